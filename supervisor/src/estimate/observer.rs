//! Position and velocity, from samples and from the force that the magnet delivers.
//!
//! In flight the model is good (known force, stiffness, damping, and a slowly varying load), so the
//! observer may be slow and smooth. In contact it is blind for the contact force and must be quick.

use crate::border::coeffs::{BESIDE, Coeffs, INSIDE, MAX_DELAY};
use crate::border::parts::AXIS_MONITOR;
use crate::estimate::bending::Bending;
use crate::estimate::monitor::{ActuatorMonitor, lagging};
use crate::estimate::unbalance::{Turn, Unbalance};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::innovation::Expected;
use crate::sense::reading::{Actuator, Rotation, SampleFlags, Spin};

/// Estimated motion, per unit.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Motion<S> {
    pub(crate) position: Vec2<S>,
    pub(crate) velocity: Vec2<S>,
    /// Speed that loads which the model does not know add in a tick.
    pub(crate) load_step: Vec2<S>,
    /// From one sample only: the velocity is not known yet.
    pub(crate) fresh: bool,
}

words_of_fields!(Motion<S> { position, velocity, load_step, fresh });

impl<S: Scalar> Motion<S> {
    /// Whether it comes inwards, or is so far inside and so slow that a quarter of the cap prevents any contact, so far beside the
    /// axis as this.
    #[inline]
    pub(crate) fn is_at_ease(&self, beside: S, coeffs: &Coeffs<S>) -> bool {
        self.position.dot(self.velocity) <= S::from_f32(INWARD)
            || (self.position.length_squared() <= S::from_f32(INSIDE * INSIDE)
                && beside <= S::from_f32(BESIDE)
                && self.velocity.length_squared() <= coeffs.ease_square)
    }
}

/// What the wall does to the rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Contact {
    None,
    /// It pushes, nobody knows when and how much.
    Impact,
    /// A rotor rests on it: it holds against all other forces.
    Resting,
}

/// From this radius on the wall may be met in the next tick, also one that is out of round or off the centre.
const WALL_IN_REACH: f32 = 0.8;
/// Samples for which a wrong reading may be believed: near the wall anything may happen.
const BELIEVED: u8 = 2;
/// A load of so many caps is no load but a missed contact.
const MOST_LOAD: f32 = 4.0;
/// Farthest and fastest motion, along each axis: what fixed point can square. Above a friction of 0.005 the cap arrests
/// no whirl that is faster, and a rotor farther out is in no bearing. The same for all numbers, so that all see the same
/// motion.
const FAR: f32 = 14.0;

/// Position times velocity of a rotor that comes inwards, rounding apart.
const INWARD: f32 = -1e-3;

/// The observer.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Observer<S> {
    motion: Motion<S>,
    unbalance: Unbalance<S>,
    bending: Bending<S>,
    started: bool,
    /// It has known a velocity before: what it knew is lost, but it is not switched on into anything.
    has_run: bool,
    /// Delivered force at the last tick.
    delivered: Vec2<S>,
    pub(crate) monitor: ActuatorMonitor<S>,
    /// Commands of the last ticks, the newest at the slot of `newest`.
    commands: [Vec2<S>; MAX_DELAY],
    newest: u8,
    /// Which of them came too late, the newest at the lowest bit, and the last that did, as it was given: it has the tick
    /// of the one after it if that is late, too.
    were_late: u8,
    late: Vec2<S>,
}

words_of_fields!(Observer<S> { motion, unbalance, bending, started, has_run, delivered, monitor, commands, newest, were_late, late });

