//! Coulomb friction, constant or falling with the sliding speed.

use crate::params::SlidingFriction;

impl SlidingFriction {
    /// Coefficient μ at a sliding speed \[m/s\] of either sign.
    #[inline]
    pub fn coefficient(&self, sliding_speed_m_s: f64) -> f64 {
        match *self {
            Self::Constant { coefficient } => coefficient,
            Self::Falling {
                at_rest,
                at_speed,
                speed_scale_m_s,
            } => {
                at_speed + (at_rest - at_speed) * (-sliding_speed_m_s.abs() / speed_scale_m_s).exp()
            }
        }
    }
}
