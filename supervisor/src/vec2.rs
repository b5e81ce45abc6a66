//! Vectors in the plane of the bearing.

use crate::math::sqrt;

/// A plane vector (x right, y up).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Vec2 {
    pub(crate) x: f32,
    pub(crate) y: f32,
}

impl Vec2 {
    pub(crate) const ZERO: Self = Self { x: 0.0, y: 0.0 };

    #[inline]
    pub(crate) const fn new(x: f32, y: f32) -> Self {
        Self { x, y }
    }

    #[inline]
    pub(crate) const fn from_array([x, y]: [f32; 2]) -> Self {
        Self { x, y }
    }

    #[inline]
    pub(crate) const fn to_array(self) -> [f32; 2] {
        [self.x, self.y]
    }

    #[inline]
    pub(crate) fn dot(self, other: Self) -> f32 {
        self.x * other.x + self.y * other.y
    }

    /// A quarter turn counter-clockwise: t̂ from r̂.
    #[inline]
    pub(crate) fn turned(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// Rotated by the angle of the vector (`cos`, `sin`), which need not be exactly a unit vector.
    #[inline]
    pub(crate) fn rotated(self, by: Self) -> Self {
        Self::new(self.x * by.x - self.y * by.y, self.x * by.y + self.y * by.x)
    }

    #[inline]
    pub(crate) fn length_squared(self) -> f32 {
        self.dot(self)
    }

    #[inline]
    pub(crate) fn length(self) -> f32 {
        sqrt(self.length_squared())
    }

    /// Unit vector and length; the zero vector and 0 where there is no direction.
    #[inline]
    pub(crate) fn direction(self) -> (Self, f32) {
        let length = self.length();
        if length > 0.0 {
            (self * (1.0 / length), length)
        } else {
            (Self::ZERO, 0.0)
        }
    }

    #[inline]
    pub(crate) fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl core::ops::Add for Vec2 {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl core::ops::Sub for Vec2 {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl core::ops::Mul<f32> for Vec2 {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f32) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

impl core::ops::Neg for Vec2 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}
