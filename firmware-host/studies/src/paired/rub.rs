//! How often the supervisor breaks a rub that levitation alone stays in.

use super::pair::{Goal, NoPair, Outcome, Pair, Tried, pair};
use super::row::{AS_CONFIGURED, ClassName, RIGHT, Row, values};
use crate::campaign::{
    Block, Chapter, Claim, Extent, Machines, Progress, Report, StudyError, run_all,
};
use crate::machines::unbalanced::{DRIVEN, Motion, RubCase, TURNS};
use firmware_bench::scene::Scene;

/// Nothing was tuned on the machines of this seed.
const SEED: u64 = 20_261_129;
/// A rub that has ended after so many turns is broken.
const IN_TIME: f64 = 50.0;
/// Contact for this share of the turns after that is a rub that stays.
const STAYS: f64 = 0.8;

/// A machine driven on to the wall, and left in the middle at full spin, where all of its unbalance begins to pull at once.
#[derive(Debug, Clone)]
pub struct Rubs {
    /// Driven on to the wall.
    pub driven: Tried,
    /// Left alone.
    pub left: Tried,
}

impl RubCase {
    /// Both pairs.
    pub fn pairs(&self) -> Rubs {
        let of = |driven| {
            let scene = Scene::parse(&self.text(), &self.scene(driven));
            pair(
                &scene.map_err(|error| NoPair::Untrusted(error.to_string()))?,
                Goal::Free,
            )
        };
        let left = of(false);
        Rubs {
            driven: match &left {
                Ok(pair) if !is_free(&pair.levitation) => {
                    Err(NoPair::Untrusted("not free".to_owned()))
                }
                _ => of(true),
            },
            left,
        }
    }

    /// Turns in contact beyond those in which it is driven.
    fn turns(&self, of: &Outcome) -> f64 {
        (of.contact_s / self.turn_s() - DRIVEN).max(0.0)
    }

    /// Free after 50 turns in contact at most.
    pub(crate) fn is_broken(&self, of: &Outcome) -> bool {
        of.recovered && self.turns(of) <= IN_TIME
    }

    /// A rub to the end, with the spin.
    pub fn stays(&self, of: &Outcome) -> bool {
        !of.recovered && !of.whirled && self.turns(of) > STAYS * TURNS
    }
}

/// Free of the wall from the middle to the end.
fn is_free(of: &Outcome) -> bool {
    of.recovered && !of.touched()
}

impl Rubs {
    /// The pairs of a machine that levitation alone holds free of the wall from the middle: driven, and left alone.
    pub fn of_free(&self) -> Option<[Pair; 2]> {
        match (&self.driven, &self.left) {
            (Ok(driven), Ok(left)) if is_free(&left.levitation) => Some([*driven, *left]),
            _ => None,
        }
    }
}

/// Outcome of machines with unbalance.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    free: u64,
    stays: u64,
    broken: u64,
    /// Of those that a force within the cap can break.
    breakable: u64,
    broken_of_breakable: u64,
    lost: u64,
    whirled: u64,
    /// Not driven: they touch, and are not free at the end.
    left_touching: u64,
    left_bound: u64,
}

impl Sum {
    fn of<'a>(all: impl Iterator<Item = (&'a RubCase, &'a Rubs)>) -> Self {
        let mut sum = Self::default();
        for (case, rubs) in all {
            let Some([driven, left]) = rubs.of_free() else {
                continue;
            };
            let (alone, own, left) = (driven.levitation, driven.supervisor, left.supervisor);
            sum.free += 1;
            sum.left_touching += u64::from(left.touched());
            sum.left_bound += u64::from(!left.recovered);
            sum.lost += u64::from(alone.recovered && !own.recovered);
            sum.whirled += u64::from(own.whirled && !alone.whirled);
            if !case.stays(&alone) {
                continue;
            }
            sum.stays += 1;
            sum.broken += u64::from(case.is_broken(&own));
            if case.reserve() > 1.0 {
                sum.breakable += 1;
                sum.broken_of_breakable += u64::from(case.is_broken(&own));
            }
        }
        sum
    }

    fn cells(&self, name: &str) -> [String; 10] {
        let counts = [
            self.free,
            self.stays,
            self.broken,
            self.breakable,
            self.broken_of_breakable,
            self.lost,
            self.whirled,
            self.left_touching,
            self.left_bound,
        ];
        let [a, b, c, d, e, f, g, h, i] = counts.map(|n| n.to_string());
        [name.to_owned(), a, b, c, d, e, f, g, h, i]
    }
}

