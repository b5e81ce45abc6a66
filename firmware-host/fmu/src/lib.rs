//! Scenes as co-simulation units of the Functional Mock-up Interface (FMI), versions 3.0 and 2.0: the plant with its
//! instruments, the supervisor, and the closed loop of both.
//!
//! One shared library serves all three and both versions: its token says which model a unit is, and the scene in its
//! resources says of what. [`bundle::bundle`] makes the archive of a unit; what an importer calls is in [`fmi3`] and [`fmi2`].
//!
//! Unsafe code stands in [`boundary`], [`fmi3`] and [`fmi2`] alone: at the border to C, whose pointers are the importer's
//! promise. A panic does not cross it: it is a fatal status with its text.
//!
//! Files, each importing only from those above it: `variable`, `quantities`, `model`, `parameters`, `supervisor_outputs`, `rows`,
//! `plant`, `closed_loop`, `supervision`, `unit`, `instance`, `base_units`, `description`, `resources`, `bundle`, `boundary`, `fmi3_absent`, `fmi3`, `fmi2`.

#![deny(clippy::undocumented_unsafe_blocks, unsafe_op_in_unsafe_fn)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod base_units;
pub mod boundary;
pub mod bundle;
mod closed_loop;
mod description;
pub mod fmi2;
pub mod fmi3;
pub mod fmi3_absent;
pub mod instance;
pub mod model;
mod parameters;
mod plant;
mod quantities;
mod resources;
mod rows;
mod supervision;
mod supervisor_outputs;
pub mod unit;
pub mod variable;
