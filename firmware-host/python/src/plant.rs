//! The plant of one plane, carried from Python.

use crate::errors::RunError;
use crate::scene::Scene;
use crate::values::{pair_array, vector, vectors};
use firmware_bench::scene::machine::AnyScene;
use numpy::PyArray2;
use plant_model::{Inputs, Meters, Options, Plant as Plane, PlantError, Snapshot, V2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::{Bound, PyAny, PyResult, Python, pyclass, pymethods};
use pyo3::types::{PyDict, PyDictMethods};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A change of mode: when \[s\], and to which.
type Change = (f64, &'static str);

/// A point mass in one plane, from the start of a scene. Positions count from the centre of the retainer bearing.
#[pyclass(frozen, module = "ambwhirl")]
pub(crate) struct Plant {
    of: Mutex<State>,
    #[pyo3(get)]
    period_s: f64,
    /// Weight and what else always acts \[N\].
    constant_n: V2,
    magnet: bool,
}

struct State {
    plane: Plane,
    /// Why it cannot be trusted any further.
    broken: Option<PlantError>,
}

impl State {
    fn advance(&mut self, to_s: f64, inputs: &Inputs) -> PyResult<Vec<Change>> {
        let mut changes = Vec::new();
        if self.broken.is_none() {
            let advanced = (self.plane).advance(to_s, inputs, &mut |now| {
                changes.push((now.t_s, now.mode.name()));
            });
            self.broken = advanced.err();
        }
        match &self.broken {
            None => Ok(changes),
            Some(reason) => Err(RunError::new_err(reason.to_string())),
        }
    }
}

/// The end of the control period that begins at a time, by whole periods as a closed loop counts them.
pub(crate) fn next_sample_s(t_s: f64, period_s: f64) -> f64 {
    ((t_s / period_s).round() + 1.0) * period_s
}

/// Whether a plant can be carried to a time.
pub(crate) fn check_time(t_s: f64, to_s: f64) -> PyResult<()> {
    match to_s.is_finite() && to_s >= t_s {
        true => Ok(()),
        false => Err(PyValueError::new_err(format!(
            "to_s: is {to_s}, expected a time from now on, {t_s} s"
        ))),
    }
}

impl Plant {
    fn state(&self) -> MutexGuard<'_, State> {
        self.of.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn snapshot(&self) -> Snapshot {
        self.state().plane.snapshot()
    }

    fn inputs(
        &self,
        command_n: Option<&Bound<'_, PyAny>>,
        external_n: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Inputs> {
        let given = |name: &str, given: Option<&Bound<'_, PyAny>>| {
            given.map_or_else(|| Ok(V2::zeros()), |given| vector(name, given))
        };
        let command_n = given("command_n", command_n)?;
        if !self.magnet && command_n != V2::zeros() {
            let text = "command_n: the scene has no magnet to command; add a [magnet]";
            return Err(PyValueError::new_err(text));
        }
        Ok(Inputs {
            command_n,
            external_n: self.constant_n + given("external_n", external_n)?,
        })
    }
}

#[pymethods]
impl Plant {
    #[new]
    fn new(py: Python<'_>, scene: &Scene) -> PyResult<Self> {
        let AnyScene::Plane(scene) = scene.plant(py)? else {
            let text = "scene: is of a whole rotor, in several planes; take ambwhirl.Machine";
            return Err(PyValueError::new_err(text));
        };
        let options = Options {
            rtol: scene.rtol,
            method: scene.method,
            ..Options::default()
        };
        let built = scene.build(options);
        Ok(Self {
            of: Mutex::new(State {
                plane: built.map_err(|error| PyValueError::new_err(error.to_string()))?,
                broken: None,
            }),
            period_s: 1.0 / scene.sample_rate_hz,
            constant_n: scene.constant_n(),
            magnet: scene.plant.magnet.is_some(),
        })
    }

    #[pyo3(signature = (to_s, command_n=None, external_n=None))]
    fn advance(
        &self,
        to_s: f64,
        command_n: Option<&Bound<'_, PyAny>>,
        external_n: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<Change>> {
        let inputs = self.inputs(command_n, external_n)?;
        let mut state = self.state();
        check_time(state.plane.snapshot().t_s, to_s)?;
        state.advance(to_s, &inputs)
    }

    #[pyo3(signature = (command_n=None, external_n=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        command_n: Option<&Bound<'py, PyAny>>,
        external_n: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let inputs = self.inputs(command_n, external_n)?;
        let mut state = self.state();
        let to_s = next_sample_s(state.plane.snapshot().t_s, self.period_s);
        state.advance(to_s, &inputs)?;
        let position_m = state.plane.snapshot().position_m;
        Ok(pair_array(py, position_m.into()).into_any())
    }

    /// One step for each row of commands: positions at their ends.
    #[pyo3(signature = (commands_n, external_n=None))]
    fn steps<'py>(
        &self,
        py: Python<'py>,
        commands_n: &Bound<'py, PyAny>,
        external_n: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let commands_n = vectors("commands_n", commands_n, None)?;
        let inputs = self.inputs(None, external_n)?;
        let mut positions_m = Vec::with_capacity(commands_n.len());
        let mut state = self.state();
        for command_n in commands_n {
            let inputs = Inputs {
                command_n,
                ..inputs
            };
            let to_s = next_sample_s(state.plane.snapshot().t_s, self.period_s);
            state.advance(to_s, &inputs)?;
            let position_m = state.plane.snapshot().position_m;
            positions_m.push(vec![position_m.x, position_m.y]);
        }
        if positions_m.is_empty() {
            return Ok(PyArray2::zeros(py, [0, 2], false));
        }
        PyArray2::from_vec2(py, &positions_m).map_err(|e| PyValueError::new_err(e.to_string()))
    }

    #[getter]
    fn t_s(&self) -> f64 {
        self.snapshot().t_s
    }

    #[getter]
    fn mode(&self) -> &'static str {
        self.snapshot().mode.name()
    }

    #[getter]
    fn position_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        pair_array(py, self.snapshot().position_m.into()).into_any()
    }

    #[getter]
    fn velocity_m_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        pair_array(py, self.snapshot().velocity_m_s.into()).into_any()
    }

    /// Everything that can be read off now.
    fn read<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let now = self.snapshot();
        let dict = PyDict::new(py);
        let vectors = [
            ("position_m", now.position_m),
            ("velocity_m_s", now.velocity_m_s),
            ("inner_ring_m", now.inner_ring.position),
            ("inner_ring_m_s", now.inner_ring.velocity),
            ("outer_ring_m", now.outer_ring.position),
            ("outer_ring_m_s", now.outer_ring.velocity),
            ("delivered_n", now.delivered_n),
        ];
        for (name, vector) in vectors {
            dict.set_item(name, pair_array(py, vector.into()))?;
        }
        let numbers = [
            ("t_s", now.t_s),
            ("spin_rad_s", now.spin_rad_s),
            ("race_spin_rad_s", now.race_spin_rad_s),
            ("penetration_m", now.penetration_m),
            ("normal_force_n", now.normal_force_n),
            ("sliding_force_n", now.sliding_force_n),
            ("rolling_force_n", now.rolling_force_n),
            (
                "contact_tangential_speed_m_s",
                now.contact_tangential_speed_m_s,
            ),
            ("sliding_speed_m_s", now.sliding_speed_m_s),
            ("whirl_angle_rad", now.whirl_angle_rad),
        ];
        for (name, number) in numbers {
            dict.set_item(name, number)?;
        }
        dict.set_item("mode", now.mode.name())?;
        Ok(dict)
    }

    /// Extremes and sums so far.
    fn meters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        meters(py, &self.state().plane.meters())
    }

    /// Energy from nowhere over energy turned over.
    #[getter]
    fn energy_residual(&self) -> f64 {
        self.state().plane.audit().residual()
    }
}

/// Extremes and sums of a plane.
pub(crate) fn meters<'py>(py: Python<'py>, of: &Meters) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("impacts", of.impacts)?;
    dict.set_item("hard_impacts", of.hard_impacts)?;
    let numbers = [
        ("contact_time_s", of.contact_time_s),
        ("peak_impact_speed_m_s", of.peak_impact_speed_m_s),
        ("peak_penetration_m", of.peak_penetration_m),
        ("peak_contact_force_n", of.peak_contact_force_n),
        ("peak_friction_torque_n_m", of.peak_friction_torque_n_m),
        ("peak_backward_speed_m_s", of.peak_backward_speed_m_s),
        ("whirl_angle_rad", of.whirl_angle_rad),
    ];
    for (name, number) in numbers {
        dict.set_item(name, number)?;
    }
    Ok(dict)
}
