//! What is in the traces, and what the supervisor left behind.

use super::{names, short_scene};
use firmware_bench::record::file::RecordFile;
use firmware_bench::record::ticks::Ticks;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::trace::Recorder;
use firmware_bench::run::trace_columns::Columns;
use firmware_bench::run::trace_file::TraceFile;
use firmware_bench::scene::policy_kind::PolicyKind;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row, RowAccessor};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use system_tests::{root, run_scene, scene_path};
use tempfile::TempDir;

/// A long run is written group by group, and every row is there, in its order.
#[test]
fn a_long_trace_has_several_groups() {
    let scene = system_tests::scene("impact_at_40_hz");
    let (_, trace) = run(&scene, PolicyKind::Passive, Keep::Trace, &mut |_| {}).unwrap();
    let rows = || trace.rows.iter().cycle().take(70_000);
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("trace.parquet");
    let mut file = TraceFile::new(fs::File::create(&path).unwrap(), Columns::of_plane()).unwrap();
    rows().for_each(|row| file.row(row));
    file.end().unwrap();
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    assert_eq!(reader.num_row_groups(), 2);
    let read = reader.get_row_iter(None).unwrap();
    let times: Vec<f64> = read
        .map(|row| row.unwrap().get_double(0).unwrap())
        .collect();
    assert!(times.into_iter().eq(rows().map(|row| row.plant.t_s)));
}

#[test]
fn traces_hold_every_sample_and_every_mode_change() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let out = folder.path().join("out");
    assert!(run_scene(&scene, &out, &[]).status.success());
    let reader =
        SerializedFileReader::new(fs::File::open(out.join("trace_supervisor.parquet")).unwrap())
            .unwrap();
    let schema = reader.metadata().file_metadata().schema_descr();
    let columns: Vec<&str> = (0..schema.num_columns())
        .map(|i| schema.column(i).name().to_owned().leak() as &str)
        .collect();
    for name in [
        "t_s",
        "rotor_x_m",
        "rotor_vy_m_s",
        "inner_ring_x_m",
        "outer_ring_vy_m_s",
        "spin_rad_s",
        "race_spin_rad_s",
        "contact_force_n",
        "commanded_x_n",
        "delivered_y_n",
        "mode",
        "supervisor_mode",
    ] {
        assert!(columns.contains(&name), "{name}");
    }
    let at = |name: &str| columns.iter().position(|c| *c == name).unwrap();
    let (time, mode, change) = (at("t_s"), at("mode"), at("mode_change"));
    let (mut samples, mut changes, mut last) = (0, 0, (-1.0, String::new()));
    for row in reader.get_row_iter(None).unwrap() {
        let row = row.unwrap();
        let (t, m) = (
            row.get_double(time).unwrap(),
            row.get_string(mode).unwrap().clone(),
        );
        assert!(t >= last.0, "time runs backwards at {t}");
        if row.get_bool(change).unwrap() {
            changes += 1;
            assert_ne!(m, last.1, "no change at {t}");
        } else {
            samples += 1;
        }
        last = (t, m);
    }
    assert_eq!(samples, 601, "30 ms at 20 kHz, both ends");
    let verdict: Value =
        serde_json::from_slice(&fs::read(out.join("verdict.json")).unwrap()).unwrap();
    let impacts = verdict["policies"]["supervisor"]["impacts"]
        .as_u64()
        .unwrap();
    assert!(
        impacts >= 1 && changes >= impacts,
        "{changes} changes, {impacts} impacts"
    );
}

/// The trace of a policy.
fn rows_of(out: &Path, policy: &str) -> Vec<Row> {
    let file = fs::File::open(out.join(format!("trace_{policy}.parquet"))).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let rows = reader.get_row_iter(None).unwrap();
    rows.map(Result::unwrap).collect()
}

