//! Hunt and Crossley's contact law against the closed forms of its impacts, and one method against another.

use crate::support::bouncing::{bouncing, bouncing_start};
use crate::support::plants::footnote_4;
use plant_model::contact::hunt_crossley::{damping_for_restitution, restitution_of};
use plant_model::params::*;
use plant_model::{BuildError, Inputs, Method, Mode, Options, Plant, Snapshot, V2, build};

const MASS_KG: f64 = 10.0;
const CLEARANCE_M: f64 = 2e-4;
const PAIRS: [Method; 1] = [Method::Collocation];

/// A free mass in a rigid stator.
fn free_mass(law: HuntCrossley, friction: f64) -> PlantParams {
    PlantParams {
        rotor: RotorParams {
            mass_kg: MASS_KG,
            stiffness_n_m: 0.0,
            damping_n_s_m: 0.0,
            eccentricity_m: 0.0,
            contact_radius_m: 0.1,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: ContactParams {
            clearance_m: CLEARANCE_M,
            law: law.into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant {
                coefficient: friction,
            },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    }
}

fn start(position_m: V2, velocity_m_s: V2, spin_rad_s: f64) -> Start {
    Start {
        position_m,
        velocity_m_s,
        spin_rad_s,
        spin_phase_rad: 0.0,
    }
}

/// k_h such that an impact at 0.2 m/s is 1e-5 m deep without damping.
fn law(exponent: f64, damping_s_m: f64) -> HuntCrossley {
    HuntCrossley {
        stiffness_n_mn: 1.0,
        exponent,
        damping_s_m: 0.0,
    }
    .with_depth(1e-5, 0.2, MASS_KG)
    .damped(damping_s_m)
}

trait Damped {
    fn damped(self, damping_s_m: f64) -> Self;
}

impl Damped for HuntCrossley {
    fn damped(self, damping_s_m: f64) -> Self {
        Self {
            damping_s_m,
            ..self
        }
    }
}

fn options(method: Method, rtol: f64) -> Options {
    Options {
        rtol,
        method,
        ..Options::default()
    }
}

/// Runs until the first contact is over: how long it took, and its end.
fn impact(plant: &mut Plant, sample_s: f64) -> (f64, Snapshot) {
    let (mut touch, mut leave) = (None, None);
    for i in 1..200_000 {
        plant
            .advance(
                f64::from(i) * sample_s,
                &Inputs::default(),
                &mut |s| match s.mode {
                    Mode::Flight => leave = leave.or(Some(*s)),
                    _ => touch = touch.or(Some(s.t_s)),
                },
            )
            .unwrap();
        if let (Some(touch), Some(leave)) = (touch, leave) {
            return (leave.t_s - touch, leave);
        }
    }
    panic!("no impact");
}

/// Peak penetration, contact time, restitution and energy of head-on impacts.
#[test]
fn impacts_are_those_of_the_closed_forms() {
    let speed = 0.2;
    for method in PAIRS {
        for n in [1.0, 1.25, 1.5, 2.0, 3.0] {
            for p in [0.0, 0.01, 0.5, 5.0] {
                let law = law(n, p / speed);
                let from = start(V2::new(1.9e-4, 0.0), V2::new(speed, 0.0), 0.0);
                let mut plant = build(&free_mass(law, 0.0), &from, options(method, 1e-12)).unwrap();
                let duration = law.undamped_contact_s(speed, MASS_KG);
                let (took, end) = impact(&mut plant, 2.0 * duration);
                let name = format!("{method:?} n = {n} λv = {p}");
                let e = -end.velocity_m_s.x / speed;
                assert!(
                    (e / restitution_of(p) - 1.0).abs() < 1e-9,
                    "{name}: e = {e}, {}",
                    restitution_of(p)
                );
                if p == 0.0 {
                    assert!(
                        (took / duration - 1.0).abs() < 1e-8,
                        "{name}: {took} {duration}"
                    );
                }
                let meters = plant.meters();
                let depth = law.depth_m(speed, MASS_KG);
                assert!(
                    (meters.peak_penetration_m / depth - 1.0).abs() < 2e-3,
                    "{name}"
                );
                let force = law.peak_force_n(speed, MASS_KG);
                assert!(
                    (meters.peak_contact_force_n / force - 1.0).abs() < 2e-2,
                    "{name}"
                );
                let audit = plant.audit();
                let lost = 0.5 * MASS_KG * speed * speed * (1.0 - e * e);
                assert!(audit.residual() < 1e-10, "{name}: {}", audit.residual());
                assert!(
                    (audit.flows.contact_damping - lost).abs() < 1e-9 * audit.turnover_j(),
                    "{name}"
                );
                let impulse = MASS_KG * speed * (1.0 + e);
                let booked = audit.flows.normal_impulse_n_s;
                assert!((booked / impulse - 1.0).abs() < 1e-9, "{name}: impulse");
            }
        }
    }
}

/// The deepest point met exactly: where the rotor stands still.
#[test]
fn the_peak_penetration_is_the_closed_one() {
    for (n, p) in [(1.5, 0.0), (1.5, 0.7), (2.5, 0.2)] {
        let (law, speed) = (law(n, p / 0.2), 0.2);
        let from = start(V2::new(CLEARANCE_M, 0.0), V2::new(speed, 0.0), 0.0);
        let mut plant = build(&free_mass(law, 0.0), &from, options(Method::Auto, 1e-12)).unwrap();
        assert_eq!(plant.method(), Method::Collocation);
        let whole = law.undamped_contact_s(speed, MASS_KG);
        let mut deepest = 0.0_f64;
        for i in 1..40_000 {
            let t = whole * f64::from(i) / 40_000.0;
            plant.advance(t, &Inputs::default(), &mut |_| {}).unwrap();
            deepest = deepest.max(plant.snapshot().penetration_m);
        }
        let exact = law.depth_m(speed, MASS_KG);
        assert!(
            (deepest / exact - 1.0).abs() < 1e-8,
            "n = {n}: {deepest} {exact}"
        );
    }
}

/// Hard contact, sliding all along: v_t changes by μ·(1 + e)·v_r.
#[test]
fn a_sliding_impact_turns_by_friction_times_the_normal_impulse() {
    let (speed, mu) = (0.2, 0.15);
    for method in PAIRS {
        for e in [1.0, 0.7, 0.2] {
            let lambda = damping_for_restitution(e, speed).unwrap();
            // Hard: 1e-9 m deep.
            let law = law(1.5, 0.0)
                .with_depth(1e-9, speed, MASS_KG)
                .damped(lambda);
            let from = start(V2::new(1.9e-4, 0.0), V2::new(speed, 0.0), 100.0);
            let mut plant = build(&free_mass(law, mu), &from, options(method, 1e-11)).unwrap();
            plant
                .advance(1e-4, &Inputs::default(), &mut |_| {})
                .unwrap();
            let end = plant.snapshot();
            assert_eq!(end.mode, Mode::Flight);
            let exact = -mu * (1.0 + e) * speed;
            // Curvature: of the order of depth over clearance.
            assert!(
                (end.velocity_m_s.y / exact - 1.0).abs() < 2e-5,
                "{} {exact}",
                end.velocity_m_s.y
            );
            assert!((end.velocity_m_s.x / (-e * speed) - 1.0).abs() < 2e-5);
        }
    }
}

/// A restitution is met in a stator of rings as well, with the reduced mass.
#[test]
fn a_ring_takes_its_share() {
    let (speed, e) = (0.2, 0.6);
    let lambda = damping_for_restitution(e, speed).unwrap();
    let mut params = free_mass(law(1.5, lambda), 0.0);
    params.stator = StatorParams::OneMass(RingParams {
        mass_kg: 5.0,
        stiffness_n_m: V2::zeros(),
        damping_n_s_m: V2::zeros(),
    });
    for method in PAIRS {
        let from = start(V2::new(1.9e-4, 0.0), V2::new(speed, 0.0), 0.0);
        let mut plant = build(&params, &from, options(method, 1e-11)).unwrap();
        let (_, end) = impact(&mut plant, 1e-3);
        let apart = end.inner_ring.velocity.x - end.velocity_m_s.x;
        assert!((apart / (e * speed) - 1.0).abs() < 1e-8, "{apart}");
    }
}

fn hardening(mut params: PlantParams, speed_m_s: f64, restitution: f64) -> PlantParams {
    let m = params.contact_mass_kg();
    let force_n = speed_m_s * (params.contact.stiffness_n_m() * m).sqrt();
    let law = HuntCrossley {
        stiffness_n_mn: 1.0,
        exponent: 1.5,
        damping_s_m: damping_for_restitution(restitution, speed_m_s).unwrap(),
    };
    params.contact.law = law.with_peak_force(force_n, speed_m_s, m).into();
    params
}

/// Explicit pair and stiff method end at the same place through the same modes; the books close.
#[test]
fn explicit_and_stiff_agree() {
    let mut runs: Vec<(&str, PlantParams, Start, f64, f64)> = vec![
        (
            "bouncing",
            hardening(bouncing(1e8), 0.3, 0.75),
            bouncing_start(),
            0.1,
            2e-6,
        ),
        (
            "footnote 4",
            hardening(footnote_4(), 0.4, 0.8),
            start(V2::new(2e-4, 0.0), V2::new(0.4, 0.0), 250.0),
            0.02,
            1e-6,
        ),
    ];
    let mut loose = runs[1].1;
    loose.friction.sliding = SlidingFriction::Falling {
        at_rest: 0.3,
        at_speed: 0.1,
        speed_scale_m_s: 3.0,
    };
    loose.rotor.eccentricity_m = 1e-5;
    runs.push(("falling friction, unbalance", loose, runs[1].2, 0.02, 1e-6));
    for (name, params, from, duration_s, near) in runs {
        let run = |method, rtol| {
            let mut plant = build(&params, &from, options(method, rtol)).unwrap();
            let mut modes = Vec::new();
            for i in 1..=20 {
                let t = duration_s * f64::from(i) / 20.0;
                plant
                    .advance(t, &Inputs::default(), &mut |s| modes.push(s.mode))
                    .unwrap();
            }
            let residual = plant.audit().residual();
            println!(
                "{name} {method:?} {rtol:e}: residual {residual:e} {:?}",
                plant.work()
            );
            assert!(residual < 10.0 * rtol, "{name} {method:?}: {residual:e}");
            (plant.snapshot().position_m, modes)
        };
        let (a, b) = (
            run(Method::Collocation, 1e-12),
            run(Method::Collocation, 1e-10),
        );
        assert_eq!(a.1, b.1, "{name}");
        let apart = (a.0 - b.0).norm() / params.contact.clearance_m;
        assert!(apart < near, "{name}: {apart:e}");
        for (method, rtol) in [(Method::Collocation, 1e-6), (Method::Collocation, 1e-9)] {
            run(method, rtol);
        }
    }
}

/// n = 1 and λ = 0 is the linear law.
#[test]
fn exponent_one_is_the_linear_law() {
    let mut params = bouncing(1e8);
    params.contact.law = LinearContact {
        stiffness_n_m: 1e8,
        damping_n_s_m: 0.0,
    }
    .into();
    let end = |params: &PlantParams| {
        let mut plant = build(
            params,
            &bouncing_start(),
            options(Method::Collocation, 1e-12),
        )
        .unwrap();
        plant
            .advance(0.02, &Inputs::default(), &mut |_| {})
            .unwrap();
        plant.snapshot().position_m
    };
    let linear = end(&params);
    params.contact.law = HuntCrossley {
        stiffness_n_mn: 1e8,
        exponent: 1.0,
        damping_s_m: 0.0,
    }
    .into();
    let apart = (end(&params) - linear).norm() / params.contact.clearance_m;
    assert!(apart < 1e-8, "{apart:e}");
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let at = start(V2::zeros(), V2::zeros(), 0.0);
    let params = free_mass(law(1.5, 0.0), 0.1);
    let refused = build(&params, &at, options(Method::Series, 1e-9))
        .err()
        .unwrap();
    assert_eq!(refused, BuildError::NoSeries);
    assert!(refused.to_string().contains("collocation"));
    for (law, field) in [
        (
            HuntCrossley {
                stiffness_n_mn: 0.0,
                ..law(1.5, 0.0)
            },
            "contact.stiffness_n_mn",
        ),
        (
            HuntCrossley {
                exponent: 0.9,
                ..law(1.5, 0.0)
            },
            "contact.exponent",
        ),
        (
            HuntCrossley {
                exponent: f64::NAN,
                ..law(1.5, 0.0)
            },
            "contact.exponent",
        ),
        (law(1.5, -1.0), "contact.damping_s_m"),
    ] {
        match build(&free_mass(law, 0.1), &at, Options::default()) {
            Err(BuildError::Param(e)) => assert_eq!(e.field, field),
            _ => panic!("{field} was taken"),
        }
    }
}
