//! How far a rotor that is left to itself can ever get.
//!
//! In flight the shaft turns it on a shrinking ellipse, r(t) = e^(−δt)·(**A**·cos ω_d·t + **B**·sin ω_d·t) with **A** = **r**,
//! **B** = (**v** + δ·**r**)/ω_d, so r ≤ a with the larger semi-axis a² = (S + √(S² − 4P²))/2, S = A² + B², P = |**A** × **B**|.
//! An unbalance at held spin adds the circle **p**, ε·Ω²·e^(iσ)/(ω0² − Ω² + 2iδΩ); the ellipse is then that of **r** − **p**, and
//! r ≤ a + p.

use crate::V2;
use crate::vector::{Body, perp};

/// What moves a rotor in flight, per mass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FreeFlight {
    /// k/m \[1/s²\].
    pub(crate) stiffness: f64,
    /// d/m \[1/s\].
    pub(crate) damping: f64,
    /// Ω \[rad/s\], held.
    pub(crate) spin: f64,
    /// ε·Ω² \[m/s²\].
    pub(crate) unbalance: f64,
}

impl FreeFlight {
    /// How far it gets at most from now on, with the unbalance in this direction \[m\]; `None` without a shaft, and where an
    /// unbalance turns in one that is overdamped.
    pub(crate) fn farthest_m(&self, now: &Body, direction: V2) -> Option<f64> {
        let decay = 0.5 * self.damping;
        let damped_square = self.stiffness - decay * decay;
        if damped_square <= 0.0 {
            // It creeps back, and gets no farther than damping alone would let it.
            let creeps = self.unbalance == 0.0 && self.stiffness >= 0.0 && self.damping > 0.0;
            return creeps.then(|| now.position.norm() + now.velocity.norm() / self.damping);
        }
        let (circle, circle_rate) = if self.unbalance > 0.0 {
            let (re, im) = (
                self.stiffness - self.spin * self.spin,
                self.damping * self.spin,
            );
            let scale = self.unbalance / (re * re + im * im);
            let d = direction;
            let circle = scale * V2::new(d.x * re + d.y * im, d.y * re - d.x * im);
            (circle, self.spin * perp(circle))
        } else {
            (V2::zeros(), V2::zeros())
        };
        let a = now.position - circle;
        let b = (now.velocity - circle_rate + decay * a) / damped_square.sqrt();
        let sum = a.norm_squared() + b.norm_squared();
        let product = a.perp(&b);
        let root = (sum * sum - 4.0 * product * product).max(0.0).sqrt();
        Some((0.5 * (sum + root)).sqrt() + circle.norm())
    }
}
