//! The linear loop of a scene against runs of it.

use firmware_bench::run::closed_loop::{Keep, RunError, run};
use firmware_bench::run::trace::TraceRow;
use firmware_bench::scene::Scene;
use firmware_bench::scene::linear_loop::{LinearLoop, Zone, is_stable};
use firmware_bench::scene::policy_kind::PolicyKind;
use nalgebra::Complex;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng as _, SeedableRng};
use std::f64::consts::TAU;
use system_tests::scene_path;

const CLEARANCE_M: f64 = 2e-4;

/// A rotor that tilts and bends once, in two magnets with gains of their own, without loads and without unbalance.
fn drawn(chance: &mut ChaCha8Rng) -> String {
    let mut of = |low: f64, high: f64| {
        let share = (chance.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        low + share * (high - low)
    };
    let mass_kg = 5.0 * 16_f64.powf(of(0.0, 1.0));
    let half_m = of(0.1, 0.4);
    let transverse = mass_kg * half_m * half_m * of(0.3, 1.5);
    let polar = transverse * of(0.05, 1.6);
    let pull_n_m = mass_kg * (TAU * of(5.0, 40.0)).powi(2) / 2.0;
    let crossover = TAU * of(25.0, 110.0);
    let gain = pull_n_m + mass_kg / 2.0 * crossover * crossover;
    let damper = of(0.1, 1.2) * mass_kg * crossover / 2.0;
    let bend = of(0.5, 2.0);
    let ends: [f64; 2] = [of(-1.2, -0.4), of(-1.2, -0.4)];
    let mut text = format!(
        r#"
title = "drawn"
[run]
duration_s = 5.0
sample_rate_hz = 10000
policies = ["levitation"]
seed = 1
[rotor]
mass_kg = {mass_kg}
transverse_inertia_kg_m2 = {transverse}
polar_inertia_kg_m2 = {polar}
[[rotor.bending]]
frequency_hz = {bending_hz}
damping_ratio = {ratio}
positions_m = [{a}, 0.0, {b}]
displacements = [{end_a}, {bend}, {end_b}]
[spin]
frequency_hz = {spin_hz}
[contact]
clearance_m = {CLEARANCE_M}
stiffness_n_m = 1e8
restitution = 0.6
[friction]
coefficient = 0.1
[magnet]
force_max_n = {cap_n}
lag_s = {lag_s}
delay_samples = {delay}
negative_stiffness_n_m = {pull_n_m}
[levitation]
proportional_n_m = {gain}
integral_n_m_s = {integral}
derivative_n_s_m = {damper}
derivative_filter_s = {filter_s}
"#,
        bending_hz = of(150.0, 900.0),
        ratio = of(0.001, 0.01),
        a = -1.3 * half_m,
        b = 1.3 * half_m,
        end_a = bend * ends[0],
        end_b = bend * ends[1],
        spin_hz = of(0.0, 250.0),
        // Far beyond what is asked for: what grows goes on to the wall and does not swing about a cap.
        cap_n = 1e5 * mass_kg,
        lag_s = of(3e-5, 3e-4),
        delay = of(1.0, 3.99) as u32,
        integral = gain * of(0.0, 10.0),
        filter_s = of(0.0, 2e-4),
    );
    for (name, side) in [("A", -1.0), ("B", 1.0)] {
        let place = half_m * of(0.8, 1.1);
        text += &format!(
            r#"
[[plane]]
name = "{name}"
position_m = {at}
contact_radius_m = 0.03
start_velocity_m_s = [{vx}, {vy}]
[plane.sensor]
position_m = {sensor}
delay_samples = {delay}
"#,
            at = side * place,
            vx = of(-1e-4, 1e-4),
            vy = of(-1e-4, 1e-4),
            sensor = side * (place - of(-0.03, 0.05)),
            delay = of(0.0, 1.99) as u32,
        );
    }
    text
}

/// Farthest from the middle between two times, as shares of the run.
fn farthest(rows: &[TraceRow], from: f64, to: f64) -> f64 {
    let at = |share: f64| (share * rows.len() as f64) as usize;
    let sizes = rows[at(from)..at(to)].iter();
    sizes
        .map(|row| row.plant.position_m.norm())
        .fold(0.0, f64::max)
}

/// What the linear loop says of stability is what five seconds show.
#[test]
fn what_is_called_stable_decays() {
    let mut chance = ChaCha8Rng::seed_from_u64(60);
    let mut counts = [0; 2];
    for i in 0..60 {
        let text = drawn(&mut chance);
        let scene = Scene::parse("drawn.toml", &text).unwrap();
        let modes = LinearLoop::new(&scene, scene.start.spin_rad_s)
            .and_then(|closed| closed.modes())
            .unwrap();
        let growth = modes
            .iter()
            .map(|mode| mode.growth_s)
            .fold(f64::MIN, f64::max);
        let stable = is_stable(&modes);
        let warned = scene.warnings.iter().any(|w| {
            w.contains("makes a loop that is not stable") || w.contains("does not hold the rotor")
        });
        assert_eq!(warned, !stable, "{:?}", scene.warnings);
        // What grows without a cap comes to the wall, or so far beyond that the run ends.
        let decays = match run(&scene, PolicyKind::Levitation, Keep::Trace, &mut |_| {}) {
            Err(RunError::Plant { .. } | RunError::Energy { .. }) => false,
            Err(error) => panic!("{error}"),
            Ok((_, trace)) => {
                let [all, before, last] = [(0.0, 1.0), (0.4, 0.7), (0.7, 1.0)]
                    .map(|(from, to)| farthest(&trace.rows, from, to));
                all < 0.5 * CLEARANCE_M && (last < before || last < 1e-6 * all)
            }
        };
        // Within a tenth of a hundredth of the border a run says nothing.
        if growth.abs() > 0.02 {
            assert_eq!(decays, stable, "{i}: {growth}\n{text}");
            counts[usize::from(stable)] += 1;
        }
    }
    assert!(counts.iter().all(|count| *count > 15), "{counts:?}");
}

/// A flexible rotor in two magnets, without noise, weight or loads, its readings a sample old.
fn quiet() -> String {
    let text = std::fs::read_to_string(scene_path("one_machine/flexible")).unwrap();
    text.split("[[disturbance]]")
        .next()
        .unwrap()
        .replace("noise_rms_m = 1e-6", "delay_samples = 1")
        .replace("feed_forward_weight = true", "")
        .replace("gravity_m_s2 = [0.0, -9.81]", "")
        .replace("duration_s = 0.3", "duration_s = 0.6")
}

/// The response to the unbalance is that of a run.
#[test]
fn an_unbalance_moves_the_rotor_so_far() {
    let text = quiet() + "[[unbalance]]\nposition_m = 0.3\nmoment_kg_m = 1e-4\n";
    let scene = Scene::parse("unbalanced.toml", &text).unwrap();
    let spin_rad_s = scene.start.spin_rad_s;
    let closed = LinearLoop::new(&scene, spin_rad_s).unwrap();
    let [planes_m, _] = closed.unbalance_response_m(spin_rad_s).unwrap();
    let (_, trace) = run(&scene, PolicyKind::Levitation, Keep::Trace, &mut |_| {}).unwrap();
    let found_m = farthest(&trace.rows, 0.8, 1.0);
    assert!(found_m > 1e-6 && found_m < 0.5 * CLEARANCE_M, "{found_m}");
    assert!(
        (found_m / planes_m[0] - 1.0).abs() < 0.005,
        "{found_m} {planes_m:?}"
    );
}

/// The sensitivity is what a sine on a reading makes of the reading.
#[test]
fn sensitivity_is_that_of_a_sine_on_a_reading() {
    let quiet = quiet();
    let scene = Scene::parse("quiet.toml", &quiet).unwrap();
    let closed = LinearLoop::new(&scene, scene.start.spin_rad_s).unwrap();
    let modes = closed.modes().unwrap();
    assert!(is_stable(&modes));
    let peaks = closed.sensitivity_peaks(&modes);
    assert_eq!(peaks.len(), 4);
    let peak = &peaks[0];
    assert_eq!(
        (peak.axis.as_str(), peak.zone),
        ("far end x", Zone::of(peak.peak))
    );
    // Of the first reading, at frequencies that fit the second half of the run.
    let fitting = |hz: f64| (hz * 0.3).round() / 0.3;
    let mut most: f64 = 0.0;
    for hz in [
        20.0,
        60.0,
        0.9 * peak.frequency_hz,
        peak.frequency_hz,
        1.1 * peak.frequency_hz,
        420.0,
        1500.0,
    ] {
        let hz = fitting(hz);
        let amplitude_m = 1e-6;
        let fault = format!(
            "[[plane.fault]]\nkind = \"oscillation\"\naxis = \"x\"\nstart_s = 0.0\nduration_s = 1.0\nfrequency_hz = {hz}\namplitude_m = {amplitude_m}\n"
        );
        let other = "[[plane]]\nname = \"coupling end\"";
        let shaken = quiet.replace(other, &(fault + other));
        let scene = Scene::parse("shaken.toml", &shaken).unwrap();
        let (_, trace) = run(&scene, PolicyKind::Levitation, Keep::Trace, &mut |_| {}).unwrap();
        let rows: Vec<&TraceRow> = trace.rows.iter().filter(|row| !row.mode_change).collect();
        let count = (0.3 * scene.sample_rate_hz).round() as usize;
        let first = 6000;
        let sum: Complex<f64> = (first..first + count)
            .map(|k| {
                let t_s = k as f64 / scene.sample_rate_hz;
                Complex::from_polar(rows[k].measured_m.x, -TAU * hz * t_s)
            })
            .sum();
        let found = 2.0 * sum.norm() / count as f64 / amplitude_m;
        let linear = closed.sensitivities(&[hz])[0][0];
        most = most.max(found);
        assert!(
            (found / linear - 1.0).abs() < 0.02,
            "{hz} Hz: {found} {linear}"
        );
    }
    assert!(
        (most / peak.peak - 1.0).abs() < 0.02,
        "{most} {}",
        peak.peak
    );
}
