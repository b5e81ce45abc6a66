//! Values on their way between Python and Rust.

use numpy::{AllowTypeChange, PyArray1, PyArrayLikeDyn};
use plant_model::V2;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::{Bound, IntoPyObject, Py, PyAny, PyAnyMethods, PyErr, PyResult, Python};
use pyo3::types::{PyBool, PyDict, PyDictMethods, PyList, PyString, PyStringMethods, PyTuple};
use serde::Serialize;
use serde_json::Value;

/// Numbers of an argument that are in an array, or in what NumPy makes one of, and its shape.
pub(crate) fn array(name: &str, given: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<usize>)> {
    let array: PyArrayLikeDyn<'_, f64, AllowTypeChange> = given.extract().map_err(|error| {
        let text = format!("{name}: expected numbers, got {}", shown(given));
        let raised = PyTypeError::new_err(text);
        raised.set_cause(given.py(), Some(error));
        raised
    })?;
    let view = array.as_array();
    Ok((view.iter().copied().collect(), view.shape().to_vec()))
}

/// As people write shapes in Python: `(2,)`.
fn shape_text(shape: &[usize]) -> String {
    match shape {
        [only] => format!("({only},)"),
        _ => format!("{shape:?}").replace('[', "(").replace(']', ")"),
    }
}

fn wrong_shape(name: &str, shape: &[usize], expected: &str) -> PyErr {
    let shape = shape_text(shape);
    PyValueError::new_err(format!(
        "{name}: has the shape {shape}, expected {expected}"
    ))
}

/// An argument with x and y, whatever numbers they are.
pub(crate) fn pair(name: &str, given: &Bound<'_, PyAny>) -> PyResult<[f64; 2]> {
    // Lists and tuples, which are what most callers have, without an array in between.
    if (given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>())
        && let Ok(pair) = given.extract::<[f64; 2]>()
    {
        return Ok(pair);
    }
    let (numbers, shape) = array(name, given)?;
    match (shape.len(), &numbers[..]) {
        (1, [x, y]) => Ok([*x, *y]),
        _ => Err(wrong_shape(name, &shape, "(2,): x and y")),
    }
}

/// An argument with so many rows of x and y, finite.
pub(crate) fn vectors(name: &str, given: &Bound<'_, PyAny>, rows: usize) -> PyResult<Vec<V2>> {
    let (numbers, shape) = array(name, given)?;
    let fits = match (&shape[..], rows) {
        ([n, 2], rows) => *n == rows,
        ([0], 0) => true,
        // One row may come as it is.
        ([2], 1) => true,
        _ => false,
    };
    if !fits {
        return Err(wrong_shape(
            name,
            &shape,
            &format!("({rows}, 2): x and y of each"),
        ));
    }
    finite(name, &numbers)?;
    let (pairs, _) = numbers.as_chunks::<2>();
    Ok(pairs.iter().map(|[x, y]| V2::new(*x, *y)).collect())
}

/// Blocks of so many rows of vectors: of one row, the rows themselves do as well.
pub(crate) fn stacks(name: &str, given: &Bound<'_, PyAny>, rows: usize) -> PyResult<Vec<Vec<V2>>> {
    let (numbers, shape) = array(name, given)?;
    let blocks = match shape[..] {
        [n, own, 2] if own == rows => n,
        [n, 2] if rows == 1 => n,
        _ => {
            let expected = format!("(n, {rows}, 2): x and y of each, step by step");
            return Err(wrong_shape(name, &shape, &expected));
        }
    };
    finite(name, &numbers)?;
    let (pairs, _) = numbers.as_chunks::<2>();
    let row = |block: usize| pairs[block * rows..(block + 1) * rows].iter();
    let vectors = |block: usize| row(block).map(|[x, y]| V2::new(*x, *y)).collect();
    Ok((0..blocks).map(vectors).collect())
}

/// Whether all of an argument's numbers are finite.
pub(crate) fn finite(name: &str, numbers: &[f64]) -> PyResult<()> {
    match numbers.iter().find(|x| !x.is_finite()) {
        None => Ok(()),
        Some(x) => Err(PyValueError::new_err(format!(
            "{name}: is {x}, expected finite numbers"
        ))),
    }
}

/// A vector as an array.
pub(crate) fn pair_array(py: Python<'_>, v: [f64; 2]) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_vec(py, v.to_vec())
}

/// As `repr` has it, shortened.
pub(crate) fn shown(given: &Bound<'_, PyAny>) -> String {
    const LONGEST: usize = 200;
    let text = given.repr().map_or_else(
        |_| "something without a repr".to_owned(),
        |text| text.to_string_lossy().into_owned(),
    );
    match text.char_indices().nth(LONGEST) {
        None => text,
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// What serde makes of a value, as dictionaries, lists and scalars.
pub(crate) fn python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let value =
        serde_json::to_value(value).map_err(|error| PyValueError::new_err(error.to_string()))?;
    of_json(py, &value)
}

fn of_json<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Null => py.None().into_bound(py),
        Value::Bool(truth) => PyBool::new(py, *truth).to_owned().into_any(),
        Value::Number(number) => match (number.as_i64(), number.as_u64()) {
            (Some(whole), _) => whole.into_pyobject(py)?.into_any(),
            (_, Some(whole)) => whole.into_pyobject(py)?.into_any(),
            _ => number.as_f64().into_pyobject(py)?.into_any(),
        },
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Array(values) => {
            let values: PyResult<Vec<_>> = values.iter().map(|value| of_json(py, value)).collect();
            PyList::new(py, values?)?.into_any()
        }
        Value::Object(values) => {
            let dict = PyDict::new(py);
            for (key, value) in values {
                dict.set_item(key, of_json(py, value)?)?;
            }
            dict.into_any()
        }
    })
}

/// A value of a scene's key.
pub(crate) fn toml_value(key: &str, given: &Bound<'_, PyAny>) -> PyResult<toml::Value> {
    let refused = || {
        let text = format!("{key}: no key of scenes has a value like {}", shown(given));
        PyTypeError::new_err(text)
    };
    if let Ok(truth) = given.cast::<PyBool>() {
        return Ok(toml::Value::Boolean(truth.extract()?));
    }
    if let Ok(text) = given.cast::<PyString>() {
        return Ok(toml::Value::String(text.to_string_lossy().into_owned()));
    }
    if let Ok(dict) = given.cast::<PyDict>() {
        let mut table = toml::Table::new();
        for (below, value) in dict.iter() {
            let below: String = below.extract().map_err(|_| refused())?;
            let value = toml_value(&format!("{key}.{below}"), &value)?;
            table.insert(below, value);
        }
        return Ok(toml::Value::Table(table));
    }
    if given.hasattr("__len__")? {
        let each = given.try_iter().map_err(|_| refused())?;
        let values: PyResult<Vec<_>> = each.map(|value| toml_value(key, &value?)).collect();
        return Ok(toml::Value::Array(values?));
    }
    // By `__index__`, which what has a fraction lacks.
    if let Ok(whole) = given.extract::<i64>() {
        return Ok(toml::Value::Integer(whole));
    }
    let number: f64 = given.extract().map_err(|_| refused())?;
    Ok(toml::Value::Float(number))
}

/// A value of a scene's key, on its way back.
pub(crate) fn of_toml(py: Python<'_>, value: &toml::Value) -> PyResult<Py<PyAny>> {
    Ok(python(py, value)?.unbind())
}
