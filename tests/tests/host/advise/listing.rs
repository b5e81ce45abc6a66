//! The suggested configuration as it is written in firmware.

use super::{AMB, advise, amb};
use firmware_bench::scene::suggest::suggested;
use supervisor::{Bearing, Config, PARAMETERS};
use system_tests::ran::{Folder, edited, flat, has, lacks, scene_text};
use system_tests::root;

/// The fields of a `Config` as Rust writes it.
fn fields(source: &str) -> Vec<(String, f32)> {
    let field = |line: &str| {
        let (name, rest) = line.split_once(':')?;
        let value = rest.split(',').next()?.trim().parse().ok()?;
        Some((name.trim_start_matches("//!").trim().to_owned(), value))
    };
    source.lines().filter_map(field).collect()
}

/// What nine numbers and what is behind them make, as Rust has it.
fn first_configuration(source: &str) -> Config {
    let (_, rest) = source.split_once("Bearing = ").unwrap();
    let (given, rest) = rest.split_once("};").unwrap();
    let given = fields(given);
    let names: Vec<&str> = given.iter().map(|(name, _)| name.as_str()).collect();
    let number = |name: &str| {
        let at = names.iter().position(|n| *n == name);
        given[at.unwrap_or_else(|| panic!("{name}: {names:?}"))].1
    };
    assert_eq!(given.len(), 9, "{names:?}");
    let follows = Config::for_bearing(&Bearing {
        sample_period_s: number("sample_period_s"),
        mass_kg: number("mass_kg"),
        stiffness_n_m: number("stiffness_n_m"),
        clearance_m: number("clearance_m"),
        force_max_n: number("force_max_n"),
        amplifier_lag_s: number("amplifier_lag_s"),
        friction_coefficient: number("friction_coefficient"),
        contact_stiffness_n_m: number("contact_stiffness_n_m"),
        sensor_noise_m: number("sensor_noise_m"),
    });
    let (_, otherwise) = rest.split_once("CONFIG").unwrap();
    let (otherwise, _) = otherwise.split_once(";\n").unwrap();
    assert!(otherwise.contains("Config::for_bearing(&BEARING)"));
    let otherwise = fields(otherwise);
    let mut values = follows.values();
    for (name, value) in otherwise {
        let index = PARAMETERS.iter().position(|p| p.name == name).unwrap();
        assert_ne!(values[index], value, "{name} follows");
        values[index] = value;
    }
    Config::from_values(values)
}

/// Fields of a configuration, by name.
fn named(config: &Config) -> Vec<(String, f32)> {
    let values = PARAMETERS.iter().zip(config.values());
    values
        .map(|(p, value)| (p.name.to_owned(), value))
        .collect()
}

/// What Rust takes is what the table for a scene says, and what the book shows is the example of the crate, and that is what is advised: but
/// for the drive's own limits, and how it is cooled.
#[test]
fn a_listing_for_rust_is_the_suggested_configuration() {
    let advised = |more: &str| advise(&format!("{AMB} {more}")).good();
    let config = suggested(&amb()).config;
    // A machine has to confirm what a simulated one is made of.
    let of_firmware = Config {
        check_first: 1.0,
        ..config
    };
    assert_eq!(fields(&advised("--format rust")), named(&of_firmware));
    let table = advised("--format toml");
    // For a person the same, with long comments broken: still a table of a scene.
    let words = |text: &str| -> Vec<String> {
        let words = text.split_whitespace().filter(|word| *word != "#");
        words.map(str::to_owned).collect()
    };
    let page = advised("");
    let (_, shown) = page.split_once("[supervisor]\n").unwrap();
    assert_eq!(words(&format!("[supervisor]\n{shown}")), words(&table));
    let parsed = |text: &str| text.parse::<toml::Table>().unwrap();
    let of_table = parsed(&table)["supervisor"].as_table().unwrap().clone();
    assert_eq!(parsed(shown), of_table);

    let own = ["force_slew_n_s", "continuous_force_n", "thermal_time_s"];
    for (shown, (name, value)) in Config::example().values().iter().zip(named(&config)) {
        let same = *shown == value || own.contains(&name.as_str());
        assert!(same, "{name} = {value}");
    }
    let page = std::fs::read_to_string(root().join("docs/src/supervisor/parameters.md")).unwrap();
    let of_page = Config {
        check_first: 0.0,
        ..first_configuration(&page)
    };
    assert_eq!(of_page, Config::example());
}

/// Nine numbers and what does not follow from them are the whole configuration, and nothing that follows is repeated.
#[test]
fn a_short_listing_makes_the_same_configuration() {
    let folder = Folder::fresh();
    let own = "\n[supervisor]\nhold_share = 0.625\nmass_kg = 9.0\n";
    folder.put("own.toml", scene_text("overload_then_release") + own);
    let noise = [("--noise-rms-m=1e-6", "--noise-rms-m=2e-7 --quantum-m=3e-6")];
    for of in [AMB, &edited(AMB, &noise), "@plants/p4", "own.toml"] {
        let said = |more: &str| {
            folder
                .ran(&format!("advise {of} --format rust {more}"))
                .good()
        };
        let (all, short) = (said(""), said("--short"));
        assert!(all.is_ascii() && short.is_ascii(), "{all}\n{short}");
        assert_eq!(fields(&all), named(&first_configuration(&short)));
    }
}

/// What a scene sets itself is in the listing, also where it does not run the supervisor, and warnings go beside it.
#[test]
fn a_listing_has_what_the_scene_sets() {
    let folder = Folder::fresh();
    let all = "policies = [\"passive\", \"radial\", \"levitation\", \"supervisor\"]";
    let passive = [(all, "policies = [\"passive\"]")];
    let own = edited(&scene_text("overload_then_release"), &passive);
    folder.put("own.toml", own + "\n[supervisor]\nhold_share = 0.625\n");
    for (language, line) in [
        ("toml", "hold_share = 0.625 "),
        ("rust", "hold_share: 0.625, "),
        ("c", "0.625f,           /* AMB_P_HOLD_SHARE: "),
    ] {
        let ran = folder.ran(&format!("advise own.toml --format {language}"));
        has(&ran.printed, &[line, "suggested 0.8"]);
        lacks(&ran.printed, &["lag_drives"]);
        has(&flat(&ran.said), &["warning: lag_drives"]);
    }
}

/// The stiffness of a contact that hardens is derived from its law, and nobody reads that it was given.
#[test]
fn the_tangent_of_a_hardening_contact_is_said_to_be_one() {
    let folder = Folder::fresh();
    let law = "stiffness_n_mn = 1e13\nrestitution_speed_m_s = 0.3";
    let hardening = [("stiffness_n_m = 1e9", law)];
    folder.scene("hardening.toml", "overload_then_release", &hardening);
    for more in ["", "--format rust", "--format c"] {
        let ran = folder.ran(&format!("advise hardening.toml {more}"));
        let text = ran.printed.to_lowercase();
        let line = text.lines().find(|l| l.contains("contact_stiffness_n_m"));
        has(
            line.unwrap_or(&text),
            &["tangent at a depth of one clearance"],
        );
    }
}
