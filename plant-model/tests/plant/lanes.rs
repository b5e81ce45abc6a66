//! Runs side by side end as they do one by one.

use crate::support::*;
use plant_model::analysis::impact::{
    Aim, Criterion, Impact, Outcome, Search, critical_speed_m_s, critical_speeds_m_s, run_impact,
    run_impacts,
};
use plant_model::analysis::onset::critical_tangential_speed_m_s;
use plant_model::lanes::{Ended, Ending, LaneParams, Launch, run};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use std::f64::consts::TAU;
use std::ops::Range;

/// Friction, damping ratio, natural frequency, restitution, clearance, eccentricity.
type Rig = (f64, f64, f64, f64, f64, f64);

fn rig((mu, damping_ratio, hz, e, clearance_m, eccentricity_m): Rig) -> PlantParams {
    let (mass_kg, natural) = (MASS_KG, TAU * hz);
    PlantParams {
        rotor: RotorParams {
            mass_kg,
            stiffness_n_m: mass_kg * natural * natural,
            damping_n_s_m: 2.0 * damping_ratio * mass_kg * natural,
            eccentricity_m,
            contact_radius_m: 0.1,
        },
        contact: ContactParams {
            clearance_m,
            law: linear(1e8, e).into(),
        },
        friction: friction(mu),
        ..bouncing(1e8)
    }
}

fn friction(coefficient: f64) -> FrictionParams {
    FrictionParams {
        sliding: constant(coefficient),
        rolling_coefficient: 0.0,
    }
}

fn rigs(eccentricity_m: f64) -> impl Strategy<Value = Rig> {
    (
        0.05..0.6_f64,
        0.0..0.1_f64,
        10.0..150.0_f64,
        0.1..0.95_f64,
        5e-5..1e-3_f64,
        0.0..=eccentricity_m,
    )
}

/// So many, always the same.
fn draw<T>(strategy: &impl Strategy<Value = T>, count: usize) -> Vec<T> {
    let mut runner = TestRunner::deterministic();
    let mut one = || strategy.new_tree(&mut runner).unwrap().current();
    (0..count).map(|_| one()).collect()
}

/// Impacts at shares of v_t,crit, as powers of ten, into any direction.
fn impacts(eccentricity_m: f64, shares: Range<f64>, count: usize) -> Vec<(PlantParams, Impact)> {
    let strategy = (
        rigs(eccentricity_m),
        shares,
        -0.3..1.4_f64,
        prop::sample::select(vec![250.0, -250.0, 100.0]),
        -3.0..3.0_f64,
    );
    let of = |(of_rig, share, inclination_rad, spin_rad_s, spin_phase_rad)| {
        let params = rig(of_rig);
        let speed_m_s = 10_f64.powf(share) * critical_tangential_speed_m_s(&params).unwrap();
        let impact = Impact {
            speed_m_s,
            inclination_rad,
            spin_rad_s,
            spin_phase_rad,
        };
        (params, impact)
    };
    draw(&strategy, count).into_iter().map(of).collect()
}

#[test]
fn impacts_end_alike() {
    // The last ones dent the wall by more than the clearance, and fly through the middle.
    let kinds = [
        (0.0, -0.7..0.6, 3000, 800),
        (2e-5, -0.7..0.6, 3000, 800),
        (0.0, 1.0..2.0, 1000, 0),
    ];
    for (eccentricity_m, shares, count, least) in kinds {
        let cases = impacts(eccentricity_m, shares, count);
        let criterion = Criterion::default();
        let mut seen = [0; 3];
        for ((params, impact), by_lanes) in cases.iter().zip(run_impacts(&cases, &criterion)) {
            let alone = run_impact(params, impact, &criterion).unwrap();
            assert_eq!(by_lanes.unwrap(), alone, "{params:?} {impact:?}");
            seen[alone.outcome as usize] += 1;
        }
        let [whirl, free, _] = seen;
        assert!(whirl > least && free > least, "{seen:?}");
    }
}

/// A rotor that lifts off deep in the wall is past the middle before twice the time that its depth takes.
#[test]
fn the_other_wall_is_seen() {
    let params = rig((0.125, 0.003, 45.0, 0.102, 2e-4, 0.0));
    let start = |i: u32| {
        let faster = 1.0 + 0.1 * f64::from(i);
        start(V2::new(2e-4, 0.0), faster * V2::new(0.94, 0.34), 250.0)
    };
    let lane = LaneParams::of(&params).unwrap();
    let launches = (0..60).map(|i| (Launch::new(lane, &start(i), 0.01).unwrap(), i));
    run(1e-9, launches, |i, ended| {
        let mut plant = build(&params, &start(i), Options::default()).unwrap();
        let mut changes = 0;
        (plant.advance(0.01, &Inputs::default(), &mut |_| changes += 1)).unwrap();
        assert_eq!(ended.events, changes, "{:?}", start(i));
        let apart = (plant.snapshot().position_m - ended.position_m).norm() / 2e-4;
        assert!(apart < 1e-7, "{apart:e} from {:?}", start(i));
        None
    });
}

