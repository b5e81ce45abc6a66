//! Small dense linear systems without allocation: how many states a plant has is known to its type
//! only, where no array length can be taken from.

use nalgebra::ComplexField;

/// Most scalar states that a plant has.
pub(super) const MOST: usize = 17;

/// LU factors with row exchanges of diagonal·I − J.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lu<T> {
    n: usize,
    a: [[T; MOST]; MOST],
    pivots: [usize; MOST],
}

impl<T: ComplexField<RealField = f64> + Copy> Lu<T> {
    /// Room for factors, kept from one matrix to the next: they are too large to be moved for each.
    pub(super) fn new() -> Self {
        Self {
            n: 0,
            a: [[T::zero(); MOST]; MOST],
            pivots: [0; MOST],
        }
    }

    /// Factorises the leading n × n part. False where it is singular.
    pub(super) fn factorise(
        &mut self,
        jacobian: &[[f64; MOST]; MOST],
        diagonal: T,
        n: usize,
    ) -> bool {
        self.n = n;
        let (a, pivots) = (&mut self.a, &mut self.pivots);
        for (i, (row, from)) in a.iter_mut().zip(jacobian).take(n).enumerate() {
            for (x, from) in row.iter_mut().zip(&from[..n]) {
                *x = T::from_real(-from);
            }
            row[i] += diagonal;
        }
        for k in 0..n {
            let mut best = k;
            for i in k + 1..n {
                if a[i][k].norm1() > a[best][k].norm1() {
                    best = i;
                }
            }
            a.swap(k, best);
            pivots[k] = best;
            let inverse = T::one() / a[k][k];
            if !inverse.is_finite() {
                return false;
            }
            let pivot_row = a[k];
            for row in &mut a[k + 1..n] {
                let factor = row[k] * inverse;
                row[k] = factor;
                if factor != T::zero() {
                    for j in k + 1..n {
                        row[j] -= factor * pivot_row[j];
                    }
                }
            }
            a[k][k] = inverse;
        }
        true
    }

    /// Solves in place for the leading n entries.
    pub(super) fn solve(&self, b: &mut [T; MOST]) {
        for (k, pivot) in self.pivots[..self.n].iter().enumerate() {
            b.swap(k, *pivot);
        }
        for k in 0..self.n {
            for i in k + 1..self.n {
                b[i] -= self.a[i][k] * b[k];
            }
        }
        for k in (0..self.n).rev() {
            for j in k + 1..self.n {
                b[k] -= self.a[k][j] * b[j];
            }
            b[k] *= self.a[k][k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    /// A matrix that needs row exchanges, real and complex.
    #[test]
    fn solves() {
        let n = 5;
        let mut jacobian = [[0.0; MOST]; MOST];
        for (i, row) in jacobian.iter_mut().enumerate().take(n) {
            for (j, x) in row.iter_mut().enumerate().take(n) {
                *x = ((3 * i + 7 * j) % 11) as f64 - if i == j { 4.0 } else { 0.0 };
            }
        }
        let diagonal = Complex::new(jacobian[0][0], 0.5);
        let exact: [Complex<f64>; MOST] =
            std::array::from_fn(|i| Complex::new(1.0 + i as f64, -2.0));
        let mut b = [Complex::new(0.0, 0.0); MOST];
        for i in 0..n {
            b[i] = diagonal * exact[i];
            for j in 0..n {
                b[i] -= exact[j] * jacobian[i][j];
            }
        }
        let mut lu = Lu::new();
        assert!(lu.factorise(&jacobian, diagonal, n));
        lu.solve(&mut b);
        for i in 0..n {
            assert!((b[i] - exact[i]).norm() < 1e-12, "{i}: {}", b[i]);
        }
        assert!(!Lu::new().factorise(&[[0.0; MOST]; MOST], 0.0, n));
    }
}
