//! Hardest blows: levitation alone, with the supervisor, and of the reference that sees the true state.

use super::{KINDS, median, tries};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, run_all};
use crate::overloads::impact::STEP;
use crate::overloads::reference::FINE;
use crate::whole_rotors::hardest::{FIRST_M_S, brings_back, hardest_from_m_s, hardest_m_s};
use crate::whole_rotors::loops::{Loops, OWN};
use crate::whole_rotors::plants::{Blow, RotorPlant};
use crate::whole_rotors::reference::hardest_of_reference_m_s;
use firmware_bench::scene::policy_kind::PolicyKind;

/// Hardest blow \[m/s\] of levitation alone and with the supervisor.
type Pair = [f64; 2];

/// Hardest blows on a plant, in the order of [`Blow::ALL`].
pub(super) struct OnPlant {
    under: Vec<(&'static str, Vec<Pair>)>,
    reference_m_s: Vec<Option<f64>>,
}

/// Those of all plants so far, as rows.
#[derive(Default)]
pub(super) struct Struck {
    rows: Vec<[String; 5]>,
    against_reference: Vec<[String; 7]>,
    /// Of plants that miss a claim by a step of the grid.
    finely: Vec<[String; 6]>,
}

/// Plants whose blows are looked at more finely.
const FINELY: [&str; 1] = ["P8"];

/// By how much the supervisor's hardest blow has to exceed levitation's, and what share of the reference's it has to be.
fn wanted(plant: &str) -> (f64, f64) {
    match plant {
        "P5" => (1.15, 0.9),
        "P8" => (1.15, 0.85),
        _ => (1.10, 0.85),
    }
}

fn least(all: impl Iterator<Item = f64>) -> f64 {
    all.fold(f64::INFINITY, f64::min)
}

impl OnPlant {
    /// Under a loop.
    pub(super) fn under(&self, name: &str) -> Option<&[Pair]> {
        let found = self.under.iter().find(|(by, _)| *by == name);
        found.map(|(_, all)| all.as_slice())
    }

    pub(super) fn cases(&self) -> u64 {
        let reference = self.reference_m_s.iter().flatten().count() as u64;
        2 * (Blow::ALL.len() * self.under.len()) as u64 + reference
    }

    /// The hardest blow of each direction under the best levitation alone.
    fn best_alone_m_s(&self) -> impl Iterator<Item = f64> {
        (0..Blow::ALL.len()).map(|i| {
            let alone = self
                .under
                .iter()
                .filter_map(|(_, all)| Some(all.get(i)?[0]));
            alone.fold(0.0, f64::max)
        })
    }

    pub(super) fn claims(&self, plant: &RotorPlant) -> Vec<Claim> {
        let name = plant.name;
        let (over, share) = wanted(name);
        let mut claims: Vec<Claim> = (self.under.iter())
            .map(|(by, all)| {
                Claim::at_least(
                    format!(
                        "{name}, {by}: hardest blow over levitation's, least of all directions"
                    ),
                    over,
                    least(all.iter().map(|[alone, own]| own / alone)),
                )
            })
            .collect();
        let Some(own) = self.under(OWN) else {
            return claims;
        };
        if self.under.len() > 2 {
            let best = own.iter().zip(self.best_alone_m_s());
            claims.push(Claim::at_least(
                format!("{name}: hardest blow over the best levitation's of three, least of all directions"),
                over,
                least(best.map(|([_, own], alone)| own / alone)),
            ));
        }
        let of_reference = own.iter().zip(&self.reference_m_s);
        let shares = of_reference.filter_map(|([_, own], reference)| Some(own / (*reference)?));
        claims.push(Claim::at_least(
            format!("{name}: hardest blow over clairvoyant's, least of all directions"),
            share,
            least(shares),
        ));
        claims
    }
}

impl Struck {
    /// Strikes a plant under each of its loops.
    pub(super) fn of(&mut self, loops: &Loops, extent: Extent, progress: &dyn Progress) -> OnPlant {
        let under: Vec<_> = (loops.by.iter())
            .map(|(by, plant)| (*by, blows(plant, extent, progress)))
            .collect();
        let mut reference_m_s = Vec::new();
        if let Some((_, plant)) = loops.by.first() {
            reference_m_s = run_all(&Blow::ALL, progress, |blow| {
                hardest_of_reference_m_s(plant, *blow, (FIRST_M_S, STEP))
            });
            for (by, all) in &under {
                for (blow, [alone, own]) in Blow::ALL.iter().zip(all) {
                    self.rows.push([
                        format!("{}, {by}", plant.name),
                        blow.name().to_owned(),
                        format!("{alone:.2}"),
                        format!("{own:.2}"),
                        format!("{:.2}", own / alone),
                    ]);
                }
            }
            let found = OnPlant {
                under,
                reference_m_s,
            };
            let own = found.under(OWN).unwrap_or_default();
            let all = own.iter().zip(found.best_alone_m_s());
            for ((blow, ([_, own], alone)), reference) in
                Blow::ALL.iter().zip(all).zip(&found.reference_m_s)
            {
                let reference = reference.unwrap_or(f64::NAN);
                self.against_reference.push([
                    plant.name.to_owned(),
                    blow.name().to_owned(),
                    format!("{alone:.2}"),
                    format!("{own:.2}"),
                    format!("{reference:.2}"),
                    format!("{:.2}", own / reference),
                    format!("{:.2}", reference / alone),
                ]);
            }
            if extent == Extent::Full && FINELY.contains(&plant.name) {
                self.finely.extend(finely(plant, &found, progress));
            }
            return found;
        }
        OnPlant {
            under,
            reference_m_s,
        }
    }

