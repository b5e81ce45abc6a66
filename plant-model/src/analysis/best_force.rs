//! What any force within a cap could do for a rotor that strikes a rigid wall: dynamic programming over where it goes.
//!
//! Without stiffness the rotor flies straight but for the force. Lengths are in clearances, speeds in lift-off speeds √(F·c/m), the force
//! in caps. Where it goes is three numbers: the share of its chord that is left to the wall, and the normal and the backward speed with
//! which it would get there. An impact gives the next chord: e of the normal speed, and μ·(1 + e) of it on top of the backward one.
//! The value of a course is the least backward speed with which contact becomes continuous. A force that acts at once and knows the state
//! makes of it what no other can; whirl slower than √(√(1 + μ²)/μ) it stops.

use crate::V2;
use crate::vector::perp;
use std::f64::consts::TAU;

/// A rebound slower than this is none, and contact continuous.
const CONTINUOUS: f64 = 0.02;
/// The fastest normal and backward speeds that are looked at.
const FASTEST_NORMAL: f64 = 10.0;
const FASTEST_BACKWARD: f64 = 4.0;
/// Directions of the force that are tried, and the longest time in which it stays.
const DIRECTIONS: u32 = 24;
const LONGEST: f64 = 0.25;
/// Values that change by less have settled; they do after so many sweeps at most.
const SETTLED: f64 = 1e-4;
const MOST_SWEEPS: u32 = 400;
/// Impacts that are told apart differ by these factors, by the values and flown.
const FINE: f64 = 1.001;
const FINE_FLOWN: f64 = 1.0125;

/// Where the rotor goes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Course {
    /// Of the chord, what is left to the wall.
    share: f64,
    /// Speeds at the wall.
    normal: f64,
    backward: f64,
}

impl Course {
    fn of(position: V2, velocity: V2) -> Self {
        let square = velocity.norm_squared().max(1e-18);
        let along = position.dot(&velocity);
        let room = (1.0 - position.norm_squared()).max(0.0);
        let time = ((along * along + square * room).sqrt() - along) / square;
        let there = (position + velocity * time).normalize();
        let normal = velocity.dot(&there).max(0.0);
        let chord = 2.0 * normal / square;
        Self {
            share: if chord > 1e-12 {
                (time / chord).clamp(0.0, 1.0)
            } else {
                1.0
            },
            normal,
            backward: velocity.dot(&perp(there)),
        }
    }

    fn speed_square(self) -> f64 {
        self.normal * self.normal + self.backward * self.backward
    }

    /// Time along the whole chord.
    fn chord(self) -> f64 {
        2.0 * self.normal / self.speed_square().max(1e-18)
    }

    fn is_continuous(self) -> bool {
        self.normal < CONTINUOUS
    }

    /// Whether the cap stops it before the wall.
    fn stops(self) -> bool {
        let square = self.speed_square();
        square * square.sqrt() <= 4.0 * self.share * self.normal
    }
}

/// A wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidWall {
    /// Friction coefficient.
    pub friction: f64,
    /// Restitution of normal speeds.
    pub restitution: f64,
}

impl RigidWall {
    /// The fastest backward whirl that the cap stops \[lift-off speeds\].
    fn fastest_whirl_stopped(&self) -> f64 {
        ((1.0 + self.friction * self.friction).sqrt() / self.friction).sqrt()
    }

    fn after(&self, normal: f64, backward: f64) -> Course {
        Course {
            share: 1.0,
            normal: self.restitution * normal,
            backward: backward + self.friction * (1.0 + self.restitution) * normal,
        }
    }

    /// Where a force takes it in a time, at most over one impact; in axes of the wall that it flies to.
    fn flown(&self, from: Course, force: V2, time: f64) -> Course {
        let velocity = V2::new(from.normal, from.backward);
        let position = V2::new(1.0, 0.0) - velocity * (from.share * from.chord());
        let at = |t: f64| position + (velocity + force * (0.5 * t)) * t;
        let out = |t: f64| at(t).norm_squared() >= 1.0;
        if !out(time) {
            return Course::of(at(time), velocity + force * time);
        }
        // One that has just left the wall is on it.
        let (mut before, mut after) = (1e-9 * time, time);
        for _ in 0..40 {
            let middle = 0.5 * (before + after);
            if out(middle) {
                after = middle;
            } else {
                before = middle;
            }
        }
        let (there, then) = (at(after).normalize(), velocity + force * after);
        self.after(then.dot(&there).max(0.0), then.dot(&perp(there)))
    }
}

