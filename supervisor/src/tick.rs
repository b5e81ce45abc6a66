//! The tick, per unit: its stages read as the list of files.

use crate::account::severity::{Evidence, Severity};
use crate::act::handover::{self, Readiness};
use crate::act::law::View;
use crate::act::limit::{self, Budget, ForceEnvelope};
use crate::border::coeffs::Coeffs;
use crate::border::signal::{
    CoreCommand, CoreSample, Events, IntegratorHint, Limits, Mode, RejectReason, Status,
};
use crate::decide::classify::Classifier;
use crate::decide::detect::{ContactEstimate, Detector, Impact, Speed, StopTest, Touch};
use crate::decide::phase::{Phase, Verdict};
use crate::decide::trust::{self, Trust};
use crate::estimate::neighbour::{Neighbour, RotorCoupling};
use crate::estimate::observer::{Contact, Motion, Observer};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::{Cells, Words as _, words_of_fields};
use crate::sense::guard::{Guard, LastVelocity};
use crate::sense::reading::{Reading, SampleFlags};

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

/// What the rotor does by the sample and the model.
struct Estimated<S> {
    motion: Motion<S>,
    /// How far the axis is beside what moves.
    off_axis: S,
    wall: Contact,
    touch: Touch,
}

/// What comes of that: the phase itself is in the state.
struct Decided {
    /// It touches most of the time.
    touches_on: bool,
    /// The reading may be acted on.
    trusted: bool,
    events: Events,
}

/// Where the rotor goes; nothing of one that levitates, and will.
#[derive(Clone, Copy, Default)]
struct Path<S> {
    speed: Speed<S>,
    /// The next impact in flight.
    ahead: Option<Impact<S>>,
    /// Contact can be avoided.
    calm: bool,
}

/// What is commanded.
struct Acted {
    limits: Limits,
    integrator: IntegratorHint,
}

/// What a stage is given beside what the ones before it have found.
struct Given<'a, S: Scalar> {
    sample: &'a CoreSample<S>,
    reading: Reading<S>,
    /// What the rest of a rotor does to this plane, where there is one.
    coupling: Option<&'a RotorCoupling<S>>,
    /// Where a fault of the sensor begins: the force that fades.
    sound: Option<Vec2<S>>,
    coeffs: &'a Coeffs<S>,
}

impl<S: Scalar> Given<'_, S> {
    #[inline(always)]
    fn flags(&self) -> SampleFlags {
        self.reading.assessment.flags
    }

    /// Whether what the controller makes of the sample must not go through. A doubt counts as much as the model that it is by.
    #[inline(always)]
    fn is_wrong(&self, trusted: bool) -> bool {
        self.flags().contains(SampleFlags::ON)
            && match self.reading.assessment.refusal {
                RejectReason::Doubted => trusted,
                refusal => refusal.is_wrong(),
            }
    }
}

impl<S: Scalar> State<S> {
    /// One tick: total and bounded; the one loop that depends on data makes up for at most four missed
    /// ticks.
    #[inline]
    pub(crate) fn tick(
        &mut self,
        sample: &CoreSample<S>,
        neighbour: &impl Neighbour<S>,
        coeffs: &Coeffs<S>,
    ) -> CoreCommand<S> {
        let given = &self.sense(sample, neighbour.coupling(), coeffs);
        let estimated = self.estimate(given);
        let envelope = ForceEnvelope::new(&self.budget, given.flags(), coeffs);
        if self.levitates_as_usual(given, estimated.wall)
            && envelope.is_whole()
            && (estimated.motion).is_at_ease(estimated.off_axis, coeffs)
        {
            return self.levitated(given, envelope);
        }
        let contact = self.detect(given, &estimated, envelope);
        let path = self.path(given, &estimated, &contact, envelope);
        let decided = self.decide(given, &estimated, &contact, &path, envelope);
        let acted = self.act(given, &estimated, &contact, &path, &decided, envelope);
        self.account(given, &estimated, &contact, &path, &decided, acted)
    }

