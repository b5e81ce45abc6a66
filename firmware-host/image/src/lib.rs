//! What the Cortex-M images share, and the bytes in which the host talks to them.
//!
//! The host needs [`wire`] and [`RECORD`]; everything else is built for a target without an operating
//! system only.

#![cfg_attr(target_os = "none", no_std)]

#[cfg(target_os = "none")]
mod on_target;
pub mod wire;

#[cfg(target_os = "none")]
pub use on_target::{exit, file, planted, report, serial, stack, under_test};

/// Ticks of the flight record of the supervisor under test. Host and image must agree: the tick at which
/// a record freezes is part of a command.
pub const RECORD: usize = 512;

/// `main` of an image that was built for the host by mistake.
#[cfg(not(target_os = "none"))]
pub fn not_for_the_host() {
    eprintln!("an image for Cortex-M: firmware-host target builds and runs it");
}
