//! One step of contact by power series: as far as the series can be trusted, or to the first event.

use super::contact_series::ContactSeries;
use super::contact_step::{ContactStep, Task};
use super::scales::Scales;
use crate::integrate::PlantError;
use crate::magnet::Amplifier;
use crate::params::LinearContact;
use crate::plane::{Bore, Raceway};
use crate::readout::Work;
use crate::series::{MAX_ORDER, Scalar};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{GUARDS, NORMAL, StateOf, System};

/// Steps contact by series; remembers the last step as the next one's reference.
pub(crate) struct SeriesStepper<S: Stator> {
    series: ContactSeries<S>,
    /// Guard that is being searched.
    guard: Scalar,
    /// The largest order that pays.
    highest_order: usize,
    step_s: f64,
}

impl<S: Stator> SeriesStepper<S> {
    pub(crate) fn new(rtol: f64, contact_rate_rad_s: f64, law: LinearContact) -> Self {
        // Measured on bouncing into rolling: between these orders the time to a given error is flat,
        // below and above it rises.
        let highest_order = match rtol {
            r if r > 1e-7 => 16,
            r if r > 1e-11 => 20,
            _ => MAX_ORDER,
        };
        Self {
            series: ContactSeries::new(law),
            guard: Scalar::default(),
            highest_order,
            step_s: 1.0 / contact_rate_rad_s,
        }
    }

    /// Steps towards the end of the span until the series, the end or an event stops it.
    pub(crate) fn step<W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        &mut self,
        system: &System<S, W, M, B, R>,
        y: &StateOf<S, W, M, R>,
        task: &Task<'_>,
        (scales, work): (&mut Scales, &mut Work),
    ) -> Result<ContactStep<StateOf<S, W, M, R>>, PlantError> {
        let (t_s, t_end_s) = task.span;
        let weights = scales.weights(system, y);
        let remaining = t_end_s - t_s;
        let highest = self.highest_order;
        let square = |series: &ContactSeries<S>, k: usize| series.square::<R>(k, &weights);
        let mut reference = self.step_s.min(remaining);
        work.steps += 1;
        let (order, trusted) = loop {
            let mut enough = Enough::new(remaining / reference);
            let (start, span) = ((t_s, y), (reference, highest));
            system.contact_series(&mut self.series, start, task, span, |series, k| {
                k >= LOWEST_ORDER - 1 && enough.with(square(series, k))
            });
            let order = self.series.order;
            work.evaluations += order as u64 + 1;
            if order < highest {
                self.step_s = self.step_s.max(remaining);
                break (order, f64::INFINITY);
            }
            // The two highest coefficients say how far the rest can be left out. Where the reference was
            // far too long they have lost their digits, or overflowed.
            let reach = |k: usize| square(&self.series, k).powf(-0.5 / k as f64);
            let (a, b) = (reach(order), reach(order - 1));
            let trusted = 0.9 * if a < b || a.is_nan() { a } else { b };
            if trusted > 1e-2 {
                self.step_s = (trusted * reference).min(1e3 * reference);
                break (order, trusted);
            }
            reference *= if trusted > 1e-6 { trusted } else { 1e-6 };
            if t_s + reference == t_s {
                return Err(PlantError::StepTooSmall { t_s });
            }
        };
        let last = trusted * reference >= remaining;
        let mut theta = if last { remaining / reference } else { trusted };
        if !(theta > 0.0 && t_s + theta * reference > t_s) {
            return Err(PlantError::StepTooSmall { t_s });
        }

        let (mut event, mut whole) = (None, last);
        for i in 0..GUARDS {
            let guard = &mut self.guard;
            if task.suppressed.has(i) || !self.series.guard(guard, system, task.mode, i) {
                continue;
            }
            let (stop, by) = match first_fall(guard, theta, order, i == NORMAL) {
                Fall::Never => continue,
                Fall::At(stop) => (stop, Some(i)),
                Fall::ClearUntil(stop) => (stop, None),
            };
            if stop < theta || (stop == theta && by.is_some()) {
                (theta, event, whole) = (stop, by, false);
            }
        }
        work.events += u64::from(event.is_some());
        let end = self.series.at::<W, M, R>(&system.spin, y, theta);
        let ends = (&y.rotor, &end.rotor);
        let readout = self.series.end(theta);
        let t_new = if whole {
            t_end_s
        } else {
            t_s + theta * reference
        };
        Ok(ContactStep {
            t_s: t_new,
            step_s: theta * reference,
            flows: self.series.flows(system, ends, task, theta),
            peaks: self.series.peaks(system, task.backward, &readout),
            end_normal: self.series.normal(&readout),
            turn: self.series.turn(&readout),
            y: end,
            event,
        })
    }
}

