//! Impacts, friction, restitution and outcome as found, held against what the plant did.

use firmware_bench::record::identify::{Estimate, Findings};
use firmware_bench::run::clairvoyant::restitution;
use firmware_bench::run::trace::{Trace, TraceRow};
use firmware_bench::scene::Scene;
use plant_model::ContactMode;
use std::ops::AddAssign;

/// Normal speed from which an impact is to be found \[m/s\], and by how much its time may be off \[ticks\].
pub(crate) const IMPACT_M_S: f64 = 0.005;
/// See [`IMPACT_M_S`].
pub(crate) const OFF_TICKS: f64 = 2.0;

/// Of how many things how many are right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Share {
    /// How many are.
    pub right: usize,
    /// Of how many.
    pub of: usize,
}

impl Share {
    /// One more.
    pub fn count(&mut self, right: bool) {
        self.right += usize::from(right);
        self.of += 1;
    }

    /// As a share; 1 of none.
    pub fn share(self) -> f64 {
        match self.of {
            0 => 1.0,
            of => self.right as f64 / of as f64,
        }
    }

    pub(super) fn text(self) -> String {
        format!("{} of {}", self.right, self.of)
    }

    fn of_estimate(&mut self, estimate: Option<Estimate>, truth: f64, off: f64) {
        if let Some(estimate) = estimate {
            self.count((estimate.value - truth).abs() <= off);
        }
    }
}

impl AddAssign for Share {
    fn add_assign(&mut self, other: Self) {
        self.right += other.right;
        self.of += other.of;
    }
}

/// An impact of the plant that no contact of the findings is at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Missed {
    /// Normal speed \[m/s\].
    pub speed_m_s: f64,
    /// Time off the wall before it, and until the next touch after it \[ticks\].
    pub flight_ticks: [f64; 2],
    /// From the last and to the next contact that was found \[ticks\].
    pub nearest_ticks: f64,
}

/// What was found, and how much of it is right.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Counts {
    /// Impacts of the plant that were found.
    pub impacts: Share,
    /// Contacts found that are the plant's.
    pub contacts: Share,
    /// Coefficients of friction within a tenth, of those that were identifiable.
    pub friction: Share,
    /// Restitutions within 0.1.
    pub restitution: Share,
    /// Outcomes that are the plant's.
    pub outcomes: Share,
    /// Impacts that were not found.
    pub missed: Vec<Missed>,
}

impl AddAssign<&Self> for Counts {
    fn add_assign(&mut self, other: &Self) {
        self.impacts += other.impacts;
        self.contacts += other.contacts;
        self.friction += other.friction;
        self.restitution += other.restitution;
        self.outcomes += other.outcomes;
        self.missed.extend(&other.missed);
    }
}

/// What the plant did in the ticks of a record.
struct Truth {
    /// Times at which the rotor came to the wall \[ticks since the first\], with its normal speed \[m/s\].
    impacts: Vec<(f64, f64)>,
    /// Times at which it was there.
    touching: Vec<f64>,
}

impl Truth {
    fn new(scene: &Scene, trace: &Trace, (first, last): (u32, u32)) -> Self {
        let tick = |row: &TraceRow| row.plant.t_s * scene.sample_rate_hz - f64::from(first);
        let within = 0.0..=f64::from(last.wrapping_sub(first));
        let (mut impacts, mut touching) = (Vec::new(), Vec::new());
        for pair in trace.rows.windows(2) {
            let (plant, at) = (&pair[1].plant, tick(&pair[1]));
            if !within.contains(&at) || plant.mode == ContactMode::Flight {
                continue;
            }
            touching.push(at);
            if pair[0].plant.mode == ContactMode::Flight {
                let n = plant.position_m.normalize();
                impacts.push((at, plant.velocity_m_s.dot(&n)));
            }
        }
        Self { impacts, touching }
    }

    /// Time off the wall before and after an impact, as far as the record shows it.
    fn flights(&self, at: f64) -> [f64; 2] {
        let before = self.touching.iter().rev().find(|t| **t < at);
        let after = self.impacts.iter().find(|(t, _)| *t > at);
        [
            before.map_or(f64::INFINITY, |t| at - t),
            after.map_or(f64::INFINITY, |(t, _)| t - at),
        ]
    }
}

/// Compares impacts and contacts of the findings with those of the plant; `last`: sequence number of the record's last entry.
pub fn contacts(scene: &Scene, trace: &Trace, last: u32, found: &Findings) -> Counts {
    let truth = Truth::new(scene, trace, (found.first, last));
    let mut counts = Counts::default();
    let hard = |(_, speed): &&(f64, f64)| *speed > IMPACT_M_S;
    for (tick, speed_m_s) in truth.impacts.iter().filter(hard) {
        let away = |(from, to): (f64, f64)| (from - tick).max(tick - to).max(0.0);
        let all = found
            .contacts
            .iter()
            .map(|c| away((c.from_tick, c.to_tick)));
        let nearest_ticks = all.fold(f64::INFINITY, f64::min);
        counts.impacts.count(nearest_ticks <= OFF_TICKS);
        if nearest_ticks > OFF_TICKS {
            counts.missed.push(Missed {
                speed_m_s: *speed_m_s,
                flight_ticks: truth.flights(*tick),
                nearest_ticks,
            });
        }
    }
    for contact in &found.contacts {
        let at = contact.from_tick - OFF_TICKS..=contact.to_tick + OFF_TICKS;
        let is_real = truth.touching.iter().any(|tick| at.contains(tick));
        counts.contacts.count(is_real);
    }
    counts
}

/// Compares friction, where it is the same throughout, and restitution as well.
pub fn compare(scene: &Scene, trace: &Trace, last: u32, found: &Findings) -> Counts {
    let mut counts = contacts(scene, trace, last, found);
    let plant = scene.plant(0);
    let mut changed = (scene.changes.iter())
        .filter_map(|change| Some((change.at_s, change.change.friction_coefficient?)));
    let mu = match changed.next_back() {
        None => Some(plant.friction.sliding.coefficient(0.0)),
        Some((0.0, mu)) => Some(mu),
        Some(_) => None,
    };
    let identified = &found.identified;
    if let Some(mu) = mu {
        (counts.friction).of_estimate(identified.friction_coefficient, mu, 0.1 * mu);
    }
    (counts.restitution).of_estimate(identified.restitution, restitution(&plant), 0.1);
    counts
}
