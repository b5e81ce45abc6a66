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
//! Files, each importing only from those above it: `number/words`, `number/scalar`, `number/product`, `number/q`,
//! `number/vec2`, `border/parts`, `border/finding`, `border/signal`, `border/config`, `border/shaft`, `border/bearing`,
//! `border/modes`, `border/coeffs`, `sense/reading`, `sense/innovation`, `sense/stuck`, `sense/guard`,
//! `estimate/unbalance`, `estimate/bending`, `estimate/monitor`, `estimate/observer`, `estimate/neighbour`,
//! `decide/detect`, `decide/classify`, `decide/phase`, `decide/trust`, `act/law`, `act/limit`, `act/handover`,
//! `account/tally`, `account/severity`, `tick`, `record/entry`, `record/publish`, `record/buffer`,
//! `record/recorder`, `record/sections`, `record/ledger`, `per_unit`, `check`, `supervisor`, `rotor/coupling`,
//! `rotor/ticker`, `rotor/two_planes`, `archive`, `self_test`, `watch`, `log_format`.

// Unconditional: under `cfg(test)` std's own methods would silently replace micromath's.
#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod number {
    pub(crate) mod product;
    pub(crate) mod q;
    pub(crate) mod scalar;
    pub(crate) mod vec2;
    pub(crate) mod words;
}
mod border {
    pub(crate) mod bearing;
    pub(crate) mod coeffs;
    pub(crate) mod config;
    pub(crate) mod finding;
    pub(crate) mod modes;
    pub(crate) mod parts;
    pub(crate) mod shaft;
    pub(crate) mod signal;
}
mod sense {
    pub(crate) mod guard;
    pub(crate) mod innovation;
    pub(crate) mod reading;
    pub(crate) mod stuck;
}
mod estimate {
    pub(crate) mod bending;
    pub(crate) mod monitor;
    pub(crate) mod neighbour;
    pub(crate) mod observer;
    pub(crate) mod unbalance;
}
mod decide {
    pub(crate) mod classify;
    pub(crate) mod detect;
    pub(crate) mod phase;
    pub(crate) mod trust;
}
mod act {
    pub(crate) mod handover;
    pub(crate) mod law;
    pub(crate) mod limit;
}
mod account {
    pub(crate) mod severity;
    pub(crate) mod tally;
}
mod tick;
mod record {
    pub(crate) mod buffer;
    pub(crate) mod entry;
    pub(crate) mod ledger;
    pub(crate) mod publish;
    pub(crate) mod recorder;
    pub(crate) mod sections;
}
mod check;
mod per_unit;
mod supervisor;
mod rotor {
    pub(crate) mod coupling;
    pub(crate) mod ticker;
    pub(crate) mod two_planes;
}
mod archive;
#[cfg(feature = "defmt")]
mod log_format;
mod self_test;
mod watch;

pub use archive::{Archive, ArchiveIn, ArchivePlace, RotorArchive};
pub use border::bearing::Bearing;
pub use border::coeffs::Scaling;
pub use border::config::{
    Config, ConfigError, Contradiction, CoreError, DefaultRule, Group, NotRepresentable,
    PARAMETERS, Parameter, RULES, Rule,
};
pub use border::finding::{Checked, Finding};
pub use border::shaft::{PlanePositions, Shaft, ShaftError};
pub use border::signal::{
    Command, CoreCommand, CoreSample, Events, IntegratorHint, Limits, Mode, RejectReason, Report,
    Sample, Status,
};
pub use number::q::{AccumulatorQ, Q};
pub use number::scalar::{Accumulator, Number, Scalar};
pub use per_unit::{Core, Prepared};
pub use record::entry::{ENTRY_WORDS, Entry};
pub use record::entry::{STRETCH_WORDS, Stretch};
pub use record::ledger::{LEDGER_BYTES, LEDGER_VERSION, Ledger, LedgerError};
pub use record::publish::QueuedEvent;
pub use record::sections::{
    Head, MOST_WORDS, NO_STATE, Part, RECORD_VERSION, Record, SECTION_BYTES, SUPERVISOR_VERSION,
    Section, Stamp, Summary, crc_of,
};
pub use rotor::ticker::{HalfTick, RotorCommand, RotorTicker};
pub use rotor::two_planes::{RotorCore, RotorReader, RotorSupervisor};
pub use self_test::SelfTest;
pub use supervisor::Supervisor;
pub use supervisor::{CoreTicker, Published, Reader, Ticker};
pub use watch::CommandWatchdog;

/// The example of the crate's README runs with those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;
