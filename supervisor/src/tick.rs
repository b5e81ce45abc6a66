//! The tick, per unit: its body reads as the list of files.

use crate::account::severity::{Evidence, Severity};
use crate::act::handover::Readiness;
use crate::act::law::View;
use crate::act::limit::{Budget, ForceEnvelope};
use crate::act::{handover, limit};
use crate::border::coeffs::Coeffs;
use crate::border::signal::{
    CoreCommand, CoreSample, Events, IntegratorHint, Limits, Mode, RejectReason, Status,
};
use crate::decide::classify::Classifier;
use crate::decide::detect::Detector;
use crate::decide::detect::{Impact, Speed};
use crate::decide::phase::{Phase, TrustVerdict};
use crate::decide::trust::Trust;
use crate::estimate::neighbour::Neighbour;
use crate::estimate::observer::{Contact, Observer};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::Cells;
use crate::number::words::{Words as _, words_of_fields};
use crate::sense::guard::Guard;
use crate::sense::reading::Spin;
use crate::sense::reading::{Actuator, Reading, SampleFlags};

/// Contact can be avoided for good where this share of the work that force and shaft can do is enough: with a half some
/// rotors come into the middle one swing of their shaft later.
const CALM_SHARE: f32 = 0.3;

/// A square of the speed below which neither an approach nor what an impact leaves is dangerous, and the share of the cap
/// below which the levitation controller has force to spare: it goes there slowly because it wants to.
const SLOW_SQUARE: f32 = 0.05;
const SPARES_BELOW: f32 = 0.75;

/// All that a core remembers from tick to tick, but for what is recorded.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub(crate) struct State<S: Scalar> {
    pub(crate) guard: Guard<S>,
    pub(crate) observer: Observer<S>,
    pub(crate) classifier: Classifier<S>,
    pub(crate) readiness: Readiness<S>,
    pub(crate) phase: Phase<S>,
    pub(crate) trust: Trust<S>,
    pub(crate) budget: Budget<S>,
    pub(crate) severity: Severity<S>,
    /// Last command …
    pub(crate) force: Vec2<S>,
    /// … and what would have been it, which is the same but in shadow.
    pub(crate) own: Vec2<S>,
    pub(crate) detector: Detector,
    pub(crate) reconfigured: bool,
}

words_of_fields!(State<S> {
    guard,
    observer,
    classifier,
    readiness,
    phase,
    trust,
    budget,
    severity,
    force,
    own,
    detector,
    reconfigured,
});

