//! Overloads.

use super::{KINDS, median, tries};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, run_all};
use crate::paired::pair::{Outcome, run_rotor};
use crate::whole_rotors::plants::{OVERLOAD, RotorPlant};

/// Where they act.
const PLACES: [(&str, Option<usize>); 2] =
    [("in the middle", None), ("at the second end", Some(1))];

/// Overloads of all plants so far, as rows.
#[derive(Default)]
pub(super) struct Loaded {
    rows: Vec<[String; 5]>,
}

impl Loaded {
    /// Loads a plant under its file's loop; what is claimed of it.
    pub(super) fn of(
        &mut self,
        plant: &RotorPlant,
        extent: Extent,
        progress: &dyn Progress,
    ) -> Vec<Claim> {
        let name = plant.name;
        let mut claims = Vec::new();
        for (place, end) in PLACES {
            let runs = KINDS.map(|kind| {
                let runs = run_all(tries(extent), progress, |tried| {
                    run_rotor(&plant.overloaded(end, OVERLOAD, *tried), kind)
                });
                runs.into_iter().flatten().collect::<Vec<Outcome>>()
            });
            let of = |runs: &[Outcome], what: fn(&Outcome) -> f64| {
                median(runs.iter().map(what).collect())
            };
            let figures: [fn(&Outcome) -> f64; 3] =
                [|r| r.impulse_n_s, |r| r.touches as f64, |r| r.force_n];
            let [impulse, touches, force] =
                figures.map(|what| runs.each_ref().map(|r| of(r, what)));
            let back = runs
                .each_ref()
                .map(|r| r.iter().filter(|r| r.recovered).count());
            self.rows.push([
                format!("{name}, {place}"),
                format!("{} and {}", back[0], back[1]),
                format!("{:.1} and {:.1}", impulse[0], impulse[1]),
                format!("{:.0} and {:.0}", touches[0], touches[1]),
                format!("{:.0} and {:.0}", force[0], force[1]),
            ]);
            claims.push(Claim::at_most(
                format!("{name}: touches of an overload {place}, over levitation's"),
                1.0,
                touches[1] / touches[0].max(1.0),
            ));
            claims.push(Claim::at_most(
                format!("{name}: impulse of an overload {place}, over levitation's"),
                0.5,
                impulse[1] / impulse[0],
            ));
        }
        claims
    }

    pub(super) fn chapter(self) -> Chapter {
        let (share, duration_s) = OVERLOAD;
        let columns = [
            "plant",
            "recovered, of 3",
            "impulse [N s]",
            "touches",
            "largest force [N]",
        ];
        Chapter::new(
            "Overloads",
            vec![
                Block::text(format!(
                    "A load of {share} caps (in the middle: of both magnets' caps) for {:.0} ms, three directions. Each figure is that of levitation alone and that with the supervisor, medians.",
                    1e3 * duration_s
                )),
                Block::table(columns, self.rows),
            ],
        )
    }
}