    pub(super) fn chapter(self) -> Chapter {
        let columns = [
            "plant and levitation",
            "blow",
            "levitation alone [m/s]",
            "supervisor [m/s]",
            "ratio",
        ];
        let against = [
            "plant",
            "blow",
            "best levitation alone [m/s]",
            "supervisor [m/s]",
            "clairvoyant [m/s]",
            "supervisor over clairvoyant",
            "clairvoyant over levitation",
        ];
        let mut blocks = vec![
            Block::text(
                "Speed that the blow gives the plane that it moves most, median of three directions and seeds, on a grid of 5 %; all slighter ones are recovered from too.",
            ),
            Block::table(columns, self.rows),
            Block::text(
                "Clairvoyant sees the true state of both planes without noise and delay, and drives both magnets with a law whose six weights were searched for each blow; in each scene the best of these laws and of the file's loop with the true state counts. The supervisor is that in front of the file's loop.",
            ),
            Block::table(against, self.against_reference),
        ];
        if !self.finely.is_empty() {
            blocks.push(Block::text(
                "The same on a grid of 1.25 % from a tenth below levitation's speed on, under the file's loop, where steps of 5 % are too coarse for what is claimed.",
            ));
            blocks.push(Block::table(
                [
                    "plant",
                    "blow",
                    "levitation alone [m/s]",
                    "supervisor, over it",
                    "clairvoyant, over it",
                    "supervisor over clairvoyant",
                ],
                self.finely,
            ));
        }
        Chapter::new("Hardest blows", blocks)
    }
}

/// Hardest blows under the file's loop on a finer grid.
fn finely(plant: &RotorPlant, known: &OnPlant, progress: &dyn Progress) -> Vec<[String; 6]> {
    let own = known.under(OWN).unwrap_or_default();
    let cases: Vec<_> = Blow::ALL.into_iter().zip(own).collect();
    run_all(&cases, progress, |(blow, [alone, _])| {
        let grid = (alone / STEP.powi(2), FINE);
        let of = |kind: PolicyKind| {
            let speeds = tries(Extent::Full).iter().map(|of| {
                hardest_from_m_s(grid, |speed_m_s| {
                    brings_back(plant, (*blow, speed_m_s), kind, *of)
                })
            });
            median(speeds.collect())
        };
        let [alone, own] = KINDS.map(of);
        let reference = hardest_of_reference_m_s(plant, *blow, grid).unwrap_or(f64::NAN);
        [
            plant.name.to_owned(),
            blow.name().to_owned(),
            format!("{alone:.3}"),
            format!("{:.3}", own / alone),
            format!("{:.3}", reference / alone),
            format!("{:.3}", own / reference),
        ]
    })
}

/// Hardest blow \[m/s\] of each direction for each of [`KINDS`].
fn blows(plant: &RotorPlant, extent: Extent, progress: &dyn Progress) -> Vec<Pair> {
    let mut cases = Vec::new();
    for (kind, blow) in KINDS
        .into_iter()
        .flat_map(|kind| Blow::ALL.map(|blow| (kind, blow)))
    {
        cases.extend(tries(extent).iter().map(|of| (kind, blow, *of)));
    }
    let speeds = run_all(&cases, progress, |(kind, blow, of)| {
        hardest_m_s(plant, *blow, *kind, *of)
    });
    let of = |kind: PolicyKind, blow: Blow| {
        let all = cases.iter().zip(&speeds);
        let its = all.filter(|((k, b, _), _)| (*k, *b) == (kind, blow));
        median(its.map(|(_, speed)| *speed).collect())
    };
    Blow::ALL
        .iter()
        .map(|blow| KINDS.map(|kind| of(kind, *blow)))
        .collect()
}
