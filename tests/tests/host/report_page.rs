//! The pages of `run`, `review`, `sweep` and `modes` in a real browser: drawn, moved, read aloud, and without script.

use firmware_bench::record::file::RecordFile;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use supervisor::Stretch;
use system_tests::browser::Browser;
use system_tests::{host, machine_scene_path, root, run_scene, scene_path};
use tempfile::TempDir;

fn page(scene: &Path, out: &Path) -> PathBuf {
    let result = run_scene(scene, out, &["--no-trace"]);
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{error}");
    out.join("report.html")
}

fn review(record: &Path, out: &Path) -> Output {
    let mut review = host();
    review.arg("review").arg(record).arg("--out").arg(out);
    review.output().unwrap()
}

/// A record becomes a page, a damaged one as far as it is whole, and what is no record leaves nothing behind.
#[test]
fn a_record_becomes_a_page() {
    let folder = TempDir::new().unwrap();
    let here = |name: &str| folder.path().join(name);
    page(&scene_path("overload_then_release"), &here("run"));
    let record = here("run/record_supervisor.bin");
    let reviewed = review(&record, &here("whole"));
    let printed = String::from_utf8_lossy(&reviewed.stdout).into_owned();
    assert!(reviewed.status.success(), "{reviewed:?}");
    let whole = fs::read_to_string(here("whole/report.html")).unwrap();
    // The verdict that is printed heads the page.
    let verdict = printed.lines().next().unwrap();
    assert!(
        whole.contains(&format!("<p class=\"headline\">{verdict}")),
        "{verdict}"
    );
    for heading in [
        "Orbit",
        "Position",
        "Radius",
        "Control force",
        "Commanded force along the axes",
        "Severity",
        "Time in contact",
        "Modes",
    ] {
        assert!(whole.contains(&format!("<h3>{heading}</h3>")), "{heading}");
    }
    assert!(
        !whole.contains("<h3>Contact force</h3>"),
        "no record has it"
    );
    assert!(whole.contains("ENGAGED") && !whole.contains("class=\"warning\""));

    the_slow_track_is_that_of_the_record(&whole, &fs::read(&record).unwrap());

    let mut bytes = fs::read(&record).unwrap();
    let last = bytes.len() - 40;
    bytes[last] ^= 1;
    fs::write(here("damaged.bin"), &bytes).unwrap();
    let reviewed = review(&here("damaged.bin"), &here("damaged"));
    assert_eq!(reviewed.status.code(), Some(2));
    let damaged = fs::read_to_string(here("damaged/report.html")).unwrap();
    assert!(damaged.contains("class=\"warning\""), "the damage is told");

    fs::write(here("none.bin"), [7; 33]).unwrap();
    let reviewed = review(&here("none.bin"), &here("none"));
    assert_eq!(reviewed.status.code(), Some(2));
    assert!(!here("none").exists());
}

/// What is written of a column: differences in steps.
fn decoded(column: &Value) -> Vec<f64> {
    let step = column["step"].as_f64().unwrap();
    let mut at = 0.0;
    (column["differences"].as_array().unwrap().iter())
        .map(|difference| {
            at += difference.as_f64().unwrap();
            at * step
        })
        .collect()
}

/// It goes on when the recorded ticks are over, and each stretch is a step of its largest values.
fn the_slow_track_is_that_of_the_record(page: &str, bytes: &[u8]) {
    let (_, data) = page.split_once("id=\"report-data\">").unwrap();
    let data: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    let track = |name: &str| {
        let mut tracks = data["tracks"].as_array().unwrap().iter();
        tracks.find(|track| track["name"] == name).unwrap()
    };
    let (slow, fast) = (track("recorded: slow track"), track("recorded"));
    let file = RecordFile::of(bytes);
    let record = file.records.first().unwrap();
    let units = record.units();
    let (t, until) = (decoded(&slow["t"]), decoded(&fast["t"]));
    assert_eq!(t.len(), 2 * record.track.len());
    assert!(t.last() > Some(&(2.0 * until.last().unwrap())), "{t:?}");
    let radius = decoded(&slow["columns"]["largest r"]);
    let share = decoded(&slow["columns"]["in contact"]);
    let ms = 1e3 / units.sample_rate_hz.unwrap();
    for (i, stretch) in record.track.iter().enumerate() {
        let (from, to) = (2 * i, 2 * i + 1);
        let lasts = f64::from(stretch.ticks) * ms;
        assert!((t[to] - t[from] - lasts).abs() < 1e-3, "stretch {i}");
        let clearances = record.number(stretch.radius_square).sqrt();
        let expected = 1e3 * units.clearance_m.unwrap() * clearances;
        let contact = 100.0 * f64::from(stretch.contact_ticks) / f64::from(stretch.ticks);
        for at in [from, to] {
            assert!((radius[at] - expected).abs() < 1e-4, "stretch {i}");
            assert!((share[at] - contact).abs() < 0.1, "stretch {i}");
        }
    }
    // No time is said of the modes of a stretch that has several.
    let modes = slow["bands"]["supervisor"].as_array().unwrap();
    let alone = |stretch: &&Stretch| stretch.modes.count_ones() == 1;
    assert!(!modes.is_empty() && modes.len() <= record.track.iter().filter(alone).count());
}

