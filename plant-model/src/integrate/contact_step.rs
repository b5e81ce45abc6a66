//! One step of contact: the high-order pair, its error control, and the guards of the mode.

use super::dop853::{B, Dop853, END, Rates, STEP_STAGES};
use crate::energy::Flows;
use crate::integrate::PlantError;
use crate::magnet::Amplifier;
use crate::mode::{Slide, Whirl};
use crate::part::Weights;
use crate::readout::Work;
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{Evaluation, Guards, Inputs, NORMAL, StateOf, System, Touch};

/// Points at which a step that may hold an event is searched.
const SCANS: usize = 8;

impl<Y: Copy + Default> Rates<Y> for Evaluation<Y> {
    fn rates(&self) -> &Y {
        &self.rates
    }
}

/// Result of one accepted step.
pub(crate) struct ContactStep<Y> {
    pub(crate) t_s: f64,
    pub(crate) step_s: f64,
    pub(crate) y: Y,
    pub(crate) flows: Flows,
    pub(crate) start: Touch,
    pub(crate) end: Touch,
    /// Contact normals at start and end turn by this angle \[rad\].
    pub(crate) turn: f64,
    /// Guard that ended the step.
    pub(crate) event: Option<usize>,
}

/// Step-size memory, stages and counters.
pub(crate) struct ContactStepper<S: Stator, W: Spin, M: Amplifier> {
    pair: Pair<StateOf<S, W, M>>,
    rtol: f64,
    step_s: f64,
    fastest_m_s: f64,
    pub(crate) work: Work,
}

type Mode = (Slide, Whirl);
type Pair<Y> = Dop853<Y, Evaluation<Y>>;

impl<S: Stator, W: Spin, M: Amplifier> ContactStepper<S, W, M> {
    pub(crate) fn new(system: &System<S, W, M>, rtol: f64, speed_m_s: f64) -> Self {
        Self {
            pair: Dop853::new(),
            rtol,
            step_s: 0.05 / system.contact_rate_rad_s(),
            fastest_m_s: speed_m_s,
            work: Work::default(),
        }
    }

    /// Scales of the motion: speed of the rotor, and the penetration that this speed makes.
    fn weights(&mut self, system: &System<S, W, M>, y: &StateOf<S, W, M>) -> Weights {
        let now = y.rotor.velocity.norm();
        self.fastest_m_s = self.fastest_m_s.max(now);
        let rate = system.contact_rate_rad_s();
        // A rotor that comes to rest is followed to a thousandth of its fastest motion; one that
        // never moved, to a thousandth of its weightless creep over the clearance.
        let floor = 1e-3
            * self
                .fastest_m_s
                .max(1e-3 * system.contact.clearance_m * rate);
        let speed = now.max(floor);
        let length = (speed / rate).min(system.contact.clearance_m);
        let spin = (speed / system.rotor.contact_radius_m)
            .max(system.spin.spin_rad_s(&y.spin).abs() * 1e-2);
        Weights {
            position: 1.0 / (self.rtol * length),
            velocity: 1.0 / (self.rtol * speed),
            spin: 1.0 / (self.rtol * spin),
            phase: 1.0 / self.rtol,
            force: 1.0 / (self.rtol * system.rotor.mass_kg * speed * rate),
        }
    }