/// Below this order the last two terms say too little about the rest.
const LOWEST_ORDER: usize = 6;

/// Whether the series reaches to the end of the span, asked from order to order: its last two terms there are
/// small, by a margin as to the distance.
struct Enough {
    /// Square of the end's θ over the margin, and its power for the next order.
    square: f64,
    power: f64,
    before: bool,
}

impl Enough {
    /// Terms that go on falling so leave one tolerance beyond the lowest order, less beyond a higher one.
    const MARGIN: f64 = 0.8;

    fn new(end_theta: f64) -> Self {
        let square = (end_theta / Self::MARGIN).powi(2);
        Self {
            square,
            power: square.powi(LOWEST_ORDER as i32 - 1),
            before: false,
        }
    }

    /// Takes the next order's coefficients in, by their weighed square; the first are those below
    /// [`LOWEST_ORDER`].
    fn with(&mut self, coefficients: f64) -> bool {
        let small = coefficients * self.power <= 1.0;
        self.power *= self.square;
        std::mem::replace(&mut self.before, small) && small
    }
}

/// Where a guard falls to zero.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fall {
    /// Nowhere in the step.
    Never,
    /// At this θ.
    At(f64),
    /// Not before this θ; what comes after is too close to decide in one go.
    ClearUntil(f64),
}

/// First θ in [0, `end`] at which a guard that starts positive, or at zero and rising, falls to zero.
///
/// Conservative advancement: with M an upper bound of |g̈| over a window, no root lies before that of
/// g + ġ·τ − M·τ²/2. Windows shrink and grow with the moves, so that the bound stays close.
fn first_fall(guard: &Scalar, end: f64, order: usize, normal: bool) -> Fall {
    let c = &guard.0[..=order];
    let swing = c[1..]
        .iter()
        .rev()
        .fold(0.0, |sum, c| (sum + c.abs()) * end);
    if c[0] > swing {
        return Fall::Never;
    }
    let bound = |window: f64| {
        let terms = c.iter().enumerate().skip(2).rev();
        terms.fold(0.0, |sum, (k, c)| {
            sum * window + (k * (k - 1)) as f64 * c.abs()
        })
    };
    // The state that the mode starts from carries the round-off of a whole step before.
    let start_tiny = 1e-12 * (c[0].abs() + swing);
    let tiny = 1e-15 * (c[0].abs() + swing);
    let (mut theta, mut window, mut curvature) = (0.0, end, bound(end));
    for _ in 0..200 {
        let (mut g, mut rate) = (0.0, 0.0);
        for c in c.iter().rev() {
            rate = rate * theta + g;
            g = g * theta + c;
        }
        if theta == 0.0 {
            // A force that has just jumped may have left the cone, whichever way it moves now. A
            // normal force that rises has not: the touch was found to round-off only.
            if g < -start_tiny && !(normal && rate > 0.0) {
                return Fall::At(0.0);
            }
            if g <= start_tiny {
                g = 0.0;
            }
        }
        if g <= tiny && rate < 0.0 {
            return Fall::At(theta);
        }
        let g = g.max(0.0);
        let root = (rate * rate + 2.0 * curvature * g).sqrt();
        let advance = if rate >= 0.0 {
            (rate + root) / curvature
        } else {
            2.0 * g / (root - rate)
        };
        if advance < 0.05 * (window - theta) {
            window = theta + 8.0 * advance.max(1e-9 * end);
            curvature = bound(window.min(end));
        }
        // At zero without slope: let it move before it is judged.
        let least = if g == 0.0 { 1e-9 * end } else { 0.0 };
        theta += advance.max(least).min(window - theta).max(least);
        if theta >= end {
            return Fall::Never;
        }
        if theta >= window {
            window = (theta * 4.0).min(end);
            curvature = bound(window);
        }
    }
    Fall::ClearUntil(theta)
}