#[test]
fn critical_speeds_are_the_same() {
    let of = |(of_rig, inclination_rad)| {
        let aim = Aim {
            inclination_rad,
            spin_rad_s: 250.0,
            spin_phase_rad: 0.2,
        };
        (rig(of_rig), aim)
    };
    let drawn = draw(&(rigs(0.0), -0.3..1.4_f64), 40).into_iter();
    let mut cases: Vec<_> = drawn.map(of).collect();
    // What lanes do not know goes the other way: free spin, a stator that moves; and what has no critical speed.
    cases[1].0.spin = free_spin(0.05, 0.0);
    cases[2].0.rotor.stiffness_n_m = -1.0;
    let search = Search {
        step: 0.03,
        tolerance: 1e-4,
    };
    let criterion = Criterion::default();
    let (found, tried) = critical_speeds_m_s(&cases, &search, &criterion);
    assert!(tried.by_lanes < tried.impacts && tried.by_lanes > tried.impacts * 9 / 10);
    for ((params, aim), by_lanes) in cases.iter().zip(found) {
        let alone = critical_speed_m_s(params, *aim, &search, &criterion);
        assert_eq!(by_lanes, alone, "{params:?}");
    }
}

fn at_speed(speed_m_s: f64) -> Start {
    start(V2::zeros(), V2::new(speed_m_s, 0.0), 400.0)
}

/// Runs of 0.2 s from a speed each, in this order.
fn by_lanes(params: &PlantParams, speeds_m_s: &[f64], rtol: f64) -> Vec<Ended> {
    let params = LaneParams::of(params).unwrap();
    let launch = |speed_m_s: &f64| Launch::new(params, &at_speed(*speed_m_s), 0.2).unwrap();
    let mut ended = vec![None; speeds_m_s.len()];
    let launches = speeds_m_s.iter().map(launch).zip(0..);
    run(rtol, launches, |i: usize, end| {
        ended[i] = Some(end);
        None
    });
    ended.into_iter().map(Option::unwrap).collect()
}

fn speeds() -> Vec<f64> {
    (0..200).map(|i| 0.05 + 0.002 * f64::from(i)).collect()
}

/// The benchmarks, from soft to hard contact: bouncing, sliding, and rolling to the end.
#[test]
fn ways_are_the_same() {
    for stiffness_n_m in [1e8, 1e10] {
        let params = bouncing(stiffness_n_m);
        for rtol in [1e-5, 1e-7, 1e-9, 1e-11] {
            let mut rolled = 0;
            for (speed_m_s, lane) in speeds().iter().zip(by_lanes(&params, &speeds(), rtol)) {
                let options = Options {
                    rtol,
                    steps_per_sample: 1_000_000,
                    ..Options::default()
                };
                let mut plant = build(&params, &at_speed(*speed_m_s), options).unwrap();
                let mut changes = 0;
                (plant.advance(0.2, &Inputs::default(), &mut |_| changes += 1)).unwrap();
                let now = plant.snapshot();
                assert_eq!(lane.ending, Ending::Time);
                assert_eq!(lane.events, changes, "{speed_m_s} m/s at {rtol:e}");
                assert_eq!(lane.in_contact, now.mode.in_contact());
                let apart = (lane.position_m - now.position_m).norm() / 3e-4;
                assert!(apart < 200.0 * rtol, "{speed_m_s} at {rtol:e}: {apart:e}");
                rolled += usize::from(now.mode == ContactMode::Roll);
            }
            assert!(rolled > 100, "{rolled} roll");
        }
    }
}

/// The same bits whatever runs beside.
#[test]
fn runs_stand_alone() {
    let params = bouncing(1e8);
    let together = by_lanes(&params, &speeds(), 1e-9);
    let mut back = speeds();
    back.reverse();
    let reversed = by_lanes(&params, &back, 1e-9);
    for ((speed, together), reversed) in speeds().iter().zip(&together).zip(reversed.iter().rev()) {
        assert_eq!(together, reversed);
        assert_eq!(together, &by_lanes(&params, &[*speed], 1e-9)[0]);
    }
}

