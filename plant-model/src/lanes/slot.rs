//! A run on its way: what follows from a step, and how it ends.

use super::group::{Constants, Event, Group, Kind, Rows};
use super::{Ended, Ending, Launch};
use crate::V2;
use crate::bisection::top_between;
use crate::free_flight::FreeFlight;
use crate::vector::{Body, perp};

/// Events in a run that are too many for it to be sound.
const MOST_EVENTS: u32 = 20_000;
/// Steps in a run that are too many for it to be worth it.
const MOST_STEPS: u64 = 200_000;
/// Steps in a row that hardly get on.
const MOST_STUCK: u32 = 40;

/// A run on its way.
#[derive(Debug, Clone)]
pub(super) struct Slot<T> {
    tag: T,
    launch: Launch,
    constants: Constants,
    kind: Kind,
    sign: f64,
    beyond: bool,
    position: V2,
    velocity: V2,
    direction: V2,
    t_s: f64,
    fastest: f64,
    /// In each mode \[s\].
    references: [f64; 4],
    impacts: u32,
    to_threshold: Option<u32>,
    events: u32,
    stuck: u32,
    /// A contact has just begun.
    fresh: bool,
    steps: u64,
}

impl<T> Slot<T> {
    pub(super) fn new(launch: Launch, tag: T) -> Self {
        let (p, start) = (&launch.params, &launch.start);
        let m = p.mass_kg;
        let (stiffness, contact_stiffness) = (p.stiffness_n_m / m, p.contact_stiffness_n_m / m);
        let spin = start.spin_rad_s;
        let unbalance = p.eccentricity_m * spin * spin;
        let constants = Constants {
            stiffness,
            natural: stiffness.sqrt(),
            damping: p.damping_n_s_m / m,
            contact_stiffness,
            contact_rate: contact_stiffness.sqrt(),
            contact_damping: p.contact_damping_n_s_m / m,
            clearance: p.clearance_m,
            friction: p.friction,
            surface: spin * p.radius_m,
            unbalance,
            // Of a balanced rotor nothing turns, also beside one that is not.
            spin: if unbalance > 0.0 { spin } else { 0.0 },
        };
        let (sin, cos) = start.spin_phase_rad.sin_cos();
        let (c, t_end) = (&constants, launch.until_s);
        let slow = c.natural + c.damping + c.spin.abs();
        let fast = c.contact_rate + c.contact_damping;
        let contact = 3.0 / (fast + slow);
        let references = [(1.0 / slow).min(t_end), contact, contact, contact];
        Self {
            kind: Kind::Flight,
            sign: 0.0,
            beyond: false,
            position: start.position_m,
            velocity: start.velocity_m_s,
            direction: V2::new(cos, sin),
            t_s: 0.0,
            fastest: 0.0,
            references,
            impacts: 0,
            to_threshold: None,
            events: 0,
            stuck: 0,
            fresh: false,
            steps: 0,
            constants,
            launch,
            tag,
        }
    }

    pub(super) fn kind(&self) -> Kind {
        self.kind
    }

    fn left_s(&self) -> f64 {
        self.launch.until_s - self.t_s
    }

    /// Puts it into a lane.
    pub(super) fn enter(&self, group: &mut Group, lane: usize) {
        group.unbalanced |= self.constants.unbalance > 0.0;
        group.watched |= self.launch.whirl_m_s.is_finite();
        group.constants.set(lane, &self.constants);
        group.position.set(lane, self.position);
        group.velocity.set(lane, self.velocity);
        group.direction.set(lane, self.direction);
        group.sign.0[lane] = self.sign;
        group.beyond[lane] = self.beyond;
        group.fastest.0[lane] = self.fastest;
        let left_s = self.left_s();
        group.reference.0[lane] = self.references[self.kind as usize].min(left_s);
        group.most.0[lane] = if self.fresh {
            left_s.min(3.3 / self.constants.contact_rate)
        } else {
            left_s
        };
    }

    /// Takes it out of its lane after a step, whose series have this order in contact: how it ended, if it did.
    pub(super) fn leave(
        &mut self,
        group: &Group,
        (rows, order): (&Rows, usize),
        lane: usize,
    ) -> Option<Ending> {
        let before_m_s = self.backward_m_s();
        let reference = &mut self.references[self.kind as usize];
        *reference = group.reference.0[lane];
        self.fastest = group.fastest.0[lane];
        self.steps += 1;
        let dt_s = group.step.0[lane];
        // Nothing that is not finite gets on.
        let moves = dt_s > 1e-9 * *reference;
        self.stuck = if moves { 0 } else { self.stuck + 1 };
        if self.stuck > MOST_STUCK || self.steps > MOST_STEPS {
            return Some(Ending::GaveUp);
        }
        if dt_s == 0.0 && group.event[lane].is_none() {
            return None;
        }
        self.position = group.position.at(lane);
        self.velocity = group.velocity.at(lane);
        self.direction = group.direction.at(lane);
        self.t_s = if dt_s >= self.left_s() {
            self.launch.until_s
        } else {
            self.t_s + dt_s
        };
        let whirled = self.kind.touches()
            && self.whirled(
                (before_m_s, group.whirl.0[lane]),
                (rows, lane),
                (order, group.theta.0[lane]),
            );
        self.follow(group.event[lane], whirled)
    }

    /// Sliding speed at the contact \[m/s\], by the tangent.
    fn sliding_m_s(&self) -> (f64, V2) {
        let tangent = perp(self.position) / self.position.norm();
        (
            self.constants.surface + tangent.dot(&self.velocity),
            tangent,
        )
    }

    /// Sign of backward whirl.
    fn backward(&self) -> f64 {
        if self.launch.start.spin_rad_s < 0.0 {
            1.0
        } else {
            -1.0
        }
    }