impl<S: Scalar> State<S> {
    /// One tick: total and bounded; the one loop that depends on data makes up for at most four missed
    /// ticks.
    #[inline]
    pub(crate) fn tick(
        &mut self,
        sample: &CoreSample<S>,
        beside: &impl Neighbour<S>,
        coeffs: &Coeffs<S>,
    ) -> CoreCommand<S> {
        let coupling = beside.coupling();
        let pinned = matches!(self.phase, Phase::Pinned { .. });
        let wall = self.detector.wall(pinned);
        if let Some(coupling) = coupling {
            let gained = coupling.gained(coeffs.tick);
            self.observer.push(gained, wall, coeffs);
        }
        // An axis that does not track its command is as good as lost.
        let status = sample.status | self.observer.monitor.lost(sample.status);
        let estimated = || (self.observer.velocity(), wall != Contact::None);
        let expected = self.observer.expected(wall, coeffs);
        let reading = (self.guard).judge((sample, status), expected, estimated, coeffs);
        let assessment = reading.assessment;
        let flags = assessment.flags;
        let spin = (reading.spin, sample.spin);
        let mut sound = None;
        if flags.intersects(SampleFlags::UNUSUAL) {
            // A copy, so that the usual one stays in registers.
            let unusual = reading;
            sound = self.catch_up(&unusual, spin, coeffs);
        }
        let (position, actuator) = (reading.position(), reading.actuator());
        let touch = self.detector.sample(position, coeffs);
        let wall = self.detector.wall(pinned);
        let acting = (actuator, coupling.map(|coupling| coupling.unbalance));
        let (motion, off_axis) = (self.observer).advance(position, spin, wall, acting, coeffs);
        let envelope = ForceEnvelope::new(&self.budget, actuator.axes, coeffs);
        if self.levitates_as_usual(sample, flags, wall)
            && envelope.is_whole()
            && motion.is_at_ease(off_axis, coeffs)
        {
            return self.levitated(sample, (actuator, assessment.events), envelope, coeffs);
        }
        let margin = self.trust.margin;
        let contact = (self.detector).contact_estimate(
            (&motion, off_axis),
            touch,
            (envelope.cap, margin),
            coupling,
            coeffs,
        );
        let blind_speed = || match wall {
            Contact::Impact => self.observer.blind_speed(contact.normal, coeffs),
            _ => S::ZERO,
        };
        let seen = position.is_some();
        let rubs = self.classifier.rubs();
        let class = (self.classifier).classify(&contact, (seen, blind_speed), spin, coeffs);

        // A rotor that levitates, and will, needs none of what follows.
        let (mut speed, mut ahead, mut calm) = (Speed::default(), None, false);
        // Of the axis: an orbit is no approach, and no sign of the model either.
        let square = self.observer.velocity().length_squared();
        let flies = wall == Contact::None;
        let quiet = self.guard.innovation.is_quiet(coeffs);
        let mut verdict = TrustVerdict {
            quiet,
            hands_back: (self.trust).tick(
                (square, flies),
                (self.phase, rubs, sample.spin),
                sample.status,
                coeffs,
            ),
            rubs_on: self.trust.rubs_on(),
            touches_on: self.classifier.is_continuous(),
            has_turned: self.classifier.has_turned(),
            trusted: quiet
                && self.trust.is_granted()
                && coupling.is_none_or(|coupling| coupling.is_in_time(coeffs)),
            unsettled: quiet && coupling.is_some_and(|coupling| coupling.unsettled),
            whirl_only: !coeffs.acts_in_flight || sample.status.contains(Status::SET_DOWN),
            harmless: false,
        };
        if self.phase != Phase::Levitated || contact.unavoidable || contact.touching {
            speed = Speed::new(motion.velocity);
            let slow = if contact.touching {
                self.classifier.is_slow()
            } else {
                speed.square < S::from_f32(SLOW_SQUARE)
            };
            if slow {
                let asks = -Vec2::from_array(sample.levitation).dot(contact.normal);
                // What is no number is no force to spare.
                verdict.harmless = asks < envelope.cap * S::from_f32(SPARES_BELOW);
            }
            if contact.touching {
                let keeps_out = self.phase == Phase::Levitated && verdict.touches_on;
                if keeps_out && self.readiness.is_pressed() {
                    // It lies where the controller wants it.
                    (verdict.harmless, verdict.unsettled) = (true, false);
                }
            } else {
                ahead = Impact::ahead(&motion, contact.radius, &speed);
                let beyond = (speed.value() - margin).max(S::ZERO);
                let share = S::from_f32(CALM_SHARE);
                calm = flies && contact.can_stop_before_wall(beyond, envelope.cap, share, coeffs);
                if let Some(coupling) = coupling
                    && flies
                    && !calm
                {
                    calm = contact.nutation_avoids_contact(
                        &motion,
                        coupling,
                        (margin, envelope.cap, share),
                        coeffs,
                    );
                }
            }
        }
        let waited = self.phase.has_waited(coeffs);
        let ready = self.readiness.ready() || (waited && !self.readiness.comes_nearer());
        let patience = (calm, ready, verdict);
        let (phase, events) = (self.phase).next(&contact, patience, class, flags, coeffs);
        self.phase = phase;
        let mode = phase.mode();

        let shadow = sample.status.contains(Status::SHADOW);
        if actuator.axes.has_lost() {
            // Such an axis has no force to start from; one that does not track may have.
            let known = actuator.axes.known(sample.status);
            (self.force, self.own) = (known.carried(self.force), known.carried(self.own));
        }
        let last = if shadow { self.own } else { self.force };
        // Under impacts and in whirl nobody asks what the levitation controller wants.
        let holds = mode == Mode::Pinned || !contact.touching;
        let uses_levitation =
            holds || matches!(mode, Mode::Levitated | Mode::HandedBack | Mode::SensorFault);
        let command = Vec2::from_array(sample.levitation);
        let (levitation, levitation_limits) = if uses_levitation {
            // What it makes of a coordinate that is none takes no room from the other.
            let command = if mode == Mode::SensorFault {
                flags.sensed(command, Vec2::ZERO)
            } else {
                command
            };
            limit::levitation(command, envelope)
        } else {
            (Vec2::ZERO, Limits::empty())
        };
        // What the controller makes of such a sample does not go through.
        // A doubt counts as much as the model that it is by.
        let wrong = flags.contains(SampleFlags::ON)
            && match assessment.refusal {
                RejectReason::Doubted => verdict.trusted,
                refusal => refusal.is_wrong(),
            };
        if !phase.is_engaged() {
            if verdict.touches_on {
                let outwards = match contact.touching {
                    true => levitation.dot(contact.normal),
                    false => S::ZERO,
                };
                self.readiness.watch(outwards, coeffs);
            } else {
                self.readiness = Readiness::default();
            }
        } else if coupling.is_some() {
            self.trust.acts();
        }
        let (target, bound) = if wrong && matches!(mode, Mode::Levitated | Mode::Handover) {
            limit::within(last, envelope)
        } else if !phase.is_engaged() {
            (levitation, levitation_limits)
        } else {
            // Laid down here alone: in most ticks nobody wants a force, and all of it stays in registers.
            let mut acted_on = match coupling {
                Some(coupling) if !contact.touching => coupling.ahead(&motion, coeffs),
                _ => motion,
            };
            if calm && matches!(phase, Phase::Approach { .. }) {
                // In calm nothing else asks for the place.
                acted_on.position =
                    acted_on.position - self.readiness.rests_at(levitation, contact.normal);
            }
            let view = View {
                position: acted_on.position,
                velocity: acted_on.velocity,
                load_step: acted_on.load_step,
                speed,
                normal: contact.normal,
                per_radius: contact.per_radius,
                radial_speed: contact.radial_speed,
                tangential_speed: contact.tangential_speed,
                load: contact.load,
                touching: contact.touching,
                ahead: ahead.as_ref(),
                spin: reading.spin,
                delivered: self.observer.delivered(),
                coeffs,
            };
            let (allocated, mut own_limits) = limit::allocate(&view.demand(phase), envelope);
            if holds && !wrong {
                // The controller has to ask for what the rotor is really held with.
                let held = actuator.applied().unwrap_or(allocated);
                self.readiness
                    .compare(held, levitation, (contact.normal, contact.radius), coeffs);
            }
            let blended = match phase {
                Phase::SensorFault { bouncing } => {
                    own_limits = levitation_limits;
                    let from = sound.unwrap_or(last);
                    handover::faded(bouncing, (from, levitation), flags, envelope, coeffs)
                }
                Phase::Handover { weight } => allocated * (S::ONE - weight) + levitation * weight,
                _ => allocated,
            };
            let (target, bound) = limit::within(blended, envelope);
            (target, own_limits | bound)
        };
        let (own, slew) = limit::slewed(target, last, coeffs);
        let mut limits = bound | slew;
        self.own = own;
        let on = flags.contains(SampleFlags::ON);
        let mut integrator = handover::integrator_hint(phase, on, || {
            // It pushes outwards in flight: it carries what is gone.
            calm || (!contact.touching && command.dot(contact.normal) > S::ZERO)
        });
        if shadow {
            let (levitation, _) = limit::levitation(command, envelope);
            (self.force, _) = limit::slewed(levitation, self.force, coeffs);
            if on {
                integrator = IntegratorHint::Run;
            }
            self.observer.monitor.switched_off();
        } else {
            self.force = own;
        }
        if position.is_none() {
            limits |= Limits::SAMPLE_REFUSED;
        }
        self.observer.commanded(self.force);
        let acting = actuator.acting(self.force);
        self.budget.spend(S::ONE, acting, coeffs);
        let evidence = Evidence {
            fresh: motion.fresh,
            contact: &contact,
            ahead: ahead.as_ref(),
            spin: reading.spin,
            coeffs,
        };
        let forces = (acting, self.observer.velocity());
        let severity = (self.severity).assess(mode, &evidence, flags, forces);

        let mut events = events | assessment.events | severity.events;
        if core::mem::take(&mut self.reconfigured) {
            events |= Events::RECONFIGURED;
        }
        limits |= severity.limits;
        CoreCommand {
            force: self.force.to_array(),
            own: self.own.to_array(),
            mode,
            limits,
            events,
            integrator,
            severity: severity.severity,
        }
    }

