//! The catalogue on whole rotors, P5 to P8: hardest blows, overloads, and data of the shaft that are wrong.

use super::compared::{Run, run};
use super::hardest::{hardest_m_s, score, tuned};
use super::plants::{Blow, Loop, RotorPlant};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use firmware_bench::scene::policy_kind::PolicyKind;
use supervisor::Shaft;

/// Directions \[rad\] and seeds of a blow, and of an overload: the median counts. In a quick run the first alone.
const TRIES: [(f64, u64); 3] = [(0.4, 1), (2.5, 2), (4.6, 3)];

fn tries(extent: Extent) -> &'static [(f64, u64)] {
    extent.pick(&TRIES[..1], &TRIES)
}

/// Loads of so many caps, for so long.
const OVERLOAD: (f64, f64) = (1.3, 0.1);

/// By how much the supervisor's hardest blow has to exceed levitation's.
fn wanted(plant: &str) -> f64 {
    match plant {
        "P5" | "P8" => 1.15,
        _ => 1.10,
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Who is compared: levitation alone, and the supervisor in front of it.
const KINDS: [PolicyKind; 2] = [PolicyKind::Levitation, PolicyKind::Supervisor];

/// Levitation loops of a plant.
struct Loops {
    plant: RotorPlant,
    by: Vec<(&'static str, RotorPlant)>,
    /// Score of the file's loop over that of the best one that is fit.
    kept: Option<f64>,
    rows: Vec<[String; 6]>,
}

/// The file's loop of each plane, and one by mode: searched, or as the last search left it.
fn loops(plant: RotorPlant, extent: Extent, progress: &dyn Progress) -> Loops {
    let mut rows = Vec::new();
    let row = |name: &str, by: &Loop, score: f64| {
        [
            plant.name.to_owned(),
            name.to_owned(),
            format!("{:.0}", by.frequency_hz),
            format!("{:.1}", by.damping_ratio),
            format!("{:.1}", by.filter),
            format!("{score:.3}"),
        ]
    };
    let (mut by_mode, mut kept) = (None, None);
    if extent == Extent::Full {
        if let Some((best, found)) = tuned(&plant, &[None], progress) {
            rows.push(row("each plane its own", &best, found));
            kept = Some(score(&plant) / found);
        }
        let cross = [Some(0.5)];
        if let Some((best, found)) = tuned(&plant, &cross, progress) {
            let name = format!("by mode, cross feedback {}", best.cross.unwrap_or_default());
            rows.push(row(&name, &best, found));
            by_mode = Some(plant.levitated_by(&best));
        }
    }
    let mut by = vec![("each plane its own", plant.clone())];
    by.extend(by_mode.map(|with| ("by mode", with)));
    Loops {
        plant,
        by,
        kept,
        rows,
    }
}

/// Hardest blow \[m/s\] of each direction for each of [`KINDS`].
fn blows(plant: &RotorPlant, extent: Extent, progress: &dyn Progress) -> Vec<[f64; 2]> {
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

/// What an overload comes to, impulse and touches, for each of [`KINDS`], in the middle and at the second end.
fn overloads(
    plant: &RotorPlant,
    extent: Extent,
    progress: &dyn Progress,
) -> Vec<(&'static str, [Vec<Run>; 2])> {
    let places = [("in the middle", None), ("at the second end", Some(1))];
    places
        .into_iter()
        .map(|(name, end)| {
            let of = KINDS.map(|kind| {
                let runs = run_all(tries(extent), progress, |tried| {
                    let scene = plant.overloaded(end, OVERLOAD, *tried).ok()?;
                    run(&scene, kind)
                });
                runs.into_iter().flatten().collect::<Vec<Run>>()
            });
            (name, of)
        })
        .collect()
}

/// Makes a datum of a shaft wrong by a factor.
type Change = fn(&mut Shaft, f32);

/// What may be told wrong of a shaft, and by how much.
const WRONG: [(&str, f64, Change); 7] = [
    ("transverse inertia", 1.2, |s, by| {
        s.transverse_inertia_kg_m2 *= by;
    }),
    ("transverse inertia", 0.8, |s, by| {
        s.transverse_inertia_kg_m2 *= by;
    }),
    ("polar inertia", 1.2, |s, by| {
        s.polar_inertia_kg_m2 *= by;
    }),
    ("polar inertia", 0.8, |s, by| {
        s.polar_inertia_kg_m2 *= by;
    }),
    ("mass", 1.2, |s, by| {
        s.mass_kg *= by;
    }),
    ("mass", 0.8, |s, by| {
        s.mass_kg *= by;
    }),
    ("distances of magnets", 0.8, |s, by| {
        s.places.iter_mut().for_each(|place| place.magnet_m *= by);
    }),
];

/// Hardest blows told wrong over those told right: the least of all directions.
fn told_wrong(
    plant: &RotorPlant,
    right: &[[f64; 2]],
    progress: &dyn Progress,
) -> Vec<(String, f64)> {
    let Some(shaft) = plant.scene.shaft() else {
        return Vec::new();
    };
    let one = |(name, by, change): &(&str, f64, Change)| {
        let mut told = shaft;
        change(&mut told, *by as f32);
        let mut with = plant.clone();
        with.scene.told = Some(told);
        let cases: Vec<_> = Blow::ALL.iter().map(|blow| (*blow, TRIES[0])).collect();
        let speeds = run_all(&cases, progress, |(blow, of)| {
            hardest_m_s(&with, *blow, PolicyKind::Supervisor, *of)
        });
        let over = speeds
            .iter()
            .zip(right)
            .map(|(wrong, [_, own])| wrong / own);
        (
            format!("{name} told {by} of what it is"),
            over.fold(f64::INFINITY, f64::min),
        )
    };
    WRONG.iter().map(one).collect()
}

/// The plants of the catalogue under all of it; in a quick run without the searches and what is told wrong.
///
/// # Errors
/// A plant that is no valid scene.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let (mut claims, mut found) = (Vec::new(), Vec::new());
    let (mut hardest, mut loaded, mut wrong) = (Vec::new(), Vec::new(), Vec::new());
    let mut cases = 0;
    for plant in RotorPlant::all()? {
        let name = plant.name;
        let mut loops = loops(plant, extent, progress);
        found.append(&mut loops.rows);
        if let Some(kept) = loops.kept {
            claims.push(Claim::at_least(
                format!("{name}: hardest blows under the file's loop, over the best that is fit"),
                0.95,
                kept,
            ));
        }
        for (by, plant) in &loops.by {
            let all = blows(plant, extent, progress);
            cases += all.len() as u64 * 2;
            for (blow, [alone, own]) in Blow::ALL.iter().zip(&all) {
                let ratio = own / alone;
                let row = [
                    format!("{name}, {by}"),
                    blow.name().to_owned(),
                    format!("{alone:.2}"),
                    format!("{own:.2}"),
                    format!("{ratio:.2}"),
                ];
                hardest.push(row);
            }
            let least = all.iter().map(|[alone, own]| own / alone);
            claims.push(Claim::at_least(
                format!("{name}, {by}: hardest blow over levitation's, least of all directions"),
                wanted(name),
                least.fold(f64::INFINITY, f64::min),
            ));
            if *by != "each plane its own" {
                continue;
            }
            for (place, runs) in overloads(plant, extent, progress) {
                let of =
                    |runs: &[Run], what: fn(&Run) -> f64| median(runs.iter().map(what).collect());
                let figures: [fn(&Run) -> f64; 3] =
                    [|r| r.impulse_n_s, |r| r.touches as f64, |r| r.force_n];
                let [impulse, touches, force] =
                    figures.map(|what| runs.each_ref().map(|r| of(r, what)));
                let back = runs
                    .each_ref()
                    .map(|r| r.iter().filter(|r| r.recovered).count());
                cases += 2 * tries(extent).len() as u64;
                loaded.push([
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
            if extent == Extent::Full {
                for (what, over) in told_wrong(&loops.plant, &all, progress) {
                    cases += Blow::ALL.len() as u64;
                    wrong.push([name.to_owned(), what, format!("{over:.2}")]);
                }
            }
        }
    }
    let mut chapters = vec![Chapter::new(
        "Hardest blows",
        vec![
            Block::text(
                "Speed that the blow gives the plane that it moves most, median of three directions and seeds, on a grid of 5 %; all slighter ones are recovered from too.",
            ),
            Block::table(
                [
                    "plant and levitation",
                    "blow",
                    "levitation alone [m/s]",
                    "supervisor [m/s]",
                    "ratio",
                ],
                hardest,
            ),
        ],
    )];
    let (share, duration_s) = OVERLOAD;
    chapters.push(Chapter::new(
        "Overloads",
        vec![
            Block::text(format!(
                "A load of {share} caps (in the middle: of both magnets' caps) for {:.0} ms, three directions. Each figure is that of levitation alone and that with the supervisor, medians.",
                1e3 * duration_s
            )),
            Block::table(["plant", "recovered, of 3", "impulse [N s]", "touches", "largest force [N]"], loaded),
        ],
    ));
    if extent == Extent::Full {
        chapters.push(Chapter::new(
            "The loops",
            vec![
                Block::text(
                    "A search over frequency and damping for the hardest blows (geometric mean of four directions), among loops with a peak sensitivity below 3 in each plane and less than 5 % of the cap for noise.",
                ),
                Block::table(["plant", "levitation", "frequency [Hz]", "damping ratio", "filter [samples]", "score [m/s]"], found),
            ],
        ));
        chapters.push(Chapter::new(
            "A shaft that is told wrong",
            vec![
                Block::text("Hardest blow over that of a supervisor that is told right, the least of four directions."),
                Block::table(["plant", "what", "hardest blow"], wrong),
            ],
        ));
    }
    Ok(Report {
        title: "Catalogue on whole rotors".to_owned(),
        claims,
        cases,
        chapters,
    })
}
