//! The catalogue on whole rotors, P5 to P8: hardest blows, against levitation and the reference, overloads, what else happens,
//! and data of the shaft that are wrong.

mod happened;
mod loaded;
mod struck;

use self::happened::{Happened, claims as claims_of};
use self::loaded::Loaded;
use self::struck::Struck;
use super::incidents::Hardest;
use super::loops::{OWN, loops};
use super::plants::{Blow, RotorPlant};
use super::wrong_shaft::configured_wrong;
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError};
use firmware_bench::scene::policy_kind::PolicyKind;

/// Directions \[rad\] and seeds of a blow, of an overload and of all else: the median counts, or each. In a quick run the
/// first alone.
const TRIES: [(f64, u64); 3] = [(0.4, 1), (2.5, 2), (4.6, 3)];

fn tries(extent: Extent) -> &'static [(f64, u64)] {
    extent.pick(&TRIES[..1], &TRIES)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Who is compared: levitation alone, and the supervisor in front of it.
const KINDS: [PolicyKind; 2] = [PolicyKind::Levitation, PolicyKind::Supervisor];

/// The plants of the catalogue under all of it; in a quick run without the searches and what is configured wrong.
///
/// # Errors
/// A plant that is no valid scene.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let (mut claims, mut found, mut wrong) = (Vec::new(), Vec::new(), Vec::new());
    let (mut struck, mut loaded, mut happened) =
        (Struck::default(), Loaded::default(), Happened::default());
    let mut cases = 0;
    for plant in &RotorPlant::all()? {
        let name = plant.name;
        let mut loops = loops(plant, extent, progress)?;
        found.append(&mut loops.rows);
        if let Some(kept) = loops.kept {
            claims.push(Claim::at_least(
                format!("{name}: hardest blows under the file's loop, over the best that is fit"),
                0.95,
                kept,
            ));
        }
        let hardest = struck.of(&loops, extent, progress);
        claims.extend(hardest.claims(plant));
        cases += hardest.cases();
        let Some(own) = hardest.under(OWN) else {
            continue;
        };
        claims.extend(loaded.of(plant, extent, progress));
        cases += 4 * tries(extent).len() as u64;
        let alone_m_s = |blow: Blow| {
            let at = Blow::ALL.iter().position(|of| *of == blow);
            at.and_then(|i| own.get(i)).map_or(0.0, |[alone, _]| *alone)
        };
        let hardest = Hardest {
            end_m_s: alone_m_s(Blow::End(0)),
            centre_m_s: alone_m_s(Blow::Centre),
        };
        let of = happened.of(&loops, hardest, extent, progress);
        claims.extend(claims_of(&of, name));
        cases += of.pairs + of.untrusted;
        if extent == Extent::Full {
            for (what, over) in configured_wrong(plant, own, progress) {
                cases += Blow::ALL.len() as u64;
                wrong.push([name.to_owned(), what, format!("{over:.2}")]);
            }
        }
    }
    let mut chapters = vec![struck.chapter(), loaded.chapter(), happened.chapter()];
    if extent == Extent::Full {
        chapters.push(Chapter::new(
            "The loops",
            vec![
                Block::text(
                    "A search over frequency and damping for the hardest blows (geometric mean of four directions), among loops with a peak sensitivity below 3 in each plane and less than 5 % of the cap for noise. The robust loop is stored beside the plant's scene with the shape that its own search has found.",
                ),
                Block::table(["plant", "levitation", "frequency [Hz]", "damping ratio", "filter [samples]", "score [m/s]"], found),
            ],
        ));
        chapters.push(Chapter::folded(
            "A shaft that is configured wrong",
            vec![
                Block::text("Hardest blow over that of a supervisor that is configured right, the least of four directions."),
                Block::table(["plant", "what", "hardest blow"], wrong),
            ],
        ));
    }
    Ok(Report {
        classes: Vec::new(),
        title: "Catalogue on whole rotors".to_owned(),
        claims,
        cases,
        chapters,
    })
}
