//! The host's decoder of flight records, and their replay.

#[path = "../../../firmware-host/bench/src/record/file.rs"]
pub mod file;
#[path = "../../../firmware-host/bench/src/record/replay.rs"]
pub mod replay;
#[path = "../../../firmware-host/bench/src/record/ticks.rs"]
pub mod ticks;
