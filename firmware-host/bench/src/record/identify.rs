//! What an event tells of its machine: friction, restitution, load, unbalance and clearance, each with an interval.

use crate::record::contacts::{Contact, Found, meets};
use crate::record::flights::Fit;
use crate::record::motion::{Instant, Motion, is_measured};
use crate::record::narrative::Event;
use plant_model::V2;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use supervisor::Events;

/// A value, and between what it lies with 95 % probability: by the noise and the scatter of the record, and by what the model of
/// the contact leaves out, as found on machines whose values are known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    pub value: f64,
    /// Lower and upper end of the interval.
    pub low: f64,
    /// See `low`.
    pub high: f64,
}

/// What is identified; `None` of what the record does not show closely enough.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Identified {
    pub friction_coefficient: Option<Estimate>,
    /// Restitution of a radial impact.
    pub restitution: Option<Estimate>,
    /// Load while the supervisor was engaged, as a force at the retainer bearing \[N\].
    pub load_x_n: Option<Estimate>,
    /// See `load_x_n`.
    pub load_y_n: Option<Estimate>,
    /// Distance of the mass centre from the axis \[m\].
    pub eccentricity_m: Option<Estimate>,
    /// Clearance \[m\].
    pub clearance_m: Option<Estimate>,
}

/// The rotor on its way to the first contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Launch {
    /// When \[ticks since the first\].
    pub tick: usize,
    /// Position \[m\].
    pub position_m: V2,
    /// Velocity \[m/s\].
    pub velocity_m_s: V2,
    /// Spin \[rad/s\].
    pub spin_rad_s: f64,
}

/// What was found in a record.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// Sequence number of the tick from which times are counted.
    pub first: u32,
    /// Contacts between two flights, in order.
    pub contacts: Vec<Contact>,
    /// Where the rotor came from.
    pub launch: Launch,
    /// Ticks between which the load acted; no second one where it did as long as the rotor is seen to fly.
    pub loaded: (usize, Option<usize>),
    /// What it tells.
    pub identified: Identified,
}

/// Impacts that an estimate from impacts needs.
const IMPACTS: usize = 3;
/// Widest intervals either way: of the coefficient of friction and the clearance as shares of them, of the restitution, of a
/// load as a share of the cap, of the eccentricity as a share of the clearance.
const FRICTION: f64 = 0.1;
const RESTITUTION: f64 = 0.1;
const CLEARANCE: f64 = 0.05;
const LOAD: f64 = 0.2;
const ECCENTRICITY: f64 = 0.05;
/// What the model leaves out, one standard error: shares of the coefficient of friction and of the clearance, and of the
/// restitution as it is.
const LEFT_OUT_FRICTION: f64 = 0.03;
const LEFT_OUT_CLEARANCE: f64 = 0.01;
const LEFT_OUT_RESTITUTION: f64 = 0.02;

impl Event<'_> {
    /// What is found out from its ticks; `None` where they or the configuration are not whole, where the rotor flew nowhere, and
    /// of the planes of a rotor, which move each other.
    pub fn findings(&self) -> Option<Findings> {
        let [record] = self.records[..] else {
            return None;
        };
        let config = record.config.filter(|_| record.head.planes == 1)?;
        // How much of the delay is the sensor's is not known.
        let delay = config.delay_samples.clamp(0.0, 7.0) as usize;
        // By commands alone forces come at the time that the whole delay says.
        let latest = if is_measured(record.entries.values()) {
            delay
        } else {
            0
        };
        let found = (0..=latest).filter_map(|late| found_in(&Motion::of(record, late)?));
        let (_, findings) = found.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        Some(findings)
    }
}

/// What was found, and how well flights are fitted.
fn found_in(motion: &Motion) -> Option<(f64, Findings)> {
    let Found { fit, contacts } = Found::new(motion)?;
    let impulses = || (contacts.iter()).filter_map(|(after, c)| Some((*after, c.impulse?)));
    let steady = || impulses().filter(|(_, impulse)| impulse.steady);
    let clearances: Vec<(f64, f64)> = steady()
        .filter(|(_, impulse)| impulse.single)
        .filter_map(|(after, _)| Some((clearance(motion, &fit, after - 1)?, fit.noise_m)))
        .collect();
    let restitution: Vec<(f64, f64)> = steady()
        .filter(|(_, impulse)| impulse.single)
        .map(|(_, impulse)| ratio(impulse.normal_m_s, impulse.normal_errors_m_s))
        .collect();
    // Friction drives the rotor against its spin.
    let against = -motion
        .instants
        .iter()
        .map(|i| i.spin_rad_s)
        .sum::<f64>()
        .signum();
    let friction: Vec<(f64, f64)> = steady()
        .map(|(_, impulse)| ratio(impulse.over_mass_m_s, impulse.errors_m_s))
        .map(|(mu, error)| (against * mu, error))
        .collect();
    let within = |estimate: Estimate, most: f64| (estimate.half() <= most).then_some(estimate);
    let mean = |of: &[(f64, f64)]| {
        if of.len() >= IMPACTS {
            pooled(of)
        } else {
            None
        }
    };
    let cap_n = f64::from(motion.config.force_max_n);
    let engaged = engaged_at(motion);
    let load = largest_load(&fit, engaged);
    let of_load = load_n(motion, &fit, load);
    let known = of_load.iter().all(|l| l.half() <= LOAD * cap_n);
    let [load_x_n, load_y_n] = of_load.map(|l| known.then_some(l));
    let identified = Identified {
        friction_coefficient: mean(&friction)
            .filter(|_| motion.spin_known)
            .map(|e| e.wider(LEFT_OUT_FRICTION * e.value))
            .and_then(|e| within(e, FRICTION * e.value)),
        restitution: mean(&restitution)
            .map(|e| e.wider(LEFT_OUT_RESTITUTION))
            .and_then(|e| within(e, RESTITUTION)),
        load_x_n,
        load_y_n,
        eccentricity_m: eccentricity(&fit)
            .and_then(|e| within(e, ECCENTRICITY * motion.clearance_m())),
        clearance_m: mean(&clearances)
            .map(|e| e.wider(LEFT_OUT_CLEARANCE * e.value))
            .and_then(|e| within(e, CLEARANCE * e.value)),
    };
    let findings = Findings {
        first: motion.first,
        launch: launch(motion, &fit, engaged),
        loaded: loaded(&fit, load),
        contacts: contacts.into_iter().map(|(_, contact)| contact).collect(),
        identified,
    };
    Some((fit.noise_m, findings))
}

