//! What a tick takes in cycles by a model: the path of every instruction is traced in the emulator, and what Arm publishes
//! of each processor says how many cycles each may take, between a lower and an upper bound.
//!
//! Files, each importing only from those above it: `disassembly`, `table`, `trace`, `study`.

mod disassembly;
mod study;
mod table;
mod trace;

pub use self::study::study;
pub use self::trace::TraceError;
