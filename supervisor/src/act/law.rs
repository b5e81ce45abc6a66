//! The wanted force per mode. Pure functions; nothing here is limited yet.
//!
//! What drives a rotor into backward whirl is friction at impacts: an impact with normal speed v_n
//! adds μ(1 + e)·v_n to the backward tangential speed, and the bounces that follow add their share of
//! what is left. Over all of them the backward speed comes to S = v_b + K·v_n with
//! K = μ(1 + e)/(1 − e). A force lowers S fastest against its gradient in the velocity: at the wall
//! b̂ + K·n̂, b̂ being the backward direction and n̂ the normal of the *next* impact; farther inside a
//! force has less of an arm about the centre, and damping the speed itself counts for more. In
//! continuous contact only −b̂ brakes, and an inward part of μ takes away some of the driving
//! friction: −(b̂ + μ·n̂).

use crate::border::coeffs::{Coeffs, NEARLY_ALL};
use crate::decide::detect::{Impact, Speed, sum_of_impacts};
use crate::decide::phase::Phase;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::sense::reading::Spin;

/// Wanted forces in the order in which they may use the capacity \[caps\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ForceDemand<S> {
    /// Against the backward tangential speed; in whirl tilted inwards by what friction is worth.
    pub(crate) braking: Vec2<S>,
    /// Against the velocity.
    pub(crate) damping: Vec2<S>,
    /// Inwards.
    pub(crate) restoring: Vec2<S>,
    /// Wanted in contact.
    pub(crate) touching: bool,
}

/// Of the whirl limit: impacts that will add up to less need no help but to be softened …
const HARMLESS: f32 = 0.65;
/// … and so much beyond it all the force goes to what they add.
const URGENT_AFTER: f32 = 0.35;
/// What is harmless in an impact that has begun, which goes on losing its speed.
const IN_CONTACT: f32 = 0.4;
/// Share of the cap that pushes inwards between impacts: more shortens the chords and with them the time
/// in which braking takes speed out.
const FLIGHT_SHARE: f32 = 0.15;

/// How much stronger a load of the cap or more, outwards, makes the restoring force: without it a load a little below the
/// cap keeps the rotor beside the wall.
const LOAD_SHARE: f32 = 0.5;

/// At rest on the wall a slower speed is noise, and costs no force \[lift-off speeds\].
const STILL: f32 = 0.1;

/// What the law looks at: a copy of what it needs, for the law is called and not part of the tick, and what it was shown by reference
/// would have to be in memory in every tick.
pub(crate) struct View<'a, S: Scalar> {
    pub(crate) position: Vec2<S>,
    pub(crate) velocity: Vec2<S>,
    /// As in [`crate::estimate::observer::Motion`].
    pub(crate) load_step: Vec2<S>,
    pub(crate) speed: Speed<S>,
    /// As in [`crate::decide::detect::ContactEstimate`].
    pub(crate) normal: Vec2<S>,
    pub(crate) per_radius: S,
    pub(crate) radial_speed: S,
    pub(crate) tangential_speed: S,
    pub(crate) load: S,
    pub(crate) touching: bool,
    /// The next impact in flight.
    pub(crate) ahead: Option<&'a Impact<S>>,
    pub(crate) spin: Spin,
    /// Force that acts.
    pub(crate) delivered: &'a Vec2<S>,
    pub(crate) coeffs: &'a Coeffs<S>,
}

