//! What it costs the catalogue's whole rotors that their supervisor is configured with a wrong shaft.

use super::hardest::hardest_m_s;
use super::plants::{Blow, RotorPlant};
use crate::campaign::{Progress, run_all};
use firmware_bench::scene::policy_kind::PolicyKind;
use supervisor::Shaft;

/// Direction \[rad\] and seed.
const TRIED: (f64, u64) = (0.4, 1);

/// Makes a datum of a shaft wrong by a factor.
type Change = fn(&mut Shaft, f32);

/// What may be configured wrong of a shaft, and by how much.
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

/// Hardest blows configured wrong over those configured right: the least of all directions.
pub(super) fn configured_wrong(
    plant: &RotorPlant,
    right: &[[f64; 2]],
    progress: &dyn Progress,
) -> Vec<(String, f64)> {
    let Some(shaft) = plant.scene.shaft() else {
        return Vec::new();
    };
    let one = |(name, by, change): &(&str, f64, Change)| {
        let mut configured_shaft = shaft;
        change(&mut configured_shaft, *by as f32);
        let mut with = plant.clone();
        with.scene.configured_shaft = Some(configured_shaft);
        let cases: Vec<_> = Blow::ALL.iter().map(|blow| (*blow, TRIED)).collect();
        let speeds = run_all(&cases, progress, |(blow, of)| {
            hardest_m_s(&with, *blow, PolicyKind::Supervisor, *of)
        });
        let over = speeds
            .iter()
            .zip(right)
            .map(|(wrong, [_, own])| wrong / own);
        (
            format!("{name} configured as {by} of what it is"),
            over.fold(f64::INFINITY, f64::min),
        )
    };
    WRONG.iter().map(one).collect()
}
