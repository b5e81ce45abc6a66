//! A second way through a step of a machine, to hold the series against: collocation in Gauss's eight points.
//!
//! Accelerations are a polynomial of degree 7 in θ = time / step that meets the equations of motion at the points, found by
//! iteration, with the walls' forces at all points [together](walls); speeds and positions are its integrals. Nothing here knows a recurrence: forces are those of an instant, held
//! speeds are held there, and what laws say may be anything smooth, as friction that falls with speed. How well the polynomial meets
//! the equations where it does not have to, at the end of the step, says how good it is.
//!
//! The result is put where the series puts its own, so events, energies and readings are those of [`super::step`].

mod equations;
mod tables;
mod walls;

use self::tables::Tables;
use super::holding::Holding;
use super::plane_series::Grip;
use super::poles::MagnetLaw;
use super::rows::{AnyRows, of_rows};
use super::series::{MachineSeries, Step};
use super::system::{MachineState, MachineSystem};
use crate::V2;
use crate::mode::Phase;
use crate::series::{INVERSE, Scalar, Series};

/// Points of collocation.
const GAUSS: usize = 8;
/// With both ends.
const POINTS: usize = GAUSS + 2;
/// Degree of positions, and of what is read off at the points.
const DEGREE: usize = POINTS - 1;
/// That of the guard of a clearance, their square: what is written is a polynomial and not the beginning of a series.
const ORDER: usize = 2 * DEGREE;
const END: usize = POINTS - 1;

/// Powers of the error by which it falls with the step.
pub(crate) const ERROR_POWER: f64 = (GAUSS + 1) as f64;

/// What a value carried to the end of a step from inside has of rounding: units in the last place times the sizes of the weights.
const ROUNDING: f64 = 500.0 * f64::EPSILON;

/// Iterations at most, each of which gains some digit.
const ITERATIONS: usize = 40;

/// What an instant says of a plane that is touched.
#[derive(Debug, Clone, Copy, Default)]
struct Touch {
    distance_m: f64,
    normal_m_s: f64,
    force_n: f64,
    /// What is positive while contact lasts.
    normal_guard: f64,
    penetration_m: f64,
    whirl_m_s: f64,
    slip_m_s: f64,
    sliding_n: f64,
    rolling_n: f64,
    normal: V2,
    /// Of the contact law.
    by_depth_n_m: f64,
    by_rate_n_s_m: f64,
    /// Friction over the normal force, where it is in proportion to it.
    sliding_share: f64,
    rolling_share: f64,
}

/// An instant: state, its rates, and what the planes say.
#[derive(Debug, Clone)]
struct Instant {
    y: MachineState,
    acceleration: Vec<V2>,
    spin_rate: f64,
    race_rates: Vec<f64>,
    magnet_rates: Vec<V2>,
    slope_rates: Vec<V2>,
    /// Their forces.
    magnets_n: Vec<V2>,
    unbalance: V2,
    touches: Vec<Touch>,
}

/// Rates of what is not a coordinate.
#[derive(Debug, Clone)]
struct Others {
    spin: f64,
    magnets: Vec<V2>,
    races: Vec<f64>,
}

/// Scales against which errors of speed, spin and magnets are weighed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    pub(crate) velocity: f64,
    pub(crate) spin: f64,
    pub(crate) force: f64,
    /// Of distances in planes, and of speeds there.
    pub(crate) gap: f64,
    pub(crate) speed: f64,
    /// Weighed errors below this are rounding.
    pub(crate) rounding: f64,
}

/// The method, with room for a step.
#[derive(Debug, Clone)]
pub(crate) struct Collocation {
    tables: Tables,
    instants: Vec<Instant>,
    holding: Holding,
    /// Accelerations at the points that an iteration started from, and the other rates there.
    before: Vec<Vec<V2>>,
    others_before: Vec<Others>,
    /// How often the equations have been evaluated, and the walls' matrix factorised.
    pub(crate) evaluations: u64,
    pub(crate) factorisations: u64,
}

