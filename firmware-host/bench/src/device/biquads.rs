//! A levitation controller of the user's: on each axis a gain and a chain of second-order sections.
//!
//! ```text
//! f = −k·H(z)·y,   H = Π (b0 + b1·z⁻¹ + b2·z⁻²)/(1 + a1·z⁻¹ + a2·z⁻²)
//! ```
//!
//! Each plane's sensor commands the plane's own magnet.

use crate::device::actuator::limited_n;
use plant_model::V2;

/// A section with a0 = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    pub b: [f64; 3],
    pub a: [f64; 2],
}

/// The controller of a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct BiquadsParams {
    /// k \[N/m\].
    pub gain_n_m: f64,
    /// Sections of x and of y, in their order.
    pub sections: [Vec<Section>; 2],
    /// Cap of the magnet \[N\].
    pub force_max_n: f64,
}

/// A section in direct form II transposed.
#[derive(Debug, Clone)]
struct Biquad {
    section: Section,
    /// What is left for the next sample and the one after it.
    left: [f64; 2],
}

impl Biquad {
    fn filtered(&mut self, x: f64) -> f64 {
        let Section {
            b: [b0, b1, b2],
            a: [a1, a2],
        } = self.section;
        let y = b0 * x + self.left[0];
        self.left = [b1 * x - a1 * y + self.left[1], b2 * x - a2 * y];
        y
    }
}

/// Controllers of planes.
#[derive(Debug, Clone)]
pub(crate) struct Biquads {
    /// None where there is no magnet.
    planes: Vec<Option<Plane>>,
}

#[derive(Debug, Clone)]
struct Plane {
    gain_n_m: f64,
    chains: [Vec<Biquad>; 2],
    force_max_n: f64,
    usable_m: V2,
}

impl Biquads {
    /// Controllers at rest, one for each plane that has a magnet.
    pub(crate) fn new(params: &[Option<BiquadsParams>]) -> Self {
        let chain = |sections: &Vec<Section>| {
            let sections = sections.iter();
            sections
                .map(|section| Biquad {
                    section: *section,
                    left: [0.0; 2],
                })
                .collect()
        };
        let planes = params.iter().map(|plane| {
            plane.as_ref().map(|plane| Plane {
                gain_n_m: plane.gain_n_m,
                chains: plane.sections.each_ref().map(chain),
                force_max_n: plane.force_max_n,
                usable_m: V2::zeros(),
            })
        });
        Self {
            planes: planes.collect(),
        }
    }

    /// Forces of the planes \[N\] for what their sensors measure \[m\], each within its cap; a reading that is no number
    /// counts as the last.
    pub(crate) fn forces_n(&mut self, measured_m: impl Iterator<Item = V2>, forces_n: &mut [V2]) {
        for ((plane, measured_m), force_n) in self.planes.iter_mut().zip(measured_m).zip(forces_n) {
            *force_n = match plane {
                Some(plane) => plane.force_n(measured_m),
                None => V2::zeros(),
            };
        }
    }
}

impl Plane {
    fn force_n(&mut self, measured_m: V2) -> V2 {
        self.usable_m = measured_m.zip_map(
            &self.usable_m,
            |new, old| if new.is_finite() { new } else { old },
        );
        let mut through = |axis: usize| {
            let chain = self.chains[axis].iter_mut();
            chain.fold(self.usable_m[axis], |x, section| section.filtered(x))
        };
        let filtered_m = V2::new(through(0), through(1));
        limited_n(-self.gain_n_m * filtered_m, self.force_max_n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the recursion y_k = Σ b·x − Σ a·y, written out.
    #[test]
    fn a_chain_is_its_recursions() {
        let sections = [
            Section {
                b: [0.5, -0.2, 0.1],
                a: [-1.1, 0.3],
            },
            Section {
                b: [2.0, 1.0, -0.5],
                a: [0.4, 0.05],
            },
        ];
        let mut biquads = Biquads::new(&[
            None,
            Some(BiquadsParams {
                gain_n_m: 3.0,
                sections: [sections.to_vec(), Vec::new()],
                force_max_n: 100.0,
            }),
        ]);
        let input: Vec<f64> = (0..40).map(|k| f64::from(k * k % 7) - 3.0).collect();
        let mut signal = input.clone();
        for Section { b, a } in sections {
            let mut out: Vec<f64> = Vec::new();
            for k in 0..signal.len() {
                let at = |of: &[f64], back: usize| {
                    k.checked_sub(back)
                        .and_then(|i| of.get(i).copied())
                        .unwrap_or(0.0)
                };
                let fed: f64 = (0..3).map(|i| b[i] * at(&signal, i)).sum();
                let back: f64 = (0..2).map(|i| a[i] * at(&out, i + 1)).sum();
                out.push(fed - back);
            }
            signal = out;
        }
        let mut forces_n = [V2::repeat(9.0); 2];
        for (x, filtered) in input.iter().zip(&signal) {
            let measured_m = [V2::zeros(), V2::new(*x, -*x)];
            biquads.forces_n(measured_m.into_iter(), &mut forces_n);
            assert_eq!(forces_n[0], V2::zeros());
            assert!((forces_n[1].x + 3.0 * filtered).abs() < 1e-12);
            assert_eq!(forces_n[1].y, 3.0 * x);
        }
        // A reading that is no number is the last; the cap is that of the vector.
        biquads.forces_n(
            [V2::zeros(), V2::repeat(f64::NAN)].into_iter(),
            &mut forces_n,
        );
        assert_eq!(forces_n[1].y, 3.0 * input[39]);
        biquads.forces_n([V2::zeros(), V2::repeat(1e3)].into_iter(), &mut forces_n);
        assert!((forces_n[1].norm() / 100.0 - 1.0).abs() < 1e-15);
    }
}
