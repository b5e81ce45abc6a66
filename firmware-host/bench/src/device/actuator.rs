//! The amplifier between command and magnet: when a command takes effect, and what limits it. The lag
//! that follows belongs to the plant.

use crate::device::axis::Axis;
use crate::words::words;
use plant_model::V2;

/// What a magnet's amplifier does beside the plant's cap and lag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmplifierParams {
    /// Cap on each component of the force \[N\], beside the cap on the vector.
    pub axis_force_max_n: Option<f64>,
    /// Fastest change of each component \[N/s\]: the voltage limit. The lag follows it.
    pub slew_n_s: Option<f64>,
    /// Samples from a position to the effect of the command computed from it, 1 to 7.
    pub delay_samples: usize,
    /// Whether the firmware measures the force that the magnet delivers.
    pub force_measured: bool,
}

/// Longest delay \[samples\].
pub(crate) const MOST_DELAY: usize = 7;

impl Default for AmplifierParams {
    fn default() -> Self {
        Self {
            axis_force_max_n: None,
            slew_n_s: None,
            delay_samples: 1,
            force_measured: false,
        }
    }
}

words! {
    /// What a faulty amplifier delivers.
    pub enum Delivers {
        /// No force: the field decays with the lag.
        Nothing = "nothing",
        /// The force with the other sign.
        Inverted = "inverted",
        /// Along x what is meant for y, and the other way round.
        Swapped = "swapped",
    }
}

/// An amplifier that does not deliver what it should for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outage {
    /// Beginning \[s\].
    pub start_s: f64,
    /// Duration \[s\].
    pub duration_s: f64,
    /// What it does instead.
    pub delivers: Delivers,
    /// What fails; both where axes are swapped.
    pub axis: Axis,
    /// Whether the firmware knows; only of an amplifier that delivers nothing.
    pub known: bool,
}

impl Outage {
    /// End \[s\].
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    fn acts(&self, at_s: f64) -> bool {
        self.start_s <= at_s && at_s < self.end_s()
    }
}

/// A force limited as a vector.
pub(crate) fn limited_n(wanted_n: V2, force_max_n: f64) -> V2 {
    let size = wanted_n.norm();
    if size > force_max_n {
        wanted_n * (force_max_n / size)
    } else {
        wanted_n
    }
}

/// Parts of a stretch in which a ramp is held, each at its mean.
const RAMP_PARTS: u32 = 8;

/// The amplifier at work.
#[derive(Debug, Clone)]
pub(crate) struct Amplifier {
    params: AmplifierParams,
    force_max_n: f64,
    outages: Vec<Outage>,
    /// Whether commands go to the plant as they are.
    plain: bool,
    /// Commands that wait, by the tick at which they take effect.
    pending_n: [V2; MOST_DELAY + 1],
    /// The command in effect.
    register_n: V2,
    /// Where the slew limit has got to.
    ramped_n: V2,
}

impl Amplifier {
    pub(crate) fn new(params: AmplifierParams, force_max_n: f64, outages: &[Outage]) -> Self {
        let limited = params.axis_force_max_n.is_some() || params.slew_n_s.is_some();
        Self {
            params,
            force_max_n,
            outages: outages.to_vec(),
            plain: outages.is_empty() && !limited,
            pending_n: [V2::zeros(); MOST_DELAY + 1],
            register_n: V2::zeros(),
            ramped_n: V2::zeros(),
        }
    }

    /// The command computed at a tick; what is no number is no command.
    pub(crate) fn command(&mut self, tick: u64, command_n: V2) {
        let finite = command_n.iter().all(|x| x.is_finite());
        let delay = self.params.delay_samples.clamp(1, MOST_DELAY) as u64;
        *self.slot(tick + delay) = if finite { command_n } else { V2::zeros() };
    }

    /// A command that takes effect without delay: only for a policy that needs no time.
    pub(crate) fn command_at_once(&mut self, command_n: V2) {
        self.register_n = command_n;
    }

    /// A tick begins.
    pub(crate) fn begin(&mut self, tick: u64) {
        self.register_n = *self.slot(tick);
    }

    fn slot(&mut self, tick: u64) -> &mut V2 {
        &mut self.pending_n[tick as usize % (MOST_DELAY + 1)]
    }

    /// The command in effect, as the policy gave it.
    pub(crate) fn in_effect_n(&self) -> V2 {
        self.register_n
    }

    /// Axes (x, y) of which the firmware knows at this time that they deliver nothing.
    pub(crate) fn known_off(&self, at_s: f64) -> [bool; 2] {
        [0, 1].map(|component| {
            (self.outages.iter()).any(|o| o.known && o.axis.has(component) && o.acts(at_s))
        })
    }

    /// Parts in which what is delivered from a time on is to be held.
    pub(crate) fn parts(&self, from_s: f64) -> u32 {
        if self.params.slew_n_s.is_some() && self.target_n(from_s) != self.ramped_n {
            RAMP_PARTS
        } else {
            1
        }
    }

    /// Where the command in effect leads.
    fn target_n(&self, at_s: f64) -> V2 {
        let mut target = limited_n(self.register_n, self.force_max_n);
        if let Some(most) = self.params.axis_force_max_n {
            target = target.map(|x| x.clamp(-most, most));
        }
        for outage in self.outages.iter().filter(|o| o.acts(at_s)) {
            target = match outage.delivers {
                Delivers::Nothing => target,
                Delivers::Inverted => outage.axis.map(target, |x| -x),
                Delivers::Swapped => V2::new(target.y, target.x),
            };
        }
        self.without_dead_axes(target, at_s)
    }

    /// Nothing along axes that deliver nothing, whatever else is wrong with them.
    fn without_dead_axes(&self, force_n: V2, at_s: f64) -> V2 {
        let dead = |o: &&Outage| o.delivers == Delivers::Nothing && o.acts(at_s);
        (self.outages.iter().filter(dead)).fold(force_n, |force, o| o.axis.map(force, |_| 0.0))
    }

    /// Mean of the limited command over a part in which no outage begins or ends \[N\].
    pub(crate) fn deliver(&mut self, from_s: f64, to_s: f64) -> V2 {
        if self.plain {
            return self.register_n;
        }
        let target = self.target_n(from_s);
        let Some(slew) = self.params.slew_n_s else {
            return target;
        };
        // No current flows where the amplifier is out.
        self.ramped_n = self.without_dead_axes(self.ramped_n, from_s);
        let step_s = to_s - from_s;
        let mut mean = target;
        for i in [0, 1] {
            let (old, way) = (self.ramped_n[i], target[i] - self.ramped_n[i]);
            let most = slew * step_s;
            if way.abs() > most {
                let new = old + way.signum() * most;
                (mean[i], self.ramped_n[i]) = (0.5 * (old + new), new);
            } else if way != 0.0 {
                let share = way.abs() / most;
                (mean[i], self.ramped_n[i]) = (target[i] - 0.5 * way * share, target[i]);
            }
        }
        mean
    }
}
