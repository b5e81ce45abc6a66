//! What stands in the rows.

use super::{DRAWS, succeeds, sweep, sweep_file};
use firmware_bench::sweep::plan::Plan;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use system_tests::{host, machine_scene_path, root, scene_path};
use tempfile::TempDir;

type Row = BTreeMap<String, Field>;

fn rows(out: &Path) -> Vec<Row> {
    let file = fs::File::open(out.join("results.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let rows = reader.get_row_iter(None).unwrap();
    let row = |row: parquet::record::Row| {
        let columns = row.get_column_iter();
        columns
            .map(|(name, field)| (name.clone(), field.clone()))
            .collect()
    };
    rows.map(|all| row(all.unwrap())).collect()
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

fn run_json(scene: &Path, out: &Path, more: &[&str]) -> Value {
    let mut run = host();
    run.arg("run")
        .arg(scene)
        .arg("--out")
        .arg(out)
        .args(["--json", "--no-trace"])
        .args(more);
    serde_json::from_str(&succeeds(&run.output().unwrap())).unwrap()
}

#[test]
fn a_run_that_is_kept_as_a_scene_comes_to_what_its_row_says() {
    let folder = TempDir::new().unwrap();
    let array = "[[vary]]\nkey = \"disturbance[0].force_n[0]\"\nvalues = [900, 1300]\n\
        [[vary]]\nkey = \"supervisor.hold_share\"\nuniform = [0.5, 0.9]\n";
    let lines = format!("worst = 2\nworst_by = \"severity_index\"\n{DRAWS}{array}")
        .replace("runs = 70", "runs = 24");
    let file = sweep_file(folder.path(), &lines);
    let out = folder.path().join("out");
    let text = succeeds(&sweep(&file, &out, &[]));
    let rows = rows(&out);
    assert_eq!(rows.len(), 48);
    let of = |row: &Row, key: &str| json(&row[key]).as_f64().unwrap_or(f64::NAN);
    let mut ranked: Vec<&Row> = rows
        .iter()
        .filter(|row| json(&row["policy"]) == "supervisor")
        .collect();
    ranked.sort_by(|a, b| of(b, "severity_index").total_cmp(&of(a, "severity_index")));
    for (place, row) in ranked.iter().take(2).enumerate() {
        let run = of(row, "run");
        let path = out.join(format!("worst_{}_run_{run}.toml", place + 1));
        assert!(
            text.contains(&format!("firmware-host run {}", path.display())),
            "{text}"
        );
        let scene = fs::read_to_string(&path).unwrap();
        assert!(
            scene.contains("# 1 kHz amplifier"),
            "comments stay: {scene}"
        );
        let printed = run_json(&path, &folder.path().join("again"), &[]);
        assert_eq!(printed["seed"].as_f64(), Some(of(row, "seed")));
        let checked = check_figures(&printed["policies"]["supervisor"], row, "");
        assert!(checked > 30, "{checked} figures");
        let alone = rows
            .iter()
            .find(|row| of(row, "run") == run && json(&row["policy"]) == "levitation");
        check_figures(&printed["policies"]["levitation"], alone.unwrap(), "");
    }
    // What varies varies as it should, and no two runs have one seed.
    let frictions: Vec<f64> = ranked
        .iter()
        .map(|row| of(row, "friction.coefficient"))
        .collect();
    assert!(frictions.iter().all(|x| (0.05..=0.3).contains(x)));
    let seeds: std::collections::BTreeSet<u64> =
        ranked.iter().map(|row| of(row, "seed") as u64).collect();
    assert_eq!(seeds.len(), 24);
}

#[test]
fn a_whole_rotor_has_the_figures_of_its_planes() {
    let folder = TempDir::new().unwrap();
    let scene = machine_scene_path("drop_of_both_ends");
    let file = folder.path().join("drop.toml");
    let lines = format!(
        "scene = {:?}\ndesign = \"grid\"\nworst = 0\nworst_by = \"free_end.peak_contact_force_n\"\n\
         [[vary]]\nkey = \"run.duration_s\"\nvalues = [0.01]\n[[vary]]\nkey = \"run.seed\"\nvalues = [5]\n",
        scene.display().to_string()
    );
    fs::write(&file, lines).unwrap();
    let out = folder.path().join("out");
    succeeds(&sweep(&file, &out, &[]));
    let rows = rows(&out);
    assert_eq!((rows.len(), json(&rows[0]["seed"])), (1, 5.into()));
    let settings = ["--set", "run.duration_s=0.01", "--seed", "5"];
    let printed = run_json(&scene, &folder.path().join("run"), &settings);
    let printed = &printed["policies"]["passive"];
    assert!(check_figures(printed, &rows[0], "") > 10);
    for (i, name) in ["coupling_end.", "free_end."].into_iter().enumerate() {
        check_figures(&printed["planes"][i], &rows[0], name);
    }
}

/// The sweep files that the documentation shows.
#[test]
fn the_examples_of_the_page_are_sweeps() {
    let page = fs::read_to_string(root().join("docs/src/host/sweep.md")).unwrap();
    let folder = TempDir::new().unwrap();
    let below = folder.path().join("sweeps");
    fs::create_dir(&below).unwrap();
    for scene in ["overload_then_release", "impact_at_40_hz"] {
        let beside = folder.path().join(format!("{scene}.toml"));
        fs::copy(scene_path(scene), beside).unwrap();
    }
    let texts = page.split("```toml\n").skip(1);
    let plans: Vec<Plan> = (texts.filter_map(|text| text.split("```").next()))
        .map(|text| {
            fs::write(below.join("example.toml"), text).unwrap();
            Plan::load(&below.join("example.toml")).unwrap()
        })
        .collect();
    let sizes: Vec<(u64, usize)> = (plans.iter())
        .map(|plan| (plan.runs(), plan.policies().len()))
        .collect();
    assert_eq!(sizes, [(1000, 2)]);
    let forces: std::collections::BTreeSet<Option<i64>> = (0..1000)
        .map(|run| plans[0].point(run).values[1].as_integer())
        .collect();
    assert!(forces.into_iter().eq([900, 1300, 1700].map(Some)));
}

/// What makes no scene is a row with its error, and stops nothing.
#[test]
fn a_run_without_figures_says_why() {
    let folder = TempDir::new().unwrap();
    let lines = "design = \"grid\"\nrepeats = 2\n[[vary]]\nkey = \"contact.restitution\"\nvalues = [0.7, 1.5]\n";
    let file = sweep_file(folder.path(), lines);
    let out = folder.path().join("out");
    let text = succeeds(&sweep(&file, &out, &[]));
    assert!(
        text.contains("2 failed") && text.contains("contact.restitution: is 1.5"),
        "{text}"
    );
    let rows = rows(&out);
    for (i, row) in rows.iter().enumerate() {
        // Two repeats of two policies of each value.
        let fails = i >= 4;
        assert_eq!(json(&row["outcome"]).is_null(), fails);
        let error = json(&row["error"]);
        assert_eq!(
            error.as_str().is_some_and(|e| e.starts_with("short.toml:")),
            fails,
            "{error}"
        );
    }
    assert_eq!(rows.len(), 8);
    // Where nothing is left there is nothing to believe.
    let none = sweep_file(folder.path(), &lines.replace("[0.7, 1.5]", "[1.5]"));
    let none = sweep(&none, &folder.path().join("none"), &[]);
    assert_eq!(none.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&none.stderr).contains("results were written"));
}
