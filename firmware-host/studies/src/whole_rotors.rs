//! Whole rotors drawn at random: levitation alone beside the supervisor of both planes.

mod compared;
mod drawn;
pub mod study;

pub use self::compared::{Ran, Run};
pub use self::drawn::{Class, Event, RotorCase};
