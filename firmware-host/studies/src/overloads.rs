//! The catalogue of overloads: every scene, policy and seed, and what it says of the supervisor's promises.

pub mod case;
pub mod catalogue;
pub mod contenders;
pub mod fault_matrix;
pub mod impact;
pub mod page;
pub mod plan;
pub mod promises;
pub mod reference;
pub mod results;
pub mod situations;
pub mod sweeps;
pub mod takeover;
pub mod tune;
