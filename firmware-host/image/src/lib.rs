//! What the Cortex-M images share, and the bytes in which the host talks to them.
//!
//! The host needs [`wire`], [`line`](mod@line) and [`under_test`]; everything else is built for a target without an
//! operating system only.

#![cfg_attr(target_os = "none", no_std)]

pub mod line;
#[cfg(target_os = "none")]
mod on_target;
pub mod under_test;
pub mod wire;

#[cfg(target_os = "none")]
pub use on_target::{checked, count, exit, file, panic_free, planted, replay, report, stack};

/// `main` of an image that was built for the host by mistake.
#[cfg(not(target_os = "none"))]
pub fn not_for_the_host() {
    eprintln!("an image for Cortex-M: firmware-host target builds and runs it");
}