/// Without the table the ring is a bushing; with it contact spins the race up, towards the rotor's spin
/// of 200 Hz, or brakes it towards there.
#[test]
fn a_race_spins_with_the_rotor() {
    let folder = TempDir::new().unwrap();
    let of = |keys: &str| {
        let scene = short_scene(folder.path(), |t| {
            t.replace("[friction]", &format!("{keys}\n[friction]"))
        });
        let out = folder.path().join("out");
        let result = run_scene(&scene, &out, &[]);
        assert!(
            result.status.success(),
            "{}",
            String::from_utf8_lossy(&result.stderr)
        );
        let spins = column(&rows_of(&out, "supervisor"), "race_spin_rad_s", number);
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
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    assert!(
        run_scene(&scene_path("impact_at_40_hz"), &out, &[])
            .status
            .success()
    );
    let rows = rows_of(&out, "supervisor");
    let between = column(&rows, "mode_change", |f| *f == Field::Bool(true));
    let of_samples = |name: &str| -> Vec<String> {
        let all = column(&rows, name, word).into_iter().zip(&between);
        all.filter(|(_, b)| !**b).map(|(x, _)| x).collect()
    };
    let [modes, limits, events] =
        ["mode", "limits", "events"].map(|what| of_samples(&format!("supervisor_{what}")));
    for (events, between) in column(&rows, "supervisor_events", word)
        .iter()
        .zip(&between)
    {
        assert!(!between || events.is_empty(), "{events} twice");
    }
    // The command of a sample takes effect at the next, and the record holds it with the sample.
    let commanded = column(&rows, "commanded_x_n", number)
        .into_iter()
        .zip(&between);
    let commanded: Vec<f64> = commanded.filter(|(_, b)| !**b).map(|(x, _)| x).collect();

    let cap_n = 150.0;
    let bytes = fs::read(out.join("record_supervisor.bin")).unwrap();
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

    let text = fs::read(out.join("verdict.json")).unwrap();
    let verdict: Value = serde_json::from_slice(&text).unwrap();
    let supervision = &verdict["policies"]["supervisor"]["supervision"];
    assert!(verdict["policies"]["passive"]["supervision"].is_null());
    let with = |name: &str| {
        events
            .iter()
            .filter(|e| e.split(' ').any(|e| e == name))
            .count()
    };
    assert_eq!(supervision["engagements"], with("ENGAGED"));
    // The last row stands at the end of the run: no tick begins there.
    let engaged = modes[..modes.len() - 1]
        .iter()
        .filter(|m| *m != "levitated")
        .count();
    let engaged_s = supervision["engaged_s"].as_f64().unwrap();
    assert!(
        (engaged_s - engaged as f64 / 20e3).abs() < 1e-9,
        "{engaged_s}, {engaged}"
    );
    let first = events.iter().position(|e| e.contains("ENGAGED")).unwrap();
    let times: Vec<f64> = (column(&rows, "t_s", number).into_iter().zip(&between))
        .filter(|(_, b)| !**b)
        .map(|(t, _)| t)
        .collect();
    assert_eq!(supervision["first_engaged_s"], times[first]);
    let severities = column(&rows, "supervisor_severity", number);
    let highest = severities.iter().copied().fold(0.0, f64::max);
    let peak = supervision["expected_severity_max"].as_f64().unwrap();
    assert!(
        highest > 1.0 && (peak / highest - 1.0).abs() < 1e-6,
        "{peak}, {highest}"
    );
    assert_eq!(supervision["sensor_faults"], 0);
    assert_eq!(supervision["landings"], 1);
    assert_eq!(supervision["flight_record_crc"], supervisor::crc_of(&bytes));
    // It begins on the wall at 0.35 m/s, which nobody has seen coming; the later impacts are slower.
    let fastest = supervision["impact_speed_max_m_s"].as_f64().unwrap();
    assert!(fastest > 0.1 && fastest < 0.35, "{fastest}");
    assert_eq!(supervision["coast_down"], false);
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("What happened: supervisor"));
    assert!(!report.contains(">nothing<"));
    // The data for the script has them once more.
    let (drawn, data) = report.split_once("<script").unwrap();
    for event in ["ENGAGED", "HANDOVER", "LEVITATED", "RECORD_FROZEN"] {
        assert!(data.contains(event), "{event}");
        let (shown, all) = (drawn.matches(event).count(), with(event));
        assert!(all > 0 && shown == all, "{event}: {shown} of {all}");
    }
}

