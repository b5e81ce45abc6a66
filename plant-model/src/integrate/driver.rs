//! Carries a plant from control sample to control sample, mode by mode.

mod changing;
mod flying;

use super::contact_step::{ContactStepper, Task};
use super::dop853::Dop853;
use super::flight::Segment;
use super::flight_map::FlightMaps;
use super::progress::Progress;
use super::radau::Radau;
use super::scales::Scales;
use super::series_step::SeriesStepper;
use super::transitions::AtZero;
use crate::energy::{Audit, Flows};
use crate::integrate::{Method, Options, PlantError};
use crate::magnet::Amplifier;
use crate::mode::{Mode, Phase, Slide, Whirl};
use crate::part::Part;
use crate::plane::{Bore, Raceway};
use crate::readout::{Meters, Snapshot, Work};
use crate::spin::Spin;
use crate::stator::{Rings, Stator};
use crate::system::{Evaluation, Geometry, Inputs, NORMAL, StateOf, SuppressedGuards, System};

type Explicit<Y> = Dop853<Y, Evaluation<Y>>;
type Stiff<Y> = Radau<Y, Evaluation<Y>>;

/// A run of one combination of parts.
pub(crate) struct Run<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> {
    pub(crate) system: System<S, W, M, B, R>,
    pub(crate) force_max_n: f64,
    pub(crate) t_s: f64,
    pub(crate) y: StateOf<S, W, M, R>,
    pub(crate) phase: Phase,
    pub(crate) flows: Flows,
    pub(crate) meters: Meters,
    scales: Scales,
    work: Work,
    segment: Segment<S>,
    maps: FlightMaps,
    /// Only where the contact law has a power series.
    series: Option<SeriesStepper<S>>,
    explicit: ContactStepper<Explicit<StateOf<S, W, M, R>>>,
    stiff: ContactStepper<Stiff<StateOf<S, W, M, R>>>,
    inputs: Inputs,
    /// Sense of backward whirl: against the spin at the start, which friction may reverse later.
    backward: f64,
    stored_at_start_j: f64,
    stored_peak_j: f64,
    /// Energy of the spin that may never take part.
    spare_j: f64,
    options: Options,
    progress: Progress,
    /// Guard that is not asked in the next step.
    suppressed: SuppressedGuards,
    /// The rotor has left the wall at this instant.
    just_left: bool,
    /// When it left last \[s\].
    left_at_s: f64,
    /// Beyond this radius the model means nothing \[m\].
    farthest_m: f64,
}

/// Share of the spin's energy at the start that is not counted as turned over. The rest of it is for rounding: of a rotor
/// that levitates nothing else moves.
pub(crate) const SPARE: f64 = 1.0 - 1e-4;

