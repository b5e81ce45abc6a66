//! Vectors in the plane of the bearing.

use crate::number::scalar::Scalar;
use crate::number::words::words_of_fields;

/// A plane vector (x right, y up).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Vec2<S> {
    pub(crate) x: S,
    pub(crate) y: S,
}

words_of_fields!(Vec2<S> { x, y });

impl<S: Scalar> Vec2<S> {
    pub(crate) const ZERO: Self = Self {
        x: S::ZERO,
        y: S::ZERO,
    };

    #[inline]
    pub(crate) const fn new(x: S, y: S) -> Self {
        Self { x, y }
    }

    /// Cosine and sine of an angle, by their series: to 1 % up to a radian.
    #[inline]
    pub(crate) fn at_angle(angle: S) -> Self {
        let square = angle * angle;
        Self::new(
            S::ONE - square * (S::from_f32(0.5) - square * S::from_f32(1.0 / 24.0)),
            angle * (S::ONE - square * S::from_f32(1.0 / 6.0)),
        )
    }

    #[inline]
    pub(crate) fn from_array([x, y]: [S; 2]) -> Self {
        Self { x, y }
    }

    #[inline]
    pub(crate) fn to_array(self) -> [S; 2] {
        [self.x, self.y]
    }

    #[inline]
    pub(crate) fn dot(self, other: Self) -> S {
        S::products(self.x, other.x, self.y, other.y)
    }

    /// A quarter turn counter-clockwise: t̂ from r̂.
    #[inline]
    pub(crate) fn perp(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// Rotated by the angle of the vector (`cos`, `sin`), which need not be exactly a unit vector.
    #[inline]
    pub(crate) fn rotated(self, by: Self) -> Self {
        Self::new(
            S::products(self.x, by.x, -self.y, by.y),
            S::products(self.x, by.y, self.y, by.x),
        )
    }

    #[inline]
    pub(crate) fn length_squared(self) -> S {
        self.dot(self)
    }

    /// 1/length; 0 where there is no direction.
    #[inline]
    pub(crate) fn inverse_length(self) -> S {
        S::inverse_length(self.x, self.y)
    }

    /// Unit vector; the zero vector where there is no direction.
    #[inline]
    pub(crate) fn direction(self) -> Self {
        self * self.inverse_length()
    }

    /// The length to within 4 %, without a root.
    #[inline]
    pub(crate) fn about_length(self) -> S {
        let (x, y) = (self.x.abs(), self.y.abs());
        let (long, short) = if x > y { (x, y) } else { (y, x) };
        S::products(long, S::from_f32(0.96), short, S::from_f32(0.4))
    }

    /// Whether it is longer than `limit`; true also where it is no number.
    #[inline]
    pub(crate) fn exceeds(self, limit: S) -> bool {
        S::exceeds(self.x, self.y, limit)
    }

    #[inline]
    pub(crate) fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }

    /// Each coordinate by a function.
    #[inline]
    pub(crate) fn map(self, f: impl Fn(S) -> S) -> Self {
        Self::new(f(self.x), f(self.y))
    }
}

impl<S: Scalar> core::ops::Add for Vec2<S> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl<S: Scalar> core::ops::Sub for Vec2<S> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl<S: Scalar> core::ops::Mul<S> for Vec2<S> {
    type Output = Self;
    #[inline]
    fn mul(self, factor: S) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

impl<S: Scalar> core::ops::Neg for Vec2<S> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}
