//! `commission`: the numbers of a machine from the trace of a run in which its supervisor checked them.

use serde_json::Value;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use system_tests::{host, machine_scene_path, python, run_scene, scene_path};
use tempfile::TempDir;

/// The trace of the shipped scene, in a folder that goes with it.
fn trace() -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let output = run_scene(&scene_path("commissioning"), folder.path(), &[]);
    assert!(output.status.success(), "{output:?}");
    let table = String::from_utf8(output.stdout).unwrap();
    let checked = table
        .lines()
        .find(|line| line.contains("configuration checked"));
    assert!(
        checked.is_some_and(|line| line.contains("passed")),
        "{table}"
    );
    let trace = folder.path().join("trace_supervisor.parquet");
    (folder, trace)
}

fn commission(arguments: &[&Path]) -> (Option<i32>, String, String) {
    let output = host().arg("commission").args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

fn found(json: &Value, name: &str) -> [f64; 3] {
    let all = json["parameters"].as_array().unwrap();
    let one = all.iter().find(|one| one["name"] == name).unwrap();
    ["value", "low", "high"].map(|key| one[key].as_f64().unwrap())
}

#[test]
fn numbers_of_the_machine_are_found_with_intervals_that_hold() {
    let (folder, trace) = trace();
    let scene = scene_path("commissioning");
    let json = Path::new("--json");
    let (code, got, _) = commission(&[&trace, Path::new("--machine"), &scene, json]);
    assert_eq!(code, Some(0));
    let parsed: Value = serde_json::from_str(&got).unwrap();
    for (name, is, within) in [
        ("mass_kg", 12.0, 0.05),
        ("time_to_force_s", 1.5e-4, 0.1),
        ("sensor_noise_m", 1e-6, 0.1),
    ] {
        let [value, low, high] = found(&parsed, name);
        assert!((value / is - 1.0).abs() < within, "{name}: {value}");
        assert!(low <= is && is <= high, "{name}: {low} to {high}");
    }
    assert_eq!(found(&parsed, "spin_sense")[0], 1.0);
    assert!(found(&parsed, "axes_turned_rad")[0].abs() < 0.02);
    assert_eq!(
        parsed["contradictions"].as_array().unwrap().len(),
        0,
        "{got}"
    );

    // As CSV the same, and a wrong mass is a contradiction.
    let csv = folder.path().join("trace_supervisor.csv");
    let export = [
        "export".as_ref(),
        "--to".as_ref(),
        "csv".as_ref(),
        trace.as_os_str(),
    ];
    let written = host().args(export).output().unwrap();
    assert!(written.status.success(), "{written:?}");
    let text = fs::read_to_string(&scene).unwrap();
    let wrong = folder.path().join("wrong.toml");
    fs::write(
        &wrong,
        text.replace("check_first = 1", "check_first = 1\nmass_kg = 24.0"),
    )
    .unwrap();
    let (code, again, err) = commission(&[&csv, Path::new("--machine"), &wrong, json]);
    assert_eq!(code, Some(0), "{err}");
    let again: Value = serde_json::from_str(&again).unwrap();
    let [value, ..] = found(&again, "mass_kg");
    assert!((value / found(&parsed, "mass_kg")[0] - 1.0).abs() < 1e-3);
    assert_eq!(again["contradictions"][0]["name"], "mass_kg");

    for (format, line) in [
        ("rust", "    mass_kg: 1."),
        ("c", "config[AMB_P_MASS_KG] = 1."),
        ("toml", "mass_kg = 1."),
    ] {
        let (code, got, _) = commission(&[&trace, Path::new("--format"), Path::new(format)]);
        assert!(code == Some(0) && got.contains(line), "{got}");
    }
    let (code, got, _) = commission(&[&trace]);
    assert!(code == Some(0) && got.contains("--walk"), "{got}");
}

/// A walk that goes round gives clearance and centre, one that does not is refused.
#[test]
fn a_walk_gives_clearance_and_centre() {
    let (folder, trace) = trace();
    let walk = |turns: f64| {
        let mut csv = "t_s,measured_x_m,measured_y_m\n".to_owned();
        for tick in 0..20_000 {
            let angle = turns * TAU * f64::from(tick) / 20_000.0;
            let ripple = 1e-6 * (7.3 * f64::from(tick)).sin();
            let [x, y] = [angle.cos(), angle.sin()].map(|at| (2e-4 + ripple) * at);
            writeln!(csv, "{},{},{}", 5e-5 * f64::from(tick), x + 2e-5, y - 1e-5).unwrap();
        }
        let path = folder.path().join(format!("walk_{turns}.csv"));
        fs::write(&path, csv).unwrap();
        path
    };
    let (code, got, _) =
        commission(&[&trace, Path::new("--walk"), &walk(1.0), Path::new("--json")]);
    assert_eq!(code, Some(0));
    let parsed: Value = serde_json::from_str(&got).unwrap();
    for (name, is) in [
        ("clearance_m", 2e-4),
        ("retainer_centre_x_m", 2e-5),
        ("retainer_centre_y_m", -1e-5),
    ] {
        let [value, ..] = found(&parsed, name);
        assert!((value - is).abs() < 0.02 * 2e-4, "{name}: {value}");
    }
    let (code, _, got) = commission(&[&trace, Path::new("--walk"), &walk(0.3)]);
    assert!(code == Some(2) && got.contains("sectors"), "{got}");
}

#[test]
fn what_is_no_log_is_refused_by_name() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let names =
        "t_s,measured_x_m,measured_y_m,commanded_x_n,commanded_y_n,stimulus_x_n,stimulus_y_n\n";
    let still: String = (0..400)
        .map(|tick| format!("{},0,0,0,0,0,0\n", 5e-5 * f64::from(tick)))
        .collect();
    let moved = |x: &str| -> String {
        let row = |tick: u32| {
            let stimulus = 40.0
                * (0.05 * f64::from(tick % 300)).sin()
                * f64::from(u32::from(tick % 300 < 290));
            format!("{},{x},0,0,0,{stimulus},0\n", 5e-5 * f64::from(tick))
        };
        (0..3_000).map(row).collect()
    };
    let uneven = still.replace("0.01,", "0.01002,");
    let back = still.replace("0.01,", "0.0107,");
    let row = still.lines().next().unwrap();
    let cases = [
        (
            write("no_stimulus.csv", "t_s,measured_x_m\n0,0\n1,0\n"),
            "no column",
        ),
        (write("still.csv", &format!("{names}{still}")), "windows"),
        (write("uneven.csv", &format!("{names}{uneven}")), "evenly"),
        (
            write("back.csv", &format!("{names}{back}")),
            "goes back in row 202",
        ),
        (write("none.csv", names), "too few rows, 0"),
        (
            write("one.csv", &format!("{names}{row}\n")),
            "too few rows, 1",
        ),
        (
            write("words.csv", &format!("{names}0,0,0,x,0,0,0\n")),
            "line 2: commanded_x_n is \"x\"",
        ),
        (
            write("stuck.csv", &format!("{names}{}", moved("0"))),
            "does not answer",
        ),
        (
            write("far.csv", &format!("{names}{}", moved("1e300"))),
            "does not answer",
        ),
        (folder.path().join("none.parquet"), "none.parquet"),
        (write("no.parquet", "nothing"), "no.parquet"),
    ];
    for (path, says) in cases {
        let (code, out, got) = commission(&[&path]);
        assert!(code == Some(2) && out.is_empty(), "{got}");
        assert!(got.replace('\n', " ").contains(says), "{says}: {got}");
    }
    // Every mapping is used or refused.
    let still = write("still.csv", &format!("{names}{still}"));
    for mapping in ["t_s=nope", "foo=t_s", "measured_x_m=measured_x_m*0"] {
        let (code, out, got) = commission(&[&still, Path::new("--column"), Path::new(mapping)]);
        assert!(code == Some(2) && out.is_empty(), "{got}");
        let name = mapping.split('=').next().unwrap();
        assert!(got.contains("--column") && got.contains(name), "{got}");
    }
}

