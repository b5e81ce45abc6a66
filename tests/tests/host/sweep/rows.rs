//! What stands in the rows.

use super::{DRAWS, SWEEP, sweep_of};
use crate::run::traces::parquet_rows;
use firmware_bench::sweep::plan::Plan;
use parquet::record::Field;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use system_tests::ran::{Folder, has};
use system_tests::{root, scene_path};

type Row = BTreeMap<String, Field>;

fn rows(folder: &Folder) -> Vec<Row> {
    let row = |row: &parquet::record::Row| {
        let columns = row.get_column_iter();
        columns
            .map(|(name, field)| (name.clone(), field.clone()))
            .collect()
    };
    let all = parquet_rows(&folder.at("out/results.parquet"));
    all.iter().map(row).collect()
}

/// A cell as it would stand in JSON.
fn json(field: &Field) -> Value {
    match field {
        Field::Double(x) => (*x).into(),
        Field::Long(x) => (*x).into(),
        Field::Bool(x) => (*x).into(),
        Field::Str(text) => text.as_str().into(),
        Field::Null => Value::Null,
        other => panic!("{other:?}"),
    }
}

/// Every figure that `run` prints of a policy is the cell of its row.
fn check_figures(printed: &Value, row: &Row, before: &str) -> usize {
    let mut checked = 0;
    for (key, value) in printed.as_object().unwrap() {
        match key.as_str() {
            // Never twice the same; names and parts of their own.
            "run_time_s" | "real_time_ratio" | "planes" | "name" => continue,
            "supervision" => checked += check_figures(value, row, before),
            key => {
                let column = format!("{before}{key}");
                let cell = row
                    .get(&column)
                    .unwrap_or_else(|| panic!("no column {column}"));
                let cell = json(cell);
                // What reads JSON here is off in the last digit now and then.
                let close = |a: f64, b: f64| (a - b).abs() <= 1e-15 * a.abs();
                let numbers = cell.as_f64().zip(value.as_f64());
                let same = cell == *value || numbers.is_some_and(|(a, b)| close(a, b));
                assert!(same, "{column}: {cell}, printed {value}");
                checked += 1;
            }
        }
    }
    checked
}

fn run_json(folder: &Folder, line: &str) -> Value {
    folder
        .ran(&format!("run {line} --out run --json --no-trace"))
        .json()
}

#[test]
fn a_run_that_is_kept_as_a_scene_comes_to_what_its_row_says() {
    let array = "[[vary]]\nkey = \"disturbance[0].force_n[0]\"\nvalues = [900, 1300]\n\
        [[vary]]\nkey = \"supervisor.hold_share\"\nuniform = [0.5, 0.9]\n";
    let lines = format!("worst = 2\nworst_by = \"severity_index\"\n{DRAWS}{array}");
    let folder = sweep_of(&lines.replace("runs = 70", "runs = 24"));
    let text = folder.ran(SWEEP).good();
    let rows = rows(&folder);
    assert_eq!(rows.len(), 48);
    let of = |row: &Row, key: &str| json(&row[key]).as_f64().unwrap_or(f64::NAN);
    let is_of = |row: &Row, policy: &str| json(&row["policy"]) == policy;
    let mut ranked: Vec<&Row> = rows.iter().filter(|row| is_of(row, "supervisor")).collect();
    ranked.sort_by(|a, b| of(b, "severity_index").total_cmp(&of(a, "severity_index")));
    for (place, row) in ranked.iter().take(2).enumerate() {
        let run = of(row, "run");
        let path = format!("out/worst_{}_run_{run}.toml", place + 1);
        has(&text, &[&format!("firmware-host run {path}")]);
        // Comments stay.
        has(&folder.text(&path), &["# 1 kHz amplifier"]);
        let printed = run_json(&folder, &path);
        assert_eq!(printed["seed"].as_f64(), Some(of(row, "seed")));
        let checked = check_figures(&printed["policies"]["supervisor"], row, "");
        assert!(checked > 30, "{checked} figures");
        let mut same_run = rows.iter().filter(|row| of(row, "run") == run);
        let alone = same_run.find(|row| is_of(row, "levitation"));
        check_figures(&printed["policies"]["levitation"], alone.unwrap(), "");
    }
    // What varies varies as it should, and no two runs have one seed.
    let mut frictions = ranked.iter().map(|row| of(row, "friction.coefficient"));
    assert!(frictions.all(|x| (0.05..=0.3).contains(&x)));
    let seeds = ranked.iter().map(|row| of(row, "seed") as u64);
    assert_eq!(seeds.collect::<BTreeSet<u64>>().len(), 24);
}