impl<S: Scalar> Observer<S> {
    /// Carries the estimate over one tick and corrects it by the sample, if there is one. What moves, and how far the
    /// axis is beside it: in flight that is the mass centre, where it is known. `tilted`: as in [`Unbalance::counts`].
    #[inline]
    pub(crate) fn advance(
        &mut self,
        sample: Option<Vec2<S>>,
        rotation: Rotation<S>,
        wall: Contact,
        actuator: Actuator<S>,
        tilted: Option<Vec2<S>>,
        coeffs: &Coeffs<S>,
    ) -> (Motion<S>, S) {
        let mean = self.deliver(actuator, coeffs);
        let turn = Turn::new(rotation, S::ONE, coeffs);
        let turning = self.unbalance.carry(turn.as_ref());
        if let Some(position) = sample
            && !self.started
        {
            self.started = true;
            let spin = if self.has_run {
                Spin::Unknown
            } else {
                rotation.sense
            };
            self.motion = Motion::found_at(position, spin, coeffs);
            return (self.motion, S::ZERO);
        }
        if wall != Contact::None
            && let Some(turn) = &turn
        {
            self.unbalance.fade(turn);
        }
        let mut bent = self.bending.carry(&coeffs.bending);
        if wall != Contact::None {
            self.bending.fade(&coeffs.bending);
            bent = Vec2::ZERO;
        }
        let m = &mut self.motion;
        m.carry(mean, turning, wall, coeffs);
        if let Some(position) = sample {
            let error = position - m.position - bent;
            let error_speed = error * coeffs.per_tick;
            if wall == Contact::None {
                let [on_position, on_velocity, on_load] = coeffs.observer.flight_gains;
                m.position = m.position + error * on_position;
                m.velocity = m.velocity + error_speed * on_velocity;
                m.load_step = m.load_step + error_speed * on_load;
                self.bending.learn(error, &coeffs.bending);
                if let Some(turn) = &turn {
                    self.unbalance.learn(turn, m.load_step);
                }
            } else if m.fresh {
                // Switched on into a contact: the first difference is worth more than rest.
                m.position = position;
                m.velocity = m.velocity + error_speed;
            } else {
                let [on_position, on_velocity] = coeffs.observer.contact_gains;
                m.position = m.position + error * on_position;
                m.velocity = m.velocity + error_speed * on_velocity;
            }
            m.fresh = false;
            self.has_run = true;
        } else {
            // The next difference would be one over more than a tick.
            self.started &= !m.fresh;
        }
        let square = m.position.length_squared() + m.velocity.length_squared();
        let within = square <= S::from_f32(FAR * FAR);
        if !within || m.load_step.exceeds(coeffs.tick * S::from_f32(MOST_LOAD)) {
            m.hold_back(coeffs);
        }
        let mut free = *m;
        if wall == Contact::None
            && let Some(turn) = &turn
            && let Some([offset, speed]) = self.unbalance.counts(turn, turning, tilted)
        {
            free.position = free.position + offset;
            free.velocity = free.velocity + speed;
            return (free, offset.about_length());
        }
        (free, S::ZERO)
    }

    /// Takes in, before the tick that it comes in, a speed that the rest of the rotor gives evenly over it: half of the way
    /// that a tick makes of it is not gone.
    #[inline]
    pub(crate) fn push(&mut self, gained: Vec2<S>, wall: Contact, coeffs: &Coeffs<S>) {
        if wall != Contact::Resting {
            let m = &mut self.motion;
            m.velocity = m.velocity + gained;
            m.position = m.position - gained * (coeffs.tick * S::from_f32(0.5));
        }
    }

    /// Coasts over ticks that were missed: nobody commanded anything new meanwhile, and nobody measured. What the sample
    /// after them says of the velocity it says of all of them: with the gain for one tick, gaps that come again and again
    /// would make the estimate swing.
    pub(crate) fn bridge(
        &mut self,
        missed: u32,
        command: Vec2<S>,
        sample: Option<Vec2<S>>,
        rotation: Rotation<S>,
        coeffs: &Coeffs<S>,
    ) {
        for _ in 0..missed {
            self.commanded(command);
        }
        self.started &= !self.motion.fresh;
        self.bending.forget();
        let ticks = S::count(missed);
        self.unbalance
            .carry(Turn::new(rotation, ticks, coeffs).as_ref());
        let m = &mut self.motion;
        m.position = m.position + m.velocity * (coeffs.tick * ticks);
        if let Some(position) = sample {
            let [_, on_velocity, _] = coeffs.observer.flight_gains;
            let error = position - m.position - m.velocity * coeffs.tick;
            let gain = (on_velocity * coeffs.per_tick).div(ticks + S::ONE);
            m.velocity = m.velocity + error * gain;
            // So that the tick's own correction finds nothing left.
            m.position = position - m.velocity * coeffs.tick;
        }
    }

