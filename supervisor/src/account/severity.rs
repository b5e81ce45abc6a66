//! How bad it was and will be: landings, severity index, the severity of an impact before it comes, and
//! the request to coast down.

use crate::account::tally::{MOST_INDEX, Tally};
use crate::border::coeffs::Coeffs;
use crate::border::signal::{Events, Limits, Mode};
use crate::decide::detect::{ContactEstimate, Impact, sum_of_impacts};
use crate::number::scalar::{Accumulator, Scalar};
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::reading::{SampleFlags, Spin};

/// Largest severity that is reported.
const MOST_SEVERITY: f32 = 1e6;

/// Counters since the supervisor was made, per unit.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Severity<S: Scalar> {
    landings: u32,
    nuisances: u32,
    impacts: u32,
    contact_ticks: u32,
    /// Of the event that is recorded, or since it was.
    pub(crate) fastest: Fastest<S>,
    /// Severity index over its limit.
    index: S::Accumulator,
    /// An engagement is under way; the rotor has touched in it.
    engaged: bool,
    landed: bool,
    beyond_ticks: u32,
    coast_down: bool,
    /// Coasting down was asked for because of the index.
    index_reported: bool,
    /// Velocity at the last tick: what it was before an impact that the sample shows.
    before: Vec2<S>,
}

words_of_fields!(Severity<S> { landings, nuisances, impacts, contact_ticks, fastest, index, engaged, landed, beyond_ticks, coast_down, index_reported, before });

/// Fastest normal speed before an impact, and backward in contact.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Fastest<S> {
    impact: S,
    backward: S,
}

words_of_fields!(Fastest<S> { impact, backward });

impl<S: Scalar> Fastest<S> {
    /// Of both.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            impact: self.impact.max(other.impact),
            backward: self.backward.max(other.backward),
        }
    }

    /// In another unit.
    pub(crate) fn rescaled(self, speed: S) -> Self {
        Self {
            impact: self.impact * speed,
            backward: self.backward * speed,
        }
    }
}

/// What it is judged by while the supervisor acts. Taken apart within the tick: none of it is laid down for a rotor that levitates.
pub(crate) struct Evidence<'a, S: Scalar> {
    /// The speed is a guess.
    pub(crate) fresh: bool,
    pub(crate) contact: &'a ContactEstimate<S>,
    /// The next impact in flight.
    pub(crate) ahead: Option<&'a Impact<S>>,
    pub(crate) spin: Spin,
    /// Force that acts \[caps\].
    pub(crate) acting: Vec2<S>,
    /// Of the axis, now: it is the axis that touches.
    pub(crate) velocity: Vec2<S>,
    pub(crate) coeffs: &'a Coeffs<S>,
}

/// What a tick has to report.
#[derive(Default)]
pub(crate) struct SeverityAssessment<S> {
    /// Predicted backward speed over the whirl limit.
    pub(crate) severity: S,
    pub(crate) limits: Limits,
    pub(crate) events: Events,
}

impl<S: Scalar> Severity<S> {
    /// The same of a rotor that levitates on.
    #[inline]
    pub(crate) fn levitated(&mut self, velocity: Vec2<S>) {
        self.before = velocity;
    }

    #[inline]
    pub(crate) fn assess(
        &mut self,
        mode: Mode,
        evidence: &Evidence<'_, S>,
        flags: SampleFlags,
    ) -> SeverityAssessment<S> {
        let before = core::mem::replace(&mut self.before, evidence.velocity);
        if !flags.contains(SampleFlags::ON) {
            self.coast_down = false;
        }
        match mode {
            Mode::Levitated => {
                if self.engaged {
                    self.ends();
                }
                SeverityAssessment::default()
            }
            // What is not measured is not counted.
            Mode::SensorFault => {
                self.engaged = true;
                SeverityAssessment::default()
            }
            _ => {
                self.engaged = true;
                self.engaged(evidence, flags, before)
            }
        }
    }

    /// The rotor levitates again.
    #[cold]
    fn ends(&mut self) {
        self.engaged = false;
        let nuisance = !core::mem::take(&mut self.landed);
        self.nuisances = self.nuisances.saturating_add(u32::from(nuisance));
        self.beyond_ticks = 0;
    }

