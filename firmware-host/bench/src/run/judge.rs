//! Watches a run and says its outcome.

use crate::device::loads::Disturbance;
use crate::device::sensor_fault::{ROUND_OFF_PERIODS, seen_until_s};
use crate::run::outcome::Outcome;
use crate::run::swings::Swings;
use crate::scene::Scene;
use plant_model::analysis::whirl::WhirlMeter;
use plant_model::params::PlantParams;
use plant_model::{Meters, Snapshot, V2};
use std::f64::consts::TAU;

/// Inside this share of the clearance the rotor is back in the middle …
const MIDDLE: f64 = 0.3;
/// … once it has stayed there for so long \[s\].
const STAY_S: f64 = 5e-3;
/// A rotor that has stayed there for so long will not leave it by itself \[s\].
const DECIDED_S: f64 = 30e-3;
/// Window of the whirl frequency \[s\].
const WHIRL_WINDOW_S: f64 = 1e-3;
/// A free rotor that moves less than this share of the middle in that time stands still.
const STANDS_STILL: f64 = 0.05;
/// A rotor that touches and is slower than this share of c·√(k_c/m) rests.
const REST_SPEED: f64 = 1e-3;

/// Collects what a verdict needs, sample by sample.
#[derive(Debug, Clone)]
pub(crate) struct Judge {
    middle_m: f64,
    whirl_speed_m_s: f64,
    /// The plane alone.
    plant: PlantParams,
    /// What acts on the rotor and when.
    loads: Vec<Disturbance>,
    /// Where the retainer bearing is as seen from the middle.
    centre_offset_m: V2,
    clock_starts_s: f64,
    period_s: f64,
    whirl: WhirlMeter,
    /// Since when the rotor has been in the middle.
    in_middle_since_s: Option<f64>,
    swings: Swings,
    /// When it came back for good, as far as is known.
    back_since_s: Option<f64>,
    first_contact_s: Option<f64>,
    last_contact_s: Option<f64>,
    /// Beginning of the last contact.
    touches_since_s: f64,
    /// In contact at the last snapshot.
    touched: bool,
    /// Spin at the first sample \[rad/s\].
    first_spin: Option<f64>,
    now_s: f64,
}

impl Judge {
    pub(crate) fn new(scene: &Scene, plane: usize) -> Self {
        Self {
            whirl_speed_m_s: scene.planes[plane].whirl_speed_m_s,
            centre_offset_m: scene.machine.planes[plane].centre_m,
            middle_m: MIDDLE * scene.clearance_m(plane),
            clock_starts_s: scene.clock_starts_s(plane),
            plant: scene.plant(plane),
            loads: scene.loads().collect(),
            period_s: 1.0 / scene.sample_rate_hz,
            whirl: WhirlMeter::new(WHIRL_WINDOW_S),
            in_middle_since_s: None,
            swings: Swings::new(1.0 / scene.sample_rate_hz),
            back_since_s: None,
            first_contact_s: None,
            last_contact_s: None,
            touches_since_s: 0.0,
            touched: false,
            first_spin: None,
            now_s: 0.0,
        }
    }

    /// A control sample.
    pub(crate) fn sample(&mut self, now: &Snapshot) {
        let spin = *self.first_spin.get_or_insert(now.spin_rad_s);
        self.follow_contact(now, spin);
        let away_m = (now.position_m + self.centre_offset_m).norm();
        // With the retainer bearing far off the centre a rotor may lie on it in the middle.
        let free = !now.mode.in_contact();
        let started = seen_until_s(now.t_s, self.period_s) >= self.clock_starts_s;
        match free && started {
            true => self.swings.push(now.t_s, away_m),
            false => self.swings.restart(),
        }
        if free && away_m < self.middle_m && started {
            let since = *self.in_middle_since_s.get_or_insert(now.t_s);
            // Sample times carry round-off.
            if now.t_s - since >= STAY_S * (1.0 - 1e-9) && self.back_since_s.is_none() {
                self.back_since_s = Some(since);
            }
        } else {
            self.in_middle_since_s = None;
        }
        self.now_s = now.t_s;
    }

    /// A change of mode between samples.
    pub(crate) fn change(&mut self, now: &Snapshot) {
        self.follow_contact(now, self.first_spin.unwrap_or(now.spin_rad_s));
    }

    fn follow_contact(&mut self, now: &Snapshot, spin_rad_s: f64) {
        let touches = now.mode.in_contact();
        self.whirl
            .push(now.t_s, now.whirl_angle_rad, touches, spin_rad_s);
        if touches || self.touched {
            // The first snapshot after it stands at the lift-off.
            self.last_contact_s = Some(now.t_s);
        }
        if touches && !self.touched {
            self.touches_since_s = now.t_s;
        }
        self.touched = touches;
        if touches {
            self.first_contact_s.get_or_insert(now.t_s);
            (self.in_middle_since_s, self.back_since_s) = (None, None);
            self.swings.restart();
        }
    }

