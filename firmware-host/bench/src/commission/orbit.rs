//! What goes round with the rotor, taken off a signal: unbalance and runout are no force that is commanded, and may be a hundred times
//! what the stimulus does.

use nalgebra::{DMatrix, DVector};

/// Multiples of the spin that sensors and rotors have.
pub(super) const HARMONICS: [f64; 3] = [1.0, 2.0, 3.0];
/// Turns from which on a multiple of the spin is told from a mean, and another one from it.
const LEAST_TURNS: f64 = 4.0;
/// A constant, and a cosine and a sine for each multiple.
const TERMS: usize = 1 + 2 * HARMONICS.len();

/// A signal without its mean and its orbit, by least squares under these weights, the rotor standing at these angles \[rad\].
pub(super) fn without_orbit(
    values: &[[f64; 2]],
    angles_rad: &[f64],
    weights: &[f64],
) -> Vec<[f64; 2]> {
    let turned = match (angles_rad.first(), angles_rad.last()) {
        (Some(first), Some(last)) => (last - first).abs(),
        _ => 0.0,
    };
    let number = match turned >= LEAST_TURNS * std::f64::consts::TAU {
        true => TERMS,
        false => 1,
    };
    let mut normal = DMatrix::<f64>::zeros(number, number);
    let mut right = [DVector::<f64>::zeros(number), DVector::zeros(number)];
    for ((value, angle), weight) in values.iter().zip(angles_rad).zip(weights) {
        let terms = terms(*angle);
        for i in 0..number {
            for (axis, right) in right.iter_mut().enumerate() {
                right[i] += weight * terms[i] * value[axis];
            }
            for j in 0..=i {
                normal[(i, j)] += weight * terms[i] * terms[j];
            }
        }
    }
    normal.fill_upper_triangle_with_lower_triangle();
    let Some(cholesky) = normal.cholesky() else {
        return values.to_vec();
    };
    let of = right.map(|right| cholesky.solve(&right));
    let pairs = values.iter().zip(angles_rad);
    pairs
        .map(|(value, angle)| {
            let terms = terms(*angle);
            [0, 1].map(|axis| {
                let own: f64 = (0..number).map(|i| of[axis][i] * terms[i]).sum();
                value[axis] - own
            })
        })
        .collect()
}

fn terms(angle_rad: f64) -> [f64; TERMS] {
    let mut all = [1.0; TERMS];
    for (place, times) in HARMONICS.iter().enumerate() {
        let (sin, cos) = (times * angle_rad).sin_cos();
        (all[1 + 2 * place], all[2 + 2 * place]) = (cos, sin);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orbit_goes_and_the_rest_stays() {
        let rows = 4_000;
        let angles: Vec<f64> = (0..rows).map(|i| 0.03 * f64::from(i)).collect();
        let weights: Vec<f64> = (0..rows)
            .map(|i| {
                (std::f64::consts::PI * f64::from(i) / 4_000.0)
                    .sin()
                    .powi(4)
            })
            .collect();
        let small = |i: usize| 1e-7 * (0.051 * i as f64).sin();
        let values: Vec<[f64; 2]> = (angles.iter().enumerate())
            .map(|(i, angle)| {
                let round = 1e-4 * angle.cos() + 2e-5 * (3.0 * angle + 0.3).sin();
                [3e-5 + round + small(i), round - 1e-5]
            })
            .collect();
        let left = without_orbit(&values, &angles, &weights);
        for (i, [x, y]) in left.iter().enumerate() {
            assert!(
                (x - small(i)).abs() < 2e-9 && y.abs() < 1e-12,
                "{i}: {x} {y}"
            );
        }
    }
}