    /// Force of the tick that ends now: delivered at its end (kept), and its mean (returned).
    #[inline]
    fn deliver(&mut self, actuator: Actuator<S>, coeffs: &Coeffs<S>) -> Vec2<S> {
        let due = actuator.carried(self.due(coeffs));
        let before = self.delivered;
        let measured = actuator.applied();
        match measured {
            _ if !AXIS_MONITOR => {}
            _ if !actuator.axes.contains(SampleFlags::ON) => self.monitor.switched_off(),
            None => self.monitor.unseen(),
            Some(now) => self.monitor.watch(now, before, due, &actuator, coeffs),
        }
        if let Some(now) = measured {
            self.delivered = now;
            return now + (before - now) * coeffs.observer.applied_weight;
        }
        let (modelled, mean) = lagging(actuator.carried(before), due, coeffs);
        self.delivered = modelled;
        mean
    }

    /// The command that the actuator works on, which is as old as its delay.
    #[inline]
    fn due(&self, coeffs: &Coeffs<S>) -> Vec2<S> {
        self.command(self.newest.wrapping_sub(coeffs.delay))
    }

    #[inline]
    fn command(&self, number: u8) -> Vec2<S> {
        (self.commands.get(slot(number)).copied()).unwrap_or_default()
    }

    /// The command from before a reading went wrong, which may have been believed for some samples; nothing outwards of it, for a
    /// force that is held pushes the rotor out to the wall.
    pub(crate) fn sound_force(&self, bad: SampleFlags) -> Vec2<S> {
        let force = self.command(self.newest.wrapping_sub(BELIEVED));
        let inward = |force: S, position: S| {
            if force * position > S::ZERO {
                S::ZERO
            } else {
                force
            }
        };
        let position = self.motion.position;
        if bad.contains(SampleFlags::BOTH_BAD) {
            let outward = position.direction();
            return force - outward * force.dot(outward).max(S::ZERO);
        }
        Vec2::new(inward(force.x, position.x), inward(force.y, position.y))
    }

    /// Where the next sample is expected.
    #[inline]
    pub(crate) fn expected(&self, wall: Contact, coeffs: &Coeffs<S>) -> Expected<S> {
        let rigid = self.motion.position + self.motion.velocity * coeffs.tick;
        let free = wall == Contact::None && self.started && !self.motion.fresh;
        let position = rigid + self.bending.ahead(&coeffs.bending);
        Expected {
            position,
            sure: free && !position.exceeds(S::from_f32(WALL_IN_REACH)),
        }
    }

    /// Estimated position of the axis.
    pub(crate) fn position(&self) -> Vec2<S> {
        self.motion.position
    }

    /// Estimated velocity of the last tick; none where it was a guess from one sample.
    pub(crate) fn velocity(&self) -> Vec2<S> {
        if self.motion.fresh {
            Vec2::ZERO
        } else {
            self.motion.velocity
        }
    }

    /// The same where it is known by more than one sample.
    pub(crate) fn known_velocity(&self) -> Option<Vec2<S>> {
        (self.started && !self.motion.fresh).then_some(self.motion.velocity)
    }

    /// As in [`Unbalance::arm`].
    #[inline]
    pub(crate) fn unbalance(&self) -> Vec2<S> {
        self.unbalance.arm()
    }

    /// Force that acts.
    #[inline]
    pub(crate) fn delivered(&self) -> &Vec2<S> {
        &self.delivered
    }

    /// Speed along the normal of a wall that holds against what the model accelerates by.
    #[inline]
    pub(crate) fn blind_speed(&self, normal: Vec2<S>, coeffs: &Coeffs<S>) -> S {
        let gained = self.delivered - self.motion.position * coeffs.stiffness;
        gained.dot(normal) * coeffs.observer.blind_time
    }

