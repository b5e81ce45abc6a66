//! The rotor–stator contact model of dry friction backward whirl, and the integrator that runs it.
//!
//! Signs and frames: x right, y up, angles counter-clockwise; r̂ points from the centre of the ring to
//! the centre of the rotor, t̂ is r̂ turned counter-clockwise. Spin Ω > 0 is counter-clockwise, whirl
//! with a tangential speed of the other sign is *backward*. SI units throughout, named in the field.
//!
//! ```text
//! params ─► build ─► Plant::advance(t_end, Inputs) ─► Snapshot, Meters, Audit
//!                      flight:  power series, or one matrix a sample
//!                      contact: power series too, guards of the mode as polynomials; implicit collocation for checks, for
//!                               overdamped contact and for what has no series
//! ```
//!
//! A rotor of 10 kg in a rigid wall, pushed to it with 50 mm/s:
//!
//! ```
//! use plant_model::contact::damping_for_restitution;
//! use plant_model::params::*;
//! use plant_model::{Inputs, Options, V2, build};
//!
//! let stiffness_n_m = 1e8;
//! let params = PlantParams {
//!     rotor: RotorParams {
//!         mass_kg: 10.0,
//!         stiffness_n_m: 8e5,
//!         damping_n_s_m: 17.0,
//!         eccentricity_m: 0.0,
//!         contact_radius_m: 0.1,
//!     },
//!     spin: SpinParams::Held,
//!     stator: StatorParams::Rigid,
//!     contact: ContactParams {
//!         clearance_m: 1e-4,
//!         law: LinearContact {
//!             stiffness_n_m,
//!             damping_n_s_m: damping_for_restitution(0.7, stiffness_n_m, 10.0).ok_or("no restitution")?,
//!         }
//!         .into(),
//!     },
//!     friction: FrictionParams {
//!         sliding: SlidingFriction::Constant { coefficient: 0.125 },
//!         rolling_coefficient: 0.0,
//!     },
//!     magnet: None,
//!     race: None,
//! };
//! let start = Start {
//!     position_m: V2::zeros(),
//!     velocity_m_s: V2::new(0.05, 0.0),
//!     spin_rad_s: 250.0,
//!     spin_phase_rad: 0.0,
//! };
//! let mut plant = build(&params, &start, Options::default())?;
//! let mut changes = Vec::new();
//! plant.advance(0.004, &Inputs::default(), &mut |now| changes.push(now.mode))?;
//!
//! assert_eq!(changes.len(), 2); // to the wall and off it
//! assert_eq!(plant.meters().impacts, 1);
//! let after = plant.snapshot();
//! assert!(after.velocity_m_s.x < 0.0); // back again,
//! assert!(after.velocity_m_s.y < 0.0); // and driven against the spin
//! assert!(plant.audit().residual().abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`lanes`] runs many of the simplest ones at a time. [`machine`] is a rotor that tilts, bends and touches in several planes; [`Plant`] is the one that does none of it.
//!
//! Files, each importing only from those above it: `vector`, `bisection`, `params`, `contact`, `friction`, `mode`, `energy`,
//! `series`, `quadrature`, `ellipse`, `free_flight`, `race`, `readout`, `integrate`, `lanes`, `machine`, `plant`, `analysis`.

#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod analysis;
mod bisection;
pub mod contact;
mod ellipse;
pub mod energy;
mod free_flight;
mod friction;
mod integrate;
pub mod lanes;
pub mod machine;
mod mode;
pub mod params;
pub mod plant;
mod quadrature;
mod race;
pub mod readout;
mod series;
mod vector;

pub use integrate::{Fastest, Method, Options, PlantError};
pub use machine::params::Change;
pub use mode::ContactMode;
pub use plant::{BuildError, Inputs, Plant, build};
pub use readout::{Meters, Snapshot, Work};
pub use vector::{Body, V2};
