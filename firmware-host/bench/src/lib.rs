//! The test bench: a scene of a machine, the closed loop that runs it as firmware would, and what a person gets to see of it.
//!
//! ```
//! use firmware_bench::run::closed_loop::{Keep, run};
//! use firmware_bench::scene::Scene;
//! use firmware_bench::scene::policy_kind::PolicyKind;
//!
//! let text = r#"
//! title = "An impact"
//! [run]
//! duration_s = 0.05
//! sample_rate_hz = 20000
//! policies = ["passive"]
//! [rotor]
//! mass_kg = 10.0
//! stiffness_n_m = 8e5
//! damping_n_s_m = 170.0
//! contact_radius_m = 0.1
//! [spin]
//! frequency_hz = 40.0
//! [start]
//! velocity_m_s = [0.05, 0.0]
//! [contact]
//! clearance_m = 1e-4
//! stiffness_n_m = 1e8
//! restitution = 0.7
//! [friction]
//! coefficient = 0.125
//! "#;
//! let scene = Scene::parse("impact.toml", text)?;
//! let (figures, trace) = run(&scene, PolicyKind::Passive, Keep::Trace, &mut |_| {})?;
//! assert!(figures.impacts > 0 && figures.peak_contact_force_n > 100.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Rooms, each importing only from those above it: `words`, `bisection`, `crossover`, `log_file`, `device`, `scene`, `record`, `commission`, `run`, `modes`, `report`, `advise`, `sweep`.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod advise;
mod bisection;
pub mod commission;
mod crossover;
pub mod device;
pub mod log_file;
pub mod modes;
pub mod record;
pub mod report;
pub mod run;
pub mod scene;
pub mod sweep;
mod words;
