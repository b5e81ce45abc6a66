//! Flight from sample to sample goes by a map once the step length recurs; cut at other times it goes by
//! the series. Both must be the same flight.

use crate::support::plants::footnote_4;
use plant_model::params::*;
use plant_model::{Inputs, Options, Plant, V2, build};

const PERIOD_S: f64 = 5e-5;
const SAMPLES: u32 = 400;

/// Every part that flies: no, one and two rings (the rings at different stiffness by axis, after a push),
/// lag and none, damping and none, drive torque.
fn plants() -> Vec<PlantParams> {
    let StatorParams::TwoMass { inner, outer } = footnote_4().stator else {
        panic!("footnote 4 has two rings");
    };
    let ring = RingParams {
        stiffness_n_m: V2::new(8.9e8, 6.0e8),
        damping_n_s_m: V2::new(300.0, 500.0),
        ..inner
    };
    let outer = RingParams {
        damping_n_s_m: V2::new(200.0, 100.0),
        ..outer
    };
    let stators = [
        StatorParams::Rigid,
        StatorParams::OneMass(ring),
        StatorParams::TwoMass { inner: ring, outer },
    ];
    let mut all = Vec::new();
    for stator in stators {
        for lag_s in [0.0, 2e-4] {
            for stiffness_n_m in [9.1e5, -2e5] {
                let mut params = footnote_4();
                params.stator = stator;
                params.rotor.stiffness_n_m = stiffness_n_m;
                params.rotor.damping_n_s_m = if lag_s > 0.0 { 20.5 } else { 0.0 };
                params.spin = SpinParams::Free {
                    inertia_kg_m2: 0.05,
                    drive_torque_n_m: 3.0,
                };
                params.magnet = Some(MagnetParams {
                    force_max_n: 500.0,
                    lag_s,
                });
                all.push(params);
            }
        }
    }
    all
}

fn input(sample: u32) -> Inputs {
    let phase = f64::from(sample);
    Inputs {
        command_n: V2::new(300.0 * (0.3 * phase).sin(), 200.0 * (0.11 * phase).cos()),
        external_n: V2::new(0.0, -20.0),
    }
}

/// Touches once, so that rings and spin move, and flies on; each sample in one go or cut in two.
fn fly(params: &PlantParams, cut: bool) -> Plant {
    let start = Start {
        position_m: V2::new(1.5e-4, 0.2e-4),
        velocity_m_s: V2::new(0.2, 0.02),
        spin_rad_s: 100.0,
        spin_phase_rad: 0.0,
    };
    // Contact must not blur what is compared here.
    let options = Options {
        rtol: 1e-12,
        ..Options::default()
    };
    let mut plant = build(params, &start, options).unwrap();
    for sample in 0..SAMPLES {
        let [from, to] = [sample, sample + 1].map(|n| f64::from(n) * PERIOD_S);
        let mut advance = |t: f64| plant.advance(t, &input(sample), &mut |_| {}).unwrap();
        if cut {
            // Nowhere twice the same.
            let share = 0.3 + 0.4 * (0.618 * f64::from(sample)).fract();
            advance(from + share * (to - from));
        }
        advance(to);
    }
    plant
}

#[test]
fn samples_flown_whole_or_cut_are_the_same_flight() {
    for params in plants() {
        let (mut whole, mut cut) = (fly(&params, false), fly(&params, true));
        assert_eq!(whole.meters().impacts, cut.meters().impacts);
        assert!(whole.meters().impacts >= 1);
        let (a, b) = (whole.snapshot(), cut.snapshot());
        let pairs = [
            (a.position_m, b.position_m, 1e-4),
            (a.velocity_m_s, b.velocity_m_s, 0.1),
            (a.inner_ring.position, b.inner_ring.position, 1e-5),
            (a.inner_ring.velocity, b.inner_ring.velocity, 0.1),
            (a.outer_ring.position, b.outer_ring.position, 1e-5),
            (a.delivered_n, b.delivered_n, 300.0),
        ];
        for (i, (a, b, size)) in pairs.into_iter().enumerate() {
            let apart = (a - b).norm() / size;
            assert!(apart < 1e-9, "{i}: {apart:e} for {params:?}");
        }
        assert!((a.spin_rad_s - b.spin_rad_s).abs() < 1e-7);
        for plant in [&whole, &cut] {
            let residual = plant.audit().residual();
            assert!(residual < 1e-11, "{residual:e} for {params:?}");
        }
        let [a, b] = [&whole, &cut].map(|plant| plant.audit().flows);
        let works = [
            ("control", a.control, b.control),
            ("rotor damping", a.rotor_damping, b.rotor_damping),
            ("stator damping", a.stator_damping, b.stator_damping),
            ("drive", a.drive, b.drive),
        ];
        for (name, a, b) in works {
            assert!(
                (a - b).abs() < 1e-9 * (a.abs() + 1e-3),
                "{name}: {a} and {b}"
            );
        }
    }
}