/// Values of all courses on one wall.
#[derive(Debug, Clone)]
pub struct BestForce {
    wall: RigidWall,
    nodes: [usize; 3],
    values: Vec<f64>,
}

impl BestForce {
    /// By so many nodes of the share of the chord, the normal and the backward speed, two of each at least.
    pub fn new(wall: RigidWall, nodes: [usize; 3]) -> Self {
        let nodes = nodes.map(|n| n.max(2));
        let [shares, normals, backwards] = nodes;
        let mut best = Self {
            wall,
            nodes,
            values: vec![FASTEST_BACKWARD; shares * normals * backwards],
        };
        for _ in 0..MOST_SWEEPS {
            if best.sweep() < SETTLED {
                break;
            }
        }
        best
    }

    /// The hardest radial impact, of a rotor that comes from the middle, after which contact becomes continuous with a whirl that the cap
    /// stops, or not at all \[lift-off speeds\].
    pub fn hardest_impact(&self) -> f64 {
        let most = self.wall.fastest_whirl_stopped();
        hardest(FINE, |speed| self.value(radial(speed)) < most)
    }

    /// The same by flying what the values advise, a new force every so many lift-off times c/√(F·c/m): what is reached for sure.
    pub fn hardest_impact_flown(&self, period: f64) -> f64 {
        hardest(FINE_FLOWN, |speed| self.recovers(radial(speed), period))
    }

    fn recovers(&self, mut now: Course, period: f64) -> bool {
        const LONGEST_FLIGHT: f64 = 60.0;
        let mut time = 0.0;
        while time < LONGEST_FLIGHT {
            if now.is_continuous() {
                return now.backward.abs() < self.wall.fastest_whirl_stopped();
            }
            if now.stops() {
                return true;
            }
            let (_, force) = self.best(now, 3 * DIRECTIONS);
            let step = period.min(0.25 * now.chord()).max(1e-5);
            now = self.wall.flown(now, force, step);
            time += step;
        }
        false
    }

    /// The largest change of a value.
    fn sweep(&mut self) -> f64 {
        let [shares, normals, backwards] = self.nodes;
        let mut largest: f64 = 0.0;
        for i in 0..shares {
            for j in 0..normals {
                for k in 0..backwards {
                    let own = (i * normals + j) * backwards + k;
                    let value = self.value_now(self.node([i, j, k]));
                    let before = self.values[own];
                    if value < before {
                        largest = largest.max(before - value);
                        self.values[own] = value;
                    }
                }
            }
        }
        largest
    }

    fn node(&self, [i, j, k]: [usize; 3]) -> Course {
        let part = |i: usize, axis: usize| i as f64 / (self.nodes[axis] - 1) as f64;
        Course {
            share: part(i, 0),
            normal: FASTEST_NORMAL * part(j, 1),
            backward: FASTEST_BACKWARD * (2.0 * part(k, 2) - 1.0),
        }
    }

    /// By the best force over the next step.
    fn value_now(&self, at: Course) -> f64 {
        if at.is_continuous() || at.stops() {
            return self.value(at);
        }
        if at.share <= 0.0 {
            return self.value(self.wall.after(at.normal, at.backward));
        }
        self.best(at, DIRECTIONS).0
    }

