//! Flight records.

use crate::config::Config;
use crate::errors::RecordError;
use crate::values::python;
use firmware_bench::record::file::{PlaneRecord, RecordFile};
use firmware_bench::record::narrative::Event;
use firmware_bench::record::ticks::{Tick, Ticks};
use firmware_bench::run::trace_table::NameColumn;
use numpy::PyArray1;
use pyo3::prelude::{Bound, Py, PyAny, PyResult, Python, pyfunction};
use pyo3::types::{PyDict, PyDictMethods, PyList, PyListMethods};

/// What is whole of a file, event by event.
#[pyfunction]
pub(crate) fn decoded<'py>(py: Python<'py>, bytes: &[u8]) -> PyResult<Bound<'py, PyDict>> {
    let file = RecordFile::of(bytes);
    let damage: Vec<String> = file.damage.iter().map(ToString::to_string).collect();
    if file.records.is_empty() {
        return Err(RecordError::new_err(format!(
            "{}; one of version 2 `firmware-host review` reads",
            damage.join("; ")
        )));
    }
    let events: PyResult<Vec<_>> = file.events().iter().map(|e| event(py, e)).collect();
    let dict = PyDict::new(py);
    dict.set_item("intact", file.is_intact())?;
    dict.set_item("damage", damage)?;
    dict.set_item("events", events?)?;
    Ok(dict)
}

fn event<'py>(py: Python<'py>, event: &Event<'_>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let narrative = event.narrative();
    dict.set_item("summary", python(py, &narrative)?)?;
    // Without a ledger nothing is used up.
    dict.set_item("text", narrative.map(|narrative| narrative.paragraph(0.0)))?;
    let replay = event.replay.as_ref();
    dict.set_item("replay", python(py, &replay.ok())?)?;
    dict.set_item("no_replay", replay.err().map(ToString::to_string))?;
    let findings = event.findings();
    let identified = findings.as_ref().map(|f| f.identified);
    dict.set_item("identified", python(py, &identified)?)?;
    let contacts = findings.as_ref().map_or(&[][..], |f| &f.contacts);
    dict.set_item("contacts", python(py, &contacts)?)?;
    dict.set_item("contacts_from", findings.as_ref().map(|f| f.first))?;
    let planes: PyResult<Vec<_>> = event.records.iter().map(|r| plane(py, r)).collect();
    dict.set_item("planes", planes?)?;
    Ok(dict)
}

fn plane<'py>(py: Python<'py>, record: &PlaneRecord) -> PyResult<Bound<'py, PyDict>> {
    let (dict, head) = (PyDict::new(py), &record.head);
    dict.set_item("plane", head.plane)?;
    dict.set_item("firmware", head.firmware)?;
    dict.set_item("time_us", head.time_us)?;
    dict.set_item("at_sequence", head.at_sequence)?;
    dict.set_item("dropped", head.dropped)?;
    let config = record
        .config
        .map(|parameters| Py::new(py, Config { parameters }));
    dict.set_item("config", config.transpose()?)?;
    let ticks = Ticks::of(record);
    dict.set_item("missing", ticks.missing)?;
    dict.set_item("stretches", python(py, &ticks.stretches)?)?;
    dict.set_item("ticks", columns(py, &ticks.ticks)?)?;
    Ok(dict)
}

/// The columns that `review --csv` has.
fn columns<'py>(py: Python<'py>, ticks: &[Tick]) -> PyResult<Bound<'py, PyAny>> {
    let columns = PyList::empty(py);
    let whole = |heading: &str, of: fn(&Tick) -> i64| {
        columns.append((
            heading,
            PyArray1::from_vec(py, ticks.iter().map(of).collect()),
        ))
    };
    let number = |heading: &str, of: &dyn Fn(&Tick) -> Option<f64>| {
        let numbers = ticks.iter().map(|tick| of(tick).unwrap_or(f64::NAN));
        columns.append((heading, PyArray1::from_vec(py, numbers.collect())))
    };
    let name = |heading: &str, of: fn(&Tick) -> String| {
        let mut column = NameColumn::default();
        ticks.iter().for_each(|tick| column.push(of(tick)));
        columns.append((heading, PyArray1::from_vec(py, column.codes), column.names))
    };
    whole("sequence", |tick| i64::from(tick.sequence))?;
    whole("tick", |tick| tick.tick)?;
    number("time_s", &|tick| tick.time_s)?;
    for (axis, letter) in ["x", "y"].into_iter().enumerate() {
        number(letter, &|tick| Some(tick.position[axis]))?;
    }
    for (axis, letter) in ["x", "y"].into_iter().enumerate() {
        number(&format!("{letter}_m"), &|tick| Some(tick.position_m?[axis]))?;
    }
    for (axis, letter) in ["x", "y"].into_iter().enumerate() {
        number(&format!("force_{letter}"), &|tick| Some(tick.force[axis]))?;
    }
    for (axis, letter) in ["x", "y"].into_iter().enumerate() {
        let heading = format!("force_{letter}_n");
        number(&heading, &|tick| Some(tick.force_n?[axis]))?;
    }
    name("mode", |tick| tick.mode.to_owned())?;
    name("limits", |tick| tick.limits.join(" "))?;
    name("events", |tick| tick.events.join(" "))?;
    Ok(columns.into_any())
}
