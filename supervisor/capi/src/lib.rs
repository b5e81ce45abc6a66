//! C interface of the [`supervisor`]: the header is `include/amb_supervisor.h`, the guide is the page
//! "Linking it into C firmware" of the book.
//!
//! ```sh
//! cargo rustc -p supervisor-capi --lib --crate-type staticlib --profile fw --target thumbv7em-none-eabihf
//! ```
//!
//! writes `libsupervisor_capi.a` and, beside it, `amb_supervisor_abi.h`. The header is written by hand,
//! because generated ones cannot say how large opaque storage is; what it says is compared with this
//! crate where it is compiled ([`layout`]) and by the test `capi`.
//!
//! Every call checks every pointer, so that a mistake is a [`Code`] with a text and not a fault. What
//! cannot be checked is under "Safety" of each function.
//!
//! Files, each importing only from those above it: `version`, `parameters`, `code`, `layout`,
//! `structs`, `pointer`, `storage`, `halves`, `calls`, `rotor`, `watch`, `bearing`, `ledger`, `archive`.

#![cfg_attr(target_os = "none", no_std)]
#![warn(missing_docs)]
#![deny(clippy::undocumented_unsafe_blocks, unsafe_op_in_unsafe_fn)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod archive;
pub mod bearing;
pub mod calls;
pub mod code;
mod halves;
pub mod layout;
pub mod ledger;
mod parameters;
mod pointer;
pub mod rotor;
mod storage;
pub mod structs;
mod version;
pub mod watch;

pub use archive::{ArchiveStorage, Shelf};
pub use code::Code;
pub use halves::{RECORD, RotorStorage, Storage};
pub use version::ABI;
pub use watch::WatchStorage;

#[cfg(target_os = "none")]
mod trap {
    unsafe extern "C" {
        /// Deliberately without a definition: firmware in which a panic can be reached does not link.
        fn amb_a_panic_can_be_reached() -> !;
    }

    #[panic_handler]
    fn panic(_info: &core::panic::PanicInfo<'_>) -> ! {
        // SAFETY: never linked; a successful link proves that this function was dropped.
        unsafe { amb_a_panic_can_be_reached() }
    }
}

/// A call that can panic: firmware that does without it links as ever, and firmware that makes it does not.
#[cfg(feature = "planted-panic")]
// SAFETY: a name of its own, which no other library has.
#[unsafe(no_mangle)]
pub extern "C" fn amb_planted_panic(index: u32) -> u8 {
    [1, 2, 3][index as usize]
}
