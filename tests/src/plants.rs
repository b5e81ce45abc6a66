//! The paper's rotor, and the benchmark problem of the plant's integrator tests.

#[path = "../../plant-model/tests/plant/support/bouncing.rs"]
mod benchmark;

pub use benchmark::{bouncing, bouncing_start};
pub use firmware_studies::paper::rotors::footnote_4;
