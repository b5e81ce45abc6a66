//! What is in the traces, and what the supervisor left behind.

use super::{RUN, short, short_scene};
use firmware_bench::record::file::RecordFile;
use firmware_bench::record::ticks::Ticks;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::trace::Recorder;
use firmware_bench::run::trace_columns::Columns;
use firmware_bench::run::trace_file::TraceFile;
use firmware_bench::scene::policy_kind::PolicyKind;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row, RowAccessor};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use system_tests::ran::{Folder, edited, has, lacks};
use system_tests::root;

/// A long run is written group by group, and every row is there, in its order.
#[test]
fn a_long_trace_has_several_groups() {
    let scene = system_tests::scene("impact_at_40_hz");
    let (_, trace) = run(&scene, PolicyKind::Passive, Keep::Trace, &mut |_| {}).unwrap();
    let rows = || trace.rows.iter().cycle().take(70_000);
    let folder = Folder::fresh();
    let path = folder.at("trace.parquet");
    let mut file = TraceFile::new(fs::File::create(&path).unwrap(), Columns::of_plane()).unwrap();
    rows().for_each(|row| file.row(row));
    file.end().unwrap();
    let reader = SerializedFileReader::new(fs::File::open(&path).unwrap()).unwrap();
    assert_eq!(reader.num_row_groups(), 2);
    let read = parquet_rows(&path);
    let times = read.iter().map(|row| row.get_double(0).unwrap());
    assert!(times.eq(rows().map(|row| row.plant.t_s)));
}

#[test]
fn traces_hold_every_sample_and_every_mode_change() {
    let folder = short_scene(&[]);
    folder.ran(RUN).good();
    let rows = rows_of(&folder, "supervisor");
    for name in [
        "rotor_x_m",
        "rotor_vy_m_s",
        "inner_ring_x_m",
        "outer_ring_vy_m_s",
        "spin_rad_s",
        "race_spin_rad_s",
        "contact_force_n",
        "commanded_x_n",
        "delivered_y_n",
    ] {
        column(&rows, name, number);
    }
    column(&rows, "supervisor_mode", word);
    let (mut samples, mut changes, mut last) = (0, 0, (-1.0, String::new()));
    let times = column(&rows, "t_s", number).into_iter();
    let modes = times.zip(column(&rows, "mode", word));
    for ((t, m), change) in modes.zip(between(&rows)) {
        assert!(t >= last.0, "time runs backwards at {t}");
        match change {
            true => changes += 1,
            false => samples += 1,
        }
        assert!(!change || m != last.1, "no change at {t}");
        last = (t, m);
    }
    assert_eq!(samples, 601, "30 ms at 20 kHz, both ends");
    let verdict = folder.json("out/verdict.json");
    let impacts = &verdict["policies"]["supervisor"]["impacts"];
    let impacts = impacts.as_u64().unwrap();
    assert!(
        impacts >= 1 && changes >= impacts,
        "{changes} changes, {impacts} impacts"
    );
}

/// The trace of a policy.
fn rows_of(folder: &Folder, policy: &str) -> Vec<Row> {
    parquet_rows(&folder.at(&format!("out/trace_{policy}.parquet")))
}

/// All rows of a Parquet file.
pub(crate) fn parquet_rows(path: &Path) -> Vec<Row> {
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let rows = reader.get_row_iter(None).unwrap();
    rows.map(Result::unwrap).collect()
}

/// Which rows are none of samples.
fn between(rows: &[Row]) -> Vec<bool> {
    column(rows, "mode_change", |f| *f == Field::Bool(true))
}

/// Of samples alone.
fn of_samples<T>(of: Vec<T>, between: &[bool]) -> Vec<T> {
    let all = of.into_iter().zip(between);
    all.filter(|(_, b)| !**b).map(|(x, _)| x).collect()
}

/// Without the table the ring is a bushing; with it contact spins the race up, towards the rotor's spin
/// of 200 Hz, or brakes it towards there.
#[test]
fn a_race_spins_with_the_rotor() {
    let of = |keys: &str| {
        let folder = short_scene(&[("[friction]", &format!("{keys}\n[friction]"))]);
        folder.ran(RUN).good();
        let spins = column(&rows_of(&folder, "supervisor"), "race_spin_rad_s", number);
        spins.last().unwrap() / std::f64::consts::TAU
    };
    assert_eq!(of(""), 0.0);
    let light = of("[race]\ninertia_kg_m2 = 1e-3\n");
    let heavy = of("[race]\ninertia_kg_m2 = 1e-1\n");
    let ahead = of("[race]\ninertia_kg_m2 = 1e-3\nstart_frequency_hz = 300.0\ndrag_n_m_s = 1e-6\n");
    assert!(light > 1.0 && light < 20.0, "{light}");
    assert!(heavy > 0.0 && heavy < 0.02 * light, "{heavy}");
    assert!(ahead > 280.0 && ahead < 299.0, "{ahead}");
}

