//! A sweep: one scene run again and again with keys that vary by a design, into one file with a row a run and policy.
//!
//! A run is its number: values and seed follow from it and from the sweep file alone, so that any part of a sweep may be run
//! anywhere, in any order, and gives the same rows.
//!
//! Files, each importing only from those above it: `error`, `permutation`, `sobol`, `design`, `tables`, `values`,
//! `size`, `file`, `table`, `figures_of`, `plan`, `store`, `sample`, `influence`, `map`, `summary`, `page`, `worst`.

pub mod design;
pub mod error;
pub mod figures_of;
pub mod file;
pub mod influence;
pub mod map;
pub mod page;
pub mod permutation;
pub mod plan;
mod sample;
mod size;
pub mod sobol;
pub mod store;
pub mod summary;
pub mod table;
mod tables;
pub mod values;
pub mod worst;
