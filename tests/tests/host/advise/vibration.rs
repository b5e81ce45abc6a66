//! A vibration of the reading: the most that a force does to it, and how fast a runout may be.

use super::shaken::{
    Path, Shake, after_a_touch, after_an_approach, engaged_for_long, on_the_wall, round_the_wall,
    shaken,
};
use super::{AMB, advice, advise, amb};
use firmware_bench::advise::RUNOUT_SPEED_SHARE;
use firmware_bench::scene::suggest::{Nominal, suggested};
use std::f64::consts::TAU;
use supervisor::{Core, CoreSample, Mode, Prepared, Status};
use system_tests::ran::{has, lacks, list, number};

/// Whatever the mode, the size and the frequency: a force within the cap does at most 4·F·A of work in a cycle on a
/// vibration of amplitude A, F for each metre of its path. In flight it damps well below the crossover at any size, and drives
/// nowhere more than the small signals say.
#[test]
fn no_vibration_gets_more_work_than_the_cap_along_its_path() {
    let ways: [(Path, bool); 4] = [
        (after_a_touch, true),
        (after_an_approach, true),
        (on_the_wall, false),
        (round_the_wall, false),
    ];
    let (mut seen, mut most) = (vec![], 0.0_f64);
    for sample_rate_hz in [10e3, 20e3] {
        let n = Nominal {
            sample_rate_hz,
            ..amb()
        };
        let config = engaged_for_long(&n);
        let vibration = advice(&n).vibration;
        let (crossover_hz, driving) = (
            vibration.crossover_hz.unwrap(),
            vibration.driving_n_s_m.unwrap(),
        );
        for (path, flying) in ways {
            for along in [[1.0, 0.0], [0.6, -0.8]] {
                for amplitude in [1e-3, 1e-2, 0.03, 0.1, 0.3] {
                    for share in [0.3, 0.7, 1.1, 1.3, 1.7, 2.5, 3.5, 5.0] {
                        let hz = share * crossover_hz;
                        let shake = Shake {
                            hz,
                            amplitude,
                            along,
                            spin_hz: None,
                        };
                        let done = shaken(&config, path, shake);
                        if done.modes.contains(&Mode::Levitated) {
                            // An approach in a reading that is not believed any more.
                            continue;
                        }
                        let what = format!("{hz} Hz, {shake:?}, {done:?}");
                        let work = done.work / (4.0 * amplitude);
                        assert!(work.abs() <= 1.0, "{what}");
                        most = most.max(work);
                        if flying {
                            assert!(share > 1.0 || work < 0.0, "{what}");
                            assert!(done.damping_n_s_m > -1.05 * driving, "{what}");
                        }
                        seen.extend(done.modes);
                    }
                }
            }
        }
    }
    for mode in [
        Mode::Approach,
        Mode::Bounce,
        Mode::BackwardWhirl,
        Mode::Pinned,
    ] {
        assert!(seen.contains(&mode), "{mode:?}");
    }
    assert!(!seen.contains(&Mode::HandedBack) && !seen.contains(&Mode::SensorFault));
    // Not far from what is possible.
    assert!(most > 0.4, "{most}");
}

fn at_spin(spin_hz: f64) -> Nominal {
    Nominal {
        spin_hz: Some(spin_hz),
        ..amb()
    }
}

/// In which mode the core, after 0.2 s of a runout of this amplitude \[clearances\], takes over from a rotor that is led onto
/// the wall, if it does; and that it has not done so before.
fn takes_over(n: &Nominal, amplitude: f64, told: bool) -> Option<Mode> {
    let config = suggested(n).config;
    let unit_s = f64::from(config.scaling().time_s);
    let spin = TAU * n.spin_hz.unwrap();
    let mut core: Core<f64, 64> = Core::new(&Prepared::new(&config).unwrap());
    let mut tick = |i: u32, out: f64| {
        let at_s = f64::from(i) * n.period_s();
        let grown = (at_s / 0.1).min(1.0);
        let way = grown * amplitude * (spin * at_s).sin();
        // A coordinate that stands still is a stuck sensor.
        let dither = if i.is_multiple_of(2) { 1e-9 } else { -1e-9 };
        let known = if told {
            Status::SPIN_VALID
        } else {
            Status::empty()
        };
        let command = core.tick(&CoreSample {
            sequence: i,
            status: Status::BEARING_ON | known,
            // Of a controller that has no force to spare.
            levitation: [0.0, -0.9],
            position: [way + dither, out + dither],
            spin: spin * unit_s,
            ..CoreSample::default()
        });
        command.mode
    };
    let rest = (0.2 * n.sample_rate_hz) as u32;
    for i in 0..rest {
        assert_eq!(tick(i, 0.0), Mode::Levitated, "{amplitude}, {told}, {n:?}");
    }
    let out = (2.0 * unit_s * n.sample_rate_hz) as u32;
    let mut led = (1..=2 * out).map(|i| tick(rest + i, (f64::from(i) / f64::from(out)).min(1.03)));
    led.find(|mode| *mode != Mode::Levitated)
}

