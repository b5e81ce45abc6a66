//! Logs of other programs, watched by the supervisor: the same event as its own record has, in whatever format, with what they
//! lack said.

use serde_json::Value;
use std::process::Command;
use system_tests::python;
use system_tests::ran::{Folder, Ran, flat, has, lacks, list, number, ran};

fn review(folder: &Folder, log: &str, more: &str) -> Ran {
    folder.ran(&format!(
        "review {log} --scene @overload_then_release {more}"
    ))
}

fn json(folder: &Folder, log: &str, more: &str) -> Value {
    review(folder, log, &format!("--json {more}")).json()
}

/// That scene, run, and its trace in these formats too.
fn exported(formats: &[&str]) -> Folder {
    let folder = Folder::fresh();
    folder.ran("run @overload_then_release --out .").good();
    for format in formats {
        let line = format!("export trace_supervisor.parquet --to {format}");
        folder.ran(&line).good();
    }
    folder
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

const NAMES: &str =
    "--column t_s=ms*1e-3 --column measured_x_m=x1*1e-6 --column measured_y_m=y1*1e-6";
const FORCES: &str = "--column commanded_x_n=fx --column commanded_y_n=fy";

#[test]
fn a_log_shows_the_event_that_the_record_has() {
    let folder = exported(&["csv", "mcap"]);
    let record = json(&folder, "record_supervisor.bin", "");
    assert!(record["log"].is_null());
    let own = json(&folder, "trace_supervisor.parquet", "");
    let (told, seen) = (&own["summary"], &record["summary"]);
    for same in ["outcome", "touches"] {
        assert_eq!(told[same], seen[same]);
    }
    for figure in ["hardest_impact_m_s", "contact_s", "severity"] {
        let (a, b) = (number(&told[figure]), number(&seen[figure]));
        assert!((a / b - 1.0).abs() < 0.05, "{figure}: {a}, recorded {b}");
    }
    let log = &own["log"];
    assert_eq!(list(&log["events"]).len(), 1);
    let begins_s = number(&log["events"][0]["from_s"]);
    assert!((0.02..0.022).contains(&begins_s), "{begins_s}");
    assert!(log["has_force"] == true && log["has_spin"] == true);

    // In other formats, to the bit; and as another program would have written it.
    for format in ["csv", "mcap"] {
        let other = json(&folder, &format!("trace_supervisor.{format}"), "");
        assert_eq!(other["summary"], own["summary"], "{format}");
    }
    let csv = folder.text("trace_supervisor.csv");
    let written = folder.put("foreign.csv", foreign(&csv, true));
    let columns = format!("{NAMES} {FORCES}");
    let other = json(&folder, "foreign.csv", &columns);
    assert_eq!(other["summary"]["touches"], told["touches"]);
    assert!(other["log"]["has_spin"] == false && other["log"]["has_force"] == true);
    if let Some(python) = python() {
        let convert = |all: &str| {
            let script = format!(
                "import sys, pandas, scipy.io\n\
                 d = pandas.read_csv(sys.argv[1], sep=';')\n\
                 scipy.io.savemat(sys.argv[2], {{c: {all} for c in d}}, do_compression=True)"
            );
            let files = [&written, &folder.at("foreign.mat")];
            ran(Command::new(&python).args(["-c", &script]).args(files)).good();
        };
        convert("d[c].to_numpy()");
        let of_matlab = json(&folder, "foreign.mat", &columns);
        assert_eq!(of_matlab["summary"], other["summary"]);
        // Vectors of a file need not be of one log.
        convert("d[c].to_numpy()[3 * (c == 'fy'):]");
        let said = review(&folder, "foreign.mat", &columns).fails(2);
        has(&said, &["rows and t_s"]);
    }

    // Without forces, which is said; what is read as a touch stays one.
    folder.put("foreign.csv", foreign(&csv, false));
    let said = review(&folder, "foreign.csv", NAMES).good();
    has(&said, &["no force", "touches"]);
    lacks(&said, &["Replayed"]);
}

#[test]
fn gaps_of_a_log_are_positions_that_are_unknown() {
    let folder = exported(&["csv"]);
    let text = foreign(&folder.text("trace_supervisor.csv"), true);
    let columns = format!("{NAMES} {FORCES}");
    let put = |rows: &[String]| folder.put("log.csv", rows.join("\n") + "\n");
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
    put(&rows);
    let of = json(&folder, "log.csv", &columns);
    let unknown = list(&of["planes"][0]["unknown"]).iter();
    let reasons: Vec<&str> = unknown.map(|u| u["reason"].as_str().unwrap()).collect();
    has(&reasons.join(" "), &["not_a_number", "missed_ticks"]);

    // Cut within the event: that it is not over is said, and it is not taken for one that ended well.
    let first = |rows: usize| -> Vec<String> { text.lines().take(rows).map(Into::into).collect() };
    put(&first(600));
    let said = review(&folder, "log.csv", &columns).printed;
    has(
        &said,
        &["where it is not over", "the log ends before it was over"],
    );
    lacks(&said, &["Nothing speaks against"]);

    // Before the event there is none.
    put(&first(300));
    let of = json(&folder, "log.csv", &columns);
    assert!(list(&of["log"]["events"]).is_empty() && of["summary"].is_null());
}

#[test]
fn both_planes_of_a_rotor_are_watched_together() {
    let folder = Folder::fresh();
    let scene = "@machines/overload_of_a_flexible_rotor";
    folder.ran(&format!("run {scene} --out .")).good();
    let json = |log: &str| {
        folder
            .ran(&format!("review {log} --scene {scene} --json"))
            .json()
    };
    let mut tables: Vec<Vec<String>> = Vec::new();
    let mut records = Vec::new();
    for plane in ["far end", "coupling end"] {
        let name = plane.replace(' ', "_");
        records.extend(folder.bytes(&format!("record_supervisor_{name}.bin")));
        let trace = format!("trace_supervisor_{name}");
        folder
            .ran(&format!("export {trace}.parquet --to csv"))
            .good();
        let text = folder.text(&format!("{trace}.csv"));
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let names: Vec<String> = (lines[0].split(','))
            .map(|name| match name {
                "t_s" | "spin_rad_s" | "mode_change" if tables.is_empty() => name.to_owned(),
                name => format!("{plane}.{name}"),
            })
            .collect();
        lines[0] = names.join(",");
        // Rows between ticks are of one plane alone.
        lines.retain(|line| !line.contains("true"));
        tables.push(lines);
    }
    folder.put("record.bin", records);
    let record = json("record.bin");
    let rows = tables[0].iter().zip(&tables[1]);
    let rows: String = rows.map(|(a, b)| format!("{a},{b}\n")).collect();
    folder.put("both.csv", rows);
    let both = json("both.csv");
    assert_eq!(list(&both["planes"]).len(), 2);
    for same in ["outcome", "touches"] {
        assert_eq!(both["summary"][same], record["summary"][same]);
    }
    assert!(both["summary"]["touches"].is_number());
}

#[test]
fn what_a_log_lacks_is_named() {
    let folder = Folder::fresh();
    folder.put("log.csv", "t_s,x\n0,0\n5e-5,0\n1e-4,0\n");
    has(&folder.ran("review log.csv").fails(2), &["--scene"]);
    let said = review(&folder, "log.csv", "").fails(2);
    has(&said, &["measured_x_m", "log.csv", "t_s, x", "--column"]);
    // In milliseconds and micrometres that nobody turned.
    let row = |i: i32| format!("{},{i},0\n", 0.05 * f64::from(i));
    let rows: String = (0..200).map(row).collect();
    folder.put("log.csv", format!("t_s,measured_x_m,measured_y_m\n{rows}"));
    has(&review(&folder, "log.csv", "").fails(2), &["t_s*1e-3"]);
    let said = review(&folder, "log.csv", "--column t_s=t_s*1e-3").good();
    has(&said, &["No rotor goes so far"]);
}

/// A reading that is no length, a plane without one, a spin without one, and a mapping that nobody uses.
#[test]
fn what_is_no_number_of_a_machine_is_said() {
    let folder = Folder::fresh();
    let of = |x: &dyn Fn(i32) -> &'static str, more: &str| {
        let row = |i| format!("{:.6},{},{},\n", 1e3 + 5e-5 * f64::from(i), x(i), x(i));
        let rows: String = (0..200).map(row).collect();
        let head = "t_s,measured_x_m,measured_y_m,spin_rad_s\n";
        folder.put("log.csv", format!("{head}{rows}"));
        let Ran {
            code,
            printed,
            said,
        } = review(&folder, "log.csv", more);
        (code, flat(&(printed + &said)))
    };
    let far = |i| if i == 7 { "1e300" } else { "1e-5" };
    let (code, said) = of(&far, "");
    assert_eq!(code, Some(0), "{said}");
    has(
        &said,
        &["count as unknown: 2.", "0.0", "spin_rad_s has no number"],
    );
    has(&said, &["the scene's is taken"]);
    lacks(&said, &["00000000"]);
    let (code, said) = of(&|_| "nan", "");
    assert_eq!(code, Some(0), "{said}");
    has(&said, &["no position is a number"]);
    for mapping in ["foo=t_s", "stimulus_x_n=t_s", "t_s=nope"] {
        let (code, said) = of(&|_| "0", &format!("--column {mapping}"));
        assert_eq!(code, Some(2), "{mapping}: {said}");
        has(&said, &["--column"]);
    }
}
