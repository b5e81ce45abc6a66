//! One step of contact by power series: as far as the series can be trusted, or to the first event.

use super::contact_series::ContactSeries;
use super::contact_step::{ContactStep, Task};
use super::enough::{Enough, LOWEST_ORDER, highest_order, trusted_theta};
use super::first_fall::{Fall, first_fall};
use super::scales::Scales;
use crate::integrate::PlantError;
use crate::magnet::Amplifier;
use crate::params::LinearContact;
use crate::plane::{Bore, Raceway};
use crate::readout::Work;
use crate::series::Scalar;
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
        Self {
            series: ContactSeries::new(law),
            guard: Scalar::default(),
            highest_order: highest_order(rtol),
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
            let mut enough = Enough::new(remaining / reference, 2);
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
            let trusted = trusted_theta(order, 2, |k| square(&self.series, k));
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
            let (stop, by) = match first_fall(guard, theta, order, (i == NORMAL, 0.0)) {
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