    /// `before` is the velocity of the axis at the last tick.
    #[inline]
    fn engaged(
        &mut self,
        evidence: &Evidence<'_, S>,
        flags: SampleFlags,
        before: Vec2<S>,
    ) -> SeverityAssessment<S> {
        let mut result = SeverityAssessment::default();
        let (contact, coeffs) = (evidence.contact, evidence.coeffs);
        // The speed of a first sample is a guess.
        let backward = if evidence.fresh {
            S::ZERO
        } else {
            evidence.spin.backward(contact.tangential_speed)
        };
        let coming = if contact.touching {
            if flags.contains(SampleFlags::USED) {
                self.contact(before, backward, contact, evidence.acting, coeffs);
            }
            let outward = contact.radial_speed.max(S::ZERO);
            sum_of_impacts(backward, outward, coeffs.bounce_gain)
        } else {
            match evidence.ahead {
                Some(impact) if contact.unavoidable => {
                    let backward = evidence.spin.backward(impact.along);
                    sum_of_impacts(backward, impact.normal_speed, coeffs.bounce_gain)
                }
                _ => S::ZERO,
            }
        };
        let severity = (coming * coeffs.per_whirl_limit).max(S::ZERO);
        result.severity = severity.min(S::from_f32(MOST_SEVERITY));

        let beyond = backward * coeffs.per_whirl_limit > S::ONE;
        if beyond && contact.touching && flags.contains(SampleFlags::USED) {
            result.limits |= Limits::BEYOND_WHIRL_LIMIT;
            self.beyond_ticks = self.beyond_ticks.saturating_add(1);
        } else if !beyond {
            // A rotor that leaves the wall for some ticks without losing speed has not been stopped.
            self.beyond_ticks = 0;
        }
        // The index never falls: what it asks for it asks for once, unless its limit is raised. A request that is
        // out already does not keep it from being reported later.
        let passed = self.index.value() > S::ONE;
        self.index_reported = self.index_reported && passed;
        let by_index = passed && !self.index_reported;
        if (by_index || self.beyond_ticks > coeffs.coast_down_ticks) && !self.coast_down {
            self.coast_down = true;
            self.index_reported = passed;
            result.events |= Events::COAST_DOWN;
        }
        result
    }

    /// A tick in contact: impact and friction, as squares of speed.
    #[inline]
    fn contact(
        &mut self,
        before: Vec2<S>,
        backward: S,
        contact: &ContactEstimate<S>,
        force: Vec2<S>,
        coeffs: &Coeffs<S>,
    ) {
        if !self.landed {
            self.landed = true;
            self.landings = self.landings.saturating_add(1);
        }
        self.contact_ticks = self.contact_ticks.saturating_add(1);
        self.fastest.backward = self.fastest.backward.max(backward);
        let mut energy = S::ZERO;
        if contact.touched {
            self.impacts = self.impacts.saturating_add(1);
            let speed = before.dot(contact.normal).max(S::ZERO);
            self.fastest.impact = self.fastest.impact.max(speed);
            energy = speed * speed;
        }
        // Normal force that keeps the rotor on its circle against what pulls it off.
        let along = contact.tangential_speed;
        let outward = force.dot(contact.normal) + contact.load;
        let normal = (along * along - coeffs.stiffness + outward).max(S::ZERO);
        let friction = coeffs.friction * normal * along.abs() * coeffs.tick;
        energy = energy + friction + friction;
        if self.index.value() <= S::from_f32(MOST_INDEX) {
            self.index.add(energy, coeffs.index_rate);
        }
    }

    /// Whether coasting down was asked for, and the bearing has been on since.
    pub(crate) fn coast_down(&self) -> bool {
        self.coast_down
    }

    /// What it has to report; `earlier`: fastest before what is recorded.
    #[inline]
    pub(crate) fn tally(&self, earlier: Fastest<S>) -> Tally<S> {
        let fastest = self.fastest.or(earlier);
        Tally {
            landings: self.landings,
            nuisances: self.nuisances,
            impacts: self.impacts,
            contact_ticks: self.contact_ticks,
            coast_down: self.coast_down,
            impact: fastest.impact,
            backward: fastest.backward,
            index: self.index.value(),
            ..Tally::default()
        }
    }

    /// After a change of the units of speed and of what the index is measured by.
    pub(crate) fn rescale(&mut self, speed: S, index: f32) {
        self.fastest = self.fastest.rescaled(speed);
        self.before = self.before * speed;
        self.index = self.index.scaled(index);
    }
}