/// A clock that has run for long rounds coarsely. A map made then has the length of one rounded sample,
/// and must not add that rounding up.
#[test]
fn a_late_start_does_not_let_the_flight_drift() {
    let mut params = footnote_4();
    params.stator = StatorParams::Rigid;
    params.spin = SpinParams::Held;
    let (begin_s, samples) = (500.0, 200_000);
    let start = Start {
        position_m: V2::new(1e-4, 0.0),
        velocity_m_s: V2::new(0.0, 0.01),
        spin_rad_s: 0.0,
        spin_phase_rad: 0.0,
    };
    let omega = (params.rotor.stiffness_n_m / params.rotor.mass_kg).sqrt();
    params.rotor.damping_n_s_m = 0.0;
    let mut plant = build(&params, &start, Options::default()).unwrap();
    plant
        .advance(begin_s, &Inputs::default(), &mut |_| {})
        .unwrap();
    for sample in 1..=samples {
        let t = begin_s + f64::from(sample) * PERIOD_S;
        plant.advance(t, &Inputs::default(), &mut |_| {}).unwrap();
    }
    let t = begin_s + f64::from(samples) * PERIOD_S;
    let exact =
        start.position_m * (omega * t).cos() + start.velocity_m_s / omega * (omega * t).sin();
    let off = (plant.snapshot().position_m - exact).norm() / 1e-4;
    assert!(off < 1e-8, "{off:e}");
}

/// Whole samples are flown by the map only where nothing can reach the wall within: here the path leaves
/// the clearance in the middle of a sample of a quarter period and is back inside at its end.
#[test]
fn a_touch_within_a_whole_sample_is_not_jumped_over() {
    let mut params = footnote_4();
    params.stator = StatorParams::Rigid;
    params.rotor.damping_n_s_m = 0.0;
    let omega = (params.rotor.stiffness_n_m / params.rotor.mass_kg).sqrt();
    let sample_s = 0.5 * std::f64::consts::PI / omega;
    let start = Start {
        position_m: V2::new(1e-6, 0.0),
        velocity_m_s: V2::zeros(),
        spin_rad_s: 0.0,
        spin_phase_rad: 0.0,
    };
    let mut plant = build(&params, &start, Options::default()).unwrap();
    let mut t = 0.0;
    let mut sample = |plant: &mut Plant, force_n: f64| {
        t += sample_s;
        let inputs = Inputs {
            command_n: V2::zeros(),
            external_n: V2::new(force_n, 0.0),
        };
        plant.advance(t, &inputs, &mut |_| {}).unwrap();
    };
    for _ in 0..40 {
        sample(&mut plant, 0.0);
    }
    assert_eq!(plant.meters().impacts, 0);
    // A quarter period about an equilibrium e takes (x, v/ω) to (e + v/ω, e − x). Two of them lead to
    // (0.7, 0.8) clearances; the third one's path swings out to 1.06 and ends at 0.8.
    let reach_n = params.rotor.stiffness_n_m * params.contact.clearance_m;
    for force in [-0.05, 0.75, 0.0] {
        sample(&mut plant, force * reach_n);
    }
    assert_eq!(plant.meters().impacts, 1);
    let cut = {
        let mut plant = build(&params, &start, Options::default()).unwrap();
        let mut t = 0.0;
        let mut part = |plant: &mut Plant, force_n: f64| {
            for share in [0.21, 0.33, 0.46] {
                t += share * sample_s;
                let inputs = Inputs {
                    command_n: V2::zeros(),
                    external_n: V2::new(force_n, 0.0),
                };
                plant.advance(t, &inputs, &mut |_| {}).unwrap();
            }
        };
        for _ in 0..40 {
            part(&mut plant, 0.0);
        }
        for force in [-0.05, 0.75, 0.0] {
            part(&mut plant, force * reach_n);
        }
        plant.meters()
    };
    assert_eq!(plant.meters().impacts, cut.impacts);
}