    /// Whether nothing but a levitated rotor has to be looked at.
    #[inline]
    fn levitates_as_usual(
        &self,
        sample: &CoreSample<S>,
        flags: SampleFlags,
        wall: Contact,
    ) -> bool {
        self.phase == Phase::Levitated
            && flags & SampleFlags::AT_EASE.1 == SampleFlags::AT_EASE.0
            && wall == Contact::None
            && !sample.status.contains(Status::SHADOW)
            && !self.reconfigured
            && !self.classifier.is_continuous()
    }

    /// Most ticks: a rotor at ease is left to its levitation. To the bit what the rest of the tick comes to.
    #[inline]
    fn levitated(
        &mut self,
        sample: &CoreSample<S>,
        (actuator, events): (Actuator<S>, Events),
        envelope: ForceEnvelope<S>,
        coeffs: &Coeffs<S>,
    ) -> CoreCommand<S> {
        let velocity = self.observer.velocity();
        let rubs = self.classifier.rubs();
        self.detector.rest();
        self.classifier.flies(coeffs);
        (self.trust).tick(
            (velocity.length_squared(), true),
            (self.phase, rubs, sample.spin),
            sample.status,
            coeffs,
        );
        let command = Vec2::from_array(sample.levitation);
        let (levitation, bound) = limit::levitation(command, envelope);
        let (force, slew) = limit::slewed(levitation, self.force, coeffs);
        (self.force, self.own) = (force, force);
        self.observer.commanded(force);
        self.budget.spend(S::ONE, actuator.acting(force), coeffs);
        self.severity.levitated(velocity);
        CoreCommand {
            force: force.to_array(),
            own: force.to_array(),
            mode: Mode::Levitated,
            limits: bound | slew,
            events,
            integrator: IntegratorHint::Run,
            severity: S::ZERO,
        }
    }

