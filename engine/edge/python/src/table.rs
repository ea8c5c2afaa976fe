//! A table of a dataset: columns as numpy arrays, the whole as an Arrow stream.

use crate::errors::{raised, refused};
use cosfly_diagnose::{Result, counted};
use cosfly_load::FlightSource;
use cosfly_read::columns::{Column, TableData};
use numpy::{PyArray1, PyArrayMethods, ToPyArray};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};
use std::path::PathBuf;
use std::sync::Arc;

/// A table of a dataset. `table["column"]` is a numpy array, or a list for texts and files; pyarrow, pandas and polars
/// take the whole table through Arrow's PyCapsule interface.
#[pyclass(frozen, module = "cosfly")]
pub struct Table {
    /// The rows.
    pub data: TableData,
    /// The dataset that they are of.
    pub dataset: Arc<dyn FlightSource>,
}

impl Table {
    /// Values read of the table, unless its folder holds another dataset by now.
    fn read<T: Send>(&self, py: Python<'_>, read: impl FnOnce(&TableData) -> Result<T> + Send) -> PyResult<T> {
        let found = py.detach(|| {
            let found = read(&self.data);
            self.dataset.check()?;
            found
        });
        raised(py, found)
    }
}

#[pymethods]
impl Table {
    /// Names of the columns.
    #[getter]
    fn columns(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.read(py, TableData::columns)
    }

    /// Parquet files of the table, in the order of their rows; none for tables that are made from other layouts.
    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.data.files().to_vec()
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.read(py, TableData::rows)
    }

    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyAny>> {
        let known = self.columns(py)?;
        if !known.iter().any(|column| column == name) {
            let message = format!("no column `{name}`; the columns are {}", known.join(", "));
            return Err(refused(py, "NotFound", &message));
        }
        let column = self.read(py, |data| data.column(name))?;
        values(py, column)
    }

    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema; // Consumers convert types themselves.
        PyCapsule::new_with_value(py, self.read(py, TableData::stream)?, c"arrow_array_stream")
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<cosfly.Table of {}: {}>", counted(self.__len__(py)?, "row"), self.columns(py)?.join(", ")))
    }
}

/// Values of a column for Python; lists of one length as an array with two axes.
fn values(py: Python<'_>, column: Column) -> PyResult<Py<PyAny>> {
    Ok(match column {
        Column::Reals(values) => PyArray1::from_vec(py, values).into_any().unbind(),
        Column::Integers(values) => PyArray1::from_vec(py, values).into_any().unbind(),
        Column::Texts(values) => PyList::new(py, values)?.into_any().unbind(),
        Column::Files(values) => PyList::new(py, values)?.into_any().unbind(),
        Column::TextLists(values) => PyList::new(py, values)?.into_any().unbind(),
        Column::Lists(values, ends) => {
            let width = ends.first().copied().unwrap_or(0);
            let is_even = width > 0 && ends.iter().enumerate().all(|(row, end)| *end == (row + 1) * width);
            if is_even {
                return Ok(PyArray1::from_vec(py, values).reshape([ends.len(), width])?.into_any().unbind());
            }
            let starts = std::iter::once(0).chain(ends.iter().copied());
            let rows = starts.zip(&ends).map(|(start, end)| values[start..*end].to_pyarray(py));
            PyList::new(py, rows.collect::<Vec<_>>())?.into_any().unbind()
        }
    })
}
