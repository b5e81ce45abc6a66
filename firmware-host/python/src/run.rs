//! Closed loops on scenes.

use crate::controller::{Raised, caller};
use crate::errors::{of_run, of_scene};
use crate::scene::Scene;
use crate::table::columns;
use crate::values::python;
use firmware_bench::run::closed_loop::{
    Accuracy, PlaneEnded, Recorders, RunError, fits_in_memory, record,
};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::supervision::{Supervision, SupervisionCount};
use firmware_bench::run::trace::{AxisRow, Recorder, TraceRow};
use firmware_bench::run::trace_columns::Columns;
use firmware_bench::run::trace_table::TraceTable;
use firmware_bench::scene::Scene as Resolved;
use firmware_bench::scene::policy_kind::PolicyKind;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::{Bound, PyAny, PyAnyMethods, PyErr, PyResult, Python, pyfunction};
use pyo3::types::{PyBytes, PyDict, PyDictMethods};
use std::ffi::CString;

/// Who listens to a plane.
struct Listener {
    table: Option<TraceTable<TraceRow>>,
    supervision: SupervisionCount,
}

impl Listener {
    fn new(trace: bool) -> Self {
        Self {
            table: trace.then(|| TraceTable::new(Columns::of_plane())),
            supervision: SupervisionCount::default(),
        }
    }
}

impl Recorder for Listener {
    fn row(&mut self, row: &TraceRow) {
        if let Some(table) = &mut self.table {
            table.row(row);
        }
        self.supervision.row(row);
    }
}

/// What one plane came to.
struct PlaneRan {
    figures: Figures,
    supervision: Option<Supervision>,
    record: Option<Vec<u8>>,
    trace: Option<TraceTable<TraceRow>>,
}

/// What a run came to: its planes by name, and its axis.
struct Ran {
    figures: Figures,
    planes: Vec<(String, PlaneRan)>,
    axis: Option<TraceTable<AxisRow>>,
}

impl PlaneRan {
    fn new((figures, read_out): PlaneEnded, listener: Listener) -> Self {
        Self {
            figures,
            supervision: listener.supervision.ended(read_out.as_ref()),
            record: read_out.and_then(|read_out| read_out.flight_record),
            trace: listener.table,
        }
    }

    fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("figures", python(py, &self.figures)?)?;
        dict.set_item("supervision", python(py, &self.supervision)?)?;
        dict.set_item("record", self.record.map(|bytes| PyBytes::new(py, &bytes)))?;
        dict.set_item("trace", self.trace.map(|t| columns(py, t)).transpose()?)?;
        dict.set_item("axis", py.None())?;
        dict.set_item("planes", PyDict::new(py))?;
        Ok(dict)
    }
}

impl Ran {
    /// The figures of the whole; what only a plane has is there of an only one.
    fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let planes = PyDict::new(py);
        let dict = PyDict::new(py);
        for key in ["supervision", "record", "trace"] {
            dict.set_item(key, py.None())?;
        }
        let only = self.planes.len() == 1;
        for (name, ran) in self.planes {
            let plane = ran.into_python(py)?;
            if only {
                dict.update(plane.as_mapping())?;
            }
            planes.set_item(name, plane)?;
        }
        dict.set_item("figures", python(py, &self.figures)?)?;
        dict.set_item("axis", self.axis.map(|t| columns(py, t)).transpose()?)?;
        dict.set_item("planes", planes)?;
        Ok(dict)
    }
}

fn run(scene: &Resolved, kind: PolicyKind, trace: bool) -> Result<Ran, RunError> {
    if trace {
        fits_in_memory(scene, kind.name())?;
    }
    let mut listeners: Vec<Listener> = scene.planes.iter().map(|_| Listener::new(trace)).collect();
    let modes = scene.machine.rotor.bending().len();
    let axis = || TraceTable::new(Columns::of_axis(modes));
    let mut axis = (trace && scene.has_axis()).then(axis);
    let recorders = Recorders {
        planes: (listeners.iter_mut())
            .map(|listener| listener as &mut dyn Recorder)
            .collect(),
        axis: axis.as_mut().map(|axis| axis as &mut dyn Recorder<AxisRow>),
    };
    let ended = record(scene, kind, recorders, Accuracy::default(), &mut |_| {})?;
    let figures: Vec<Figures> = ended.iter().map(|(figures, _)| figures.clone()).collect();
    let policy = kind.name();
    let planes = scene.planes.iter().zip(ended.into_iter().zip(listeners));
    Ok(Ran {
        figures: Figures::of_machine(&figures).ok_or(RunError::Incomplete { policy })?,
        planes: planes
            .map(|(plane, (ended, listener))| (plane.name.clone(), PlaneRan::new(ended, listener)))
            .collect(),
        axis,
    })
}

/// What was raised by the controller itself, with the place of the run noted where Python can.
fn raised(py: Python<'_>, raised: Option<&Raised>, error: &RunError) -> PyErr {
    let Some(own) = raised.and_then(Raised::take) else {
        return of_run(error);
    };
    // From Python 3.11 on; without a note it is the same exception.
    let _noted = own.value(py).call_method1("add_note", (error.to_string(),));
    own
}

/// Runs the policies of a scene one after the other: what each came to, by its name.
#[pyfunction]
#[pyo3(signature = (scene, controller, trace))]
pub(crate) fn run_policies<'py>(
    py: Python<'py>,
    scene: &Scene,
    controller: Option<&Bound<'py, PyAny>>,
    trace: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let mut spec = scene.spec.clone();
    let mut from = None;
    if let Some(make) = controller {
        let (caller, raised) = caller(make)?;
        (spec.levitated_by(caller)).map_err(|error| of_scene(py, &error))?;
        from = Some(raised);
    }
    let scene = spec.resolve().map_err(|error| of_scene(py, &error))?;
    for warning in &scene.warnings {
        let text = CString::new(warning.replace('\0', " "))?;
        // Of the line that calls `run_scene`.
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 2)?;
    }
    let runs = PyDict::new(py);
    for kind in &scene.policies {
        // Others may use Python meanwhile; a controller is attached to it for each of its samples.
        let ran = py.detach(|| run(&scene, *kind, trace));
        let ran = ran.map_err(|error| raised(py, from.as_ref(), &error))?;
        runs.set_item(kind.name(), ran.into_python(py)?)?;
    }
    Ok(runs)
}
