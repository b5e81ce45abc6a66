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
