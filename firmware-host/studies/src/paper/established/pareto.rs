//! The constants that the paper leaves out, searched: can any set meet all figures at once?

use crate::paper::data::*;
use crate::paper::rotors::{LeftOut, USED, footnote_4_with};
use crate::paper::runs::violence;
use plant_model::contact::damping_for_restitution;

const STIFFNESSES_N_M: [f64; 9] = [2e8, 3e8, 4e8, 5e8, 6e8, 7e8, 1e9, 1.5e9, 3e9];
const INERTIAS_KG_M2: [f64; 8] = [0.0075, 0.01, 0.0125, 0.015, 0.02, 0.03, 0.05, 0.08];
/// The quick search takes the first.
const RESTITUTIONS: [f64; 3] = [0.7, 0.5, 0.9];
/// Rotor against inner ring \[kg\].
const CONTACT_MASS_KG: f64 = 5.0;
/// The paper's: computed plateau \[Hz\], outer ring \[m\], standstill from 40 Hz \[s\].
pub(super) const PLATEAU_HZ: f64 = 660.0;
pub(super) const RING_M: f64 = 5e-5;
pub(super) const STANDSTILL_S: f64 = 0.012;

/// A maximum that rises no more than this from 80 to 166 Hz is a plateau.
const FLAT: f64 = 0.02;

/// A set with what it gives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub(super) left_out: LeftOut,
    /// Largest whirl frequency from 166 Hz.
    pub(super) plateau_hz: f64,
    /// Rise of the largest whirl frequency from 80 to 166 Hz, as a share.
    pub(super) rise: f64,
    /// Largest whirl frequency from 40 Hz.
    pub(super) slow_hz: f64,
    /// Outer ring, the larger of 40 and 166 Hz.
    pub(super) ring_m: f64,
    /// From 40 Hz.
    pub(super) standstill_s: f64,
}

impl Candidate {
    fn of(left_out: &LeftOut) -> Result<Self> {
        let params = footnote_4_with(left_out);
        // Long enough for the slowest standstill of the grid.
        let slow = violence(&params, 40.0, 0.15)?;
        let middle = violence(&params, 80.0, 0.2)?;
        let fast = violence(&params, 166.0, 0.25)?;
        Ok(Self {
            left_out: *left_out,
            plateau_hz: fast.whirl_hz,
            rise: fast.whirl_hz / middle.whirl_hz - 1.0,
            slow_hz: slow.whirl_hz,
            ring_m: slow.displacement_m[2].max(fast.displacement_m[2]),
            standstill_s: slow.standstill_s,
        })
    }

    /// How far off each figure is: shares; a ring below the bound is not off.
    fn misses(&self) -> [f64; 4] {
        [
            (self.plateau_hz / PLATEAU_HZ - 1.0).abs(),
            (self.ring_m / RING_M - 1.0).max(0.0),
            (self.standstill_s / STANDSTILL_S - 1.0).abs(),
            (self.rise - FLAT).max(0.0),
        ]
    }

    /// Which of the four it meets: plateau within 5 %, ring within the bound, standstill within 25 %,
    /// a plateau at all.
    fn met(&self) -> [bool; 4] {
        const MOST: [f64; 4] = [0.05, 0.0, 0.25, 0.0];
        let misses = self.misses();
        [0, 1, 2, 3].map(|i| misses[i] <= MOST[i])
    }

    fn dominates(&self, other: &Self) -> bool {
        // In steps of 5 %: less is no reason to prefer a set.
        let rounded = |c: &Self| c.misses().map(|m| (m * 20.0).round());
        let (a, b) = (rounded(self), rounded(other));
        a != b && a.iter().zip(&b).all(|(a, b)| a <= b)
    }

    /// Contact damping hardly matters: sets that differ in nothing else count as one.
    fn like(&self, other: &Self) -> bool {
        let key = |c: &Self| [c.left_out.contact_stiffness_n_m, c.left_out.inertia_kg_m2];
        key(self) == key(other)
    }
}

/// The search.
pub(super) struct Search {
    /// Every set tried; the first is the one used.
    pub(super) all: Vec<Candidate>,
    /// Number of sets that meet all four.
    pub(super) met: usize,
    /// Number of sets that meet all but the flatness.
    pub(super) met_three: usize,
    /// Nearest to plateau, ring and standstill together, of those with the restitution that every
    /// extent tries.
    pub(super) nearest: Candidate,
}

/// Runs the whole grid.
pub(super) fn search(extent: Extent) -> Result<Search> {
    let mut sets = vec![USED];
    for restitution in &RESTITUTIONS[..extent.pick(1, 3)] {
        for contact_stiffness_n_m in STIFFNESSES_N_M {
            let damping =
                damping_for_restitution(*restitution, contact_stiffness_n_m, CONTACT_MASS_KG);
            let contact_damping_n_s_m = damping.or_missing("no such restitution")?;
            sets.extend(INERTIAS_KG_M2.map(|inertia_kg_m2| LeftOut {
                contact_stiffness_n_m,
                contact_damping_n_s_m,
                inertia_kg_m2,
            }));
        }
    }
    let all = each(&sets, Candidate::of)?;
    let off = |c: &Candidate| c.misses()[..3].iter().sum::<f64>();
    let first = STIFFNESSES_N_M.len() * INERTIAS_KG_M2.len();
    let nearest = (all[1..=first].iter().copied()).min_by(|a, b| off(a).total_cmp(&off(b)));
    Ok(Search {
        met: all.iter().filter(|c| c.met() == [true; 4]).count(),
        met_three: all.iter().filter(|c| c.met()[..3] == [true; 3]).count(),
        nearest: nearest.or_missing("no set of constants")?,
        all,
    })
}

impl Search {
    /// Sets that no other is better than, with the used set.
    pub(super) fn table(&self) -> Table {
        let mut best: Vec<&Candidate> = Vec::new();
        for (i, c) in self.all.iter().enumerate() {
            let beaten = i > 0 && self.all.iter().any(|other| other.dominates(c));
            if !beaten && !best.iter().any(|other| other.like(c)) {
                best.push(c);
            }
        }
        best.sort_by(|a, b| a.plateau_hz.total_cmp(&b.plateau_hz));
        let mark = |c: &Candidate, i: usize| if c.met()[i] { " ✓" } else { "" };
        table! {
            "Constants that the paper leaves out: sets that no other beats in all four figures, in steps of 5 % (✓: plateau within 5 % of 660 Hz, outer ring within 0.05 mm, standstill within 25 % of 12 ms, rise from 80 to 166 Hz below 2 %)";
            for c in best;
            "k_c [N/m]" => "{:.1e}", c.left_out.contact_stiffness_n_m;
            "d_c [N s/m]" => "{:.0}", c.left_out.contact_damping_n_s_m;
            "J [kg m²]" => "{}", c.left_out.inertia_kg_m2;
            "Plateau [Hz]" => "{:.0}{}", c.plateau_hz, mark(c, 0);
            "Outer ring [mm]" => "{:.3}{}", 1e3 * c.ring_m, mark(c, 1);
            "Standstill from 40 Hz [ms]" => "{:.1}{}", 1e3 * c.standstill_s, mark(c, 2);
            "Rise from 80 to 166 Hz [%]" => "{:.1}{}", 100.0 * c.rise, mark(c, 3);
            "Whirl from 40 Hz [Hz]" => "{:.0}", c.slow_hz;
            "" => "{}", if c.left_out == USED { "used" } else { "" };
        }
    }
}
