//! How often the supervisor breaks a rub that levitation alone stays in.

use super::drawn::{Motion, RubCase, Run};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use firmware_bench::scene::policy_kind::PolicyKind;

/// Nothing was tuned on the machines of this seed.
const SEED: u64 = 20_261_129;

/// A machine that levitation alone holds free of the wall from the middle: driven on to it with each, and with the supervisor
/// left in the middle as well.
#[derive(Debug, Clone, Copy)]
struct Pair {
    alone: Run,
    own: Run,
    left: Run,
}

fn pair(case: &RubCase) -> Option<Pair> {
    if !case.runs_free()? {
        return None;
    }
    Some(Pair {
        alone: case.driven(PolicyKind::Levitation)?,
        own: case.driven(PolicyKind::Supervisor)?,
        left: case.left_alone(PolicyKind::Supervisor)?,
    })
}

/// What came of machines with unbalance.
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
    fn of<'a>(all: impl Iterator<Item = (&'a RubCase, &'a Option<Pair>)>) -> Self {
        let mut sum = Self::default();
        for (case, pair) in all {
            let Some(Pair { alone, own, left }) = pair else {
                continue;
            };
            sum.free += 1;
            sum.left_touching += u64::from(left.touched);
            sum.left_bound += u64::from(!left.free);
            sum.lost += u64::from(alone.free && !own.free);
            sum.whirled += u64::from(own.whirled && !alone.whirled);
            if !alone.stays() {
                continue;
            }
            sum.stays += 1;
            sum.broken += u64::from(own.broken());
            if case.reserve() > 1.0 {
                sum.breakable += 1;
                sum.broken_of_breakable += u64::from(own.broken());
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
    let machines = extent.pick(100, 2000);
    let mut cases = Vec::new();
    for motion in Motion::ALL {
        cases.extend((0..machines).map(|number| RubCase::new(SEED, motion, number)));
    }
    let pairs = run_all(&cases, progress, pair);
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
    let left = all().filter_map(|(case, pair)| {
        let Pair { alone, own, .. } = (*pair)?;
        let stays = alone.stays() && !own.broken() && case.reserve() > 1.0;
        let lost = alone.free && !own.free;
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
            "{machines} machines of seed {SEED} for each motion, their unbalance 0.06 to 0.5 clearances, spins 1.3 to 5 times the frequency of the levitation loop. Counted are those that the loop holds free of the wall from the middle. After 40 turns a force that turns with the unbalance drives each on to the wall, for 15 turns; 150 more follow."
        )),
        Block::table(COLUMNS, rows),
        Block::text(
            "Stays: in contact for 120 of them and at the end. Broken: free at the end after 50 more turns in contact at most. Within the cap: friction and the whole cap brake more than unbalance can drive. Lost: only levitation alone comes free. Whirl: only with the supervisor. From the middle: not driven, with the supervisor, from a start at full spin at which all of the unbalance begins to pull at once, as after a lost blade.",
        ),
        Block::List(left.collect()),
    ];
    Ok(Report {
        classes: Vec::new(),
        title: "Forward rub".to_owned(),
        claims,
        cases: cases.len() as u64,
        chapters: vec![Chapter::new("Rubs that do not end by themselves", blocks)],
    })
}