    /// Steps from `t_s` towards `t_end_s` until the tolerance, the end or an event stops it.
    pub(crate) fn step(
        &mut self,
        system: &System<S, W, M>,
        (t_s, t_end_s): (f64, f64),
        y: &StateOf<S, W, M>,
        inputs: &Inputs,
        mode: Mode,
    ) -> Result<ContactStep<StateOf<S, W, M>>, PlantError> {
        let weights = self.weights(system, y);
        let mut field = |t: f64, y: &StateOf<S, W, M>| system.contact(t, y, inputs, mode);
        let first = field(t_s, y);
        self.work.evaluations += 1;
        let remaining = t_end_s - t_s;
        let mut step = self.step_s;
        let (end, last) = loop {
            // A last sliver shorter than a tenth of the step is taken along.
            let last = step * 1.1 >= remaining;
            let h = if last { remaining } else { step };
            let (end, error) = self.pair.step(t_s, y, &first, h, &weights, &mut field);
            self.work.evaluations += STEP_STAGES as u64 - 1;
            if error <= 1.0 {
                let growth = if error > 0.0 {
                    0.9 * error.powf(-0.125)
                } else {
                    5.0
                };
                // A step cut short by the end of the sample says nothing against the longer one.
                let grown = h * growth.clamp(0.3, 5.0);
                self.step_s = if last { grown.max(self.step_s) } else { grown };
                step = h;
                break (end, last);
            }
            self.work.rejected += 1;
            let shrink = if error.is_finite() {
                (0.9 * error.powf(-0.125)).clamp(0.1, 0.9)
            } else {
                0.1
            };
            step = h * shrink;
            if t_s + 1e-3 * step == t_s && step < 1e-6 / system.contact_rate_rad_s() {
                return Err(PlantError::StepTooSmall { t_s });
            }
        };
        // A step that only the sample's end kept short may not let the next one grow without bound.
        self.step_s = self.step_s.min(1.0 / system.contact_rate_rad_s() * 10.0);
        self.work.steps += 1;
        self.pair.evaluations[END] = field(t_s + step, &end);
        self.work.evaluations += 1;

        let event = match self.suspicious() {
            true => self.locate(t_s, step, &mut field),
            false => None,
        };
        let (y_end, h) = match event {
            None => (end, step),
            Some((guard, theta)) => {
                self.work.events += 1;
                self.step_onto(t_s, y, &first, theta * step, guard, &weights, &mut field)
            }
        };
        let mut flows = Flows::default();
        for &(j, b) in B {
            flows.add_scaled(h * b, &self.pair.evaluations[j].powers);
        }
        let (a, b) = (system.geometry(y).normal, system.geometry(&y_end).normal);
        Ok(ContactStep {
            t_s: if last && event.is_none() {
                t_end_s
            } else {
                t_s + h
            },
            step_s: h,
            y: y_end,
            flows,
            start: first.touch,
            end: self.pair.evaluations[END].touch,
            turn: a.perp(&b).atan2(a.dot(&b)),
            event: event.map(|(guard, _)| guard),
        })
    }

    /// Whether a guard is negative at the end, or comes near zero at any stage. The stages are rough
    /// looks at the inside of the step, and cost nothing.
    fn suspicious(&self) -> bool {
        let e = &self.pair.evaluations;
        (0..e[0].guards.len()).any(|i| {
            let (start, end) = (e[0].guards[i], e[END].guards[i]);
            let near = 0.1 * start.abs().max(end.abs());
            end < near || e[1..STEP_STAGES].iter().any(|s| s.guards[i] < near)
        })
    }

    /// First event inside the last step: the guard, and θ to the accuracy of the dense output.
    fn locate(
        &mut self,
        t_s: f64,
        step_s: f64,
        field: &mut impl FnMut(f64, &StateOf<S, W, M>) -> Evaluation<StateOf<S, W, M>>,
    ) -> Option<(usize, f64)> {
        let dense = self.pair.dense(t_s, field);
        let start = self.pair.evaluations[0].guards;
        let scale = self.guard_scales();
        let mut evaluations = 3_u64;
        let mut guards_at = |theta: f64| {
            evaluations += 1;
            field(t_s + theta * step_s, &dense.at(theta)).guards
        };
        let mut found: Option<(usize, f64)> = None;
        let (mut low, mut at_low) = (0.0, start);
        for i in 1..=SCANS {
            let high = i as f64 / SCANS as f64;
            let at_high = guards_at(high);
            for (guard, value) in at_high.iter().enumerate() {
                if *value >= -1e-13 * scale[guard] {
                    continue;
                }
                let theta = first_root(guard, (low, at_low[guard]), (high, *value), &mut guards_at);
                if found.is_none_or(|(_, earlier)| theta < earlier) {
                    found = Some((guard, theta));
                }
            }
            if found.is_some() {
                break;
            }
            (low, at_low) = (high, at_high);
        }
        self.work.evaluations += evaluations;
        found
    }

