//! Scenes.

use crate::errors::of_scene;
use crate::values::{of_toml, toml_value};
use firmware_bench::scene::Scene as Resolved;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::spec::Spec;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::{Bound, Py, PyAny, PyAnyMethods, PyResult, Python, pyclass, pymethods};
use pyo3::types::{PyDict, PyDictMethods};
use std::path::PathBuf;

/// A scene as it is written: its keys are known and of their types. Whether the values make a scene is said where it is used,
/// or by `check`.
#[pyclass(frozen, module = "ambwhirl")]
pub(crate) struct Scene {
    pub(crate) spec: Spec,
}

impl Scene {
    /// With every value checked.
    pub(crate) fn resolved(&self, py: Python<'_>) -> PyResult<Resolved> {
        self.spec.resolve().map_err(|error| of_scene(py, &error))
    }

    /// With every value checked, for its plant alone: what no policy needs may lack.
    pub(crate) fn plant(&self, py: Python<'_>) -> PyResult<Resolved> {
        let mut spec = self.spec.clone();
        let passive = vec![PolicyKind::Passive.name()];
        (spec.set("run.policies", passive))
            .and_then(|()| spec.resolve())
            .map_err(|error| of_scene(py, &error))
    }

    fn of(
        py: Python<'_>,
        spec: Result<Spec, SceneError>,
        values: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let spec = spec.map_err(|error| of_scene(py, &error))?;
        let scene = Self { spec };
        match values {
            Some(values) => scene.replace(py, values),
            None => Ok(scene),
        }
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (path, values=None))]
    fn new(py: Python<'_>, path: PathBuf, values: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        Self::of(py, Spec::load(&path), values)
    }

    #[staticmethod]
    #[pyo3(signature = (text, values=None, *, name="scene.toml"))]
    fn parse(
        py: Python<'_>,
        text: &str,
        values: Option<&Bound<'_, PyDict>>,
        name: &str,
    ) -> PyResult<Self> {
        Self::of(py, Spec::parse(name, text), values)
    }

    fn replace(&self, py: Python<'_>, values: &Bound<'_, PyDict>) -> PyResult<Self> {
        let mut all = Vec::new();
        for (key, value) in values.iter() {
            let key: String = key.extract().map_err(|_| {
                PyTypeError::new_err("values: expected keys of scenes, as \"friction.coefficient\"")
            })?;
            let value = toml_value(&key, &value)?;
            all.push((key, value));
        }
        let by_key: Vec<_> =
            (all.iter().map(|(key, value)| (key.as_str(), value.clone()))).collect();
        let mut spec = self.spec.clone();
        spec.set_all(&by_key)
            .map_err(|error| of_scene(py, &error))?;
        Ok(Self { spec })
    }

    fn get(&self, py: Python<'_>, key: &str) -> PyResult<Option<Py<PyAny>>> {
        let value = self.spec.get(key).map_err(|error| of_scene(py, &error))?;
        value.map(|value| of_toml(py, value)).transpose()
    }

    fn check(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.resolved(py)?.warnings)
    }

    fn __repr__(&self) -> String {
        let title = self.spec.get("title").ok().flatten();
        let title = title.and_then(toml::Value::as_str).unwrap_or_default();
        format!("<ambwhirl.Scene {title:?}>")
    }
}
