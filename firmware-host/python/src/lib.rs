//! The bench as a Python module: plant, supervisor, closed loops, flight records. What users import is the package `ambwhirl`
//! around it, whose stubs say what there is.
//!
//! Rooms, each importing only from those above it: `values`, `errors`, `table`, `scene`, `controller`, `run`, `plant`,
//! `config`, `supervise`, `record`.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod config;
mod controller;
mod errors;
mod plant;
mod record;
mod run;
mod scene;
mod supervise;
mod table;
mod values;

/// What is written in Rust of the package `ambwhirl`.
#[pyo3::pymodule]
mod _ambwhirl {
    #[pymodule_export]
    use crate::config::{Config, parameters};
    #[pymodule_export]
    use crate::controller::{Sample, Setup};
    #[pymodule_export]
    use crate::errors::{ConfigError, ControllerError, RecordError, RunError, SceneError};
    #[pymodule_export]
    use crate::plant::Plant;
    #[pymodule_export]
    use crate::record::decoded;
    #[pymodule_export]
    use crate::run::run_policies;
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::supervise::{Command, Supervisor};
}
