//! What is said of a controller that does not do what it should, and with which exit code.

use super::{GAINS, library, python, with, written};
use std::path::Path;
use std::process::Output;
use system_tests::{host, run_scene};
use tempfile::TempDir;

/// Runs a scene that ends in an error, and gives what it says.
fn refused(folder: &Path, table: &str, code: i32) -> String {
    let alone = with(table).replace(", \"supervisor\"]", "]");
    let scene = written(folder, "scene.toml", &alone);
    let out = folder.join("out");
    let Output { status, stderr, .. } = run_scene(&scene, &out, &[]);
    let said = String::from_utf8_lossy(&stderr).into_owned();
    assert_eq!(status.code(), Some(code), "{table}: {said}");
    assert!(!out.exists(), "{table}");
    said
}

/// A program of Python, the exit code of its run, and what is said.
const MISTAKES: [(&str, i32, &[&str]); 9] = [
    (
        "x = 1",
        2,
        &[
            "scene.toml:3",
            "controller.python: own.py has no function make(scene)",
            "help: ",
        ],
    ),
    (
        "def make(scene) return 1",
        2,
        &["own.py\", line 1", "SyntaxError"],
    ),
    (
        "def make(scene): return scene.gain",
        2,
        &["own.py raised", "line 1, in make", "AttributeError"],
    ),
    (
        "def make(scene): return 7",
        2,
        &["make(scene) returned 7, which has no method step(sample)"],
    ),
    (
        "class C:\n    def step(self, now): return [0.0, 1 / (now.t_s - 0.01)]\ndef make(scene): return C()",
        1,
        &[
            "policy levitation: controller own.py at 0.01 s: raised",
            "line 2, in step",
            "ZeroDivisionError",
        ],
    ),
    (
        "class C:\n    def step(self, now): return [0.0, float('nan')]\ndef make(scene): return C()",
        1,
        &["own.py at 0 s: its force in y of plane 1 is NaN"],
    ),
    (
        "class C:\n    def step(self, now): return [1.0]\ndef make(scene): return C()",
        1,
        &["step returned 1 forces, expected 2"],
    ),
    (
        "import os\nclass C:\n    def step(self, now): os._exit(7)\ndef make(scene): return C()",
        1,
        &["own.py at 0 s: ended with exit code 7"],
    ),
    (
        "class C:\n    def step(self, now):\n        while True: pass\ndef make(scene): return C()",
        1,
        &["did not answer within 2 s, its controller.timeout_s"],
    ),
];

#[test]
fn mistakes_in_python_are_said() {
    if !python() {
        return;
    }
    let folder = TempDir::new().unwrap();
    for (program, code, says) in MISTAKES {
        written(folder.path(), "own.py", program);
        let said = refused(
            folder.path(),
            "[controller]\npython = \"own.py\"\ntimeout_s = 2.0\n",
            code,
        );
        for says in says {
            assert!(said.contains(says), "{program}: {said}");
        }
    }
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

/// What is replaced by what, the exit code of the run, and what is said.
const IN_C: [(&str, &str, i32, &str); 8] = [
    (
        "AMB_CONTROLLER_DEFINE_ABI",
        "",
        2,
        "own.so has no function amb_controller_abi",
    ),
    (
        "AMB_CONTROLLER_DEFINE_ABI",
        "uint32_t amb_controller_abi(void) { return 9; }",
        2,
        "was compiled for version 9 of amb_controller.h, and this program has version 1",
    ),
    (
        "amb_controller_close",
        "amb_controller_end",
        2,
        "has no function amb_controller_close",
    ),
    (
        "return &it;",
        "(void)it; return 0;",
        2,
        "amb_controller_init returned NULL",
    ),
    (
        "return 0;",
        "return 3;",
        1,
        "at 0 s: amb_controller_step returned 3",
    ),
    (
        "force_n[0] = force_n[1]",
        "force_n[1]",
        1,
        "its force in x of plane 1 is NaN",
    ),
    (
        "(void)now;",
        "(void)now; *(volatile int *)0 = 1;",
        1,
        "crashed: signal: 11 (SIGSEGV)",
    ),
    (
        "{ (void)it; }",
        "{ (void)it; *(volatile int *)0 = 1; }",
        1,
        "closed after the last sample: crashed",
    ),
];

#[test]
fn mistakes_in_c_are_said() {
    let folder = TempDir::new().unwrap();
    for (piece, by, code, says) in IN_C {
        let program = NOTHING.replace(piece, by);
        assert_ne!(program, NOTHING);
        library(folder.path(), "own", &program);
        let said = refused(folder.path(), "[controller]\nlibrary = \"own.so\"\n", code);
        assert!(said.contains(says), "{by}: {said}");
    }
    written(folder.path(), "own.so", "no library");
    let said = refused(folder.path(), "[controller]\nlibrary = \"own.so\"\n", 2);
    assert!(
        said.contains("controller.library: own.so") && said.contains("cc -O2 -shared"),
        "{said}"
    );
}

#[test]
fn mistakes_in_the_scene_are_said() {
    let folder = TempDir::new().unwrap();
    written(folder.path(), "own.py", "raise SystemExit(3)");
    for (table, says) in [
        (
            "[controller]\npython = \"none.py\"\n",
            "controller.python: none.py: No such file",
        ),
        (
            "[controller]\nlibrary = \".\"\n",
            "controller.library: .: is no file",
        ),
        (
            "[controller]\ntimeout_s = 1.0\n",
            "controller: names no program",
        ),
        (
            "[controller]\npython = \"own.py\"\nlibrary = \"a.so\"\n",
            "given together with controller.library",
        ),
        (
            "[controller]\npython = \"own.py\"\ntimeout_s = 0.0\n",
            "controller.timeout_s: is 0, expected",
        ),
        (
            "[controller]\npyton = \"own.py\"\n",
            "did you mean `python`?",
        ),
        (
            &format!("{GAINS}[controller]\npython = \"own.py\"\n"),
            "levitation: does not go with [controller]",
        ),
        (
            "[biquads]\nsections = [1.0, 2.0]\n",
            "biquads.sections: has 2 numbers, which is no multiple of six",
        ),
        (
            "[biquads]\nsections = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]\n",
            "section 1 over its a0 = 0 is not finite",
        ),
        (
            "[biquads]\nfile = \"none.npz\"\n",
            "biquads.file: none.npz: No such file",
        ),
    ] {
        let said = refused(folder.path(), table, 2);
        assert!(said.contains(says), "{table}: {said}");
    }
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
