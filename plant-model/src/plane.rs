//! A plane in which the rotor may touch: how the two press and rub, and what the rotor touches there.

pub(crate) mod race;

use crate::ellipse::Ellipse;
use crate::params::{ContactParams, FrictionParams};
use crate::part::Part;
use race::Race;

/// The plane. What its bearing lacks is a unit type.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane<B, R> {
    /// R_r, of the rotor where it touches \[m\].
    pub(crate) radius_m: f64,
    /// Clearance and contact law.
    pub(crate) contact: ContactParams,
    /// Friction.
    pub(crate) friction: FrictionParams,
    /// Shape of the bore.
    pub(crate) bore: B,
    /// Race of a ball bearing.
    pub(crate) race: R,
}

/// The shape of a bore: a circle by the clearance, or an [`Ellipse`].
pub(crate) trait Bore: Copy + Send + 'static {
    /// Whether it is an [`Ellipse`]: then contact has no power series.
    const OUT_OF_ROUND: bool = false;
    /// The ellipse, where it is that.
    #[inline]
    fn ellipse(&self) -> Option<&Ellipse> {
        None
    }
}

impl Bore for () {}

impl Bore for Ellipse {
    const OUT_OF_ROUND: bool = true;
    fn ellipse(&self) -> Option<&Ellipse> {
        Some(self)
    }
}

/// What the rotor slides on: a bushing, or the [`Race`] of a ball bearing, which turns.
pub(crate) trait Raceway: Copy + Send + 'static {
    /// Its spin, if it turns.
    type State: Part;
    /// Whether it turns.
    const TURNS: bool = false;
    /// Its spin at the start.
    fn start(&self) -> Self::State;
    /// The race, where it is that.
    #[inline]
    fn race(&self) -> Option<&Race> {
        None
    }
    /// Its spin Ω_i \[rad/s\], in a state or a change of one; 0 for a bushing.
    #[inline]
    fn spin_rad_s(_state: &Self::State) -> f64 {
        0.0
    }
    /// Ω_i replaced, where there is a race.
    #[inline]
    fn set_spin_rad_s(_state: &mut Self::State, _spin_rad_s: f64) {}
    /// Time derivative under sliding friction on the rotor \[N\]. Linear in both.
    fn rates(&self, state: &Self::State, sliding_n: f64) -> Self::State;
    /// State after `dt_s` without contact.
    fn coast(&self, state: &Self::State, dt_s: f64) -> Self::State;
}

impl Raceway for () {
    type State = ();
    fn start(&self) {}
    #[inline]
    fn rates(&self, _state: &(), _sliding_n: f64) {}
    #[inline]
    fn coast(&self, _state: &(), _dt_s: f64) {}
}
