//! Whole rotors under levitation alone and with the supervisor of both planes: drawn at random (`study`), and those of the
//! catalogue (`catalogue`).

pub mod catalogue;
mod compared;
mod drawn;
mod hardest;
mod plants;
pub mod study;

pub use self::compared::{Ran, Run};
pub use self::drawn::{Class, Event, RotorCase};
pub use self::plants::{Blow, Loop, RotorPlant};
