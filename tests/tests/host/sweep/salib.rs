//! The page's recipe for indices of sensitivity: SALib reads what a sweep writes.

use super::sweep_of;
use std::process::Command;
use system_tests::ran::{has, ran};
use system_tests::root;

/// As the page has it.
#[test]
fn salib_reads_the_results() {
    let Some(python) = system_tests::python() else {
        return;
    };
    let draws = "design = \"monte_carlo\"\nruns = 200\n\
        [[vary]]\nkey = \"start.velocity_m_s[0]\"\nuniform = [0.1, 0.5]\n\
        [[vary]]\nkey = \"friction.coefficient\"\nuniform = [0.05, 0.2]\n";
    let folder = sweep_of(draws);
    folder.ran("sweep sweep.toml --out runs/sweep").good();

    let page = std::fs::read_to_string(root().join("docs/src/host/sweep.md")).unwrap();
    let (_, recipe) = page.split_once("```python\n").unwrap();
    let (recipe, _) = recipe.split_once("```").unwrap();
    // And of a figure that is known: all of it hangs on the first key.
    let known = "s = rbd_fast.analyze(problem, x, x[:, 0] ** 2)['S1']\nassert y.std() > 0 and s[0] > 0.9 and s[1] < 0.2, s\n";
    let mut python = Command::new(python);
    python.args(["-c", &format!("{recipe}{known}")]);
    let said = ran(python.current_dir(folder.at("."))).good();
    has(&said, &["delta", "S1"]);
}
