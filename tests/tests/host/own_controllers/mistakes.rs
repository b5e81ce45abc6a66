//! What is said of a controller that does not do what it should, and with which exit code.

use super::{library, python, with};
use crate::refusals::all;
use system_tests::ran::{Folder, Ran, edited, has, ran};

/// Runs a scene that ends in an error, and gives its exit code and what it says.
fn refused(folder: &Folder, table: &str) -> String {
    let alone = with(table).replace(", \"supervisor\"]", "]");
    folder.put("scene.toml", alone);
    let Ran { code, said, .. } = folder.ran("run scene.toml --out out");
    assert!(!folder.at("out").exists(), "{table}");
    format!("exit {}: {said}", code.unwrap())
}

#[test]
fn mistakes_in_python_are_said() {
    if !python() {
        return;
    }
    let folder = Folder::fresh();
    all("controllers/python", 9, "", |program, _| {
        folder.put("own.py", program);
        let table = "[controller]\npython = \"own.py\"\ntimeout_s = 2.0\n";
        refused(&folder, table)
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
    let folder = Folder::fresh();
    let table = "[controller]\nlibrary = \"own.so\"\n";
    all("controllers/c", 8, NOTHING, |program, _| {
        library(&folder, "own", program);
        refused(&folder, table)
    });
    folder.put("own.so", "no library");
    let said = refused(&folder, table);
    has(
        &said,
        &["exit 2: ", "controller.library: own.so", "cc -O2 -shared"],
    );
}

#[test]
fn mistakes_in_the_scene_are_said() {
    let folder = Folder::fresh();
    folder.put("own.py", "raise SystemExit(3)");
    all("controllers/scene", 10, "", |table, _| {
        refused(&folder, table)
    });
    // Without Python on the search path.
    let table = "[controller]\npython = \"own.py\"\n";
    folder.put("scene.toml", with(table));
    let mut run = folder.command("run scene.toml");
    let said = ran(run.env("PATH", folder.at("."))).fails(2);
    has(&said, &["own.py needs python3: ", "install Python 3"]);
    // Who asks for no levitation starts none.
    let passive = [("[\"levitation\", \"supervisor\"]", "[\"passive\"]")];
    folder.put("passive.toml", edited(&with(table), &passive));
    folder.ran("run passive.toml --out out").good();
}
