//! Least squares: Gauss and Newton's steps, held back as Levenberg and Marquardt do where they do not improve.

use nalgebra::{DMatrix, DVector};

/// Steps at most.
const STEPS: usize = 40;
/// Difference by which slopes are found, and the step at which it ends, as shares of the sizes of the values.
const DIFFERENCE: f64 = 1e-5;
const ENOUGH: f64 = 1e-7;

/// Values near `start` with which the sum of squares is smallest. `sizes` are those of what a value may change by.
///
/// # Errors
/// What the residuals say.
pub(super) fn fitted<const N: usize, E>(
    start: [f64; N],
    sizes: [f64; N],
    residuals: impl Fn(&[f64; N]) -> Result<Vec<f64>, E>,
) -> Result<[f64; N], E> {
    let mut values = start;
    let mut off = DVector::from_vec(residuals(&values)?);
    let mut held_back = 1e-6;
    for _ in 0..STEPS {
        let mut slopes = DMatrix::zeros(off.len(), N);
        for (i, size) in sizes.iter().enumerate() {
            let mut near = values;
            near[i] += DIFFERENCE * size;
            let more = DVector::from_vec(residuals(&near)?) - &off;
            slopes.set_column(i, &(more / DIFFERENCE));
        }
        let (normal, gradient) = (slopes.tr_mul(&slopes), slopes.tr_mul(&off));
        let mut longest = 0.0;
        // Until it improves.
        while held_back < 1e6 {
            let mut damped = normal.clone();
            for i in 0..N {
                // What has no slope yet stays where it is.
                damped[(i, i)] += held_back * (normal[(i, i)] + normal.trace());
            }
            let Some(step) = damped.lu().solve(&gradient) else {
                held_back *= 10.0;
                continue;
            };
            let tried: [f64; N] = std::array::from_fn(|i| values[i] - step[i] * sizes[i]);
            // Values with which nothing can be computed are none.
            let there = residuals(&tried).ok().map(DVector::from_vec);
            if let Some(there) = there.filter(|there| there.norm_squared() < off.norm_squared()) {
                (values, off, longest) = (tried, there, step.amax());
                held_back = f64::max(0.1 * held_back, 1e-12);
                break;
            }
            held_back *= 10.0;
        }
        if longest < ENOUGH {
            break;
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::fitted;

    #[test]
    fn a_decay_is_found_again() {
        let decay = |[a, rate]: [f64; 2], t: f64| a * (-rate * t).exp();
        let found = fitted::<2, ()>([1.0, 0.1], [1.0, 1.0], |values| {
            let times = (0..50).map(|i| 0.1 * f64::from(i));
            Ok(times
                .map(|t| decay(*values, t) - decay([3.0, 0.8], t))
                .collect())
        });
        let [a, rate] = found.unwrap();
        assert!(
            (a - 3.0).abs() < 1e-6 && (rate - 0.8).abs() < 1e-6,
            "{a} {rate}"
        );
    }

    #[test]
    fn what_cannot_be_computed_is_stepped_back_from() {
        // The first step of this leads below zero.
        let found = fitted([4.0], [1.0], |[x]: &[f64; 1]| match *x > 0.0 {
            true => Ok(vec![x.ln() - 0.1f64.ln()]),
            false => Err("below zero"),
        });
        assert!((found.unwrap()[0] - 0.1).abs() < 1e-6);
        assert_eq!(
            fitted([-1.0], [1.0], |_| Err("below zero")),
            Err("below zero")
        );
    }
}