    /// Judges the sample, and makes up for what it says was missed.
    #[inline(always)]
    fn sense<'a>(
        &mut self,
        sample: &'a CoreSample<S>,
        coupling: Option<&'a RotorCoupling<S>>,
        coeffs: &'a Coeffs<S>,
    ) -> Given<'a, S> {
        let wall = self.detector.wall(self.is_pinned());
        if let Some(coupling) = coupling {
            let gained = coupling.gained(coeffs.tick);
            self.observer.push(gained, wall, coeffs);
        }
        // An axis that does not track its command is as good as lost.
        let status = sample.status | self.observer.monitor.lost(sample.status);
        let last = || LastVelocity {
            velocity: self.observer.velocity(),
            in_contact: wall != Contact::None,
        };
        let expected = self.observer.expected(wall, coeffs);
        let reading = (self.guard).judge(sample, status, expected, last, coeffs);
        let mut sound = None;
        if reading.assessment.flags.intersects(SampleFlags::UNUSUAL) {
            // A copy, so that the usual one stays in registers.
            let unusual = reading;
            sound = self.catch_up(&unusual, coeffs);
        }
        Given {
            sample,
            reading,
            coupling,
            sound,
            coeffs,
        }
    }

    /// Looks for contact, and carries the motion on.
    #[inline(always)]
    fn estimate(&mut self, given: &Given<'_, S>) -> Estimated<S> {
        let coeffs = given.coeffs;
        let (reading, position) = (&given.reading, given.reading.position());
        let touch = self.detector.sample(position, coeffs);
        let wall = self.detector.wall(self.is_pinned());
        let tilted = given.coupling.map(|coupling| coupling.unbalance);
        let (rotation, actuator) = (reading.rotation, reading.actuator());
        let (motion, off_axis) =
            (self.observer).advance(position, rotation, wall, actuator, tilted, coeffs);
        Estimated {
            motion,
            off_axis,
            wall,
            touch,
        }
    }

    /// Whether it touches, and whether it will.
    #[inline(always)]
    fn detect(
        &mut self,
        given: &Given<'_, S>,
        estimated: &Estimated<S>,
        envelope: ForceEnvelope<S>,
    ) -> ContactEstimate<S> {
        let test = StopTest {
            force: envelope.cap,
            share: S::ONE,
            margin: self.trust.margin,
        };
        let (motion, coeffs) = (&estimated.motion, given.coeffs);
        let (beside, touch) = (estimated.off_axis, estimated.touch);
        (self.detector).contact_estimate(motion, beside, touch, test, given.coupling, coeffs)
    }

    /// What kind of contact it is, where it leads, and which phase follows.
    #[inline(always)]
    fn decide(
        &mut self,
        given: &Given<'_, S>,
        estimated: &Estimated<S>,
        contact: &ContactEstimate<S>,
        path: &Path<S>,
        envelope: ForceEnvelope<S>,
    ) -> Decided {
        let (coeffs, wall) = (given.coeffs, estimated.wall);
        let blind_speed = || match wall {
            Contact::Impact => self.observer.blind_speed(contact.normal, coeffs),
            _ => S::ZERO,
        };
        let seen = given.reading.position().is_some();
        let rubs = self.classifier.rubs();
        let rotation = given.reading.rotation;
        let class = (self.classifier).classify(contact, seen, blind_speed, rotation, coeffs);
        let mut verdict = self.verdict(given, wall, rubs);
        verdict.calm = path.calm;
        if self.needs_decision(contact) {
            let keeps_out = self.phase == Phase::Levitated && verdict.touches_on;
            if contact.touching && keeps_out && self.readiness.is_pressed() {
                // It lies where the controller wants it.
                (verdict.harmless, verdict.unsettled) = (true, false);
            } else {
                verdict.harmless = self.is_harmless(given, estimated, contact, envelope);
            }
        }
        let waited = self.phase.has_waited(coeffs);
        verdict.ready = self.readiness.ready() || (waited && !self.readiness.comes_nearer());
        let (phase, events) = (self.phase).next(contact, &verdict, class, given.flags(), coeffs);
        self.phase = phase;
        Decided {
            touches_on: verdict.touches_on,
            trusted: verdict.trusted,
            events,
        }
    }

    /// What the judge of the model says.
    #[inline(always)]
    fn verdict(&mut self, given: &Given<'_, S>, wall: Contact, rubs: bool) -> Verdict {
        let (sample, coupling, coeffs) = (given.sample, given.coupling, given.coeffs);
        let quiet = self.guard.innovation.is_quiet(coeffs);
        let seen = trust::Seen {
            // Of the axis: an orbit is no approach, and no sign of the model either.
            speed_square: self.observer.velocity().length_squared(),
            flies: wall == Contact::None,
            phase: self.phase,
            rubs,
            spin: sample.spin,
            status: sample.status,
        };
        let hands_back = self.trust.tick(&seen, coeffs);
        Verdict {
            calm: false,
            ready: false,
            quiet,
            hands_back,
            rubs_on: self.trust.rubs_on(),
            touches_on: self.classifier.is_continuous(),
            has_turned: self.classifier.has_turned(),
            trusted: quiet
                && self.trust.is_granted()
                && coupling.is_none_or(|coupling| coupling.is_in_time(coeffs)),
            unsettled: quiet && coupling.is_some_and(|coupling| coupling.unsettled),
            whirl_only: !coeffs.acts_in_flight || sample.status.contains(Status::SET_DOWN),
            harmless: false,
        }
    }

    /// Whether what comes, or is there, is so slow that a controller with force to spare can have it.
    #[inline(always)]
    fn is_harmless(
        &self,
        given: &Given<'_, S>,
        estimated: &Estimated<S>,
        contact: &ContactEstimate<S>,
        envelope: ForceEnvelope<S>,
    ) -> bool {
        let slow = if contact.touching {
            self.classifier.is_slow()
        } else {
            estimated.motion.velocity.length_squared() < S::from_f32(SLOW_SQUARE)
        };
        let asks = -Vec2::from_array(given.sample.levitation).dot(contact.normal);
        // What is no number is no force to spare.
        slow && asks < envelope.cap * S::from_f32(SPARES_BELOW)
    }

    /// A rotor that levitates, and will, needs none.
    #[inline(always)]
    fn needs_decision(&self, contact: &ContactEstimate<S>) -> bool {
        self.phase != Phase::Levitated || contact.unavoidable || contact.touching
    }

    /// The next impact, and whether contact can be avoided.
    #[inline(always)]
    fn path(
        &self,
        given: &Given<'_, S>,
        estimated: &Estimated<S>,
        contact: &ContactEstimate<S>,
        envelope: ForceEnvelope<S>,
    ) -> Path<S> {
        let (motion, coeffs) = (&estimated.motion, given.coeffs);
        if !self.needs_decision(contact) {
            return Path::default();
        }
        let speed = Speed::new(motion.velocity);
        let (mut ahead, mut calm) = (None, false);
        if !contact.touching {
            ahead = Impact::ahead(motion, contact.radius, &speed);
            if estimated.wall == Contact::None {
                let test = StopTest {
                    force: envelope.cap,
                    share: S::from_f32(CALM_SHARE),
                    margin: self.trust.margin,
                };
                let beyond = (speed.value() - test.margin).max(S::ZERO);
                calm = contact.can_stop_before_wall(beyond, test, coeffs);
                if let Some(coupling) = given.coupling
                    && !calm
                {
                    calm = contact.nutation_avoids_contact(motion, coupling, test, coeffs);
                }
            }
        }
        Path { speed, ahead, calm }
    }

    /// The force of the phase, within all limits.
    #[inline(always)]
    fn act(
        &mut self,
        given: &Given<'_, S>,
        estimated: &Estimated<S>,
        contact: &ContactEstimate<S>,
        path: &Path<S>,
        decided: &Decided,
        envelope: ForceEnvelope<S>,
    ) -> Acted {
        let (sample, flags, coeffs) = (given.sample, given.flags(), given.coeffs);
        let mode = self.phase.mode();
        let shadow = flags.contains(SampleFlags::SHADOW);
        if flags.has_lost() {
            // Such an axis has no force to start from; one that does not track may have.
            let known = flags.known(sample.status);
            (self.force, self.own) = (known.carried(self.force), known.carried(self.own));
        }
        let last = if shadow { self.own } else { self.force };
        let command = Vec2::from_array(sample.levitation);
        let (levitation, levitation_limits) = if self.uses_levitation(contact.touching) {
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
        let wrong = given.is_wrong(decided.trusted);
        if !self.phase.is_engaged() {
            self.watch_controller(contact, decided.touches_on, levitation, coeffs);
        } else if given.coupling.is_some() {
            self.trust.acts();
        }
        let (target, bound) = if wrong && matches!(mode, Mode::Levitated | Mode::Handover) {
            limit::within(last, envelope)
        } else if !self.phase.is_engaged() {
            (levitation, levitation_limits)
        } else {
            let (allocated, mut limits) =
                self.allocated(given, estimated, contact, path, levitation, envelope);
            if !wrong && self.uses_own_force(contact.touching) {
                // The controller has to ask for what the rotor is really held with.
                let held = given.reading.actuator().applied().unwrap_or(allocated);
                self.readiness
                    .compare(held, levitation, contact.normal, contact.radius, coeffs);
            }
            let blended = match self.phase {
                Phase::SensorFault { bouncing } => {
                    limits = levitation_limits;
                    let from = given.sound.unwrap_or(last);
                    handover::faded(bouncing, from, levitation, flags, envelope, coeffs)
                }
                Phase::Handover { weight } => allocated * (S::ONE - weight) + levitation * weight,
                _ => allocated,
            };
            let (target, bound) = limit::within(blended, envelope);
            (target, limits | bound)
        };
        let (own, slew) = limit::slewed(target, last, coeffs);
        self.own = own;
        let on = flags.contains(SampleFlags::ON);
        let mut integrator = handover::integrator_hint(self.phase, on, || {
            // It pushes outwards in flight: it carries what is gone.
            path.calm || (!contact.touching && command.dot(contact.normal) > S::ZERO)
        });
        if shadow {
            self.only_watch(command, envelope, coeffs);
            if on {
                integrator = IntegratorHint::Run;
            }
        } else {
            self.force = own;
        }
        Acted {
            limits: bound | slew,
            integrator,
        }
    }

    /// In shadow the levitation command goes through, within the limits.
    #[inline(always)]
    fn only_watch(&mut self, command: Vec2<S>, envelope: ForceEnvelope<S>, coeffs: &Coeffs<S>) {
        let (levitation, _) = limit::levitation(command, envelope);
        (self.force, _) = limit::slewed(levitation, self.force, coeffs);
        self.observer.monitor.switched_off();
    }

    /// Whether a controller that has the bearing presses the rotor onto the wall by itself.
    #[inline(always)]
    fn watch_controller(
        &mut self,
        contact: &ContactEstimate<S>,
        touches_on: bool,
        levitation: Vec2<S>,
        coeffs: &Coeffs<S>,
    ) {
        if touches_on {
            let outwards = match contact.touching {
                true => levitation.dot(contact.normal),
                false => S::ZERO,
            };
            self.readiness.watch(outwards, coeffs);
        } else {
            self.readiness = Readiness::default();
        }
    }

    /// What the law wants, within the envelope.
    #[inline(always)]
    fn allocated(
        &self,
        given: &Given<'_, S>,
        estimated: &Estimated<S>,
        contact: &ContactEstimate<S>,
        path: &Path<S>,
        levitation: Vec2<S>,
        envelope: ForceEnvelope<S>,
    ) -> (Vec2<S>, Limits) {
        let coeffs = given.coeffs;
        // Laid down here alone: in most ticks nobody wants a force, and all of it stays in registers.
        let mut acted_on = match given.coupling {
            Some(coupling) if !contact.touching => coupling.ahead(&estimated.motion, coeffs),
            _ => estimated.motion,
        };
        if path.calm && matches!(self.phase, Phase::Approach { .. }) {
            // In calm nothing else asks for the place.
            acted_on.position =
                acted_on.position - self.readiness.rests_at(levitation, contact.normal);
        }
        let view = View {
            position: acted_on.position,
            velocity: acted_on.velocity,
            load_step: acted_on.load_step,
            speed: path.speed,
            normal: contact.normal,
            per_radius: contact.per_radius,
            radial_speed: contact.radial_speed,
            tangential_speed: contact.tangential_speed,
            load: contact.load,
            touching: contact.touching,
            ahead: path.ahead.as_ref(),
            spin: given.reading.rotation.sense,
            delivered: self.observer.delivered(),
            coeffs,
        };
        limit::allocate(&view.demand(self.phase), envelope)
    }

    /// Under impacts and in whirl nobody asks what the levitation controller wants.
    #[inline(always)]
    fn uses_levitation(&self, touching: bool) -> bool {
        self.uses_own_force(touching)
            || matches!(
                self.phase.mode(),
                Mode::Levitated | Mode::HandedBack | Mode::SensorFault
            )
    }

    /// Whether the rotor is held, so that two forces that hold it can be compared.
    #[inline(always)]
    fn uses_own_force(&self, touching: bool) -> bool {
        self.is_pinned() || !touching
    }

    #[inline(always)]
    fn is_pinned(&self) -> bool {
        matches!(self.phase, Phase::Pinned { .. })
    }

    /// What the tick costs the magnet and the bearing, and what it answers.
    #[inline(always)]
    fn account(
        &mut self,
        given: &Given<'_, S>,
        estimated: &Estimated<S>,
        contact: &ContactEstimate<S>,
        path: &Path<S>,
        decided: &Decided,
        acted: Acted,
    ) -> CoreCommand<S> {
        let (coeffs, assessment) = (given.coeffs, &given.reading.assessment);
        let mut limits = acted.limits;
        if given.reading.position().is_none() {
            limits |= Limits::SAMPLE_REFUSED;
        }
        self.observer.commanded(self.force);
        let acting = given.reading.actuator().acting(self.force);
        self.budget.spend(S::ONE, acting, coeffs);
        let mode = self.phase.mode();
        let evidence = Evidence {
            fresh: estimated.motion.fresh,
            contact,
            ahead: path.ahead.as_ref(),
            spin: given.reading.rotation.sense,
            acting,
            velocity: self.observer.velocity(),
            coeffs,
        };
        let severity = (self.severity).assess(mode, &evidence, assessment.flags);
        let mut events = decided.events | assessment.events | severity.events;
        if core::mem::take(&mut self.reconfigured) {
            events |= Events::RECONFIGURED;
        }
        CoreCommand {
            force: self.force.to_array(),
            own: self.own.to_array(),
            mode,
            limits: limits | severity.limits,
            events,
            integrator: acted.integrator,
            severity: severity.severity,
        }
    }

    /// Whether nothing but a levitated rotor has to be looked at.
    #[inline]
    fn levitates_as_usual(&self, given: &Given<'_, S>, wall: Contact) -> bool {
        self.phase == Phase::Levitated
            && given.flags() & SampleFlags::AT_EASE.1 == SampleFlags::AT_EASE.0
            && wall == Contact::None
            && !self.reconfigured
            && !self.classifier.is_continuous()
    }

    /// Most ticks: a rotor at ease is left to its levitation. To the bit what the rest of the tick comes to.
    #[inline(always)]
    fn levitated(&mut self, given: &Given<'_, S>, envelope: ForceEnvelope<S>) -> CoreCommand<S> {
        let (sample, coeffs) = (given.sample, given.coeffs);
        let velocity = self.observer.velocity();
        let seen = trust::Seen {
            speed_square: velocity.length_squared(),
            flies: true,
            phase: Phase::Levitated,
            rubs: self.classifier.rubs(),
            spin: sample.spin,
            status: sample.status,
        };
        self.detector.rest();
        self.classifier.flies(coeffs);
        self.trust.tick(&seen, coeffs);
        let command = Vec2::from_array(sample.levitation);
        let (levitation, bound) = limit::levitation(command, envelope);
        let (force, slew) = limit::slewed(levitation, self.force, coeffs);
        (self.force, self.own) = (force, force);
        self.observer.commanded(force);
        let acting = given.reading.actuator().acting(force);
        self.budget.spend(S::ONE, acting, coeffs);
        self.severity.levitated(velocity);
        CoreCommand {
            force: force.to_array(),
            own: force.to_array(),
            mode: Mode::Levitated,
            limits: bound | slew,
            events: given.reading.assessment.events,
            integrator: IntegratorHint::Run,
            severity: S::ZERO,
        }
    }

    /// What a tick has to make up for: commands that came too late, ticks that were missed, an estimate that
    /// cannot go on. Where a fault of the sensor begins: the force that fades.
    #[cold]
    fn catch_up(&mut self, reading: &Reading<S>, coeffs: &Coeffs<S>) -> Option<Vec2<S>> {
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
            let (position, rotation) = (reading.position(), reading.rotation);
            self.observer
                .bridge(missed, self.force, position, rotation, coeffs);
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