const COLUMNS: [&str; 10] = [
    "motion",
    "free from the middle",
    "levitation alone stays",
    "broken",
    "within the cap",
    "of them broken",
    "lost",
    "whirl",
    "touches from the middle",
    "stays from the middle",
];

/// Some thousand machines of each motion, or a few hundred.
///
/// # Errors
/// None.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    drawn(Machines::default(), extent, progress)
}

/// The same on other machines.
///
/// # Errors
/// None.
pub fn drawn(of: Machines, extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let seed = of.seed.unwrap_or(SEED);
    let machines = of.number.unwrap_or(extent.pick(100, 2000));
    let mut cases = Vec::new();
    for motion in Motion::ALL {
        cases.extend((0..machines).map(|number| RubCase::new(seed, motion, number)));
    }
    let pairs = run_all(&cases, progress, RubCase::pairs);
    let all = || cases.iter().zip(&pairs);
    let of = |motion| Sum::of(all().filter(move |(case, _)| case.motion == motion));
    let whole = Sum::of(all());
    let share = |part: u64, of: u64| part as f64 / of as f64;
    let claims = vec![
        Claim::at_least(
            "rubs that a force within the cap can break: broken within 50 turns",
            0.9,
            share(whole.broken_of_breakable, whole.breakable),
        ),
        Claim::at_least(
            "rubs that levitation alone stays in: broken within 50 turns",
            0.8,
            share(whole.broken, whole.stays),
        ),
        Claim::at_most(
            "only levitation alone comes free, share of machines",
            0.001,
            share(whole.lost, whole.free),
        ),
        Claim::at_most(
            "backward whirl with the supervisor alone",
            0.0,
            whole.whirled as f64,
        ),
        Claim::at_most(
            "set free in the middle at full spin, not free at the end with the supervisor, share of machines",
            0.001,
            share(whole.left_bound, whole.free),
        ),
    ];
    let mut rows: Vec<[String; 10]> = (Motion::ALL.iter())
        .map(|motion| of(*motion).cells(motion.name()))
        .collect();
    rows.push(whole.cells("all"));
    let left = all().filter_map(|(case, rubs)| {
        let [
            Pair {
                levitation: alone,
                supervisor: own,
                ..
            },
            _,
        ] = rubs.of_free()?;
        let stays = case.stays(&alone) && !case.is_broken(&own) && case.reserve() > 1.0;
        let lost = alone.recovered && !own.recovered;
        let whirls = own.whirled && !alone.whirled;
        let what = match (whirls, stays, lost) {
            (true, ..) => "whirl",
            (_, true, _) => "not broken, though within the cap",
            (.., true) => "lost",
            _ => return None,
        };
        Some(format!("{what}: {}", case.text()))
    });
    let blocks = vec![
        Block::text(format!(
            "{machines} machines of seed {seed} for each motion, their unbalance 0.06 to 0.5 clearances, spins 1.3 to 5 times the frequency of the levitation loop. Counted are those that the loop holds free of the wall from the middle. After 40 turns a force that turns with the unbalance drives each on to the wall, for 15 turns; 150 more follow."
        )),
        Block::table(COLUMNS, rows),
        Block::text(
            "Stays: in contact for 120 of them and at the end. Broken: free at the end after 50 more turns in contact at most. Within the cap: friction and the whole cap brake more than unbalance can drive. Lost: only levitation alone comes free. Whirl: only with the supervisor. From the middle: not driven, with the supervisor, from a start at full spin at which all of the unbalance begins to pull at once, as after a lost blade.",
        ),
        Block::List(left.collect()),
    ];
    Ok(Report {
        classes: values(&rows_of(&cases, &pairs)),
        title: "Forward rub".to_owned(),
        claims,
        cases: cases.len() as u64,
        chapters: vec![Chapter::new("Rubs that do not end by themselves", blocks)],
    })
}

/// A row for each motion: driven on to the wall, of machines that run free.
fn rows_of(cases: &[RubCase], all: &[Rubs]) -> Vec<Row> {
    let row = |motion: &Motion| {
        let class = ClassName {
            machine: motion.name().to_owned(),
            event: "forward rub".to_owned(),
            sensors: AS_CONFIGURED.to_owned(),
            configuration: RIGHT.to_owned(),
        };
        let of = cases
            .iter()
            .zip(all)
            .filter(|(case, rubs)| case.motion == *motion && rubs.of_free().is_some());
        Row::new(class, of.map(|(case, rubs)| (case.number, &rubs.driven)))
    };
    Motion::ALL.iter().map(row).collect()
}
