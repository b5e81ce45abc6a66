//! Carries a machine from sample to sample, event by event.

mod changing;
mod reading;
mod settle;
mod warming;

use super::flight_map::FlightMap;
use super::guards::Guard;
use super::holding::Holding;
use super::params::{MAX_PLANES, MachineParams, MachineStart};
use super::readout::{Held, MachineSnapshot, PlaneFlows};
use super::step::{Stepper, Task};
use super::system::{MachineInputs, MachineState, MachineSystem, ON_WALL};
use crate::V2;
use crate::energy::Flows;
use crate::integrate::progress::Progress;
use crate::integrate::{Method, Options, PlantError};
use crate::mode::{ContactMode, Phase, Slide, Whirl};
use crate::params::ParamError;
use crate::readout::{HARD_IMPACT_M_S, Meters, Work};
use settle::AtZero;
use warming::Warming;
pub use warming::Warmth;

/// Share of the spin's energy at the start that is not counted as turned over. The rest of it is for rounding: of a rotor
/// that levitates nothing else moves.
const SPARE: f64 = 1.0 - 1e-4;

/// Share of a moment that a step has to get on by. Friction that falls within a thousandth of a moment is followed.
const CREEPING: f64 = 1e-3;

/// For how many moments a guard is not asked.
const MUTED: f64 = 100.0;

/// Share of its cone from which on friction counts as holding something.
const GRIPPED: f64 = 0.01;

/// Share of the normal force by which friction at the edge of its cone may be off by rounding.
const AT_EDGE: f64 = 1e-10;

/// A rotor that may touch in several planes, being run. Deterministic: the same calls give the same bits.
#[derive(Debug, Clone)]
pub struct Machine {
    system: MachineSystem,
    y: MachineState,
    phases: Vec<Phase>,
    stepper: Stepper,
    map: FlightMap,
    holding: Holding,
    inputs: MachineInputs,
    /// Forces that are held over a call, on the coordinates.
    forces: Vec<V2>,
    /// Room for modes that are tried.
    trial: Vec<Phase>,
    fallback: Vec<Phase>,
    t_s: f64,
    flows: Flows,
    stored_at_start_j: f64,
    stored_peak_j: f64,
    /// Energy of the spins that may never take part.
    spare_j: f64,
    plane_flows: Vec<PlaneFlows>,
    /// Of bearings that have heat; others stay as they are.
    warmings: Vec<Warming>,
    meters: Vec<Meters>,
    work: Work,
    options: Options,
    /// Whether flight goes by series and the flight map.
    flies: bool,
    /// Sign of backward whirl in each plane.
    backward: Vec<f64>,
    path: Vec<V2>,
    suppressed: Vec<u8>,
    /// For how long at least a guard is not asked \[s\].
    at_edge_s: f64,
    just_left: Vec<bool>,
    /// Planes in which it started on the wall, and along it if it moved.
    rests: Vec<bool>,
    left_at_s: Vec<f64>,
    progress: Progress,
}

