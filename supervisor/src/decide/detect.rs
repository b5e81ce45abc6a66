//! Approach and contact: where the rotor is against the clearance, and whether contact can still be
//! avoided.
//!
//! Where the rotor is going: its speed, and the next impact at the end of a straight path.

use crate::border::coeffs::Coeffs;
use crate::estimate::neighbour::RotorCoupling;
use crate::estimate::observer::{Contact, Motion};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;

/// What was found at this tick.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ContactEstimate<S> {
    /// r̂ of the estimated position.
    pub(crate) normal: Vec2<S>,
    pub(crate) radius: S,
    /// 1/r; 0 where there is no direction.
    pub(crate) per_radius: S,
    /// How far from the centre it may be: less than the clearance by how far the axis is beside it.
    pub(crate) reach: S,
    /// Outward speed.
    pub(crate) radial_speed: S,
    /// Counter-clockwise tangential speed.
    pub(crate) tangential_speed: S,
    /// Outward acceleration by an unknown load.
    pub(crate) load: S,
    pub(crate) touching: bool,
    /// Touching began, ended at this tick.
    pub(crate) touched: bool,
    pub(crate) left: bool,
    /// The force that the budget leaves, inwards and from now on, could not prevent contact.
    pub(crate) unavoidable: bool,
}

/// What a tick changed about touching.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Touch {
    pub(crate) began: bool,
    pub(crate) ended: bool,
}

/// Whether a rotor can be stopped: with which share of which force \[caps\], and which outward speed does not count.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StopTest<S> {
    pub(crate) force: S,
    pub(crate) share: S,
    pub(crate) margin: S,
}

/// Ticks for which the observer stays quick from the last tick in contact on: its velocity must get
/// over the impact.
const RECOVERY_TICKS: u8 = 3;

/// Below this radius a load estimate alone does not make contact unavoidable; it may be noise.
const LOAD_COUNTS_BEYOND: f32 = 0.5;

/// Times that the observer takes to settle within which the wall is near.
const NEAR: f32 = 16.0;

/// Memory of the detector.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Detector {
    touching: bool,
    recovery: u8,
    /// Ticks in a row in which contact seemed unavoidable.
    alarmed: u8,
}

words_of_fields!(Detector {
    touching,
    recovery,
    alarmed
});

impl Detector {
    /// Whether the rotor touches.
    #[inline]
    pub(crate) fn is_touching(&self) -> bool {
        self.touching
    }

    /// What the wall does; `resting`: the rotor did at the last tick.
    #[inline]
    pub(crate) fn wall(&self, resting: bool) -> Contact {
        if resting && self.touching {
            Contact::Resting
        } else if self.touching || self.recovery > 0 {
            Contact::Impact
        } else {
            Contact::None
        }
    }

    /// Looks for contact in the sample itself, before the observer uses it.
    #[inline]
    pub(crate) fn sample<S: Scalar>(
        &mut self,
        position: Option<Vec2<S>>,
        coeffs: &Coeffs<S>,
    ) -> Touch {
        let before = self.touching;
        if let Some(position) = position {
            let radius = if before {
                coeffs.leave_radius
            } else {
                coeffs.touch_radius
            };
            self.touching = position.exceeds(radius);
        }
        if self.touching {
            self.recovery = RECOVERY_TICKS;
        } else {
            self.recovery = self.recovery.saturating_sub(1);
        }
        Touch {
            began: self.touching && !before,
            ended: before && !self.touching,
        }
    }

    /// Nothing is coming.
    #[inline]
    pub(crate) fn rest(&mut self) {
        self.alarmed = 0;
    }

    /// `beside`: how far the axis is beside what moves; `test`: with what the budget leaves of the cap.
    #[inline]
    pub(crate) fn contact_estimate<S: Scalar>(
        &mut self,
        motion: &Motion<S>,
        beside: S,
        touch: Touch,
        test: StopTest<S>,
        coupling: Option<&RotorCoupling<S>>,
        coeffs: &Coeffs<S>,
    ) -> ContactEstimate<S> {
        let per_radius = motion.position.inverse_length();
        let normal = motion.position * per_radius;
        let mut contact = ContactEstimate {
            normal,
            radius: motion.position.dot(normal),
            per_radius,
            reach: S::ONE - beside,
            radial_speed: motion.velocity.dot(normal),
            tangential_speed: motion.velocity.dot(normal.perp()),
            load: motion.load_step.dot(normal) * coeffs.per_tick,
            touching: self.touching,
            touched: touch.began,
            left: touch.ended,
            unavoidable: false,
        };
        if let Some(coupling) = coupling {
            // The observer knows of it and takes it for no load.
            contact.load = contact.load + coupling.known.dot(normal);
        }
        let outward = contact.radial_speed - test.margin;
        let mut alarm = outward > S::ZERO && !contact.can_stop_before_wall(outward, test, coeffs);
        if let Some(coupling) = coupling
            && alarm
        {
            alarm = !contact.nutation_avoids_contact(motion, coupling, test, coeffs);
        }
        self.alarmed = if alarm {
            self.alarmed.saturating_add(1)
        } else {
            0
        };
        // Twice the lag of the load is what the observer takes to settle.
        let settling = coeffs.observer.flight_lag + coeffs.observer.flight_lag;
        let near = outward * (settling * (coeffs.tick * S::from_f32(NEAR)));
        let urgent = near > contact.reach - contact.radius;
        contact.unavoidable = alarm && (urgent || S::count(u32::from(self.alarmed)) > settling);
        contact
    }
}

