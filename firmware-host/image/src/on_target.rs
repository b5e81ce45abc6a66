//! What the images share on the target.

pub mod count;
pub mod exit;
pub mod file;
mod logger;
pub mod panic_free;
pub mod replay;
pub mod report;
pub mod stack;

use crate::under_test::Ticked;

/// Puts a panic into an image that asks for it, to show that the check of the link would find it.
pub fn planted() {
    #[cfg(feature = "planted-panic")]
    {
        let few = [1, 2, 3];
        core::hint::black_box(few[core::hint::black_box(2_usize)]);
    }
}

/// What firmware does at boot: a processor that computes something else must not drive a magnet. Afterwards the supervisor is as
/// new.
pub fn checked<U: Ticked>(supervisor: &mut U) {
    if !supervisor.self_test() {
        report::failed("the self-test of the supervisor does not pass on this processor")
    }
}
