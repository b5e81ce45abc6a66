//! The numbers that a supervisor under test calculates in, and recorders of its ticks.

use super::tick_log::{Recording, Tick, TickLog};
use firmware_bench::run::controller::Supervise;
use firmware_image::under_test::{Fixed, Float, Ticked, UnderTest};
use firmware_image::wire::core_sample_bits;
use std::rc::Rc;
use supervisor::{Command, Config, CoreSample, Prepared, Q, Sample, Scalar, Scaling};

/// Kinds of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    /// `f32`, from SI to SI.
    Float,
    /// Fixed point, per unit; the conversion from SI and back is the host's.
    Fixed,
}

impl Number {
    /// Name in tables and in `budgets.toml`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float => Float::NUMBER,
            Self::Fixed => Fixed::NUMBER,
        }
    }

    /// Name of an image that has one for each number.
    pub fn image(self, image: &str) -> String {
        match self {
            Self::Float => image.to_owned(),
            Self::Fixed => format!("{image}-q"),
        }
    }

    /// Whether there is a supervisor of this configuration in these numbers.
    pub fn fits(self, config: &Config) -> bool {
        match self {
            Self::Float => config.validate().is_ok(),
            Self::Fixed => Prepared::<Q>::new(config).is_ok(),
        }
    }

    /// A new supervisor that writes its ticks to a log; `None` where none [`Self::fits`].
    pub fn recorder(self, config: &Config, log: &TickLog) -> Option<Box<dyn Supervise>> {
        let log = Rc::clone(log);
        Some(match self {
            Self::Float => Box::new(Recording {
                supervisor: Box::new(Float::new(config).ok()?),
                log,
            }),
            Self::Fixed => Box::new(RecordingFixed {
                scaling: config.scaling(),
                core: <Fixed as Ticked>::new(config)?,
                log,
            }),
        })
    }
}

/// Fastest spin that `Q` is given \[1/t₀\].
const FASTEST: f32 = 500.0;

/// The core in fixed point behind a conversion, with a log of what passes between them.
#[derive(Debug)]
struct RecordingFixed {
    scaling: Scaling,
    core: Fixed,
    log: TickLog,
}

/// What `Q` does not hold keeps its bits and becomes some number: a converter of real firmware has no NaN either, and
/// what is out of its range must not look like the centre.
fn converted(x: f32) -> Q {
    if Q::represents(x) {
        Q::from_f32(x)
    } else {
        Q::from_bits(x.to_bits() as i32)
    }
}

impl Supervise for RecordingFixed {
    fn tick(&mut self, sample: &Sample) -> Command {
        let scaling = &self.scaling;
        let forces = |force_n: [f32; 2]| force_n.map(|x| converted(x * scaling.force_per_n));
        let sample = CoreSample {
            sequence: sample.sequence,
            status: sample.status,
            position: (sample.position_m).map(|x| converted(x * scaling.position_per_m)),
            spin: converted((sample.spin_rad_s * scaling.time_s).clamp(-FASTEST, FASTEST)),
            levitation: forces(sample.levitation_n),
            applied: forces(sample.applied_n),
        };
        let command = self.core.tick(&sample);
        let tick = Tick::new(&core_sample_bits(&sample), &Fixed::bits(&command));
        self.log.borrow_mut().push(tick);
        scaling.command(&command)
    }
}
