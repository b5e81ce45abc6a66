//! Linker arguments and memory maps of the images; on the host there is nothing to link.

use std::path::Path;

/// Images that start by themselves, with the map of their machine.
const RUNNABLE: [&str; 8] = [
    "replay",
    "replay-q",
    "count",
    "count-q",
    "count-pair",
    "count-half",
    "in-the-loop",
    "timer-interrupt",
];
/// Images that are only linked.
const LINKED: [&str; 2] = ["panic-free", "panic-free-q"];

/// The Cortex-M0 machine (microbit) is small; the MPS2 boards of M3, M4F and M7 share one map.
const SMALL: &str =
    "MEMORY { FLASH : ORIGIN = 0x00000000, LENGTH = 256K RAM : ORIGIN = 0x20000000, LENGTH = 16K }";
const MPS2: &str =
    "MEMORY { FLASH : ORIGIN = 0x00000000, LENGTH = 4M RAM : ORIGIN = 0x20000000, LENGTH = 4M }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=panic_free.x");
    // The small machine, which has another clock.
    println!("cargo::rustc-check-cfg=cfg(small_board)");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return Ok(());
    }
    let here = std::env::var("CARGO_MANIFEST_DIR")?;
    for bin in LINKED {
        println!("cargo::rustc-link-arg-bin={bin}=-T{here}/panic_free.x");
    }

    let out = std::env::var("OUT_DIR")?;
    let small = std::env::var("TARGET")?.starts_with("thumbv6m");
    if small {
        println!("cargo::rustc-cfg=small_board");
    }
    // cortex-m-rt's link.x includes it by this name.
    std::fs::write(
        Path::new(&out).join("memory.x"),
        if small { SMALL } else { MPS2 },
    )?;
    println!("cargo::rustc-link-search={out}");
    for bin in RUNNABLE {
        println!("cargo::rustc-link-arg-bin={bin}=-Tlink.x");
        // Sections of one page each would waste flash.
        println!("cargo::rustc-link-arg-bin={bin}=--nmagic");
    }
    // What is logged stays in the image's file, for the decoder, and takes no memory of the target.
    println!("cargo::rustc-link-arg-bin=timer-interrupt=-Tdefmt.x");
    println!("cargo::rustc-link-arg-bins=--gc-sections");
    Ok(())
}
