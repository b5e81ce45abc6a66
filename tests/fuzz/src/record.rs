//! The host's decoder of flight records, and their replay.

#[path = "../../../firmware-host/bench/src/record/file.rs"]
pub mod file;
#[path = "../../../firmware-host/bench/src/record/replay.rs"]
pub mod replay;
#[path = "../../../firmware-host/bench/src/record/ticks.rs"]
pub mod ticks;
#[allow(dead_code, reason = "the replay needs a part of it")]
#[path = "../../../firmware-host/bench/src/record/unknown.rs"]
pub mod unknown;
