//! Impacts by lanes: several at a time where they know all that is in a rotor, one by one elsewhere. Both ways end in the same.

use super::{
    Aim, Criterion, Hunt, Impact, ImpactError, ImpactOutcome, Next, Outcome, Search, run_impact,
    start_of,
};
use crate::Method;
use crate::analysis::onset::critical_tangential_speed_m_s;
use crate::lanes::{self, Ended, Ending, LaneParams, Launch};
use crate::params::PlantParams;

/// How many impacts were run, and how many of them by lanes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tried {
    /// All.
    pub impacts: u64,
    /// By lanes.
    pub by_lanes: u64,
    /// Those that were taken for no whirl, since their time was over before they were decided.
    pub undecided: u64,
}

impl Tried {
    fn add(&mut self, outcome: Outcome) {
        self.impacts += 1;
        self.undecided += u64::from(outcome == Outcome::Undecided);
    }
}

/// [`run_impact`] of each, on this thread: in their order.
///
/// # Errors
/// [`ImpactError`] of each.
pub fn run_impacts(
    cases: &[(PlantParams, Impact)],
    criterion: &Criterion,
) -> Vec<Result<ImpactOutcome, ImpactError>> {
    let mut outcomes: Vec<Option<_>> = vec![None; cases.len()];
    let mut launches = Vec::with_capacity(cases.len());
    for (i, (params, impact)) in cases.iter().enumerate() {
        match launch(params, impact, criterion) {
            Some(launch) => launches.push((launch, i)),
            None => outcomes[i] = Some(run_impact(params, impact, criterion)),
        }
    }
    lanes::run(criterion.options.rtol, launches.into_iter(), |i, ended| {
        let (params, impact) = &cases[i];
        let outcome = match outcome(&ended) {
            Some(outcome) => Ok(outcome),
            None => run_impact(params, impact, criterion),
        };
        outcomes[i] = Some(outcome);
        None
    });
    outcomes.into_iter().flatten().collect()
}

/// [`super::critical_speed_m_s`] of each, on this thread: in their order.
///
/// # Errors
/// [`ImpactError`] of each.
pub fn critical_speeds_m_s(
    cases: &[(PlantParams, Aim)],
    search: &Search,
    criterion: &Criterion,
) -> (Vec<Result<Option<f64>, ImpactError>>, Tried) {
    let mut found: Vec<Option<Result<_, _>>> = vec![None; cases.len()];
    let mut tried = Tried::default();
    let hunts = cases
        .iter()
        .map(|(params, at)| Hunt::new(params, *at, search));
    let mut first = Vec::with_capacity(cases.len());
    for (i, hunt) in hunts.enumerate() {
        let begun = hunt.and_then(|hunt| begin(&cases[i].0, hunt, criterion, &mut tried));
        match begun {
            Ok(Begun::Launch(both)) => first.push((both.0, (i, both.1))),
            Ok(Begun::Found(speed_m_s)) => found[i] = Some(Ok(speed_m_s)),
            Err(error) => found[i] = Some(Err(error)),
        }
    }
    lanes::run(
        criterion.options.rtol,
        first.into_iter(),
        |(i, mut hunt), ended| {
            let params = &cases[i].0;
            let outcome = match outcome(&ended) {
                Some(outcome) => {
                    tried.by_lanes += 1;
                    Ok(outcome)
                }
                None => run_impact(params, &hunt.impact(), criterion),
            };
            let begun = outcome.and_then(|outcome| {
                tried.add(outcome.outcome);
                hunt.answer(outcome.outcome == Outcome::Whirl);
                begin(params, hunt, criterion, &mut tried)
            });
            match begun {
                Ok(Begun::Launch(both)) => return Some((both.0, (i, both.1))),
                Ok(Begun::Found(speed_m_s)) => found[i] = Some(Ok(speed_m_s)),
                Err(error) => found[i] = Some(Err(error)),
            }
            None
        },
    );
    (found.into_iter().flatten().collect(), tried)
}

/// A search that waits for lanes, or is over.
enum Begun {
    Launch(Box<(Launch, Hunt)>),
    Found(Option<f64>),
}

/// Goes on with a search until lanes have something to do.
fn begin(
    params: &PlantParams,
    mut hunt: Hunt,
    criterion: &Criterion,
    tried: &mut Tried,
) -> Result<Begun, ImpactError> {
    loop {
        let impact = match hunt.next() {
            Next::Found(speed_m_s) => return Ok(Begun::Found(speed_m_s)),
            Next::Try(impact) => impact,
        };
        if let Some(launch) = launch(params, &impact, criterion) {
            return Ok(Begun::Launch(Box::new((launch, hunt))));
        }
        let after = run_impact(params, &impact, criterion)?;
        tried.add(after.outcome);
        hunt.answer(after.outcome == Outcome::Whirl);
    }
}

/// An impact for lanes; `None` where they do not know all that is in it, or it is wrong.
fn launch(params: &PlantParams, impact: &Impact, criterion: &Criterion) -> Option<Launch> {
    let known = criterion.options.method != Method::Collocation;
    let options = criterion.options.validate().is_ok();
    let threshold_m_s = critical_tangential_speed_m_s(params).filter(|_| known && options)?;
    let start = start_of(params, impact);
    let launch = Launch::new(LaneParams::of(params)?, &start, criterion.limit_s(params))?;
    Some(launch.until_decided(threshold_m_s, criterion.whirl_multiple * threshold_m_s))
}

/// `None` where lanes gave up.
fn outcome(ended: &Ended) -> Option<ImpactOutcome> {
    let outcome = match ended.ending {
        Ending::Whirl => Outcome::Whirl,
        Ending::Free => Outcome::Free,
        Ending::Time => Outcome::Undecided,
        Ending::GaveUp => return None,
    };
    Some(ImpactOutcome {
        outcome,
        impacts_to_threshold: ended.impacts_to_threshold,
    })
}
