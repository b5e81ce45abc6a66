//! Where the supervisor's damping ends: the linear analysis against the core itself.

use super::noise::machine;
use super::shaken::{
    Path, Shake, after_a_touch, after_an_approach, engaged_for_long, shaken, whole,
};
use super::{advice, amb};
use firmware_bench::advise::SmallSignals;
use firmware_bench::scene::suggest::Nominal;
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use std::f64::consts::TAU;
use supervisor::{Config, Mode};

/// Speed of a vibration that is small \[lift-off speeds\].
const SMALL: f64 = 3e-4;

/// Damping of a small vibration by the core, off the axes, and the mode in which it was.
fn measured(config: &Config, path: Path, hz: f64, spin_hz: Option<f64>) -> (f64, Vec<Mode>) {
    let unit_s = f64::from(config.scaling().time_s);
    let shake = Shake {
        hz,
        amplitude: SMALL / (TAU * hz * unit_s),
        along: [0.6, 0.8],
        spin_hz,
    };
    let done = shaken(config, path, shake);
    (done.damping_n_s_m, done.modes)
}

/// Largest difference of analysis and core over half the rate of the loop, in shares of the largest damping or driving there is.
fn largest_difference(config: &Config, path: Path, mode: Mode) -> f64 {
    let analysis = SmallSignals::new(config);
    let lines: Vec<[f64; 2]> = (0..12)
        .map(|i| whole(0.95 * analysis.nyquist_hz() * 0.65_f64.powi(i)))
        .map(|hz| {
            let (by_core, modes) = measured(config, path, hz, None);
            assert_eq!(modes, [mode], "{hz} Hz: {config:?}");
            [analysis.damping_n_s_m(hz).unwrap(), by_core]
        })
        .collect();
    let largest = lines.iter().map(|[a, _]| a.abs()).fold(0.0, f64::max);
    let apart = lines
        .iter()
        .map(|[a, b]| (a - b).abs() / (0.3 * largest).max(a.abs()));
    apart.fold(0.0, f64::max)
}

/// In Bounce and in Approach; with no lag, much delay, leverage, damping, a shaft, and forces so late that the load is
/// carried beside the restoring force.
#[test]
fn the_analysis_is_what_the_core_does() {
    let late = Nominal {
        mass_kg: 1.0,
        contact_mass_kg: 1.0,
        lag_s: 4e-4,
        stiffness_n_m: -1e5,
        ..amb()
    };
    let on_a_shaft = Nominal {
        delay_samples: 3,
        damping_n_s_m: 500.0,
        stiffness_n_m: 8e5,
        ..amb()
    };
    let at_once = Nominal {
        lag_s: 0.0,
        delay_samples: 0,
        ..amb()
    };
    let slow = Nominal {
        sample_rate_hz: 10e3,
        ..amb()
    };
    for n in [amb(), slow, late, on_a_shaft, at_once] {
        let mut config = engaged_for_long(&n);
        for leverage in [[1.0, 1.0], [0.8, 1.3]] {
            [config.retainer_plane_ratio, config.magnet_plane_ratio] = leverage;
            for (path, mode) in [
                (after_a_touch as Path, Mode::Bounce),
                (after_an_approach, Mode::Approach),
            ] {
                let apart = largest_difference(&config, path, mode);
                assert!(apart < 0.01, "{mode:?}, {apart}: {n:?}");
            }
        }
    }
}

/// What swings at a configured frequency is kept apart as the analysis has it: one mode or two, close and far.
///
/// Requirement: SR-41
#[test]
fn the_analysis_holds_with_bending_told() {
    let slow = Nominal {
        sample_rate_hz: 10e3,
        ..amb()
    };
    let mut driven = 0;
    for n in [amb(), slow] {
        let rigid = engaged_for_long(&n);
        for modes_hz in [
            [1300.0, 0.0],
            [0.0, 1300.0],
            [900.0, 2000.0],
            [1200.0, 1300.0],
        ] {
            let mut config = rigid;
            [config.bending_first_hz, config.bending_second_hz] = modes_hz;
            assert!(
                modes_hz.iter().any(|hz| config.keeps_apart(*hz)),
                "{modes_hz:?}"
            );
            let apart = largest_difference(&config, after_a_touch, Mode::Bounce);
            assert!(apart < 0.01, "{modes_hz:?}, {apart}: {n:?}");
            // Near where it was driven most it is hardly felt, or damped.
            let hz = f64::from(modes_hz[0].max(modes_hz[1]));
            let [before, now] =
                [&rigid, &config].map(|config| measured(config, after_a_touch, whole(hz), None).0);
            let most = SmallSignals::new(&rigid).crossover().unwrap().driving_n_s_m;
            if before < -0.5 * most {
                driven += 1;
                assert!(now > before / 3.0, "{modes_hz:?}: {before}, {now}");
            }
        }
    }
    assert!(driven >= 6, "{driven}");
}

