//! The pages of `run` and `review` in a real browser: drawn, moved, read aloud, and without script.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{env, fs};
use system_tests::target::skipped;
use system_tests::{host, machine_scene_path, root, run_scene, scene_path};
use tempfile::TempDir;

fn found(program: &str) -> Option<PathBuf> {
    let path = env::var_os("PATH")?;
    let mut places = env::split_paths(&path).map(|folder| folder.join(program));
    places.find(|place| place.is_file())
}

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
        "Modes",
    ] {
        assert!(whole.contains(&format!("<h3>{heading}</h3>")), "{heading}");
    }
    assert!(
        !whole.contains("<h3>Contact force</h3>"),
        "no record has it"
    );
    assert!(whole.contains("ENGAGED") && !whole.contains("class=\"warning\""));

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

#[test]
fn pages_work_in_a_browser() {
    let driver = root().join("tests/browser");
    let (Some(chromium), Some(node)) = (found("chromium"), found("node")) else {
        skipped("chromium or node is not installed");
        return;
    };
    if !driver.join("node_modules").is_dir() {
        skipped("tests/browser has no node_modules");
        return;
    }
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

    let driven = Command::new(node)
        .arg(driver.join("report.mjs"))
        .args([&chromium, &run, &machine, &record])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&driven.stdout);
    let error = String::from_utf8_lossy(&driven.stderr);
    println!("{size} bytes\n{said}");
    assert!(driven.status.success(), "{said}\n{error}");
}
