//! What the supervisor does at its border: what it promises, what is configured wrong, how it comes back, what it writes down.

#![allow(
    clippy::disallowed_methods,
    reason = "what the supervisor must not call, its tests may"
)]

mod arbitrary_bits;
mod archive;
mod axes;
mod border;
mod check;
mod configuration;
mod coordinate_left;
mod derating;
mod drive;
mod faults;
mod first_sample;
mod ledger;
mod numbers;
mod promises;
mod recorded;
mod refusals;
mod rotor;
mod sequence;
mod service;
mod severity;
mod split;
mod stuck;
mod trust;
mod waiting;
