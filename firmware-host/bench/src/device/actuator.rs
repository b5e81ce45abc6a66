//! The amplifier between command and magnet: when a command takes effect, and what limits it. The lag
//! that follows belongs to the plant.

use crate::device::axis::Axis;
use crate::words::words;
use plant_model::V2;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// What a magnet's amplifier does beside the plant's cap and lag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmplifierParams {
    /// Cap on each component of the force \[N\], beside the cap on the vector.
    pub axis_force_max_n: Option<f64>,
    /// Fastest change of each component \[N/s\]: the voltage limit. The lag follows it.
    pub slew_n_s: Option<f64>,
    /// Samples from a position to the effect of the command computed from it, 1 to 7.
    pub delay_samples: usize,
    /// So many samples more a command may be late, each by chance; one that comes after a newer one is dropped. Together with the
    /// delay at most 7.
    pub jitter_samples: usize,
    /// Whether the firmware measures the force that the magnet delivers.
    pub force_measured: bool,
}

/// What tells the chance of the amplifier from that of the sensor, which has the same seed.
const STREAM: u64 = 0x6a09_e667_f3bc_c908;

/// Longest delay \[samples\].
pub(crate) const MOST_DELAY: usize = 7;

impl Default for AmplifierParams {
    fn default() -> Self {
        Self {
            axis_force_max_n: None,
            slew_n_s: None,
            delay_samples: 1,
            jitter_samples: 0,
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

/// Parts of a ramp, held over their halves.
const RAMP_PARTS: u32 = 4;

/// The amplifier at work.
#[derive(Debug, Clone)]
pub(crate) struct Amplifier {
    params: AmplifierParams,
    force_max_n: f64,
    outages: Vec<Outage>,
    /// Whether commands go to the plant as they are.
    plain: bool,
    /// Commands that wait, by the tick at which they take effect; each with a number, from 1.
    pending_n: [(u64, V2); MOST_DELAY + 1],
    /// The command in effect, and its number.
    register_n: V2,
    number: u64,
    /// How late commands are.
    chance: ChaCha8Rng,
    /// Where the slew limit has got to.
    ramped_n: V2,
}

impl Amplifier {
    pub(crate) fn new(
        params: AmplifierParams,
        force_max_n: f64,
        outages: &[Outage],
        seed: u64,
    ) -> Self {
        let limited = params.axis_force_max_n.is_some() || params.slew_n_s.is_some();
        Self {
            params,
            force_max_n,
            outages: outages.to_vec(),
            plain: outages.is_empty() && !limited,
            pending_n: [(0, V2::zeros()); MOST_DELAY + 1],
            register_n: V2::zeros(),
            number: 0,
            chance: ChaCha8Rng::seed_from_u64(seed ^ STREAM),
            ramped_n: V2::zeros(),
        }
    }

    /// The command computed at a tick; what is no number is no command.
    pub(crate) fn command(&mut self, tick: u64, command_n: V2) {
        let finite = command_n.iter().all(|x| x.is_finite());
        let delay = self.params.delay_samples.clamp(1, MOST_DELAY);
        let most = self.params.jitter_samples.min(MOST_DELAY - delay) as u64;
        let late = match most {
            0 => 0,
            most => self.chance.next_u64() % (most + 1),
        };
        let command_n = if finite { command_n } else { V2::zeros() };
        *self.slot(tick + delay as u64 + late) = (tick + 1, command_n);
    }

    /// A command that takes effect without delay: only for a policy that needs no time.
    pub(crate) fn command_at_once(&mut self, command_n: V2) {
        self.register_n = command_n;
    }

    /// A tick begins.
    pub(crate) fn begin(&mut self, tick: u64) {
        let (number, command_n) = *self.slot(tick);
        if number > self.number {
            (self.number, self.register_n) = (number, command_n);
        }
    }

    fn slot(&mut self, tick: u64) -> &mut (u64, V2) {
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

    /// Parts over whose halves a ramp that goes on at a time is to be held; `None` without one.
    pub(crate) fn parts(&self, from_s: f64) -> Option<u32> {
        let ramp = self.params.slew_n_s.is_some() && self.target_n(from_s) != self.ramped_n;
        ramp.then_some(RAMP_PARTS)
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

    /// The limited command, to be held over the two halves of a part in which no outage begins or ends \[N\]. As of loads that
    /// vary, momentum and first moment are those of a ramp; where one ends within the part, only the momentum of each half is.
    pub(crate) fn deliver(&mut self, from_s: f64, to_s: f64) -> [V2; 2] {
        if self.plain {
            return [self.register_n; 2];
        }
        let target_n = self.target_n(from_s);
        let Some(slew) = self.params.slew_n_s else {
            return [target_n; 2];
        };
        // No current flows where the amplifier is out.
        self.ramped_n = self.without_dead_axes(self.ramped_n, from_s);
        let most_n = slew * (to_s - from_s);
        let mut halves_n = [target_n; 2];
        for i in [0, 1] {
            let way_n = target_n[i] - self.ramped_n[i];
            let left_n = way_n.abs();
            let behind_n = match left_n < most_n {
                true => [left_n, left_n - 0.5 * most_n].map(|left_n| mean_n(left_n, 0.5 * most_n)),
                false => [1.0, 5.0].map(|sixths| left_n - most_n * (sixths / 6.0)),
            };
            for (half_n, behind_n) in halves_n.iter_mut().zip(behind_n) {
                half_n[i] -= way_n.signum() * behind_n;
            }
            self.ramped_n[i] = match left_n > most_n {
                true => self.ramped_n[i] + way_n.signum() * most_n,
                false => target_n[i],
            };
        }
        halves_n
    }
}

/// How far a ramp is behind its end, on average over a time in which it could go `most_n`, where `left_n` are left to go.
fn mean_n(left_n: f64, most_n: f64) -> f64 {
    let left_n = left_n.max(0.0);
    match left_n < most_n {
        true => 0.5 * left_n * left_n / most_n,
        false => left_n - 0.5 * most_n,
    }
}