/// Stamps of Parquet in nanoseconds, rows that are missing at a large time, and complex numbers.
#[test]
fn what_python_writes_is_read_as_it_is_meant_or_refused() {
    let Some(python) = python() else { return };
    let (folder, trace) = trace();
    let script = "import sys, numpy as np, pandas as pd, scipy.io\n\
        folder, log = sys.argv[1], pd.read_parquet(sys.argv[2])\n\
        log = log[~log.mode_change].drop(columns='mode_change').select_dtypes('number')\n\
        ns = log.assign(t_s=pd.to_datetime((log.t_s * 1e9).round().astype('int64')))\n\
        ns.to_parquet(folder + '/ns.parquet')\n\
        late = log.assign(t_s=log.t_s + 1000)\n\
        late.to_csv(folder + '/late.csv', index=False)\n\
        late.drop(late.index[7::10]).to_csv(folder + '/gaps.csv', index=False)\n\
        columns = {c: log[c].to_numpy() for c in log}\n\
        columns['measured_x_m'] = columns['measured_x_m'] + 1e-6j\n\
        scipy.io.savemat(folder + '/complex.mat', columns)\n";
    let mut python = Command::new(python);
    let done = python.arg("-c").arg(script).arg(folder.path()).arg(&trace);
    let done = done.output().unwrap();
    assert!(done.status.success(), "{done:?}");
    for (name, says) in [
        ("ns.parquet", Some("no control loop")),
        ("gaps.csv", Some("evenly")),
        ("complex.mat", Some("measured_x_m is of complex numbers")),
        ("late.csv", None),
    ] {
        let (code, out, got) = commission(&[&folder.path().join(name)]);
        match says {
            Some(says) => assert!(code == Some(2) && got.contains(says), "{name}: {got}{out}"),
            None => assert!(code == Some(0) && out.contains("mass_kg"), "{name}: {got}"),
        }
    }
    let scaled = [Path::new("--column"), Path::new("t_s=t_s*1e-9")];
    let ns = folder.path().join("ns.parquet");
    let (code, out, got) = commission(&[&ns, scaled[0], scaled[1]]);
    assert!(code == Some(0) && out.contains("1.2"), "{got}{out}");
}