    /// Whether it has come to whirl, which no run takes back.
    pub(crate) fn whirls(&self, meters: &Meters) -> bool {
        meters.peak_backward_speed_m_s > self.whirl_speed_m_s
    }

    /// Whether the rotor has been back for so long that nothing will change.
    pub(crate) fn is_back(&self) -> bool {
        (self.in_middle_since_s).is_some_and(|since| self.now_s - since >= DECIDED_S)
    }

    /// When it touched first \[s\]; `None` if never.
    pub(crate) fn first_contact_s(&self) -> Option<f64> {
        self.first_contact_s
    }

    /// Largest backward whirl frequency over 1 ms of continuous contact \[Hz\]; `None` without such a contact.
    pub(crate) fn backward_whirl_hz(&self) -> Option<f64> {
        // A rotor at rest on the wall goes round at 0, not at −0.
        self.whirl.fastest().map(|w| w.backward_hz + 0.0)
    }

    /// From the end of the disturbance to the beginning of the stay in the middle \[s\]; `None` if never.
    pub(crate) fn relevitation_time_s(&self, outcome: Outcome) -> Option<f64> {
        match outcome {
            Outcome::Recovered => self.back_since_s.map(|t| self.on_the_clock_s(t)),
            _ => None,
        }
    }

    /// Time of a sample since the clock started, without the round-off of sample times.
    fn on_the_clock_s(&self, t_s: f64) -> f64 {
        let since_s = t_s - self.clock_starts_s;
        match since_s > ROUND_OFF_PERIODS * self.period_s {
            true => since_s,
            false => 0.0,
        }
    }

    /// Spin that is gone, of either sense; a rotor that did not spin cannot lose any, and what it gains is negative.
    pub(crate) fn spin_lost_rad_s(&self, last: f64) -> f64 {
        let first = self.first_spin.unwrap_or(0.0);
        if first == 0.0 {
            return 0.0 - last.abs();
        }
        // What is kept is 0, not −0.
        first.signum() * (first - last) + 0.0
    }

    /// How the run ended, from its last snapshot and the largest backward speed in contact.
    pub(crate) fn outcome(&self, last: &Snapshot, peak_backward_m_s: f64) -> Outcome {
        match peak_backward_m_s > self.whirl_speed_m_s {
            true => Outcome::Whirl,
            false => self.at_end(last),
        }
    }

    /// The same without a look at whirl, which a strong magnet stops even beyond the scene's limit.
    pub(crate) fn at_end(&self, last: &Snapshot) -> Outcome {
        let plant = &self.plant;
        let natural = plant.natural_frequency_rad_s();
        // A rotor whose distance grows as if it were to touch soon is free, and not back.
        let free = |outcome: Outcome| {
            let half_period_s = natural.map_or(0.0, |natural| 0.5 * TAU / natural);
            let clearance_m = plant.contact.clearance_m;
            match self.swings.grow(STAY_S.max(half_period_s), clearance_m) {
                true => Outcome::Diverging,
                false => outcome,
            }
        };
        if self.back_since_s.is_some() {
            return free(Outcome::Recovered);
        }
        let Some(last_contact_s) = self.last_contact_s else {
            // Never touched.
            return free(Outcome::Decayed);
        };
        // Free for long enough to have touched again if it were going to: a period of the shaft, or,
        // without one, time to cross the clearance, unless it stands still.
        let speed = last.velocity_m_s.norm();
        let settled_s = match natural {
            Some(natural) => TAU / natural,
            None if speed * STAY_S < STANDS_STILL * self.middle_m => 0.0,
            None => 4.0 * plant.contact.clearance_m / speed,
        };
        let settled_s = settled_s.max(STAY_S);
        if last.t_s - last_contact_s >= settled_s {
            return free(Outcome::Decayed);
        }
        let rest = REST_SPEED * plant.contact.clearance_m * plant.contact_rate_rad_s();
        let loaded = (self.loads.iter()).any(|d| d.start_s < last.t_s && last.t_s <= d.end_s());
        match (last.mode.in_contact(), loaded) {
            (true, true) => Outcome::Pinned,
            (true, false) if last.velocity_m_s.norm() < rest => Outcome::Resting,
            (true, false) if last.t_s - self.touches_since_s >= settled_s => Outcome::Rubbing,
            _ => Outcome::Bouncing,
        }
    }
}
