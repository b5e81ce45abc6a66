//! The sensor: what it is always like, and what goes wrong for a while.

use super::ridden;
use firmware_bench::device::axis::Axis;
use firmware_bench::device::sensor::{Reading, Sensor, SensorParams};
use firmware_bench::device::sensor_fault::{Fault, FaultKind};
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::V2;
use std::f64::consts::TAU;
use system_tests::scene;

const PERIOD_S: f64 = 1e-4;

/// Position at a sample: no value comes twice.
fn position(i: usize) -> V2 {
    V2::new(1e-5 * (i as f64 + 1.0), -2e-5 * (i as f64 + 1.0))
}

/// Forty samples under a fault from sample 10 to sample 19.
fn read(params: SensorParams, kind: FaultKind, axis: Axis) -> Vec<Reading> {
    let fault = Fault {
        start_s: 10.0 * PERIOD_S,
        duration_s: 10.0 * PERIOD_S,
        kind,
        axis,
    };
    let mut sensor = Sensor::new(params, &[fault], PERIOD_S, 7);
    (0..40)
        .map(|i| sensor.read(i as f64 * PERIOD_S, position(i), 0.0))
        .collect()
}

/// What is seen at each sample of the fault by an otherwise ideal sensor; before and after it the truth.
fn check(kind: FaultKind, axis: Axis, expected: impl Fn(usize) -> V2) {
    let params = SensorParams {
        range_m: Some(1e-3),
        ..SensorParams::default()
    };
    for (i, reading) in read(params, kind, axis).into_iter().enumerate() {
        let expected = match i {
            10..20 => expected(i),
            _ => position(i),
        };
        for component in [0, 1] {
            let (found, expected) = (reading.position_m[component], expected[component]);
            let same = found == expected
                || (found.is_nan() && expected.is_nan())
                || (found - expected).abs() < 1e-18;
            assert!(same, "{kind:?} at {i}: {found:e}, not {expected:e}");
        }
        assert_eq!(reading.sequence, i as u32, "{kind:?}");
    }
}

#[test]
fn each_fault_shows_what_it_says() {
    use FaultKind::*;
    let x = |i: usize, x: f64| V2::new(x, position(i).y);
    check(Nan, Axis::X, |i| x(i, f64::NAN));
    check(Infinity, Axis::Both, |_| V2::repeat(f64::INFINITY));
    check(Zero, Axis::Y, |i| V2::new(position(i).x, 0.0));
    check(Rail, Axis::X, |i| x(i, 1e-3));
    check(Stuck, Axis::X, |i| x(i, position(9).x));
    check(Offset(3e-5), Axis::X, |i| x(i, position(i).x + 3e-5));
    check(Gain(0.5), Axis::Both, |i| 0.5 * position(i));
    check(Inverted, Axis::X, |i| x(i, -position(i).x));
    check(Swapped, Axis::Both, |i| {
        V2::new(position(i).y, position(i).x)
    });
    check(Delay(3), Axis::Both, |i| position(i - 3));
    let step = 2e-3 / 64.0;
    check(Bits(6), Axis::Both, |i| {
        position(i).map(|x| (x / step).round() * step)
    });
    let oscillation = Oscillation {
        frequency_hz: 300.0,
        amplitude_m: 2e-5,
    };
    check(oscillation, Axis::X, |i| {
        let phase = TAU * 300.0 * (i as f64 * PERIOD_S - 10.0 * PERIOD_S);
        x(i, position(i).x + 2e-5 * phase.sin())
    });
}

#[test]
fn a_dropout_repeats_the_sample_with_its_number() {
    let readings = read(SensorParams::default(), FaultKind::Dropout, Axis::Both);
    for (i, reading) in readings.iter().enumerate() {
        let (sequence, position_m) = match i {
            0..10 => (i, position(i)),
            10..20 => (9, position(9)),
            _ => (i - 10, position(i)),
        };
        assert_eq!(reading.sequence, sequence as u32);
        assert_eq!(reading.position_m, position_m);
    }
}

