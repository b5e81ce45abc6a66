//! What may change of a rotor during a run.

use super::{Rotor, Unbalance};
use crate::params::{FINITE, NOT_NEGATIVE, ParamError, check};

/// Parameters that take other values from an instant on; `None` stays as it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Change {
    /// New eccentricity of the centre of mass \[m\], ≥ 0.
    pub eccentricity_m: Option<f64>,
    /// An unbalance that comes on top of what there is, at the angle that the rotor has then: a lost blade.
    pub unbalance: Option<Unbalance>,
    /// New coefficient of sliding friction in all planes, the same at every speed, ≥ 0.
    pub friction_coefficient: Option<f64>,
    /// New drive torque \[N m\]; needs a free spin.
    pub drive_torque_n_m: Option<f64>,
}

impl Change {
    /// Checks every value against its range, and the place of an unbalance against the rotor.
    ///
    /// # Errors
    /// The first that is out of range.
    pub fn validate(&self, rotor: &Rotor) -> Result<(), ParamError> {
        if let Some(unbalance) = &self.unbalance {
            unbalance.validate(rotor, "unbalance")?;
        }
        let eccentricity_m = self.eccentricity_m.unwrap_or_default();
        let field = "rotor.eccentricity_m";
        check(eccentricity_m >= 0.0, field, eccentricity_m, NOT_NEGATIVE)?;
        rotor.has_centre(eccentricity_m)?;
        let friction = self.friction_coefficient.unwrap_or_default();
        let field = "friction.coefficient";
        check(friction >= 0.0, field, friction, NOT_NEGATIVE)?;
        let torque = self.drive_torque_n_m.unwrap_or_default();
        check(true, "spin.drive_torque_n_m", torque, FINITE)
    }
}
