//! Figures read off a run, and closed forms to hold them against.

pub mod course;
pub mod onset;
pub mod phases;
pub mod whirl;
