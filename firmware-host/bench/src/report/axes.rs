//! Which stretch of time a section shows, and which axes the policies share.

use crate::report::plot::thin::Interval;
use crate::report::summary::SceneSummary;
use crate::run::outcome::Outcome;
use crate::run::verdict::PolicyRun;

/// A run that would stretch the shared axis more than this gets one of its own.
const OWN_SCALE_FROM: f64 = 3.0;

/// From the start to the end of the longest run \[ms\].
pub(super) fn run_window(scene: &SceneSummary, runs: &[PolicyRun]) -> Interval {
    let ends = runs
        .iter()
        .flat_map(|run| [run.trace.rows.first(), run.trace.rows.last()]);
    let times = ends.flatten().map(|row| 1e3 * row.plant.t_s);
    let all = Interval::of(times.chain([0.0, 1e3 * scene.duration_s]));
    match all {
        Some(all) if all.size() > 0.0 => all,
        _ => Interval { lo: 0.0, hi: 1.0 },
    }
}

/// The stretch \[ms\] in which the runs that settle do something; `None` where that is not much
/// shorter than the run.
pub(super) fn focus_window(scene: &SceneSummary, runs: &[PolicyRun]) -> Option<Interval> {
    let whole = run_window(scene, runs);
    let events: Vec<_> = runs.iter().map(events).collect();
    let settles = |run: &PolicyRun| {
        matches!(
            run.verdict.figures.outcome,
            Outcome::Recovered | Outcome::Decayed
        )
    };
    let settled = runs.iter().zip(&events).filter(|(run, _)| settles(run));
    let settled = settled.filter_map(|(_, span)| *span).reduce(Interval::with);
    let first = events
        .iter()
        .flatten()
        .map(|span| span.lo)
        .reduce(f64::min)?;
    // Runs that never settle have no last event worth waiting for: show how they begin.
    let last = settled.map_or(first + 0.05 * whole.size(), |span| span.hi.max(first));
    let disturbed = disturbances(scene)
        .iter()
        .map(|span| span.lo)
        .reduce(f64::min);
    let first = disturbed
        .map_or(first, |begin| begin.min(first))
        .max(whole.lo);
    // A long quiet beginning is left out.
    let before = first - whole.lo;
    let quiet = before > 0.5 * (last - whole.lo) && before > 0.1 * whole.size();
    let margin = |share: f64, of: f64| (share * of).max(0.01 * whole.size());
    let lo = if quiet {
        first - margin(0.1, last - first)
    } else {
        whole.lo
    };
    let hi = last + margin(0.15, last - lo);
    let window = Interval { lo, hi }.within(whole)?;
    (window.size() < 0.5 * whole.size()).then_some(window)
}

/// From the first to the last contact or change of the supervisor's mode \[ms\].
fn events(run: &PolicyRun) -> Option<Interval> {
    let rows = &run.trace.rows;
    let contacts = rows.iter().filter(|row| row.plant.mode.in_contact());
    let changes = rows
        .windows(2)
        .filter(|w| w[0].supervisor_mode() != w[1].supervisor_mode());
    let all = contacts.chain(changes.map(|w| &w[1]));
    Interval::of(all.map(|row| 1e3 * row.plant.t_s))
}

/// Disturbance intervals \[ms\].
pub(super) fn disturbances(scene: &SceneSummary) -> Vec<Interval> {
    let spans = scene.disturbances.iter();
    spans
        .filter_map(|d| Interval::of([1e3 * d.from_s, 1e3 * d.to_s]))
        .collect()
}

/// The axis of each run, and whether it is the run's own: all share the axis of the runs without
/// whirl, except where that would flatten those.
pub(super) fn axes(ranges: &[Interval], runs: &[PolicyRun]) -> Vec<(Interval, bool)> {
    let calm = ranges
        .iter()
        .zip(runs)
        .filter(|(_, run)| run.verdict.figures.outcome != Outcome::Whirl);
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

/// The same axis for each run.
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

    const fn interval(lo: f64, hi: f64) -> Interval {
        Interval { lo, hi }
    }

    #[test]
    fn whirl_does_not_flatten_the_others() {
        let runs = [
            run("a", Outcome::Recovered, &[]),
            run("b", Outcome::Whirl, &[]),
            run("c", Outcome::Whirl, &[]),
        ];
        let ranges = [
            interval(0.0, 1.0),
            interval(0.0, 1000.0),
            interval(0.0, 2.0),
        ];
        let shared = interval(0.0, 2.0);
        assert_eq!(
            axes(&ranges, &runs),
            [(shared, false), (ranges[1], true), (shared, false)]
        );
        // With nothing to flatten there is one axis.
        assert_eq!(
            axes(&ranges[1..], &runs[1..]),
            [(ranges[1], false), (ranges[1], false)]
        );
    }

    /// Contact from 10 to 20 ms in a run of 400 ms.
    const BRIEF: Samples = &[(0.0, false), (0.010, true), (0.020, true), (0.4, false)];

    #[test]
    fn focus_ends_after_the_last_contact() {
        let runs = [run("a", Outcome::Recovered, BRIEF)];
        let window = focus_window(&scene(), &runs).unwrap();
        assert_eq!(window.lo, 0.0);
        assert!(window.hi > 20.0 && window.hi < 30.0, "{window:?}");
    }

    #[test]
    fn focus_ignores_runs_that_never_settle() {
        let endless: Samples = &[(0.0, false), (0.010, true), (0.4, true)];
        let runs = [
            run("a", Outcome::Whirl, endless),
            run("b", Outcome::Decayed, BRIEF),
        ];
        assert!(focus_window(&scene(), &runs).unwrap().hi < 30.0);
        let window = focus_window(&scene(), &runs[..1]).unwrap();
        assert!(window.hi > 10.0 && window.hi < 60.0, "{window:?}");
    }

    #[test]
    fn no_focus_without_events_or_with_late_ones() {
        assert_eq!(focus_window(&scene(), &[]), None);
        let early_and_late: Samples = &[(0.0, true), (0.3, true), (0.4, false)];
        let runs = [run("a", Outcome::Recovered, early_and_late)];
        assert_eq!(focus_window(&scene(), &runs), None);
    }

    #[test]
    fn focus_leaves_out_a_quiet_beginning() {
        let late: Samples = &[(0.0, false), (0.3, true), (0.32, true), (0.4, false)];
        let window = focus_window(&scene(), &[run("a", Outcome::Recovered, late)]).unwrap();
        assert!(window.lo > 290.0 && window.lo < 300.0, "{window:?}");
    }
}