/// What the walk-through shows is what the tool draws today of the record that it is about, and all of it is small.
#[test]
fn pictures_of_the_walk_through_are_the_tools() {
    let folder = TempDir::new().unwrap();
    let here = |name: &str| folder.path().join(name);
    page(&scene_path("overload_then_release"), &here("run"));
    let mut review = host();
    review.arg("review").arg(here("run/record_supervisor.bin"));
    let reviewed = review.arg("--figures").arg(here("drawn")).output().unwrap();
    assert!(reviewed.status.success(), "{reviewed:?}");
    let kept = root().join("docs/src/start/overload");
    let names = |folder: &Path| -> BTreeSet<String> {
        let entries = fs::read_dir(folder).unwrap();
        let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        entries.map(|entry| name(entry.unwrap())).collect()
    };
    let drawn = names(&here("drawn"));
    assert_eq!(drawn, names(&kept), "docs/src/start/overload has others");
    for name in &drawn {
        let svg = fs::read_to_string(here("drawn").join(name)).unwrap();
        assert!(svg.len() < 60_000, "{name} has {} bytes", svg.len());
        assert!(
            svg == fs::read_to_string(kept.join(name)).unwrap(),
            "docs/src/start/overload/{name} is another: renew it with the command of docs/src/start/review.md"
        );
    }
    // Every sentence that the page has of the verdict is printed.
    let text = fs::read_to_string(root().join("docs/src/start/review.md")).unwrap();
    let (_, shown) = text.split_once("```text\n").unwrap();
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let shown = words(shown.split_once("```").unwrap().0);
    let printed = words(&String::from_utf8_lossy(&reviewed.stdout));
    assert!(printed.starts_with(&shown), "{printed}");
    for link in text.split("](overload/").skip(1) {
        let name = link.split(')').next().unwrap();
        assert!(drawn.contains(name), "{name}");
    }
}

#[test]
fn pages_work_in_a_browser() {
    let Some(browser) = Browser::found() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let here = |name: &str| folder.path().join(name);
    // Two seconds at 20 kHz.
    let text = fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let long = text.replace("duration_s = 0.2\n", "duration_s = 2.0\n");
    assert!(long.contains("duration_s = 2.0\n") && long.contains("sample_rate_hz = 20000\n"));
    fs::write(here("long.toml"), long).unwrap();
    let run = page(&here("long.toml"), &here("run"));
    let machine = page(
        &machine_scene_path("overload_of_a_flexible_rotor"),
        &here("machine"),
    );
    let reviewed = review(&here("run/record_supervisor.bin"), &here("record"));
    assert!(reviewed.status.success(), "{reviewed:?}");
    let record = here("record/report.html");
    let size = fs::metadata(&run).unwrap().len();
    assert!(size < 3_000_000, "the page has {size} bytes");

    // Maps of both kinds, and influences.
    let lines = format!(
        "scene = {:?}\npolicies = [\"levitation\", \"supervisor\"]\ndesign = \"sobol\"\nruns = 96\n\
         maps = [[\"start.velocity_m_s[0]\", \"friction.coefficient\"], [\"magnet.delay_samples\", \"friction.coefficient\"]]\n\
         [[vary]]\nkey = \"start.velocity_m_s[0]\"\nuniform = [0.1, 0.5]\n\
         [[vary]]\nkey = \"friction.coefficient\"\nuniform = [0.05, 0.2]\n\
         [[vary]]\nkey = \"magnet.delay_samples\"\nvalues = [1, 2]\n",
        scene_path("impact_at_40_hz").display().to_string()
    );
    fs::write(here("sweep.toml"), lines).unwrap();
    let mut sweep = host();
    let swept = sweep.arg("sweep").arg(here("sweep.toml"));
    let swept = swept.arg("--out").arg(here("swept")).output().unwrap();
    assert!(swept.status.success(), "{swept:?}");
    let sweep = here("swept/report.html");

    let modes = here("modes.html");
    let scene = machine_scene_path("misaligned_bearings");
    let printed = (host().arg("modes").arg(scene).arg("--html").arg(&modes)).output();
    assert!(printed.unwrap().status.success());

    println!("{size} bytes");
    browser.check("report.mjs", &[&run, &machine, &record, &sweep, &modes]);
}
