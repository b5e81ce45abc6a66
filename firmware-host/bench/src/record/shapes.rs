//! How the two planes of a rotor moved beside each other: together, as in a cylindrical whirl, or opposed, as in a conical one.

use super::file::PlaneRecord;
use super::ticks::Ticks;
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use supervisor::Mode;

/// Motion of one shape.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Shape {
    /// Root mean square of the distance from the middle, of both axes together \[m\].
    pub rms_m: f64,
    /// Mean rate at which it went round, positive counter-clockwise \[Hz\]: that of the angle between neighbouring ticks, weighted by
    /// the square of the distance.
    pub whirl_hz: f64,
}

/// Motion of a rotor in two planes while the supervisor saw one of them bounce or whirl.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Shapes {
    /// Pairs of neighbouring ticks that it is found from.
    pub pairs: usize,
    /// Half the sum of both planes' positions.
    pub together: Shape,
    /// Half their difference, the first plane's less the second's.
    pub opposed: Shape,
}

/// What is summed up of a shape.
#[derive(Default)]
struct Sums {
    square: f64,
    cross: f64,
    dot: f64,
}

impl Sums {
    fn add(&mut self, [from, to]: [[f64; 2]; 2]) {
        self.square += to[0].powi(2) + to[1].powi(2);
        self.cross += from[0] * to[1] - from[1] * to[0];
        self.dot += from[0] * to[0] + from[1] * to[1];
    }

    fn shape(&self, pairs: usize, rate_hz: f64) -> Shape {
        Shape {
            rms_m: (self.square / pairs as f64).sqrt(),
            whirl_hz: self.cross.atan2(self.dot) * rate_hz / TAU,
        }
    }
}

impl Shapes {
    /// Of an event with the records of two planes, whose configurations are whole; `None` where no two neighbouring ticks of a bounce
    /// or whirl are recorded of both, with readings that were believed.
    pub fn of(records: &[&PlaneRecord]) -> Option<Self> {
        let [first, second] = records else {
            return None;
        };
        let rate_hz = first.units().sample_rate_hz?;
        let [first, second] = [first, second].map(|record| {
            let ticks = Ticks::of(record).ticks;
            let at = ticks.into_iter().map(|tick| (tick.sequence, tick));
            at.collect::<BTreeMap<u32, _>>()
        });
        let whirls = |mode| [Mode::Bounce.name(), Mode::BackwardWhirl.name()].contains(&mode);
        let positions_m = |sequence: u32| {
            let (a, b) = (first.get(&sequence)?, second.get(&sequence)?);
            let [p, q] = [a.position_m?, b.position_m?];
            let seen = a.believed && b.believed && (whirls(a.mode) || whirls(b.mode));
            seen.then_some((p, q))
        };
        let (mut together, mut opposed, mut pairs) = (Sums::default(), Sums::default(), 0);
        for sequence in first.keys() {
            let next = positions_m(sequence.wrapping_add(1));
            let Some((before, after)) = positions_m(*sequence).zip(next) else {
                continue;
            };
            let half = |sign: f64| {
                [before, after].map(|(p, q)| [0, 1].map(|axis| 0.5 * (p[axis] + sign * q[axis])))
            };
            together.add(half(1.0));
            opposed.add(half(-1.0));
            pairs += 1;
        }
        (pairs > 0).then(|| Self {
            pairs,
            together: together.shape(pairs, rate_hz),
            opposed: opposed.shape(pairs, rate_hz),
        })
    }
}
