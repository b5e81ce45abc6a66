//! The suggested configuration as it is written in firmware.

use super::{AMB, advise, amb, stderr};
use firmware_bench::scene::suggest::suggested;
use supervisor::{Config, PARAMETERS};
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
    let values: Vec<(String, f32)> = (PARAMETERS.iter().zip(config.values()))
        .map(|(p, value)| (p.name.to_owned(), value))
        .collect();
    assert_eq!(fields(&listing), values);
    let table = advised(&["--format", "toml"]);
    assert!(advised(&[]).ends_with(&table), "{table}");

    let own = ["force_slew_n_s", "continuous_force_n", "thermal_time_s"];
    let example: Vec<(String, f32)> = (PARAMETERS.iter().zip(Config::example().values()))
        .map(|(p, value)| (p.name.to_owned(), value))
        .collect();
    for ((name, shown), (_, value)) in example.iter().zip(&values) {
        assert!(
            shown == value || own.contains(&name.as_str()),
            "{name} = {value}"
        );
    }
    let page = std::fs::read_to_string(root().join("docs/src/supervisor/linking.md")).unwrap();
    let (_, rest) = page.split_once("Config {").unwrap();
    assert_eq!(fields(rest.split_once("};").unwrap().0), example);
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
        ("c", "[AMB_P_HOLD_SHARE] = 0.625f, "),
    ] {
        let output = advise(&[path.to_str().unwrap(), "--format", language]);
        let said = stderr(&output);
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(
            text.contains(line) && text.contains("suggested 0.8"),
            "{text}"
        );
        assert!(
            !text.contains("lag_drives") && said.contains("warning: lag_drives"),
            "{said}"
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
