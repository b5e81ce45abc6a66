//! A whole rotor, carried from Python.

use crate::errors::RunError;
use crate::plant::{check_time, meters, next_sample_s};
use crate::scene::Scene;
use crate::values::vectors;
use firmware_bench::scene::machine::AnyScene;
use numpy::PyArray2;
use plant_model::machine::{Machine as Rotor, MachineInputs};
use plant_model::{Options, PlantError, V2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::{Bound, PyAny, PyResult, Python, pyclass, pymethods};
use pyo3::types::PyDict;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A change of mode: when \[s\], in which plane, and to which.
type Change = (f64, String, &'static str);

/// A rotor in several planes, from the start of a scene. Positions count from the line of the magnets.
#[pyclass(frozen, module = "ambwhirl")]
pub(crate) struct Machine {
    of: Mutex<State>,
    #[pyo3(get)]
    period_s: f64,
    #[pyo3(get)]
    planes: Vec<String>,
    #[pyo3(get)]
    magnets: usize,
    #[pyo3(get)]
    loads: usize,
}

struct State {
    rotor: Rotor,
    /// Why it cannot be trusted any further.
    broken: Option<PlantError>,
}

impl Machine {
    fn state(&self) -> MutexGuard<'_, State> {
        self.of.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Before the state is taken: what an argument does to become an array is its own affair.
    fn inputs(
        &self,
        commands_n: Option<&Bound<'_, PyAny>>,
        loads_n: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<MachineInputs> {
        let rows = |name: &str, given: Option<&Bound<'_, PyAny>>, rows: usize| match given {
            Some(given) => vectors(name, given, Some(rows)),
            None => Ok(vec![V2::zeros(); rows]),
        };
        Ok(MachineInputs {
            commands_n: rows("commands_n", commands_n, self.magnets)?,
            loads_n: rows("loads_n", loads_n, self.loads)?,
        })
    }

    fn carry(&self, state: &mut State, to_s: f64, inputs: &MachineInputs) -> PyResult<Vec<Change>> {
        let mut changes = Vec::new();
        if state.broken.is_none() {
            let advanced = (state.rotor).advance(to_s, inputs, &mut |plane, now| {
                if let (Some(at), Some(name)) = (now.planes().nth(plane), self.planes.get(plane)) {
                    changes.push((now.t_s, name.clone(), at.mode.name()));
                }
            });
            state.broken = advanced.err();
        }
        match &state.broken {
            None => Ok(changes),
            Some(reason) => Err(RunError::new_err(reason.to_string())),
        }
    }

    fn rows<'py>(
        &self,
        py: Python<'py>,
        of: impl FnOnce(&mut Rotor) -> Vec<V2>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = of(&mut self.state().rotor);
        let rows: Vec<Vec<f64>> = rows.iter().map(|v| vec![v.x, v.y]).collect();
        PyArray2::from_vec2(py, &rows).map_err(|e| PyValueError::new_err(e.to_string()))
    }
}

#[pymethods]
impl Machine {
    #[new]
    fn new(py: Python<'_>, scene: &Scene) -> PyResult<Self> {
        let AnyScene::Machine(scene) = scene.plant(py)? else {
            let text = "scene: has a point mass in one plane; take ambwhirl.Plant";
            return Err(PyValueError::new_err(text));
        };
        let common = scene.common();
        let options = Options {
            rtol: common.rtol,
            method: common.method,
            ..Options::default()
        };
        let rotor = Rotor::new(&scene.machine, &scene.start, options);
        Ok(Self {
            of: Mutex::new(State {
                rotor: rotor.map_err(|error| PyValueError::new_err(error.to_string()))?,
                broken: None,
            }),
            period_s: 1.0 / common.sample_rate_hz,
            planes: scene
                .planes
                .iter()
                .map(|plane| plane.name.clone())
                .collect(),
            magnets: scene.machine.magnets.len(),
            loads: scene.machine.loads_m.len(),
        })
    }

    #[pyo3(signature = (to_s, commands_n=None, loads_n=None))]
    fn advance(
        &self,
        to_s: f64,
        commands_n: Option<&Bound<'_, PyAny>>,
        loads_n: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<Change>> {
        let inputs = self.inputs(commands_n, loads_n)?;
        let mut state = self.state();
        check_time(state.rotor.t_s(), to_s)?;
        self.carry(&mut state, to_s, &inputs)
    }

    #[pyo3(signature = (commands_n=None, loads_n=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        commands_n: Option<&Bound<'py, PyAny>>,
        loads_n: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let inputs = self.inputs(commands_n, loads_n)?;
        {
            let mut state = self.state();
            let to_s = next_sample_s(state.rotor.t_s(), self.period_s);
            self.carry(&mut state, to_s, &inputs)?;
        }
        self.sensed_m(py)
    }

    /// Where the rotor is at the sensors, a row each.
    #[getter]
    fn sensed_m<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let planes = self.planes.len();
        self.rows(py, |rotor| {
            let probes = (0..planes).filter_map(|plane| rotor.probe(plane));
            probes.map(|probe| probe.position).collect()
        })
    }

    /// Where the rotor is in the planes, a row each.
    #[getter]
    fn position_m<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, |rotor| {
            let now = rotor.snapshot();
            now.planes().map(|plane| plane.rotor.position).collect()
        })
    }

    /// Its velocity there.
    #[getter]
    fn velocity_m_s<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, |rotor| {
            let now = rotor.snapshot();
            now.planes().map(|plane| plane.rotor.velocity).collect()
        })
    }

    #[getter]
    fn t_s(&self) -> f64 {
        self.state().rotor.t_s()
    }

    #[getter]
    fn spin_rad_s(&self) -> f64 {
        self.state().rotor.snapshot().spin_rad_s
    }

    #[getter]
    fn modes(&self) -> Vec<&'static str> {
        let now = self.state().rotor.snapshot();
        now.planes().map(|plane| plane.mode.name()).collect()
    }

    /// Contact forces in the planes \[N\].
    #[getter]
    fn normal_force_n(&self) -> Vec<f64> {
        let now = self.state().rotor.snapshot();
        now.planes().map(|plane| plane.normal_force_n).collect()
    }

    /// Extremes and sums of each plane so far.
    fn meters<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let of: Vec<_> = self.state().rotor.meters().to_vec();
        of.iter().map(|of| meters(py, of)).collect()
    }

    /// Energy from nowhere over energy turned over.
    #[getter]
    fn energy_residual(&self) -> f64 {
        self.state().rotor.audit().residual()
    }
}