/// Traces of both ends of a rotor, in a folder that goes with them, and their scene.
fn both_ends() -> (TempDir, [PathBuf; 2], PathBuf) {
    let folder = TempDir::new().unwrap();
    let scene = machine_scene_path("commissioning_of_both_ends");
    let output = run_scene(&scene, folder.path(), &[]);
    assert!(output.status.success(), "{output:?}");
    let table = String::from_utf8(output.stdout).unwrap();
    let checked = table
        .lines()
        .filter(|line| line.contains("configuration checked") && line.contains("passed"));
    assert_eq!(checked.count(), 2, "{table}");
    let traces = ["far_end", "wheel_end"].map(|plane| {
        folder
            .path()
            .join(format!("trace_supervisor_{plane}.parquet"))
    });
    (folder, traces, scene)
}

/// A trace as CSV: its columns, and its rows without those between ticks.
fn as_csv(trace: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let export = [
        "export".as_ref(),
        "--to".as_ref(),
        "csv".as_ref(),
        trace.as_os_str(),
    ];
    let written = host().args(export).output().unwrap();
    assert!(written.status.success(), "{written:?}");
    let text = fs::read_to_string(trace.with_extension("csv")).unwrap();
    let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
    let mut lines = text.lines();
    let names = cells(lines.next().unwrap());
    (names, lines.map(cells).collect())
}

/// Mass and inertias of a rotor in two planes, from two logs and from one; what is configured wrong is contradicted, what costs most first.
#[test]
fn a_rotor_in_two_planes_is_found() {
    let (folder, [far, wheel], scene) = both_ends();
    let (machine, json) = (Path::new("--machine"), Path::new("--json"));
    let page = folder.path().join("fits.html");
    let asked: [&Path; 7] = [
        &far,
        &wheel,
        machine,
        &scene,
        json,
        Path::new("--page"),
        &page,
    ];
    let (code, got, err) = commission(&asked);
    assert_eq!(code, Some(0), "{err}");
    let parsed: Value = serde_json::from_str(&got).unwrap();
    for (name, is) in [
        ("mass_kg", 12.0),
        ("transverse_inertia_kg_m2", 0.25),
        ("polar_inertia_kg_m2", 0.2),
        ("force_factor_ratio", 1.0),
        ("far end.force_factor", 1.0),
    ] {
        let [value, low, high] = found(&parsed, name);
        assert!((value / is - 1.0).abs() < 0.03, "{name}: {value}");
        assert!(high - low < 0.06 * is, "{name}: {low} to {high}");
    }
    for plane in ["far end", "wheel end"] {
        let [value, ..] = found(&parsed, &format!("{plane}.magnet_stiffness_n_m"));
        // A tenth of the cap over the clearance.
        assert!((value + 1e5).abs() < 0.1 * 4e6, "{plane}: {value}");
    }
    assert_eq!(
        parsed["contradictions"].as_array().unwrap().len(),
        0,
        "{got}"
    );
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("<svg") && html.contains("transverse_inertia_kg_m2"));
    assert!(html.contains("far end, x") && !html.contains("<script"));

    let text = fs::read_to_string(&scene).unwrap();
    let wrong = folder.path().join("wrong.toml");
    fs::write(&wrong, text.replace("mass_kg = 12.0", "mass_kg = 18.0")).unwrap();
    let (code, got, err) = commission(&[&far, &wheel, machine, &wrong, json]);
    assert_eq!(code, Some(0), "{err}");
    let parsed: Value = serde_json::from_str(&got).unwrap();
    let contradicted = parsed["contradictions"].as_array().unwrap();
    let lost = |of: &Value| of["lost_share"].as_f64();
    assert!(contradicted.iter().any(|c| c["name"] == "mass_kg"), "{got}");
    assert!(
        contradicted[0]["name"]
            .as_str()
            .unwrap()
            .ends_with("force_factor")
    );
    assert!(lost(&contradicted[0]) >= lost(&contradicted[contradicted.len() - 1]));

    let (code, out, got) = commission(&[&far, &wheel]);
    assert!(
        code == Some(2) && out.is_empty() && got.contains("--machine"),
        "{got}"
    );
    let (code, out, got) = commission(&[&wheel, &far, machine, &scene]);
    assert!(
        code == Some(2) && out.is_empty() && got.contains("order of the scene"),
        "{got}"
    );
    let (code, out, got) = commission(&[&far, &wheel, machine, &scene_path("commissioning")]);
    assert!(
        code == Some(2) && out.is_empty() && got.contains("two planes"),
        "{got}"
    );
}

