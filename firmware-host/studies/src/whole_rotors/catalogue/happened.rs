//! What else happens, under every loop.

use super::tries;
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, run_all};
use crate::paired::pair::{Goal, NoPair, Tried, pair, remark};
use crate::paired::row::{COLUMNS, ClassName, Row as Sum};
use crate::whole_rotors::incidents::{Hardest, Incident};
use crate::whole_rotors::loops::Loops;

/// A run of an incident on a plant.
struct Row {
    plant: &'static str,
    by: &'static str,
    incident: Incident,
    seed: u64,
    ran: Tried,
}

/// All that has happened so far.
#[derive(Default)]
pub(super) struct Happened {
    rows: Vec<Row>,
}

/// What is claimed of the incidents on a plant.
pub(super) fn claims(sum: &Sum, plant: &str) -> [Claim; 3] {
    [
        Claim::at_most(
            format!("{plant}, incidents: recoveries lost"),
            0.0,
            sum.lost as f64,
        ),
        Claim::at_least(
            format!("{plant}, incidents: recoveries, over levitation's"),
            1.0,
            sum.recovery_ratio(),
        ),
        Claim::at_most(
            format!("{plant}, incidents: pairs that cannot be trusted"),
            0.0,
            sum.untrusted as f64,
        ),
    ]
}

fn summed<'a>(all: impl Iterator<Item = &'a Tried>) -> Sum {
    Sum::new(ClassName::default(), all.map(|tried| (0, tried)))
}

impl Happened {
    /// Lets everything happen to a plant under each of its loops.
    pub(super) fn of(
        &mut self,
        loops: &Loops,
        hardest: Hardest,
        extent: Extent,
        progress: &dyn Progress,
    ) -> Sum {
        let mut cases = Vec::new();
        for (by, plant) in &loops.by {
            for incident in Incident::ALL {
                cases.extend(tries(extent).iter().map(|of| (*by, plant, incident, *of)));
            }
        }
        let ran = run_all(&cases, progress, |(_, plant, incident, of)| {
            let scene = incident.scene(plant, hardest, *of);
            let scene = scene.map_err(|error| NoPair::Untrusted(error.to_string()))?;
            pair(&scene, Goal::Free)
        });
        let sum = summed(ran.iter());
        let rows = cases.into_iter().zip(ran);
        (self.rows).extend(rows.map(|((by, plant, incident, (_, seed)), ran)| Row {
            plant: plant.name,
            by,
            incident,
            seed,
            ran,
        }));
        sum
    }

    fn sum(&self, of: impl Fn(&Row) -> bool) -> Sum {
        summed(self.rows.iter().filter(|row| of(row)).map(|row| &row.ran))
    }

    pub(super) fn chapter(self) -> Chapter {
        let by_incident =
            (Incident::ALL.iter()).map(|i| self.sum(|row| row.incident == *i).cells(i.name()));
        let mut groups: Vec<(&str, &str)> = Vec::new();
        for row in &self.rows {
            if !groups.contains(&(row.plant, row.by)) {
                groups.push((row.plant, row.by));
            }
        }
        let by_loop = groups.iter().map(|(plant, by)| {
            let of = self.sum(|row| (row.plant, row.by) == (*plant, *by));
            of.cells(format!("{plant}, {by}"))
        });
        let named = self.rows.iter().filter_map(|row| {
            let what = remark(&row.ran)?;
            let name = row.incident.name();
            Some(format!(
                "{what}: {}, {}; {name}; seed {}",
                row.plant, row.by, row.seed
            ))
        });
        let mut columns = COLUMNS;
        columns[0] = "plant and levitation";
        Chapter::folded(
            "What else happens",
            vec![
                Block::text(
                    "Three directions and seeds of everything under every loop. Blows are at the first end, over a seal at the centre, with 0.7 of the hardest there that the file's loop alone recovers from; what comes after one comes 2 ms after it. Magnet, axis and sensor are those of the first plane, lost ones known to be. Power goes with the weight fed forward. Force and impulse are those with the supervisor over those of levitation alone, touches the same, summed where both recover. Struck on and on: twice the touches of levitation alone, and ten more.",
                ),
                Block::table(COLUMNS, by_incident),
                Block::table(columns, by_loop),
                Block::List(named.collect()),
            ],
        )
    }
}
