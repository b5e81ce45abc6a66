//! The test bench: a scene of a machine, the closed loop that runs it as firmware would, and what a person gets to see of it.
//!
//! Rooms, each importing only from those above it: `words`, `device`, `scene`, `run`, `report`, `advise`.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod advise;
pub mod device;
pub mod report;
pub mod run;
pub mod scene;
mod words;