impl Collocation {
    pub(crate) fn new(system: &MachineSystem) -> Self {
        let (pairs, planes, magnets) = (
            system.body.pairs,
            system.planes.len(),
            system.body.magnets.len(),
        );
        let instant = Instant {
            y: MachineState::default(),
            acceleration: vec![V2::zeros(); pairs],
            spin_rate: 0.0,
            race_rates: vec![0.0; planes],
            magnet_rates: vec![V2::zeros(); magnets],
            slope_rates: vec![V2::zeros(); magnets],
            magnets_n: vec![V2::zeros(); magnets],
            unbalance: V2::zeros(),
            touches: vec![Touch::default(); planes],
        };
        Self {
            tables: Tables::new(),
            instants: vec![instant; POINTS],
            holding: Holding::new(pairs),
            before: vec![vec![V2::zeros(); pairs]; POINTS],
            others_before: vec![
                Others {
                    spin: 0.0,
                    magnets: vec![V2::zeros(); magnets],
                    races: vec![0.0; planes],
                };
                POINTS
            ],
            evaluations: 0,
            factorisations: 0,
        }
    }

    /// Goes through a step; its error in units of the scales, or infinity where the iteration does not settle.
    pub(crate) fn solve(&mut self, step: &Step<'_>, y: &MachineState, scales: &Scales) -> f64 {
        for instant in &mut self.instants {
            instant.y.clone_from(y);
        }
        self.evaluate(step, 0);
        let (first, rest) = self.instants.split_at_mut(1);
        for instant in rest {
            instant.take_rates(&first[0]);
        }
        let mut last = f64::INFINITY;
        let mut settled = false;
        for iteration in 0..ITERATIONS {
            for i in 1..END {
                self.place(step, y, i);
            }
            for i in 1..END {
                self.renew(step, i);
            }
            self.answer(step);
            let change = (1..END)
                .map(|i| self.change(step, i, scales))
                .fold(0.0, f64::max);
            settled = change <= scales.rounding.max(1e-2);
            if settled || (iteration > 3 && change > 0.5 * last) {
                break;
            }
            last = change;
        }
        self.place(step, y, END);
        self.evaluate(step, END);
        // Comparisons do not see what is no number.
        if !settled || !self.instants.iter().all(Instant::is_finite) {
            return f64::INFINITY;
        }
        let error = (self.defect(step, scales, 0))
            .max(self.defect(step, scales, END))
            .max(self.misread(step, scales));
        if error.is_nan() { f64::INFINITY } else { error }
    }

    /// Puts the state of a point: the start, and the integrals of the rates.
    fn place(&mut self, step: &Step<'_>, start: &MachineState, i: usize) {
        let h = step.step_s;
        let (once, twice) = (&self.tables.once[i], &self.tables.twice[i]);
        let t_s = h * self.tables.theta[i];
        // The state is taken out while the rates of all points are read.
        let mut y = std::mem::take(&mut self.instants[i].y);
        y.clone_from(start);
        for (q, v) in y.position.iter_mut().zip(&start.velocity) {
            *q += t_s * v;
        }
        y.phase_rad += t_s * start.spin_rad_s;
        for (j, instant) in self.instants[1..END].iter().enumerate() {
            let (b, bb) = (h * once[j], h * h * twice[j]);
            for (v, a) in y.velocity.iter_mut().zip(&instant.acceleration) {
                *v += b * a;
            }
            for (q, a) in y.position.iter_mut().zip(&instant.acceleration) {
                *q += bb * a;
            }
            y.spin_rad_s += b * instant.spin_rate;
            y.phase_rad += bb * instant.spin_rate;
            for (spin, rate) in y.races_rad_s.iter_mut().zip(&instant.race_rates) {
                *spin += b * rate;
            }
            for (force, rate) in y.magnets.iter_mut().zip(&instant.magnet_rates) {
                *force += b * rate;
            }
            for (slope, rate) in y.magnet_slopes.iter_mut().zip(&instant.slope_rates) {
                *slope += b * rate;
            }
        }
        self.instants[i].y = y;
    }

