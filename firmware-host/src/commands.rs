//! The commands, one file each.

pub mod accuracy;
pub mod advise;
pub mod error;
pub mod overloads;
pub mod paper;
mod progress;
pub mod record;
pub mod run;
pub mod target;