impl Machine {
    /// Puts a machine together. [`Method::Auto`] is [`Method::Series`], or [`Method::Collocation`] where something has no
    /// series ([`MachineParams::method`]).
    ///
    /// # Errors
    /// The first value that is out of range.
    pub fn new(
        params: &MachineParams,
        start: &MachineStart,
        options: Options,
    ) -> Result<Self, ParamError> {
        let system = MachineSystem::new(params)?;
        options.validate()?;
        let flies = options.method != Method::Collocation && params.flies();
        let method = match params.method(options.method)? {
            Method::Series if options.method == Method::Auto && system.is_overdamped() => {
                Method::Collocation
            }
            method => method,
        };
        let options = Options { method, ..options };
        let y = system.start(params, start)?;
        let (pairs, planes) = (system.body.pairs, system.planes.len());
        let mut machine = Self {
            stepper: Stepper::new(&system, options.rtol, (method, flies)),
            map: FlightMap::default(),
            holding: Holding::new(pairs),
            inputs: MachineInputs {
                commands_n: vec![V2::zeros(); system.caps_n.len()],
                loads_n: vec![V2::zeros(); system.body.loads.len()],
            },
            forces: system.body.gravity.clone(),
            phases: vec![Phase::Inside; planes],
            trial: vec![Phase::Inside; planes],
            fallback: vec![Phase::Inside; planes],
            t_s: 0.0,
            flows: Flows::default(),
            stored_at_start_j: 0.0,
            stored_peak_j: 0.0,
            spare_j: SPARE * system.turning_j(&y),
            plane_flows: vec![PlaneFlows::default(); planes],
            warmings: (params.planes.iter())
                .map(|plane| Warming::new(plane.heat.map_or(0.0, |heat| heat.start_rise_k)))
                .collect(),
            meters: vec![Meters::default(); planes],
            work: Work::default(),
            options,
            flies,
            backward: (0..planes).map(|p| system.backward(p, &y)).collect(),
            path: vec![V2::zeros(); pairs],
            suppressed: vec![0; planes],
            at_edge_s: 0.0,
            just_left: vec![false; planes],
            rests: vec![false; planes],
            left_at_s: vec![f64::NEG_INFINITY; planes],
            progress: Progress::default(),
            system,
            y,
        };
        for p in 0..planes {
            let motion = machine.contact_motion(p);
            let data = &machine.system.planes[p];
            let depth = motion.penetration_m;
            machine.rests[p] = depth.abs() <= ON_WALL * data.clearance_m
                && motion.normal_m_s.abs() <= ON_WALL * motion.speed_m_s;
            if depth > ON_WALL * data.clearance_m {
                if data.law.normal_force_n(depth, motion.normal_m_s) > 0.0 {
                    machine.settle(p, AtZero::default());
                } else {
                    machine.phases[p] = Phase::Beyond;
                }
            }
        }
        machine.stored_at_start_j = machine.system.stored_j(&machine.y, &machine.phases);
        Ok(machine)
    }

    /// Carries the machine to `t_end_s` with `inputs` held. `on_change` is called right after each change of a plane's mode,
    /// with the plane and what can be read off there.
    ///
    /// # Errors
    /// [`PlantError`]: the run cannot be trusted any further and must end.
    pub fn advance(
        &mut self,
        t_end_s: f64,
        inputs: &MachineInputs,
        on_change: &mut dyn FnMut(usize, &MachineSnapshot),
    ) -> Result<(), PlantError> {
        let t_s = self.t_s;
        if inputs.commands_n.len() != self.inputs.commands_n.len()
            || inputs.loads_n.len() != self.inputs.loads_n.len()
        {
            return Err(PlantError::InputCount { t_s });
        }
        let finite = |all: &[V2]| all.iter().all(|f| f.x.is_finite() && f.y.is_finite());
        if !(t_end_s.is_finite() && finite(&inputs.commands_n) && finite(&inputs.loads_n)) {
            return Err(PlantError::NotFinite { t_s });
        }
        self.apply(inputs);
        let before = self.modes();
        self.warm();
        self.tell(before, on_change);
        if self.flies
            && self.t_s < t_end_s
            && self.phases.iter().all(|phase| *phase == Phase::Inside)
        {
            let dt_s = t_end_s - self.t_s;
            let flows = (&mut self.flows, &mut self.plane_flows[..]);
            let held = (&self.inputs, dt_s);
            if (self.map).fly(&self.system, &mut self.y, held, &mut self.path, flows) {
                self.t_s = t_end_s;
                self.just_left.fill(false);
                self.progress.whole_sample();
                self.note_stored();
                return self.check_state();
            }
        }
        self.progress.begin_sample();
        while self.t_s < t_end_s {
            let begun = self.progress.begin_step(&self.options, self.t_s);
            begun.map_err(|error| self.system.naming_fastest(error))?;
            let free = self.phases.iter().all(|phase| *phase == Phase::Inside);
            let before: [ContactMode; MAX_PLANES] = self.modes();
            let (t_before, moment_s) = (self.t_s, self.system.moment_s(&self.y));
            self.step(t_end_s)?;
            self.check_state()?;
            self.progress.count(self.t_s, self.t_s > t_before)?;
            let creeps = self.t_s - t_before <= CREEPING * moment_s && self.t_s < t_end_s;
            self.progress.creeps(self.t_s, creeps)?;
            if free && self.modes() == before && !creeps {
                self.progress.was_free();
            }
            self.tell(before, on_change);
        }
        self.note_stored();
        Ok(())
    }

