//! Runs plant and supervisor in closed loop as firmware would, on scenes, and shows what happened.
//!
//! Files, each importing only from those above it: `trace`, `supervision`, `verdict`, `policy_kind`, `scene_missing`, `scene_error`, `axis`, `loads`,
//! `amplifier`, `faults`, `flight_record`, `scene_values`, `scene_event_file`, `scene_file`, `plant_setup`, `suggest`, `supervisor_setup`, `scene_warnings`, `instruments`,
//! `levitation`, `clairvoyant`, `history`, `scene_events`, `scene_instruments`, `scene_limits`, `scene`, `policies`, `judge`, `closed_loop`, `verify`, `accuracy`, `wrong_runs`, `trace_file`, `plot`, `scene_words`, `table`, `report`, `paper`, `overloads`, `harm`, `sensitivity`, `advice`, `target`, `output`,
//! `commands`.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod accuracy;
pub mod advice;
mod amplifier;
mod axis;
pub mod clairvoyant;
pub mod closed_loop;
pub mod commands;
mod faults;
pub mod flight_record;
pub mod harm;
pub mod history;
pub mod instruments;
mod judge;
pub mod levitation;
mod loads;
pub mod output;
pub mod overloads;
pub mod paper;
mod plant_setup;
mod plot;
pub mod policies;
pub mod policy_kind;
pub mod report;
pub mod scene;
pub mod scene_error;
mod scene_event_file;
mod scene_events;
mod scene_file;
mod scene_instruments;
mod scene_limits;
mod scene_missing;
mod scene_values;
mod scene_warnings;
mod scene_words;
pub mod sensitivity;
pub mod suggest;
pub mod supervision;
mod supervisor_setup;
pub mod table;
pub mod target;
pub mod trace;
pub mod trace_file;
pub mod verdict;
pub mod verify;
pub mod wrong_runs;
