//! Flight records as firmware has written them down: what of a file is whole, what happened in it, and whether the supervisor of
//! this build does the same.

pub mod file;
pub mod replay;
pub mod story;
pub mod ticks;
