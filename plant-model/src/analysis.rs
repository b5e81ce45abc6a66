//! Figures read off a run, and closed forms to hold them against.

pub mod arrest;
pub mod best_force;
pub mod black;
pub mod course;
pub mod impact;
pub mod onset;
pub mod phases;
pub mod whirl;
