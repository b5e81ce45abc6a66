//! The catalogue of overloads: every scene, policy and seed, and what it says of the supervisor's promises.

pub mod found;
pub mod impact;
pub mod loop_shape;
pub mod plants;
pub mod reference;
pub mod seats;
pub mod takeover;
pub mod tune;