impl<S: Scalar> View<'_, S> {
    /// The wanted force of a phase; zero for those in which the supervisor wants nothing itself.
    #[inline(never)]
    pub(crate) fn demand(&self, phase: Phase<S>) -> ForceDemand<S> {
        match phase {
            Phase::Levitated | Phase::HandedBack { .. } | Phase::SensorFault { .. } => {
                ForceDemand::default()
            }
            Phase::Pinned { hold } => self.hold(hold),
            Phase::BackwardWhirl => self.in_contact(true),
            _ if self.touching => self.in_contact(false),
            _ => self.in_flight(),
        }
    }

    /// What friction adds; with unknown spin nobody knows which way an impact will push, and only the whirl counts
    /// that is there, or its sense, and the force with it, would change from tick to tick.
    #[inline]
    fn by_friction(&self, added: S) -> S {
        match self.spin {
            Spin::Unknown => S::ZERO,
            _ => added,
        }
    }

    /// (4.8)'s K.
    fn bounce_gain(&self) -> S {
        self.by_friction(self.coeffs.bounce_gain)
    }

    /// What the cap has over an outward load \[caps\].
    fn braked(&self) -> S {
        (S::ONE - self.load).clamp(S::ZERO, S::ONE)
    }

    /// Against the speed, −D·v; no longer than twice the cap, which no envelope holds either.
    fn damping(&self) -> Vec2<S> {
        let twice = self.speed.inverse + self.speed.inverse;
        self.velocity * -self.coeffs.damper.min(twice)
    }

    /// In flight. What speed leaves of the capacity brings the rotor back: damping alone would let it lie.
    /// When slow, a little more of it than a hold on the wall has, or the two would take turns; but no more than is
    /// stable with a force that comes late.
    #[inline]
    fn in_flight(&self) -> ForceDemand<S> {
        let coeffs = self.coeffs;
        let most = coeffs.restoring;
        let share = (most - self.speed.square).max(most.min(S::from_f32(FLIGHT_SHARE)));
        let slow = (S::ONE - self.speed.square).max(S::ZERO);
        let load = self.load.clamp(S::ZERO, S::ONE) * (slow * most * S::from_f32(LOAD_SHARE));
        let carrying = (S::ONE - most * S::from_f32(1.0 / NEARLY_ALL)).max(S::ZERO);
        let carried = self.load_step * (coeffs.per_tick * slow * carrying);
        ForceDemand {
            braking: match self.ahead {
                Some(impact) => self.before(impact),
                None => Vec2::ZERO,
            },
            damping: self.damping(),
            restoring: self.position * -(share + load) - carried,
            touching: false,
        }
    }

    /// Against what the impacts to come will add up to, by its gradient in the velocity at the place where
    /// a force that is decided now will act. If the next impact comes before that, it is the flight after
    /// it, with the velocity that the impact will leave.
    #[inline]
    fn before(&self, impact: &Impact<S>) -> Vec2<S> {
        let coeffs = self.coeffs;
        let gain = self.bounce_gain();
        let sense = self.spin.sense_of_backward(impact.along);
        let (mut normal_speed, mut backward) = (impact.normal_speed, impact.along * sense);
        // What a force that acts already, and after that the cap, against the speed leaves of it until the impact.
        let speed = self.speed.value();
        let way = impact.time * speed;
        let early = way.min(coeffs.horizon * speed);
        let slowing = -self.delivered.dot(self.velocity) * self.speed.inverse;
        let work = early * slowing + (way - early) * self.braked();
        let left = (self.speed.square - (work + work)).sqrt();
        let time = (way + way).div(speed + left);
        let sum =
            sum_of_impacts(backward, normal_speed, gain) * (left * self.speed.inverse).min(S::ONE);
        let urgency = urgency(sum, HARMLESS, coeffs);
        if urgency <= S::ZERO {
            return Vec2::ZERO;
        }
        let (mut position, mut velocity) = (self.position, self.velocity);
        let mut act_after = coeffs.horizon;
        if time < act_after {
            let n = impact.normal;
            let lost = (S::ONE + coeffs.restitution) * normal_speed;
            let friction = self.by_friction(coeffs.friction * lost);
            velocity = velocity - n * lost + n.perp() * (friction * sense);
            normal_speed = coeffs.restitution * normal_speed;
            backward = backward + friction;
            position = n;
            // A chord from wall to wall lasts 2·v_n/v².
            let (square, twice) = (velocity.length_squared(), normal_speed + normal_speed);
            let left = act_after - time;
            act_after = if left * square <= twice {
                left
            } else {
                twice.div(square)
            };
        }
        let acts_at = position + velocity * act_after;
        // Gradient of S, times v_n: v_b = r × v about the centre, v_n = √(v² − v_b²).
        let arm = sense * (normal_speed - gain * backward);
        let gradient = acts_at.perp() * arm + velocity * gain;
        gradient * -(gradient.inverse_length() * urgency)
    }

    /// In contact: brake along the wall, aimed at where the rotor will be when the force has come. `driven`: friction
    /// drives all the time, and an inward part takes away from it what it costs along the wall; in an impact on a hard wall, which
    /// is over when that part has come, it would only shorten the chord to the next one, and on a soft one it is worth
    /// [`Self::inward_worth`].
    #[inline]
    fn in_contact(&self, driven: bool) -> ForceDemand<S> {
        let coeffs = self.coeffs;
        let n = self.normal;
        let sense = self.spin.sense_of_backward(self.tangential_speed);
        let outward = self.radial_speed.max(S::ZERO);
        let worth = if driven {
            coeffs.friction
        } else {
            self.inward_worth()
        };
        let backward = self.tangential_speed * sense;
        let sum = sum_of_impacts(backward, outward, self.bounce_gain());
        let mut strength = sum * coeffs.damper;
        if !driven {
            // What the impacts will add counts as far as it is dangerous, what is there counts in full.
            let there = backward * coeffs.damper;
            let urgency = urgency(sum, IN_CONTACT, coeffs);
            strength = strength.min(urgency).max(there);
        }
        let strength = strength.clamp(S::ZERO, S::ONE);
        let braking = if strength > S::ZERO {
            let rate = self.tangential_speed * self.per_radius;
            // Unit vector against b̂ + w·n̂.
            let along = n.perp() * sense;
            let (against, length) = if driven {
                (along + n * worth, coeffs.tilt)
            } else if worth > S::ZERO {
                let against = along + n * worth;
                (against, against.inverse_length() * S::JUST_BELOW_ONE)
            } else {
                (along, S::JUST_BELOW_ONE)
            };
            (against * -(strength * length)).rotated(self.lead(rate))
        } else {
            Vec2::ZERO
        };
        // Slower than lift-off an inward force can end the contact.
        let pressing = (self.load.min(S::JUST_BELOW_ONE)).max(coeffs.pressing);
        let inward = (pressing - self.speed.square).max(S::ZERO);
        ForceDemand {
            braking,
            damping: self.damping(),
            restoring: n * -inward,
            touching: true,
        }
    }

    /// What an inward force in an impact is worth over one along the wall, by the gradient of (4.8). On a wall that gives way the rotor swings in with d = A·sin φ, and a push there takes J·(1 + cos φ) from ∫N dt and
    /// J·cos φ from the speed with which it will leave: w = μ + (μ + K)·cos φ, at the time when the force has come. Nothing on a
    /// wall that is left by then.
    fn inward_worth(&self) -> S {
        let coeffs = self.coeffs;
        let Some([cosine, sine, rate]) = coeffs.contact_ahead else {
            return S::ZERO;
        };
        let depth = (self.position.dot(self.normal) - S::ONE).max(S::ZERO);
        let swing = depth * rate;
        let per_amplitude = Vec2::new(self.radial_speed, swing).inverse_length();
        let then = (self.radial_speed * cosine - swing * sine) * per_amplitude;
        let friction = self.by_friction(coeffs.friction);
        let worth = friction + (friction + self.bounce_gain()) * then;
        worth.max(S::ZERO)
    }

    /// Rotation that makes up for delay and lag on a circle at this rate: a delay of h turns a rotating
    /// force by ω·h, a lag of τ by atan(ω·τ).
    #[inline]
    fn lead(&self, rate: S) -> Vec2<S> {
        // Up to a radian, beyond which no lead would help.
        let angle = (rate * self.coeffs.delay_time).within(S::ONE);
        Vec2::at_angle(angle)
            .rotated(Vec2::new(S::ONE, rate * self.coeffs.lag))
            .direction()
    }

    /// On the wall under a load: push inwards, keep still.
    fn hold(&self, share: S) -> ForceDemand<S> {
        let coeffs = self.coeffs;
        let sense = self.spin.sense_of_backward(self.tangential_speed);
        let still = S::from_f32(STILL);
        let backward = self.tangential_speed * sense - still;
        let strength = (backward * coeffs.damper).clamp(S::ZERO, S::ONE);
        let moving = (S::ONE - still * self.speed.inverse).max(S::ZERO);
        ForceDemand {
            braking: self.normal.perp() * -(sense * strength),
            damping: self.damping() * moving,
            restoring: self.normal * -share,
            touching: true,
        }
    }
}

/// How much of the capacity impacts need that will add up to this backward speed, beyond a harmless share of the whirl limit;
/// none at zero or less.
#[inline]
fn urgency<S: Scalar>(sum: S, harmless: f32, coeffs: &Coeffs<S>) -> S {
    let beyond_harmless = sum * coeffs.per_whirl_limit - S::from_f32(harmless);
    (beyond_harmless * S::from_f32(1.0 / URGENT_AFTER)).min(S::JUST_BELOW_ONE)
}