    /// Speed of the whirl, backward \[m/s\].
    fn backward_m_s(&self) -> f64 {
        self.backward() * self.position.perp(&self.velocity) / self.position.norm()
    }

    /// Whether it whirled in a step of contact that ended here. Between the ends it is looked for where a bound lets it be there;
    /// where the surfaces roll, the speed of both is held.
    fn whirled(
        &self,
        (before_m_s, bound_m_s): (f64, f64),
        (rows, lane): (&Rows, usize),
        (order, theta): (usize, f64),
    ) -> bool {
        let most_m_s = before_m_s.max(self.backward_m_s());
        let whirl_m_s = self.launch.whirl_m_s;
        if most_m_s >= whirl_m_s || self.kind != Kind::Slip || bound_m_s < whirl_m_s {
            return most_m_s >= whirl_m_s;
        }
        let backward = self.backward();
        let of = |at: f64| {
            let (speed, slope) = rows.whirl(lane, order, at);
            (backward * speed, backward * slope)
        };
        let point = |at: f64| {
            let (speed, slope) = of(at);
            (at, speed, slope)
        };
        let [start, middle, end] = [0.0, 0.5 * theta, theta].map(point);
        top_between(&of, start, middle).max(top_between(&of, middle, end)) >= whirl_m_s
    }

    /// Notes a speed at a touch or a lift-off.
    fn note(&mut self) {
        if self.to_threshold.is_none() && self.backward_m_s() >= self.launch.threshold_m_s {
            self.to_threshold = Some(self.impacts);
        }
    }

    /// After a step and its event: how it ended, if it did.
    fn follow(&mut self, event: Option<Event>, whirled: bool) -> Option<Ending> {
        let touched = self.kind.touches();
        self.fresh = false;
        self.beyond = false;
        if whirled {
            self.to_threshold = self.to_threshold.or(Some(self.impacts));
            return Some(Ending::Whirl);
        }
        match event {
            Some(Event::Lingers) => {
                self.kind = Kind::Beyond;
                return None;
            }
            Some(Event::Returns) => {
                self.kind = Kind::Flight;
                return None;
            }
            Some(Event::Touch) => {
                self.impacts += 1;
                let (sliding, _) = self.sliding_m_s();
                self.kind = Kind::Slip;
                self.sign = if sliding < 0.0 { -1.0 } else { 1.0 };
                self.fresh = true;
                if sliding.abs() <= 1e-12 * self.velocity.norm() {
                    return Some(Ending::GaveUp);
                }
                self.note();
            }
            Some(Event::LiftOff) => {
                self.note();
                self.kind = Kind::Flight;
                self.beyond = self.position.norm() > self.constants.clearance;
            }
            Some(Event::Stops) => {
                let (sliding, tangent) = self.sliding_m_s();
                self.velocity -= sliding * tangent;
                let (needed, available) = self.held();
                let edge = 1e-9 * available;
                if needed.abs() < available - edge {
                    self.kind = Kind::Roll;
                } else if needed.abs() > available + edge && needed * self.sign > 0.0 {
                    // Friction cannot hold it: the speed goes on through zero.
                    self.sign = -self.sign;
                } else {
                    return Some(Ending::GaveUp);
                }
            }
            Some(Event::Slips(positive)) => {
                self.kind = Kind::Slip;
                self.sign = if positive { 1.0 } else { -1.0 };
            }
            // After a touch it is not free at once: it has just been at the wall.
            None if !touched && self.launch.until_free && self.stays_free() => {
                return Some(Ending::Free);
            }
            None => {}
        }
        self.events += u32::from(event.is_some());
        if self.events > MOST_EVENTS {
            return Some(Ending::GaveUp);
        }
        (self.t_s >= self.launch.until_s).then(|| {
            if self.launch.until_free && self.kind == Kind::Flight && self.stays_free() {
                Ending::Free
            } else if self.kind.touches() && self.backward_m_s() >= self.launch.threshold_m_s {
                Ending::Whirl
            } else {
                Ending::Time
            }
        })
    }

    /// Friction that holds the sliding speed at zero, and the largest that there is, per mass \[m/s²\].
    fn held(&self) -> (f64, f64) {
        let c = &self.constants;
        let (u, w) = (self.position, self.velocity);
        let radius = u.norm();
        let normal = u / radius;
        let rate = normal.dot(&w);
        let force = c.contact_stiffness * (radius - c.clearance) + c.contact_damping * rate;
        let free = c.unbalance * self.direction - c.stiffness * u - c.damping * w;
        let tangent = perp(normal);
        let whirl = tangent.dot(&w);
        // The whirl's speed stays: its rate is t̂·a less what the normal's turning takes.
        (
            whirl * rate / radius - tangent.dot(&free),
            c.friction * force,
        )
    }

    /// Whether the rotor can never touch again.
    fn stays_free(&self) -> bool {
        let c = &self.constants;
        let flight = FreeFlight {
            stiffness: c.stiffness,
            damping: c.damping,
            spin: c.spin,
            unbalance: c.unbalance,
        };
        let now = Body {
            position: self.position,
            velocity: self.velocity,
        };
        (flight.farthest_m(&now, self.direction)).is_some_and(|farthest| farthest < c.clearance)
    }

    pub(super) fn ended(self, ending: Ending) -> (T, Ended) {
        let ended = Ended {
            ending,
            t_s: self.t_s,
            position_m: self.position,
            velocity_m_s: self.velocity,
            in_contact: self.kind.touches(),
            impacts: self.impacts,
            impacts_to_threshold: self.to_threshold,
            events: self.events,
            steps: self.steps,
        };
        (self.tag, ended)
    }
}