    /// The least value after a step, and the force that leads there.
    fn best(&self, at: Course, directions: u32) -> (f64, V2) {
        let step = 1.0 / (self.nodes[0] - 1) as f64;
        let time = (step * at.chord()).clamp(1e-4, LONGEST);
        let turned = (0..directions).map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(directions)).sin_cos();
            V2::new(cos, sin)
        });
        let mut best = (f64::INFINITY, V2::zeros());
        for force in turned.chain([V2::zeros()]) {
            let value = self.value(self.wall.flown(at, force, time));
            if value < best.0 {
                best = (value, force);
            }
        }
        best
    }

    /// Between the nodes; what is faster than they are is lost.
    fn value(&self, at: Course) -> f64 {
        if at.is_continuous() {
            return at.backward.abs().min(FASTEST_BACKWARD);
        }
        if at.stops() {
            return 0.0;
        }
        if at.backward >= FASTEST_BACKWARD || at.normal > FASTEST_NORMAL {
            return FASTEST_BACKWARD;
        }
        let places = [
            at.share,
            at.normal / FASTEST_NORMAL,
            0.5 * (at.backward / FASTEST_BACKWARD + 1.0),
        ];
        let mut below = [0; 3];
        let mut part = [0.0; 3];
        for axis in 0..3 {
            let last = self.nodes[axis] - 1;
            let place = (places[axis] * last as f64).clamp(0.0, last as f64);
            below[axis] = (place as usize).min(last - 1);
            part[axis] = place - below[axis] as f64;
        }
        let [_, normals, backwards] = self.nodes;
        let [i, j, k] = below;
        let corner = |a: usize, b: usize, c: usize| {
            self.values[((i + a) * normals + j + b) * backwards + k + c]
        };
        let between = |low: f64, high: f64, part: f64| low + (high - low) * part;
        let line = |a: usize, b: usize| between(corner(a, b, 0), corner(a, b, 1), part[2]);
        let plane = |a: usize| between(line(a, 0), line(a, 1), part[1]);
        between(plane(0), plane(1), part[0])
    }
}

/// From the middle.
fn radial(speed: f64) -> Course {
    Course {
        share: 0.5,
        normal: speed,
        backward: 0.0,
    }
}

/// The hardest of impacts that is recovered from, all softer ones being recovered from, too.
fn hardest(factor: f64, recovers: impl Fn(f64) -> bool) -> f64 {
    let mut last = 0.0;
    let mut speed = 1.0;
    while speed < FASTEST_NORMAL && recovers(speed) {
        last = speed;
        speed *= factor;
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: RigidWall = RigidWall {
        friction: 0.15,
        restitution: 0.7,
    };

    /// Without a force a course is where it was, only nearer to the wall, and an impact is the closed form.
    #[test]
    fn a_straight_flight_stays_on_its_course() {
        let from = Course {
            share: 0.9,
            normal: 2.0,
            backward: 1.3,
        };
        let later = WALL.flown(from, V2::zeros(), 0.4 * from.chord());
        assert!((later.share - 0.5).abs() < 1e-12);
        assert!((later.normal - 2.0).abs() < 1e-12 && (later.backward - 1.3).abs() < 1e-12);
        let after = WALL.flown(from, V2::zeros(), 1.1 * from.chord());
        assert_eq!(after.share, 1.0);
        assert!((after.normal - 1.4).abs() < 1e-9 && (after.backward - 1.81).abs() < 1e-9);
    }

    /// A cap stops what comes from the middle with √2 just before the wall.
    #[test]
    fn what_the_cap_stops_before_the_wall_costs_nothing() {
        let speed = 2.0_f64.sqrt();
        assert!(radial(0.999 * speed).stops() && !radial(1.001 * speed).stops());
    }

    /// What the values say is what their forces reach, grids agree, and friction makes it worse.
    #[test]
    fn values_are_reached_by_their_own_forces() {
        let [coarse, finer] = [[9, 33, 49], [13, 49, 73]].map(|n| BestForce::new(WALL, n));
        let speeds = [&coarse, &finer].map(BestForce::hardest_impact);
        assert!((speeds[0] / speeds[1] - 1.0).abs() < 0.03, "{speeds:?}");
        let flown = finer.hardest_impact_flown(0.02);
        assert!(
            (0.95..1.03).contains(&(flown / speeds[1])),
            "{flown} {speeds:?}"
        );
        // No force at all: impacts take their speed to the limit of whirl.
        let idle = WALL.fastest_whirl_stopped() * (1.0 - 0.7) / (0.15 * 1.7);
        assert!(speeds[1] > 1.5 * idle, "{speeds:?} {idle}");
        let rougher = RigidWall {
            friction: 0.25,
            ..WALL
        };
        assert!(BestForce::new(rougher, [9, 33, 49]).hardest_impact() < 0.8 * speeds[0]);
    }
}