/// Faults draw from a stream of their own: the noise around them is that of a run without.
#[test]
fn chance_follows_the_seed_and_leaves_the_noise_alone() {
    let params = SensorParams {
        noise_rms_m: 1e-6,
        ..SensorParams::default()
    };
    let spikes = FaultKind::Spikes {
        rate_hz: 0.5 / PERIOD_S,
        size_m: 1e-4,
    };
    let quiet = read(params, FaultKind::Offset(0.0), Axis::Both);
    let spiked = read(params, spikes, Axis::Both);
    assert_eq!(spiked, read(params, spikes, Axis::Both));
    let mut seen = [0; 3];
    for (i, (a, b)) in quiet.iter().zip(&spiked).enumerate() {
        let jump = (b.position_m - a.position_m) / 1e-4;
        for x in jump.iter() {
            assert!((x - x.round()).abs() < 1e-12 && x.abs() < 1.1);
            assert!((10..20).contains(&i) || *x == 0.0);
            if (10..20).contains(&i) {
                seen[(x.round() + 1.0) as usize] += 1;
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 0), "{seen:?}");
    let loud = read(params, FaultKind::Noise(5.0), Axis::X);
    for (i, (a, b)) in quiet.iter().zip(&loud).enumerate() {
        let (a, b) = (a.position_m - position(i), b.position_m - position(i));
        let factor = if (10..20).contains(&i) { 5.0 } else { 1.0 };
        assert!((b.x - factor * a.x).abs() < 1e-15 && b.y == a.y);
    }
}

#[test]
fn a_sensor_has_gain_offset_delay_range_and_wrong_wires() {
    let params = SensorParams {
        offset_m: V2::new(1e-6, 2e-6),
        gain: V2::new(2.0, 0.5),
        delay_samples: 2,
        swapped: true,
        range_m: Some(2e-4),
        ..SensorParams::default()
    };
    let mut sensor = Sensor::new(params, &[], PERIOD_S, 0);
    for i in 0..40 {
        let reading = sensor.read(i as f64 * PERIOD_S, position(i), 0.0);
        let old = position(i.max(2) - 2);
        let expected = V2::new(2.0 * old.y + 1e-6, 0.5 * old.x + 2e-6);
        let expected = expected.map(|x| x.clamp(-2e-4, 2e-4));
        assert!((reading.position_m - expected).norm() < 1e-18, "{i}");
    }
}

/// Every policy takes every fault: the run ends with a verdict, and the same one each time.
#[test]
fn every_policy_survives_every_fault() {
    use FaultKind::*;
    let signal = [Nan, Infinity, Zero, Rail, Stuck, Inverted, Swapped];
    let mut scene = scene("overload_then_release");
    scene.duration_s = 0.05;
    for kind in signal.into_iter().chain([Dropout, Delay(20), Bits(4)]) {
        scene.planes[0].faults = vec![Fault {
            start_s: 0.022,
            duration_s: 0.004,
            kind,
            axis: Axis::Both,
        }];
        scene.planes[0].sensor.range_m = Some(5e-4);
        for policy in PolicyKind::ALL {
            let [a, b] = [(); 2].map(|()| ridden(&scene, policy).1.rows);
            assert!(a.iter().zip(&b).all(|(a, b)| a.plant == b.plant));
            let mut forces = a.iter().flat_map(|row| row.commanded_n.iter());
            let finite = forces.all(|x| x.is_finite());
            assert!(finite, "{kind:?}, {}", policy.name());
        }
    }
}

/// The spin is reported as unknown, or a wrong one is.
#[test]
fn the_spin_that_is_seen_matters() {
    let mut scene = scene("overload_then_release");
    scene.duration_s = 0.04;
    let commands = |scene: &_| -> Vec<V2> {
        let trace = ridden(scene, PolicyKind::Supervisor).1;
        trace.rows.iter().map(|r| r.commanded_n).collect()
    };
    let known = commands(&scene);
    scene.spin_sensor.gain = -1.0;
    let reversed = commands(&scene);
    scene.spin_sensor.valid = false;
    let unknown = commands(&scene);
    assert!(known != reversed && known != unknown);
    scene.spin_sensor.gain = 1.0;
    assert_eq!(commands(&scene), unknown, "an unknown spin has no sign");
}
