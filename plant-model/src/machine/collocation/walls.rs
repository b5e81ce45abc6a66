//! What makes the iteration settle on stiff walls: contact forces at all points of a step are found together.
//!
//! An iteration that puts into each force the motion under the forces before settles only while a wall is soft over a step. Of all
//! that acts only the walls are stiff, and each acts along one direction. So with r the change of the accelerations that plain
//! iteration would make, k and d the slopes of the contact law at a point and n its normal, the changes x of the forces obey
//!
//! ```text
//! x_i = Σ_j (k_i·h²·∬_ij + d_i·h·∫_ij)·n_i·(r_j − Σ_q mobility·push_qj·x_qj)
//! ```
//!
//! one linear system over planes and points. What friction does with the force stands in the push.

use super::{Collocation, END, GAUSS};
use crate::V2;
use crate::machine::params::MAX_PLANES;
use crate::machine::series::Step;
use crate::mode::Phase;
use crate::vector::perp;
use nalgebra::{DMatrix, DVector};

impl Collocation {
    /// Puts into the accelerations what plain iteration makes of them, from those `before`, and what the walls answer.
    pub(super) fn answer(&mut self, step: &Step<'_>) {
        let (h, body) = (step.step_s, &step.system.body);
        let mut touched = [0; MAX_PLANES];
        let mut count = 0;
        for (p, phase) in step.phases.iter().enumerate() {
            if matches!(phase, Phase::Contact(..)) {
                touched[count] = p;
                count += 1;
            }
        }
        let touched = &touched[..count];
        if touched.is_empty() {
            return;
        }
        let n = count * GAUSS;
        let (mut a, mut b) = (DMatrix::<f64>::identity(n, n), DVector::<f64>::zeros(n));
        // Of the plain change at each point, in each plane.
        let mut plain = [[V2::zeros(); GAUSS]; MAX_PLANES];
        for (plain, p) in plain.iter_mut().zip(touched) {
            for (plain, (at, before)) in plain
                .iter_mut()
                .zip(self.instants[1..END].iter().zip(&self.before[1..END]))
            {
                let port = &body.contacts[*p];
                *plain = port.of(&at.acceleration) - port.of(before);
            }
        }
        for (row_plane, p) in touched.iter().enumerate() {
            for i in 0..GAUSS {
                let at = &self.instants[1 + i].touches[*p];
                let (once, twice) = (&self.tables.once[1 + i], &self.tables.twice[1 + i]);
                let row = row_plane * GAUSS + i;
                for j in 0..GAUSS {
                    let slope = at.by_depth_n_m * h * h * twice[j] + at.by_rate_n_s_m * h * once[j];
                    b[row] += slope * at.normal.dot(&plain[row_plane][j]);
                    for (column_plane, q) in touched.iter().enumerate() {
                        let mobility = body.contacts[*p].mobility_with(&body.contacts[*q]);
                        let push = self.instants[1 + j].touches[*q].push();
                        a[(row, column_plane * GAUSS + j)] +=
                            slope * mobility * at.normal.dot(&push);
                    }
                }
            }
        }
        self.factorisations += 1;
        let Some(x) = a.lu().solve(&b) else { return };
        for (column_plane, q) in touched.iter().enumerate() {
            let data = &step.system.planes[*q];
            for j in 0..GAUSS {
                let more_n = x[column_plane * GAUSS + j];
                let at = &mut self.instants[1 + j];
                let touch = at.touches[*q];
                body.contacts[*q].push(&mut at.acceleration, -more_n * touch.push());
                let rubs_n = more_n * touch.sliding_share;
                at.spin_rate += data.radius_m * step.system.inverse_inertia * rubs_n;
                if let Some(race) = &data.race {
                    at.race_rates[*q] -= race.radius_m / race.inertia_kg_m2 * rubs_n;
                }
            }
        }
    }
}

impl super::Touch {
    /// Against the force on the rotor that one newton of normal force gives, friction in proportion to it included.
    fn push(&self) -> V2 {
        self.normal - (self.sliding_share + self.rolling_share) * perp(self.normal)
    }
}
