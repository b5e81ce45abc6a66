//! Traces as arrays.

use firmware_bench::run::trace_table::TraceTable;
use numpy::PyArray1;
use pyo3::prelude::{Bound, PyAny, PyResult, Python};
use pyo3::types::{PyList, PyListMethods};

/// Columns in the order of the files: (heading, array), of names (heading, codes, names). The arrays own what the run has
/// written; nothing is copied.
pub(crate) fn columns<R>(py: Python<'_>, table: TraceTable<R>) -> PyResult<Bound<'_, PyAny>> {
    let headings = table.headings();
    let columns = PyList::empty(py);
    for (heading, numbers) in headings.numbers.into_iter().zip(table.numbers) {
        columns.append((heading, PyArray1::from_vec(py, numbers)))?;
    }
    for (heading, column) in headings.names.into_iter().zip(table.names) {
        columns.append((heading, PyArray1::from_vec(py, column.codes), column.names))?;
    }
    for (heading, flags) in headings.flags.into_iter().zip(table.flags) {
        columns.append((heading, PyArray1::from_vec(py, flags)))?;
    }
    Ok(columns.into_any())
}
