//! The levitation loops of the catalogue's whole rotors: of each plane, by mode, robust.

use super::hardest::{score, tuned};
use super::plants::{Loop, RotorPlant};
use crate::campaign::{Extent, Progress};
use firmware_bench::scene::diagnostic::SceneError;

/// The file's loop.
pub(super) const OWN: &str = "each plane its own";
pub(super) const BY_MODE: &str = "by mode";
/// The stored one.
pub(super) const ROBUST: &str = "robust";

/// Levitation loops of a plant.
pub(super) struct Loops {
    /// The plant under each.
    pub(super) by: Vec<(&'static str, RotorPlant)>,
    /// Score of the file's loop over that of the best one that is fit.
    pub(super) kept: Option<f64>,
    /// What the search has found.
    pub(super) rows: Vec<[String; 6]>,
}

/// The file's loop of each plane, the robust one, and in a full run one by mode, which is searched.
///
/// # Errors
/// A stored loop that is no valid scene.
pub(super) fn loops(
    plant: &RotorPlant,
    extent: Extent,
    progress: &dyn Progress,
) -> Result<Loops, SceneError> {
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
    let robust = plant.robust()?;
    let (mut by_mode, mut kept) = (None, None);
    if extent == Extent::Full {
        if let Some((best, found)) = tuned(plant, &[None], progress) {
            rows.push(row(OWN, &best, found));
            kept = Some(score(plant) / found);
        }
        let cross = [Some(0.5)];
        if let Some((best, found)) = tuned(plant, &cross, progress) {
            let name = format!(
                "{BY_MODE}, cross feedback {}",
                best.cross.unwrap_or_default()
            );
            rows.push(row(&name, &best, found));
            by_mode = Some(plant.levitated_by(&best));
        }
        let none = || "–".to_owned();
        let (name, found) = (plant.name.to_owned(), format!("{:.3}", score(&robust)));
        rows.push([name, ROBUST.to_owned(), none(), none(), none(), found]);
    }
    let mut by = vec![(OWN, plant.clone())];
    by.extend(by_mode.map(|with| (BY_MODE, with)));
    // Quick: on one plant.
    if extent == Extent::Full || plant.name == "P5" {
        by.push((ROBUST, robust));
    }
    Ok(Loops { by, kept, rows })
}
