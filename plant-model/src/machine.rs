//! A whole rotor: rigid with four lateral degrees of freedom or bending, gyroscopic, in up to four planes of contact.
//!
//! Positions along the axis count from the centre of mass. The axis leans by φ = dx/dz and ψ = dy/dz, and spins with Ω about
//! itself, counter-clockwise with x right and y up:
//!
//! ```text
//! m·r̈ = Σ F                I_t·φ̈ + I_p·Ω·ψ̇ = Σ z·F_x
//! J·Ω̇ = t_d + Σ R·s        I_t·ψ̈ − I_p·Ω·φ̇ = Σ z·F_y
//! ```
//!
//! The torque of friction counts about the rotor's own axis. Then the terms with Ω̇ in the tilt cancel against the share of
//! torque that the leaning axis turns, and energy closes with what stands here.
//!
//! Planes are as in [`crate::params`], each with its own bore, contact, friction, stator and race; what the rotor touches is
//! part of the same linear body. Everything is one power series a step, and the first guard of any plane ends it. Derivations
//! and what was measured: `docs/src/theory/whole-rotor.md`.
//!
//! A rotor that falls into two bushings while it spins:
//!
//! ```
//! use plant_model::machine::params::*;
//! use plant_model::machine::{Machine, MachineInputs};
//! use plant_model::params::*;
//! use plant_model::{ContactMode, Options, V2};
//!
//! let plane = |position_m: f64| MachinePlane {
//!     position_m,
//!     centre_m: V2::zeros(),
//!     radius_m: 0.03,
//!     contact: ContactParams {
//!         clearance_m: 2e-4,
//!         law: LinearContact { stiffness_n_m: 1e8, damping_n_s_m: 5e3 }.into(),
//!     },
//!     friction: FrictionParams {
//!         sliding: SlidingFriction::Constant { coefficient: 0.15 },
//!         rolling_coefficient: 0.0,
//!     },
//!     stator: StatorParams::Rigid,
//!     race: None,
//!     load_drag: None,
//!     heat: None,
//! };
//! let params = MachineParams {
//!     rotor: Rotor::Rigid(RigidRotor {
//!         mass_kg: 20.0,
//!         transverse_inertia_kg_m2: 0.3,
//!         polar_inertia_kg_m2: 0.06,
//!     }),
//!     supports: vec![],
//!     spin: SpinParams::Free { inertia_kg_m2: 0.06, drive_torque_n_m: 0.0 },
//!     unbalances: vec![],
//!     eccentricity_m: 0.0,
//!     magnets: vec![],
//!     loads_m: vec![],
//!     probes_m: vec![0.15],
//!     gravity_m_s2: V2::new(0.0, -9.81),
//!     planes: vec![plane(-0.2), plane(0.15)],
//! };
//! let start = MachineStart { spin_rad_s: 300.0, ..MachineStart::default() };
//! let mut machine = Machine::new(&params, &start, Options::default())?;
//! let mut touched = [false; 2];
//! machine.advance(0.05, &MachineInputs::default(), &mut |plane, now| {
//!     let mode = now.planes().nth(plane).map(|p| p.mode);
//!     touched[plane] |= mode.is_some_and(ContactMode::in_contact);
//! })?;
//!
//! assert_eq!(touched, [true; 2]);
//! assert!(machine.snapshot().spin_rad_s < 300.0); // friction brakes it
//! assert!(machine.audit().residual() < 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod body;
mod collocation;
mod flight_map;
mod guards;
mod holding;
pub mod linear;
pub mod linear_plant;
mod orders;
pub mod params;
mod peaks;
mod plane_series;
pub mod point_mass;
mod poles;
mod readout;
pub mod reduced;
mod rows;
mod run;
mod series;
pub mod shaft;
mod step;
mod system;
pub mod whirl_ranges;

pub use readout::{AxisMotion, MachineSnapshot, PlaneFlows, PlaneSnapshot};
pub use run::{Machine, Warmth};
pub use system::MachineInputs;
