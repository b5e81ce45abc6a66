//! What noise is said to need, on machines drawn at random: it must be enough, and no contradiction.

use super::{advice, amb};
use firmware_bench::advise::{Advice, Noise, Warning};
use firmware_bench::scene::Scene;
use firmware_bench::scene::nominal::Override;
use firmware_bench::scene::suggest::{Nominal, suggested};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use supervisor::PARAMETERS;
use system_tests::root;

/// A number between two, evenly by its logarithm.
fn between(chance: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    let share = f64::from(chance.next_u32()) / f64::from(u32::MAX);
    low * (high / low).powf(share)
}

/// A machine on a shaft or pulled by its magnets, with a sensor from good to useless.
pub(super) fn machine(chance: &mut ChaCha8Rng) -> Nominal {
    let mass_kg = between(chance, 0.3, 100.0);
    let clearance_m = between(chance, 1e-4, 5e-4);
    let force_max_n = mass_kg * between(chance, 20.0, 600.0);
    let pull_n_m = force_max_n / clearance_m * between(chance, 0.02, 0.5);
    let on_shaft = chance.next_u32().is_multiple_of(2);
    Nominal {
        mass_kg,
        contact_mass_kg: mass_kg,
        clearance_m,
        force_max_n,
        stiffness_n_m: if on_shaft { pull_n_m } else { -pull_n_m },
        damping_n_s_m: if on_shaft {
            between(chance, 0.1, 1e3)
        } else {
            0.0
        },
        friction_coefficient: between(chance, 0.06, 0.35),
        lag_s: between(chance, 2e-5, 5e-4),
        sample_rate_hz: between(chance, 5e3, 5e4),
        noise_rms_m: clearance_m * between(chance, 1e-4, 3e-2),
        ..amb()
    }
}

fn named(name: &str, value: f64) -> Override {
    let index = PARAMETERS.iter().position(|p| p.name == name).unwrap();
    (index, value as f32)
}

fn with(n: &Nominal, overrides: &[Override]) -> Advice {
    Advice::new("test", n, overrides).unwrap()
}

fn warning(advice: &Advice) -> Option<&Warning> {
    advice.warnings.iter().find(|w| w.key == "noise")
}

/// Number before a unit.
fn number_before(text: &str, unit: &str) -> Option<f64> {
    let before = text.split(unit).next().filter(|before| *before != text)?;
    before.split_whitespace().last()?.parse().ok()
}

fn noise_at(n: &Nominal, overrides: &[Override], noise_rms_m: f64) -> Noise {
    let n = Nominal {
        noise_rms_m,
        quantum_m: 0.0,
        ..*n
    };
    with(&n, overrides).noise
}

/// With suggested poles and with poles that are set: every sensor below the limit is tolerable, one that is not is
/// noisier than the limit, and whatever is said to be done helps.
#[test]
fn what_noise_needs_is_no_contradiction() {
    let mut chance = ChaCha8Rng::seed_from_u64(1);
    let (mut warned, mut by_pole, mut by_sensor, mut by_rate) = (0, 0, 0, 0);
    for i in 0..600 {
        let n = machine(&mut chance);
        let poles = match i % 3 {
            0 => vec![
                named("observer_pole_flight", between(&mut chance, 0.3, 0.98)),
                named("observer_pole_contact", between(&mut chance, 0.1, 0.98)),
            ],
            _ => vec![],
        };
        // Too slow a loop for its machine is refused.
        if suggested(&n).config.validate().is_err() {
            continue;
        }
        let a = with(&n, &poles);
        let what = format!("machine {i}: {n:?} {poles:?} {:?}", a.noise);
        if let Some(most_m) = a.noise.sensor_noise_most_m {
            assert!(a.noise.tolerable || most_m < n.noise_rms_m, "{what}");
            for _ in 0..20 {
                let quieter_m = most_m * between(&mut chance, 1e-3, 1.0);
                assert!(
                    noise_at(&n, &poles, quieter_m).tolerable,
                    "{quieter_m} of {what}"
                );
            }
        }
        if let Some(sample_rate_hz) = a.noise.sample_rate_least_hz {
            assert_eq!(
                a.noise.tolerable,
                sample_rate_hz <= n.sample_rate_hz,
                "{what}"
            );
            let other = Nominal {
                sample_rate_hz,
                ..n
            };
            assert!(with(&other, &poles).noise.tolerable, "{what}");
        }
        let Some(warning) = warning(&a) else {
            continue;
        };
        warned += 1;
        let remedy = &warning.remedy;
        if let Some(micrometres) = number_before(remedy, " µm") {
            by_sensor += 1;
            assert!(micrometres * 1e-6 < n.noise_rms_m, "{remedy} for {what}");
            assert!(
                noise_at(&n, &poles, micrometres * 1e-6).tolerable,
                "{remedy} for {what}"
            );
        }
        if let Some(kilohertz) = number_before(remedy, " kHz") {
            by_rate += 1;
            let sample_rate_hz = kilohertz * 1e3;
            assert!(sample_rate_hz > n.sample_rate_hz, "{remedy} for {what}");
            let other = Nominal {
                sample_rate_hz,
                ..n
            };
            assert!(with(&other, &poles).noise.tolerable, "{remedy} for {what}");
        }
        let mut set = poles.clone();
        for name in ["observer_pole_flight", "observer_pole_contact"] {
            if let Some((_, rest)) = remedy.split_once(&format!("{name} = ")) {
                let pole = rest.split([' ', ',']).next().unwrap().parse().unwrap();
                set.retain(|(index, _)| PARAMETERS[*index].name != name);
                set.push(named(name, pole));
            }
        }
        if set != poles {
            by_pole += 1;
            assert!(with(&n, &set).noise.tolerable, "{remedy} for {what}");
        }
    }
    let counts = [warned, by_pole, by_sensor, by_rate];
    assert!(counts.iter().all(|count| *count >= 20), "{counts:?}");
}

/// The example of the book: its threshold is far below what the suggested poles aim at.
#[test]
fn the_scene_of_the_book_is_told_a_slower_pole() {
    let page = std::fs::read_to_string(root().join("docs/src/host/scenes.md")).unwrap();
    let (_, rest) = page.split_once("```toml\n").unwrap();
    let text = rest.split_once("```").unwrap().0;
    let set = |more: &str| {
        let text = text.replacen("hold_share = 0.7", more, 1);
        let plane = Scene::parse("scenes.md", &text).unwrap().planes.remove(0);
        Advice::new("test", &plane.nominal, &plane.overrides).unwrap()
    };
    let a = set("");
    let remedy = &warning(&a).unwrap().remedy;
    let poles =
        "set observer_pole_flight = 0.71 and observer_pole_contact = 0.52, or at most 0.326 µm";
    assert!(remedy.starts_with(poles), "{remedy}");
    assert!(!remedy.contains("kHz"), "{remedy}");
    let a = set("observer_pole_flight = 0.71\nobserver_pole_contact = 0.52");
    assert!(a.noise.tolerable && warning(&a).is_none());
    // What is set is judged, also where the suggested pole would do.
    let quick = [named("observer_pole_flight", 0.1)];
    let a = with(&amb(), &quick);
    assert!(advice(&amb()).noise.tolerable && !a.noise.tolerable);
    let remedy = &warning(&a).unwrap().remedy;
    assert!(
        remedy.starts_with("set observer_pole_flight = "),
        "{remedy}"
    );
    assert!(!remedy.contains("observer_pole_contact"), "{remedy}");
    let slow = [named("observer_pole_flight", 0.98)];
    assert!(warning(&with(&amb(), &slow)).is_some());
}
