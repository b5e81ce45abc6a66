//! `commission`: the numbers of a machine from the trace of a run in which its supervisor checked them.

use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::process::Command;
use system_tests::python;
use system_tests::ran::{Folder, has, lacks, list, number, ran};

/// The trace of the shipped scene, in a folder that goes with it.
fn trace() -> Folder {
    let folder = Folder::fresh();
    let table = folder.ran("run @commissioning --out .").good();
    let mut lines = table.lines();
    let checked = lines.find(|line| line.contains("configuration checked"));
    assert!(
        checked.is_some_and(|line| line.contains("passed")),
        "{table}"
    );
    folder
}

fn found(json: &Value, name: &str) -> [f64; 3] {
    let mut all = list(&json["parameters"]).iter();
    let one = all.find(|one| one["name"] == name).unwrap();
    ["value", "low", "high"].map(|key| number(&one[key]))
}

#[test]
fn numbers_of_the_machine_are_found_with_intervals_that_hold() {
    let folder = trace();
    let log = "commission trace_supervisor.parquet";
    let parsed = folder
        .ran(&format!("{log} --machine @commissioning --json"))
        .json();
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
    assert_eq!(parsed["contradictions"], json!([]));

    // As CSV the same, and a wrong mass is a contradiction.
    folder
        .ran("export --to csv trace_supervisor.parquet")
        .good();
    let wrong = [("check_first = 1", "check_first = 1\nmass_kg = 24.0")];
    folder.scene("wrong.toml", "commissioning", &wrong);
    let again = folder
        .ran("commission trace_supervisor.csv --machine wrong.toml --json")
        .json();
    let [value, ..] = found(&again, "mass_kg");
    assert!((value / found(&parsed, "mass_kg")[0] - 1.0).abs() < 1e-3);
    assert_eq!(again["contradictions"][0]["name"], "mass_kg");

    for (more, line) in [
        ("--format rust", "    mass_kg: 1."),
        ("--format c", "config[AMB_P_MASS_KG] = 1."),
        ("--format toml", "mass_kg = 1."),
        ("", "--walk"),
    ] {
        has(&folder.ran(&format!("{log} {more}")).good(), &[line]);
    }
}

/// A walk that goes round gives clearance and centre, one that does not is refused.
#[test]
fn a_walk_gives_clearance_and_centre() {
    let folder = trace();
    let walk = |turns: f64| {
        let mut csv = "t_s,measured_x_m,measured_y_m\n".to_owned();
        for tick in 0..20_000 {
            let angle = turns * TAU * f64::from(tick) / 20_000.0;
            let ripple = 1e-6 * (7.3 * f64::from(tick)).sin();
            let [x, y] = [angle.cos(), angle.sin()].map(|at| (2e-4 + ripple) * at);
            writeln!(csv, "{},{},{}", 5e-5 * f64::from(tick), x + 2e-5, y - 1e-5).unwrap();
        }
        folder.put("walk.csv", csv);
        folder.ran("commission trace_supervisor.parquet --walk walk.csv --json")
    };
    let parsed = walk(1.0).json();
    for (name, is) in [
        ("clearance_m", 2e-4),
        ("retainer_centre_x_m", 2e-5),
        ("retainer_centre_y_m", -1e-5),
    ] {
        let [value, ..] = found(&parsed, name);
        assert!((value - is).abs() < 0.02 * 2e-4, "{name}: {value}");
    }
    has(&walk(0.3).refused(), &["sectors"]);
}

#[test]
fn what_is_no_log_is_refused_by_name() {
    let folder = Folder::fresh();
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
    let row = still.lines().next().unwrap();
    let of = |rows: &str| format!("{names}{rows}");
    for (name, text, says) in [
        (
            "short.csv",
            "t_s,measured_x_m\n0,0\n1,0\n".to_owned(),
            "no column",
        ),
        (
            "uneven.csv",
            of(&still.replace("0.01,", "0.01002,")),
            "evenly",
        ),
        (
            "back.csv",
            of(&still.replace("0.01,", "0.0107,")),
            "goes back in row 202",
        ),
        ("none.csv", of(""), "too few rows, 0"),
        ("one.csv", of(row), "too few rows, 1"),
        (
            "words.csv",
            of("0,0,0,x,0,0,0\n"),
            "line 2: commanded_x_n is \"x\"",
        ),
        ("stuck.csv", of(&moved("0")), "does not answer"),
        ("far.csv", of(&moved("1e300")), "does not answer"),
        ("no.parquet", "nothing".to_owned(), "no.parquet"),
        ("still.csv", of(&still), "windows"),
    ] {
        folder.put(name, text);
        has(
            &folder.ran(&format!("commission {name}")).refused(),
            &[says],
        );
    }
    has(
        &folder.ran("commission none.parquet").refused(),
        &["none.parquet"],
    );
    // Every mapping is used or refused.
    for mapping in ["t_s=nope", "foo=t_s", "measured_x_m=measured_x_m*0"] {
        let said = folder
            .ran(&format!("commission still.csv --column {mapping}"))
            .refused();
        has(&said, &["--column", mapping.split('=').next().unwrap()]);
    }
}

