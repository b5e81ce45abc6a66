//! The header against MISRA C:2012, as far as a free checker goes: what it finds is a deviation that the safety manual explains.

use crate::library::{capi, tool};
use std::collections::BTreeSet;
use system_tests::ran::{Folder, ran};
use system_tests::root;

/// Rules that cppcheck finds broken in a file, as 10.4.
fn broken(text: &str, standard: &str) -> BTreeSet<String> {
    let Some(mut cppcheck) = tool("cppcheck") else {
        return BTreeSet::new();
    };
    let folder = Folder::fresh();
    let version = format!("#define AMB_LIBRARY_ABI {}\n", supervisor_capi::ABI);
    folder.put("amb_supervisor_abi.h", version);
    folder.put("use.c", text);
    cppcheck.args("--addon=misra --enable=style --quiet --template={id} -I. -I".split(' '));
    cppcheck.arg(capi().join("include"));
    cppcheck.arg(format!("--std={standard}"));
    let ran = ran(cppcheck.current_dir(folder.at(".")).arg("use.c"));
    assert_eq!(ran.code, Some(0), "{}{}", ran.printed, ran.said);
    let lines = ran.said.lines();
    let rules = lines.filter_map(|id| id.strip_prefix("misra-c2012-"));
    rules.map(str::to_owned).collect()
}

#[test]
fn deviations_of_the_header_are_explained() {
    if tool("cppcheck").is_none() {
        return;
    }
    let manual = root().join("docs/src/supervisor/safety-manual.md");
    let manual = std::fs::read_to_string(manual).unwrap();
    let mut found = BTreeSet::new();
    for standard in ["c99", "c11"] {
        found.extend(broken("#include \"amb_supervisor.h\"\n", standard));
    }
    assert!(
        found.contains("19.2"),
        "the checker sees nothing: {found:?}"
    );
    for rule in &found {
        assert!(
            manual.contains(&format!("| {rule} | ")),
            "rule {rule} is not in the safety manual"
        );
    }
    // A goto is found, so an empty list says something.
    let with_goto = "int main(void) { goto end; end: return 0; }\n";
    assert!(broken(with_goto, "c99").contains("15.1"));
}
