//! `advise`: closed forms, the suggested configuration, warnings, and the command line.

mod command;
mod crossover;
mod keys;
mod listing;
mod noise;
mod parameters;
mod rotor;
mod shaken;
mod vibration;
mod warnings;

use firmware_bench::advise::Advice;
use firmware_bench::scene::suggest::Nominal;
use std::f64::consts::TAU;
use system_tests::ran::{Folder, Ran, has};
use system_tests::scene;

/// The AMB rotor of the theory chapter: 10 kg, −2e5 N/m, 0.2 mm, 1000 N, a 1 kHz amplifier, 20 kHz.
fn amb() -> Nominal {
    Nominal {
        sample_rate_hz: 20e3,
        mass_kg: 10.0,
        stiffness_n_m: -2e5,
        damping_n_s_m: 0.0,
        clearance_m: 2e-4,
        contact_stiffness_n_m: 1e9,
        contact_hardens: false,
        contact_mass_kg: 10.0,
        restitution: Some(0.7),
        friction_coefficient: 0.15,
        rolling_coefficient: 0.0,
        force_max_n: 1000.0,
        axis_force_max_n: None,
        slew_n_s: None,
        lag_s: 1.6e-4,
        delay_samples: 1,
        noise_rms_m: 1e-6,
        quantum_m: 0.0,
        range_m: None,
        load_n: 0.0,
        centre_offset_m: 0.0,
        spin_hz: None,
        runout_m: None,
        retainer_plane_ratio: 1.0,
        magnet_plane_ratio: 1.0,
    }
}

const AMB: &str = "--mass-kg=10 --clearance-m=2e-4 --friction=0.15 --stiffness-n-m=-2e5 --contact-stiffness-n-m=1e9 \
    --restitution=0.7 --force-max-n=1000 --lag-s=1.6e-4 --sample-rate-hz=20000 --noise-rms-m=1e-6";

fn advice(nominal: &Nominal) -> Advice {
    Advice::new("test", nominal, &[]).unwrap()
}

#[track_caller]
fn close(value: f64, by_hand: f64) {
    let off = value / by_hand - 1.0;
    assert!(off.abs() < 1e-6, "{value}, by hand {by_hand}");
}

fn advise(words: &str) -> Ran {
    Folder::fresh().ran(&format!("advise {words}"))
}

#[test]
fn closed_forms_of_a_known_plant() {
    let a = advice(&amb());
    assert_eq!(a.limits.passive_threshold_m_s, None);
    has(a.limits.passive_threshold_text, &["negative stiffness"]);
    close(a.limits.lift_off_m_s, (2e-4 * 960.0 / 10.0_f64).sqrt());
    // (4.12) on the orbit r = c + F/(μ·√(1 + μ²)·k_c).
    let tilt = (1.0 + 0.15_f64.powi(2)).sqrt();
    let r = 2e-4 + 1000.0 / (0.15 * tilt * 1e9);
    let limit = (r / (0.15 * 10.0) * (1000.0 * tilt - 0.15 * 2e5 * r)).sqrt();
    close(a.limits.whirl_limit_m_s.unwrap(), limit);
    let omega = limit / r;
    close(a.limits.whirl_limit_hz.unwrap(), omega / TAU);
    // Without damping (4.13) with v_lim for v_T, and longer by about the yielding of the wall, 3.3 % of r at v_lim.
    let time = r / (0.15 * limit) * 0.85_f64.atanh();
    let longer = a.limits.arrest_time_s.unwrap() / time;
    assert!((1.025..1.035).contains(&longer), "{longer}");

    let horizon = 50e-6 + 25e-6 + 160e-6;
    close(a.reaction.detect_to_force_s, horizon);
    close(a.reaction.worst_s, horizon + 50e-6);
    close(a.reaction.ways[1].way_m, 0.3 * horizon);
    let lag = a.lag.unwrap();
    let angle = omega * 75e-6 + (omega * 160e-6).atan();
    close(lag.angle_deg, angle.to_degrees());
    close(lag.friction_angle_deg, 8.530_765_609_948);

    let v = a.impact.unavoidable_m_s;
    let stopped = 2.0 * 100.0 * (2e-4 - v * horizon) - 2e5 * 4e-8 / 10.0;
    close(v * v, stopped);
    let k = 0.15 * 1.7 / 0.3;
    // The restitution is an f32.
    close(a.impact.bounce_gain, k);
    close(a.impact.all_bounces_m_s.unwrap() * k, limit);
    close(a.impact.first_m_s.unwrap() * 0.15 * 1.7, limit);
    let v = a.impact.first_compliant_m_s.unwrap();
    let soft = 1.0 + std::f64::consts::FRAC_PI_4 * v / 2e-4 * 1e-4;
    close(0.15 * 1.7 * v * soft, limit);
    assert_eq!(a.impact.passive_m_s, None);
    assert!(a.noise.tolerable && a.noise.share < 0.04);
}

/// The paper's onset rig has a threshold: 0.0579 m/s, and 0.082 m/s of radial impact without help.
#[test]
fn a_shaft_gives_a_threshold() {
    let scene = scene("impact_at_40_hz");
    let a = advice(&scene.planes[0].nominal);
    let threshold_m_s = a.limits.passive_threshold_m_s.unwrap();
    assert!((threshold_m_s - 0.0579).abs() < 5e-5);
    assert!((a.impact.passive_m_s.unwrap() - 0.082).abs() < 5e-4);
    assert_eq!(a.noise.reference_m_s, threshold_m_s);
}

/// Without friction nothing drives; with hardly any force nothing can be stopped.
#[test]
fn what_has_no_limit_says_why() {
    let a = advice(&Nominal {
        friction_coefficient: 0.0,
        ..amb()
    });
    assert!(a.limits.whirl_limit_text.contains("drives nothing"));
    assert!(a.limits.whirl_limit_m_s.is_none() && a.impact.first_m_s.is_none() && a.lag.is_none());
    let a = advice(&Nominal {
        force_max_n: 1.0,
        ..amb()
    });
    assert!(a.limits.whirl_limit_text.contains("more than the cap"));
    assert_eq!(a.limits.lift_off_m_s, 0.0);
    assert_eq!(a.impact.unavoidable_m_s, 0.0);
}

/// What is called the most noise and the least rate is tolerable, and a little worse is not.
#[test]
fn the_noise_asked_for_is_enough_and_needed() {
    let noise = advice(&amb()).noise;
    let most = noise.sensor_noise_most_m.unwrap();
    let least = noise.sample_rate_least_hz.unwrap();
    for (noise_rms_m, sample_rate_hz, good) in [
        (most, 20e3, true),
        (1.011 * most, 20e3, false),
        (1e-6, least, true),
        (1e-6, least / 1.011, false),
    ] {
        let n = Nominal {
            noise_rms_m,
            sample_rate_hz,
            ..amb()
        };
        assert_eq!(advice(&n).noise.tolerable, good, "{n:?}");
    }
}
