//! Between command and actuator: a command that is not renewed in time expires.

use crate::number::scalar::Scalar;

/// Holds the last command for the actuator's own loop, and lets it expire: a supervisor that is no longer
/// called must not leave its last force on the magnet.
///
/// ```
/// let mut watch = supervisor::CommandWatchdog::<f32>::new(2);
/// watch.renew([5.0, 0.0]);                    // after a tick
/// assert_eq!(watch.force(), [5.0, 0.0]);      // the actuator's period of this tick …
/// assert_eq!(watch.force(), [5.0, 0.0]);      // … one more without a tick …
/// assert_eq!(watch.force(), [0.0, 0.0]);      // … and no longer
/// assert!(watch.expired());
/// ```
#[derive(Debug, Clone, Copy)]
pub struct CommandWatchdog<S> {
    force: [S; 2],
    left: u32,
    most: u32,
}

impl<S: Scalar> CommandWatchdog<S> {
    /// A command holds for this many periods of the actuator; before the first there is none.
    pub fn new(periods: u32) -> Self {
        Self {
            force: [S::ZERO; 2],
            left: 0,
            most: periods,
        }
    }

    /// After each tick. What is no number is no force.
    #[inline]
    pub fn renew(&mut self, force: [S; 2]) {
        self.force = force.map(|x| if x.is_finite() { x } else { S::ZERO });
        self.left = self.most;
    }

    /// Once in each period of the actuator: its force, zero when the command has expired.
    #[inline]
    pub fn force(&mut self) -> [S; 2] {
        if self.left == 0 {
            self.force = [S::ZERO; 2];
        } else {
            self.left -= 1;
        }
        self.force
    }

    /// Whether the next period would have no command.
    #[inline]
    pub fn expired(&self) -> bool {
        self.left == 0
    }
}
