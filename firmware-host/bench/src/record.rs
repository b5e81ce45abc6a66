//! Flight records as firmware has written them down: what of a file is whole, what happened in it, what it tells of the machine,
//! and whether the supervisor of this build does the same.

mod contacts;
pub mod file;
mod flights;
pub mod identify;
mod motion;
pub mod narrative;
pub mod remaining;
pub mod replay;
pub mod shapes;
pub mod ticks;
pub mod unknown;

pub use contacts::{Contact, Impulse};
