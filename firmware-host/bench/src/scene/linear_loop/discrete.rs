//! Linear systems at samples, and how they are put together.

use nalgebra::DMatrix;

/// x' = A·x + B·u, y = C·x + D·u from one sample to the next.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Discrete {
    pub(super) a: DMatrix<f64>,
    pub(super) b: DMatrix<f64>,
    pub(super) c: DMatrix<f64>,
    pub(super) d: DMatrix<f64>,
}

impl Discrete {
    /// Without a memory.
    pub(super) fn gain(d: DMatrix<f64>) -> Self {
        Self {
            a: DMatrix::zeros(0, 0),
            b: DMatrix::zeros(0, d.ncols()),
            c: DMatrix::zeros(d.nrows(), 0),
            d,
        }
    }

    /// Each signal so many samples later.
    pub(super) fn delays(samples: &[usize]) -> Self {
        (samples.iter()).fold(Self::gain(DMatrix::zeros(0, 0)), |all, count| {
            let n = *count;
            let mut one = Self::gain(DMatrix::from_element(1, 1, f64::from(u8::from(n == 0))));
            if n > 0 {
                one.a = DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i == j + 1)));
                one.b = DMatrix::from_fn(n, 1, |i, _| f64::from(u8::from(i == 0)));
                one.c = DMatrix::from_fn(1, n, |_, j| f64::from(u8::from(j == n - 1)));
            }
            all.beside(&one)
        })
    }

    /// Both, with nothing between them: signals of this one first.
    pub(super) fn beside(&self, other: &Self) -> Self {
        let corner = |a: &DMatrix<f64>, b: &DMatrix<f64>| {
            let mut both = DMatrix::zeros(a.nrows() + b.nrows(), a.ncols() + b.ncols());
            both.view_mut((0, 0), a.shape()).copy_from(a);
            both.view_mut(a.shape(), b.shape()).copy_from(b);
            both
        };
        Self {
            a: corner(&self.a, &other.a),
            b: corner(&self.b, &other.b),
            c: corner(&self.c, &other.c),
            d: corner(&self.d, &other.d),
        }
    }

    /// What comes out of this one goes into another.
    pub(super) fn then(&self, other: &Self) -> Self {
        let (n, m) = (self.a.nrows(), other.a.nrows());
        let mut a = DMatrix::zeros(n + m, n + m);
        a.view_mut((0, 0), (n, n)).copy_from(&self.a);
        a.view_mut((n, 0), (m, n)).copy_from(&(&other.b * &self.c));
        a.view_mut((n, n), (m, m)).copy_from(&other.a);
        Self {
            a,
            b: stacked(&self.b, &(&other.b * &self.d)),
            c: abreast(&(&other.d * &self.c), &other.c),
            d: &other.d * &self.d,
        }
    }

    /// Closed over another one, which takes what comes out of this one and gives what goes into it: A of both, and what a signal
    /// added to that which the other takes does to the states. This one answers with its memory alone.
    pub(super) fn closed_over(&self, other: &Self) -> (DMatrix<f64>, DMatrix<f64>) {
        let (n, m) = (self.a.nrows(), other.a.nrows());
        let mut a = DMatrix::zeros(n + m, n + m);
        a.view_mut((0, 0), (n, n))
            .copy_from(&(&self.a + &self.b * &other.d * &self.c));
        a.view_mut((0, n), (n, m)).copy_from(&(&self.b * &other.c));
        a.view_mut((n, 0), (m, n)).copy_from(&(&other.b * &self.c));
        a.view_mut((n, n), (m, m)).copy_from(&other.a);
        (a, stacked(&(&self.b * &other.d), &other.b))
    }
}

fn stacked(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    let mut both = DMatrix::zeros(above.nrows() + below.nrows(), above.ncols());
    both.view_mut((0, 0), above.shape()).copy_from(above);
    both.view_mut((above.nrows(), 0), below.shape())
        .copy_from(below);
    both
}

fn abreast(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    let mut both = DMatrix::zeros(left.nrows(), left.ncols() + right.ncols());
    both.view_mut((0, 0), left.shape()).copy_from(left);
    both.view_mut((0, left.ncols()), right.shape())
        .copy_from(right);
    both
}
