//! Results as a table: a row a class.

use super::compared::{Figures, Pair};
use super::conditions::Condition;
use super::events::Event;
use super::plan::Run;
use crate::campaign::Block;
use serde::Serialize;

/// A class of runs: an event with sensors of a kind.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// What happened.
    pub event: &'static str,
    /// What the sensors were.
    pub sensors: String,
    /// Runs that can be trusted.
    pub runs: usize,
    /// How many the levitation controller alone recovers from.
    pub alone: usize,
    /// … and with the supervisor.
    pub own: usize,
    /// Machines that only levitation alone recovers.
    pub lost: Vec<u64>,
    /// How many only the supervisor recovers.
    pub gained: usize,
    /// Machines that touch with the supervisor and not with levitation alone.
    pub new_touches: Vec<u64>,
    /// Peak contact force over levitation's, where both recover and levitation touches.
    pub force: Shares,
    /// Machines on which that is more than 2.
    pub twice_as_hard: Vec<u64>,
    /// Impulse of the contacts, the same.
    pub impulse: Shares,
    /// Share of the time in which the supervisor had the bearing, in the mean and at most.
    pub engaged_mean: f64,
    /// See [`Row::engaged_mean`].
    pub engaged_max: f64,
    /// Times that it took over.
    pub engagements: u64,
    /// Longest time that it had the bearing without a break \[s\].
    pub longest_engagement_s: f64,
    /// Times that it gave up for a while.
    pub handed_back: u64,
}

/// Of a sorted list: `None` where it is empty.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Shares {
    /// Half are below it.
    pub median: Option<f64>,
    /// 95 % are.
    pub p95: Option<f64>,
    /// 99 % are.
    pub p99: Option<f64>,
    /// All are.
    pub max: Option<f64>,
}

impl Shares {
    fn of(mut list: Vec<f64>) -> Self {
        list.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let last = list.len().checked_sub(1)?;
            list.get((last as f64 * share).round() as usize).copied()
        };
        Self {
            median: at(0.5),
            p95: at(0.95),
            p99: at(0.99),
            max: at(1.0),
        }
    }
}

impl Row {
    fn of(event: Event, condition: Condition, pairs: &[(u64, Pair)]) -> Self {
        let numbers = |test: fn(&Pair) -> bool| -> Vec<u64> {
            let having = pairs.iter().filter(|(_, pair)| test(pair));
            having.map(|(number, _)| *number).collect()
        };
        let count = |test| numbers(test).len();
        let ratios = |of: fn(&Figures) -> f64| {
            let pairs = pairs.iter().filter(|(_, pair)| comparable(pair));
            let ratios = pairs.map(|(_, p)| of(&p.own) / of(&p.alone));
            Shares::of(ratios.filter(|ratio| ratio.is_finite()).collect())
        };
        let shares = || pairs.iter().map(|(_, pair)| pair.engaged.share());
        let sum = |of: fn(&Pair) -> u64| pairs.iter().map(|(_, pair)| of(pair)).sum();
        let longest = pairs.iter().map(|(_, pair)| pair.engaged.longest_s);
        Self {
            event: event.name(),
            sensors: condition.name(),
            runs: pairs.len(),
            alone: count(|p| p.alone.recovered),
            own: count(|p| p.own.recovered),
            lost: numbers(|p| p.alone.recovered && !p.own.recovered),
            gained: count(|p| !p.alone.recovered && p.own.recovered),
            new_touches: numbers(|p| !p.alone.touched() && p.own.touched()),
            force: ratios(|f| f.force_n),
            twice_as_hard: numbers(|p| comparable(p) && p.own.force_n > 2.0 * p.alone.force_n),
            impulse: ratios(|f| f.impulse_n_s),
            engaged_mean: shares().sum::<f64>() / pairs.len().max(1) as f64,
            engaged_max: shares().fold(0.0, f64::max),
            engagements: sum(|p| p.engaged.engagements),
            longest_engagement_s: longest.fold(0.0, f64::max),
            handed_back: sum(|p| p.engaged.handed_back),
        }
    }
}

/// Whether both recover and levitation alone touches.
fn comparable(pair: &Pair) -> bool {
    pair.alone.recovered && pair.own.recovered && pair.alone.touched()
}

/// A row for each class, in the order of the runs.
pub fn rows(runs: &[Run]) -> Vec<Row> {
    let of_one_class = |a: &Run, b: &Run| a.event == b.event && a.condition == b.condition;
    let row = |class: &[Run]| {
        let first = class.first()?;
        let pairs = class.iter().filter_map(|run| Some((run.number, run.pair?)));
        let pairs: Vec<(u64, Pair)> = pairs.collect();
        Some(Row::of(first.event, first.condition, &pairs))
    };
    runs.chunk_by(of_one_class).filter_map(row).collect()
}

const COLUMNS: [&str; 19] = [
    "event",
    "sensors",
    "runs",
    "alone",
    "own",
    "lost",
    "gained",
    "new touches",
    "force: median",
    "p95",
    "p99",
    "max",
    "impulse: median",
    "p95",
    "max",
    "engaged: mean",
    "max",
    "times",
    "handed back",
];

/// The rows as a table.
pub fn table(rows: &[Row]) -> Block {
    let ratio = |x: Option<f64>| x.map_or("–".to_owned(), |x| format!("{x:.2}"));
    let cells = rows.iter().map(|r| {
        [
            r.event.to_owned(),
            r.sensors.clone(),
            r.runs.to_string(),
            r.alone.to_string(),
            r.own.to_string(),
            r.lost.len().to_string(),
            r.gained.to_string(),
            r.new_touches.len().to_string(),
            ratio(r.force.median),
            ratio(r.force.p95),
            ratio(r.force.p99),
            ratio(r.force.max),
            ratio(r.impulse.median),
            ratio(r.impulse.p95),
            ratio(r.impulse.max),
            format!("{:.2} %", 100.0 * r.engaged_mean),
            format!("{:.1} %", 100.0 * r.engaged_max),
            r.engagements.to_string(),
            r.handed_back.to_string(),
        ]
    });
    Block::table(COLUMNS, cells)
}

/// The machines on which something was lost, a line a class.
pub fn lists(rows: &[Row]) -> Vec<String> {
    let line = |row: &Row, (what, numbers): (&str, &[u64])| {
        let numbers: Vec<String> = numbers.iter().map(u64::to_string).collect();
        let (event, sensors) = (row.event, &row.sensors);
        (!numbers.is_empty()).then(|| format!("{event}, {sensors}: {what} {}", numbers.join(", ")))
    };
    let of_row = |row: &Row| {
        [
            ("lost on machines", row.lost.as_slice()),
            ("touches only with the supervisor on", &row.new_touches),
            ("more than twice as hard on", &row.twice_as_hard),
        ]
        .map(|list| line(row, list))
    };
    rows.iter().flat_map(of_row).flatten().collect()
}