/// A start is on the wall within this share of the clearance, and moves along it within this share of its speed: sine,
/// cosine, a product and the length leave up to 2.5ε. The [search](super::flight) for the wall knows it as well.
pub(crate) const ON_WALL: f64 = 4.0 * f64::EPSILON;

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> Run<S, W, M, B, R> {
    pub(crate) fn new(
        system: System<S, W, M, B, R>,
        y: StateOf<S, W, M, R>,
        force_max_n: f64,
        mut options: Options,
    ) -> Self {
        let mobility = 1.0 / system.rotor.mass_kg + system.stator.inverse_mass();
        // What comes against the wall only now is not yet there.
        let touching = beyond_wall(&system, &y) || rests_on_wall(&system, &y);
        let start = (y.rotor.velocity.norm(), touching);
        options.method =
            (options.method).resolved(&system.plane.contact.law, start, mobility, options.rtol);
        if B::OUT_OF_ROUND && options.method == Method::Series {
            options.method = Method::Explicit;
        }
        let mut run = Self {
            scales: Scales::new(options.rtol, &system, &y),
            work: Work::default(),
            maps: FlightMaps::default(),
            segment: Segment::new(system.flight_rate_rad_s()),
            series: (system.plane.contact.law.linear())
                .filter(|_| !B::OUT_OF_ROUND)
                .map(|law| SeriesStepper::new(options.rtol, system.contact_rate_rad_s(), law)),
            explicit: ContactStepper::new::<StateOf<S, W, M, R>>(system.contact_rate_rad_s()),
            stiff: ContactStepper::new::<StateOf<S, W, M, R>>(system.contact_rate_rad_s()),
            system,
            force_max_n,
            t_s: 0.0,
            y,
            phase: Phase::Inside,
            flows: Flows::default(),
            meters: Meters::default(),
            inputs: Inputs::default(),
            backward: 1.0,
            stored_at_start_j: 0.0,
            stored_peak_j: 0.0,
            spare_j: 0.0,
            options,
            progress: Progress::default(),
            suppressed: SuppressedGuards::NONE,
            just_left: false,
            left_at_s: f64::NEG_INFINITY,
            farthest_m: 0.0,
        };
        let params = &run.system;
        run.farthest_m = (1e3 * params.plane.contact.clearance_m).max(params.plane.radius_m);
        // Without spin friction drives against the way in which the surfaces slide on each other.
        let spin = run.system.spin.spin_rad_s(&run.y.spin);
        let sense = match spin == 0.0 {
            true => run.system.surface_m_s(&run.y),
            false => spin,
        };
        if sense >= 0.0 {
            run.backward = -1.0;
        }
        run.spare_j = SPARE * run.system.turning_j(&run.y);
        if beyond_wall(&run.system, &run.y) {
            let g = run.system.geometry(&run.y);
            run.phase = match run.normal_n(&g) > 0.0 {
                true => run.settled(),
                false => Phase::Beyond,
            };
        }
        run.stored_at_start_j = run.system.stored_j(&run.y, run.in_contact());
        run
    }

    fn in_contact(&self) -> bool {
        matches!(self.phase, Phase::Contact(..))
    }

    fn normal_n(&self, g: &Geometry) -> f64 {
        (self.system.plane.contact.law).normal_force_n(g.penetration_m, g.normal_speed_m_s)
    }

    /// See [`crate::plant::Plant::advance`].
    pub(crate) fn advance(
        &mut self,
        t_end_s: f64,
        inputs: &Inputs,
        on_change: &mut dyn FnMut(&Snapshot),
    ) -> Result<(), PlantError> {
        let finite = |v: &crate::V2| v.iter().all(|x| x.is_finite());
        if !(finite(&inputs.command_n) && finite(&inputs.external_n)) {
            return Err(PlantError::NotFinite { t_s: self.t_s });
        }
        self.inputs = *inputs;
        self.inputs.command_n = limited(inputs.command_n, self.force_max_n);
        if !t_end_s.is_finite() {
            return Err(PlantError::NotFinite { t_s: self.t_s });
        }
        if self.phase == Phase::Inside && self.t_s < t_end_s {
            let dt_s = t_end_s - self.t_s;
            let flown = (self.system).fly_by_map(&mut self.maps, &self.y, &self.inputs, dt_s);
            if let Some((end, flows)) = flown {
                self.flows.add_scaled(1.0, &flows);
                (self.y, self.t_s) = (end, t_end_s);
                self.just_left = false;
                self.progress.whole_sample();
                return self.check_state();
            }
        }
        self.progress.begin_sample();
        while self.t_s < t_end_s {
            self.progress.begin_step(&self.options, self.t_s)?;
            let (t_before, phase_before) = (self.t_s, self.phase);
            match self.phase {
                Phase::Inside => {
                    if self.fly_inside(t_end_s) {
                        self.progress.was_free();
                    }
                }
                Phase::Beyond => self.fly_beyond(t_end_s),
                Phase::Contact(slide, whirl) => self.touch(t_end_s, (slide, whirl))?,
            }
            self.check_state()?;
            self.progress.count(self.t_s, self.t_s > t_before)?;
            if self.phase.mode() != phase_before.mode() {
                on_change(&self.snapshot());
            }
        }
        Ok(())
    }

    fn check_state(&mut self) -> Result<(), PlantError> {
        let t_s = self.t_s;
        if !self.y.is_finite() {
            return Err(PlantError::NotFinite { t_s });
        }
        let radius_m = self.y.rotor.position.norm();
        if radius_m > self.farthest_m {
            return Err(PlantError::Diverged { t_s, radius_m });
        }
        let stored = self.system.stored_j(&self.y, self.in_contact()) - self.spare_j;
        self.stored_peak_j = self.stored_peak_j.max(stored.abs());
        Ok(())
    }

    fn touch(&mut self, t_end_s: f64, pair: (Slide, Whirl)) -> Result<(), PlantError> {
        // Guards that ended this very mode at this very instant are not asked again for a moment.
        let suppressed = core::mem::take(&mut self.suppressed);
        let t_end_s = match suppressed {
            SuppressedGuards::NONE => t_end_s,
            _ => t_end_s.min(self.t_s + 100.0 * self.system.moment_s(&self.y)),
        };
        let task = Task {
            span: (self.t_s, t_end_s),
            inputs: &self.inputs,
            mode: pair,
            suppressed,
            backward: self.backward,
        };
        let books = (&mut self.scales, &mut self.work);
        let outcome = match (self.options.method, &mut self.series) {
            (Method::Auto | Method::Series, Some(series)) => {
                series.step(&self.system, &self.y, &task, books)?
            }
            (Method::Stiff, _) => self.stiff.step(&self.system, &self.y, &task, books)?,
            _ => self.explicit.step(&self.system, &self.y, &task, books)?,
        };
        self.flows.add_scaled(1.0, &outcome.flows);
        let radius_m = self.system.plane.radius_m;
        (self.meters).contact_step(&outcome.peaks, outcome.step_s, outcome.turn, radius_m);
        let stood_still = outcome.t_s == self.t_s;
        self.y = outcome.y;
        self.t_s = outcome.t_s;
        // As the normal force dies the friction cones close with it: that is one event, lift-off.
        let (normal, rate) = outcome.end_normal;
        let over = normal < -rate * self.system.moment_s(&self.y);
        match outcome.event.map(|guard| if over { NORMAL } else { guard }) {
            None => self.system.zero_speeds(&mut self.y, AtZero::held(pair)),
            Some(NORMAL) => self.lift_off(),
            Some(guard) => {
                self.system
                    .zero_speeds(&mut self.y, AtZero::after(pair, guard));
                let here = (self.t_s, &self.y);
                let next = self.system.next_in_contact(here, &self.inputs, pair, guard);
                if next == pair && stood_still {
                    self.suppressed = suppressed.and(guard);
                }
                if self.progress.is_circle() {
                    self.suppressed = SuppressedGuards::MODES;
                }
                self.phase = Phase::Contact(next.0, next.1);
            }
        }
        Ok(())
    }

    /// Contact begins. Where it has only just ended, the normal force is at zero and hardly moves; it
    /// is not asked for a moment.
    fn touch_down(&mut self) {
        if self.t_s - self.left_at_s <= self.system.moment_s(&self.y) {
            self.suppressed = SuppressedGuards::NORMAL;
        }
        self.phase = self.settled();
    }

    /// Contact in the mode that fits the speeds.
    fn settled(&self) -> Phase {
        let here = (self.t_s, &self.y);
        let (slide, whirl) = self.system.settle(here, &self.inputs, AtZero::default());
        Phase::Contact(slide, whirl)
    }

    fn lift_off(&mut self) {
        self.just_left = true;
        self.left_at_s = self.t_s;
        let g = self.system.geometry(&self.y);
        self.phase = if self.system.plane.contact.leaves_dent(g.penetration_m) {
            // The dent relaxes on the contact damper alone.
            self.flows.contact_damping += self.system.plane.contact.law.stored_j(g.penetration_m);
            Phase::Beyond
        } else {
            Phase::Inside
        };
    }

    pub(crate) fn snapshot(&self) -> Snapshot {
        let g = self.system.geometry(&self.y);
        let ring = self.y.stator.inner();
        let outer = self.y.stator.outer();
        let mut snapshot = Snapshot {
            t_s: self.t_s,
            position_m: self.y.rotor.position,
            velocity_m_s: self.y.rotor.velocity,
            inner_ring: ring,
            outer_ring: outer.unwrap_or_default(),
            spin_rad_s: self.system.spin.spin_rad_s(&self.y.spin),
            race_spin_rad_s: R::spin_rad_s(&self.y.race),
            mode: self.phase.mode(),
            penetration_m: g.penetration_m,
            normal_force_n: 0.0,
            sliding_force_n: 0.0,
            rolling_force_n: 0.0,
            contact_tangential_speed_m_s: g.whirl_speed_m_s,
            sliding_speed_m_s: g.sliding_speed_m_s,
            delivered_n: (self.system.amplifier).force_n(&self.y.force, self.inputs.command_n),
            whirl_angle_rad: self.meters.whirl_angle_rad,
        };
        if let Phase::Contact(slide, whirl) = self.phase {
            let e = self
                .system
                .contact(self.t_s, &self.y, &self.inputs, (slide, whirl));
            snapshot.normal_force_n = e.touch.normal_n.max(0.0);
            snapshot.sliding_force_n = e.touch.sliding_n;
            snapshot.rolling_force_n = e.touch.rolling_n;
        }
        snapshot
    }

    pub(crate) fn method(&self) -> Method {
        self.options.method
    }

    pub(crate) fn mode(&self) -> Mode {
        self.phase.mode()
    }

    pub(crate) fn audit(&self) -> Audit {
        Audit {
            flows: self.flows,
            stored_at_start_j: self.stored_at_start_j,
            stored_j: self.system.stored_j(&self.y, self.in_contact()),
            stored_peak_j: (self.stored_peak_j).max((self.stored_at_start_j - self.spare_j).abs()),
        }
    }

    pub(crate) fn work(&self) -> Work {
        self.work
    }
}

/// Farther out than rounding may put a start that is meant to be on the wall.
fn beyond_wall<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway>(
    system: &System<S, W, M, B, R>,
    y: &StateOf<S, W, M, R>,
) -> bool {
    system.geometry(y).penetration_m > ON_WALL * system.plane.contact.clearance_m
}

/// On the wall, at rest or moving along it.
fn rests_on_wall<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway>(
    system: &System<S, W, M, B, R>,
    y: &StateOf<S, W, M, R>,
) -> bool {
    let g = system.geometry(y);
    g.penetration_m.abs() <= ON_WALL * system.plane.contact.clearance_m
        && g.normal_speed_m_s.abs() <= ON_WALL * y.rotor.velocity.norm()
}

/// Vector limited to a length.
fn limited(v: crate::V2, length: f64) -> crate::V2 {
    let norm = v.norm();
    if norm > length {
        v * (length / norm)
    } else {
        v
    }
}
