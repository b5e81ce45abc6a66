//! What tests of the supervisor share with those that span the crates. It needs nothing but the supervisor.

pub mod bearing;
pub mod bench;
pub mod bounds;
pub mod records;
pub mod rig;
pub mod storm;

use supervisor::{CoreSample, Scalar};

/// The same sample in other numbers, each the nearest.
pub fn in_numbers<S: Scalar>(sample: &CoreSample<f32>) -> CoreSample<S> {
    CoreSample {
        sequence: sample.sequence,
        status: sample.status,
        position: sample.position.map(S::from_f32),
        spin: S::from_f32(sample.spin),
        levitation: sample.levitation.map(S::from_f32),
        applied: sample.applied.map(S::from_f32),
    }
}
