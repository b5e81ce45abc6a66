//! Which stretch of time a section shows, and which axes the tracks share.

use crate::report::plot::thin::Interval;
use crate::report::summary::SceneSummary;
use crate::report::track::Track;
use crate::run::outcome::Outcome;

/// A run that would stretch the shared axis more than this gets one of its own.
const OWN_SCALE_FROM: f64 = 3.0;

/// From the start to the end of the longest track, and what else is to be in it.
pub(super) fn window_of<'a>(
    tracks: impl IntoIterator<Item = &'a Track>,
    also: Option<Interval>,
) -> Interval {
    let ends = tracks.into_iter().filter_map(|track| {
        let ends = [track.t.first(), track.t.last()];
        Interval::of(ends.into_iter().flatten().copied())
    });
    match ends.chain(also).reduce(Interval::with) {
        Some(all) if all.size() > 0.0 => all,
        _ => Interval { lo: 0.0, hi: 1.0 },
    }
}

/// From the start to the end of the scene and of its longest run \[ms\].
pub(super) fn run_window(scene: &SceneSummary, tracks: &[Track]) -> Interval {
    window_of(tracks, Interval::of([0.0, 1e3 * scene.duration_s]))
}

/// The stretch \[ms\] of `whole` in which the runs that settle do something; `None` where that is not much shorter.
pub(super) fn focus_window(
    whole: Interval,
    disturbances: &[Interval],
    tracks: &[Track],
) -> Option<Interval> {
    let events: Vec<_> = tracks.iter().map(Track::eventful).collect();
    let settles = |track: &Track| track.outcome.is_some_and(Outcome::recovered);
    let settled = tracks
        .iter()
        .zip(&events)
        .filter(|(track, _)| settles(track));
    let settled = settled.filter_map(|(_, span)| *span).reduce(Interval::with);
    let first = events
        .iter()
        .flatten()
        .map(|span| span.lo)
        .reduce(f64::min)?;
    // Runs that never settle have no last event worth waiting for: show how they begin.
    let last = settled.map_or(first + 0.05 * whole.size(), |span| span.hi.max(first));
    let disturbed = disturbances.iter().map(|span| span.lo).reduce(f64::min);
    let first = disturbed
        .map_or(first, |begin| begin.min(first))
        .max(whole.lo);
    let margin = |share: f64| (share * (last - first)).max(0.002 * whole.size());
    let (lo, hi) = (first - margin(0.1), last + margin(0.15));
    let window = Interval { lo, hi }.within(whole)?;
    (window.size() < 0.5 * whole.size()).then_some(window)
}

/// Disturbance intervals \[ms\].
pub(super) fn disturbances(scene: &SceneSummary) -> Vec<Interval> {
    let spans = scene.disturbances.iter();
    spans
        .filter_map(|d| Interval::of([1e3 * d.from_s, 1e3 * d.to_s]))
        .collect()
}

/// The axis of each track, and whether it is the track's own: all share the axis of the runs without
/// whirl, except where that would flatten those.
pub(super) fn axes(ranges: &[Interval], tracks: &[&Track]) -> Vec<(Interval, bool)> {
    let calm = ranges
        .iter()
        .zip(tracks)
        .filter(|(_, track)| track.outcome != Some(Outcome::Whirl));
    let calm = calm.map(|(range, _)| *range).reduce(Interval::with);
    let Some(calm) = calm.or_else(|| all_of(ranges)) else {
        return Vec::new();
    };
    let fits = |range: &Interval| calm.with(*range).size() <= OWN_SCALE_FROM * calm.size();
    let shared = ranges
        .iter()
        .filter(|range| fits(range))
        .fold(calm, |all, range| all.with(*range));
    let axis = |range: &Interval| {
        if fits(range) {
            (shared, false)
        } else {
            (*range, true)
        }
    };
    ranges.iter().map(axis).collect()
}

/// The same axis for each track.
pub(super) fn one_axis(ranges: &[Interval]) -> Vec<(Interval, bool)> {
    all_of(ranges).map_or(Vec::new(), |all| vec![(all, false); ranges.len()])
}

fn all_of(ranges: &[Interval]) -> Option<Interval> {
    ranges.iter().copied().reduce(Interval::with)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture::{Samples, run, scene};

    fn track(name: &str, outcome: Outcome, samples: Samples) -> Track {
        Track::of_run(&scene(), &run(name, outcome, samples))
    }

    fn focus(tracks: &[Track]) -> Option<Interval> {
        focus_window(run_window(&scene(), tracks), &[], tracks)
    }

    const fn interval(lo: f64, hi: f64) -> Interval {
        Interval { lo, hi }
    }

    #[test]
    fn whirl_does_not_flatten_the_others() {
        let runs = [
            track("a", Outcome::Recovered, &[]),
            track("b", Outcome::Whirl, &[]),
            track("c", Outcome::Whirl, &[]),
        ];
        let ranges = [
            interval(0.0, 1.0),
            interval(0.0, 1000.0),
            interval(0.0, 2.0),
        ];
        let shared = interval(0.0, 2.0);
        assert_eq!(
            axes(&ranges, &[&runs[0], &runs[1], &runs[2]]),
            [(shared, false), (ranges[1], true), (shared, false)]
        );
        // With nothing to flatten there is one axis.
        assert_eq!(
            axes(&ranges[1..], &[&runs[1], &runs[2]]),
            [(ranges[1], false), (ranges[1], false)]
        );
    }

    /// Contact from 10 to 20 ms in a run of 400 ms.
    const BRIEF: Samples = &[(0.0, false), (0.010, true), (0.020, true), (0.4, false)];

    #[test]
    fn focus_ends_after_the_last_contact() {
        let runs = [track("a", Outcome::Recovered, BRIEF)];
        let window = focus(&runs).unwrap();
        assert!(window.lo > 8.0 && window.lo < 10.0, "{window:?}");
        assert!(window.hi > 20.0 && window.hi < 30.0, "{window:?}");
    }

    #[test]
    fn focus_ignores_runs_that_never_settle() {
        let endless: Samples = &[(0.0, false), (0.010, true), (0.4, true)];
        let runs = [
            track("a", Outcome::Whirl, endless),
            track("b", Outcome::Decayed, BRIEF),
        ];
        assert!(focus(&runs).unwrap().hi < 30.0);
        let window = focus(&runs[..1]).unwrap();
        assert!(window.hi > 10.0 && window.hi < 60.0, "{window:?}");
    }

    #[test]
    fn no_focus_without_events_or_with_late_ones() {
        assert_eq!(focus(&[]), None);
        let early_and_late: Samples = &[(0.0, true), (0.3, true), (0.4, false)];
        let runs = [track("a", Outcome::Recovered, early_and_late)];
        assert_eq!(focus(&runs), None);
    }

    #[test]
    fn focus_leaves_out_a_quiet_beginning() {
        let late: Samples = &[(0.0, false), (0.3, true), (0.32, true), (0.4, false)];
        let window = focus(&[track("a", Outcome::Recovered, late)]).unwrap();
        assert!(window.lo > 290.0 && window.lo < 300.0, "{window:?}");
    }
}
