//! Errors that name the cause, the key with its table, and what to give.

use super::short_scene;
use std::fs;
use system_tests::run_scene;
use tempfile::TempDir;

/// The policy whose default needs a magnet that can lift is not to blame for one that cannot, nor is its key.
#[test]
fn a_magnet_that_cannot_lift_is_named_with_the_policy_damping_too() {
    let folder = TempDir::new().unwrap();
    for (more, needs) in [
        ("", "verdict.whirl_speed_m_s has no default"),
        (
            "[verdict]\nwhirl_speed_m_s = 1.0\n",
            "damping.coefficient_n_s_m has no default",
        ),
    ] {
        let scene = short_scene(folder.path(), |t| {
            t.replace("force_max_n = 1000.0", "force_max_n = 10.0")
                .replace("\"radial\"", "\"damping\"")
                + "\n"
                + more
        });
        let result = run_scene(&scene, &folder.path().join("out"), &[]);
        let error = String::from_utf8(result.stderr).unwrap();
        assert_eq!(result.status.code(), Some(2), "{error}");
        assert!(
            error.contains("magnet.force_max_n: is 10: it cannot lift"),
            "{error}"
        );
        assert!(error.contains(needs), "{error}");
    }
}

/// Every key that a scene cannot do without is named with its table, in its line, and what to give is said.
#[test]
fn what_is_missing_is_named_with_its_table_and_unit() {
    let folder = TempDir::new().unwrap();
    let more = "
[stator.inner]\nmass_kg = 12.0 # inner\nstiffness_n_m = 1e9 # inner\ndamping_n_s_m = 1e4 # inner
[race]\ninertia_kg_m2 = 1e-3
[[outage]]\nstart_s = 0.01 # outage\nduration_s = 0.001 # outage
[[disturbance]]\nstart_s = 0.02 # second\nduration_s = 0.001 # second\nforce_n = [1.0, 0.0] # second
[[change]]\nat_s = 0.01\neccentricity_m = 0.0\n";
    for (line, key, help) in [
        ("mass_kg = 10.0", "rotor.mass_kg", "give a number in kg"),
        ("contact_radius_m", "rotor.contact_radius_m", "in m"),
        ("duration_s = 0.03", "run.duration_s", "seconds"),
        ("sample_rate_hz", "run.sample_rate_hz", "in Hz"),
        (
            "policies",
            "run.policies",
            "passive, radial, damping, levitation, supervisor",
        ),
        ("frequency_hz", "spin.frequency_hz", "in Hz"),
        ("clearance_m", "contact.clearance_m", "in m"),
        (
            "coefficient = 0.15",
            "friction.coefficient",
            "sliding friction",
        ),
        ("force_max_n", "magnet.force_max_n", "in N"),
        ("proportional_n_m", "levitation.proportional_n_m", "in N/m"),
        ("force_n = [1300.0", "disturbance[0].force_n", "[x, y]"),
        (
            "force_n = [1.0, 0.0] # second",
            "disturbance[1].force_n",
            "[x, y]",
        ),
        (
            "stiffness_n_m = 1e9 # inner",
            "stator.inner.stiffness_n_m",
            "in N/m",
        ),
        ("inertia_kg_m2 = 1e-3", "race.inertia_kg_m2", "in kg m²"),
        ("start_s = 0.01 # outage", "outage[0].start_s", "in s"),
        ("at_s", "change[0].at_s", "in s"),
        ("title", "title", "give a name in one line"),
    ] {
        let scene = short_scene(folder.path(), |t| {
            let text = t + more;
            let kept = text.lines().filter(|l| !l.starts_with(line));
            kept.collect::<Vec<_>>().join("\n")
        });
        let text = fs::read_to_string(&scene).unwrap();
        let result = run_scene(&scene, &folder.path().join("out"), &[]);
        let error = String::from_utf8(result.stderr).unwrap();
        assert_eq!(result.status.code(), Some(2), "{line}: {error}");
        let is_missing = [
            format!(": {key}: is missing"),
            format!(": {key} is missing"),
        ];
        assert!(
            is_missing.iter().any(|m| error.contains(m)),
            "{line}: {error}"
        );
        let helps = error.split("help: ").nth(1).unwrap_or_default();
        assert!(helps.contains(help), "{line}: {error}");
        // The line of the table's heading.
        let heading = key.rsplit_once('.').map(|(table, _)| table);
        let heading = heading.map(|table| table.split('[').next().unwrap());
        let number = error.split("short.toml:").nth(1).unwrap();
        let number: usize = number.split(':').next().unwrap().parse().unwrap();
        let at = text.lines().nth(number - 1).unwrap();
        assert!(
            heading.is_none_or(|table| at.contains(table)),
            "{line}: {at}"
        );
    }
    // A whole table.
    let scene = short_scene(folder.path(), |t| {
        let (before, rest) = t.split_once("[friction]").unwrap();
        format!("{before}\n{}", &rest[rest.find("\n[").unwrap()..])
    });
    let result = run_scene(&scene, &folder.path().join("out"), &[]);
    let error = String::from_utf8(result.stderr).unwrap();
    assert!(error.contains("friction is missing"), "{error}");
    assert!(error.contains("add a table [friction]"), "{error}");
}
