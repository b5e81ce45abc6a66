//! A force history that was laid down beforehand, with the whole run known: no feedback until it ends, then
//! the reference's law.

use crate::device::actuator::limited_n;
use crate::run::clairvoyant::Clairvoyant;
use crate::run::controller::{Controller, Force, Seen};
use plant_model::{Snapshot, V2};

/// Force vectors, each held for a while.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    forces_n: Vec<V2>,
    held_s: f64,
    /// Whether they come on top of the law's force; the law and not the history is then what is searched about.
    on_top: bool,
    law: Clairvoyant,
    force_max_n: f64,
}

impl History {
    /// Forces \[N\], each held for `held_s`; what exceeds the cap as a vector is cut.
    pub fn new(forces_n: Vec<V2>, held_s: f64, law: Clairvoyant, force_max_n: f64) -> Self {
        Self {
            forces_n,
            held_s,
            on_top: false,
            law,
            force_max_n,
        }
    }

    /// The same on top of the law's force. The run being known, the sum is one force history as well.
    #[must_use]
    pub fn on_top(self) -> Self {
        Self {
            on_top: true,
            ..self
        }
    }

    /// Force at a sample \[N\].
    pub fn force_n(&self, now: &Snapshot) -> V2 {
        // Sample times carry round-off.
        let index = (now.t_s / self.held_s + 1e-6) as usize;
        match self.forces_n.get(index) {
            None => self.law.force_n(now),
            Some(own_n) if self.on_top => {
                limited_n(*own_n + self.law.force_n(now), self.force_max_n)
            }
            Some(own_n) => limited_n(*own_n, self.force_max_n),
        }
    }
}

impl Controller for History {
    fn command(&mut self, _seen: &Seen, truth: &Snapshot) -> Force {
        Force::AtOnce(self.force_n(truth))
    }
}
