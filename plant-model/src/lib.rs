//! The rotor–stator contact model of dry friction backward whirl, and the integrator that runs it.
//!
//! Signs and frames: x right, y up, angles counter-clockwise; r̂ points from the centre of the ring to
//! the centre of the rotor, t̂ is r̂ turned counter-clockwise. Spin Ω > 0 is counter-clockwise, whirl
//! with a tangential speed of the other sign is *backward*. SI units throughout, named in the field.
//!
//! ```text
//! params ─► build ─► Plant::advance(t_end, Inputs) ─► Snapshot, Meters, Audit
//!                      flight:  power series, exact; wall crossing on the exact solution
//!                      contact: power series too, guards of the mode as polynomials; an explicit
//!                               pair for checks, Radau IIA for overdamped contact
//! ```
//!
//! Files, each importing only from those above it: `bisection`, `params`, `contact`, `friction`, `mode`, `energy`,
//! `part`, `series`, `quadrature`, `ellipse`, `stator`, `spin`, `magnet`, `system`, `tangent`, `readout`, `integrate`, `plant`,
//! `analysis`.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod analysis;
mod bisection;
pub mod contact;
mod ellipse;
pub mod energy;
mod friction;
mod integrate;
mod magnet;
mod mode;
pub mod params;
mod part;
pub mod plant;
mod quadrature;
pub mod readout;
mod series;
mod spin;
mod stator;
mod system;
mod tangent;

/// A vector in the plane.
pub type V2 = nalgebra::Vector2<f64>;

pub use integrate::{Method, Options, PlantError};
pub use mode::Mode;
pub use params::Change;
pub use part::Body;
pub use plant::{BuildError, Plant, build, build_for_changes};
pub use readout::{HARD_IMPACT_M_S, Meters, Snapshot, Work};
pub use system::Inputs;
