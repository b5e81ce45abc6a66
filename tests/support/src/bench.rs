//! A supervisor on a rotor that whirls or is led by the hand.

use crate::rig::{RADIUS_M, on_circle, sample, sample_with};
use supervisor::{Command, Config, Limits, Mode, Sample, Supervisor};

/// A supervisor with its counter of samples.
pub struct Bench {
    /// It has a short flight record.
    pub supervisor: Supervisor<64>,
    /// Number of the last sample.
    pub sequence: u32,
}

/// Angle of the whirl in a tick; in 70 ticks not the same coordinate twice.
pub const WHIRL_STEP: f32 = 0.0977;

impl Bench {
    /// Before its first sample.
    ///
    /// # Panics
    /// If the configuration is not valid.
    pub fn new(config: &Config) -> Self {
        Self {
            supervisor: Supervisor::new(config).unwrap(),
            sequence: 0,
        }
    }

    /// A tick with the next number.
    pub fn tick(&mut self, position_m: [f32; 2]) -> Command {
        self.sequence = self.sequence.wrapping_add(1);
        self.tick_again(position_m)
    }

    /// A tick without a new number.
    pub fn tick_again(&mut self, position_m: [f32; 2]) -> Command {
        self.supervisor.tick(&sample(self.sequence, position_m))
    }

    /// Ticks of the same reading.
    pub fn ticks(&mut self, ticks: u32, position_m: [f32; 2]) {
        for _ in 0..ticks {
            self.tick(position_m);
        }
    }

    /// A tick under a levitation controller that asks for a force.
    pub fn tick_asking(&mut self, position_m: [f32; 2], levitation_n: [f32; 2]) -> Command {
        self.tick_with(position_m, |now| now.levitation_n = levitation_n)
    }

    /// A tick with the next number and a change of its sample.
    pub fn tick_with(&mut self, position_m: [f32; 2], change: impl FnOnce(&mut Sample)) -> Command {
        self.sequence = self.sequence.wrapping_add(1);
        let now = sample_with(self.sequence, position_m, change);
        self.supervisor.tick(&now)
    }

    /// Whirls backward on the wall until it is braked, 20 µm a tick, and says at which angle it is.
    ///
    /// # Panics
    /// If a sample is refused, or it is no whirl.
    pub fn whirl(config: &Config) -> (Self, f32) {
        let mut bench = Self::new(config);
        let mut angle = 0.0;
        for _ in 0..200 {
            angle += WHIRL_STEP;
            let command = bench.tick(on_circle(RADIUS_M, angle));
            assert!(!command.limits.contains(Limits::SAMPLE_REFUSED));
        }
        assert_eq!(bench.supervisor.mode(), Mode::BackwardWhirl);
        (bench, angle)
    }
}
