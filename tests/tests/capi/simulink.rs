//! The block for Simulink: compiled against a header of this test's own and driven as Simulink would, it is the library.

use crate::library::{STRICT, Target, beside, built, includes, linked_with};
use std::process::Command;
use system_tests::ran::{Folder, ran};

#[test]
fn the_block_is_the_library() {
    let Some(library) = built(Target::Host) else {
        return;
    };
    let Some(mut cc) = Target::Host.compiler() else {
        return;
    };
    let folder = Folder::fresh();
    let program = folder.at("driver");
    cc.args(STRICT).args(["-O1", "-DMATLAB_MEX_FILE"]);
    cc.args(includes(&library));
    cc.arg(format!("-I{}", beside("simulink").display()));
    cc.arg(beside("simulink/driver.c"))
        .args(linked_with(&library));
    ran(cc.arg("-o").arg(&program)).good();
    let said = ran(&mut Command::new(program)).good();
    assert_eq!(said, "4000 ticks the same, engaged\n");
}
