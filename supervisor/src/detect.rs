//! Approach and contact: where the rotor is against the clearance, and whether contact can still be
//! avoided.

use crate::coeffs::Coeffs;
use crate::estimate::Motion;
use crate::math::max;
use crate::vec2::Vec2;

/// What was found at this tick.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Findings {
    /// r̂ of the estimated position.
    pub(crate) normal: Vec2,
    /// Outward speed.
    pub(crate) radial_speed: f32,
    /// Counter-clockwise tangential speed.
    pub(crate) tangential_speed: f32,
    pub(crate) touching: bool,
    /// Touching began, ended at this tick.
    pub(crate) touched: bool,
    pub(crate) left: bool,
    /// The whole force inwards, from now on, could not prevent contact.
    pub(crate) unavoidable: bool,
    /// Half of it could, whatever the direction of the motion turns to.
    pub(crate) calm: bool,
}

/// Ticks for which the observer stays quick from the last tick in contact on: its velocity must get
/// over the impact.
const RECOVERY_TICKS: u8 = 3;

/// Below this radius a load estimate alone does not make contact unavoidable; it may be noise.
const LOAD_COUNTS_BEYOND: f32 = 0.5;

/// Memory of the detector.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Detector {
    touching: bool,
    recovery: u8,
}

impl Detector {
    /// Whether the observer should distrust its model.
    pub(crate) fn near_contact(&self) -> bool {
        self.touching || self.recovery > 0
    }

    /// Looks for contact in the sample itself, before the observer uses it.
    pub(crate) fn sample(&mut self, position: Option<Vec2>, coeffs: &Coeffs) -> (bool, bool) {
        let before = self.touching;
        if let Some(position) = position {
            let radius = if before {
                coeffs.leave_radius
            } else {
                coeffs.touch_radius
            };
            self.touching = position.length_squared() > radius * radius;
        }
        if self.touching {
            self.recovery = RECOVERY_TICKS;
        } else {
            self.recovery = self.recovery.saturating_sub(1);
        }
        (self.touching && !before, before && !self.touching)
    }

    pub(crate) fn findings(
        &self,
        motion: &Motion,
        (touched, left): (bool, bool),
        coeffs: &Coeffs,
    ) -> Findings {
        let (normal, radius) = motion.position.direction();
        let radial_speed = motion.velocity.dot(normal);
        let tangential_speed = motion.velocity.dot(normal.turned());
        let load = max(motion.load.dot(normal), 0.0);
        let available = |share: f32| {
            let left = share * coeffs.force_gain - load;
            if radius < LOAD_COUNTS_BEYOND {
                max(left, 0.25 * share * coeffs.force_gain)
            } else {
                left
            }
        };
        // v² against twice the work per mass that the force and the shaft do up to the wall.
        let spring = coeffs.stiffness * (1.0 - radius * radius);
        let stops = |speed: f32, share: f32| {
            let path = 1.0 - radius - speed * coeffs.horizon;
            path > 0.0 && speed * speed <= 2.0 * available(share) * path + spring
        };
        Findings {
            normal,
            radial_speed,
            tangential_speed,
            touching: self.touching,
            touched,
            left,
            unavoidable: radial_speed > 0.0 && !stops(radial_speed, 1.0),
            calm: !self.near_contact() && stops(motion.velocity.length(), 0.5),
        }
    }
}
