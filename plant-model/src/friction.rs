//! Coulomb friction, constant or falling with the sliding speed.

use crate::params::SlidingFriction;

impl SlidingFriction {
    /// Coefficient μ at a sliding speed \[m/s\], counted along the direction of slip.
    ///
    /// The law holds from zero upwards. A step that ends the slip looks a little beyond, at negative
    /// speeds; there the law is continued smoothly, and held once it has grown by e.
    #[inline]
    pub fn coefficient(&self, along_slip_m_s: f64) -> f64 {
        match *self {
            Self::Constant { coefficient } => coefficient,
            Self::Falling {
                at_rest,
                at_speed,
                speed_scale_m_s,
            } => {
                let exponent = (-along_slip_m_s / speed_scale_m_s).min(1.0);
                at_speed + (at_rest - at_speed) * exponent.exp()
            }
        }
    }

    /// Change of [`SlidingFriction::coefficient`] per speed \[s/m\].
    pub fn slope(&self, along_slip_m_s: f64) -> f64 {
        match *self {
            Self::Constant { .. } => 0.0,
            Self::Falling {
                at_rest,
                at_speed,
                speed_scale_m_s,
            } => {
                let exponent = -along_slip_m_s / speed_scale_m_s;
                if exponent > 1.0 {
                    return 0.0;
                }
                -(at_rest - at_speed) / speed_scale_m_s * exponent.exp()
            }
        }
    }
}