#[test]
fn one_log_of_two_planes_tells_the_same() {
    let (folder, [far, wheel], scene) = both_ends();
    let (machine, json) = (Path::new("--machine"), Path::new("--json"));
    let (_, got, _) = commission(&[&far, &wheel, machine, &scene, json]);
    let parsed: Value = serde_json::from_str(&got).unwrap();
    let (names, first) = as_csv(&far);
    let (_, second) = as_csv(&wheel);
    let at = |name: &str| names.iter().position(|n| n == name).unwrap();
    let own = [
        "measured_x_m",
        "measured_y_m",
        "commanded_x_n",
        "commanded_y_n",
        "stimulus_x_n",
        "stimulus_y_n",
    ];
    let mut csv = "t_s,spin_rad_s".to_owned();
    for plane in ["far end", "wheel end"] {
        own.iter()
            .for_each(|name| csv += &format!(",{plane}.{name}"));
    }
    csv += "\n";
    for (a, b) in first.iter().zip(&second) {
        csv += &format!("{},{}", a[at("t_s")], a[at("spin_rad_s")]);
        for row in [a, b] {
            own.iter()
                .for_each(|name| csv += &format!(",{}", row[at(name)]));
        }
        csv += "\n";
    }
    let both = folder.path().join("both.csv");
    fs::write(&both, csv).unwrap();
    let (code, again, err) = commission(&[&both, machine, &scene, json]);
    assert_eq!(code, Some(0), "{err}");
    let again: Value = serde_json::from_str(&again).unwrap();
    for name in [
        "mass_kg",
        "transverse_inertia_kg_m2",
        "wheel end.sensor_noise_m",
    ] {
        let [[one, ..], [other, ..]] = [found(&parsed, name), found(&again, name)];
        assert!(
            (one / other - 1.0).abs() < 1e-3,
            "{name}: {one} and {other}"
        );
    }
}

/// A flight record tells of contact, and says what it cannot tell.
#[test]
fn a_record_says_what_it_can_and_what_not() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let scene = scene_path("overload_then_release");
    assert!(run_scene(&scene, &out, &["--no-trace"]).status.success());
    let record = out.join("record_supervisor.bin");
    let (code, got, err) = commission(&[&record, Path::new("--json")]);
    assert_eq!(code, Some(0), "{err}");
    let parsed: Value = serde_json::from_str(&got).unwrap();
    // As the scene has it.
    let [value, low, high] = found(&parsed, "sensor_noise_m");
    assert!((low..=high).contains(&1e-6), "{value}");
    let missing = parsed["not_found"].as_array().unwrap();
    for (name, why) in [
        ("mass_kg", "no stimulus"),
        ("friction_coefficient", "closely enough"),
        ("spin_sense", "turns less"),
    ] {
        let one = missing.iter().find(|m| m["name"] == name).unwrap();
        assert!(one["reason"].as_str().unwrap().contains(why), "{got}");
    }
    for more in [
        [Path::new("--machine"), scene.as_path()],
        [Path::new("--walk"), scene.as_path()],
    ] {
        let (code, out, got) = commission(&[&record, more[0], more[1]]);
        assert!(
            code == Some(2) && out.is_empty() && got.contains("flight record"),
            "{got}"
        );
    }
}
