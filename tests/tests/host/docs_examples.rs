//! Scenes that the documentation shows.

use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::scene::Scene;
use system_tests::root;

/// The example with every table runs under each of its policies.
#[test]
fn the_scene_with_everything_runs() {
    let page = std::fs::read_to_string(root().join("docs/src/host/scenes.md")).unwrap();
    let (_, rest) = page.split_once("```toml\n").unwrap();
    let (text, _) = rest.split_once("```").unwrap();
    let scene = Scene::parse("scenes.md", text).unwrap();
    assert!(!scene.outages.is_empty() && scene.amplifier.slew_n_s.is_some());
    for policy in &scene.policies {
        if let Err(error) = run(&scene, *policy, Keep::Verdict, &mut |_| {}) {
            panic!("{}: {error}", policy.name());
        }
    }
}

/// What the pages to start with tell a reader to type works, in the order of each page.
#[test]
fn the_commands_to_start_with_run() {
    let mut run = 0;
    for entry in std::fs::read_dir(root().join("docs/src/start")).unwrap() {
        let page = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        // As in the project's folder, but that results go elsewhere.
        let folder = tempfile::TempDir::new().unwrap();
        std::os::unix::fs::symlink(
            root().join("firmware-host"),
            folder.path().join("firmware-host"),
        )
        .unwrap();
        for line in page.lines() {
            let Some(args) = line.trim().strip_prefix("cargo run --release -- ") else {
                continue;
            };
            let output = (system_tests::host().args(args.split(' ')))
                .current_dir(folder.path())
                .output()
                .unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{args}: {said}");
            assert!(!output.stdout.is_empty(), "{args}");
            run += 1;
        }
    }
    assert!(run >= 7, "{run} commands");
}