impl Estimate {
    fn new(value: f64, half: f64) -> Self {
        Self {
            value,
            low: value - half,
            high: value + half,
        }
    }

    /// With another standard error.
    fn wider(self, error: f64) -> Self {
        Self::new(self.value, self.half().hypot(TWO_SIDED * error))
    }

    fn half(&self) -> f64 {
        0.5 * (self.high - self.low)
    }
}

/// The second of a pair over the first, and its standard error.
fn ratio([below, above]: [f64; 2], [error_below, error_above]: [f64; 2]) -> (f64, f64) {
    let ratio = above / below;
    (ratio, error_above.hypot(ratio * error_below) / below.abs())
}

/// Mean of values with their standard errors, by these; its interval by these, or by the scatter where that is wider.
fn pooled(of: &[(f64, f64)]) -> Option<Estimate> {
    let weights: f64 = of.iter().map(|(_, s)| s.powi(-2)).sum();
    let value = of.iter().map(|(x, s)| x * s.powi(-2)).sum::<f64>() / weights;
    let freedom = (of.len() - 1) as f64;
    let scatter = of
        .iter()
        .map(|(x, s)| ((x - value) / s).powi(2))
        .sum::<f64>()
        / freedom;
    let student = StudentsT::new(0.0, 1.0, freedom).ok()?.inverse_cdf(0.975);
    let half = TWO_SIDED.max(student * scatter.sqrt()) / weights.sqrt();
    (value.is_finite() && half.is_finite()).then(|| Estimate::new(value, half))
}

/// So many standard errors either way are 95 %.
const TWO_SIDED: f64 = 1.96;

/// Tick of the first engagement, or the first of all.
fn engaged_at(motion: &Motion) -> usize {
    let engaged = |i: &Instant| i.events.contains(Events::ENGAGED);
    motion.instants.iter().position(engaged).unwrap_or(0)
}

/// The largest load from the engagement on: one may have ended before the record did.
fn largest_load(fit: &Fit<'_>, engaged: usize) -> usize {
    let acted = fit
        .flights
        .iter()
        .filter(|f| f.to > engaged)
        .map(|f| f.load);
    let size = |load: &usize| {
        let (load, error) = fit.load(*load);
        load.norm() - TWO_SIDED * error.norm()
    };
    acted
        .max_by(|a, b| size(a).total_cmp(&size(b)))
        .unwrap_or(0)
}

fn load_n(motion: &Motion, fit: &Fit<'_>, load: usize) -> [Estimate; 2] {
    let (load, error) = fit.load(load);
    let mass = motion.mass_kg();
    [0, 1].map(|i| Estimate::new(mass * load[i], TWO_SIDED * mass * error[i]))
}

/// Ticks from the flight on in which a load sets in to the last one of it, where another follows.
fn loaded(fit: &Fit<'_>, load: usize) -> (usize, Option<usize>) {
    let of = || fit.flights.iter().filter(|f| f.load == load);
    let from = of().next().map_or(0, |f| f.from);
    let ends = fit.flights.last().is_some_and(|f| f.load != load);
    (from, of().next_back().filter(|_| ends).map(|f| f.to))
}

/// At the begin of the flight in which the supervisor engaged, or of the one before.
fn launch(motion: &Motion, fit: &Fit<'_>, engaged: usize) -> Launch {
    let number = fit
        .flights
        .iter()
        .rposition(|f| f.from <= engaged)
        .unwrap_or(0);
    let tick = fit.flights.get(number).map_or(0, |f| f.from);
    let state = fit.state(number, tick as f64);
    Launch {
        tick,
        position_m: state.position_m,
        velocity_m_s: state.velocity_m_s,
        spin_rad_s: motion.instants.get(tick).map_or(0.0, |i| i.spin_rad_s),
    }
}

fn eccentricity(fit: &Fit<'_>) -> Option<Estimate> {
    let (unbalance, error) = fit.unbalance()?;
    let size = unbalance.norm();
    let estimate = Estimate::new(size, TWO_SIDED * error.norm());
    Some(Estimate {
        low: estimate.low.max(0.0),
        ..estimate
    })
}

/// The clearance at which the flights before and after a contact are apart by the time that an impact lasts.
fn clearance(motion: &Motion, fit: &Fit<'_>, before: usize) -> Option<f64> {
    let lasts = |radius_m: f64| {
        let [from, to] = meets(fit, before, radius_m);
        Some(to? - from?)
    };
    let configured = motion.clearance_m();
    let (mut low, mut high) = (0.9 * configured, 1.1 * configured);
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        // Farther out the flights meet later and part sooner.
        if lasts(middle).is_some_and(|ticks| ticks > motion.impact_ticks()) {
            low = middle;
        } else {
            high = middle;
        }
    }
    lasts(low).map(|_| low)
}
