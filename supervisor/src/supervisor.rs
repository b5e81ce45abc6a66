//! The tick: its body reads as the list of files.

use crate::classify::Classifier;
use crate::coeffs::Coeffs;
use crate::config::{Config, ConfigError};
use crate::detect::Detector;
use crate::estimate::Observer;
use crate::guard::{Actuator, Guard};
use crate::handover::Readiness;
use crate::limit::{Budget, Room};
use crate::phase::Phase;
use crate::recorder::{QueuedEvent, Record, Recorder};
use crate::severity::Severity;
use crate::signal::{Command, Limits, Mode, Refusal, Report, Sample};
use crate::vec2::Vec2;
use crate::{handover, law, limit};

/// Supervisor of one bearing plane with a flight record of `RECORD` ticks (a power of two).
#[derive(Debug, Clone)]
pub struct Supervisor<const RECORD: usize = 512> {
    coeffs: Coeffs,
    guard: Guard,
    observer: Observer,
    detector: Detector,
    classifier: Classifier,
    readiness: Readiness,
    phase: Phase,
    budget: Budget,
    severity: Severity,
    /// Last force \[caps\] …
    force: Vec2,
    /// … and as it was commanded \[N\].
    force_n: [f32; 2],
    refusal: Refusal,
    recorder: Recorder<RECORD>,
}

impl<const RECORD: usize> Supervisor<RECORD> {
    /// A supervisor that starts levitated.
    ///
    /// # Errors
    /// The first parameter of `config` that is outside its range.
    pub fn new(config: &Config) -> Result<Self, ConfigError> {
        config.validate()?;
        Ok(Self {
            coeffs: Coeffs::new(config),
            guard: Guard::default(),
            observer: Observer::default(),
            detector: Detector::default(),
            classifier: Classifier::default(),
            readiness: Readiness::default(),
            phase: Phase::default(),
            budget: Budget::default(),
            severity: Severity::default(),
            force: Vec2::ZERO,
            force_n: [0.0; 2],
            refusal: Refusal::None,
            recorder: Recorder::new(),
        })
    }

    /// One tick: total and bounded; the one loop that depends on data makes up for at most four missed
    /// ticks.
    pub fn tick(&mut self, sample: &Sample) -> Command {
        let coeffs = &self.coeffs;
        let blind = self.detector.near_contact();
        let reading = (self.guard).judge(sample, self.observer.velocity(), blind, coeffs);
        let actuator = reading.actuator;
        self.refusal = reading.refusal;
        for _ in 0..reading.missed {
            // Nobody commanded anything else meanwhile.
            let modelled = Actuator {
                applied: None,
                ..actuator
            };
            self.observer.advance(None, blind, modelled, coeffs);
            self.observer.commanded(self.force);
        }
        let contact = self.detector.sample(reading.position, coeffs);
        if reading.anew || (reading.faulty && reading.position.is_none()) {
            self.observer.forget();
        }
        let near_contact = self.detector.near_contact();
        let motion = (self.observer).advance(reading.position, near_contact, actuator, coeffs);
        let mut found = self.detector.findings(&motion, contact, coeffs);
        let calm = found.calm;
        found.calm &= self.readiness.ready();
        let class = (self.classifier).classify(&found, reading.spin_sign, coeffs);
        let before = self.phase;
        let (phase, events) = before.next(&found, class, &reading, coeffs);
        self.phase = phase;

        let wanted = law::wanted(phase.mode(), &motion, &found, reading.spin_sign, coeffs);
        let room = Room::new(&self.budget, actuator, coeffs);
        let (own, own_limits) = limit::allocate(&wanted, &room);
        let (levitation_n, levitation_limits) =
            limit::levitation(sample.levitation_n, &room, coeffs);
        let levitation = coeffs.force(levitation_n);
        // The controller has to ask for what the rotor is really held with.
        let held = actuator.applied.unwrap_or(own);
        (self.readiness).compare(held, levitation, found.normal, coeffs);
        let force = handover::blend(phase, own, levitation, self.force, coeffs);

        // A lost axis has no force to start from.
        let last_n = actuator.carried(Vec2::from_array(self.force_n));
        // Levitated is transparent bit for bit: the command does not go through per unit and back.
        let (force_n, last, mut limits) = if phase.mode() == Mode::Levitated {
            let (force_n, last) = limit::slewed(levitation_n, last_n, coeffs);
            (force_n, last | levitation_limits, Limits::empty())
        } else {
            let (force_n, last) =
                limit::final_force_n(coeffs.force_n(force), last_n, &room, coeffs);
            (force_n, last, own_limits)
        };
        limits |= last | reading.limits;
        self.force_n = force_n;
        self.force = if last.is_empty() {
            force
        } else {
            coeffs.force(force_n)
        };
        self.observer.commanded(self.force);
        let acting = actuator.applied.unwrap_or(self.force);
        self.budget.tick(acting, coeffs);
        let assessment =
            (self.severity).assess(phase.mode(), &motion, &found, &reading, acting, coeffs);

        let mut command = Command {
            force_n,
            mode: phase.mode(),
            limits: limits | assessment.limits,
            events: events | reading.events | assessment.events,
            integrator: handover::integrator_hint(phase, calm, reading.bearing_on),
            severity: assessment.severity,
        };
        let position = reading.position.unwrap_or(motion.position);
        command.events |= (self.recorder).push(sample, position, self.force, &command);
        command
    }

    /// What the supervisor is doing.
    pub fn mode(&self) -> Mode {
        self.phase.mode()
    }

    /// What has happened since the supervisor was made.
    pub fn report(&self) -> Report {
        Report {
            thermal_state: self.budget.state(),
            force_cap_n: self.budget.cap(&self.coeffs) * self.coeffs.force_max_n,
            refusal: self.refusal,
            fault: self.guard.fault,
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
