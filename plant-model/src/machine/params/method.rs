//! By which method a machine is integrated.

use super::{MachineError, MachineParams, MachinePlane};
use crate::integrate::Method;
use crate::params::SlidingFriction;

impl MachineParams {
    /// What a method comes to. Friction that falls with speed and magnets with poles have no series here.
    ///
    /// # Errors
    /// A method that does not go with what is there, by what does not go.
    pub fn method(&self, method: Method) -> Result<Method, MachineError> {
        if self.magnets.iter().any(|magnet| magnet.poles.is_some()) {
            return match method {
                Method::Auto | Method::Explicit => Ok(Method::Explicit),
                Method::Series | Method::Stiff => Err(MachineError {
                    field: "run.method".into(),
                    value: f64::NAN,
                    expected: "auto or explicit: magnets with poles have no power series here",
                }),
            };
        }
        let falls = |plane: &MachinePlane| {
            matches!(plane.friction.sliding, SlidingFriction::Falling { .. })
        };
        let falling = self.planes.iter().position(falls);
        match (method, falling) {
            (Method::Auto, None) => Ok(Method::Series),
            (Method::Auto, Some(_)) => Ok(Method::Explicit),
            (Method::Series, Some(p)) => Err(MachineError {
                field: format!("planes[{p}].friction.coefficient_at_speed"),
                value: (self.planes[p].friction.sliding).coefficient(f64::INFINITY),
                expected: "sliding friction that is the same at every speed, or another method than series",
            }),
            (Method::Stiff, _) => Err(MachineError {
                field: "run.method".into(),
                value: f64::NAN,
                expected: "auto, series or explicit",
            }),
            (method, _) => Ok(method),
        }
    }
}
