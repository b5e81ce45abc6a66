//! A rotor as one of its planes feels it in an impact: a point mass on a spring.

use super::params::{MachineParams, RigidRotor};

/// A point mass that moves as the plane of a rigid rotor does when it is struck there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointMass {
    /// 1/(1/m + z²/I_t) \[kg\], eq. (6.4).
    pub mass_kg: f64,
    /// Stiffness of the supports against that motion, the mean of x and y \[N/m\].
    pub stiffness_n_m: f64,
    /// Damping of the supports against that motion, likewise \[N s/m\].
    pub damping_n_s_m: f64,
}

impl RigidRotor {
    /// Mobility between two places \[1/kg\], eq. (6.4): velocity of one by an impulse on the other.
    pub fn mobility(&self, a_m: f64, b_m: f64) -> f64 {
        1.0 / self.mass_kg + a_m * b_m / self.transverse_inertia_kg_m2
    }

    /// How far a place moves when the rotor is struck at `struck_m`, over how far it moves there; negative beyond the centre
    /// of percussion.
    pub fn lever(&self, place_m: f64, struck_m: f64) -> f64 {
        self.mobility(place_m, struck_m) / self.mobility(struck_m, struck_m)
    }
}

impl MachineParams {
    /// The rotor, taken as rigid, as an impact at a place finds it.
    pub fn point_mass(&self, position_m: f64) -> PointMass {
        let rigid = self.rotor.rigid();
        let mut point = PointMass {
            mass_kg: match rigid.tilts() {
                true => 1.0 / rigid.mobility(position_m, position_m),
                false => rigid.mass_kg,
            },
            stiffness_n_m: 0.0,
            damping_n_s_m: 0.0,
        };
        for support in &self.supports {
            let square = rigid.lever(support.position_m, position_m).powi(2);
            point.stiffness_n_m += square * support.stiffness_n_m.mean();
            point.damping_n_s_m += square * support.damping_n_s_m.mean();
        }
        point
    }
}
