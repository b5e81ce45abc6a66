//! Forward rub that does not end: unbalance that the levitation controller holds free of the wall, and not once it is on it.

mod drawn;
pub mod study;

pub use self::drawn::{Motion, RubCase};
