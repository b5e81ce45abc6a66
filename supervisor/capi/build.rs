//! Writes `amb_supervisor_abi.h`, which says what the library that is being built speaks, for the header
//! to compare with.

use std::path::Path;

#[path = "src/version.rs"]
pub mod version;

fn main() -> std::io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/version.rs");
    let text = format!(
        "/* Written when the library in this folder was built. */\n#define AMB_LIBRARY_ABI {}\n",
        version::ABI
    );
    let out = std::env::var_os("OUT_DIR").unwrap_or_default();
    // target/<target>/<profile>/build/<package>/out: beside the library, or it would be found by nobody.
    // Were it only in `out`, each build would need a search for the newest of several folders.
    let beside_library = Path::new(&out)
        .ancestors()
        .nth(3)
        .unwrap_or_else(|| Path::new(&out));
    let file = beside_library.join("amb_supervisor_abi.h");
    // Builds that share the folder write the same; another's compiler must not read it half written.
    if std::fs::read_to_string(&file).is_ok_and(|there| there == text) {
        return Ok(());
    }
    std::fs::write(file, text)
}
