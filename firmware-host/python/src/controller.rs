//! Levitation controllers in Python, in this process.

use crate::values::shown;
use firmware_bench::device::external::{self, Caller, Make, Step};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::{Bound, Py, PyAny, PyAnyMethods, PyErr, PyResult, Python, pyclass, pymethods};
use pyo3::types::PyList;
use std::sync::{Arc, Mutex, PoisonError};

/// What a controller is told before the first sample.
#[pyclass(frozen, get_all, module = "ambwhirl")]
#[derive(Debug)]
pub(crate) struct Setup {
    period_s: f64,
    sensors: u32,
    magnets: usize,
    magnet_plane: Vec<u32>,
    force_max_n: Vec<f64>,
    parameters: Vec<f64>,
}

/// What is known at a control sample.
#[pyclass(frozen, get_all, module = "ambwhirl")]
#[derive(Debug)]
pub(crate) struct Sample {
    t_s: f64,
    spin_rad_s: f64,
    hold: bool,
    sequence: Py<PyList>,
    position_m: Py<PyList>,
}

#[pymethods]
impl Setup {
    fn __repr__(&self) -> String {
        format!("{self:?}")
    }
}

#[pymethods]
impl Sample {
    fn __repr__(&self) -> String {
        let Self {
            t_s, position_m, ..
        } = self;
        format!("<ambwhirl.Sample at {t_s} s: {position_m}>")
    }
}

/// What a controller has raised, on its way around the bench.
#[derive(Debug, Clone, Default)]
pub(crate) struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// What was raised, if anything was.
    pub(crate) fn take(&self) -> Option<PyErr> {
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        held.take()
    }

    /// Keeps it, and says that there is something.
    fn keep(&self, error: PyErr) -> String {
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        *held = Some(error);
        "raised an exception".to_owned()
    }
}

/// A function of a [`Setup`] that returns a controller.
struct Maker {
    make: Py<PyAny>,
    raised: Raised,
}

/// Controllers that a function makes, and where to find what they raise.
pub(crate) fn caller(make: &Bound<'_, PyAny>) -> PyResult<(Caller, Raised)> {
    if !make.is_callable() {
        return Err(PyTypeError::new_err(format!(
            "controller: {} is not callable; give a function of the controller's setup that returns a controller, as a class does",
            shown(make)
        )));
    }
    let name = make.getattr("__name__").and_then(|name| name.extract());
    let raised = Raised::default();
    let maker = Maker {
        make: make.clone().unbind(),
        raised: raised.clone(),
    };
    let name: String = name.unwrap_or_else(|_| shown(make));
    Ok((Caller::new(name, maker), raised))
}

/// A controller at work.
#[derive(Debug)]
struct Controller {
    step: Py<PyAny>,
    close: Option<Py<PyAny>>,
    forces: usize,
    raised: Raised,
}

impl Make for Maker {
    fn make(&self, setup: &external::Setup) -> Result<Box<dyn Step>, String> {
        let made = Python::attach(|py| self.made(py, setup));
        let controller = made.map_err(|error| self.raised.keep(error))?;
        Ok(Box::new(controller))
    }
}

impl Maker {
    fn made(&self, py: Python<'_>, setup: &external::Setup) -> PyResult<Controller> {
        let given = Setup {
            period_s: setup.period_s,
            sensors: setup.sensors,
            magnets: setup.magnet_plane.len(),
            magnet_plane: setup.magnet_plane.clone(),
            force_max_n: setup.force_max_n.clone(),
            parameters: setup.parameters.clone(),
        };
        let made = self.make.bind(py).call1((given,))?;
        let callable = |name: &str| {
            let found = made.getattr(name).ok();
            found.filter(PyAnyMethods::is_callable).map(Bound::unbind)
        };
        let itself = || made.is_callable().then(|| made.clone().unbind());
        let step = callable("step").or_else(itself).ok_or_else(|| {
            PyTypeError::new_err(format!(
                "controller: it returned {}, which has no method step(sample) and is no function of a sample",
                shown(&made)
            ))
        })?;
        Ok(Controller {
            step,
            close: callable("close"),
            forces: setup.forces(),
            raised: self.raised.clone(),
        })
    }
}

impl Step for Controller {
    fn step(&mut self, question: &external::Question) -> Result<Vec<f64>, String> {
        Python::attach(|py| {
            let returned = asked(py, question)
                .and_then(|sample| self.step.bind(py).call1((sample,)))
                .map_err(|error| self.raised.keep(error))?;
            let wrong = |_: PyErr| {
                let (shown, forces) = (shown(&returned), self.forces);
                format!("step returned {shown}, expected a list of {forces} forces")
            };
            let forces_n: Vec<f64> = returned.extract().map_err(wrong)?;
            match forces_n.len() == self.forces {
                true => Ok(forces_n),
                false => Err(format!(
                    "step returned {} forces, expected {}: x and y of each magnet",
                    forces_n.len(),
                    self.forces
                )),
            }
        })
    }

    fn close(&mut self) -> Result<(), String> {
        let Some(close) = &self.close else {
            return Ok(());
        };
        let closed = Python::attach(|py| close.call0(py).map(drop));
        closed.map_err(|error| self.raised.keep(error))
    }
}

fn asked(py: Python<'_>, question: &external::Question) -> PyResult<Sample> {
    Ok(Sample {
        t_s: question.t_s,
        spin_rad_s: question.spin_rad_s,
        hold: question.hold,
        sequence: PyList::new(py, &question.sequence)?.unbind(),
        position_m: PyList::new(py, &question.position_m)?.unbind(),
    })
}