    /// Calls for each plane whose mode is another than before.
    fn tell(
        &mut self,
        before: [ContactMode; MAX_PLANES],
        on_change: &mut dyn FnMut(usize, &MachineSnapshot),
    ) {
        let after = self.modes();
        if after != before {
            let snapshot = self.snapshot();
            for p in (0..self.phases.len()).filter(|p| after[*p] != before[*p]) {
                on_change(p, &snapshot);
            }
        }
    }

    fn modes(&self) -> [ContactMode; MAX_PLANES] {
        let mut modes = [ContactMode::Flight; MAX_PLANES];
        for (mode, phase) in modes.iter_mut().zip(&self.phases) {
            *mode = phase.mode();
        }
        modes
    }

    /// Takes inputs over, and what they push on the coordinates.
    fn apply(&mut self, inputs: &MachineInputs) {
        self.forces.copy_from_slice(&self.system.body.gravity);
        for (m, command_n) in inputs.commands_n.iter().enumerate() {
            let (cap, size) = (self.system.caps_n[m], command_n.norm());
            let held = if size > cap {
                command_n * (cap / size)
            } else {
                *command_n
            };
            self.inputs.commands_n[m] = held;
            if self.system.magnets[m].is_held() {
                self.system.body.magnets[m].push(&mut self.forces, held);
            }
        }
        for (l, load_n) in inputs.loads_n.iter().enumerate() {
            self.inputs.loads_n[l] = *load_n;
            self.system.body.loads[l].push(&mut self.forces, *load_n);
        }
    }

