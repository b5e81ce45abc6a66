//! Modes may follow each other at one instant, but not for ever.

use super::PlantError;

/// Events without time in between from which on modes are taken to follow each other in a circle, and those that are too many.
const CIRCLE: u32 = 4;
const MOST_AT_ONCE: u32 = 50;

/// Events at one instant so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Progress {
    at_once: u32,
}

impl Progress {
    /// A step is over, at `t_s`, in which time has moved or not.
    pub(crate) fn count(&mut self, t_s: f64, moved: bool) -> Result<(), PlantError> {
        self.at_once = if moved { 0 } else { self.at_once + 1 };
        if self.at_once > MOST_AT_ONCE {
            return Err(PlantError::ModeUndecided { t_s });
        }
        Ok(())
    }

    /// Whether round-off alone leads round in a circle.
    pub(crate) fn is_circle(self) -> bool {
        self.at_once >= CIRCLE
    }
}