    /// Size of each guard over the last step, against which zero is judged.
    fn guard_scales(&self) -> Guards {
        let mut scale = [0.0; 5];
        for e in &self.pair.evaluations[..=END] {
            for (s, g) in scale.iter_mut().zip(&e.guards) {
                if g.is_finite() {
                    *s = g.abs().max(*s);
                }
            }
        }
        scale
    }

    /// Repeats the step with its end on the event, so that the state there has the accuracy of the
    /// pair and not of the dense output.
    #[allow(
        clippy::too_many_arguments,
        reason = "one step's whole context, used once"
    )]
    fn step_onto(
        &mut self,
        t_s: f64,
        y: &StateOf<S, W, M>,
        first: &Evaluation<StateOf<S, W, M>>,
        step_s: f64,
        guard: usize,
        weights: &Weights,
        field: &mut impl FnMut(f64, &StateOf<S, W, M>) -> Evaluation<StateOf<S, W, M>>,
    ) -> (StateOf<S, W, M>, f64) {
        let mut h = step_s;
        let mut end = *y;
        let mut earlier: Option<(f64, f64)> = None;
        for _ in 0..4 {
            end = self.pair.step(t_s, y, first, h, weights, field).0;
            self.pair.evaluations[END] = field(t_s + h, &end);
            self.work.evaluations += STEP_STAGES as u64;
            let value = self.pair.evaluations[END].guards[guard];
            // Slope of the guard: known for the normal force, by secant for the others.
            let slope = match (guard, earlier) {
                (NORMAL, _) => self.pair.evaluations[END].touch.normal_rate_n_s,
                (_, Some((h0, v0))) if h != h0 => (value - v0) / (h - h0),
                _ => (value - first.guards[guard]) / h,
            };
            let correction = value / slope;
            earlier = Some((h, value));
            if !correction.is_finite()
                || correction.abs() <= 1e-13 * h
                || correction.abs() > 0.1 * h
            {
                break;
            }
            h -= correction;
        }
        let h = earlier.map_or(h, |(taken, _)| taken);
        (end, h)
    }
}

/// First sign change of one guard in a bracket whose high end is negative. A low end at zero (the
/// guard has just been armed there) is first moved to a point at which the guard is positive; if
/// there is none the event is at the low end itself.
fn first_root(
    guard: usize,
    (mut low, mut at_low): (f64, f64),
    (mut high, mut at_high): (f64, f64),
    guards_at: &mut impl FnMut(f64) -> Guards,
) -> f64 {
    if at_low <= 0.0 {
        let start = low;
        let mut width = high - low;
        loop {
            width *= 0.25;
            if width < 1e-12 {
                return start;
            }
            let value = guards_at(start + width)[guard];
            if value > 0.0 {
                (low, at_low) = (start + width, value);
                break;
            }
            (high, at_high) = (start + width, value);
        }
    }
    // Regula falsi with the Illinois rule: brackets, and converges faster than bisection.
    let mut side = 0;
    for _ in 0..60 {
        let theta = (low * at_high - high * at_low) / (at_high - at_low);
        if !(theta > low && theta < high) || high - low < 1e-15 {
            break;
        }
        let value = guards_at(theta)[guard];
        if value > 0.0 {
            (low, at_low) = (theta, value);
            if side == 1 {
                at_high *= 0.5;
            }
            side = 1;
        } else {
            (high, at_high) = (theta, value);
            if side == -1 {
                at_low *= 0.5;
            }
            side = -1;
        }
        if value == 0.0 {
            break;
        }
    }
    high
}
