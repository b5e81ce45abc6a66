//! Small disturbances of steady whirl in a circle.
//!
//! In the frame that turns with the whirl the circle stands still and its disturbances have constant coefficients:
//! a body at X obeys m·(Ẍ − 2iωẊ − ω²X) = F − k·X − d·(Ẋ − iωX). Let the disturbance of u be a + ib, along
//! and across the normal. The force −(N + iQ)·u/|u| on the rotor then changes by
//!
//! ```text
//! −(δN + iδQ) − (N + iQ)·ib/|u|        δN = k_c·a + d_c·ȧ
//! sliding:  δQ = μ·δN                    rolling:  δQ = D·(ḃ − ω·a), D → ∞, so that the sliding speed
//!                                                  stays zero
//! ```

use super::{Circle, Oscillator, SteadyWhirl, Surface};
use nalgebra::DMatrix;

/// Contact stiffness that stands for infinity \[N/m\]; the softest parts are a thousandth of it.
const HARD_N_M: f64 = 1e12;
/// Damping ratio of the contact against the rotor that stands for a contact without deformation.
const HARD_DAMPING_RATIO: f64 = 0.08;

impl SteadyWhirl {
    /// Largest real part of the eigenvalues \[1/s\], the one of the phase aside, which is zero.
    pub(super) fn growth_rate_s(&self, circle: &Circle, surface: Surface) -> f64 {
        // A tangential spring is outside the equations of the plant.
        if self.tangential_compliance_m_n > 0.0 || !circle.exists() {
            return f64::NAN;
        }
        let w = circle.omega_rad_s;
        let bodies: Vec<&Oscillator> = std::iter::once(&self.rotor).chain(&self.rings).collect();
        let n = bodies.len();
        let (k_c, d_c) = if self.normal_compliance_m_n > 0.0 {
            (1.0 / self.normal_compliance_m_n, self.contact_damping_n_s_m)
        } else {
            let critical = 2.0 * (HARD_N_M * self.rotor.mass_kg).sqrt();
            (HARD_N_M, HARD_DAMPING_RATIO * critical)
        };
        // Unknowns: x, y of each body, then their rates over ω; time in 1/ω.
        let size = 4 * n;
        let mut matrix = DMatrix::<f64>::zeros(size, size);
        let (x, v) = (|body: usize, axis: usize| 2 * body + axis, 2 * n);
        for i in 0..2 * n {
            matrix[(i, v + i)] = 1.0;
        }
        // Force on a body along an axis by a displacement or by a rate (over ω) in column `from`.
        let mut add = |body: usize, axis: usize, from: usize, force: f64| {
            let mass = bodies[body].mass_kg;
            matrix[(v + x(body, axis), from)] += force / (mass * w * w);
        };
        for (body, own) in bodies.iter().enumerate() {
            let inertia = own.mass_kg * w * w;
            for (axis, other, turn) in [(0, 1, 1.0), (1, 0, -1.0)] {
                add(body, axis, x(body, axis), inertia);
                // 2iωẊ: −2ωẏ along x, 2ωẋ along y, for a frame that turns clockwise with the minus.
                add(body, axis, v + x(body, other), -2.0 * turn * inertia);
            }
            // The mounting acts against what carries it: the next ring, or the ground.
            let carrier = (body > 0 && body + 1 < n).then_some(body + 1);
            for (on, sign_on) in std::iter::once((body, 1.0)).chain(carrier.map(|c| (c, -1.0))) {
                for (of, sign_of) in std::iter::once((body, 1.0)).chain(carrier.map(|c| (c, -1.0)))
                {
                    let sign = sign_on * sign_of;
                    let (k, d) = (own.stiffness_n_m, own.damping_n_s_m * w);
                    for (axis, other, turn) in [(0, 1, 1.0), (1, 0, -1.0)] {
                        add(on, axis, x(of, axis), -sign * k);
                        add(on, axis, v + x(of, axis), -sign * d);
                        // d·iωX: −dω·y along x, dω·x along y.
                        add(on, axis, x(of, other), -sign * turn * d);
                    }
                }
            }
        }
        let rate = d_c * w;
        let grip = 1e4 * self.rotor.mass_kg * w * w;
        let (normal, tangential) = (
            circle.normal_force_n / circle.distance_m,
            circle.driving_share * circle.normal_force_n / circle.distance_m,
        );
        // (axis of the force, axis of u or, from 2 on, of its rate, force on the rotor).
        let mut contact = vec![
            (0, 0, -k_c),
            (0, 2, -rate),
            (0, 1, tangential),
            (1, 1, -normal),
        ];
        match surface {
            Surface::Sliding => {
                contact.push((1, 0, -circle.driving_share * k_c));
                contact.push((1, 2, -circle.driving_share * rate));
            }
            Surface::Rolling => {
                contact.push((1, 3, -grip));
                contact.push((1, 0, grip));
            }
        }
        for (axis, cause, force) in contact {
            let column = |body| {
                if cause < 2 {
                    x(body, cause)
                } else {
                    v + x(body, cause - 2)
                }
            };
            add(0, axis, column(0), force);
            if n > 1 {
                add(0, axis, column(1), -force);
                add(1, axis, column(0), -force);
                add(1, axis, column(1), force);
            }
        }
        let mut eigenvalues: Vec<_> = matrix.complex_eigenvalues().iter().copied().collect();
        // The neutral one is the smallest.
        eigenvalues.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        let growth = eigenvalues.iter().skip(1).map(|value| value.re);
        growth.fold(f64::NEG_INFINITY, f64::max) * w
    }
}
