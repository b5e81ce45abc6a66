//! The supervisor on the processors that it is for, emulated: what is run there and what is measured.
//!
//! A stream of samples is recorded on the host with the commands that the host gives ([`record`]); the images in
//! `firmware-host/image` replay it ([`emulator`]) and their figures are held against budgets ([`budgets`]).

pub mod budgets;
pub mod closed_loops;
pub mod counts;
pub mod coverage;
pub mod emulator;
pub mod images;
pub mod link;
pub mod loops;
pub mod machines;
pub mod measure;
pub mod numbers;
pub mod record;
pub mod results;
pub mod study;
pub mod synthetic;
pub mod tick_log;
pub mod vectors;
pub mod worst_tick;
