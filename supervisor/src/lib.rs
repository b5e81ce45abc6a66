//! Real-time supervisor that keeps a rotor on active magnetic bearings out of dry friction backward
//! whirl when it touches its retainer bearing. `no_std`, no allocation, no panic, no unsafe.
//!
//! ```
//! use supervisor::{Config, Mode, Sample, Status, Supervisor};
//!
//! let config = Config {
//!     mass_kg: 12.0, // of this machine; all others as in the example
//!     ..Config::example()
//! };
//! let mut supervisor = Supervisor::<512>::new(&config)?;
//! let command = supervisor.tick(&Sample {
//!     sequence: 0,
//!     status: Status::SPIN_VALID | Status::BEARING_ON | Status::LEVITATED_BEFORE,
//!     position_m: [1e-5, -2e-5],
//!     spin_rad_s: 1000.0,
//!     levitation_n: [-12.5, 25.0],
//!     ..Sample::default()
//! });
//! assert_eq!(command.force_n, [-12.5, 25.0]); // transparent while levitated
//!
//! // Towards the wall with 0.4 m/s, more than the cap can stop: it takes the bearing before the touch.
//! let mut position_m = [1e-5, -2e-5];
//! for sequence in 1..10 {
//!     position_m[0] += 0.4 * config.sample_period_s;
//!     let sample = Sample {
//!         sequence,
//!         status: Status::SPIN_VALID | Status::BEARING_ON | Status::LEVITATED_BEFORE,
//!         position_m,
//!         spin_rad_s: 1000.0,
//!         ..Sample::default()
//!     };
//!     supervisor.tick(&sample); // its force goes to the actuator
//! }
//! assert_eq!(supervisor.mode(), Mode::Approach);
//! assert_eq!(supervisor.report().landings, 0);
//! # Ok::<(), supervisor::ConfigError>(())
//! ```
//!
//! Signs and frames: x right, y up, angles and spin counter-clockwise positive; r̂ outwards from the
//! centre of the retainer bearing, t̂ = r̂ turned counter-clockwise. Backward means against the spin.
//! SI at the border, per unit inside (lengths in clearances, forces in caps, time in √(m·c/F)).
//!
//! ```text
//! Sample ─► guard ─► detect ─► estimate ─► classify ─► phase ─► law ─► limit ─► handover ─► Command
//!                                                                                 ├─► severity
//!                                                                                 └─► recorder
//! ```
//!
//! Files, each importing only from those above it: `parts`, `cells`, `words`, `scalar`, `product`, `q`, `math`, `vec2`, `signal`, `config`, `bending`, `coeffs`,
//! `spin`, `unbalance`, `innovation`, `reading`, `stuck`, `guard`, `actuator_monitor`, `estimate`, `beside`, `detect`, `impact`, `classify`, `phase`, `trust`, `law`, `limit`, `handover`, `tally`, `severity`,
//! `tick`, `entry`, `track`, `events`, `latest`, `tape`, `recorder`, `record`, `ledger`, `per_unit`, `supervisor`, `split`, `shaft`, `bearing`, `coupling`, `rotor`, `archive`, `self_test`, `watch`, `log_format`.

// Unconditional: under `cfg(test)` std's own methods would silently replace micromath's.
#![no_std]
#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod actuator_monitor;
mod archive;
mod bearing;
mod bending;
mod beside;
mod cells;
mod classify;
mod coeffs;
mod config;
mod coupling;
mod detect;
mod entry;
mod estimate;
mod events;
mod guard;
mod handover;
mod impact;
mod innovation;
mod latest;
mod law;
mod ledger;
mod limit;
#[cfg(feature = "defmt")]
mod log_format;
mod math;
mod parts;
mod per_unit;
mod phase;
mod product;
mod q;
mod reading;
mod record;
mod recorder;
mod rotor;
mod scalar;
mod self_test;
mod severity;
mod shaft;
mod signal;
mod spin;
mod split;
mod stuck;
mod supervisor;
mod tally;
mod tape;
mod tick;
mod track;
mod trust;
mod unbalance;
mod vec2;
mod watch;
mod words;

pub use archive::{Archive, ArchiveIn, ArchivePlace, RotorArchive};
pub use bearing::Bearing;
pub use coeffs::Scaling;
pub use config::{
    Config, ConfigError, Contradiction, CoreError, DefaultRule, Group, NotRepresentable,
    PARAMETERS, Parameter, RULES, Rule,
};
pub use entry::{ENTRY_WORDS, Entry};
pub use events::QueuedEvent;
pub use ledger::{LEDGER_BYTES, LEDGER_VERSION, Ledger, LedgerError};
pub use per_unit::{Core, Prepared};
pub use q::{AccumulatorQ, Q};
pub use record::{
    Head, MOST_WORDS, NO_STATE, Part, RECORD_VERSION, Record, SECTION_BYTES, SUPERVISOR_VERSION,
    Section, Stamp, Summary, crc_of,
};
pub use rotor::{Machine, Rotor, RotorCommand, RotorReader, RotorTicker};
pub use scalar::{Accumulator, Number, Scalar};
pub use self_test::SelfTest;
pub use shaft::{Place, Shaft, ShaftError};
pub use signal::{
    Command, CoreCommand, CoreSample, Events, IntegratorHint, Limits, Mode, RejectReason, Report,
    Sample, Status,
};
pub use split::{CoreTicker, Published, Reader, Ticker};
pub use supervisor::Supervisor;
pub use track::{STRETCH_WORDS, STRETCHES, Stretch};
pub use watch::CommandWatchdog;

/// The example of the crate's README runs with those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;
