//! What the images share on the target.

pub mod exit;
pub mod file;
pub mod report;
pub mod serial;
pub mod stack;
pub mod under_test;

/// Puts a panic into an image that asks for it, to show that the check of the link would find it.
pub fn planted() {
    #[cfg(feature = "planted-panic")]
    {
        let few = [1, 2, 3];
        core::hint::black_box(few[core::hint::black_box(2_usize)]);
    }
}
