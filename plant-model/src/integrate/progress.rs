//! Modes may follow each other at one instant, and steps in a sample, but not for ever.

use super::{Options, PlantError};

/// Events without time in between from which on modes are taken to follow each other in a circle, and those that are too many.
const CIRCLE: u32 = 4;
const MOST_AT_ONCE: u32 = 50;
/// Steps in a row that a machine may take without getting on: time that creeps is time that stands still.
const MOST_CREEPING: u32 = 1000;

/// Events at one instant, steps in this sample and steps of the run so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Progress {
    at_once: u32,
    creeping: u32,
    in_sample: u64,
    steps: u64,
}

impl Progress {
    /// A sample begins that is not flown whole.
    pub(crate) fn begin_sample(&mut self) {
        self.in_sample = 0;
    }

    /// A sample was flown whole.
    pub(crate) fn whole_sample(&mut self) {
        self.steps += 1;
    }

    /// A step begins, at `t_s`.
    pub(crate) fn begin_step(&mut self, options: &Options, t_s: f64) -> Result<(), PlantError> {
        self.in_sample += 1;
        self.steps += 1;
        for (done, limit) in [
            (self.in_sample, options.steps_per_sample),
            (self.steps, options.steps),
        ] {
            if done > limit {
                return Err(PlantError::WorkLimit {
                    t_s,
                    steps: limit,
                    fastest: None,
                });
            }
        }
        Ok(())
    }

    /// That step was free flight. How many of these a sample has is up to its length and the fastest rate: nothing moves too
    /// fast.
    pub(crate) fn was_free(&mut self) {
        self.in_sample -= 1;
    }

    /// A step is over, at `t_s`, in which time has moved or not.
    pub(crate) fn count(&mut self, t_s: f64, moved: bool) -> Result<(), PlantError> {
        self.at_once = if moved { 0 } else { self.at_once + 1 };
        if self.at_once > MOST_AT_ONCE {
            return Err(PlantError::ModeUndecided { t_s });
        }
        Ok(())
    }

    /// The same step, whether time has got on in it.
    pub(crate) fn creeps(&mut self, t_s: f64, creeps: bool) -> Result<(), PlantError> {
        self.creeping = if creeps { self.creeping + 1 } else { 0 };
        if self.creeping > MOST_CREEPING {
            return Err(PlantError::ModeUndecided { t_s });
        }
        Ok(())
    }

    /// Whether round-off alone leads round in a circle.
    pub(crate) fn is_circle(self) -> bool {
        self.at_once >= CIRCLE
    }
}
