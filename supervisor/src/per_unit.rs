//! The tick, per unit: its body reads as the list of files.

use crate::beside::Beside;
use crate::classify::Classifier;
use crate::coeffs::{Coeffs, Scaling};
use crate::config::{Config, CoreError, NotRepresentable};
use crate::detect::Detector;
use crate::estimate::{Contact, Observer};
use crate::guard::Guard;
use crate::handover::Readiness;
use crate::impact::{Impact, Speed};
use crate::law::View;
use crate::limit::{Budget, ForceEnvelope};
use crate::phase::{Judged, Phase};
use crate::reading::{Reading, SampleFlags};
use crate::recorder::{QueuedEvent, Record, Recorder};
use crate::scalar::Scalar;
use crate::severity::Severity;
use crate::signal::{
    CoreCommand, CoreSample, Events, IntegratorHint, Limits, Mode, RejectReason, Report, Status,
};
use crate::spin::Spin;
use crate::trust::Trust;
use crate::vec2::Vec2;
use crate::{handover, limit};

/// Contact can be avoided for good where this share of the work that force and shaft can do is enough: with a half some
/// rotors come into the middle one swing of their shaft later.
const CALM_SHARE: f32 = 0.3;

/// Supervisor of one bearing plane in clearances and force caps, for a number `S`, with a flight record of
/// `RECORD` ticks (a power of two). [`Config::scaling`] says what the units are.
///
/// The order of the fields is kept: what a tick works with is within reach of one base register, and the long ring
/// of the recorder comes last.
#[derive(Debug, Clone)]
#[repr(C)]
pub struct Core<S: Scalar, const RECORD: usize = 512> {
    coeffs: Coeffs<S>,
    guard: Guard<S>,
    observer: Observer<S>,
    classifier: Classifier<S>,
    readiness: Readiness<S>,
    phase: Phase<S>,
    trust: Trust<S>,
    budget: Budget<S>,
    severity: Severity<S>,
    /// Last command …
    force: Vec2<S>,
    /// … and what would have been it, which is the same but in shadow.
    own: Vec2<S>,
    detector: Detector,
    reconfigured: bool,
    recorder: Recorder<RECORD>,
}

/// Checked and converted configuration: made in the background, taken over between two ticks.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<S: Scalar>(Coeffs<S>);

impl<S: Scalar> Prepared<S> {
    /// Checks and converts.
    ///
    /// # Errors
    /// A parameter outside its range, or a coefficient that `S` cannot hold.
    pub fn new(config: &Config) -> Result<Self, CoreError> {
        config.validate().map_err(CoreError::Range)?;
        match Self::from_valid(config) {
            (prepared, None) => Ok(prepared),
            (_, Some(lost)) => Err(CoreError::NotRepresentable(lost)),
        }
    }

    pub(crate) fn from_valid(config: &Config) -> (Self, Option<NotRepresentable>) {
        let (coeffs, lost) = Coeffs::new(config);
        (Self(coeffs), lost)
    }
}

impl<S: Scalar, const RECORD: usize> Core<S, RECORD> {
    /// Bytes of the whole that are the flight recorder's: its ring, the queue of events, and where it is.
    pub const RECORDER_BYTES: usize = size_of::<Recorder<RECORD>>();

    /// A supervisor that starts levitated.
    pub fn new(prepared: &Prepared<S>) -> Self {
        Self {
            coeffs: prepared.0,
            guard: Guard::default(),
            observer: Observer::default(),
            detector: Detector::default(),
            classifier: Classifier::default(),
            readiness: Readiness::default(),
            phase: Phase::default(),
            trust: Trust::default(),
            budget: Budget::default(),
            severity: Severity::default(),
            force: Vec2::ZERO,
            own: Vec2::ZERO,
            reconfigured: false,
            recorder: Recorder::new(),
        }
    }

    /// Takes another configuration over, to hold from the next tick on. What is known of the rotor stays,
    /// and so do mode, counters and thermal state; entries of a flight record are in the units of
    /// their time, and the tick of the change has [`Events::RECONFIGURED`]. A smaller cap holds at once: from
    /// there on the slew limit holds.
    pub fn reconfigure(&mut self, prepared: &Prepared<S>) {
        let (old, new) = (&self.coeffs, &prepared.0);
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
        self.coeffs = prepared.0;
        self.reconfigured = true;
        // A cap that is smaller now holds at once; what the budget leaves of it is come down to by the slew limit, as ever.
        let envelope = ForceEnvelope::below(S::ONE, SampleFlags::empty(), &self.coeffs);
        let held = |last: Vec2<S>| limit::levitation(last * S::from_f32(force), envelope).0;
        (self.force, self.own) = (held(self.force), held(self.own));
    }

