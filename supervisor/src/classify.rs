//! What kind of contact it is: bounce, continuous backward whirl, or held by a load.

use crate::coeffs::Coeffs;
use crate::detect::Findings;

/// Kind of motion on the retainer bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Class {
    Bounce,
    BackwardWhirl,
    Pinned,
}

/// Share of time in contact beyond which it is continuous.
const CONTINUOUS: f32 = 0.6;
/// Whirl is faster, rest is slower than these shares of the square of the lift-off speed.
const WHIRL_SPEED_SQUARED: f32 = 0.1;
const REST_SPEED_SQUARED: f32 = 0.05;
/// Rest ends only beyond this share, so that noise does not end it.
const MOVING_SPEED_SQUARED: f32 = 0.2;

/// Memory of the classifier.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Classifier {
    contact_share: f32,
    ticks_touching: u32,
    resting: bool,
}

impl Classifier {
    pub(crate) fn classify(&mut self, found: &Findings, spin_sign: f32, coeffs: &Coeffs) -> Class {
        let now = if found.touching { 1.0 } else { 0.0 };
        self.contact_share += coeffs.contact_share_step * (now - self.contact_share);
        self.ticks_touching = if found.touching {
            self.ticks_touching.saturating_add(1)
        } else {
            0
        };
        let along = found.tangential_speed;
        let square = along * along + found.radial_speed * found.radial_speed;
        let share_of_lift_off = |share: f32| share * coeffs.slow_squared;
        self.resting = if self.resting {
            found.touching && square < share_of_lift_off(MOVING_SPEED_SQUARED)
        } else {
            self.ticks_touching > coeffs.whirl_ticks
                && square < share_of_lift_off(REST_SPEED_SQUARED)
        };
        // With unknown spin every whirl counts as backward: friction will make it so.
        let backward = spin_sign * along <= 0.0;
        if self.resting {
            Class::Pinned
        } else if self.contact_share > CONTINUOUS
            && backward
            && along * along > share_of_lift_off(WHIRL_SPEED_SQUARED)
        {
            Class::BackwardWhirl
        } else {
            Class::Bounce
        }
    }
}