/// Stamps of Parquet in nanoseconds, rows that are missing at a large time, and complex numbers.
#[test]
fn what_python_writes_is_read_as_it_is_meant_or_refused() {
    let Some(python) = python() else { return };
    let folder = trace();
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
    let files = [folder.at("."), folder.at("trace_supervisor.parquet")];
    ran(Command::new(python).args(["-c", script]).args(files)).good();
    for (name, says) in [
        ("ns.parquet", "no control loop"),
        ("gaps.csv", "evenly"),
        ("complex.mat", "measured_x_m is of complex numbers"),
    ] {
        has(&folder.ran(&format!("commission {name}")).fails(2), &[says]);
    }
    has(&folder.ran("commission late.csv").good(), &["mass_kg"]);
    let scaled = "commission ns.parquet --column t_s=t_s*1e-9";
    has(&folder.ran(scaled).good(), &["1.2"]);
}

/// Traces of both ends of a rotor, in a folder that goes with them.
fn both_ends() -> Folder {
    let folder = Folder::fresh();
    let run = "run @machines/commissioning_of_both_ends --out .";
    let table = folder.ran(run).good();
    let checked = table
        .lines()
        .filter(|line| line.contains("configuration checked") && line.contains("passed"));
    assert_eq!(checked.count(), 2, "{table}");
    folder
}

const BOTH: &str = "commission trace_supervisor_far_end.parquet trace_supervisor_wheel_end.parquet";
const MACHINE: &str = "--machine @machines/commissioning_of_both_ends";

/// A trace as CSV: its columns, and its rows without those between ticks.
fn as_csv(folder: &Folder, end: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let trace = format!("trace_supervisor_{end}");
    folder
        .ran(&format!("export --to csv {trace}.parquet"))
        .good();
    let text = folder.text(&format!("{trace}.csv"));
    let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
    let mut lines = text.lines();
    let names = cells(lines.next().unwrap());
    (names, lines.map(cells).collect())
}

/// Mass and inertias of a rotor in two planes, from two logs and from one; what is told wrong is contradicted, what costs most first.
#[test]
fn a_rotor_in_two_planes_is_found() {
    let folder = both_ends();
    let parsed = folder
        .ran(&format!("{BOTH} {MACHINE} --json --page fits.html"))
        .json();
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
    assert_eq!(parsed["contradictions"], json!([]));
    let html = folder.text("fits.html");
    has(&html, &["<svg", "transverse_inertia_kg_m2", "far end, x"]);
    lacks(&html, &["<script"]);

    let wrong = [("mass_kg = 12.0", "mass_kg = 18.0")];
    folder.scene("wrong.toml", "machines/commissioning_of_both_ends", &wrong);
    let parsed = folder
        .ran(&format!("{BOTH} --machine wrong.toml --json"))
        .json();
    let contradicted = list(&parsed["contradictions"]);
    let names = contradicted.iter().map(|c| c["name"].as_str().unwrap());
    assert!(names.clone().any(|name| name == "mass_kg"), "{parsed}");
    assert!(names.clone().next().unwrap().ends_with("force_factor"));
    let lost = |of: &Value| of["lost_share"].as_f64();
    assert!(lost(&contradicted[0]) >= lost(&contradicted[contradicted.len() - 1]));

    let turned = "commission trace_supervisor_wheel_end.parquet trace_supervisor_far_end.parquet";
    for (line, says) in [
        (BOTH.to_owned(), "--machine"),
        (format!("{turned} {MACHINE}"), "order of the scene"),
        (format!("{BOTH} --machine @commissioning"), "two planes"),
    ] {
        has(&folder.ran(&line).refused(), &[says]);
    }
}

#[test]
fn one_log_of_two_planes_tells_the_same() {
    let folder = both_ends();
    let parsed = folder.ran(&format!("{BOTH} {MACHINE} --json")).json();
    let (names, first) = as_csv(&folder, "far_end");
    let (_, second) = as_csv(&folder, "wheel_end");
    let at = |name: &str| names.iter().position(|n| n == name).unwrap();
    let own: Vec<String> = ["measured", "commanded", "stimulus"]
        .iter()
        .zip(["m", "n", "n"])
        .flat_map(|(what, unit)| ["x", "y"].map(|axis| format!("{what}_{axis}_{unit}")))
        .collect();
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
    folder.put("both.csv", csv);
    let again = folder
        .ran(&format!("commission both.csv {MACHINE} --json"))
        .json();
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
    let folder = Folder::fresh();
    folder
        .ran("run @overload_then_release --out . --no-trace")
        .good();
    let record = "commission record_supervisor.bin";
    let parsed = folder.ran(&format!("{record} --json")).json();
    // As the scene has it.
    let [value, low, high] = found(&parsed, "sensor_noise_m");
    assert!((low..=high).contains(&1e-6), "{value}");
    for (name, why) in [
        ("mass_kg", "no stimulus"),
        ("friction_coefficient", "closely enough"),
        ("spin_sense", "turns less"),
    ] {
        let mut missing = list(&parsed["not_found"]).iter();
        let one = missing.find(|m| m["name"] == name).unwrap();
        has(one["reason"].as_str().unwrap(), &[why]);
    }
    for more in ["--machine", "--walk"] {
        let line = format!("{record} {more} @overload_then_release");
        has(&folder.ran(&line).refused(), &["flight record"]);
    }
}