/// A column of a trace by its name.
fn column<T>(rows: &[Row], name: &str, of: impl Fn(&Field) -> T) -> Vec<T> {
    let value = |row: &Row| {
        let mut columns = row.get_column_iter();
        let found = columns.find(|(column, _)| *column == name);
        found.map(|(_, field)| of(field))
    };
    (rows.iter().map(value).collect::<Option<_>>()).unwrap_or_else(|| panic!("no column {name}"))
}

fn word(field: &Field) -> String {
    match field {
        Field::Str(text) => text.clone(),
        other => panic!("{other} is no text"),
    }
}

fn number(field: &Field) -> f64 {
    match field {
        Field::Double(number) => *number,
        other => panic!("{other} is no number"),
    }
}

/// Mode, limits and events of every sample are the same in the trace and in the flight record, the verdict counts what is
/// there, and the report tells it.
#[test]
fn what_the_supervisor_said_is_in_trace_record_verdict_and_report() {
    let folder = Folder::fresh();
    folder.ran("run @impact_at_40_hz --out out").good();
    let rows = rows_of(&folder, "supervisor");
    let between = between(&rows);
    let said = |what: &str| column(&rows, &format!("supervisor_{what}"), word);
    let [modes, limits, events] =
        ["mode", "limits", "events"].map(|what| of_samples(said(what), &between));
    for (events, between) in said("events").iter().zip(&between) {
        assert!(!between || events.is_empty(), "{events} twice");
    }
    // The command of a sample takes effect at the next, and the record holds it with the sample.
    let [commanded, times] =
        ["commanded_x_n", "t_s"].map(|name| of_samples(column(&rows, name, number), &between));

    let cap_n = 150.0;
    let bytes = folder.bytes("out/record_supervisor.bin");
    let file = RecordFile::of(&bytes);
    assert!(file.is_intact(), "{:?}", file.damage);
    let record = Ticks::of(&file.records[0]);
    assert!(record.ticks.len() > 300 && record.missing == 0);
    for tick in &record.ticks {
        let at = tick.sequence as usize;
        assert_eq!(modes[at], tick.mode, "{at}");
        assert_eq!(limits[at], tick.limits.join(" "), "{at}");
        // The record keeps the first 16 of the events.
        let kept = events[at]
            .replace(" RECORD_FROZEN", "")
            .replace("RECORD_FROZEN", "");
        assert_eq!(kept, tick.events.join(" "), "{at}");
        let recorded_n = tick.force_n.unwrap()[0];
        let apart = (commanded[at + 1] - recorded_n).abs();
        assert!(apart <= 1e-6 * cap_n, "{at}: {apart} N");
    }

    let verdict = folder.json("out/verdict.json");
    let supervision = &verdict["policies"]["supervisor"]["supervision"];
    assert!(verdict["policies"]["passive"]["supervision"].is_null());
    let told = |key: &str| supervision[key].as_f64().unwrap();
    let with = |name: &str| {
        let has_it = |e: &&String| e.split(' ').any(|e| e == name);
        events.iter().filter(has_it).count()
    };
    assert_eq!(supervision["engagements"], with("ENGAGED"));
    // The last row stands at the end of the run: no tick begins there.
    let modes = &modes[..modes.len() - 1];
    let engaged = modes.iter().filter(|m| *m != "levitated").count();
    let off_s = told("engaged_s") - engaged as f64 / 20e3;
    assert!(off_s.abs() < 1e-9, "{off_s}, {engaged}");
    let first = events.iter().position(|e| e.contains("ENGAGED")).unwrap();
    assert_eq!(supervision["first_engaged_s"], times[first]);
    let severities = column(&rows, "supervisor_severity", number);
    let highest = severities.iter().copied().fold(0.0, f64::max);
    let off = told("expected_severity_max") / highest - 1.0;
    assert!(highest > 1.0 && off.abs() < 1e-6, "{off}, {highest}");
    assert_eq!(supervision["sensor_faults"], 0);
    assert_eq!(supervision["landings"], 1);
    assert_eq!(supervision["flight_record_crc"], supervisor::crc_of(&bytes));
    // It begins on the wall at 0.35 m/s, which nobody has seen coming; the later impacts are slower.
    let fastest = told("impact_speed_max_m_s");
    assert!(fastest > 0.1 && fastest < 0.35, "{fastest}");
    assert_eq!(supervision["coast_down"], false);
    let report = folder.text("out/report.html");
    has(&report, &["What happened: supervisor"]);
    lacks(&report, &[">nothing<"]);
    // The data for the script has them once more.
    let (drawn, data) = report.split_once("<script").unwrap();
    for event in ["ENGAGED", "HANDOVER", "LEVITATED", "RECORD_FROZEN"] {
        has(data, &[event]);
        let (told, said) = (drawn.matches(event).count(), with(event));
        assert!(said > 0 && told == said, "{event}: {told} of {said}");
    }
}

