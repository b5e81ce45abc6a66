//! What the supervisor promises, against what was measured.

use super::contenders::Contender;
use super::results::ResultRow;
use super::sweeps::{SweepRow, TIMED_SHARE, median, median_of};
use crate::campaign::Claim;
use firmware_bench::run::figures::Figures;
use serde::Serialize;
use std::collections::BTreeMap;

/// Promises about the sweeps.
pub(crate) fn of_sweeps(rows: &[SweepRow]) -> Vec<Claim> {
    let mut promises = Vec::new();
    for row in rows
        .iter()
        .filter(|r| r.policy == Contender::Supervisor.name())
    {
        let here = |contender: Contender| {
            (rows.iter()).find(|r| {
                r.plant == row.plant && r.rate_hz == row.rate_hz && r.policy == contender.name()
            })
        };
        let place = format!("{}, {:.0} kHz", row.plant, 1e-3 * row.rate_hz);
        let own = median(&row.impact_m_s);
        let ratio_to = |contender: Contender| here(contender).map(|r| own / median(&r.impact_m_s));
        let levitated_only = row.plant.starts_with("P2") || row.plant.starts_with("P3");
        if let Some(ratio) = ratio_to(Contender::Clairvoyant) {
            let bound = if levitated_only { 0.92 } else { 0.85 };
            let name = format!("{place}: impact recovered from, over clairvoyant");
            promises.push(Claim::at_least(name, bound, ratio));
        }
        if let (true, Some(ratio)) = (levitated_only, ratio_to(Contender::Tuned)) {
            let name = format!("{place}: impact recovered from, over tuned");
            promises.push(Claim::at_least(name, 1.10, ratio));
        }
        let baselines = [
            Contender::Passive,
            Contender::Radial,
            Contender::Damping,
            Contender::Stiff,
            Contender::Tuned,
        ];
        if let Some(ratio) = ratio_to(Contender::Stiff) {
            let name = format!("{place}: impact recovered from, over stiff");
            promises.push(Claim::at_least(name, 1.0, ratio));
        }
        let best = (baselines.iter().filter_map(|contender| here(*contender)))
            .map(|r| median(&r.impact_m_s))
            .fold(0.0, f64::max);
        let name = format!("{place}: impact recovered from, over the best baseline");
        promises.push(Claim::at_least(name, 1.0, own / best));
        if let Some(reference) = here(Contender::Clairvoyant) {
            let others = best.max(own);
            let name = format!("{place}: clairvoyant over every other policy");
            let ratio = median(&reference.impact_m_s) / others;
            promises.push(Claim::at_least(name, 1.0, ratio));
        }
        let offset = median(&row.offset_impact_m_s) / own;
        let name = format!("{place}: impact with the bearing 10 % off the centre, over centred");
        promises.push(Claim::at_least(name, 0.85, offset));

        let share = median(&row.whirl_share);
        let name = format!("{place}: whirl arrested at take-over, share of v_lim");
        promises.push(Claim::at_least(name, 0.85, share));
        for (contender, bound) in [(Contender::Clairvoyant, 0.95), (Contender::Tuned, 1.0)] {
            if let Some(other) = here(contender) {
                let name = format!("{place}: whirl arrested, over {}", contender.name());
                let ratio = share / median(&other.whirl_share);
                promises.push(Claim::at_least(name, bound, ratio));
            }
        }
        let time_s = slowest(row);
        let name =
            format!("{place}: time to arrest {TIMED_SHARE} v_lim, over closed form + 0.5 ms");
        let bound_s = 1.5 * row.closed_form_s + 5e-4;
        promises.push(Claim::at_most(name, 1.0, time_s / bound_s));
        if let Some(tuned) = here(Contender::Tuned) {
            let name = format!("{place}: time to arrest {TIMED_SHARE} v_lim, over tuned");
            promises.push(Claim::at_most(name, 0.85, time_s / slowest(tuned)));
        }
    }
    promises
}

/// Median time to arrest; infinite where a seed never arrests it.
fn slowest(row: &SweepRow) -> f64 {
    if row.arrest_s.len() < row.whirl_share.len() {
        f64::INFINITY
    } else {
        median(&row.arrest_s)
    }
}

/// Results of a scene under one policy, over its seeds.
type PerScene<'a> = BTreeMap<(String, u64, String), Vec<&'a ResultRow>>;

fn per_scene<'a>(rows: impl Iterator<Item = &'a ResultRow>, policy: &str) -> PerScene<'a> {
    let mut map = PerScene::new();
    for row in rows.filter(|r| r.policy == policy) {
        let key = (row.plant.clone(), row.rate_hz as u64, row.scene.clone());
        map.entry(key).or_default().push(row);
    }
    map
}

/// A scene that the supervisor makes worse than levitation alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Harm {
    /// Plant, rate and scene.
    pub place: String,
    /// Group of the scene in the catalogue.
    pub group: &'static str,
    /// Largest contact force over levitation's, median over the seeds.
    pub force_ratio: f64,
    /// The same, 95th percentile.
    pub force_ratio_95: f64,
    /// Seeds that levitation alone recovers from …
    pub recovered_alone: usize,
    /// … and the supervisor.
    pub recovered: usize,
    pub seeds: usize,
}

