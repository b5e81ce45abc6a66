//! Runs that take a step together: what goes in, what comes out, and the power series in between.

use super::number::{Lanes, Mask, WIDTH};
use crate::V2;
use crate::series::LENGTH;

/// Mode of all runs in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Kind {
    #[default]
    Flight,
    /// Without force, while the wall is still dented.
    Beyond,
    Slip,
    Roll,
}

impl Kind {
    pub(super) fn touches(self) -> bool {
        matches!(self, Self::Slip | Self::Roll)
    }
}

/// A plane vector of each run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pair {
    pub(super) x: Lanes,
    pub(super) y: Lanes,
}

impl Pair {
    #[inline(always)]
    pub(super) fn dot(self, other: Self) -> Lanes {
        self.x * other.x + self.y * other.y
    }

    pub(super) fn set(&mut self, lane: usize, v: V2) {
        (self.x.0[lane], self.y.0[lane]) = (v.x, v.y);
    }

    pub(super) fn at(&self, lane: usize) -> V2 {
        V2::new(self.x.0[lane], self.y.0[lane])
    }

    #[inline(always)]
    pub(super) fn perp(self, other: Self) -> Lanes {
        self.x * other.y - self.y * other.x
    }
}

/// Numbers that stay the same over a run, one field for each; forces and stiffnesses are per mass.
macro_rules! constants {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// Of one run.
        #[derive(Debug, Clone, Copy, Default)]
        pub(super) struct Constants {
            $($(#[$doc])* pub(super) $name: f64,)*
        }

        /// Of each run.
        #[derive(Debug, Clone, Copy, Default)]
        pub(super) struct LanesOfConstants {
            $(pub(super) $name: Lanes,)*
        }

        impl LanesOfConstants {
            pub(super) fn set(&mut self, lane: usize, of: &Constants) {
                $(self.$name.0[lane] = of.$name;)*
            }
        }
    };
}

constants! {
    /// Shaft: k/m \[1/s²\] and its root.
    stiffness,
    natural,
    /// d/m \[1/s\].
    damping,
    /// k_c/m \[1/s²\], its root, and d_c/m \[1/s\].
    contact_stiffness,
    contact_rate,
    contact_damping,
    /// c \[m\].
    clearance,
    friction,
    /// Ω·R \[m/s\].
    surface,
    /// ε·Ω² \[m/s²\], and Ω \[rad/s\] where that is not zero.
    unbalance,
    spin,
}

/// Runs in one step: what goes in, and what comes out.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    pub(super) kind: Kind,
    /// Whether any run is unbalanced.
    pub(super) unbalanced: bool,
    /// Whether any run ends by whirl.
    pub(super) watched: bool,
    pub(super) constants: LanesOfConstants,
    /// State, and at the end of the step.
    pub(super) position: Pair,
    pub(super) velocity: Pair,
    /// Direction of the unbalance.
    pub(super) direction: Pair,
    /// Sign of the sliding speed.
    pub(super) sign: Lanes,
    /// Flight beyond the wall: of lanes that have just lifted off.
    pub(super) beyond: Mask,
    /// Reference \[s\], and the next one.
    pub(super) reference: Lanes,
    /// Longest step \[s\].
    pub(super) most: Lanes,
    /// Largest speed so far \[m/s\].
    pub(super) fastest: Lanes,
    /// Length of the step \[s\], 0 where the reference was far too long; and its end on the series.
    pub(super) step: Lanes,
    pub(super) theta: Lanes,
    /// In a step of slip the whirl is never faster than this \[m/s\].
    pub(super) whirl: Lanes,
    pub(super) event: [Option<Event>; WIDTH],
}

/// What ended a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    Touch,
    LiftOff,
    /// The sliding speed comes to zero.
    Stops,
    /// Friction that holds it comes to an edge of its cone: from then on the sliding speed has this sign.
    Slips(bool),
    /// It may stay beyond the wall for longer; no step was taken.
    Lingers,
    /// Back inside the wall, without force.
    Returns,
}

/// Series of a step over θ = time / reference.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    pub(super) ux: [Lanes; LENGTH],
    pub(super) uy: [Lanes; LENGTH],
    pub(super) wx: [Lanes; LENGTH],
    pub(super) wy: [Lanes; LENGTH],
    /// ρ, f_n, κ, τ.
    pub(super) distance: [Lanes; LENGTH],
    pub(super) force: [Lanes; LENGTH],
    pub(super) normal: [Lanes; LENGTH],
    pub(super) friction: [Lanes; LENGTH],
    pub(super) cos: [Lanes; LENGTH],
    pub(super) sin: [Lanes; LENGTH],
    /// A guard.
    pub(super) guard: [Lanes; LENGTH],
    pub(super) room: [Lanes; LENGTH],
}

impl Default for Rows {
    fn default() -> Self {
        let row = [Lanes::default(); LENGTH];
        Self {
            ux: row,
            uy: row,
            wx: row,
            wy: row,
            distance: row,
            force: row,
            normal: row,
            friction: row,
            cos: row,
            sin: row,
            guard: row,
            room: row,
        }
    }
}

impl Rows {
    /// Speed of a run's whirl \[m/s\] at θ, counter-clockwise, and its slope.
    pub(super) fn whirl(&self, lane: usize, order: usize, theta: f64) -> (f64, f64) {
        let with_slope = |x: &[Lanes; LENGTH], y: &[Lanes; LENGTH]| {
            let (mut value, mut slope) = (V2::zeros(), V2::zeros());
            for k in (0..=order).rev() {
                slope = slope * theta + value;
                value = value * theta + V2::new(x[k].0[lane], y[k].0[lane]);
            }
            (value, slope)
        };
        let (u, w) = (
            with_slope(&self.ux, &self.uy),
            with_slope(&self.wx, &self.wy),
        );
        let distance = u.0.norm();
        let speed = u.0.perp(&w.0) / distance;
        let turned = speed * u.0.dot(&u.1) / (distance * distance);
        (speed, (u.1.perp(&w.0) + u.0.perp(&w.1)) / distance - turned)
    }
}

/// Tolerances and orders in flight and in contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Accuracy {
    pub(super) rtol: [f64; 2],
    pub(super) order: [usize; 2],
}