    /// One tick: total and bounded; the one loop that depends on data makes up for at most four missed
    /// ticks.
    #[inline]
    pub fn tick(&mut self, sample: &CoreSample<S>) -> CoreCommand<S> {
        self.tick_beside(sample, &())
    }

    /// The same of a plane that knows what is beside it.
    #[inline]
    pub(crate) fn tick_beside(
        &mut self,
        sample: &CoreSample<S>,
        beside: &impl Beside<S>,
    ) -> CoreCommand<S> {
        let tilting = beside.tilting();
        let coeffs = &self.coeffs;
        let pinned = matches!(self.phase, Phase::Pinned { .. });
        if let Some(tilting) = tilting {
            let gained = tilting.gained(coeffs.tick);
            (self.observer).push(gained, self.detector.wall(pinned), coeffs);
        }
        // An axis that does not track its command is as good as lost.
        let status = sample.status | self.observer.monitor.lost(sample.status);
        let estimated = || {
            let blind = self.detector.wall(pinned) != Contact::None;
            (self.observer.velocity(), blind)
        };
        let expected = (self.observer).expected(self.detector.wall(pinned), coeffs);
        let reading = (self.guard).judge((sample, status), expected, estimated, coeffs);
        let assessment = reading.assessment;
        let flags = assessment.flags;
        let spin = (reading.spin, sample.spin);
        if flags.intersects(SampleFlags::UNUSUAL) {
            // A copy, so that the usual one stays in registers.
            let unusual = reading;
            self.catch_up(&unusual, spin);
        }
        let coeffs = &self.coeffs;
        let (position, actuator) = (reading.position(), reading.actuator());
        let touch = self.detector.sample(position, coeffs);
        let wall = self.detector.wall(pinned);
        let (motion, off_axis) = (self.observer).advance(position, spin, wall, actuator, coeffs);
        let envelope = ForceEnvelope::new(&self.budget, actuator.axes, coeffs);
        let margin = self.trust.margin;
        let contact = (self.detector).contact_estimate(
            (&motion, off_axis),
            touch,
            (envelope.cap, margin),
            tilting,
            coeffs,
        );
        let made_up = || match wall {
            Contact::Impact => self.observer.made_up(contact.normal, coeffs),
            _ => S::ZERO,
        };
        let seen = position.is_some();
        let rubs = self.classifier.rubs();
        let class = (self.classifier).classify(&contact, (seen, made_up), spin, coeffs);

        // A rotor that levitates, and will, needs none of what follows.
        let (mut speed, mut ahead, mut calm) = (Speed::default(), None, false);
        // Of the axis: an orbit is no approach, and no sign of the model either.
        let square = self.observer.velocity().length_squared();
        let flies = wall == Contact::None;
        let quiet = self.guard.innovation.is_quiet(coeffs);
        let judged = Judged {
            quiet,
            hands_back: (self.trust).tick((square, flies), (self.phase, rubs, sample.spin), coeffs),
            rubs_on: self.trust.rubs_on(),
            trusted: quiet && self.trust.is_granted(),
        };
        if self.phase != Phase::Levitated || contact.unavoidable || contact.touching {
            speed = Speed::new(motion.velocity);
            if !contact.touching {
                ahead = Impact::ahead(&motion, contact.radius, &speed);
                let beyond = (speed.value - margin).max(S::ZERO);
                let share = S::from_f32(CALM_SHARE);
                calm = flies && contact.stops(beyond, envelope.cap, share, coeffs);
                if let Some(tilting) = tilting
                    && flies
                    && !calm
                {
                    calm = contact.curls(&motion, tilting, (margin, envelope.cap, share), coeffs);
                }
            }
        }
        let patience = (calm, self.readiness.ready(), judged);
        let (phase, events) = (self.phase).next(&contact, patience, class, flags, coeffs);
        self.phase = phase;
        let mode = phase.mode();

        let led;
        let acted_on = match tilting {
            Some(tilting) if phase.is_engaged() && !contact.touching => {
                led = tilting.ahead(&motion, coeffs);
                &led
            }
            _ => &motion,
        };
        let view = View {
            motion: acted_on,
            contact: &contact,
            speed: &speed,
            ahead: ahead.as_ref(),
            spin: reading.spin,
            delivered: self.observer.delivered(),
            coeffs,
        };
        let shadow = sample.status.contains(Status::SHADOW);
        if actuator.axes.has_lost() {
            // Such an axis has no force to start from; one that does not track may have.
            let known = actuator.axes.known(sample.status);
            (self.force, self.own) = (known.carried(self.force), known.carried(self.own));
        }
        let last = if shadow { self.own } else { self.force };
        // Under impacts and in whirl nobody asks what the levitation controller wants.
        let holds = mode == Mode::Pinned || !contact.touching;
        let has_a_say =
            holds || matches!(mode, Mode::Levitated | Mode::HandedBack | Mode::SensorFault);
        let command = Vec2::from_array(sample.levitation);
        let (levitation, levitation_limits) = if has_a_say {
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
                RejectReason::Doubted => judged.trusted,
                refusal => refusal.is_wrong(),
            };
        if !phase.is_engaged() {
            self.readiness = Readiness::default();
        }
        let (target, bound) = if wrong && matches!(mode, Mode::Levitated | Mode::Handover) {
            limit::within(last, envelope)
        } else if !phase.is_engaged() {
            (levitation, levitation_limits)
        } else {
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
                    handover::faded(bouncing, (last, levitation), flags, envelope, coeffs)
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
        let mut integrator = handover::integrator_hint(phase, calm, on);
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
        let severity =
            (self.severity).assess(mode, &view, flags, (acting, self.observer.velocity()));

        let mut events = events | assessment.events | severity.events;
        if core::mem::take(&mut self.reconfigured) {
            events |= Events::RECONFIGURED;
        }
        limits |= severity.limits;
        events |= self.recorder.push(
            sample.sequence,
            position.unwrap_or(self.observer.position()),
            self.own,
            (mode, limits),
            events,
        );
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

    /// What a tick has to make up for: commands that came too late, ticks that were missed, an estimate that
    /// cannot go on.
    #[cold]
    fn catch_up(&mut self, reading: &Reading<S>, spin: (Spin, S)) {
        let assessment = reading.assessment;
        let flags = assessment.flags;
        if flags.contains(SampleFlags::LATE) {
            self.observer.late();
        }
        if assessment.missed > 0 {
            let missed = u32::from(assessment.missed);
            self.observer
                .bridge(missed, self.force, (reading.position(), spin), &self.coeffs);
            let acting = reading.actuator().acting(self.force);
            (self.budget).spend(S::count(missed), acting, &self.coeffs);
        }
        let lost = flags.contains(SampleFlags::FAULTY) && !flags.contains(SampleFlags::USED);
        if flags.intersects(SampleFlags::ANEW | SampleFlags::MISSED) {
            self.observer.monitor.unseen();
        }
        if flags.contains(SampleFlags::ANEW) || lost {
            self.observer.forget();
            self.classifier.forget();
        }
    }

    /// Velocity of the axis; `None` where it is not known by more than one sample.
    #[inline]
    pub(crate) fn velocity(&self) -> Option<Vec2<S>> {
        self.observer.known_velocity()
    }

    /// The recorder, to ask how far it is.
    pub(crate) fn recorder(&self) -> &Recorder<RECORD> {
        &self.recorder
    }

    /// Force that acts now.
    #[inline]
    pub(crate) fn delivered(&self) -> Vec2<S> {
        self.observer.delivered()
    }

    /// The units of samples and commands.
    #[inline]
    pub fn scaling(&self) -> &Scaling {
        &self.coeffs.scaling
    }

    /// What the supervisor is doing.
    pub fn mode(&self) -> Mode {
        self.phase.mode()
    }

    /// What has happened since the supervisor was made, in SI.
    pub fn report(&self) -> Report {
        Report {
            thermal_state: self.budget.state(&self.coeffs),
            force_cap_n: self.budget.cap(&self.coeffs).to_f32() * self.coeffs.scaling.force_n,
            missed_ticks: self.guard.missed_ticks,
            repeated_ticks: self.guard.repeated_ticks,
            late_ticks: self.guard.late_ticks,
            refusal: self.guard.refusal,
            fault: self.guard.fault,
            handed_back: u32::from(self.trust.handed_back),
            ..self.severity.report(&self.coeffs)
        }
    }

    /// The frozen flight record, if there is one.
    pub fn record(&self) -> Option<Record<'_, RECORD>> {
        self.recorder.record()
    }

    /// Discards a frozen record and waits for the next engagement.
    pub fn rearm(&mut self) {
        self.recorder.rearm();
    }

    /// Next event for the background task, oldest first.
    pub fn next_event(&mut self) -> Option<QueuedEvent> {
        self.recorder.next_event()
    }
}
