//! By which method a machine is integrated.

use super::{MachineParams, MachinePlane};
use crate::integrate::Method;
use crate::params::ParamError;
use crate::params::StatorParams;

impl MachinePlane {
    /// What has no power series here: field, value and what would have one.
    fn without_series(&self) -> Option<(&'static str, f64, &'static str)> {
        if self.contact.law.linear().is_none() {
            let rule = "a linear contact law, or another method than series";
            return Some(("contact.stiffness_n_mn", self.contact.stiffness_n_m(), rule));
        }
        if let StatorParams::RigidEllipse(bore) = &self.stator {
            let rule = "a round bore, or another method than series";
            return Some(("stator.ellipticity", bore.ellipticity, rule));
        }
        let rule = "no drag by load, or another method than series";
        (self.load_drag).map(|drag| ("load_drag.arm_m", drag.arm_m, rule))
    }
}

impl MachineParams {
    /// Whether flight has a power series, whatever contact has: without poles and amplifiers of second order.
    pub(crate) fn flies(&self) -> bool {
        (self.magnets.iter()).all(|m| m.poles.is_none() && m.lag_damping_ratio.is_none())
    }

    /// What a method comes to. Contact that is not linear, a bore out of round, drag by load, magnets with poles and amplifiers of
    /// second order have no series here.
    ///
    /// # Errors
    /// A method that does not go with what is there, by what does not go.
    pub fn method(&self, method: Method) -> Result<Method, ParamError> {
        let refused = |field: String, value: f64, expected: &'static str| {
            Err(ParamError {
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
            if !self.flies() {
                let rule = "auto or collocation: magnets with poles and amplifiers of second order have no power series here";
                return refused("run.method".into(), f64::NAN, rule);
            }
            Ok(Method::Series)
        };
        match method {
            Method::Auto => Ok(of_series().unwrap_or(Method::Collocation)),
            Method::Series => of_series(),
            Method::Collocation => Ok(method),
        }
    }
}
