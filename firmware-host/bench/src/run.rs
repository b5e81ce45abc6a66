//! A scene in closed loop under a controller: what is decided of it while it runs, what is kept of it, how far it can be trusted.

pub mod again;
pub mod clairvoyant;
pub mod closed_loop;
pub mod columns;
pub mod controller;
pub mod figures;
mod judge;
pub mod log_watch;
pub mod outcome;
pub mod overview;
pub mod recording;
mod rig;
pub mod supervision;
mod swings;
pub mod trace;
pub mod trace_columns;
pub mod trace_file;
pub mod trace_table;
pub mod verdict;
pub mod verify;
pub mod whole_clairvoyant;
