//! Memory of the chip, where cortex-m-rt's script looks for it.

use std::path::Path;

/// STM32H743xI. All data are in the AXI memory, which DMA reaches, too. A machine that needs a quicker tick moves the supervisor and
/// the stack to the tightly coupled memory at 0x20000000, which DMA does not reach.
const MEMORY: &str =
    "MEMORY { FLASH : ORIGIN = 0x08000000, LENGTH = 2M RAM : ORIGIN = 0x24000000, LENGTH = 512K }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let out = std::env::var("OUT_DIR")?;
    std::fs::write(Path::new(&out).join("memory.x"), MEMORY)?;
    println!("cargo::rustc-link-search={out}");
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!("cargo::rustc-link-arg-bins=--nmagic");
    Ok(())
}
