//! Scenes that the documentation shows.

use crate::own_controllers::python;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::scene::Scene;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use system_tests::ran::Folder;
use system_tests::root;

/// The example with every table runs under each of its policies.
#[test]
fn the_scene_with_everything_runs() {
    let page = std::fs::read_to_string(root().join("docs/src/host/scenes.md")).unwrap();
    let (_, rest) = page.split_once("```toml\n").unwrap();
    let (text, _) = rest.split_once("```").unwrap();
    let scene = Scene::parse("scenes.md", text).unwrap();
    let plane = &scene.planes[0];
    assert!(!plane.outages.is_empty() && plane.amplifier.slew_n_s.is_some());
    for policy in &scene.policies {
        if let Err(error) = run(&scene, *policy, Keep::Verdict, &mut |_| {}) {
            panic!("{}: {error}", policy.name());
        }
    }
}

const BY_PYTHON: &str = "the Python package's own tests run the whole page";

/// What takes long, or asks for what is not here: only whether words and options are known is tried.
const ONLY_PARSED: [(&str, &str); 22] = [
    (
        "accuracy",
        "seconds of reference runs; the studies' tests run it",
    ),
    ("harm", "minutes of machines"),
    ("overloads", "half a minute and more"),
    ("study paper", "half a minute and more"),
    ("target", "needs an emulator"),
    ("study rotor-catalogue", "the studies' tests run it"),
    ("study harm", "minutes"),
    ("study sensitivity", "minutes"),
    ("study optimum", "the studies' tests run it"),
    ("study target", "needs an emulator"),
    ("study overloads", "minutes"),
    ("study unseen-machines", "minutes"),
    ("study loop-rates", "minutes"),
    ("study worst-tick", "needs an emulator"),
    ("review landing.bin", "the record is the reader's"),
    ("modes from_ross.toml", BY_PYTHON),
    ("export from_ross.toml", BY_PYTHON),
    ("modes own.toml", BY_PYTHON),
    ("run own.toml", BY_PYTHON),
    ("advise own.toml", BY_PYTHON),
    ("sweep drops.toml", BY_PYTHON),
    (
        "run firmware-host/scenes/controllers/pid_in_c.toml",
        "the line before compiles it; the tests of own controllers do both",
    ),
];

/// What is not this program: what it needs, or what builds and runs firmware.
const OTHERS: [(&str, &str); 24] = [
    ("git clone", "fetches the project"),
    ("curl", "installs Rust"),
    ("apt-get", "installs packages"),
    ("rustup", "installs a target, as tests/run does"),
    ("tests/run", "runs this test"),
    ("tests/peers/run", "installs other people's integrators"),
    ("cargo rustc", "the tests of the C library do it"),
    ("cargo build", "the tests of the images do it"),
    (
        "cargo build --locked --release --manifest-path firmware-host/boards",
        ".ci/run does it",
    ),
    ("cc -std=c99", "the tests of the C library do it"),
    ("cc -O2 -shared", "the tests of own controllers do it"),
    ("./two_planes", "the tests of the C library do it"),
    ("arm-none-eabi-gcc", "the tests of the C library do it"),
    ("qemu-system-arm", "the tests of the images do it"),
    (
        "cargo run --release -p system-tests",
        "the test of the requirements compares what it writes",
    ),
    ("cargo package", "the tests of the C library do it"),
    (
        "tests/semver",
        "needs cargo-semver-checks, and a release before",
    ),
    (
        "firmware-host/dist",
        "the test of the release does it, around what is built",
    ),
    (
        "supervisor/capi/prebuilt/build",
        "the tests of the C library do it",
    ),
    (
        "pip install",
        "firmware-host/python/test and tests/run do it, in environments of their own",
    ),
    (
        "firmware-host/python/build",
        "firmware-host/python/test does it",
    ),
    (
        "python3 firmware-host/python/examples",
        "the Python package's own tests do it",
    ),
    ("cd ", "leads to the next line"),
    (
        "python firmware-host/fmu/examples",
        "the tests of the units do it",
    ),
];

/// Lines of the blocks for a shell, in one where they are continued, without what is behind a `#` or goes to a file.
fn commands(page: &str) -> Vec<String> {
    let page = page.replace("\\\n", " ");
    let blocks = page.split("```sh\n").skip(1);
    let lines = blocks.flat_map(|rest| rest.split("```").next().unwrap_or_default().lines());
    let bare = lines.map(|line| line.split(['#', '>']).next().unwrap_or_default());
    let words = bare.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    words.filter(|line| !line.is_empty()).collect()
}

fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => pages(&path, found),
            false if path.extension().is_some_and(|e| e == "md") => found.push(path),
            false => {}
        }
    }
}

/// Every command that README and documentation tell a reader to type works, in the order of each page.
#[test]
fn every_command_works_or_is_known() {
    let mut files = vec![root().join("README.md")];
    pages(&root().join("docs/src"), &mut files);
    files.sort();
    // As in the project's folder, but that results go elsewhere.
    let folder = Folder::fresh();
    let project = root().join("firmware-host");
    std::os::unix::fs::symlink(project, folder.at("firmware-host")).unwrap();
    let brief = [("duration_s = 0.2", "duration_s = 0.03")];
    folder.scene("my_scene.toml", "overload_then_release", &brief);
    let run = |line: &str| {
        let printed = folder.ran(line).good();
        assert!(!printed.is_empty(), "{line}");
    };
    run("run firmware-host/scenes/overload_then_release.toml");
    let runs = "runs/overload_then_release";
    let record = folder.bytes(&format!("{runs}/record_supervisor.bin"));
    folder.put("landing.bin", record);
    run(&format!("export {runs}/trace_supervisor.parquet --to csv"));
    let csv = folder.text(&format!("{runs}/trace_supervisor.csv"));
    folder.put("landing.csv", crate::review::logs::foreign(&csv, false));

    let mut seen = BTreeSet::new();
    for file in files {
        let page = std::fs::read_to_string(&file).unwrap();
        for command in commands(&page) {
            if !seen.insert(command.clone()) {
                continue;
            }
            let Some(args) = command.strip_prefix("cargo run --release -- ") else {
                let known = OTHERS.iter().any(|(start, _)| command.starts_with(start));
                let known = known || command.starts_with("LIBRARY=");
                assert!(known, "{}: {command}", file.display());
                continue;
            };
            let only_parsed = ONLY_PARSED.iter().any(|(start, _)| args.starts_with(start));
            match only_parsed || (args.contains("python") && !python()) {
                true => run(&format!("{args} --help")),
                false => run(args),
            }
        }
    }
    assert!(seen.len() > 30, "{seen:?}");
    for (start, why) in OTHERS {
        assert!(seen.iter().any(|c| c.starts_with(start)), "{start}: {why}");
    }
}
