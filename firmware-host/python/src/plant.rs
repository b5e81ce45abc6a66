//! The plant of a scene, step by step.

use crate::errors::RunError;
use crate::scene::Scene;
use crate::values::{pair_array, stacks, vectors};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use plant_model::machine::params::MachineParams;
use plant_model::machine::{Machine, MachineInputs, PlaneSnapshot};
use plant_model::{Meters, Options, PlantError, V2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::{Bound, PyAny, PyResult, Python, pyclass, pymethods};
use pyo3::types::{PyDict, PyDictMethods};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A change of mode: when \[s\], in which plane, and to which.
type Change = (f64, String, &'static str);

/// The rotor of a scene from its start. Positions count from the line of the magnets; a row for each magnet, load or plane.
#[pyclass(frozen, module = "ambwhirl")]
pub(crate) struct Plant {
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
    rotor: Machine,
    /// Why it cannot be trusted any further.
    broken: Option<PlantError>,
}

impl Plant {
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
            Some(given) => vectors(name, given, rows),
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
        of: impl FnOnce(&mut Machine) -> Vec<V2>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = of(&mut self.state().rotor);
        let rows: Vec<Vec<f64>> = rows.iter().map(|v| vec![v.x, v.y]).collect();
        PyArray2::from_vec2(py, &rows).map_err(|e| PyValueError::new_err(e.to_string()))
    }
}

#[pymethods]
impl Plant {
    #[new]
    fn new(py: Python<'_>, scene: &Scene) -> PyResult<Self> {
        let scene = scene.plant(py)?;
        let options = Options {
            rtol: scene.rtol,
            method: scene.method,
            ..Options::default()
        };
        // As a closed loop has them, to the last bit.
        let params = MachineParams {
            loads_m: scene.load_places_m(),
            ..scene.machine.clone()
        };
        let rotor = Machine::new(&params, &scene.start, options);
        Ok(Self {
            of: Mutex::new(State {
                rotor: rotor.map_err(|error| PyValueError::new_err(error.to_string()))?,
                broken: None,
            }),
            period_s: 1.0 / scene.sample_rate_hz,
            planes: scene
                .planes
                .iter()
                .map(|plane| plane.name.clone())
                .collect(),
            magnets: params.magnets.len(),
            loads: params.loads_m.len(),
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

    /// One step for each block of commands: positions in the planes at their ends.
    #[pyo3(signature = (commands_n, loads_n=None))]
    fn steps<'py>(
        &self,
        py: Python<'py>,
        commands_n: &Bound<'py, PyAny>,
        loads_n: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let all = stacks("commands_n", commands_n, self.magnets)?;
        let mut inputs = self.inputs(None, loads_n)?;
        let (n, planes) = (all.len(), self.planes.len());
        let mut positions_m = Vec::with_capacity(2 * n * planes);
        let mut state = self.state();
        for commands_n in all {
            inputs.commands_n = commands_n;
            let to_s = next_sample_s(state.rotor.t_s(), self.period_s);
            self.carry(&mut state, to_s, &inputs)?;
            let now = state.rotor.snapshot();
            positions_m.extend(now.planes().flat_map(|plane| {
                let position_m = plane.rotor.position;
                [position_m.x, position_m.y]
            }));
        }
        PyArray1::from_vec(py, positions_m).reshape([n, planes, 2])
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

    /// Everything that can be read off now, of each plane.
    fn read<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let now = self.state().rotor.snapshot();
        let of_plane = |(plane, name): (&PlaneSnapshot, &String)| {
            let dict = PyDict::new(py);
            let vectors = [
                ("position_m", plane.rotor.position),
                ("velocity_m_s", plane.rotor.velocity),
                ("inner_ring_m", plane.ring.position),
                ("inner_ring_m_s", plane.ring.velocity),
                ("outer_ring_m", plane.outer_ring.position),
                ("outer_ring_m_s", plane.outer_ring.velocity),
            ];
            for (name, vector) in vectors {
                dict.set_item(name, pair_array(py, vector.into()))?;
            }
            let numbers = [
                ("race_spin_rad_s", plane.race_spin_rad_s),
                ("penetration_m", plane.penetration_m),
                ("normal_force_n", plane.normal_force_n),
                ("sliding_force_n", plane.sliding_force_n),
                ("rolling_force_n", plane.rolling_force_n),
                ("contact_tangential_speed_m_s", plane.whirl_speed_m_s),
                ("sliding_speed_m_s", plane.sliding_speed_m_s),
                ("whirl_angle_rad", plane.whirl_angle_rad),
            ];
            for (name, number) in numbers {
                dict.set_item(name, number)?;
            }
            dict.set_item("plane", name)?;
            dict.set_item("mode", plane.mode.name())?;
            Ok(dict)
        };
        now.planes().zip(&self.planes).map(of_plane).collect()
    }

    /// Forces that the magnets deliver \[N\], a row each.
    #[getter]
    fn delivered_n<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, |rotor| rotor.snapshot().delivered_n().collect())
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

/// The end of the control period that begins at a time, by whole periods as a closed loop counts them.
fn next_sample_s(t_s: f64, period_s: f64) -> f64 {
    ((t_s / period_s).round() + 1.0) * period_s
}

/// Whether a plant can be carried to a time.
fn check_time(t_s: f64, to_s: f64) -> PyResult<()> {
    match to_s.is_finite() && to_s >= t_s {
        true => Ok(()),
        false => Err(PyValueError::new_err(format!(
            "to_s: is {to_s}, expected a time from now on, {t_s} s"
        ))),
    }
}

/// Extremes and sums of a plane.
fn meters<'py>(py: Python<'py>, of: &Meters) -> PyResult<Bound<'py, PyDict>> {
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
