//! What goes wrong, as exceptions.

use firmware_bench::run::closed_loop::RunError as Run;
use firmware_bench::scene::diagnostic::SceneError as Scene;
use miette::Diagnostic;
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::{PyAnyMethods, PyErr, PyResult, Python};

create_exception!(
    ambwhirl,
    SceneError,
    PyValueError,
    "A scene cannot be used. Says file, line, key and what was expected, as the command line does, and what to do: `message` and `help`."
);
create_exception!(
    ambwhirl,
    ConfigError,
    PyValueError,
    "A parameter of the supervisor is outside its range. Names it, its value and the range."
);
create_exception!(
    ambwhirl,
    RunError,
    PyRuntimeError,
    "A run cannot be trusted any further. There is no half-trusted result."
);
create_exception!(
    ambwhirl,
    ControllerError,
    RunError,
    "A levitation controller does not answer as it should."
);
create_exception!(
    ambwhirl,
    RecordError,
    PyValueError,
    "Bytes are no flight record."
);

/// With its message and its help also by themselves.
pub(crate) fn of_scene(py: Python<'_>, error: &Scene) -> PyErr {
    let message = error.to_string();
    let help = error.help().map(|help| help.to_string());
    let text = match &help {
        Some(help) => format!("{message}\nhelp: {help}"),
        None => message.clone(),
    };
    let error = SceneError::new_err(text);
    let value = error.value(py);
    let set: PyResult<()> =
        (value.setattr("message", message)).and_then(|()| value.setattr("help", help));
    match set {
        Ok(()) => error,
        Err(other) => other,
    }
}

/// Of a run.
pub(crate) fn of_run(error: &Run) -> PyErr {
    match error {
        Run::Controller { .. } => ControllerError::new_err(error.to_string()),
        _ => RunError::new_err(error.to_string()),
    }
}
