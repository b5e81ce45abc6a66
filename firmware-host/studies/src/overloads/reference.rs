//! The search for the reference's weights.

use super::contenders::clairvoyant;
use super::impact::{FIRST_M_S, STEP};
use super::takeover::{arrest_of, take_over};
use crate::campaign::each;
use firmware_bench::run::clairvoyant::ClairvoyantLaw;
use firmware_bench::run::closed_loop::{Keep, RunError, run_policy};
use firmware_bench::scene::Scene;
use plant_model::V2;
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, Uniform};

/// Weights tried at random, and then around the best.
const AT_RANDOM: usize = 240;
const AROUND: usize = 60;
/// Rounds of the second.
const ROUNDS: usize = 2;
/// The search distinguishes speeds by this factor.
pub(crate) const FINE: f64 = 1.0125;

/// Ranges of the weights: the law that comes out of the supervisor's derivation is well inside.
pub(crate) const RANGES: [(f64, f64); 5] = [
    (0.0, 3.0),
    (0.0, 3.0),
    (-0.3, 0.8),
    (1.5, 40.0),
    (0.0, 0.95),
];
/// Which of them is drawn by its logarithm: the damper.
const BY_LOGARITHM: usize = 3;
/// Where a search begins.
pub(crate) const START: [f64; 5] = [0.8, 0.8, 0.15, 4.0, 0.2];

pub(crate) fn law_of(w: [f64; 5]) -> ClairvoyantLaw {
    ClairvoyantLaw {
        flight_gain: w[0],
        contact_gain: w[1],
        tilt: w[2],
        damper: w[3],
        restoring: w[4],
    }
}

/// Searches the weights with the highest score, from a start.
pub(crate) fn search<const N: usize>(
    ranges: [(f64, f64); N],
    start: [f64; N],
    score: &(dyn Fn([f64; N]) -> Result<f64, RunError> + Sync),
) -> Result<(f64, [f64; N]), RunError> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut share = || -> f64 {
        match Uniform::new(0.0, 1.0) {
            Ok(uniform) => uniform.sample(&mut random),
            Err(_) => 0.5,
        }
    };
    let mut draw = |centre: Option<[f64; N]>| {
        let mut w = [0.0; N];
        for (i, (low, high)) in ranges.into_iter().enumerate() {
            let s = share();
            w[i] = match centre {
                None if i == BY_LOGARITHM => low * (high / low).powf(s),
                None => low + (high - low) * s,
                Some(c) if i == BY_LOGARITHM => {
                    (c[i] * 1.5_f64.powf(2.0 * s - 1.0)).clamp(low, high)
                }
                Some(c) => (c[i] + 0.1 * (high - low) * (2.0 * s - 1.0)).clamp(low, high),
            };
        }
        w
    };
    let rate = |all: &[[f64; N]]| {
        let rated = each(all, |w| Ok((score(*w)?, *w)));
        rated.into_iter().collect::<Result<Vec<_>, RunError>>()
    };
    let best = |all: Vec<(f64, [f64; N])>, before: (f64, [f64; N])| {
        (all.into_iter()).fold(
            before,
            |best, next| if next.0 > best.0 { next } else { best },
        )
    };
    let mut all: Vec<[f64; N]> = (0..AT_RANDOM).map(|_| draw(None)).collect();
    all.push(start);
    let mut found = best(rate(&all)?, (f64::NEG_INFINITY, start));
    for _ in 0..ROUNDS {
        let all: Vec<[f64; N]> = (0..AROUND).map(|_| draw(Some(found.1))).collect();
        found = best(rate(&all)?, found);
    }
    Ok(found)
}

/// Searches the law of one plane with the highest score.
fn search_law(
    score: &(dyn Fn(ClairvoyantLaw) -> Result<f64, RunError> + Sync),
) -> Result<ClairvoyantLaw, RunError> {
    let (_, weights) = search(RANGES, START, &|w| score(law_of(w)))?;
    Ok(law_of(weights))
}

/// Weights with the hardest impact recovered from.
///
/// # Errors
/// [`RunError`] of a run that cannot be trusted.
pub(crate) fn impact_law(scene: &Scene, from_m_s: f64) -> Result<ClairvoyantLaw, RunError> {
    search_law(&|law| {
        let mut scene = scene.clone();
        let (mut speed, mut last) = (from_m_s, 0.0);
        loop {
            scene.start.centre_velocity_m_s = V2::new(speed, 0.0);
            let policy = Box::new(clairvoyant(law, &scene));
            let (verdict, _) =
                run_policy(&scene, (policy, "clairvoyant"), Keep::Decision, &mut |_| {})?;
            if !verdict.recovered {
                return Ok(last);
            }
            last = speed;
            speed *= FINE;
        }
    })
}

/// A speed from which the search may start: some steps of the grid below one that is known.
pub(crate) fn search_from_m_s(known_m_s: f64) -> f64 {
    (known_m_s / STEP.powi(5)).max(FIRST_M_S)
}

/// Weights that arrest the fastest whirl, and of those the one that arrests 0.85 v_lim soonest.
///
/// # Errors
/// [`RunError`] of a run that cannot be trusted.
pub(crate) fn whirl_law(scene: &Scene) -> Result<Option<ClairvoyantLaw>, RunError> {
    let Some(arrest) = arrest_of(scene, 0) else {
        return Ok(None);
    };
    let score = |law: ClairvoyantLaw| {
        let run = |share: f64| {
            let policy = Box::new(clairvoyant(law, scene));
            take_over(scene, share * arrest.limit_m_s, (policy, "clairvoyant"))
        };
        let (mut share, mut last) = (0.7, 0.0);
        while run(share)?.recovered {
            last = share;
            share *= FINE;
        }
        let time_s = run(0.85)?.arrested_s.unwrap_or(1.0);
        Ok(last - time_s)
    };
    search_law(&score).map(Some)
}