#[test]
fn what_lanes_do_not_know_is_refused() {
    let known = bouncing(1e8);
    let lane = LaneParams::of(&known).unwrap();
    type Change = fn(&mut PlantParams);
    let unknown: &[Change] = &[
        |p| p.spin = free_spin(0.1, 0.0),
        |p| p.rotor.stiffness_n_m = -1e3,
        |p| p.rotor.mass_kg = f64::NAN,
        |p| p.friction.rolling_coefficient = 0.01,
        |p| p.magnet = Some(magnet_of(100.0, 1e-3)),
        |p| p.contact.law = spring(1e8, 1e6).into(),
        |p| p.contact.clearance_m = 0.0,
    ];
    for change in unknown {
        let mut params = known;
        change(&mut params);
        assert_eq!(LaneParams::of(&params), None, "{params:?}");
    }
    let beyond = Start {
        position_m: V2::new(3.1e-4, 0.0),
        ..at_speed(0.1)
    };
    assert_eq!(Launch::new(lane, &beyond, 1.0), None);
    for until_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(Launch::new(lane, &at_speed(0.1), until_s), None);
    }
    assert_eq!(Launch::new(lane, &at_speed(f64::NAN), 1.0), None);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever the numbers: it ends, and where lanes decide, they decide as the other does.
    #[test]
    fn extremes_end(
        (mass, stiffness, damping, contact, ratio) in (-3.0..3.0_f64, 0.0..8.0_f64, -2.0..5.0_f64, 4.0..11.0_f64, 0.0..1.9_f64),
        (clearance, mu, radius, spin, eccentricity) in (-6.0..-2.0_f64, 0.0..1.5_f64, -4.0..0.0_f64, -3000.0..3000.0_f64, 0.0..0.3_f64),
        (share, inclination_rad, rtol) in (-2.0..1.5_f64, -1.5..1.5_f64, -12.0..-3.0_f64),
    ) {
        let (mass_kg, contact_n_m, clearance_m) = (10_f64.powf(mass), 10_f64.powf(contact), 10_f64.powf(clearance));
        let mut params = rig((0.2, 0.01, 40.0, 0.5, clearance_m, eccentricity * clearance_m));
        params.rotor.mass_kg = mass_kg;
        params.rotor.stiffness_n_m = 10_f64.powf(stiffness);
        params.rotor.damping_n_s_m = 10_f64.powf(damping);
        params.rotor.contact_radius_m = 10_f64.powf(radius);
        params.friction = friction(mu);
        params.contact.law = spring(contact_n_m, ratio * (contact_n_m * mass_kg).sqrt()).into();
        let threshold = critical_tangential_speed_m_s(&params);
        prop_assume!(threshold.is_some());
        let impact = Impact {
            speed_m_s: 10_f64.powf(share) * threshold.unwrap_or(1.0),
            inclination_rad,
            spin_rad_s: spin,
            spin_phase_rad: 0.3,
        };
        let options = Options { rtol: 10_f64.powf(rtol), steps: 20_000, ..Options::default() };
        let criterion = Criterion { limit_s: 0.05, limit_periods: 0.0, options, ..Criterion::default() };
        let cases = [(params, impact)];
        let by_lanes = run_impacts(&cases, &criterion);
        let alone = run_impact(&cases[0].0, &impact, &criterion);
        if let (Ok(by_lanes), Ok(alone)) = (&by_lanes[0], alone) {
            prop_assert_eq!(by_lanes.outcome == Outcome::Whirl, alone.outcome == Outcome::Whirl);
        }
    }
}

/// Whirl that comes and goes within one long step: the unbalance turns through its own direction.
#[test]
fn whirl_between_the_ends_of_a_step_is_seen() {
    let (mass_kg, clearance_m) = (700.0, 1e-2);
    let mut params = rig((0.2, 0.01, 40.0, 0.5, clearance_m, 1.6e-3));
    params.rotor.mass_kg = mass_kg;
    params.rotor.stiffness_n_m = 1.0;
    params.rotor.damping_n_s_m = 1.0;
    params.rotor.contact_radius_m = 1.0;
    params.friction = friction(0.7);
    params.contact.law = spring(5e7, 1.17 * (5e7 * mass_kg).sqrt()).into();
    let impact = Impact {
        speed_m_s: critical_tangential_speed_m_s(&params).unwrap(),
        inclination_rad: 0.0,
        spin_rad_s: -1160.0,
        spin_phase_rad: 0.3,
    };
    for rtol in [1e-2, 1e-3, 1e-5, 1e-9, 1e-12] {
        let options = Options {
            rtol,
            ..Options::default()
        };
        let criterion = Criterion {
            limit_s: 0.05,
            limit_periods: 0.0,
            options,
            ..Criterion::default()
        };
        let by_lanes = run_impacts(&[(params, impact)], &criterion).remove(0);
        let alone = run_impact(&params, &impact, &criterion).unwrap();
        assert_eq!(alone.outcome, Outcome::Whirl, "{rtol:e}");
        assert_eq!(by_lanes.unwrap(), alone);
    }
}