/// What is slower than the observer's own motion, or faster than half the rate, is not kept apart.
#[test]
fn what_cannot_be_kept_apart_has_no_effect() {
    let rigid = engaged_for_long(&amb());
    for hz in [0.0, 100.0, 500.0, 9_950.0, 1e5] {
        assert!(!rigid.keeps_apart(hz), "{hz}");
        let configured = Config {
            bending_first_hz: hz,
            ..rigid
        };
        let [before, now] =
            [&rigid, &configured].map(|config| measured(config, after_a_touch, 1300.0, None).0);
        assert_eq!(before.to_bits(), now.to_bits(), "{hz}");
    }
    assert!(
        [800.0, 3000.0, 9_000.0]
            .iter()
            .all(|hz| rigid.keeps_apart(*hz))
    );
}

/// Machines of all kinds.
#[test]
fn the_analysis_holds_on_machines_drawn_at_random() {
    let mut chance = ChaCha8Rng::seed_from_u64(2);
    for i in 0..60 {
        let mut n = machine(&mut chance);
        // Whole ticks in what is measured.
        n.sample_rate_hz = (n.sample_rate_hz / 100.0).round() * 100.0;
        let apart = largest_difference(&engaged_for_long(&n), after_a_touch, Mode::Bounce);
        assert!(apart < 0.01, "machine {i}, {apart}: {n:?}");
    }
}

/// Rate \[Hz\], lag \[s\] and sensor noise \[m\] of the machine of the theory chapter; the crossover that closed loops showed \[Hz\],
/// in steps of some ten hertz.
const SHOWN: [[f64; 4]; 6] = [
    [10e3, 1.6e-4, 1e-6, 630.0],
    [20e3, 1.6e-4, 3e-6, 575.0],
    [20e3, 1.6e-4, 1e-6, 800.0],
    [20e3, 1.6e-4, 3e-7, 1060.0],
    [20e3, 5e-5, 1e-6, 1100.0],
    [50e3, 5e-5, 1e-6, 1500.0],
];

/// The machine of a row.
fn of_row([sample_rate_hz, lag_s, noise_rms_m, _]: [f64; 4]) -> Nominal {
    Nominal {
        sample_rate_hz,
        lag_s,
        noise_rms_m,
        ..amb()
    }
}

/// And on either side of it the core does what is said.
#[test]
fn the_crossover_is_where_closed_loops_showed_it() {
    for row in SHOWN {
        let (n, shown_hz) = (of_row(row), row[3]);
        let vibration = advice(&n).vibration;
        let hz = vibration.crossover_hz.unwrap();
        assert!((hz / shown_hz - 1.0).abs() < 0.05, "{hz}, shown {shown_hz}");
        let config = engaged_for_long(&n);
        let damping = |hz: f64| measured(&config, after_a_touch, hz, None).0;
        assert!(damping(0.96 * hz) > 0.0 && damping(1.04 * hz) < 0.0, "{hz}");
        let most = vibration.driving_n_s_m.unwrap();
        let there = -damping(vibration.driving_hz.unwrap());
        assert!((there / most - 1.0).abs() < 0.01, "{there}, said {most}");
        assert!((8e3..1.2e4).contains(&most), "{most}");
    }
}

/// With a known spin the observer takes what turns with it for an unbalance: the crossover hardly moves, and next to the spin
/// there is more damping than is said.
#[test]
fn a_known_spin_moves_the_crossover_by_little() {
    for row in SHOWN {
        let config = engaged_for_long(&of_row(row));
        let analysis = SmallSignals::new(&config);
        let hz = analysis.crossover().unwrap().frequency_hz;
        for spin_hz in [200.0, -200.0, 500.0] {
            let damping = |hz: f64| measured(&config, after_a_touch, hz, Some(spin_hz)).0;
            assert!(
                damping(0.96 * hz) > 0.0 && damping(1.04 * hz) < 0.0,
                "{hz}, {spin_hz}"
            );
            let same_hz = spin_hz.abs();
            let value = analysis.damping_n_s_m(same_hz).unwrap();
            assert!(damping(same_hz) > 0.99 * value, "{spin_hz}: {value}");
        }
    }
}
