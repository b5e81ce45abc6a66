//! The tick: its body reads as the list of files.

use crate::classify::Classifier;
use crate::coeffs::Coeffs;
use crate::config::{Config, ConfigError};
use crate::detect::Detector;
use crate::estimate::Observer;
use crate::guard::Guard;
use crate::handover::Readiness;
use crate::phase::Phase;
use crate::recorder::{QueuedEvent, Record, Recorder};
use crate::signal::{Command, Limits, Mode, Sample};
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
    /// Last force \[caps\].
    force: Vec2,
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
            force: Vec2::ZERO,
            recorder: Recorder::new(),
        })
    }

    /// One tick: total, bounded, without loops that depend on data.
    pub fn tick(&mut self, sample: &Sample) -> Command {
        let coeffs = &self.coeffs;
        let reading = self.guard.judge(sample, coeffs);
        let contact = self.detector.sample(reading.position, coeffs);
        if reading.faulty && reading.position.is_none() {
            self.observer.forget();
        }
        let motion =
            (self.observer).advance(reading.position, self.detector.near_contact(), coeffs);
        let mut found = self.detector.findings(&motion, contact, coeffs);
        let calm = found.calm;
        found.calm &= self.readiness.ready();
        let class = (self.classifier).classify(&found, reading.spin_sign, coeffs);
        let before = self.phase;
        let (phase, events) = before.next(&found, class, &reading, coeffs);
        self.phase = phase;

        let wanted = law::wanted(phase.mode(), &motion, &found, reading.spin_sign, coeffs);
        let (own, own_limits) = limit::allocate(&wanted);
        let (levitation_n, levitation_limits) = limit::levitation(sample.levitation_n, coeffs);
        let levitation = coeffs.force(levitation_n);
        (self.readiness).compare(own, levitation, found.normal, coeffs);
        let force = handover::blend(phase, own, levitation, self.force, coeffs);

        // Levitated is transparent bit for bit: the command does not go through per unit and back.
        let (force_n, mut limits) = match phase.mode() {
            Mode::Levitated => (levitation_n, levitation_limits),
            Mode::SensorFault => limit::final_force_n(coeffs.force_n(force), coeffs),
            _ => {
                let (force_n, last) = limit::final_force_n(coeffs.force_n(force), coeffs);
                (force_n, last | own_limits)
            }
        };
        limits |= reading.limits;
        self.force = if limits.contains(Limits::NOT_FINITE) {
            Vec2::ZERO
        } else {
            force
        };
        self.observer.commanded(self.force);

        let mut command = Command {
            force_n,
            mode: phase.mode(),
            limits,
            events: events | reading.events,
            integrator: handover::integrator_hint(phase, calm, reading.bearing_on),
        };
        let position = reading.position.unwrap_or(motion.position);
        command.events |= (self.recorder).push(sample, position, self.force, &command);
        command
    }

    /// What the supervisor is doing.
    pub fn mode(&self) -> Mode {
        self.phase.mode()
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
