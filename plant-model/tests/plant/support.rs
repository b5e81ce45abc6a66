//! What the tests share: plants, rotors, runs, and an independent code; and what they use of the crate.

#[expect(
    unreachable_pub,
    reason = "tests/src/plants.rs compiles it, too, and hands it on"
)]
mod bouncing;
mod plants;
pub(crate) mod reference;
mod rotor;
mod runs;

pub(crate) use bouncing::*;
pub(crate) use plant_model::machine::params::*;
pub(crate) use plant_model::machine::{Machine, MachineInputs, MachineSnapshot};
pub(crate) use plant_model::params::*;
pub(crate) use plant_model::{
    BuildError, ContactMode, Inputs, Meters, Method, Options, Plant, PlantError, Snapshot, V2,
    build,
};
pub(crate) use plants::*;
pub(crate) use rotor::*;
pub(crate) use runs::*;
