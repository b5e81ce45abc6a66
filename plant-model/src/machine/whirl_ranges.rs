//! Where friction can hold backward whirl of a whole rotor: Black's limits, from the receptances of its planes.
//!
//! Steady whirl is a circle in every plane that takes part, all at one rate ω, backward, turned against each other by phases θ.
//! With vectors as complex numbers times e^(−iωt), N the normal force and T the friction along the whirl,
//!
//! ```text
//! c_p·e^(iθ_p) = −Σ_q (H_pq(ω, Ω) + δ_pq/k_p)·(N_q + i·T_q)·e^(iθ_q)
//! ```
//!
//! H is the receptance of rotor against ring in backward circles, with the gyroscopic terms of the spin in it; the contact spring
//! counts to the stator. For each set of phases the forces follow; whirl at ω needs friction of |T|/N in every plane, and the
//! phases that need least decide. The ends of the ranges in which that is no more than there is are Black's limits, where
//! friction slides; inside it rolls. Of one plane that is the condition of [`crate::analysis::black`].

use super::linear::{C, LinearMachine, Wall};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Rates at which friction can hold steady backward whirl in some planes at once.
#[derive(Debug, Clone, PartialEq)]
pub struct WhirlRange {
    /// The planes that touch: one or two.
    pub planes: Vec<usize>,
    /// Slowest and fastest whirl \[rad/s\], backward positive.
    pub rates_rad_s: [f64; 2],
    /// At both ends: by how much the second plane is turned against the first \[rad\], −π to π. 0 is cylindrical, π conical
    /// whirl. Zero of a single plane.
    pub phases_rad: [f64; 2],
}

/// What whirl needs.
#[derive(Debug, Clone, Copy)]
struct Need {
    /// Friction over normal force, over the friction that there is; infinite where the wall would have to pull.
    share: f64,
    phase_rad: f64,
}

/// Rates that are looked at; a range or a gap between two of them is not seen.
const RATES: usize = 4000;
/// Phases that are looked at before the best is refined.
const PHASES: usize = 48;
/// Slowest rate, of the fastest.
const SLOWEST: f64 = 1e-3;
/// Receptances along x and y differ by no more, of the largest.
const ROUND: f64 = 1e-6;

impl LinearMachine {
    /// Ranges of steady backward whirl at a spin \[rad/s\], of each plane alone and of each two together, slowest first. Looked at
    /// are rates from a thousandth of the fastest to that, one and a half times the fastest on a contact spring; a range may go
    /// on beyond. `None` where mountings differ along x and y, as whirl is no circle there, and where walls are closed.
    pub fn whirl_ranges(&self, spin_rad_s: f64) -> Option<Vec<WhirlRange>> {
        let walls = self.walls.as_deref()?;
        let planes = walls.len();
        let mut sets: Vec<Vec<usize>> = (0..planes).map(|p| vec![p]).collect();
        for p in 0..planes {
            sets.extend((p + 1..planes).map(|q| vec![p, q]));
        }
        let fastest = 1.5 * self.fastest_whirl_rad_s(walls);
        let at = |i: usize| fastest * SLOWEST.powf(1.0 - i as f64 / (RATES - 1) as f64);
        let spin_rad_s = spin_rad_s.abs();
        let mut compliances = Vec::with_capacity(RATES);
        for i in 0..RATES {
            compliances.push(self.compliance(walls, at(i), spin_rad_s)?);
        }
        let mut ranges = Vec::new();
        for set in sets {
            let need = |rate: f64| match self.compliance(walls, rate, spin_rad_s) {
                Some(Some(whole)) => need_of(walls, &whole, &set),
                _ => NONE,
            };
            let mut open: Option<(f64, f64)> = None;
            let mut before = false;
            for (i, compliance) in compliances.iter().enumerate() {
                let now = match compliance {
                    Some(whole) => need_of(walls, whole, &set),
                    None => NONE,
                };
                let holds = now.share <= 1.0;
                if holds != before {
                    let (rate, phase) = match i {
                        0 => (at(0), now.phase_rad),
                        _ => edge(&need, at(i - 1), at(i), before),
                    };
                    match open.take() {
                        None => open = Some((rate, phase)),
                        Some(from) => ranges.push(range(&set, from, (rate, phase))),
                    }
                }
                before = holds;
            }
            if let Some(from) = open {
                ranges.push(range(&set, from, (fastest, need(fastest).phase_rad)));
            }
        }
        ranges.sort_by(|a, b| {
            let slowest = a.rates_rad_s[0].total_cmp(&b.rates_rad_s[0]);
            a.planes.len().cmp(&b.planes.len()).then(slowest)
        });
        Some(ranges)
    }

