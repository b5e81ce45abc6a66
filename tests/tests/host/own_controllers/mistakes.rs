//! What is said of a controller that does not do what it should, and with which exit code.

use super::{library, python, with, written};
use crate::refusals::all;
use std::path::Path;
use std::process::Output;
use system_tests::{host, run_scene};
use tempfile::TempDir;

/// Runs a scene that ends in an error, and gives its exit code and what it says.
fn refused(folder: &Path, table: &str) -> String {
    let alone = with(table).replace(", \"supervisor\"]", "]");
    let scene = written(folder, "scene.toml", &alone);
    let out = folder.join("out");
    let Output { status, stderr, .. } = run_scene(&scene, &out, &[]);
    assert!(!out.exists(), "{table}");
    let code = status.code().unwrap();
    format!("exit {code}: {}", String::from_utf8_lossy(&stderr))
}

#[test]
fn mistakes_in_python_are_said() {
    if !python() {
        return;
    }
    let folder = TempDir::new().unwrap();
    all("controllers/python", 9, "", |program, _| {
        written(folder.path(), "own.py", program);
        let table = "[controller]\npython = \"own.py\"\ntimeout_s = 2.0\n";
        refused(folder.path(), table)
    });
}

/// A controller that does nothing, with a piece of it replaced.
const NOTHING: &str = "#include \"amb_controller.h\"
AMB_CONTROLLER_DEFINE_ABI
static int it;
void *amb_controller_init(const amb_controller_setup *setup) { (void)setup; return &it; }
int amb_controller_step(void *it, const amb_controller_sample *now, double *force_n) {
    (void)it; (void)now; force_n[0] = force_n[1] = 0.0; return 0;
}
void amb_controller_close(void *it) { (void)it; }
";

#[test]
fn mistakes_in_c_are_said() {
    let folder = TempDir::new().unwrap();
    let table = "[controller]\nlibrary = \"own.so\"\n";
    all("controllers/c", 8, NOTHING, |program, _| {
        library(folder.path(), "own", program);
        refused(folder.path(), table)
    });
    written(folder.path(), "own.so", "no library");
    let said = refused(folder.path(), table);
    assert!(
        said.starts_with("exit 2: ")
            && said.contains("controller.library: own.so")
            && said.contains("cc -O2 -shared"),
        "{said}"
    );
}

#[test]
fn mistakes_in_the_scene_are_said() {
    let folder = TempDir::new().unwrap();
    written(folder.path(), "own.py", "raise SystemExit(3)");
    all("controllers/scene", 10, "", |table, _| {
        refused(folder.path(), table)
    });
    // Without Python on the search path.
    let table = "[controller]\npython = \"own.py\"\n";
    let scene = written(folder.path(), "scene.toml", &with(table));
    let mut run = host();
    let output = run.arg("run").arg(&scene).current_dir(folder.path());
    let output = output.env("PATH", folder.path()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said.contains("own.py needs python3: ") && said.contains("install Python 3"),
        "{said}"
    );
    // Who asks for no levitation starts none.
    let passive = with(table).replace("[\"levitation\", \"supervisor\"]", "[\"passive\"]");
    let scene = written(folder.path(), "passive.toml", &passive);
    let output = run_scene(&scene, &folder.path().join("out"), &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}
