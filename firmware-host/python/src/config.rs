//! The supervisor's parameters.

use crate::errors::ConfigError;
use crate::values::shown;
use pyo3::exceptions::{PyAttributeError, PyTypeError};
use pyo3::prelude::{Bound, PyAny, PyAnyMethods, PyResult, Python, pyclass, pyfunction, pymethods};
use pyo3::types::{PyDict, PyDictMethods};
use supervisor::{Bearing, Config as Parameters, DefaultRule, PARAMETERS};

/// A configuration of the supervisor: every parameter is in its range. Numbers are single precision, as in firmware.
#[pyclass(frozen, eq, module = "ambwhirl")]
#[derive(Clone, PartialEq)]
pub(crate) struct Config {
    pub(crate) parameters: Parameters,
}

fn number(key: &str, given: &Bound<'_, PyAny>) -> PyResult<f32> {
    let number: f64 = given.extract().map_err(|_| {
        PyTypeError::new_err(format!("{key}: expected a number, got {}", shown(given)))
    })?;
    Ok(number as f32)
}

impl Config {
    fn valid(parameters: Parameters) -> PyResult<Self> {
        match parameters.validate() {
            Ok(()) => Ok(Self { parameters }),
            Err(error) => Err(ConfigError::new_err(error.to_string())),
        }
    }

    /// With other values of some keys.
    fn with(parameters: &Parameters, keys: &Bound<'_, PyDict>) -> PyResult<Parameters> {
        let mut values = parameters.values();
        for (key, given) in keys.iter() {
            let key: String = key.extract()?;
            let row = PARAMETERS.iter().position(|row| row.name == key);
            let Some(value) = row.and_then(|row| values.get_mut(row)) else {
                return Err(PyTypeError::new_err(format!(
                    "{key}: is no parameter of the supervisor; ambwhirl.parameters() lists them"
                )));
            };
            *value = number(&key, &given)?;
        }
        Ok(Parameters::from_values(values))
    }
}

#[pymethods]
impl Config {
    #[new]
    #[pyo3(signature = (**keys))]
    fn new(py: Python<'_>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let none = PyDict::new(py);
        let keys = keys.unwrap_or(&none);
        for row in PARAMETERS {
            if !keys.contains(row.name)? {
                return Err(PyTypeError::new_err(format!(
                    "{}: is missing; Config.for_bearing makes a configuration from nine numbers",
                    row.name
                )));
            }
        }
        Self::valid(Self::with(&Parameters::example(), keys)?)
    }

    #[staticmethod]
    #[pyo3(signature = (*, sample_period_s, mass_kg, stiffness_n_m, clearance_m, force_max_n, amplifier_lag_s, friction_coefficient, contact_stiffness_n_m, sensor_noise_m, **keys))]
    #[allow(
        clippy::too_many_arguments,
        reason = "keyword arguments of Python, each named where it is called"
    )]
    fn for_bearing(
        py: Python<'_>,
        sample_period_s: f32,
        mass_kg: f32,
        stiffness_n_m: f32,
        clearance_m: f32,
        force_max_n: f32,
        amplifier_lag_s: f32,
        friction_coefficient: f32,
        contact_stiffness_n_m: f32,
        sensor_noise_m: f32,
        keys: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let parameters = Parameters::for_bearing(&Bearing {
            sample_period_s,
            mass_kg,
            stiffness_n_m,
            clearance_m,
            force_max_n,
            amplifier_lag_s,
            friction_coefficient,
            contact_stiffness_n_m,
            sensor_noise_m,
        });
        let none = PyDict::new(py);
        Self::valid(Self::with(&parameters, keys.unwrap_or(&none))?)
    }

    #[staticmethod]
    fn example() -> Self {
        Self {
            parameters: Parameters::example(),
        }
    }

    #[pyo3(signature = (**keys))]
    fn replace(&self, py: Python<'_>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let none = PyDict::new(py);
        Self::valid(Self::with(&self.parameters, keys.unwrap_or(&none))?)
    }

    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (row, value) in PARAMETERS.iter().zip(self.parameters.values()) {
            dict.set_item(row.name, f64::from(value))?;
        }
        Ok(dict)
    }

    fn __getattr__(&self, key: &str) -> PyResult<f64> {
        let mut all = PARAMETERS.iter().zip(self.parameters.values());
        match all.find(|(row, _)| row.name == key) {
            Some((_, value)) => Ok(f64::from(value)),
            None => Err(PyAttributeError::new_err(format!(
                "{key}: is no parameter of the supervisor"
            ))),
        }
    }

    fn __repr__(&self) -> String {
        let all = PARAMETERS.iter().zip(self.parameters.values());
        let all: Vec<String> = all
            .map(|(row, value)| format!("{}={value:?}", row.name))
            .collect();
        format!("Config({})", all.join(", "))
    }
}

/// The table of the parameters: a dictionary a row.
#[pyfunction]
pub(crate) fn parameters(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let row = |row: &supervisor::Parameter| {
        let dict = PyDict::new(py);
        dict.set_item("name", row.name)?;
        dict.set_item("unit", row.unit)?;
        dict.set_item("low", f64::from(row.low))?;
        dict.set_item("high", f64::from(row.high))?;
        dict.set_item("text", row.text)?;
        dict.set_item(
            "default",
            match row.default {
                DefaultRule::Given => "given".to_owned(),
                DefaultRule::Constant(value, why) => format!("{value}: {why}"),
                DefaultRule::Derived(how) => how.to_owned(),
            },
        )?;
        Ok(dict)
    };
    PARAMETERS.iter().map(row).collect()
}