    /// Evaluates a point again, and keeps what was there.
    fn renew(&mut self, step: &Step<'_>, i: usize) {
        let (instant, others) = (&self.instants[i], &mut self.others_before[i]);
        self.before[i].copy_from_slice(&instant.acceleration);
        others.spin = instant.spin_rate;
        others.magnets.copy_from_slice(&instant.magnet_rates);
        others.races.copy_from_slice(&instant.race_rates);
        self.evaluate(step, i);
    }

    /// By how much the rates of a point have changed, in units of the scales.
    fn change(&self, step: &Step<'_>, i: usize, scales: &Scales) -> f64 {
        let (now, others) = (&self.instants[i], &self.others_before[i]);
        let off = now.acceleration.iter().zip(&self.before[i]);
        let moved: f64 = off.map(|(a, b)| (a - b).norm_squared()).sum();
        let magnets = now.magnet_rates.iter().zip(&others.magnets);
        let magnet = (magnets.zip(&step.system.magnets))
            .map(|((a, b), law)| law.per_state_n() * (a - b).norm())
            .fold(0.0, f64::max);
        let races = now.race_rates.iter().zip(&others.races);
        let race = (races.zip(&step.system.planes))
            .map(|((a, b), data)| data.race_radius_m() * (a - b).abs())
            .fold(0.0, f64::max);
        step.step_s
            * (moved.sqrt() * scales.velocity)
                .max((now.spin_rate - others.spin).abs() * scales.spin)
                .max(magnet * scales.force)
                .max(race * scales.speed)
    }

    /// How far the rates at an end are from the polynomial through those between, in units of the scales.
    fn defect(&self, step: &Step<'_>, scales: &Scales, end: usize) -> f64 {
        let (end, weights) = (&self.instants[end], &self.tables.at_ends[end.min(1)]);
        let inner = || self.instants[1..END].iter().zip(weights);
        let mut square = 0.0;
        for (c, a) in end.acceleration.iter().enumerate() {
            let through = inner().fold(V2::zeros(), |sum, (at, w)| sum + *w * at.acceleration[c]);
            square += (a - through).norm_squared();
        }
        let spin: f64 = inner().map(|(at, w)| w * at.spin_rate).sum();
        let mut magnets = 0.0;
        for (m, rate) in end.magnet_rates.iter().enumerate() {
            let law = &step.system.magnets[m];
            let through = inner().fold(V2::zeros(), |sum, (at, w)| sum + *w * at.magnet_rates[m]);
            magnets += (law.per_state_n() * (rate - through)).norm_squared();
            let through = inner().fold(V2::zeros(), |sum, (at, w)| sum + *w * at.slope_rates[m]);
            magnets += (law.per_slope_s() * (end.slope_rates[m] - through)).norm_squared();
        }
        // A distance is known to a few units in its last place, and walls are stiff.
        let (mut noise, mut races) = (0.0_f64, 0.0_f64);
        for (p, data) in step.system.planes.iter().enumerate() {
            let rounding_n = ROUNDING * end.touches[p].distance_m * data.stiffness_n_m;
            noise = noise.max(rounding_n * step.system.contact(p).mobility().sqrt());
            if let Some(race) = &data.race {
                let through: f64 = inner().map(|(at, w)| w * at.race_rates[p]).sum();
                let off = race.radius_m * (end.race_rates[p] - through).abs();
                // Friction passes the force's rounding on.
                races = races.max(off - data.sliding.max(1.0) * rounding_n * race.mobility());
            }
        }
        step.step_s
            * ((square.sqrt() - noise).max(0.0) * scales.velocity)
                .hypot((end.spin_rate - spin) * scales.spin)
                .hypot(races.max(0.0) * scales.speed)
                .hypot(magnets.sqrt() * scales.force)
    }

