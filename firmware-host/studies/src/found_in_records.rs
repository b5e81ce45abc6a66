//! What is found out from flight records, against what the plant did.
//!
//! Files, each importing only from those above it: `counts`, `study`.

mod counts;
mod study;

pub use self::counts::{Counts, Missed, Share, compare, contacts};
pub use self::study::study;
