//! `review` of a rotor's record: both planes beside each other, on the terminal and on the page.

use firmware_bench::record::file::{PlaneRecord, RecordFile};
use firmware_bench::record::shapes::Shapes;
use std::f64::consts::TAU;
use supervisor::Mode;
use system_tests::ran::{Folder, has};

/// The records of both planes of a run, as firmware would write them one after the other.
fn record_of_a_rotor(folder: &Folder) -> Vec<u8> {
    let run = "run @machines/overload_of_a_flexible_rotor --out run --no-trace";
    folder.ran(run).good();
    let mut records = folder.names("run");
    records.retain(|name| name.ends_with(".bin"));
    assert_eq!(records.len(), 2, "{records:?}");
    let read = |name: &String| folder.bytes(&format!("run/{name}"));
    records.iter().flat_map(read).collect()
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
    let folder = Folder::fresh();
    folder.put("both.bin", record_of_a_rotor(&folder));
    let text = folder.ran("review both.bin --out page").good();
    let page = folder.text("page/report.html");

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
        let cells = row[1..].iter().map(|cell| format!("<td>{cell}</td>"));
        let cells: String = cells.collect();
        has(
            &page,
            &[&format!("<th scope=\"row\">{}</th>{cells}</tr>", row[0])],
        );
    }
    for said in [
        "all to the last bit as they are recorded.",
        "Plane 0. Retainer bearing",
        "Plane 1. Retainer bearing",
        "<h2>Tables of plane 1</h2>",
        "<caption>Modes of the recorded ticks</caption>",
        "<caption>The largest of each, to the end of the event</caption>",
    ] {
        has(&page, &[said]);
    }

    // The sentence has the sum and the worse of what stands there.
    let json = folder.ran("review both.bin --json").json();
    let touches = planes.iter().find(|row| row[0] == "touches").unwrap();
    let sum: u64 = touches[1..].iter().map(|n| n.parse::<u64>().unwrap()).sum();
    assert_eq!(json["summary"]["touches"], sum);
    assert!(json["shapes"]["pairs"].as_u64() > Some(0), "{json}");
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
    let file = RecordFile::of(&record_of_a_rotor(&Folder::fresh()));
    let near = |found: f64, wanted: f64| {
        let off = (found - wanted).abs();
        assert!(off < 1e-3 * wanted.abs() + 1e-9, "{found} for {wanted}");
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
