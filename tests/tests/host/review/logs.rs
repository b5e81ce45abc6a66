//! Logs of other programs, watched by the supervisor: the same event as its own record has, in whatever format, with what they
//! lack said.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use system_tests::{host, machine_scene_path, python, run_scene, scene_path};
use tempfile::TempDir;

fn review(log: &Path, scene: &Path, more: &[&str]) -> Output {
    let mut review = host();
    review
        .arg("review")
        .arg(log)
        .arg("--scene")
        .arg(scene)
        .args(more);
    review.output().unwrap()
}

fn json(log: &Path, scene: &Path, more: &[&str]) -> Value {
    let output = review(log, scene, &[&["--json"], more].concat());
    let shown = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {shown}", log.display());
    serde_json::from_slice(&output.stdout).unwrap()
}

fn export(trace: &Path, format: &str) {
    let export = host()
        .arg("export")
        .arg(trace)
        .args(["--to", format])
        .output();
    assert!(export.unwrap().status.success());
}

/// Columns of a trace under other names, in micrometres and milliseconds, between semicolons.
pub(crate) fn foreign(csv: &str, force: bool) -> String {
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = |name: &str| names.iter().position(|n| *n == name).unwrap();
    let wanted = [("t_s", 1e3), ("measured_x_m", 1e6), ("measured_y_m", 1e6)];
    let forces = [("commanded_x_n", 1.0), ("commanded_y_n", 1.0)];
    let all = wanted.iter().chain(forces.iter().filter(|_| force));
    let columns: Vec<(usize, f64)> = all.map(|(name, factor)| (at(name), *factor)).collect();
    let between = at("mode_change");
    let mut out = "ms;x1;y1".to_owned() + if force { ";fx;fy\n" } else { "\n" };
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        if cells[between] == "true" {
            continue;
        }
        let row: Vec<String> = (columns.iter())
            .map(|(i, factor)| (factor * cells[*i].parse::<f64>().unwrap()).to_string())
            .collect();
        out += &(row.join(";") + "\n");
    }
    out
}

const NAMES: [&str; 6] = [
    "--column",
    "t_s=ms*1e-3",
    "--column",
    "measured_x_m=x1*1e-6",
    "--column",
    "measured_y_m=y1*1e-6",
];
const FORCES: [&str; 4] = [
    "--column",
    "commanded_x_n=fx",
    "--column",
    "commanded_y_n=fy",
];

#[test]
fn a_log_shows_the_event_that_the_record_has() {
    let folder = TempDir::new().unwrap();
    let (scene, out) = (scene_path("overload_then_release"), folder.path());
    assert!(run_scene(&scene, out, &[]).status.success());
    let trace = out.join("trace_supervisor.parquet");
    ["csv", "mcap"]
        .iter()
        .for_each(|format| export(&trace, format));
    let record = json(&out.join("record_supervisor.bin"), &scene, &[]);
    assert!(record["log"].is_null());
    let own = json(&trace, &scene, &[]);
    let (watched, seen) = (&own["summary"], &record["summary"]);
    assert_eq!(
        (&watched["outcome"], &watched["touches"]),
        (&seen["outcome"], &seen["touches"])
    );
    for figure in ["hardest_impact_m_s", "contact_s", "severity"] {
        let (a, b) = (
            watched[figure].as_f64().unwrap(),
            seen[figure].as_f64().unwrap(),
        );
        assert!((a / b - 1.0).abs() < 0.05, "{figure}: {a}, recorded {b}");
    }
    let log = &own["log"];
    assert_eq!(log["events"].as_array().unwrap().len(), 1);
    let begins_s = log["events"][0]["from_s"].as_f64().unwrap();
    assert!((0.02..0.022).contains(&begins_s), "{begins_s}");
    assert!(log["has_force"] == true && log["has_spin"] == true);

    // In other formats, to the bit; and as another program would have written it.
    for format in ["csv", "mcap"] {
        let other = json(&trace.with_extension(format), &scene, &[]);
        assert_eq!(other["summary"], own["summary"], "{format}");
    }
    let csv = fs::read_to_string(trace.with_extension("csv")).unwrap();
    let written = out.join("foreign.csv");
    fs::write(&written, foreign(&csv, true)).unwrap();
    let columns = [&NAMES[..], &FORCES].concat();
    let other = json(&written, &scene, &columns);
    assert_eq!(other["summary"]["touches"], watched["touches"]);
    assert!(other["log"]["has_spin"] == false && other["log"]["has_force"] == true);
    if let Some(python) = python() {
        let mat = out.join("foreign.mat");
        let convert = |all: &str| {
            let script = format!(
                "import sys, pandas, scipy.io\n\
                 d = pandas.read_csv(sys.argv[1], sep=';')\n\
                 scipy.io.savemat(sys.argv[2], {{c: {all} for c in d}}, do_compression=True)"
            );
            let mut python = Command::new(&python);
            let done = python.arg("-c").arg(script).args([&written, &mat]).output();
            let done = done.unwrap();
            let shown = String::from_utf8_lossy(&done.stderr);
            assert!(done.status.success(), "{shown}");
        };
        convert("d[c].to_numpy()");
        assert_eq!(json(&mat, &scene, &columns)["summary"], other["summary"]);
        // Vectors of a file need not be of one log.
        convert("d[c].to_numpy()[3 * (c == 'fy'):]");
        let refused = review(&mat, &scene, &columns);
        let shown = String::from_utf8_lossy(&refused.stderr);
        assert!(
            refused.status.code() == Some(2) && shown.contains("rows and t_s"),
            "{shown}"
        );
    }

    // Without forces, which is said; what is read as a touch stays one.
    fs::write(&written, foreign(&csv, false)).unwrap();
    let without = review(&written, &scene, &NAMES);
    let shown = String::from_utf8_lossy(&without.stdout);
    assert!(
        shown.contains("no force") && shown.contains("touches"),
        "{shown}"
    );
    assert!(!shown.contains("Replayed"), "{shown}");
}

