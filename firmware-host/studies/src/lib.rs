//! Studies: many runs of many scenes, and what is claimed of them.
//!
//! Rooms, each importing only from those above it: `accuracy`, `paper`, `overloads`, `harm`, `sensitivity`, `on_target`.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod accuracy;
pub mod harm;
pub mod on_target;
pub mod overloads;
pub mod paper;
pub mod sensitivity;