/// With a runout below the limit the supervisor helps before the touch, with one above it leaves the rotor to levitation
/// until it whirls; and takes none for an approach.
#[test]
fn a_runout_below_the_limit_leaves_the_help() {
    for sample_rate_hz in [10e3, 20e3, 50e3] {
        for noise_rms_m in [1e-6, 3e-6] {
            for spin_hz in [80.0, 120.0, 200.0, 360.0, 500.0] {
                let n = Nominal {
                    sample_rate_hz,
                    noise_rms_m,
                    ..at_spin(spin_hz)
                };
                let limit = advice(&n).vibration.runout_limit_m.unwrap() / n.clearance_m;
                for told in [false, true] {
                    let mode = takes_over(&n, 0.7 * limit, told);
                    let early = matches!(mode, Some(Mode::Approach | Mode::Bounce));
                    assert!(early, "{mode:?}, {told}, {n:?}");
                }
                if spin_hz < 400.0 {
                    let mode = takes_over(&n, 1.3 * limit, false);
                    assert!(matches!(mode, None | Some(Mode::BackwardWhirl)), "{n:?}");
                }
            }
        }
    }
}

/// Two fifths of √(F·c/m) at the spin, whichever way it turns, at most the clearance, and nothing where no spin is known.
#[test]
fn the_runout_limit_is_that_of_the_speed() {
    let limit = |n: &Nominal| advice(n).vibration.runout_limit_m;
    assert_eq!(limit(&amb()), None);
    assert_eq!(RUNOUT_SPEED_SHARE, 0.4);
    for spin_hz in [200.0, -200.0] {
        let by_hand = 0.4 * (1000.0 * 2e-4 / 10.0_f64).sqrt() / (TAU * 200.0);
        let limit_m = limit(&at_spin(spin_hz)).unwrap();
        assert!((limit_m / by_hand - 1.0).abs() < 1e-9, "{limit_m}");
    }
    for spin_hz in [0.0, 40.0] {
        assert_eq!(limit(&at_spin(spin_hz)), Some(2e-4));
    }
}

/// On the right side of the limit, with what to do.
#[test]
fn a_runout_beyond_the_limit_is_told() {
    let told = |n: Nominal, runout_m: Option<f64>| {
        let warnings = advice(&Nominal { runout_m, ..n }).warnings;
        warnings.into_iter().find(|w| w.key == "runout")
    };
    let limit_m = advice(&at_spin(200.0)).vibration.runout_limit_m.unwrap();
    for (n, runout_m, expected) in [
        (at_spin(200.0), None, false),
        (at_spin(200.0), Some(0.999 * limit_m), false),
        (at_spin(200.0), Some(1.001 * limit_m), true),
        (at_spin(-200.0), Some(1.001 * limit_m), true),
        (at_spin(10.0), Some(1.9e-4), false),
        (at_spin(10.0), Some(2.1e-4), true),
        (amb(), Some(1e-3), false),
    ] {
        assert_eq!(told(n, runout_m).is_some(), expected, "{runout_m:?}, {n:?}");
    }
    let warning = told(at_spin(200.0), Some(8e-5)).unwrap();
    has(&warning.text, &["80.0 µm at 200.0 Hz"]);
    has(&warning.remedy, &["subtract"]);
}

#[test]
fn text_and_json_say_where_damping_ends() {
    let with = |more: &str| advise(&format!("{AMB} {more}"));
    let plain = with("--json").json();
    let hz = number(&plain["crossover_hz"]);
    assert!((hz - 817.0).abs() < 1.0, "{hz}");
    assert!(number(&plain["driving_hz"]) > hz);
    assert!(number(&plain["driving_n_s_m"]) > 9e3);
    assert!(plain["runout_limit_m"].is_null() && plain["nominal"]["spin_hz"].is_null());
    let turning = with("--spin-hz=-200 --runout-m=9e-5 --json").json();
    let limit_m = number(&turning["runout_limit_m"]);
    assert!((limit_m - 4.502e-5).abs() < 1e-8, "{limit_m}");
    assert_eq!(turning["nominal"]["runout_m"], 9e-5);
    let mut warnings = list(&turning["warnings"]).iter();
    assert!(warnings.any(|w| w["key"] == "runout"), "{turning}");

    let text = with("--spin-hz=200").good();
    has(&text, &["817.0 Hz", "at most with 9490 N s/m"]);
    has(&text, &["most runout at 200.0 Hz", "45.0 µm"]);
    lacks(&with("").good(), &["most runout"]);
}

/// A scene has its spin; the runout is told beside it.
#[test]
fn a_runout_may_be_told_beside_a_scene() {
    let json = advise("@overload_then_release --json --runout-m=6e-5").json();
    assert_eq!(json["nominal"]["spin_hz"], 200.0);
    has(&json["warnings"].to_string(), &["\"runout\""]);
}