    /// Starts anew at the next sample: without samples the model runs away.
    pub(crate) fn forget(&mut self) {
        self.started = false;
        self.motion = Motion::default();
        self.bending.forget();
        self.unbalance.forget();
    }

    /// Tells the observer what was commanded at this tick.
    pub(crate) fn commanded(&mut self, force: Vec2<S>) {
        self.were_late <<= 1;
        self.newest = self.newest.wrapping_add(1);
        self.replace_newest(force);
    }

    #[inline]
    fn replace_newest(&mut self, force: Vec2<S>) {
        if let Some(newest) = self.commands.get_mut(slot(self.newest)) {
            *newest = force;
        }
    }

    /// The last command came too late: the one before it had its tick, too. Of several in a row each has the tick of
    /// the next.
    pub(crate) fn late(&mut self) {
        let before = if self.were_late & 2 != 0 {
            self.late
        } else {
            self.command(self.newest.wrapping_sub(1))
        };
        self.late = self.command(self.newest);
        self.were_late |= 1;
        self.replace_newest(before);
    }

    /// After a change of the units of length, speed and force, and of the length of a tick.
    pub(crate) fn rescale(&mut self, length: S, speed: S, tick: S, force: S) {
        let m = &mut self.motion;
        m.position = m.position * length;
        m.velocity = m.velocity * speed;
        m.load_step = m.load_step * speed * tick;
        self.unbalance.rescale(speed);
        self.bending.rescale(length);
        self.delivered = self.delivered * force;
        self.late = self.late * force;
        self.monitor.rescale(force);
        for command in &mut self.commands {
            *command = *command * force;
        }
    }
}

/// Where in the ring a command is.
#[inline]
fn slot(number: u8) -> usize {
    usize::from(number) & (MAX_DELAY - 1)
}

impl<S: Scalar> Motion<S> {
    /// Motion of a rotor of which one sample is known: at rest, or, with a known spin and pressed deep into the
    /// bearing, whirling backwards at the lift-off speed. That is a guess, and costs a tick where a load presses; but a
    /// whirl near the limit grows while the force does, so that it has to lead from the first tick on. How fast
    /// matters little.
    #[cold]
    fn found_at(position: Vec2<S>, spin: Spin, coeffs: &Coeffs<S>) -> Self {
        let pressed = S::from_f32(2.0) - coeffs.touch_radius;
        let velocity = if spin != Spin::Unknown && position.exceeds(pressed) {
            position.direction().perp() * spin.sense_of_backward(S::ZERO)
        } else {
            Vec2::ZERO
        };
        Self {
            position,
            velocity,
            fresh: true,
            ..Self::default()
        }
    }

    /// A tick under the means of the force and of what turns; shaft and damping at its middle. Loads on a rotor at the
    /// wall are not known.
    #[inline]
    fn carry(&mut self, mean: Vec2<S>, turning: Vec2<S>, wall: Contact, coeffs: &Coeffs<S>) {
        let time = coeffs.tick;
        if wall == Contact::Resting {
            self.position = self.position + self.velocity * time;
            return;
        }
        let mut gained = mean * time
            - self.position * coeffs.stiffness_step
            - self.velocity * coeffs.damping_step;
        if wall == Contact::None {
            gained = gained + turning * time + self.load_step;
        }
        self.position = self.position + self.velocity * time + gained * (time * S::from_f32(0.5));
        self.velocity = self.velocity + gained;
    }

    /// Bounds what has run away, or is no number.
    #[inline]
    fn hold_back(&mut self, coeffs: &Coeffs<S>) {
        let held = |v: Vec2<S>, most: S| v.map(|x| x.within(most));
        self.position = held(self.position, S::from_f32(FAR));
        self.velocity = held(self.velocity, S::from_f32(FAR));
        self.load_step = held(self.load_step, coeffs.tick * S::from_f32(MOST_LOAD));
    }
}