#[test]
fn a_whole_rotor_has_the_figures_of_its_planes() {
    let folder = Folder::fresh();
    let lines = format!(
        "scene = {:?}\ndesign = \"grid\"\nworst = 0\nworst_by = \"free_end.peak_contact_force_n\"\n\
         [[vary]]\nkey = \"run.duration_s\"\nvalues = [0.01]\n[[vary]]\nkey = \"run.seed\"\nvalues = [5]\n",
        scene_path("machines/drop_of_both_ends")
            .display()
            .to_string()
    );
    folder.put("sweep.toml", lines);
    folder.ran(SWEEP).good();
    let rows = rows(&folder);
    assert_eq!((rows.len(), json(&rows[0]["seed"])), (1, 5.into()));
    let line = "@machines/drop_of_both_ends --set run.duration_s=0.01 --seed 5";
    let printed = &run_json(&folder, line)["policies"]["passive"];
    assert!(check_figures(printed, &rows[0], "") > 10);
    for (i, name) in ["coupling_end.", "free_end."].into_iter().enumerate() {
        check_figures(&printed["planes"][i], &rows[0], name);
    }
}

/// The sweep files that the documentation shows.
#[test]
fn the_examples_of_the_page_are_sweeps() {
    let page = fs::read_to_string(root().join("docs/src/host/sweep.md")).unwrap();
    let folder = Folder::fresh();
    fs::create_dir(folder.at("sweeps")).unwrap();
    for scene in ["overload_then_release", "impact_at_40_hz"] {
        folder.scene(&format!("{scene}.toml"), scene, &[]);
    }
    let texts = page.split("```toml\n").skip(1);
    let plans: Vec<Plan> = (texts.filter_map(|text| text.split("```").next()))
        .map(|text| Plan::load(&folder.put("sweeps/example.toml", text)).unwrap())
        .collect();
    let sizes: Vec<(u64, usize)> = (plans.iter())
        .map(|plan| (plan.runs(), plan.policies().len()))
        .collect();
    assert_eq!(sizes, [(1000, 2)]);
    let forces: BTreeSet<Option<i64>> = (0..1000)
        .map(|run| plans[0].point(run).values[1].as_integer())
        .collect();
    assert!(forces.into_iter().eq([900, 1300, 1700].map(Some)));
}

/// What makes no scene is a row with its error, and stops nothing.
#[test]
fn a_run_without_figures_says_why() {
    let lines = "design = \"grid\"\nrepeats = 2\n[[vary]]\nkey = \"contact.restitution\"\nvalues = [0.7, 1.5]\n";
    let folder = sweep_of(lines);
    let text = folder.ran(SWEEP).good();
    has(&text, &["2 failed", "contact.restitution: is 1.5"]);
    let rows = rows(&folder);
    for (i, row) in rows.iter().enumerate() {
        // Two repeats of two policies of each value.
        let fails = i >= 4;
        assert_eq!(json(&row["outcome"]).is_null(), fails);
        let error = json(&row["error"]);
        let of_scene = error.as_str().is_some_and(|e| e.starts_with("short.toml:"));
        assert_eq!(of_scene, fails, "{error}");
    }
    assert_eq!(rows.len(), 8);
    // Where nothing is left there is nothing to believe.
    let none = sweep_of(&lines.replace("[0.7, 1.5]", "[1.5]"));
    has(&none.ran(SWEEP).fails(1), &["results were written"]);
}
