//! What is found out from flight records, against what the plant did.
//!
//! Files, each importing only from those above it: `counts`, `study`.

mod counts;
mod study;

pub use self::counts::{Counts, IMPACT_M_S, Missed, OFF_TICKS, Share, compare, contacts};
pub use self::study::study;
