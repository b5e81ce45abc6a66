//! Carries a plant from control sample to control sample, mode by mode.

use super::contact_step::ContactStepper;
use super::flight::Crossing;
use crate::energy::{Audit, Flows};
use crate::integrate::{Options, PlantError};
use crate::magnet::Amplifier;
use crate::mode::{Mode, Phase, Slide, Whirl};
use crate::part::Part;
use crate::readout::{Meters, Snapshot, Work};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{Geometry, Inputs, NORMAL, SLIDE, SLIDE_LOW, StateOf, System, WHIRL};

/// A run of one combination of parts.
pub(crate) struct Run<S: Stator, W: Spin, M: Amplifier> {
    pub(crate) system: System<S, W, M>,
    pub(crate) force_max_n: f64,
    pub(crate) t_s: f64,
    pub(crate) y: StateOf<S, W, M>,
    pub(crate) phase: Phase,
    pub(crate) flows: Flows,
    pub(crate) meters: Meters,
    stepper: ContactStepper<S, W, M>,
    inputs: Inputs,
    /// Sense of backward whirl: against the spin at the start, which friction may reverse later.
    backward: f64,
    stored_at_start_j: f64,
    stored_peak_j: f64,
    options: Options,
    events_without_progress: u32,
}

impl<S: Stator, W: Spin, M: Amplifier> Run<S, W, M> {
    pub(crate) fn new(
        system: System<S, W, M>,
        y: StateOf<S, W, M>,
        force_max_n: f64,
        options: Options,
    ) -> Self {
        let mut run = Self {
            stepper: ContactStepper::new(&system, options.rtol, y.rotor.velocity.norm()),
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
            options,
            events_without_progress: 0,
        };
        if run.system.spin.spin_rad_s(&run.y.spin) >= 0.0 {
            run.backward = -1.0;
        }
        let g = run.system.geometry(&run.y);
        if g.penetration_m > 0.0 {
            run.phase = match run.normal_n(&g) > 0.0 {
                true => run.settle(false, false),
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
        (self.system.contact).normal_force_n(g.penetration_m, g.normal_speed_m_s)
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
        let mut work = 0_u32;
        while self.t_s < t_end_s {
            work += 1;
            if work > self.options.steps_per_sample {
                return Err(PlantError::WorkLimit {
                    t_s: self.t_s,
                    steps: self.options.steps_per_sample,
                });
            }
            let before = (self.t_s, self.phase);
            match self.phase {
                Phase::Inside => self.fly_inside(t_end_s),
                Phase::Beyond => self.fly_beyond(t_end_s),
                Phase::Contact(slide, whirl) => self.touch(t_end_s, (slide, whirl))?,
            }
            if !self.y.is_finite() {
                return Err(PlantError::NotFinite { t_s: self.t_s });
            }
            self.stored_peak_j =
                (self.system.stored_j(&self.y, self.in_contact()).abs()).max(self.stored_peak_j);
            if self.phase != before.1 {
                self.count_progress(self.t_s > before.0)?;
            }
            if self.phase.mode() != before.1.mode() {
                on_change(&self.snapshot());
            }
        }
        Ok(())
    }

    /// Modes may follow each other at one instant, but not for ever.
    fn count_progress(&mut self, moved: bool) -> Result<(), PlantError> {
        if moved {
            self.events_without_progress = 0;
            return Ok(());
        }
        self.events_without_progress += 1;
        if self.events_without_progress > 20 {
            return Err(PlantError::ModeUndecided { t_s: self.t_s });
        }
        Ok(())
    }

    fn fly_inside(&mut self, t_end_s: f64) {
        let remaining = t_end_s - self.t_s;
        let step = remaining.min(self.system.longest_flight_s(&self.y, remaining));
        let last = step >= remaining;
        let segment = self.system.fly(self.t_s, &self.y, &self.inputs, step);
        let (theta, hit) = match segment.wall_crossing(self.system.contact.clearance_m) {
            Crossing::Nowhere => (1.0, false),
            Crossing::At(theta) => (theta, true),
            Crossing::ClearUntil(theta) => (theta.min(1.0), false),
        };
        let end = self.system.flown(&segment, &self.y, theta);
        let flows = (self.system).flight_flows(&segment, &self.y, &end, &self.inputs, theta);
        self.flows.add_scaled(1.0, &flows);
        self.y = end;
        self.t_s = if last && theta == 1.0 {
            t_end_s
        } else {
            self.t_s + theta * step
        };
        if hit {
            self.meters.impacts += 1;
            let g = self.system.geometry(&self.y);
            self.meters.peak_impact_speed_m_s =
                self.meters.peak_impact_speed_m_s.max(g.normal_speed_m_s);
            self.phase = self.settle(false, false);
        }
    }

    /// The wall is still dented but the force is gone. Short: the rotor leaves at impact speed.
    fn fly_beyond(&mut self, t_end_s: f64) {
        const SCANS: u32 = 16;
        let remaining = t_end_s - self.t_s;
        let mut step = remaining.min(self.system.longest_flight_s(&self.y, remaining));
        let g = self.system.geometry(&self.y);
        let leave_s = g.penetration_m / g.normal_speed_m_s.abs();
        step = step.min((2.0 * leave_s).max(1e-6 / self.system.contact_rate_rad_s()));
        let last = step >= remaining;
        let segment = self.system.fly(self.t_s, &self.y, &self.inputs, step);
        // Positive while beyond: (penetration, lack of force).
        let room = |theta: f64| {
            let g = self
                .system
                .geometry(&self.system.flown(&segment, &self.y, theta));
            (g.penetration_m, -self.normal_n(&g))
        };
        let mut theta = 1.0;
        let mut next = Phase::Beyond;
        let mut valid = 0.0;
        for i in 1..=SCANS {
            let at = f64::from(i) / f64::from(SCANS);
            let (inside, force) = room(at);
            if inside <= 0.0 || force < 0.0 {
                let leaves = inside <= 0.0;
                let hold = |th: f64| {
                    if leaves {
                        room(th).0 > 0.0
                    } else {
                        room(th).1 >= 0.0
                    }
                };
                theta = bisect(valid, at, hold);
                next = if leaves {
                    Phase::Inside
                } else {
                    Phase::Contact(Slide::Rolling, Whirl::Still)
                };
                break;
            }
            valid = at;
        }
        let end = self.system.flown(&segment, &self.y, theta);
        let flows = (self.system).flight_flows(&segment, &self.y, &end, &self.inputs, theta);
        self.flows.add_scaled(1.0, &flows);
        self.y = end;
        self.t_s = if last && theta == 1.0 {
            t_end_s
        } else {
            self.t_s + theta * step
        };
        if matches!(next, Phase::Contact(..)) {
            // The dent whose energy was written off at lift-off is felt again.
            let g = self.system.geometry(&self.y);
            self.flows.contact_damping -= self.system.contact.stored_j(g.penetration_m);
            self.phase = self.settle(false, false);
        } else {
            self.phase = next;
        }
    }

    fn touch(&mut self, t_end_s: f64, pair: (Slide, Whirl)) -> Result<(), PlantError> {
        let outcome = self.stepper.step(
            &self.system,
            (self.t_s, t_end_s),
            &self.y,
            &self.inputs,
            pair,
        )?;
        self.flows.add_scaled(1.0, &outcome.flows);
        self.meters
            .contact_step(&outcome.start, &outcome.end, outcome.step_s, outcome.turn);
        let backward = self.backward * outcome.end.whirl_speed_m_s;
        self.meters.peak_backward_speed_m_s = self.meters.peak_backward_speed_m_s.max(backward);
        let radius = self.system.rotor.contact_radius_m;
        self.meters.peak_friction_torque_n_m =
            (self.meters.peak_friction_torque_n_m).max(outcome.end.sliding_n.abs() * radius);
        self.y = outcome.y;
        self.t_s = outcome.t_s;
        match outcome.event {
            None => {}
            Some(NORMAL) => self.lift_off(),
            Some(guard) => self.phase = self.next_in_contact(pair, guard),
        }
        if let Phase::Contact(slide, whirl) = self.phase {
            self.hold_constraints(slide, whirl);
        }
        Ok(())
    }

    fn lift_off(&mut self) {
        let g = self.system.geometry(&self.y);
        self.phase = if self.system.contact.damping_n_s_m > 0.0 && g.penetration_m > 0.0 {
            // The dent relaxes on the contact damper alone.
            self.flows.contact_damping += self.system.contact.stored_j(g.penetration_m);
            Phase::Beyond
        } else {
            Phase::Inside
        };
    }

    fn next_in_contact(&self, (slide, whirl): (Slide, Whirl), guard: usize) -> Phase {
        match guard {
            SLIDE if slide == Slide::Rolling => Phase::Contact(Slide::Negative, whirl),
            SLIDE_LOW => Phase::Contact(Slide::Positive, whirl),
            SLIDE => self.settle(true, whirl == Whirl::Still),
            WHIRL if whirl == Whirl::Still => Phase::Contact(slide, Whirl::Negative),
            WHIRL => self.settle(slide == Slide::Rolling, true),
            // WHIRL_LOW: the force needed to hold the whirl is at the lower edge of the cone.
            _ => Phase::Contact(slide, Whirl::Positive),
        }
    }

    /// The contact mode that is consistent just after this instant, given which speeds are known to
    /// be zero. Forces are judged a moment later, because at a touch they all start from zero.
    fn settle(&self, slide_at_zero: bool, whirl_at_zero: bool) -> Phase {
        let g = self.system.geometry(&self.y);
        let speed = self.y.rotor.velocity.norm();
        let zero = 1e-13 * speed;
        let slide_at_zero = slide_at_zero || g.sliding_speed_m_s.abs() <= zero;
        let whirl_at_zero = whirl_at_zero || g.whirl_speed_m_s.abs() <= zero;
        let slides: &[Slide] = if slide_at_zero {
            &[Slide::Rolling, Slide::Positive, Slide::Negative]
        } else {
            &[Slide::of(g.sliding_speed_m_s)]
        };
        let whirls: &[Whirl] = if self.system.friction.rolling_coefficient == 0.0 {
            &[Whirl::Ignored]
        } else if whirl_at_zero {
            &[Whirl::Still, Whirl::Positive, Whirl::Negative]
        } else {
            &[Whirl::of(g.whirl_speed_m_s)]
        };
        let moment_s = 1e-6 / self.system.contact_rate_rad_s();
        for &slide in slides {
            for &whirl in whirls {
                let pair = (slide, whirl);
                let now = self.system.contact(self.t_s, &self.y, &self.inputs, pair);
                let mut later = self.y;
                later.add_scaled(moment_s, &now.rates);
                let e = self
                    .system
                    .contact(self.t_s + moment_s, &later, &self.inputs, pair);
                let slide_holds = match slide {
                    Slide::Rolling => e.guards[SLIDE] >= 0.0 && e.guards[SLIDE_LOW] >= 0.0,
                    _ => !slide_at_zero || slide.sign() * e.touch.sliding_acceleration >= 0.0,
                };
                let whirl_holds = match whirl {
                    Whirl::Still => e.guards[WHIRL].min(e.guards[WHIRL + 1]) >= 0.0,
                    _ => !whirl_at_zero || whirl.sign() * e.touch.whirl_acceleration >= 0.0,
                };
                if slide_holds && whirl_holds {
                    return Phase::Contact(slide, whirl);
                }
            }
        }
        Phase::Contact(slides[0], whirls[0])
    }

    /// Removes the drift of a speed that the mode holds at zero; it is within the tolerance.
    fn hold_constraints(&mut self, slide: Slide, whirl: Whirl) {
        if slide != Slide::Rolling && whirl != Whirl::Still {
            return;
        }
        let g = self.system.geometry(&self.y);
        let mut whirl_speed = g.whirl_speed_m_s;
        if whirl == Whirl::Still {
            self.y.rotor.velocity -= whirl_speed * g.tangent;
            whirl_speed = 0.0;
        }
        if slide == Slide::Rolling {
            let spin = -whirl_speed / self.system.rotor.contact_radius_m;
            let is_state = self.system.spin.set_spin_rad_s(&mut self.y.spin, spin);
            if !is_state && whirl != Whirl::Still {
                self.y.rotor.velocity -= g.sliding_speed_m_s * g.tangent;
            }
        }
    }

    pub(crate) fn snapshot(&self) -> Snapshot {
        let g = self.system.geometry(&self.y);
        let ring = S::inner(&self.y.stator);
        let outer = S::outer(&self.y.stator);
        let mut snapshot = Snapshot {
            t_s: self.t_s,
            position_m: self.y.rotor.position,
            velocity_m_s: self.y.rotor.velocity,
            inner_ring: ring,
            outer_ring: outer.unwrap_or_default(),
            spin_rad_s: self.system.spin.spin_rad_s(&self.y.spin),
            mode: self.phase.mode(),
            penetration_m: g.penetration_m,
            normal_force_n: 0.0,
            sliding_force_n: 0.0,
            rolling_force_n: 0.0,
            contact_tangential_speed_m_s: g.whirl_speed_m_s,
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

    pub(crate) fn mode(&self) -> Mode {
        self.phase.mode()
    }

    pub(crate) fn audit(&self) -> Audit {
        Audit {
            flows: self.flows,
            stored_at_start_j: self.stored_at_start_j,
            stored_j: self.system.stored_j(&self.y, self.in_contact()),
            stored_peak_j: self.stored_peak_j.max(self.stored_at_start_j.abs()),
        }
    }

    pub(crate) fn work(&self) -> Work {
        self.stepper.work
    }
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

/// Last θ in [low, high] for which `holds` is true, to round-off; `holds(low)` is taken for granted.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
