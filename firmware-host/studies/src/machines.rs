//! The machines that studies run on: the plants of the catalogue with their tuned gains, and machines drawn at random.
//!
//! Files, each importing only from those above it: `plants`, `tuned_gains`, `draw`, `random`, `rotors`, `unbalanced`.

pub mod draw;
pub mod plants;
pub mod random;
pub mod rotors;
pub mod tuned_gains;
pub mod unbalanced;
