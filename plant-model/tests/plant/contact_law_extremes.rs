//! Hunt and Crossley's contact at its extremes: an answer or a named error, no hang, and no wrong answer.

use crate::support::bouncing::{bouncing, bouncing_start};
use plant_model::contact::hunt_crossley::damping_for_restitution;
use plant_model::params::*;
use plant_model::{Inputs, Method, Mode, Options, PlantError, V2, build};

const METHODS: [Method; 2] = [Method::Auto, Method::Collocation];

fn plant(law: HuntCrossley) -> PlantParams {
    let mut params = bouncing(1e8);
    params.contact.law = law.into();
    params.friction.rolling_coefficient = 0.02;
    params
}

/// Start position and velocity \[m\], \[m/s\], and the force before and after the middle \[N\].
type Case = (&'static str, [f64; 2], [f64; 2], [[f64; 2]; 2]);

const CASES: [Case; 9] = [
    ("head-on", [0.0, 0.0], [0.3, 0.0], [[0.0; 2]; 2]),
    (
        "in the wall, at rest",
        [3.2e-4, 0.0],
        [0.0, 0.0],
        [[0.0; 2]; 2],
    ),
    (
        "in the wall, inwards",
        [3.2e-4, 0.0],
        [-0.2, 0.0],
        [[0.0; 2]; 2],
    ),
    (
        "in the wall, outwards",
        [3.2e-4, 0.0],
        [0.2, 0.1],
        [[0.0; 2]; 2],
    ),
    (
        "on the wall, along it",
        [3e-4, 0.0],
        [0.0, 0.5],
        [[0.0; 2]; 2],
    ),
    ("grazing", [0.0, 2.999e-4], [0.06, 0.0], [[0.0; 2]; 2]),
    ("dropped", [2.5e-4, 0.0], [0.0, 0.0], [[2000.0, 0.0]; 2]),
    (
        "lying, then pulled off",
        [3e-4, 0.0],
        [0.0, 0.0],
        [[2000.0, 0.0], [-9000.0, 0.0]],
    ),
    (
        "lying under its weight",
        [0.0, -3e-4],
        [0.0, 0.0],
        [[0.0, -98.1]; 2],
    ),
];

#[test]
fn extremes_end_with_an_answer_or_a_named_error() {
    let (mut runs, mut errors) = (0, 0);
    for (name, position, velocity, forces) in CASES {
        for method in METHODS {
            for n in [1.0, 1.5, 3.0] {
                for depth_m in [1e-6, 1e-5, 1e-3] {
                    for damping_s_m in [0.0, 1.0, 1e5] {
                        let law = HuntCrossley {
                            stiffness_n_mn: 1.0,
                            exponent: n,
                            damping_s_m: 0.0,
                        }
                        .with_depth(depth_m, 0.3, 10.0);
                        let law = HuntCrossley { damping_s_m, ..law };
                        let start = Start {
                            position_m: position.into(),
                            velocity_m_s: velocity.into(),
                            ..bouncing_start()
                        };
                        let options = Options {
                            method,
                            steps_per_sample: 5_000,
                            steps: 20_000,
                            ..Options::default()
                        };
                        let mut plant = build(&plant(law), &start, options).unwrap();
                        let mut run = || -> Result<(), PlantError> {
                            for i in 1..=20 {
                                let inputs = Inputs {
                                    command_n: V2::zeros(),
                                    external_n: forces[usize::from(i > 10)].into(),
                                };
                                plant.advance(1e-3 * f64::from(i), &inputs, &mut |_| {})?;
                            }
                            Ok(())
                        };
                        let ended = run();
                        let what =
                            format!("{name} {method:?} n = {n} {depth_m:e} λ = {damping_s_m:e}");
                        runs += 1;
                        match ended {
                            // Beyond 1000·rtol the host refuses a run.
                            Ok(()) if plant.audit().residual() > 1e-6 => {
                                errors += 1;
                                println!("{what}: residual {:e}", plant.audit().residual());
                            }
                            Ok(()) => {}
                            Err(e) => {
                                errors += 1;
                                println!("{what}: {e}");
                            }
                        }
                    }
                }
            }
        }
    }
    println!("{errors} named errors in {runs} runs");
    // The hardest of them vibrate too fast for the steps allowed here.
    assert!(errors * 10 <= runs, "{errors} of {runs}");
}

/// Pulled off faster than the wall relaxes the force ends with a dent, and the energy of the dent is lost.
#[test]
fn a_wall_does_not_pull() {
    for method in [Method::Auto, Method::Collocation] {
        let law = HuntCrossley {
            stiffness_n_mn: 1e11,
            exponent: 1.5,
            damping_s_m: 50.0,
        };
        let mut params = plant(law);
        params.rotor.eccentricity_m = 0.0;
        params.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
        let start = Start {
            position_m: V2::new(3e-4 + 1e-5, 0.0),
            velocity_m_s: V2::zeros(),
            ..bouncing_start()
        };
        let options = Options {
            method,
            ..Options::default()
        };
        let mut run = build(&params, &start, options).unwrap();
        let pull = Inputs {
            command_n: V2::zeros(),
            external_n: V2::new(-5e4, 0.0),
        };
        let mut left = None;
        run.advance(1e-3, &pull, &mut |s| {
            if s.mode == Mode::Flight {
                left = left.or(Some(*s));
            }
        })
        .unwrap();
        let left = left.unwrap();
        // Where 1 + λB = 0, still dented.
        assert!((left.velocity_m_s.x * 50.0 + 1.0).abs() < 1e-9, "{left:?}");
        assert!(left.penetration_m > 1e-6, "{left:?}");
        assert!(run.audit().residual() < 1e-10);
    }
}

/// A rotor dropped on the wall bounces ever lower until it lies there with the force that holds it.
#[test]
fn bouncing_comes_to_rest_at_the_static_depth() {
    let lambda = damping_for_restitution(0.3, 0.1).unwrap();
    let law = HuntCrossley {
        stiffness_n_mn: 1e11,
        exponent: 1.5,
        damping_s_m: lambda,
    };
    let mut params = plant(law);
    params.rotor.eccentricity_m = 0.0;
    params.rotor.stiffness_n_m = 0.0;
    for method in METHODS {
        let start = Start {
            position_m: V2::new(2.9e-4, 0.0),
            velocity_m_s: V2::zeros(),
            spin_rad_s: 0.0,
            ..bouncing_start()
        };
        let options = Options {
            method,
            ..Options::default()
        };
        let mut run = build(&params, &start, options).unwrap();
        let push = Inputs {
            command_n: V2::zeros(),
            external_n: V2::new(3000.0, 0.0),
        };
        run.advance(0.5, &push, &mut |_| {}).unwrap();
        let now = run.snapshot();
        println!(
            "{method:?}: {} impacts, {:?}",
            run.meters().impacts,
            run.work()
        );
        assert!(now.mode.in_contact());
        assert!((now.normal_force_n / 3000.0 - 1.0).abs() < 1e-4, "{now:?}");
        let depth = (3000.0_f64 / 1e11).powf(2.0 / 3.0);
        assert!((now.penetration_m / depth - 1.0).abs() < 1e-4, "{now:?}");
    }
}

/// 100 starts against a reference that survives a change of method: none ends elsewhere.
#[test]
fn no_run_is_silently_wrong() {
    const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];
    let speed = 0.3;
    let law = HuntCrossley {
        stiffness_n_mn: 1.0,
        exponent: 1.5,
        damping_s_m: damping_for_restitution(0.75, speed).unwrap(),
    }
    .with_depth(speed * (10.0_f64 / 1e8).sqrt(), speed, 10.0);
    let mut params = plant(law);
    params.friction.rolling_coefficient = 0.0;
    let run = |speed_m_s: f64, method: Method, rtol: f64| {
        let start = Start {
            velocity_m_s: V2::new(speed_m_s, 0.0),
            ..bouncing_start()
        };
        let options = Options {
            rtol,
            method,
            ..Options::default()
        };
        let mut plant = build(&params, &start, options).unwrap();
        let mut modes = Vec::new();
        plant
            .advance(0.1, &Inputs::default(), &mut |s| modes.push(s.mode))
            .unwrap();
        (plant.snapshot().position_m, modes)
    };
    let agree = |a: &(V2, Vec<Mode>), b: &(V2, Vec<Mode>)| {
        a.1 == b.1 && (a.0 - b.0).norm() < 0.5 * params.contact.clearance_m
    };
    let (mut wrong, mut left_out, mut changes) = ([0_u32; 4], 0, 0);
    for i in 0..100 {
        let speed = 0.05 + 0.399 * f64::from(i) / 99.0;
        let reference = run(speed, Method::Collocation, 1e-13);
        if !agree(
            &reference,
            &run(speed * (1.0 + 1e-12), Method::Collocation, 1e-10),
        ) {
            left_out += 1;
            continue;
        }
        changes += reference.1.len();
        for (wrong, rtol) in wrong.iter_mut().zip(TOLERANCES) {
            let other = run(speed, Method::Auto, rtol);
            if !agree(&reference, &other) {
                *wrong += 1;
                let apart = (reference.0 - other.0).norm() / params.contact.clearance_m;
                println!("{speed} m/s at {rtol:e}: {apart:e} clearances off");
                println!("{:?}\n{:?}", reference.1, other.1);
            }
        }
    }
    println!("wrong {wrong:?} at {TOLERANCES:?}, {left_out} left out, {changes} changes of mode");
    // At 1e-6 one run misses a hop before it rolls, and ends 1e-5 clearances off: the explicit pair, which
    // contact without a series is left with, is coarser than the series.
    assert!(wrong[0] <= 2 && wrong[1] <= 1, "{wrong:?}");
    assert!(wrong[2..].iter().all(|w| *w == 0), "{wrong:?}");
    assert!(left_out <= 2, "{left_out} left out");
}
