//! The block for Simulink: compiled against a header of this test's own and driven as Simulink would, it is the library.

use crate::library::{STRICT, Target, beside, built, good, includes};
use std::process::Command;

#[test]
fn the_block_is_the_library() {
    let Some(library) = built(Target::Host) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("driver");
    let Some(mut cc) = Target::Host.compiler() else {
        return;
    };
    cc.args(STRICT).args(["-O1", "-DMATLAB_MEX_FILE"]);
    cc.args(includes(&library));
    cc.arg(format!("-I{}", beside("simulink").display()));
    cc.arg(beside("simulink/driver.c"));
    cc.arg(library.join("libsupervisor_capi.a"));
    cc.args(["-lpthread", "-ldl", "-lm", "-o"]).arg(&program);
    let output = cc.output().unwrap();
    good(&output);
    let text = good(&Command::new(program).output().unwrap());
    assert_eq!(text, "4000 ticks the same, engaged\n");
}
