//! One step of contact: the high-order pair, its error control, and the guards of the mode.

use std::f64::consts::TAU;

use super::crossings::{first_root, guard_scales, lowest_between, suspicious};
use super::frame::Frame;
use super::pair::{Field, Origin, Pair, Rates};
use super::scales::Scales;
use crate::V2;
use crate::energy::Flows;
use crate::integrate::PlantError;
use crate::magnet::Amplifier;
use crate::mode::{Slide, Whirl};
use crate::params::SlidingFriction;
use crate::part::{Part, Weights};
use crate::plane::{Bore, Raceway};
use crate::readout::{Peaks, Work};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{Evaluation, Guards, Inputs, NORMAL, StateOf, SuppressedGuards, System};

/// Points at which a step that may hold an event is searched; those close to the ends show a dip there.
const SCANS: [f64; 10] = [
    0.015_625, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.984_375, 1.0,
];

impl<Y: Copy + Default> Rates<Y> for Evaluation<Y> {
    fn rates(&self) -> &Y {
        &self.rates
    }
    fn powers(&self) -> Flows {
        self.powers
    }
}

/// A guard that becomes negative inside a step.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    guard: usize,
    /// Where, as a share of the step, to the accuracy of the dense output.
    theta: f64,
    /// It becomes positive again before the next point of the scan.
    dip: bool,
}

/// The contact field of one mode under held inputs, counting its calls.
struct ContactField<'a, S, W, M, B, R> {
    system: &'a System<S, W, M, B, R>,
    inputs: &'a Inputs,
    mode: (Slide, Whirl),
    evaluations: u64,
    factorisations: u64,
}

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway>
    Field<StateOf<S, W, M, R>, Evaluation<StateOf<S, W, M, R>>>
    for ContactField<'_, S, W, M, B, R>
{
    fn at(&mut self, t_s: f64, y: &StateOf<S, W, M, R>) -> Evaluation<StateOf<S, W, M, R>> {
        self.evaluations += 1;
        self.system.contact(t_s, y, self.inputs, self.mode)
    }

    fn along(
        &mut self,
        t_s: f64,
        y: &StateOf<S, W, M, R>,
        dy: &StateOf<S, W, M, R>,
    ) -> StateOf<S, W, M, R> {
        (self.system).contact_tangent((t_s, y), self.inputs, self.mode, dy)
    }

    /// The contact normal turns at ω = v_w/ρ, and ω̇ = (v̇_w − ω·B)/ρ.
    fn frame(&self, y: &StateOf<S, W, M, R>, first: &Evaluation<StateOf<S, W, M, R>>) -> Frame {
        let g = self.system.geometry(y);
        let turn_rad_s = g.whirl_speed_m_s / g.distance_m;
        let apart = first.touch.whirl_acceleration - turn_rad_s * g.normal_speed_m_s;
        Frame {
            turn_rad_s,
            turn_rad_s2: apart / g.distance_m,
        }
    }

    fn factorised(&mut self) {
        self.factorisations += 1;
    }
}

/// What a step is asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Task<'a> {
    /// From, and to at most \[s\].
    pub(crate) span: (f64, f64),
    pub(crate) inputs: &'a Inputs,
    pub(crate) mode: (Slide, Whirl),
    /// Guard that is not to be asked.
    pub(crate) suppressed: SuppressedGuards,
    /// Sign of v_w in backward whirl.
    pub(crate) backward: f64,
}

/// Result of one accepted step.
pub(crate) struct ContactStep<Y> {
    pub(crate) t_s: f64,
    pub(crate) step_s: f64,
    pub(crate) y: Y,
    pub(crate) flows: Flows,
    pub(crate) peaks: Peaks,
    /// Guard of the normal force at the end, and its rate.
    pub(crate) end_normal: (f64, f64),
    /// Contact normals at start and end turn by this angle \[rad\].
    pub(crate) turn: f64,
    /// Guard that ended the step.
    pub(crate) event: Option<usize>,
}

