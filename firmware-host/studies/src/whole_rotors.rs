//! The whole rotors of the catalogue.

pub mod catalogue;
mod hardest;
mod incidents;
mod loops;
mod plants;
pub mod reference;
mod wrong_shaft;

pub use self::incidents::{Hardest, Incident};
pub use self::plants::{Blow, Loop, RotorPlant};
