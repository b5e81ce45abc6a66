//! Whole rotors under levitation alone and with the supervisor of both planes: drawn at random (`study`), and those of the
//! catalogue (`catalogue`).

pub mod catalogue;
mod compared;
mod drawn;
mod hardest;
mod incidents;
mod loops;
mod plants;
pub mod reference;
pub mod study;
pub mod told_bending;
mod wrong_shaft;

pub use self::compared::{Ran, Run};
pub use self::drawn::{Class, Event, RotorCase};
pub use self::incidents::{Hardest, Incident};
pub use self::plants::{Blow, Loop, RotorPlant};