    /// What a tick has to make up for: commands that came too late, ticks that were missed, an estimate that
    /// cannot go on. Where a fault of the sensor begins: the force that fades.
    #[cold]
    fn catch_up(
        &mut self,
        reading: &Reading<S>,
        spin: (Spin, S),
        coeffs: &Coeffs<S>,
    ) -> Option<Vec2<S>> {
        let assessment = reading.assessment;
        let flags = assessment.flags;
        let begins =
            flags.contains(SampleFlags::FAULTY) && !matches!(self.phase, Phase::SensorFault { .. });
        // One that was no number has never been believed.
        let lied = begins && assessment.refusal == RejectReason::Stuck;
        let sound = lied.then(|| self.observer.sound_force(flags));
        if flags.contains(SampleFlags::LATE) {
            self.observer.late();
        }
        if assessment.missed > 0 {
            let missed = u32::from(assessment.missed);
            self.observer
                .bridge(missed, self.force, (reading.position(), spin), coeffs);
            let acting = reading.actuator().acting(self.force);
            (self.budget).spend(S::count(missed), acting, coeffs);
        }
        let lost = flags.contains(SampleFlags::FAULTY) && !flags.contains(SampleFlags::USED);
        if flags.intersects(SampleFlags::ANEW | SampleFlags::MISSED) {
            self.observer.monitor.unseen();
        }
        if flags.contains(SampleFlags::ANEW) || lost {
            self.observer.forget();
            self.classifier.forget();
        }
        sound
    }

    /// After a change of units and coefficients. What a speed and the severity index are multiplied by.
    pub(crate) fn rescale(&mut self, old: &Coeffs<S>, new: &Coeffs<S>) -> (S, f32) {
        // What a sensor showed is now at another place in another unit.
        let length = new.scaling.position_per_m / old.scaling.position_per_m;
        let [new_s, old_s] = [new, old].map(|coeffs| coeffs.scaling.time_s);
        let speed = length * new_s / old_s;
        let tick = (new_s * new.tick.to_f32()) / (old_s * old.tick.to_f32());
        let force = old.scaling.force_n / new.scaling.force_n;
        let index = old.severity_limit / new.severity_limit;
        self.guard.rescale(S::from_f32(length));
        self.trust.rescale(S::from_f32(speed));
        (self.observer).rescale(
            S::from_f32(length),
            S::from_f32(speed),
            S::from_f32(tick),
            S::from_f32(force),
        );
        self.readiness.rescale(S::from_f32(force));
        self.budget.rescale(force);
        self.severity.rescale(S::from_f32(speed), index);
        self.reconfigured = true;
        // A cap that is smaller now holds at once; what the budget leaves of it is come down to by the slew limit, as ever.
        let envelope = ForceEnvelope::below(S::ONE, SampleFlags::empty(), new);
        let held = |last: Vec2<S>| limit::levitation(last * S::from_f32(force), envelope).0;
        (self.force, self.own) = (held(self.force), held(self.own));
        (S::from_f32(speed), index)
    }

    /// Lays all of it down. Once, for who keeps it and for who writes down a new one.
    #[inline(never)]
    pub(crate) fn write_all<const WORDS: usize>(&self, cells: &Cells<WORDS>) {
        self.write_cells(cells.all(), 0);
    }

    /// The severity in words of the whole.
    pub(crate) fn severity_in(words: impl Iterator<Item = u32>) -> Severity<S> {
        let Self {
            guard,
            observer,
            classifier,
            readiness,
            phase,
            trust,
            budget,
            ..
        } = &Self::default();
        let before = guard.word_count()
            + observer.word_count()
            + classifier.word_count()
            + readiness.word_count()
            + phase.word_count()
            + trust.word_count()
            + budget.word_count();
        Severity::decode(&mut words.skip(before as usize))
    }

    /// Where the axis is by the estimate, and whether it touches.
    #[inline]
    pub(crate) fn whereabouts(&self) -> (Vec2<S>, bool) {
        (self.observer.position(), self.detector.is_touching())
    }
}