impl<S: Scalar> ContactEstimate<S> {
    /// Whether nutation keeps the rotor off the wall: it goes round a centre that a share of this force stops in time.
    #[inline(never)]
    pub(crate) fn nutation_avoids_contact(
        &self,
        motion: &Motion<S>,
        coupling: &RotorCoupling<S>,
        test: StopTest<S>,
        coeffs: &Coeffs<S>,
    ) -> bool {
        let Some((centre, velocity, distance)) = coupling.centre(motion) else {
            return false;
        };
        let normal = centre.direction();
        let about = Self {
            radius: centre.dot(normal),
            reach: self.reach - distance,
            ..*self
        };
        let outward = (velocity.dot(normal) - test.margin).max(S::ZERO);
        about.reach > about.radius && about.can_stop_before_wall(outward, test, coeffs)
    }

    /// Whether a share of what the force inwards has over load and magnets' pull, from when it can act, stops a rotor of
    /// this speed before the wall, or before where the pull is stronger: v² against twice the work up to there, the shaft's
    /// with it.
    pub(crate) fn can_stop_before_wall(
        &self,
        speed: S,
        test: StopTest<S>,
        coeffs: &Coeffs<S>,
    ) -> bool {
        let mut left = test.force - self.load.max(S::ZERO);
        if self.radius < S::from_f32(LOAD_COUNTS_BEYOND) {
            left = left.max(S::from_f32(0.25) * test.force);
        }
        let pulls = coeffs.stiffness < S::ZERO;
        let reach = if pulls {
            self.reach.min(left * coeffs.per_pull)
        } else {
            self.reach
        };
        let room = reach - self.radius;
        let path = room - speed * coeffs.horizon;
        if path <= S::ZERO {
            return false;
        }
        let spring = coeffs.stiffness * room * (reach + self.radius);
        speed * speed <= ((left + left) * path + spring) * test.share
    }
}

/// Speed, with its square and its inverse.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Speed<S> {
    /// v²; over that of the lift-off speed, which is 1.
    pub(crate) square: S,
    /// 1/v; 0 for a rotor without speed.
    pub(crate) inverse: S,
}

impl<S: Scalar> Speed<S> {
    #[inline]
    pub(crate) fn new(velocity: Vec2<S>) -> Self {
        let (square, inverse) = (velocity.length_squared(), velocity.inverse_length());
        Self { square, inverse }
    }

    /// Its size. Not kept: a product costs less than a place on the stack.
    #[inline]
    pub(crate) fn value(&self) -> S {
        self.square * self.inverse
    }
}

/// Where a straight flight meets the clearance circle.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Impact<S> {
    /// Until then.
    pub(crate) time: S,
    pub(crate) normal: Vec2<S>,
    /// Normal and counter-clockwise tangential speed there.
    pub(crate) normal_speed: S,
    pub(crate) along: S,
}

impl<S: Scalar> Impact<S> {
    /// `None` for a rotor without speed, or beyond the wall.
    #[inline]
    pub(crate) fn ahead(motion: &Motion<S>, radius: S, speed: &Speed<S>) -> Option<Self> {
        let room = (S::ONE - radius) * (S::ONE + radius);
        if speed.inverse <= S::ZERO || room <= S::ZERO {
            return None;
        }
        let heading = motion.velocity * speed.inverse;
        let along = motion.position.dot(heading);
        let cosine = (along * along + room).sqrt();
        let chord = cosine - along;
        Some(Self {
            time: chord * speed.inverse,
            normal: motion.position + heading * chord,
            normal_speed: speed.value() * cosine,
            along: motion.position.perp().dot(motion.velocity),
        })
    }
}

/// Backward speed after all the impacts to come, v_b + K·v_n.
#[inline]
pub(crate) fn sum_of_impacts<S: Scalar>(backward: S, normal_speed: S, gain: S) -> S {
    backward + gain * normal_speed
}
