//! The plant beside somebody else's measurement: a rotor about a fixed pivot that an exciter drives into its retainer bearing.
//!
//! The rig is that of the master's thesis of S. V. Andersen, DTU 2019, with its numbers as they stand in the public repository
//! `SV3A/masterproject-contact-code`. The record is theirs (GPL), is not part of this project, and is read from a file that the
//! user has.
//!
//! Files, each importing only from those above it: `record`, `fit`, `rig`, `study`.

mod fit;
mod record;
mod rig;
mod study;

pub use self::record::{Record, RecordError};
pub use self::rig::{Flight, Impact, Ran, Rig, Touch};
pub use self::study::{on_record, study};
