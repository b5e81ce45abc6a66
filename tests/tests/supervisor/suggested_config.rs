//! What scenes give the supervisor: every value, as it has been.

use firmware_bench::scene::Scene;
use std::fmt::Write;
use std::path::PathBuf;
use supervisor::PARAMETERS;
use system_tests::root;

/// Scenes and plants, sorted.
fn files() -> Vec<PathBuf> {
    let scenes = root().join("firmware-host/scenes");
    let mut files: Vec<PathBuf> = [scenes.clone(), scenes.join("plants")]
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|x| x == "toml"))
        .collect();
    files.sort();
    files
}

/// Shortest decimals that give the same f32 again, so the comparison is exact.
#[test]
fn scenes_give_the_supervisor_what_they_always_gave() {
    let mut text = String::new();
    for path in files() {
        let scene = Scene::load(&path).unwrap();
        let Some(config) = scene.planes[0].supervisor else {
            continue;
        };
        let name = path.file_stem().unwrap().to_string_lossy();
        for (parameter, value) in PARAMETERS.iter().zip(config.values()) {
            writeln!(text, "{name} {} {value:e}", parameter.name).unwrap();
        }
    }
    let path = root().join("tests/golden/suggested_config.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let golden = std::fs::read_to_string(&path).unwrap();
    for (now, before) in text.lines().zip(golden.lines()) {
        assert_eq!(now, before, "{}", path.display());
    }
    assert_eq!(text.lines().count(), golden.lines().count());
}