#[test]
fn gaps_of_a_log_are_positions_that_are_unknown() {
    let folder = TempDir::new().unwrap();
    let (scene, out) = (scene_path("overload_then_release"), folder.path());
    assert!(run_scene(&scene, out, &[]).status.success());
    let trace = out.join("trace_supervisor.parquet");
    export(&trace, "csv");
    let text = foreign(
        &fs::read_to_string(trace.with_extension("csv")).unwrap(),
        true,
    );
    let columns = [&NAMES[..], &FORCES].concat();
    // Row 430 is 21.5 ms.
    let rows: Vec<String> = (text.lines().enumerate())
        .filter(|(i, _)| !(460..480).contains(i))
        .map(|(i, line)| match (430..450).contains(&i) {
            true => {
                let cells: Vec<&str> = line.split(';').collect();
                [cells[0], "", "", cells[3], cells[4]].join(";")
            }
            false => line.to_owned(),
        })
        .collect();
    let log = out.join("gaps.csv");
    fs::write(&log, rows.join("\n") + "\n").unwrap();
    let of = json(&log, &scene, &columns);
    let unknown = of["planes"][0]["unknown"].as_array().unwrap();
    let reasons: Vec<&str> = unknown
        .iter()
        .map(|u| u["reason"].as_str().unwrap())
        .collect();
    assert!(
        reasons.contains(&"not_a_number") && reasons.contains(&"missed_ticks"),
        "{reasons:?}"
    );

    // Cut within the event: that it is not over is said, and it is not taken for one that ended well.
    let cut: Vec<&str> = text.lines().take(600).collect();
    fs::write(&log, cut.join("\n") + "\n").unwrap();
    let output = review(&log, &scene, &columns);
    let shown = String::from_utf8_lossy(&output.stdout);
    assert!(shown.contains("where it is not over"), "{shown}");
    assert!(shown.contains("the log ends before it was over"), "{shown}");
    assert!(!shown.contains("Nothing speaks against"), "{shown}");

    // Before the event there is none.
    let quiet: Vec<&str> = text.lines().take(300).collect();
    fs::write(&log, quiet.join("\n") + "\n").unwrap();
    let of = json(&log, &scene, &columns);
    assert!(of["log"]["events"].as_array().unwrap().is_empty() && of["summary"].is_null());
}