/// A pair with its step-size memory.
pub(crate) struct ContactStepper<P> {
    pair: P,
    step_s: f64,
    /// Where the last step ended.
    end_s: f64,
    /// Inputs and mode of the last step, if the field at its end is the field that the next one starts
    /// with.
    carried: Option<(Inputs, (Slide, Whirl))>,
}

impl<P> ContactStepper<P> {
    pub(crate) fn new<Y: Part>(contact_rate_rad_s: f64) -> Self
    where
        P: Pair<Y, Evaluation<Y>>,
    {
        Self {
            pair: P::new(),
            step_s: 0.05 / contact_rate_rad_s,
            end_s: f64::NAN,
            carried: None,
        }
    }

    /// Steps towards the end of the span until the tolerance, the end or an event stops it.
    pub(crate) fn step<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        &mut self,
        system: &System<S, W, M, B, R>,
        y: &StateOf<S, W, M, R>,
        task: &Task<'_>,
        (scales, work): (&mut Scales, &mut Work),
    ) -> Result<ContactStep<StateOf<S, W, M, R>>, PlantError>
    where
        P: Pair<StateOf<S, W, M, R>, Evaluation<StateOf<S, W, M, R>>>,
    {
        let (t_s, t_end_s) = task.span;
        let weights = scales.weights(system, y);
        let mut field = ContactField {
            system,
            inputs: task.inputs,
            mode: task.mode,
            evaluations: 0,
            factorisations: 0,
        };
        let follows = t_s == self.end_s;
        let carried = follows && self.carried == Some((*task.inputs, task.mode));
        let first = match self.pair.seen().last() {
            Some(end) if carried => *end,
            _ => field.at(t_s, y),
        };
        let origin = Origin {
            t_s,
            y,
            first: &first,
        };
        self.pair.begin(&origin, &mut field);
        let round_off = system.guard_round_off(y, task.mode);
        let power = -1.0 / P::ERROR_POWER;
        let remaining = t_end_s - t_s;
        let mut step = self.step_s;
        if !follows {
            step = step.min(P::FIRST / system.contact_rate_rad_s());
        }
        // A dip of the dense output that the pair itself does not see is none: where damping makes the force of errors
        // in speed there would be many.
        let mut dips = true;
        let (y_end, h, last, event) = loop {
            // A last sliver shorter than a tenth of the step is taken along.
            let last = step * 1.1 >= remaining;
            let h = if last { remaining } else { step };
            let (end, error) = self.pair.step(&origin, h, &weights, &mut field);
            if error.is_nan() || error > 1.0 {
                work.rejected += 1;
                step = h * if error.is_finite() {
                    (0.9 * error.powf(power)).clamp(0.1, 0.9)
                } else {
                    self.pair.reach().unwrap_or(0.0).clamp(0.1, 0.5)
                };
                if t_s + step == t_s || step < 1e-9 * system.moment_s(y) {
                    return Err(PlantError::StepTooSmall { t_s });
                }
                continue;
            }
            self.pair.set_end(field.at(t_s + h, &end));
            let event = match suspicious(self.pair.seen()) {
                true => self.locate((t_s, h), (task.suppressed, &round_off), dips, &mut field),
                false => None,
            };
            let Some(Crossing { guard, theta, dip }) = event else {
                let growth = if error > 0.0 {
                    0.9 * error.powf(power)
                } else {
                    5.0
                };
                let growth = growth.min(self.pair.reach().unwrap_or(f64::INFINITY));
                // A step cut short by the end of the sample says nothing against the longer one.
                let grown =
                    (h * growth.clamp(0.3, 5.0)).min(P::LONGEST / system.contact_rate_rad_s());
                self.step_s = if last { grown.max(self.step_s) } else { grown };
                break (end, h, last, None);
            };
            let reach = (theta * h, remaining);
            let onto = self.step_onto(
                &origin,
                reach,
                (guard, round_off[guard]),
                &weights,
                &mut field,
            );
            // Almost a double root right at the start: the event is here.
            let here = || (theta * h <= system.moment_s(y)).then_some((*y, 0.0));
            match onto.or_else(here) {
                Some((y_end, taken)) => {
                    work.events += 1;
                    break (y_end, taken, false, Some(guard));
                }
                // The dense output has promised an event that the shorter step does not see.
                None if dip => (dips, step) = (false, h),
                None => step = 0.5 * theta * h,
            }
        };
        work.steps += 1;
        // A step of no length leaves the stages of the attempt before it.
        let (flows, last_touch, normal) = match self.pair.seen().last() {
            Some(end) if h > 0.0 => {
                let (touch, normal) = (end.touch, end.guards[NORMAL]);
                (self.pair.flows(&mut field), touch, normal)
            }
            _ => (Flows::default(), first.touch, first.guards[NORMAL]),
        };
        let peaks = {
            let inside = |theta, normal_n| self.sliding_n((t_s, h), (theta, normal_n), &mut field);
            Peaks::between(&[first.touch, last_touch], h, task.backward, inside)
        };
        // Each column of a Jacobian is a share of one evaluation.
        let jacobians = u64::from(field.factorisations > 0);
        work.evaluations += field.evaluations + jacobians;
        work.jacobians += jacobians;
        work.factorisations += field.factorisations;
        let (a, b) = (system.geometry(y), system.geometry(&y_end));
        self.end_s = if last { t_end_s } else { t_s + h };
        // An event and a speed held at zero move the state at the end.
        let held = task.mode.0 == Slide::Rolling || task.mode.1 == Whirl::Still;
        self.carried = (event.is_none() && !held).then_some((*task.inputs, task.mode));
        Ok(ContactStep {
            t_s: self.end_s,
            step_s: h,
            y: y_end,
            flows,
            peaks,
            end_normal: (normal, last_touch.guard_rate),
            turn: turn_rad(
                (a.normal, a.whirl_speed_m_s / a.distance_m),
                (b.normal, b.whirl_speed_m_s / b.distance_m),
                h,
            ),
            event,
        })
    }

    /// Sliding force at a place inside the last step at which the normal force is `normal_n` \[N\]. A slip follows the
    /// normal force; what rolling needs the field says there, within the cone.
    fn sliding_n<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        &mut self,
        (t_s, step_s): (f64, f64),
        (theta, normal_n): (f64, f64),
        field: &mut ContactField<'_, S, W, M, B, R>,
    ) -> f64
    where
        P: Pair<StateOf<S, W, M, R>, Evaluation<StateOf<S, W, M, R>>>,
    {
        let sliding = &field.system.plane.friction.sliding;
        let (slide, _) = field.mode;
        if let (SlidingFriction::Constant { coefficient }, true) =
            (sliding, slide != Slide::Rolling)
        {
            return coefficient * normal_n;
        }
        let dense = self.pair.dense(field);
        let y = P::dense_at(&dense, theta);
        match slide {
            Slide::Rolling => {
                let needed = field.at(t_s + theta * step_s, &y).touch.sliding_n.abs();
                needed.min(sliding.coefficient(0.0) * normal_n)
            }
            _ => {
                let along = slide.sign() * field.system.geometry(&y).sliding_speed_m_s;
                sliding.coefficient(along.max(0.0)) * normal_n
            }
        }
    }

    /// First event inside the last step. `dips`: also those that are over before the next point of the scan.
    fn locate<Y: Part>(
        &mut self,
        (t_s, step_s): (f64, f64),
        (suppressed, round_off): (SuppressedGuards, &Guards),
        dips: bool,
        field: &mut impl Field<Y, Evaluation<Y>>,
    ) -> Option<Crossing>
    where
        P: Pair<Y, Evaluation<Y>>,
    {
        let dense = self.pair.dense(field);
        let start = self.pair.seen().first()?.guards;
        let scale = guard_scales(self.pair.seen());
        let mut guards_at = |theta: f64| {
            field
                .at(t_s + theta * step_s, &P::dense_at(&dense, theta))
                .guards
        };
        // A force that has just jumped may have left the cone, whichever way it moves now.
        // A normal force that rises from zero has not: the touch was found to round-off only.
        let rising = self.pair.seen().first()?.touch.guard_rate > 0.0;
        let jumped = |(guard, g): (usize, &f64)| {
            *g < -1e-12 * scale[guard] - round_off[guard]
                && !suppressed.has(guard)
                && !(guard == NORMAL && rising)
        };
        if let Some(guard) = start.iter().enumerate().position(jumped) {
            return Some(Crossing {
                guard,
                theta: 0.0,
                dip: false,
            });
        }
        let negative = |guard: usize, value: f64| {
            // No number is no positive one: the step is to be shortened.
            let positive = value >= -1e-13 * scale[guard] - round_off[guard];
            !positive && !suppressed.has(guard)
        };
        let mut found: Option<Crossing> = None;
        let (mut before, mut at_before) = (0.0, start);
        let (mut low, mut at_low) = (0.0, start);
        for high in SCANS {
            let at_high = guards_at(high);
            for (guard, value) in at_high.iter().enumerate() {
                let three = [
                    (before, at_before[guard]),
                    (low, at_low[guard]),
                    (high, *value),
                ];
                let end = if negative(guard, *value) {
                    (high, *value)
                } else if dips
                    && let Some(lowest) = lowest_between(guard, three, &mut guards_at)
                    && negative(guard, lowest.1)
                {
                    lowest
                } else {
                    continue;
                };
                let [first, middle, _] = three;
                let begin = if end.0 > middle.0 { middle } else { first };
                let theta = first_root(guard, begin, end, &mut guards_at);
                if found.is_none_or(|earlier| theta < earlier.theta) {
                    let dip = end.0 < high;
                    found = Some(Crossing { guard, theta, dip });
                }
            }
            if found.is_some() {
                break;
            }
            ((before, at_before), (low, at_low)) = ((low, at_low), (high, at_high));
        }
        found
    }

    /// Repeats the step with its end on the event, so that the state there has the accuracy of the
    /// pair and not of the dense output. `None` where the shorter step misses the tolerance or does
    /// not meet the event.
    fn step_onto<Y: Part>(
        &mut self,
        origin: &Origin<'_, Y, Evaluation<Y>>,
        (step_s, longest_s): (f64, f64),
        (guard, round_off): (usize, f64),
        weights: &Weights,
        field: &mut impl Field<Y, Evaluation<Y>>,
    ) -> Option<(Y, f64)>
    where
        P: Pair<Y, Evaluation<Y>>,
    {
        if step_s == 0.0 {
            return Some((*origin.y, 0.0));
        }
        let scale = guard_scales(self.pair.seen())[guard];
        let mut h = step_s;
        let mut before = (0.0, origin.first.guards[guard]);
        for _ in 0..6 {
            let (end, error) = self.pair.step(origin, h, weights, field);
            let at_end = field.at(origin.t_s + h, &end);
            self.pair.set_end(at_end);
            if error.is_nan() || error > 1.0 {
                return None;
            }
            let value = at_end.guards[guard];
            // Slope of the guard: known for the normal force, by secant for the others.
            let slope = match guard {
                NORMAL => at_end.touch.guard_rate,
                _ => (value - before.1) / (h - before.0),
            };
            let correction = value / slope;
            if value.abs() <= 1e-12 * scale + round_off || correction.abs() <= 1e-12 * h {
                return Some((end, h));
            }
            if !correction.is_finite() || correction.abs() > 0.1 * h {
                return None;
            }
            before = (h, value);
            h = (h - correction).min(longest_s);
        }
        None
    }
}

/// Angle by which a direction turns over a step \[rad\], from direction and rate \[rad/s\] at both ends:
/// whole turns by the mean rate, since a step may take several.
pub(crate) fn turn_rad((a, rate_a): (V2, f64), (b, rate_b): (V2, f64), step_s: f64) -> f64 {
    let part = a.perp(&b).atan2(a.dot(&b));
    let turns = (0.5 * (rate_a + rate_b) * step_s - part) / TAU;
    part + TAU * turns.round()
}