/// What the levitation controller asked for is what it would command alone, up to where the supervisor takes over;
/// policies without a supervisor have nothing there.
#[test]
fn levitation_is_in_the_trace() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    assert!(
        run_scene(&scene_path("overload_then_release"), &out, &[])
            .status
            .success()
    );
    let rows = |policy: &str| -> Vec<Row> {
        let rows = rows_of(&out, policy);
        let between = column(&rows, "mode_change", |f| *f == Field::Bool(true));
        let both = rows.into_iter().zip(between);
        both.filter(|(_, between)| !between)
            .map(|(row, _)| row)
            .collect()
    };
    let (supervised, alone) = (rows("supervisor"), rows("levitation"));
    let asked = column(&supervised, "levitation_x_n", number);
    let commanded = column(&alone, "commanded_x_n", number);
    let modes = column(&supervised, "supervisor_mode", word);
    let engaged = modes.iter().position(|mode| mode != "levitated").unwrap();
    assert!(engaged > 400);
    for at in 0..engaged {
        let (asked, commanded) = (asked[at], commanded[at + 1]);
        // In single precision at the supervisor's border.
        assert!(
            (asked - commanded).abs() <= 1e-6 * commanded.abs(),
            "{at}: {asked}, {commanded}"
        );
    }
    for name in ["levitation_x_n", "levitation_y_n", "supervisor_severity"] {
        assert!(
            column(&alone, name, number).iter().all(|x| *x == 0.0),
            "{name}"
        );
    }
    for name in ["supervisor_mode", "supervisor_limits", "supervisor_events"] {
        assert!(
            column(&alone, name, word).iter().all(String::is_empty),
            "{name}"
        );
    }

    // Numbers say what the words say, as the documentation has them; bits are there where names are.
    let text = fs::read_to_string(root().join("docs/src/host/results.md")).unwrap();
    let docs = |column: &str| {
        let line = text
            .lines()
            .find(|l| l.starts_with(&format!("| `{column}_code`")));
        line.unwrap().to_owned()
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
    let all: Vec<String> = modes
        .iter()
        .map(|mode| format!("{} `{}`", *mode as u8, mode.name()))
        .collect();
    assert!(docs("supervisor_mode").contains(&all.join(", ")), "{all:?}");
    for name in ["mode", "supervisor_mode"] {
        let (line, numbers) = (
            docs(name),
            column(&supervised, &format!("{name}_code"), number),
        );
        let words = column(&supervised, name, word);
        assert!(words.iter().collect::<BTreeSet<_>>().len() > 1, "{name}");
        for (number, word) in numbers.iter().zip(&words) {
            assert!(
                line.contains(&format!("{number} `{word}`")),
                "{number}: {word}"
            );
        }
    }
    let nothing = |rows: &[Row], name: &str| -> Vec<bool> {
        let bits = column(rows, &format!("{name}_code"), number);
        let words = column(rows, name, word);
        (bits.iter().zip(&words)).for_each(|(bits, word)| {
            let names = word.split_whitespace().count();
            assert_eq!(
                (*bits as u32).count_ones() as usize,
                names,
                "{name}: {bits}, {word}"
            );
        });
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
    let folder = TempDir::new().unwrap();
    let all = "policies = [\"passive\", \"radial\", \"levitation\", \"supervisor\"]";
    let out = folder.path().join("out");
    assert!(
        run_scene(&short_scene(folder.path(), |t| t), &out, &[])
            .status
            .success()
    );
    assert!(names(&out).contains(&"trace_supervisor.parquet".to_owned()));
    for name in [
        "record_supervisor.bin",
        "record_mine.bin",
        "trace_mine.parquet",
    ] {
        fs::write(out.join(name), "kept or not").unwrap();
    }
    fs::create_dir(out.join("trace_damping.parquet")).unwrap();
    let fewer = short_scene(folder.path(), |t| t.replace(all, "policies = [\"radial\"]"));
    assert!(run_scene(&fewer, &out, &[]).status.success());
    assert_eq!(
        names(&out),
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
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| {
        let calm = t.split("[[disturbance]]").next().unwrap();
        calm.to_owned()
    });
    let out = folder.path().join("out");
    let result = run_scene(&scene, &out, &[]);
    assert!(result.status.success());
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    let (_, table) = report.split_once("What happened: supervisor").unwrap();
    assert!(table.contains("<td class=\"words\" colspan=\"5\">nothing</td>"));
}
