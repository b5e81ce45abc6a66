//! Scenes in which the supervisor is in a known mode at a known instant. When that is differs from plant to plant by
//! more than a mode lasts, so it is not written down but found, by watching a supervisor to which nothing else happens.

use super::case::{Sizes, aimed, load, seeded};
use super::takeover::let_whirl;
use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use supervisor::Mode;

/// An instant in a mode.
#[derive(Debug, Clone)]
pub struct Situation {
    /// Name of the mode, as in names of scenes.
    pub name: &'static str,
    pub mode: Mode,
    /// What leads there; nothing else happens in it.
    pub scene: Scene,
    /// In the middle of the longest time in that mode, whatever the noise \[s\].
    pub at_s: f64,
}

/// How long the supervisor is watched \[s\].
const WATCHED_S: f64 = 0.06;
/// Shares of the reference sizes that are tried one after the other: the first that leads to the mode is taken.
const SHARES: [f64; 4] = [0.5, 0.7, 0.85, 1.0];
/// Seeds of the noise.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=10;
/// Shorter than this a mode is hardly reached.
const SOME_SAMPLES: usize = 3;

/// Makes of a scene one that leads to a mode, at a share of the reference size.
type Way<'a> = &'a dyn Fn(f64, &mut Scene);

/// A situation for each mode but [`Mode::SensorFault`], with a supervisor in front of this loop; a mode that it does
/// not get into on this plant is left out.
pub fn situations(base: &Scene, sizes: Sizes, tuned: LevitationParams) -> Vec<Situation> {
    let at_rest = |_share: f64, _scene: &mut Scene| {};
    let impact = |share: f64, scene: &mut Scene| {
        scene.start = aimed(base, share * sizes.impact_m_s, 30.0);
    };
    let whirl = |share: f64, scene: &mut Scene| {
        let_whirl(scene, share * sizes.limit_m_s);
    };
    // Of a load at the wall, by the shaft [caps].
    let carried = base.plant(0).rotor.stiffness_n_m * base.clearance_m(0) / sizes.force_n;
    let overload = |share: f64, scene: &mut Scene| {
        scene.disturbances = vec![load(sizes, 3.0 * share + carried, 0.0, WATCHED_S)];
    };
    let ways: [(&'static str, Mode, &[f64], Way<'_>); 6] = [
        ("idle", Mode::Levitated, &[0.0], &at_rest),
        ("approach", Mode::Approach, &SHARES, &impact),
        ("bounce", Mode::Bounce, &[1.0], &impact),
        ("whirl", Mode::BackwardWhirl, &SHARES, &whirl),
        ("pinned", Mode::Pinned, &SHARES, &overload),
        ("hand-over", Mode::Handover, &SHARES, &impact),
    ];
    let mut all = Vec::new();
    for (name, mode, shares, lead) in ways {
        all.extend(shares.iter().find_map(|&share| {
            let mut scene = base.clone();
            scene.levitated_before = true;
            lead(share, &mut scene);
            let at_s = middle_of_longest(mode, &scene, tuned)?;
            Some(Situation {
                name,
                mode,
                scene,
                at_s,
            })
        }));
    }
    all
}

/// Middle of the longest time in which the supervisor is in a mode whatever the noise \[s\].
fn middle_of_longest(mode: Mode, scene: &Scene, tuned: LevitationParams) -> Option<f64> {
    let mut there: Vec<bool> = Vec::new();
    for seed in SEEDS {
        let mut watched = seeded(scene, seed);
        watched.duration_s = WATCHED_S;
        watched.planes[0].levitation = Some(tuned);
        let (_, trace) = run(&watched, PolicyKind::Supervisor, Keep::Trace, &mut |_| {}).ok()?;
        let at_samples = trace.rows.iter().filter(|row| !row.mode_change);
        let now = at_samples.map(|row| row.supervisor_mode() == Some(mode));
        there = match there.as_slice() {
            [] => now.collect(),
            before => before.iter().zip(now).map(|(a, b)| *a && b).collect(),
        };
    }
    let mut begin = 0;
    let times = there.chunk_by(|a, b| a == b).map(|time| {
        let span = (begin, time.len());
        begin += time.len();
        (span, time.first() == Some(&true))
    });
    let spans = times.filter_map(|(span, there)| there.then_some(span));
    let (from, samples) = spans.max_by_key(|(_, samples)| *samples)?;
    let middle = from + samples / 2;
    (samples >= SOME_SAMPLES).then_some(middle as f64 / scene.sample_rate_hz)
}
