//! The commands, one file each.

pub mod accuracy;
pub mod error;
mod progress;
pub mod run;
