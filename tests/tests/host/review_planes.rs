//! `review` of a rotor's record: both planes beside each other, on the terminal and on the page.

use firmware_bench::record::file::{PlaneRecord, RecordFile};
use firmware_bench::record::shapes::Shapes;
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Output;
use supervisor::Mode;
use system_tests::{host, machine_scene_path, run_scene};
use tempfile::TempDir;

/// The records of both planes of a run, as firmware would write them one after the other.
fn record_of_a_rotor(folder: &Path) -> Vec<u8> {
    let out = folder.join("run");
    let scene = machine_scene_path("overload_of_a_flexible_rotor");
    let ran = run_scene(&scene, &out, &["--no-trace"]);
    assert!(ran.status.success(), "{ran:?}");
    let files = fs::read_dir(out)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut records: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|end| end == "bin"))
        .collect();
    records.sort();
    assert_eq!(records.len(), 2, "{records:?}");
    let read = |path| fs::read(path).unwrap();
    records.iter().flat_map(read).collect()
}

fn review(file: &Path, more: &[&str]) -> Output {
    let mut command = host();
    command.arg("review").arg(file).args(more);
    command.output().expect("the host starts")
}

/// Rows of a table, cells separated by two blanks and more.
fn rows_of(text: &str, heading: &str) -> Vec<Vec<String>> {
    let cells = |line: &str| -> Vec<String> {
        let cells = line.split("  ").map(str::trim);
        let there = cells.filter(|cell| !cell.is_empty());
        there.map(str::to_owned).collect()
    };
    let mut lines = text.lines().skip_while(|line| !line.contains(heading));
    let head = lines
        .next()
        .unwrap_or_else(|| panic!("{heading} is not in {text}"));
    let rows = lines.skip(1).take_while(|line| !line.trim().is_empty());
    std::iter::once(head).chain(rows).map(cells).collect()
}

/// What is printed of both planes is on the page, to the last digit.
#[test]
fn the_page_of_a_rotor_has_what_is_printed() {
    let folder = TempDir::new().unwrap();
    let here = |name: &str| folder.path().join(name);
    fs::write(here("both.bin"), record_of_a_rotor(folder.path())).unwrap();
    let out = here("page").display().to_string();
    let shown = review(&here("both.bin"), &["--out", &out]);
    let text = String::from_utf8(shown.stdout).unwrap();
    assert!(shown.status.success(), "{text}");
    let page = fs::read_to_string(here("page/report.html")).unwrap();

    let planes = rows_of(&text, "figure");
    assert_eq!(planes[0], ["figure", "plane 0", "plane 1"]);
    let names: Vec<&str> = planes.iter().map(|row| &row[0][..]).collect();
    for row in [
        "touches",
        "hardest impact [m/s]",
        "severity of the event",
        "landings",
    ] {
        assert!(names.contains(&row), "{row} is not among {names:?}");
    }
    let shapes = rows_of(&text, "both planes in contact");
    assert_eq!(shapes.len(), 3, "{shapes:?}");
    for row in planes[1..].iter().chain(&shapes[1..]) {
        let [name, cells @ ..] = &row[..] else {
            panic!("{row:?}")
        };
        let cells: String = cells
            .iter()
            .map(|cell| format!("<td>{cell}</td>"))
            .collect();
        let row = format!("<th scope=\"row\">{name}</th>{cells}</tr>");
        assert!(page.contains(&row), "{row} is not on the page");
    }
    for said in [
        "all to the last bit as they are recorded.",
        "Plane 0. Retainer bearing",
        "Plane 1. Retainer bearing",
        "<h2>Tables of plane 1</h2>",
        "<caption>Modes of the recorded ticks</caption>",
        "<caption>The largest of each, to the end of the event</caption>",
    ] {
        assert!(page.contains(said), "{said}");
    }

    // The sentence has the sum and the worse of what stands there.
    let json: Value =
        serde_json::from_slice(&review(&here("both.bin"), &["--json"]).stdout).unwrap();
    let touches = planes.iter().find(|row| row[0] == "touches").unwrap();
    let sum: u64 = touches[1..].iter().map(|n| n.parse::<u64>().unwrap()).sum();
    assert_eq!(json["summary"]["touches"], sum);
    assert!(
        json["shapes"]["pairs"].as_u64() > Some(0),
        "{}",
        json["shapes"]
    );
}

/// Two planes that move as they are told to, in whirl.
fn moved(file: &RecordFile, positions_m: impl Fn(f64) -> [[f64; 2]; 2]) -> Option<Shapes> {
    let mut records: Vec<PlaneRecord> = file.records.clone();
    let first = *records[0].entries.values().next().unwrap();
    for (plane, record) in records.iter_mut().enumerate() {
        let units = record.units();
        let (clearance_m, rate_hz) = (units.clearance_m.unwrap(), units.sample_rate_hz.unwrap());
        for entry in record.entries.values_mut() {
            let ticks = entry.sequence.wrapping_sub(first.sequence);
            let at_m = positions_m(f64::from(ticks) / rate_hz)[plane];
            entry.position = at_m.map(|x| ((x / clearance_m) as f32).to_bits());
            entry.mode = Mode::BackwardWhirl as u8;
        }
    }
    Shapes::of(&records.iter().collect::<Vec<_>>())
}

fn circle(radius_m: f64, rate_hz: f64, t_s: f64) -> [f64; 2] {
    let (sin, cos) = (TAU * rate_hz * t_s).sin_cos();
    [radius_m * cos, radius_m * sin]
}

/// A cylindrical and a conical whirl, each with its rate and direction, and both at once.
#[test]
fn both_shapes_are_told_apart() {
    let folder = TempDir::new().unwrap();
    let file = RecordFile::of(&record_of_a_rotor(folder.path()));
    let near = |found: f64, wanted: f64| {
        assert!(
            (found - wanted).abs() < 1e-3 * wanted.abs() + 1e-9,
            "{found} for {wanted}"
        );
    };
    let both = |[x, y]: [f64; 2], sign: f64| [[x, y], [sign * x, sign * y]];

    let cylindrical = moved(&file, |t| both(circle(2e-4, -80.0, t), 1.0)).unwrap();
    near(cylindrical.together.rms_m, 2e-4);
    near(cylindrical.together.whirl_hz, -80.0);
    assert!(cylindrical.opposed.rms_m < 1e-10);

    let conical = moved(&file, |t| both(circle(1e-4, 120.0, t), -1.0)).unwrap();
    near(conical.opposed.rms_m, 1e-4);
    near(conical.opposed.whirl_hz, 120.0);
    assert!(conical.together.rms_m < 1e-10);

    let mixed = moved(&file, |t| {
        let ([a, b], [c, d]) = (circle(2e-4, -80.0, t), circle(5e-5, 200.0, t));
        [[a + c, b + d], [a - c, b - d]]
    })
    .unwrap();
    near(mixed.together.whirl_hz, -80.0);
    near(mixed.opposed.whirl_hz, 200.0);
    near(mixed.opposed.rms_m, 5e-5);

    // One plane alone has no shape, and levitation is none of contact.
    assert_eq!(Shapes::of(&[&file.records[0]]), None);
    let mut calm = file.records.clone();
    for entry in calm
        .iter_mut()
        .flat_map(|record| record.entries.values_mut())
    {
        entry.mode = Mode::Levitated as u8;
    }
    assert_eq!(Shapes::of(&calm.iter().collect::<Vec<_>>()), None);
}
