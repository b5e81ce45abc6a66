//! One step of a machine: as far as the series can be trusted, or to the first guard of any plane that falls to zero.

use super::collocation::{Collocation, ERROR_POWER, Scales};
use super::guards::Guard;
use super::series::{MachineSeries, Parts, Step};
use super::system::{MachineState, MachineSystem};
use crate::V2;
use crate::integrate::first_crossing::{ZeroCrossing, first_crossing};
use crate::integrate::order_control::{OrderControl, flight_rtol, highest_order, trusted_theta};
use crate::integrate::{Method, PlantError};
use crate::mode::Phase;
use crate::readout::Work;
use crate::series::Scalar;

/// What a step is asked for.
#[derive(Clone, Copy)]
pub(crate) struct Task<'a> {
    /// From, and to at most \[s\].
    pub(crate) span: (f64, f64),
    pub(crate) phases: &'a [Phase],
    /// Forces that are held, on the coordinates.
    pub(crate) forces: &'a [V2],
    /// Commands of magnets that lag.
    pub(crate) commands_n: &'a [V2],
    /// Guards that are not asked, by plane.
    pub(crate) suppressed: &'a [u8],
    /// Planes that the rotor has left at this instant.
    pub(crate) just_left: &'a [bool],
}

/// How far a step goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach {
    pub(crate) t_s: f64,
    /// End of the step on the series.
    pub(crate) theta: f64,
    /// Plane and guard that ended it.
    pub(crate) event: Option<(usize, Guard)>,
}

/// Scales of the motion, against which coefficients are weighed.
#[derive(Debug, Clone, Copy)]
struct Weights {
    position: f64,
    velocity: f64,
    gap: f64,
    spin: f64,
    race: f64,
    force: f64,
}

/// How many of the last coefficients a step goes by. With two of them one of 400 runs of 60 ms with bending modes at 1e-6 ends in
/// another sequence of modes.
const LAST: usize = 3;

/// Steps a machine; remembers the last steps as the next ones' references.
#[derive(Debug, Clone)]
pub(crate) struct Stepper {
    pub(crate) series: MachineSeries,
    /// Whether flight goes by series whatever the method.
    flies: bool,
    /// The second method, where it is asked for.
    collocation: Option<Box<Collocation>>,
    guard: Scalar,
    /// Tolerances and highest orders in flight and in contact.
    rtol: [f64; 2],
    highest_order: [usize; 2],
    /// References in flight and in contact \[s\].
    references_s: [f64; 2],
    fastest_m_s: f64,
    /// Largest mobility of any plane \[1/kg\], of which speeds are made.
    mobility: f64,
    clearance_m: f64,
    radius_m: f64,
    contact_rate: f64,
    slow_rate: f64,
}

impl Stepper {
    pub(crate) fn new(system: &MachineSystem, rtol: f64, (method, flies): (Method, bool)) -> Self {
        let planes = 0..system.planes.len();
        let least =
            |of: &dyn Fn(usize) -> f64| planes.clone().map(of).fold(f64::INFINITY, f64::min);
        let most = |of: &dyn Fn(usize) -> f64| planes.clone().map(of).fold(0.0, f64::max);
        let rate = system.contact_rate_rad_s();
        Self {
            series: MachineSeries::new(&system.body),
            flies,
            collocation: (method == Method::Collocation)
                .then(|| Box::new(Collocation::new(system))),
            guard: Scalar::default(),
            rtol: [flight_rtol(rtol), rtol],
            highest_order: [flight_rtol(rtol), rtol].map(highest_order),
            references_s: [1.0 / rate; 2],
            fastest_m_s: 0.0,
            mobility: most(&|p| system.contact(p).mobility()),
            clearance_m: least(&|p| system.planes[p].clearance_m),
            radius_m: least(&|p| system.planes[p].radius_m),
            contact_rate: most(&|p| system.undamped_contact_rate_rad_s(p)),
            slow_rate: system.body.undamped_rate_rad_s(),
        }
    }

