//! The suggested configuration as it is written in firmware.

use super::{AMB, advise, amb, stderr};
use firmware_bench::scene::suggest::suggested;
use supervisor::{Bearing, Config, PARAMETERS};
use system_tests::{root, scene_path};

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

/// What Rust takes is what the table for a scene says, and what the book shows is the example of the crate, and that is what is advised: but
/// for the drive's own limits, and how it is cooled.
#[test]
fn a_listing_for_rust_is_the_suggested_configuration() {
    let advised = |more: &[&str]| {
        let output = advise(&[&AMB[..], more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        String::from_utf8(output.stdout).unwrap()
    };
    let listing = advised(&["--format", "rust"]);
    let config = suggested(&amb()).config;
    // A machine has to confirm what a simulated one is made of.
    let of_firmware = Config {
        check_first: 1.0,
        ..config
    };
    let named = |config: &Config| -> Vec<(String, f32)> {
        let values = PARAMETERS.iter().zip(config.values());
        values
            .map(|(p, value)| (p.name.to_owned(), value))
            .collect()
    };
    let values = named(&config);
    assert_eq!(fields(&listing), named(&of_firmware));
    let table = advised(&["--format", "toml"]);
    // For a person the same, with long comments broken: still a table of a scene.
    let words = |text: &str| -> Vec<String> {
        let words = text.split_whitespace().filter(|word| *word != "#");
        words.map(str::to_owned).collect()
    };
    let page = advised(&[]);
    let (_, shown) = page.split_once("[supervisor]\n").unwrap();
    assert_eq!(words(&format!("[supervisor]\n{shown}")), words(&table));
    let parsed = |text: &str| text.parse::<toml::Table>().unwrap();
    assert_eq!(
        parsed(shown),
        parsed(&table)["supervisor"].as_table().unwrap().clone()
    );

    let own = ["force_slew_n_s", "continuous_force_n", "thermal_time_s"];
    for (shown, (name, value)) in Config::example().values().iter().zip(&values) {
        assert!(
            shown == value || own.contains(&name.as_str()),
            "{name} = {value}"
        );
    }
    let page = std::fs::read_to_string(root().join("docs/src/supervisor/parameters.md")).unwrap();
    let of_page = first_configuration(&page);
    assert_eq!(
        Config {
            check_first: 0.0,
            ..of_page
        },
        Config::example()
    );
}

/// Nine numbers and what does not follow from them are the whole configuration, and nothing that follows is repeated.
#[test]
fn a_short_listing_makes_the_same_configuration() {
    let folder = tempfile::TempDir::new().unwrap();
    let own = std::fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let path = folder.path().join("own.toml");
    std::fs::write(
        &path,
        own + "\n[supervisor]\nhold_share = 0.625\nmass_kg = 9.0\n",
    )
    .unwrap();
    let plant = root().join("firmware-host/scenes/plants/p4.toml");
    let plant = plant.to_str().unwrap();
    let noisy = [&AMB[..9], &["--noise-rms-m=2e-7", "--quantum-m=3e-6"]].concat();
    for args in [&AMB[..], &noisy, &[plant], &[path.to_str().unwrap()]] {
        let printed = |more: &[&str]| {
            let output = advise(&[args, &["--format", "rust"], more].concat());
            assert!(output.status.success(), "{}", stderr(&output));
            String::from_utf8(output.stdout).unwrap()
        };
        let (all, short) = (printed(&[]), printed(&["--short"]));
        assert!(all.is_ascii() && short.is_ascii(), "{all}\n{short}");
        let made = first_configuration(&short);
        let made: Vec<(String, f32)> = (PARAMETERS.iter().zip(made.values()))
            .map(|(p, value)| (p.name.to_owned(), value))
            .collect();
        assert_eq!(fields(&all), made);
    }
}

/// What a scene sets itself is in the listing, also where it does not run the supervisor, and warnings go beside it.
#[test]
fn a_listing_has_what_the_scene_sets() {
    let folder = tempfile::TempDir::new().unwrap();
    let own = std::fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let path = folder.path().join("own.toml");
    let all = "policies = [\"passive\", \"radial\", \"levitation\", \"supervisor\"]";
    assert!(own.contains(all));
    let own = own.replace(all, "policies = [\"passive\"]") + "\n[supervisor]\nhold_share = 0.625\n";
    std::fs::write(&path, own).unwrap();
    for (language, line) in [
        ("toml", "hold_share = 0.625 "),
        ("rust", "hold_share: 0.625, "),
        ("c", "0.625f,           /* AMB_P_HOLD_SHARE: "),
    ] {
        let output = advise(&[path.to_str().unwrap(), "--format", language]);
        let printed = stderr(&output);
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(
            text.contains(line) && text.contains("suggested 0.8"),
            "{text}"
        );
        assert!(
            !text.contains("lag_drives") && printed.contains("warning: lag_drives"),
            "{printed}"
        );
    }
}

/// The stiffness of a contact that hardens is derived from its law, and nobody reads that it was given.
#[test]
fn the_tangent_of_a_hardening_contact_is_said_to_be_one() {
    let folder = tempfile::TempDir::new().unwrap();
    let own = std::fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let law = "stiffness_n_mn = 1e13\nrestitution_speed_m_s = 0.3";
    let path = folder.path().join("hardening.toml");
    std::fs::write(&path, own.replacen("stiffness_n_m = 1e9", law, 1)).unwrap();
    for more in [&[][..], &["--format", "rust"], &["--format", "c"]] {
        let output = advise(&[&[path.to_str().unwrap()], more].concat());
        let text = String::from_utf8(output.stdout).unwrap().to_lowercase();
        let mut lines = text
            .lines()
            .filter(|l| l.trim().contains("contact_stiffness_n_m"));
        let line = lines.next().unwrap_or_else(|| panic!("{text}"));
        assert!(
            line.contains("tangent at a depth of one clearance"),
            "{line}"
        );
    }
}
