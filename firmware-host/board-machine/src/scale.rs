//! From counts of the converter to metres, from newtons to amperes: all that is of the units of this machine.

/// The sensors measure this far to each side \[m\].
pub const SENSOR_RANGE_M: f32 = 4e-4;
/// Readings at the centre of the retainer bearing, as shares of the converter's range: from calibration, with the rotor pushed
/// against the retainer bearing all round.
const CENTRE: [f32; 2] = [0.5, 0.5];

/// Current of an amplifier at full scale of its set-point \[A\].
pub const CURRENT_FULL_SCALE_A: f32 = 10.0;
/// Force on the rotor over current \[N/A\], at the bias and in the centre.
const FORCE_PER_CURRENT_N_A: f32 = 200.0;

/// Position \[m\] from readings of a converter with so many steps.
pub fn position_m(readings: [u16; 2], steps: u32) -> [f32; 2] {
    let range_m = 2.0 * SENSOR_RANGE_M;
    let along = |axis: usize| (f32::from(readings[axis]) / steps as f32 - CENTRE[axis]) * range_m;
    [along(0), along(1)]
}

/// Two magnets an axis, which pull against each other about a bias: amplifiers of one direction.
pub enum Magnets {}

impl Magnets {
    /// Current of all of them without force \[A\].
    pub const BIAS_A: f32 = 5.0;
    /// Force along an axis at which one of its two magnets has no current left \[N\]: the range in which it is linear.
    pub const FORCE_MAX_N: f32 = FORCE_PER_CURRENT_N_A * Self::BIAS_A;

    /// Currents for a force \[A\]: +x, −x, +y, −y.
    pub fn currents_a([x_n, y_n]: [f32; 2]) -> [f32; 4] {
        let [x, y] = [x_n / FORCE_PER_CURRENT_N_A, y_n / FORCE_PER_CURRENT_N_A];
        [x, -x, y, -y].map(|a| (Self::BIAS_A + a).clamp(0.0, CURRENT_FULL_SCALE_A))
    }
}

/// Currents for a force \[A\], along x and y: amplifiers of two directions, which share the current out to their magnets and have
/// the bias themselves.
pub fn signed_currents_a(force_n: [f32; 2]) -> [f32; 2] {
    force_n.map(|n| {
        let current_a = n / FORCE_PER_CURRENT_N_A;
        current_a.clamp(-CURRENT_FULL_SCALE_A, CURRENT_FULL_SCALE_A)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_the_range_is_the_centre() {
        assert_eq!(position_m([2048, 2048], 4096), [0.0, 0.0]);
        assert_eq!(position_m([0, 0x8000], 0x1_0000), [-SENSOR_RANGE_M, 0.0]);
    }

    #[test]
    fn magnets_pull_along_the_force_about_their_bias() {
        assert_eq!(Magnets::currents_a([0.0, 0.0]), [5.0; 4]);
        assert_eq!(Magnets::currents_a([400.0, -200.0]), [7.0, 3.0, 4.0, 6.0]);
        assert_eq!(Magnets::currents_a([3000.0, 0.0]), [10.0, 0.0, 5.0, 5.0]);
        assert_eq!(signed_currents_a([400.0, -1e9]), [2.0, -10.0]);
    }
}