    /// Rate of the fastest plane on its contact spring.
    fn fastest_whirl_rad_s(&self, walls: &[Wall]) -> f64 {
        let planes = walls.iter().zip(&self.body.contacts);
        let squares = planes.map(|(wall, port)| wall.stiffness_n_m * port.mobility());
        squares.fold(0.0, f64::max).sqrt()
    }

    /// Receptances in backward circles with the contact springs; inner `None` where an undamped mode is hit, outer where circles
    /// are none.
    fn compliance(
        &self,
        walls: &[Wall],
        rate_rad_s: f64,
        spin_rad_s: f64,
    ) -> Option<Option<DMatrix<C>>> {
        let Some(all) = self.receptance(rate_rad_s, spin_rad_s) else {
            return Some(None);
        };
        let planes = walls.len();
        let size = all.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let mut whole = DMatrix::zeros(planes, planes);
        for p in 0..planes {
            for q in 0..planes {
                let [xx, xy] = [all[(2 * p, 2 * q)], all[(2 * p, 2 * q + 1)]];
                let [yx, yy] = [all[(2 * p + 1, 2 * q)], all[(2 * p + 1, 2 * q + 1)]];
                if (xx - yy).norm() > ROUND * size || (xy + yx).norm() > ROUND * size {
                    return None;
                }
                whole[(p, q)] = (xx + C::i() * xy).conj();
            }
            whole[(p, p)] += 1.0 / walls[p].stiffness_n_m;
        }
        Some(Some(whole))
    }
}

/// The least friction that whirl in these planes needs.
fn need_of(walls: &[Wall], whole: &DMatrix<C>, set: &[usize]) -> Need {
    let part = DMatrix::from_fn(set.len(), set.len(), |i, j| whole[(set[i], set[j])]);
    let Some(stiffness) = part.try_inverse() else {
        return NONE;
    };
    let share = |phase_rad: f64| {
        let turn = |i: usize| C::from_polar(1.0, i as f64 * phase_rad);
        let gap = DVector::from_fn(set.len(), |i, _| walls[set[i]].clearance_m * turn(i));
        let forces = -(&stiffness * gap);
        let shares = forces.iter().enumerate().map(|(i, force)| {
            let own = force / turn(i);
            match own.re > 0.0 {
                true => own.im.abs() / own.re / walls[set[i]].driving_friction,
                false => f64::INFINITY,
            }
        });
        shares.fold(0.0, f64::max)
    };
    if set.len() == 1 {
        return Need {
            share: share(0.0),
            phase_rad: 0.0,
        };
    }
    let mut best = NONE;
    for i in 0..PHASES {
        let phase_rad = TAU * (i as f64 / PHASES as f64 - 0.5);
        let need = share(phase_rad);
        if need < best.share {
            best = Need {
                share: need,
                phase_rad,
            };
        }
    }
    let mut step = TAU / PHASES as f64;
    while step > 1e-6 {
        step *= 0.5;
        for phase_rad in [best.phase_rad - step, best.phase_rad + step] {
            let need = share(phase_rad);
            if need < best.share {
                best = Need {
                    share: need,
                    phase_rad,
                };
            }
        }
    }
    best
}

const NONE: Need = Need {
    share: f64::INFINITY,
    phase_rad: 0.0,
};

/// Where between two rates whirl begins or ceases to be held, and the phase on the side where it is.
fn edge(need: &impl Fn(f64) -> Need, low: f64, high: f64, held_below: bool) -> (f64, f64) {
    let (mut low, mut high) = (low, high);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        match (need(middle).share <= 1.0) == held_below {
            true => low = middle,
            false => high = middle,
        }
    }
    let inside = if held_below { low } else { high };
    (inside, need(inside).phase_rad)
}

fn range(set: &[usize], from: (f64, f64), to: (f64, f64)) -> WhirlRange {
    let wrapped = |phase: f64| phase - TAU * (phase / TAU).round();
    WhirlRange {
        planes: set.to_vec(),
        rates_rad_s: [from.0, to.0],
        phases_rad: [wrapped(from.1), wrapped(to.1)],
    }
}