    /// The same of what guards are made of in planes that touch.
    fn misread(&self, step: &Step<'_>, scales: &Scales) -> f64 {
        let mut worst: f64 = 0.0;
        for (p, phase) in step.phases.iter().enumerate() {
            if *phase == Phase::Inside {
                continue;
            }
            let end = &self.instants[END].touches[p];
            let off = |size: f64, value: &dyn Fn(&Touch) -> f64| {
                let before = self.instants[..END].iter().zip(&self.tables.from_start);
                let through: f64 = before.map(|(at, w)| w * value(&at.touches[p])).sum();
                ((value(end) - through).abs() - ROUNDING * size).max(0.0)
            };
            let stiffness_n_m = step.system.planes[p].stiffness_n_m;
            let grip_n = stiffness_n_m * end.distance_m;
            // What the contact makes of errors of distance and of speed that are within the tolerance.
            let per_n = 1.0 / (stiffness_n_m / scales.gap + end.by_rate_n_s_m / scales.speed);
            worst = (worst.max(off(grip_n, &|t| t.force_n) * per_n))
                .max(off(grip_n, &|t| t.sliding_n) * per_n)
                .max(off(grip_n, &|t| t.rolling_n) * per_n)
                .max(off(end.distance_m, &|t| t.penetration_m) * scales.gap)
                .max(off(end.whirl_m_s.abs(), &|t| t.whirl_m_s) * scales.speed);
        }
        worst
    }

    /// Puts the solution where the series has its own.
    pub(crate) fn write(&self, step: &Step<'_>, y: &MachineState, out: &mut MachineSeries) {
        let (system, h) = (step.system, step.step_s);
        let MachineSeries { rows, parts } = out;
        (parts.step_s, parts.order) = (h, ORDER);
        let mut velocity = y.velocity.clone();
        of_rows!(&mut *rows, rows => rows.set(0, &y.position, &velocity));
        for k in 0..ORDER {
            velocity.fill(V2::zeros());
            if k < GAUSS {
                for (instant, c) in self.instants[1..END].iter().zip(&self.tables.inner[k]) {
                    let c = h * c * INVERSE[k + 1];
                    for (v, a) in velocity.iter_mut().zip(&instant.acceleration) {
                        *v += c * a;
                    }
                }
            }
            of_rows!(&mut *rows, rows => rows.set(k + 1, &[], &velocity));
        }
        of_rows!(&mut *rows, rows => rows.integrate(ORDER, h));
        self.integrals(&mut parts.spin, y.spin_rad_s, h, |at| at.spin_rate);
        for (m, law) in system.magnets.iter().enumerate() {
            for axis in [0, 1] {
                let mut one = Scalar::default();
                let rate = |at: &Instant| at.magnet_rates[m][axis];
                self.integrals(&mut one, y.magnets[m][axis], h, rate);
                match law {
                    MagnetLaw::Held => {}
                    MagnetLaw::Lag(_) => set_axis(&mut parts.magnets[m], axis, &one),
                    MagnetLaw::SecondOrder(..) => {
                        set_axis(&mut parts.magnets[m], axis, &one);
                        let rate = |at: &Instant| at.slope_rates[m][axis];
                        self.integrals(&mut one, y.magnet_slopes[m][axis], h, rate);
                        set_axis(&mut parts.currents[m], axis, &one);
                    }
                    MagnetLaw::Poles(_) => {
                        set_axis(&mut parts.currents[m], axis, &one);
                        self.through(&mut one, |at| at.magnets_n[m][axis]);
                        set_axis(&mut parts.magnets[m], axis, &one);
                    }
                }
            }
        }
        if system.body.unbalance.is_some() {
            parts.unbalance.0[..=ORDER].fill(V2::zeros());
            for (k, row) in self.tables.all.iter().enumerate() {
                let all = self.instants.iter().zip(row);
                parts.unbalance.0[k] =
                    all.fold(V2::zeros(), |sum, (at, c)| sum + *c * at.unbalance);
            }
        }
        for (p, plane) in parts.planes.iter_mut().enumerate() {
            of_rows!(&*rows, rows => for k in 0..=ORDER {
                plane.gap.0[k] = rows.gap(p, k);
            });
            plane.gap.0[0] -= system.planes[p].centre_m;
            self.integrals(&mut plane.race, y.races_rad_s[p], h, |at| at.race_rates[p]);
            if step.phases[p] == Phase::Inside {
                continue;
            }
            of_rows!(&*rows, rows => for k in 0..=ORDER {
                plane.gap_rate.0[k] = rows.gap_rate(p, k);
            });
            let per_m = |at: &Instant| 1.0 / at.touches[p].distance_m;
            if system.planes[p].bore.is_some() {
                // From the centre of curvature, which moves.
                for axis in [0, 1] {
                    let mut one = Scalar::default();
                    self.through(&mut one, |at| {
                        at.touches[p].distance_m * at.touches[p].normal[axis]
                    });
                    set_axis(&mut plane.gap, axis, &one);
                }
                self.through(&mut plane.depth, |at| at.touches[p].penetration_m);
            }
            plane.grip = Grip::none(system, p);
            self.through(&mut plane.distance, |at| at.touches[p].distance_m);
            self.through(&mut plane.force, |at| at.touches[p].force_n);
            self.through(&mut plane.normal_guard, |at| at.touches[p].normal_guard);
            self.through(&mut plane.normal_n_m, |at| {
                per_m(at) * at.touches[p].force_n
            });
            self.through(&mut plane.sliding_n_m, |at| {
                per_m(at) * at.touches[p].sliding_n
            });
            self.through(&mut plane.rolling_n_m, |at| {
                per_m(at) * at.touches[p].rolling_n
            });
            self.through(&mut plane.sliding_n, |at| at.touches[p].sliding_n);
            self.through(&mut plane.rolling_n, |at| at.touches[p].rolling_n);
        }
    }

