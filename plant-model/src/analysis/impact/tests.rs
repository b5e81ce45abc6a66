use super::*;
use crate::contact::damping_for_restitution;
use crate::params::*;

fn rig(restitution: f64) -> PlantParams {
    let (mass_kg, natural, k_c) = (10.0, std::f64::consts::TAU * 45.0, 1e10);
    PlantParams {
        rotor: RotorParams {
            mass_kg,
            stiffness_n_m: mass_kg * natural * natural,
            damping_n_s_m: 0.0,
            eccentricity_m: 0.0,
            contact_radius_m: 0.1,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: ContactParams {
            clearance_m: 2e-4,
            law: LinearContact {
                stiffness_n_m: k_c,
                damping_n_s_m: damping_for_restitution(restitution, k_c, mass_kg).unwrap(),
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.125 },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    }
}

fn radial(spin_rad_s: f64) -> Aim {
    Aim {
        inclination_rad: 0.0,
        spin_rad_s,
        spin_phase_rad: 0.0,
    }
}

/// An unbalance makes whirl of impacts far slower than those that a balanced rotor needs: the search goes down to them.
#[test]
fn unbalance_is_searched_for_below_what_bounces_need() {
    let mut params = rig(0.7);
    let search = Search {
        step: 0.02,
        tolerance: 1e-4,
    };
    let critical = |params: &PlantParams| {
        critical_speed_m_s(params, radial(250.0), &search, &Criterion::default()).unwrap()
    };
    let balanced = critical(&params).unwrap();
    params.rotor.eccentricity_m = 2e-5;
    let speed_m_s = critical(&params).unwrap();
    assert!(speed_m_s < 0.1 * balanced, "{speed_m_s} and {balanced}");
    let outcome = |speed_m_s: f64| {
        let impact = radial(250.0).at(speed_m_s);
        let after = run_impact(&params, &impact, &Criterion::default()).unwrap();
        after.outcome
    };
    assert_eq!(outcome(speed_m_s), Outcome::Whirl);
    assert_ne!(outcome(0.9995 * speed_m_s), Outcome::Whirl);
    // One that is driven along the wall by its unbalance alone bears nothing.
    params.rotor.eccentricity_m = 5e-5;
    assert_eq!(critical(&params), Some(0.0));
}

/// Rolling below twice v_t,crit holds the rotor at the wall: that is whirl, too.
#[test]
fn rolling_just_above_the_threshold_is_whirl() {
    let mut params = rig(0.5);
    params.contact.law = LinearContact {
        stiffness_n_m: 1e8,
        damping_n_s_m: damping_for_restitution(0.5, 1e8, 10.0).unwrap(),
    }
    .into();
    let threshold_m_s = critical_tangential_speed_m_s(&params).unwrap();
    params.rotor.contact_radius_m = 1.3 * threshold_m_s / 250.0;
    let outcome = |speed_m_s: f64| {
        let impact = radial(250.0).at(speed_m_s);
        [
            run_impact(&params, &impact, &Criterion::default()).unwrap(),
            run_impacts(&[(params, impact)], &Criterion::default())[0]
                .clone()
                .unwrap(),
        ]
        .map(|after| after.outcome)
    };
    assert_eq!(outcome(10.0 * threshold_m_s), [Outcome::Whirl; 2]);
    assert!(!outcome(0.5 * threshold_m_s).contains(&Outcome::Whirl));
    // Slower than the threshold it cannot stay there.
    params.rotor.contact_radius_m = 0.9 * threshold_m_s / 250.0;
    let impact = radial(250.0).at(10.0 * threshold_m_s);
    let after = run_impact(&params, &impact, &Criterion::default()).unwrap();
    assert_ne!(after.outcome, Outcome::Whirl);
}

#[test]
fn what_has_no_critical_speed_says_why() {
    let critical = |params: &PlantParams, inclination_rad: f64| {
        let aim = Aim {
            inclination_rad,
            ..radial(250.0)
        };
        critical_speed_m_s(params, aim, &Search::default(), &Criterion::default())
    };
    let mut params = rig(0.7);
    for inclination_rad in [1.6, -1.6, f64::NAN] {
        assert_eq!(
            critical(&params, inclination_rad),
            Err(ImpactError::Inclination)
        );
    }
    params.rotor.stiffness_n_m = -1.0;
    assert_eq!(critical(&params, 0.0), Err(ImpactError::NotHeld));
    params.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
    assert_eq!(critical(&params, 0.0), Err(ImpactError::NoFriction));
}

/// Hard contact, nothing lost between bounces: the sum over all bounces, v_t,crit/K.
#[test]
fn undamped_hard_impacts_sum_up() {
    let params = rig(0.7);
    let threshold = critical_tangential_speed_m_s(&params).unwrap();
    let search = Search {
        step: 0.02,
        tolerance: 1e-4,
    };
    for spin in [250.0, -250.0] {
        let v = critical_speed_m_s(&params, radial(spin), &search, &Criterion::default())
            .unwrap()
            .unwrap();
        let sum = threshold / (0.125 * 1.7 / 0.3);
        assert!((v / sum - 1.0).abs() < 0.03, "{v} against {sum}");
    }
}

/// The bound on what flight can reach holds, and without damping is what it reaches; with unbalance
/// it holds.
#[test]
fn free_is_told_by_the_ellipse() {
    for (eccentricity_m, damping_n_s_m, slack) in
        [(0.0, 0.0, 1.001), (0.0, 100.0, 1.05), (5e-6, 20.0, 1.5)]
    {
        let mut params = rig(0.7);
        params.rotor.damping_n_s_m = damping_n_s_m;
        params.rotor.eccentricity_m = eccentricity_m;
        let start = Start {
            position_m: V2::new(1e-4, 0.0),
            velocity_m_s: V2::new(0.03, 0.03),
            spin_rad_s: 200.0,
            spin_phase_rad: 0.4,
        };
        let mut plant = build(&params, &start, Options::default()).unwrap();
        let begin = plant.snapshot();
        let mut largest = 0.0_f64;
        for i in 1..=20_000 {
            let t = f64::from(i) * 1e-5;
            plant.advance(t, &Inputs::default(), &mut |_| {}).unwrap();
            largest = largest.max(plant.snapshot().position_m.norm());
        }
        assert_eq!(plant.meters().impacts, 0);
        params.contact.clearance_m = 0.9999 * largest;
        assert!(!stays_free(&params, &begin, 0.4), "ε = {eccentricity_m}");
        params.contact.clearance_m = slack * largest;
        assert!(stays_free(&params, &begin, 0.4), "ε = {eccentricity_m}");
    }
}

/// Whatever is called free never touches again: out of round, where the wall comes nearer than c, and with rings that
/// swing on after the touch.
#[test]
fn what_is_free_never_touches_again() {
    let ring = RingParams {
        mass_kg: 5.0,
        stiffness_n_m: V2::new(4e6, 5e6),
        damping_n_s_m: V2::new(20.0, 20.0),
    };
    let outer = RingParams {
        stiffness_n_m: V2::new(2e7, 2e7),
        ..ring
    };
    let stators = [
        StatorParams::RigidEllipse(EllipseParams {
            ellipticity: 0.15,
            long_axis_rad: 0.3,
        }),
        StatorParams::OneMass(ring),
        StatorParams::TwoMass { inner: ring, outer },
    ];
    for stator in stators {
        let mut params = rig(0.7);
        params.contact.law.linear_mut().unwrap().stiffness_n_m = 1e8;
        params.rotor.damping_n_s_m = 15.0;
        params.stator = stator;
        let mut free = 0;
        for i in 0..40 {
            let impact = Impact {
                speed_m_s: 0.02 + 0.002 * f64::from(i),
                inclination_rad: 0.3,
                spin_rad_s: 200.0,
                spin_phase_rad: 0.0,
            };
            let after = run_impact(&params, &impact, &Criterion::default()).unwrap();
            if after.outcome != Outcome::Free {
                continue;
            }
            free += 1;
            let start = start_of(&params, &impact);
            let mut plant = build(&params, &start, Options::default()).unwrap();
            let mut t_s = 0.0;
            loop {
                t_s += LOOK_S;
                plant.advance(t_s, &Inputs::default(), &mut |_| {}).unwrap();
                let now = plant.snapshot();
                if !now.mode.in_contact() && stays_free(&params, &now, 0.0) {
                    break;
                }
            }
            let then = plant.meters().contact_time_s;
            (plant.advance(t_s + 1.0, &Inputs::default(), &mut |_| {})).unwrap();
            assert_eq!(
                plant.meters().contact_time_s,
                then,
                "{stator:?} at {} m/s",
                impact.speed_m_s
            );
        }
        assert!(free >= 10, "{free} free of 40 on {stator:?}");
    }
}

/// The ring's bound against its largest way over its first periods: what it reaches and little more.
#[test]
fn a_ring_goes_as_far_as_its_energy_lets_it() {
    let ring = RingParams {
        mass_kg: 5.0,
        stiffness_n_m: V2::new(4e6, 4e6),
        damping_n_s_m: V2::zeros(),
    };
    let outer = RingParams {
        mass_kg: 3.0,
        stiffness_n_m: V2::new(9e6, 9e6),
        ..ring
    };
    for (stator, slack) in [
        (StatorParams::OneMass(ring), 1.001),
        (StatorParams::TwoMass { inner: ring, outer }, 1.2),
    ] {
        let mut params = rig(0.7);
        params.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
        params.stator = stator;
        let impact = Impact {
            speed_m_s: 0.1,
            inclination_rad: 0.0,
            spin_rad_s: 200.0,
            spin_phase_rad: 0.0,
        };
        let start = start_of(&params, &impact);
        let mut plant = build(&params, &start, Options::default()).unwrap();
        let mut t = 0.0;
        while t == 0.0 || plant.mode().in_contact() {
            t += 1e-5;
            plant.advance(t, &Inputs::default(), &mut |_| {}).unwrap();
        }
        let bound = ring_reach_m(&params.stator, &plant.snapshot());
        // Without the wall nothing stops it.
        let mut farthest = 0.0_f64;
        while t < 2e-3 {
            t += 1e-5;
            plant.advance(t, &Inputs::default(), &mut |_| {}).unwrap();
            farthest = farthest.max(plant.snapshot().inner_ring.position.norm());
        }
        assert_eq!(plant.meters().impacts, 1, "{stator:?}");
        assert!(farthest <= bound * (1.0 + 1e-9), "{farthest:e} {bound:e}");
        assert!(farthest * slack >= bound, "{farthest:e} {bound:e}");
        let drifting = StatorParams::OneMass(RingParams {
            stiffness_n_m: V2::new(1e6, 0.0),
            ..ring
        });
        assert!(ring_reach_m(&drifting, &plant.snapshot()).is_infinite());
    }
}
