//! A class as a row: of tables, and of JSON.

use super::pair::{NoPair, Outcome, Pair, Tried};
use crate::campaign::{Block, Chapter};
use serde::Serialize;

/// What a class is: its place on every axis, in words.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Default)]
pub struct ClassName {
    /// Class of the machines.
    pub machine: String,
    /// What happens.
    pub event: String,
    /// How the sensors are.
    pub sensors: String,
    /// What the supervisor is configured with.
    pub configuration: String,
}

/// Of a list: `None` where it is empty.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Shares {
    /// Half are below it.
    pub median: Option<f64>,
    /// 95 % are.
    pub p95: Option<f64>,
    /// All are.
    pub max: Option<f64>,
}

impl Shares {
    fn of(mut list: Vec<f64>) -> Self {
        list.retain(|ratio| ratio.is_finite());
        list.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let last = list.len().checked_sub(1)?;
            list.get((last as f64 * share).round() as usize).copied()
        };
        Self {
            median: at(0.5),
            p95: at(0.95),
            max: at(1.0),
        }
    }
}

/// Outcome of the pairs of a class; forces and impulses are those with the supervisor over those of levitation alone.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Row {
    /// Which class.
    #[serde(flatten)]
    pub class: ClassName,
    /// Pairs that can be trusted.
    pub pairs: u64,
    /// Recoveries of levitation alone.
    pub levitation: u64,
    /// Recoveries with the supervisor.
    pub supervisor: u64,
    /// Pairs that only levitation alone recovers.
    pub lost: u64,
    /// Pairs that only the supervisor recovers.
    pub gained: u64,
    /// Pairs that touch with the supervisor only.
    pub new_touches: u64,
    /// Pairs with more than twice the touches, and ten more.
    pub struck_on: u64,
    /// Peak contact force, where both recover and levitation touches.
    pub force: Shares,
    /// Impulse of the contacts, the same.
    pub impulse: Shares,
    /// Pairs whose configuration the supervisor refuses.
    pub refused: u64,
    /// Pairs that cannot be trusted.
    pub untrusted: u64,
    /// Touches of all pairs of which both recover, levitation alone and supervisor.
    pub touches: [u64; 2],
    /// Mean share of the time in which the supervisor had the bearing.
    pub engaged_mean: f64,
    /// Largest share.
    pub engaged_max: f64,
    /// Times that it took over.
    pub engagements: u64,
    /// Times that it gave up for a while.
    pub handed_back: u64,
    /// Numbers of the machines that were lost.
    pub lost_numbers: Vec<u64>,
    /// Numbers of those that touch with the supervisor only.
    pub new_touch_numbers: Vec<u64>,
}

impl Row {
    /// The row of a class, from pairs with the numbers of their machines.
    pub fn new<'a>(class: ClassName, tried: impl Iterator<Item = (u64, &'a Tried)>) -> Self {
        let mut row = Self {
            class,
            ..Self::default()
        };
        let mut pairs: Vec<Pair> = Vec::new();
        for (number, tried) in tried {
            match tried {
                Err(NoPair::Refused(_)) => row.refused += 1,
                Err(NoPair::Untrusted(_)) => row.untrusted += 1,
                Ok(pair) => {
                    row.count(number, pair);
                    pairs.push(*pair);
                }
            }
        }
        let ratios = |of: fn(&Outcome) -> f64| {
            let comparable = pairs.iter().filter(|pair| pair.is_comparable());
            Shares::of(
                comparable
                    .map(|p| of(&p.supervisor) / of(&p.levitation))
                    .collect(),
            )
        };
        row.force = ratios(|outcome| outcome.force_n);
        row.impulse = ratios(|outcome| outcome.impulse_n_s);
        let shares = || pairs.iter().map(|pair| pair.engaged.share());
        row.engaged_mean = shares().sum::<f64>() / pairs.len().max(1) as f64;
        row.engaged_max = shares().fold(0.0, f64::max);
        row
    }

    fn count(&mut self, number: u64, pair: &Pair) {
        self.pairs += 1;
        self.levitation += u64::from(pair.levitation.recovered);
        self.supervisor += u64::from(pair.supervisor.recovered);
        self.gained += u64::from(pair.is_gained());
        self.struck_on += u64::from(pair.is_struck_on());
        self.engagements += pair.engaged.engagements;
        self.handed_back += pair.engaged.handed_back;
        if pair.is_lost() {
            self.lost += 1;
            self.lost_numbers.push(number);
        }
        if pair.newly_touches() {
            self.new_touches += 1;
            self.new_touch_numbers.push(number);
        }
        if pair.both_recover() {
            self.touches[0] += pair.levitation.touches;
            self.touches[1] += pair.supervisor.touches;
        }
    }

    /// Touches with the supervisor over those of levitation alone, summed where both recover.
    pub(crate) fn touch_ratio(&self) -> f64 {
        self.touches[1] as f64 / self.touches[0] as f64
    }

    /// Recoveries over levitation's.
    pub(crate) fn recovery_ratio(&self) -> f64 {
        self.supervisor as f64 / self.levitation as f64
    }

    /// Its cells after those of its name.
    fn measured(&self) -> [String; 14] {
        let ratio = |x: Option<f64>| match x.filter(|x| x.is_finite()) {
            Some(x) => format!("{x:.2}"),
            None => "–".to_owned(),
        };
        [
            self.pairs.to_string(),
            self.levitation.to_string(),
            self.supervisor.to_string(),
            self.lost.to_string(),
            self.gained.to_string(),
            self.new_touches.to_string(),
            self.struck_on.to_string(),
            ratio(self.force.median),
            ratio(self.force.p95),
            ratio(self.force.max),
            ratio(self.impulse.median),
            ratio(Some(self.touch_ratio())),
            format!("{:.2} %", 100.0 * self.engaged_mean),
            self.refused.to_string(),
        ]
    }

    /// Its cells under [`COLUMNS`], headed by a name.
    pub fn cells(&self, name: impl Into<String>) -> [String; 15] {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = self.measured();
        [name.into(), a, b, c, d, e, f, g, h, i, j, k, l, m, n]
    }
}