    /// The polynomial that starts at a value and has these rates.
    fn integrals(&self, out: &mut Scalar, start: f64, h: f64, rate: impl Fn(&Instant) -> f64) {
        out.0[..=ORDER].fill(0.0);
        out.0[0] = start;
        for (k, row) in self.tables.inner.iter().enumerate() {
            let rates = self.instants[1..END].iter().zip(row);
            out.0[k + 1] = h * INVERSE[k + 1] * rates.map(|(at, c)| c * rate(at)).sum::<f64>();
        }
    }

    /// The polynomial through values at all points.
    fn through(&self, out: &mut Scalar, value: impl Fn(&Instant) -> f64) {
        out.0[..=ORDER].fill(0.0);
        for (c, row) in out.0.iter_mut().zip(&self.tables.all) {
            let values = self.instants.iter().zip(row);
            *c = values.map(|(at, c)| c * value(at)).sum();
        }
        // A guard that starts at zero is to do so to the last bit.
        out.0[0] = value(&self.instants[0]);
    }
}

fn set_axis(out: &mut Series, axis: usize, one: &Scalar) {
    for (c, x) in out.0[..=ORDER].iter_mut().zip(one.0) {
        c[axis] = x;
    }
}

impl Instant {
    fn is_finite(&self) -> bool {
        let magnets = self.magnet_rates.iter().chain(&self.slope_rates);
        let magnets = magnets.flat_map(|rate| [rate.x, rate.y]);
        let rates = (self.acceleration.iter().flatten().copied())
            .chain(self.race_rates.iter().copied())
            .chain(magnets);
        self.spin_rate.is_finite() && rates.into_iter().all(f64::is_finite)
    }

    fn take_rates(&mut self, of: &Self) {
        self.acceleration.copy_from_slice(&of.acceleration);
        self.race_rates.copy_from_slice(&of.race_rates);
        self.magnet_rates.copy_from_slice(&of.magnet_rates);
        self.slope_rates.copy_from_slice(&of.slope_rates);
        self.spin_rate = of.spin_rate;
    }
}