#[test]
fn both_planes_of_a_rotor_are_watched_together() {
    let folder = TempDir::new().unwrap();
    let (scene, out) = (
        machine_scene_path("overload_of_a_flexible_rotor"),
        folder.path(),
    );
    let ran = run_scene(&scene, out, &[]);
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    let of = firmware_bench::scene::Scene::load(&scene).unwrap();
    let mut tables: Vec<Vec<String>> = Vec::new();
    let mut records = Vec::new();
    for plane in &of.planes {
        let name = plane.name.replace(' ', "_");
        records.extend(fs::read(out.join(format!("record_supervisor_{name}.bin"))).unwrap());
        let trace = out.join(format!("trace_supervisor_{name}.parquet"));
        export(&trace, "csv");
        let text = fs::read_to_string(trace.with_extension("csv")).unwrap();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let names: Vec<String> = (lines[0].split(','))
            .map(|name| match name {
                "t_s" | "spin_rad_s" | "mode_change" if tables.is_empty() => name.to_owned(),
                name => format!("{}.{name}", plane.name),
            })
            .collect();
        lines[0] = names.join(",");
        tables.push(lines);
    }
    fs::write(out.join("record.bin"), records).unwrap();
    let record = json(&out.join("record.bin"), &scene, &[]);
    // Rows between ticks are of one plane alone.
    let ticks = |lines: &[String]| -> Vec<String> {
        (lines.iter())
            .filter(|line| !line.contains("true"))
            .cloned()
            .collect()
    };
    let [a, b] = [ticks(&tables[0]), ticks(&tables[1])];
    let rows: Vec<String> = a.iter().zip(&b).map(|(a, b)| format!("{a},{b}")).collect();
    let log = out.join("both.csv");
    fs::write(&log, rows.join("\n") + "\n").unwrap();
    let both = json(&log, &scene, &[]);
    assert_eq!(both["planes"].as_array().unwrap().len(), 2);
    assert_eq!(both["summary"]["outcome"], record["summary"]["outcome"]);
    let touches = |of: &Value| of["summary"]["touches"].as_f64().unwrap();
    assert_eq!(touches(&both), touches(&record));
}

#[test]
fn what_a_log_lacks_is_named() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("log.csv");
    fs::write(&log, "t_s,x\n0,0\n5e-5,0\n1e-4,0\n").unwrap();
    let scene = scene_path("overload_then_release");
    let output = host().arg("review").arg(&log).output().unwrap();
    let shown = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.code() == Some(2) && shown.contains("--scene"),
        "{shown}"
    );
    let output = review(&log, &scene, &[]);
    let shown = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    for part in ["measured_x_m", "log.csv", "t_s, x", "--column"] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    // In milliseconds and micrometres that nobody turned.
    let rows: Vec<String> = (0..200)
        .map(|i| format!("{},{i},0\n", 0.05 * f64::from(i)))
        .collect();
    fs::write(
        &log,
        format!("t_s,measured_x_m,measured_y_m\n{}", rows.concat()),
    )
    .unwrap();
    let output = review(&log, &scene, &[]);
    let shown = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.code() == Some(2) && shown.contains("t_s*1e-3"),
        "{shown}"
    );
    let output = review(&log, &scene, &["--column", "t_s=t_s*1e-3"]);
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success() && shown.contains("No rotor goes so far"),
        "{shown}"
    );
}

/// A reading that is no length, a plane without one, a spin without one, and a mapping that nobody uses.
#[test]
fn what_is_no_number_of_a_machine_is_said() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("log.csv");
    let scene = scene_path("overload_then_release");
    let of = |x: &dyn Fn(i32) -> &'static str, more: &[&str]| {
        let rows: String = (0..200)
            .map(|i| format!("{:.6},{},{},\n", 1e3 + 5e-5 * f64::from(i), x(i), x(i)))
            .collect();
        let head = "t_s,measured_x_m,measured_y_m,spin_rad_s\n";
        fs::write(&log, format!("{head}{rows}")).unwrap();
        let output = review(&log, &scene, more);
        let shown = [&output.stdout[..], &output.stderr].concat();
        let shown = String::from_utf8(shown).unwrap();
        let words: Vec<&str> = shown.split_whitespace().collect();
        (output.status.code(), words.join(" "))
    };
    let far = |i| if i == 7 { "1e300" } else { "1e-5" };
    let (code, shown) = of(&far, &[]);
    assert_eq!(code, Some(0), "{shown}");
    for part in [
        "count as unknown: 2.",
        "0.0",
        "spin_rad_s has no number",
        "the scene's is taken",
    ] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    assert!(!shown.contains("00000000"), "{shown}");
    let (code, shown) = of(&|_| "nan", &[]);
    assert!(
        code == Some(0) && shown.contains("no position is a number"),
        "{shown}"
    );
    for mapping in ["foo=t_s", "stimulus_x_n=t_s", "t_s=nope"] {
        let (code, shown) = of(&|_| "0", &["--column", mapping]);
        assert!(
            code == Some(2) && shown.contains("--column"),
            "{mapping}: {shown}"
        );
    }
}
