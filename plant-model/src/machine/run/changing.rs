//! Parameters that change during a run.

use super::Machine;
use super::settle::AtZero;
use crate::machine::guards::Guard;
use crate::machine::params::Change;
use crate::mode::Phase;
use crate::params::ParamError;

impl Machine {
    /// Changes parameters from now on. Position, speeds and stored energy stay as they are: none of these parameters has a
    /// share in them. What an unbalance does comes of the spin that the rotor has, and of how that changes.
    ///
    /// # Errors
    /// The first value that is out of range, and a torque while the speed is held; then nothing has changed.
    pub fn change(&mut self, change: &Change) -> Result<(), ParamError> {
        self.system.change(change)?;
        self.map.forget();
        self.stepper.series.renew(&self.system.body);
        for p in 0..self.phases.len() {
            let phase = self.phases[p];
            if matches!(phase, Phase::Contact(..)) {
                // A weaker cone may not hold what the stronger one held.
                self.settle(p, AtZero::held(phase));
                self.suppressed[p] &= Guard::Normal.bit();
            }
        }
        Ok(())
    }
}
