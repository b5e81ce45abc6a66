//! Pairs of runs, levitation alone and with the supervisor, on machines drawn at random: a machine class, an event, sensors and
//! a configuration make a class, and every number of the draw a pair in it.
//!
//! Files, each importing only from those above it: `pair`, `row`, `written_events`, `point_events`, `events`, `machines`,
//! `sensors`, `configured`, `plan`, `harm`, `bending`, `rub`, `whole_rotors`.

pub mod bending;
pub mod configured;
pub mod events;
pub mod harm;
pub mod machines;
pub mod pair;
pub mod plan;
mod point_events;
pub mod row;
pub mod rub;
pub mod sensors;
pub mod whole_rotors;
mod written_events;