    fn step(&mut self, t_end_s: f64) -> Result<(), PlantError> {
        let moment_s = self.system.moment_s(&self.y);
        let muted = self.suppressed.iter().any(|s| *s != 0);
        let t_end_s = match muted {
            false => t_end_s,
            true => t_end_s.min(self.t_s + (MUTED * moment_s).max(self.at_edge_s)),
        };
        self.at_edge_s = 0.0;
        let task = Task {
            span: (self.t_s, t_end_s),
            phases: &self.phases,
            forces: &self.forces,
            commands_n: &self.inputs.commands_n,
            suppressed: &self.suppressed,
            just_left: &self.just_left,
        };
        let reach = self
            .stepper
            .step(&self.system, &self.y, &task, &mut self.work)?;
        self.book(reach.theta);
        let stood_still = reach.t_s == self.t_s;
        self.t_s = reach.t_s;
        let mut before = [0; MAX_PLANES];
        for (kept, suppressed) in before.iter_mut().zip(&mut self.suppressed) {
            *kept = std::mem::take(suppressed);
        }
        // Another plane may leave its wall with this one, up to rounding.
        if reach.theta * self.stepper.series.parts.step_s > moment_s {
            self.just_left.fill(false);
        }
        let Some((p, guard)) = reach.event else {
            self.zero_speeds(None);
            return Ok(());
        };
        let phase = self.phases[p];
        // As the normal force dies the friction cones close with it: that is one event, lift-off.
        let guard = match (phase, guard) {
            (Phase::Contact(..), guard) if guard != Guard::Normal => {
                let force = self.stepper.series.parts.planes[p]
                    .normal_guard(&self.system.planes[p])
                    .with_slope(reach.theta, self.stepper.series.parts.order);
                let rate = force.1 / self.stepper.series.parts.step_s;
                if force.0 < -rate * moment_s {
                    Guard::Normal
                } else {
                    guard
                }
            }
            (_, guard) => guard,
        };
        let gripped = self.gripped(p);
        if !stood_still && self.options.method == Method::Collocation && self.holds_on(p, guard) {
            self.zero_speeds(None);
            return Ok(());
        }
        match guard {
            Guard::Gap if self.never_left(p) => self.touch_down(p),
            Guard::Gap => self.impact(p),
            Guard::Beyond => {
                self.zero_speeds(None);
                self.phases[p] = Phase::Inside;
                self.just_left[p] = true;
            }
            Guard::NoForce => {
                let dent_j = self.spring_j(p);
                self.book_dent(p, -dent_j);
                self.touch_down(p);
            }
            Guard::Normal => self.lift_off(p),
            _ => {
                let at_zero = AtZero::after(phase, guard);
                self.zero_speeds(Some((p, at_zero)));
                self.settle(p, at_zero);
                if self.phases[p] == phase && stood_still {
                    self.suppressed[p] = before[p] | guard.bit();
                }
                // A speed that begins at zero, from the edge of its cone, has the sign of rounding at first. The damper, which makes
                // a moment shorter, has no part in it. Where it held nothing, as in a straight impact, no speed
                // begins, and at a jump the sign is plain.
                for (begins, guard) in [
                    (at_zero.only_slide.is_some(), Guard::Slide),
                    (at_zero.only_whirl.is_some(), Guard::Whirl),
                ] {
                    if begins && !stood_still && gripped {
                        self.suppressed[p] |= guard.bit();
                        self.at_edge_s = MUTED * 1e-6 / self.system.undamped_contact_rate_rad_s(p);
                    }
                }
                if self.progress.is_circle() {
                    for (kept, phase) in self.suppressed.iter_mut().zip(&self.phases) {
                        if matches!(phase, Phase::Contact(..)) {
                            *kept = !Guard::Normal.bit();
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether friction had something to hold where the last step began, and not rounding alone.
    fn gripped(&self, p: usize) -> bool {
        let (data, plane) = (&self.system.planes[p], &self.stepper.series.parts.planes[p]);
        let grips = |mu: f64, friction_n_m: f64| {
            friction_n_m.abs() > GRIPPED * mu * plane.normal_n_m.0[0].abs()
        };
        grips(data.sliding, plane.sliding_n_m.0[0]) || grips(data.rolling, plane.rolling_n_m.0[0])
    }

    /// Whether friction that holds a speed is still inside its cone where a guard says that it has come to the edge. Between its
    /// points a polynomial is off by the tolerance; the forces of the instant decide.
    fn holds_on(&mut self, p: usize, guard: Guard) -> bool {
        let Phase::Contact(slide, whirl) = self.phases[p] else {
            return false;
        };
        let (rolls, still) = (slide == Slide::Rolling, whirl == Whirl::Still);
        self.look();
        let (plane, data) = (&self.stepper.series.parts.planes[p], &self.system.planes[p]);
        let normal_n_m = plane.normal_n_m.0[0];
        let (sliding, rolling) = (plane.sliding_n_m.0[0], plane.rolling_n_m.0[0]);
        let room = match guard {
            Guard::Slide if rolls => data.sliding * normal_n_m - sliding,
            Guard::SlideLow => data.sliding * normal_n_m + sliding,
            Guard::Whirl if still => data.rolling * normal_n_m - rolling,
            Guard::WhirlLow => data.rolling * normal_n_m + rolling,
            _ => return false,
        };
        room > AT_EDGE * normal_n_m
    }

    /// Takes the step over up to θ: energies, largest values, state.
    fn book(&mut self, theta: f64) {
        let series = &self.stepper.series;
        self.path.copy_from_slice(&self.y.position);
        series.at((&self.system, &self.phases), theta, &mut self.y);
        for (path, q) in self.path.iter_mut().zip(&self.y.position) {
            *path = q - *path;
        }
        let held = Held {
            inputs: &self.inputs,
            path: &self.path,
        };
        let phases = &self.phases;
        let flows = series.flows(&self.system, phases, (theta, &self.backward), held);
        self.flows.add_scaled(1.0, &flows.machine);
        let step_s = theta * series.parts.step_s;
        for (p, phase) in self.phases.iter().enumerate() {
            self.plane_flows[p].add(&flows.planes[p]);
            if matches!(phase, Phase::Contact(..)) && theta > 0.0 {
                let motion = self.system.motion(p, &self.y);
                let (data, meters) = (&self.system.planes[p], &mut self.meters[p]);
                let tops = (&flows.tops[p], &meters.peaks(data.radius_m));
                let end = (theta, self.backward[p]);
                let peaks = series.parts.peaks((p, data), end, &motion, tops);
                let turn_rad = series.parts.turn_rad(p, &motion, step_s);
                meters.contact_step(&peaks, step_s, turn_rad, data.radius_m);
            }
        }
    }

    /// From the start on the wall, and no farther from it since than rounding: under a push of ½·a·t² = ½·v·t.
    fn never_left(&self, p: usize) -> bool {
        let off_m = self.t_s * self.contact_motion(p).normal_m_s;
        self.rests[p] && off_m <= 2.0 * ON_WALL * self.system.planes[p].clearance_m
    }

    fn impact(&mut self, p: usize) {
        let motion = self.contact_motion(p);
        let meters = &mut self.meters[p];
        meters.impacts += 1;
        meters.hard_impacts += u64::from(motion.normal_m_s > HARD_IMPACT_M_S);
        meters.peak_impact_speed_m_s = meters.peak_impact_speed_m_s.max(motion.normal_m_s);
        self.touch_down(p);
    }

    /// Contact begins. Where it has only just ended, the normal force is at zero and hardly moves; it is not asked for a
    /// moment.
    fn touch_down(&mut self, p: usize) {
        self.zero_speeds(None);
        if self.t_s - self.left_at_s[p] <= self.system.moment_s(&self.y) {
            self.suppressed[p] = Guard::Normal.bit();
        }
        self.settle(p, AtZero::default());
    }

    fn lift_off(&mut self, p: usize) {
        self.zero_speeds(None);
        self.just_left[p] = true;
        self.left_at_s[p] = self.t_s;
        let depth_m = self.contact_motion(p).penetration_m;
        self.phases[p] = if self.system.planes[p].leaves_dent(depth_m) {
            // The dent relaxes on the contact damper alone.
            let dent_j = self.spring_j(p);
            self.book_dent(p, dent_j);
            Phase::Beyond
        } else {
            Phase::Inside
        };
    }

    /// Energy in a plane's contact spring \[J\], of a dent as well; it is not pulled.
    fn spring_j(&self, p: usize) -> f64 {
        let depth_m = self.contact_motion(p).penetration_m.max(0.0);
        self.system.planes[p].law.stored_j(depth_m)
    }

    fn book_dent(&mut self, p: usize, dent_j: f64) {
        self.flows.contact_damping += dent_j;
        self.plane_flows[p].contact_damping += dent_j;
    }

    fn check_state(&mut self) -> Result<(), PlantError> {
        let t_s = self.t_s;
        if !self.y.is_finite() {
            return Err(PlantError::NotFinite { t_s });
        }
        for p in 0..self.phases.len() {
            let data = &self.system.planes[p];
            let radius_m = self.system.body.at_planes[p].of(&self.y.position).norm();
            if radius_m > (1e3 * data.clearance_m).max(data.radius_m) {
                return Err(PlantError::Diverged { t_s, radius_m });
            }
        }
        Ok(())
    }

    /// Notes what is stored at the end of a call.
    fn note_stored(&mut self) {
        let stored = self.system.stored_j(&self.y, &self.phases) - self.spare_j;
        self.stored_peak_j = self.stored_peak_j.max(stored.abs());
    }

    /// Mode of each plane.
    pub fn mode(&self, plane: usize) -> Option<ContactMode> {
        Some(self.phases.get(plane)?.mode())
    }

    /// Extremes and sums of each plane so far.
    pub fn meters(&self) -> &[Meters] {
        &self.meters
    }

    /// Energy that each plane took so far.
    pub fn plane_flows(&self) -> &[PlaneFlows] {
        &self.plane_flows
    }

    /// Work done so far.
    pub fn work(&self) -> Work {
        self.work
    }

    /// How it is integrated; never [`Method::Auto`].
    pub fn method(&self) -> Method {
        self.options.method
    }

    /// Time now \[s\].
    pub fn t_s(&self) -> f64 {
        self.t_s
    }
}