    /// As those of one plane, `integrate/scales.rs`, with the energy norm of the coordinates for speeds.
    fn weights(&mut self, y: &MachineState, rtol: f64) -> Weights {
        let size = y.velocity.iter().map(V2::norm_squared).sum::<f64>().sqrt();
        let now = size * self.mobility.sqrt();
        self.fastest_m_s = self.fastest_m_s.max(now);
        let floor = 1e-3
            * self
                .fastest_m_s
                .max(1e-3 * self.clearance_m * self.contact_rate);
        let speed = now.max(floor);
        let per = |x: f64| 1.0 / (rtol * x);
        let race_rad_s = y
            .races_rad_s
            .iter()
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        Weights {
            position: per((speed / self.slow_rate).min(self.clearance_m)) * self.mobility.sqrt(),
            velocity: per(speed) * self.mobility.sqrt(),
            gap: per((speed / self.contact_rate).min(self.clearance_m)),
            spin: per((speed / self.radius_m).max(1e-2 * y.spin_rad_s.abs())),
            race: per((speed / self.radius_m).max(1e-2 * race_rad_s)),
            force: per(speed * self.contact_rate / self.mobility),
        }
    }

    /// Carries the solution from `y` towards the end of the span until it, the series or an event stops it.
    pub(crate) fn step(
        &mut self,
        system: &MachineSystem,
        y: &MachineState,
        task: &Task<'_>,
        work: &mut Work,
    ) -> Result<Reach, PlantError> {
        let (t_s, t_end_s) = task.span;
        work.steps += 1;
        let remaining = t_end_s - t_s;
        let flies = self.flies && !task.touches();
        let trusted = match self.collocation.take_if(|_| !flies) {
            None => self.by_series(system, y, task, work)?,
            Some(mut collocation) => {
                let trusted = self.by_collocation(&mut collocation, (system, y), task, work);
                self.collocation = Some(collocation);
                trusted?
            }
        };
        let reference = self.series.parts.step_s;
        let mut whole = trusted * reference >= remaining;
        let mut theta = if whole {
            remaining / reference
        } else {
            trusted
        };
        if !(theta > 0.0 && t_s + theta * reference > t_s) {
            return Err(PlantError::StepTooSmall { t_s });
        }
        let order = self.series.parts.order;
        let mut event = None;
        for (p, phase) in task.phases.iter().enumerate() {
            for guard in Guard::of(*phase) {
                if task.suppressed[p] & guard.bit() != 0 {
                    continue;
                }
                let (series, data) = (&self.series.parts, &system.planes[p]);
                let plane = (&series.planes[p], &series.spin);
                let left = *guard == Guard::Gap && task.just_left[p];
                let out = &mut self.guard;
                let Some(over) = guard.over(out, plane, (data, *phase), (theta, order)) else {
                    continue;
                };
                let rising = matches!(guard, Guard::Normal | Guard::NoForce | Guard::Beyond);
                let how = (rising, guard.rounding(data));
                let fall = if left {
                    // Whatever rounding says: the contact force has just fallen to zero.
                    let mut over = *over;
                    over.0[..2].iter_mut().for_each(|c| *c = c.max(0.0));
                    first_crossing(&over, theta, order, how)
                } else {
                    first_crossing(over, theta, order, how)
                };
                let (stop, by) = match fall {
                    ZeroCrossing::Never => continue,
                    ZeroCrossing::At(stop) => (stop, Some((p, *guard))),
                    ZeroCrossing::ClearUntil(stop) => (stop, None),
                };
                if stop < theta || (stop == theta && by.is_some()) {
                    (theta, event, whole) = (stop, by, false);
                }
            }
        }
        work.events += u64::from(event.is_some());
        let t_s = if whole {
            t_end_s
        } else {
            t_s + theta * reference
        };
        Ok(Reach { t_s, theta, event })
    }

    /// Fills the series, and says up to which θ it can be trusted.
    fn by_series(
        &mut self,
        system: &MachineSystem,
        y: &MachineState,
        task: &Task<'_>,
        work: &mut Work,
    ) -> Result<f64, PlantError> {
        let (t_s, t_end_s) = task.span;
        let touching = task.touches();
        let weights = self.weights(y, self.rtol[usize::from(touching)]);
        let remaining = t_end_s - t_s;
        let highest = self.highest_order[usize::from(touching)];
        let square = |series: &Parts, k: usize, rows| {
            square(series, rows, (system, task.phases), (k, &weights))
        };
        let mut reference = self.references_s[usize::from(touching)].min(remaining);
        loop {
            let mut orders = OrderControl::new(remaining / reference, LAST);
            self.series.fill(
                &task.step(system, reference),
                y,
                highest,
                &mut |series, k, rows| orders.with(square(series, k, rows)),
            );
            let order = self.series.parts.order;
            work.evaluations += order as u64 + 1;
            let kept = &mut self.references_s[usize::from(touching)];
            if order < highest {
                *kept = kept.max(remaining);
                return Ok(f64::INFINITY);
            }
            let trusted = trusted_theta(order, LAST, |k| {
                square(&self.series.parts, k, self.series.squares(k))
            });
            if trusted > 1e-2 {
                *kept = (trusted * reference).min(1e3 * reference);
                return Ok(trusted);
            }
            reference *= if trusted > 1e-6 { trusted } else { 1e-6 };
            if t_s + reference == t_s {
                return Err(PlantError::StepTooSmall { t_s });
            }
        }
    }