/// Headings of [`Row::cells`].
pub const COLUMNS: [&str; 15] = [
    "class",
    "pairs",
    "levitation alone",
    "supervisor",
    "lost",
    "gained",
    "new touches",
    "struck on and on",
    "force: median",
    "p95",
    "max",
    "impulse: median",
    "touches",
    "engaged",
    "refused",
];

/// Rows as programs read them.
pub fn values(rows: &[Row]) -> Vec<serde_json::Value> {
    (rows.iter())
        .filter_map(|row| serde_json::to_value(row).ok())
        .collect()
}

/// Rows as a table: event, sensors and configuration in one name, the machine class too where there are several.
pub fn table(rows: &[Row]) -> Block {
    let several = rows
        .iter()
        .any(|row| row.class.machine != rows[0].class.machine);
    Block::table(
        COLUMNS,
        rows.iter().map(|row| row.cells(row.class.text(several))),
    )
}

/// Of a class: most recoveries lost, new touches and pairs struck on and on, and largest median impulse, that are none to speak of.
const MOST_LOST: f64 = 1.0 / 2000.0;
const MOST_NEW_TOUCHES: f64 = 1.0 / 1000.0;
const MOST_STRUCK_ON: f64 = 1.0 / 500.0;
const MOST_IMPULSE: f64 = 1.05;

/// The classes in which the supervisor does more harm than that, the worst first.
pub fn worse(rows: &[Row]) -> Chapter {
    let share = |count: u64, of: u64| count as f64 / of.max(1) as f64;
    let is_worse = |row: &Row| {
        share(row.lost, row.levitation) > MOST_LOST
            || share(row.new_touches, row.pairs) > MOST_NEW_TOUCHES
            || share(row.struck_on, row.pairs) > MOST_STRUCK_ON
            || row.impulse.median.is_some_and(|ratio| ratio > MOST_IMPULSE)
    };
    let mut worse: Vec<&Row> = rows.iter().filter(|row| is_worse(row)).collect();
    worse.sort_by_key(|row| std::cmp::Reverse((row.lost, row.struck_on, row.new_touches)));
    let story = format!(
        "{} of {} classes: more than a 2000th of the recoveries lost, new touches in more than a 1000th of the pairs, struck on and on in more than a 500th, or a median impulse above {MOST_IMPULSE}.",
        worse.len(),
        rows.len()
    );
    let cells = worse.iter().map(|row| {
        let impulse = row
            .impulse
            .median
            .map_or("–".to_owned(), |x| format!("{x:.2}"));
        let counts = [
            row.levitation,
            row.lost,
            row.gained,
            row.new_touches,
            row.struck_on,
        ];
        let [a, b, c, d, e] = counts.map(|count| count.to_string());
        [row.class.text(true), a, b, c, d, e, impulse]
    });
    let columns = [
        "class",
        "levitation alone",
        "lost",
        "gained",
        "new touches",
        "struck on and on",
        "impulse: median",
    ];
    let blocks = vec![Block::text(story), Block::table(columns, cells)];
    Chapter::new("Where it is worse than levitation alone", blocks)
}

impl ClassName {
    /// In a line; what is as usual is left out.
    pub fn text(&self, machine: bool) -> String {
        let usual = [AS_CONFIGURED, RIGHT];
        let named = [&self.event, &self.sensors, &self.configuration];
        let named = named.into_iter().filter(|name| !usual.contains(&&name[..]));
        let machine = machine.then_some(&self.machine);
        let all: Vec<&str> = machine.into_iter().chain(named).map(|s| &s[..]).collect();
        all.join(", ")
    }
}

/// Name of sensors that are what the supervisor is configured for.
pub(crate) const AS_CONFIGURED: &str = "as configured";
/// Name of a configuration without a mistake.
pub const RIGHT: &str = "right";

/// The machines on which something was lost, a line a class.
pub fn lists(rows: &[Row]) -> Vec<String> {
    let line = |row: &Row, what: &str, numbers: &[u64]| {
        let numbers: Vec<String> = numbers.iter().map(u64::to_string).collect();
        (!numbers.is_empty())
            .then(|| format!("{}: {what} {}", row.class.text(true), numbers.join(", ")))
    };
    let of_row = |row: &Row| {
        [
            line(row, "lost on machines", &row.lost_numbers),
            line(
                row,
                "touches only with the supervisor on",
                &row.new_touch_numbers,
            ),
        ]
    };
    rows.iter().flat_map(of_row).flatten().collect()
}