/// Every scene against levitation alone, which is the policy of that name.
pub fn against_levitation(rows: &[ResultRow], alone: &str) -> Vec<Harm> {
    let alone = per_scene(rows.iter(), alone);
    let mut all = Vec::new();
    for ((plant, rate, scene), own) in per_scene(rows.iter(), Contender::Supervisor.name()) {
        let Some(other) = alone.get(&(plant.clone(), rate, scene.clone())) else {
            continue;
        };
        let force = |row: &ResultRow| row.metrics.as_ref().map(|m| m.peak_contact_force_n);
        let mut ratios: Vec<f64> = (own.iter().zip(other))
            .filter_map(|(a, b)| match (force(a)?, force(b)?) {
                // No contact in either is no harm.
                (a, b) if a == b => Some(1.0),
                (a, b) => Some(a / b),
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        all.push(Harm {
            place: format!("{plant}, {} kHz: {scene}", 1e-3 * rate as f64),
            group: own.first().map_or("", |r| r.group),
            force_ratio: median(&ratios),
            force_ratio_95: percentile(&ratios, 0.95),
            recovered_alone: other.iter().filter(|r| r.recovered()).count(),
            recovered: own.iter().filter(|r| r.recovered()).count(),
            seeds: own.len(),
        });
    }
    all
}

/// Promises about the catalogue, compared with levitation alone.
pub(crate) fn of_results(rows: &[ResultRow], harms: &[Harm]) -> Vec<Claim> {
    let worst = |value: &dyn Fn(&Harm) -> f64| harms.iter().map(value).fold(0.0, f64::max);
    let medians = force_ratios(harms);
    let mut promises = vec![
        Claim::at_most(
            "largest contact force over levitation alone: worst scene's median",
            1.0,
            worst(&|h| h.force_ratio),
        ),
        Claim::at_most(
            "largest contact force over levitation alone: worst scene's 95th percentile",
            1.10,
            worst(&|h| h.force_ratio_95),
        ),
        Claim::at_most(
            "largest contact force over levitation alone: median of the scenes' medians",
            1.0,
            percentile(&medians, 0.5),
        ),
        Claim::at_most(
            "largest contact force over levitation alone: 95th percentile of the scenes' medians",
            1.10,
            percentile(&medians, 0.95),
        ),
        Claim::at_most(
            "scenes with fewer recoveries than chance explains",
            0.0,
            harms.iter().filter(|h| lost_beyond_chance(h)).count() as f64,
        ),
    ];
    promises.extend(of_static_overloads(rows));
    promises
}

/// Ratios of the largest contact forces of some scenes, ascending; one that is no number counts as infinite.
pub(super) fn force_ratios<'a>(harms: impl IntoIterator<Item = &'a Harm>) -> Vec<f64> {
    let finite = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    let mut ratios: Vec<f64> = harms.into_iter().map(|h| finite(h.force_ratio)).collect();
    ratios.sort_by(f64::total_cmp);
    ratios
}

/// The smallest of ascending values that is not below this share of them; not a number without any.
pub(super) fn percentile(ascending: &[f64], share: f64) -> f64 {
    let index = (share * (ascending.len().max(1) - 1) as f64).ceil() as usize;
    ascending.get(index).copied().unwrap_or(f64::NAN)
}

/// Fewer recoveries than 95 % of binomial draws with levitation's rate would have: with p = 1 any loss.
pub(super) fn lost_beyond_chance(harm: &Harm) -> bool {
    let (n, p) = (
        harm.seeds,
        harm.recovered_alone as f64 / harm.seeds.max(1) as f64,
    );
    // Probability of at most as many recoveries as were seen.
    let mut probability = 0.0;
    let mut choose = 1.0;
    for k in 0..=harm.recovered {
        if k > 0 {
            choose *= (n - k + 1) as f64 / k as f64;
        }
        probability += choose * p.powi(k as i32) * (1.0 - p).powi((n - k) as i32);
    }
    harm.recovered < harm.recovered_alone && probability < 0.05
}

fn of_static_overloads(rows: &[ResultRow]) -> Vec<Claim> {
    let overloads = || rows.iter().filter(|r| r.group == "static overload");
    let alone = per_scene(overloads(), Contender::Tuned.name());
    let (mut impacts, mut force, mut impulse, mut back_s) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    for (key, own) in per_scene(overloads(), Contender::Supervisor.name()) {
        let Some(other) = alone.get(&key) else {
            continue;
        };
        let middle = |rows: &[&ResultRow], value: &dyn Fn(&Figures) -> f64| {
            let of = |r: &&ResultRow| r.metrics.as_ref().map_or(f64::INFINITY, value);
            median_of(rows.iter().map(of))
        };
        let pair = |value: &dyn Fn(&Figures) -> f64| (middle(&own, value), middle(other, value));
        let (a, b) = pair(&|m| m.contacts_over_20_mm_s as f64);
        impacts = impacts.max(a - b);
        let (a, b) = pair(&|m| m.peak_contact_force_n);
        let ratio = |a: f64, b: f64| if a == b { 0.0 } else { a / b };
        force = force.max(ratio(a, b));
        let (a, b) = pair(&|m| m.contact_impulse_n_s);
        impulse = impulse.max(ratio(a, b));
        back_s = back_s.max(middle(&own, &|m| {
            m.relevitation_time_s.unwrap_or(f64::INFINITY)
        }));
    }
    vec![
        Claim::at_most(
            "static overload: hard touches more than levitation alone",
            1.0,
            impacts,
        ),
        Claim::at_most(
            "static overload: largest contact force over levitation alone",
            1.05,
            force,
        ),
        Claim::at_most(
            "static overload: contact impulse over levitation alone",
            0.95,
            impulse,
        ),
        Claim::at_most("static overload: re-levitated after [s]", 0.02, back_s),
    ]
}