/// What the levitation controller asked for is what it would command alone, up to where the supervisor takes over;
/// policies without a supervisor have nothing there.
#[test]
fn levitation_is_in_the_trace() {
    let folder = Folder::fresh();
    folder.ran("run @overload_then_release --out out").good();
    let [supervised, alone] = ["supervisor", "levitation"].map(|policy| {
        let rows = rows_of(&folder, policy);
        let between = between(&rows);
        of_samples(rows, &between)
    });
    let asked = column(&supervised, "levitation_x_n", number);
    let commanded = column(&alone, "commanded_x_n", number);
    let modes = column(&supervised, "supervisor_mode", word);
    let engaged = modes.iter().position(|mode| mode != "levitated").unwrap();
    assert!(engaged > 400);
    for at in 0..engaged {
        let (asked, commanded) = (asked[at], commanded[at + 1]);
        // In single precision at the supervisor's border.
        let same = (asked - commanded).abs() <= 1e-6 * commanded.abs();
        assert!(same, "{at}: {asked}, {commanded}");
    }
    for name in ["levitation_x_n", "levitation_y_n", "supervisor_severity"] {
        let all = column(&alone, name, number);
        assert!(all.iter().all(|x| *x == 0.0), "{name}");
    }
    for name in ["supervisor_mode", "supervisor_limits", "supervisor_events"] {
        let all = column(&alone, name, word);
        assert!(all.iter().all(String::is_empty), "{name}");
    }

    // Numbers say what the words say, as the documentation has them; bits are there where names are.
    let text = fs::read_to_string(root().join("docs/src/host/results.md")).unwrap();
    let told = |column: &str| {
        let begins = format!("| `{column}_code`");
        text.lines().find(|l| l.starts_with(&begins)).unwrap()
    };
    use supervisor::Mode as S;
    let modes = [
        S::Levitated,
        S::Approach,
        S::Bounce,
        S::BackwardWhirl,
        S::Pinned,
        S::Handover,
        S::SensorFault,
        S::HandedBack,
    ];
    let all = modes.map(|mode| format!("{} `{}`", mode as u8, mode.name()));
    has(told("supervisor_mode"), &[&all.join(", ")]);
    for name in ["mode", "supervisor_mode"] {
        let numbers = column(&supervised, &format!("{name}_code"), number);
        let words = column(&supervised, name, word);
        assert!(words.iter().collect::<BTreeSet<_>>().len() > 1, "{name}");
        for (number, word) in numbers.iter().zip(&words) {
            has(told(name), &[&format!("{number} `{word}`")]);
        }
    }
    let nothing = |rows: &[Row], name: &str| -> Vec<bool> {
        let bits = column(rows, &format!("{name}_code"), number);
        for (bits, word) in bits.iter().zip(&column(rows, name, word)) {
            let (bits, names) = (*bits as u32, word.split_whitespace().count());
            assert_eq!(bits.count_ones() as usize, names, "{name}: {bits}, {word}");
        }
        bits.iter().map(|bits| *bits == 0.0).collect()
    };
    for name in ["supervisor_limits", "supervisor_events"] {
        assert!(nothing(&supervised, name).contains(&false), "{name}");
        assert!(!nothing(&alone, name).contains(&false), "{name}");
    }
    let without = column(&alone, "supervisor_mode_code", number);
    assert!(without.iter().all(|code| *code == -1.0));
}

/// Traces and records of policies that a scene has no longer would be taken for its results.
#[test]
fn traces_of_an_earlier_run_go() {
    let folder = short_scene(&[]);
    folder.ran(RUN).good();
    assert!(folder.at("out/trace_supervisor.parquet").exists());
    for name in [
        "record_supervisor.bin",
        "record_mine.bin",
        "trace_mine.parquet",
    ] {
        folder.put(&format!("out/{name}"), "kept or not");
    }
    fs::create_dir(folder.at("out/trace_damping.parquet")).unwrap();
    let all = "[\"passive\", \"radial\", \"levitation\", \"supervisor\"]";
    folder.put("short.toml", edited(&short(), &[(all, "[\"radial\"]")]));
    folder.ran(RUN).good();
    assert_eq!(
        folder.names("out"),
        [
            "record_mine.bin",
            "report.html",
            "trace_damping.parquet",
            "trace_mine.parquet",
            "trace_radial.parquet",
            "verdict.json"
        ]
    );
}

/// A supervisor that had nothing to do has a table that says so.
#[test]
fn a_table_of_nothing_says_nothing() {
    let folder = Folder::fresh();
    folder.put(
        "short.toml",
        short().split("[[disturbance]]").next().unwrap(),
    );
    folder.ran(RUN).good();
    let report = folder.text("out/report.html");
    let (_, table) = report.split_once("What happened: supervisor").unwrap();
    has(table, &["<td class=\"words\" colspan=\"5\">nothing</td>"]);
}
