//! By which method a machine is integrated.

use super::{MachineError, MachineMagnet, MachineParams, MachinePlane};
use crate::integrate::Method;
use crate::params::SlidingFriction;

impl MachinePlane {
    /// What has no power series here: field, value and what would have one.
    fn without_series(&self) -> Option<(&'static str, f64, &'static str)> {
        if let SlidingFriction::Falling { at_speed, .. } = self.friction.sliding {
            let rule =
                "sliding friction that is the same at every speed, or another method than series";
            return Some(("friction.coefficient_at_speed", at_speed, rule));
        }
        if self.contact.law.linear().is_none() {
            let rule = "a linear contact law, or another method than series";
            return Some(("contact.stiffness_n_mn", self.contact.stiffness_n_m(), rule));
        }
        let rule = "no drag by load, or another method than series";
        (self.load_drag).map(|drag| ("load_drag.arm_m", drag.arm_m, rule))
    }
}

impl MachineParams {
    /// What a method comes to. Friction that falls with speed, contact that is not linear, drag by load, magnets with poles and
    /// amplifiers of second order have no series here.
    ///
    /// # Errors
    /// A method that does not go with what is there, by what does not go.
    pub fn method(&self, method: Method) -> Result<Method, MachineError> {
        let refused = |field: String, value: f64, expected: &'static str| {
            Err(MachineError {
                field,
                value,
                expected,
            })
        };
        let of_series = || {
            let planes = self.planes.iter().enumerate();
            let mut none = planes.filter_map(|(p, plane)| Some((p, plane.without_series()?)));
            if let Some((p, (name, value, rule))) = none.next() {
                return refused(format!("planes[{p}].{name}"), value, rule);
            }
            let moved = |m: &MachineMagnet| m.poles.is_some() || m.lag_damping_ratio.is_some();
            if self.magnets.iter().any(moved) {
                let rule = "auto or explicit: magnets with poles and amplifiers of second order have no power series here";
                return refused("run.method".into(), f64::NAN, rule);
            }
            Ok(Method::Series)
        };
        match method {
            Method::Auto => Ok(of_series().unwrap_or(Method::Explicit)),
            Method::Series => of_series(),
            Method::Explicit => Ok(method),
            Method::Stiff => refused("run.method".into(), f64::NAN, "auto, series or explicit"),
        }
    }
}