    /// The same by collocation, whose steps are taken whole.
    fn by_collocation(
        &mut self,
        collocation: &mut Collocation,
        (system, y): (&MachineSystem, &MachineState),
        task: &Task<'_>,
        work: &mut Work,
    ) -> Result<f64, PlantError> {
        let (t_s, t_end_s) = task.span;
        let [_, rtol] = self.rtol;
        let weights = self.weights(y, rtol);
        let rounding = 100.0 * f64::EPSILON / rtol;
        let scales = Scales {
            velocity: weights.velocity,
            spin: match system.inverse_inertia > 0.0 {
                true => weights.spin,
                false => 0.0,
            },
            force: weights.force,
            gap: weights.gap,
            speed: weights.velocity / self.mobility.sqrt(),
            rounding,
        };
        let touching = usize::from(task.touches());
        let remaining = t_end_s - t_s;
        let mut whole = remaining < self.references_s[touching];
        let mut step_s = self.references_s[touching].min(remaining);
        loop {
            let step = task.step(system, step_s);
            let error = collocation.solve(&step, y, &scales);
            work.evaluations += std::mem::take(&mut collocation.evaluations);
            work.factorisations += std::mem::take(&mut collocation.factorisations);
            let pace = 0.9 * error.max(1e-30).powf(-1.0 / ERROR_POWER);
            if error <= rounding.max(1.0) {
                collocation.write(&step, y, &mut self.series);
                let next_s = step_s * pace.clamp(0.5, 2.0);
                let kept = &mut self.references_s[touching];
                // A step that the span has cut short says nothing against longer ones.
                *kept = if whole { kept.max(next_s) } else { next_s };
                return Ok(1.0);
            }
            whole = false;
            step_s *= if error.is_finite() {
                pace.clamp(0.1, 0.8)
            } else {
                0.3
            };
            if t_s + step_s == t_s {
                return Err(PlantError::StepTooSmall { t_s });
            }
        }
    }
}

impl Task<'_> {
    fn touches(&self) -> bool {
        self.phases.iter().any(|phase| *phase != Phase::Inside)
    }

    fn step<'a>(&'a self, system: &'a MachineSystem, step_s: f64) -> Step<'a> {
        Step {
            system,
            phases: self.phases,
            forces: self.forces,
            commands_n: self.commands_n,
            step_s,
        }
    }
}

/// Σ (coefficient k / scale)².
fn square(
    series: &Parts,
    (positions, velocities): (f64, f64),
    (system, phases): (&MachineSystem, &[Phase]),
    (k, weights): (usize, &Weights),
) -> f64 {
    let mut sum = positions * weights.position * weights.position
        + velocities * weights.velocity * weights.velocity;
    for (plane, phase) in series.planes.iter().zip(phases) {
        // Beyond the wall nothing but the guards knows the distance, whose series ends where the rotor would pass the
        // middle however straight it flies.
        let gap = match phase {
            Phase::Inside => continue,
            Phase::Beyond => plane.distance.0[k] * plane.distance.0[k],
            Phase::Contact(..) => plane.gap.0[k].norm_squared(),
        };
        sum += gap * weights.gap * weights.gap;
        // Of a race that is touched; another one has no coefficients.
        if plane.grip.turns && *phase != Phase::Beyond {
            sum += (plane.race.0[k] * weights.race).powi(2);
        }
    }
    if system.inverse_inertia > 0.0 {
        sum += (series.spin.0[k] * weights.spin).powi(2);
    }
    for (series, law) in series.magnets.iter().zip(&system.magnets) {
        if law.lag().is_some() {
            sum += series.0[k].norm_squared() * weights.force * weights.force;
        }
    }
    sum
}
