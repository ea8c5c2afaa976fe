//! Diagnostics as exceptions of the class `cosfly.Error`.

use cosfly::Refusal;
use cosfly_diagnose::{Diagnostic, Fault, Label, render_all};
use cosfly_secrets::without_secrets;
use pyo3::exceptions::PyBaseException;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;

pyo3::import_exception!(cosfly._errors, InvalidValue);

/// The exception for some diagnostics; the first one decides its code.
pub fn exception(py: Python<'_>, refusals: &[Box<Diagnostic>]) -> PyErr {
    let build = || -> PyResult<PyErr> {
        let class = py.import("cosfly._errors")?.getattr("Error")?;
        let problems = PyList::empty(py);
        for refusal in refusals {
            let problem = PyDict::new(py);
            problem.set_item("code", refusal.code)?;
            problem.set_item("message", without_secrets(&refusal.to_string()))?;
            problem.set_item("hints", &refusal.hints)?;
            problem.set_item("place", refusal.labels.first().map(place))?;
            problems.append(problem)?;
        }
        let text = without_secrets(&render_all(refusals.iter().map(|refusal| &**refusal), false));
        Ok(PyErr::from_value(class.call1((text, problems))?))
    };
    build().unwrap_or_else(|error| error)
}

/// The exception for a refusal.
pub fn exception_of(py: Python<'_>, refusal: Refusal) -> PyErr {
    match refusal {
        Refusal::Arguments(error) => refused(py, "InvalidValue", &error.to_string()),
        Refusal::Work(refusals) => exception(py, &refusals),
    }
}

/// The exception of a class of `cosfly._errors`, which is also the one that Python's protocol asks for.
pub fn refused(py: Python<'_>, class: &str, message: &str) -> PyErr {
    let build = || PyResult::Ok(PyErr::from_value(py.import("cosfly._errors")?.getattr(class)?.call1((message,))?));
    build().unwrap_or_else(|error| error)
}

/// The exception for a fault of cosfly itself.
pub fn internal(py: Python<'_>) -> PyErr {
    let message = "internal error of cosfly: please report it, with the message above";
    exception(py, &[Diagnostic::new("internal-panic", Fault::Bug, message)])
}

/// File, line and column (from 1) of a label.
fn place(label: &Label) -> (String, usize, usize) {
    let before = label.text.get(..label.span.start).unwrap_or_default();
    let line = before.rsplit('\n').next().unwrap_or_default();
    (label.path.display().to_string(), before.matches('\n').count() + 1, line.chars().count() + 1)
}

/// Diagnostics of a reader as an exception.
pub fn raised<T>(py: Python<'_>, result: cosfly_diagnose::Result<T>) -> PyResult<T> {
    result.map_err(|refusal| exception(py, &[refusal]))
}

/// The refusal for a file of a training pack.
#[pyfunction]
pub fn damaged_pack(py: Python<'_>, path: &str, cause: &str) -> Py<PyBaseException> {
    let refusal = Diagnostic::new("dataset-damaged", Fault::Input, format!("`{path}` is damaged"))
        .because(cause)
        .hint("`cosfly.pack` makes a new pack");
    exception(py, &[refusal]).into_value(py)
}

/// The refusal for a folder whose dataset is another one than before: both by their digests.
#[pyfunction]
pub fn changed_dataset(py: Python<'_>, folder: PathBuf, before: &str, now: &str) -> Py<PyBaseException> {
    exception(py, &[cosfly_read::changed(&folder, before, now)]).into_value(py)
}

/// The refusal for a pack that was made anew since it was opened.
#[pyfunction]
pub fn changed_pack(py: Python<'_>, pack: &str) -> Py<PyBaseException> {
    let message = format!("the pack `{pack}` was made anew since it was opened");
    let refusal = Diagnostic::new("pack-changed", Fault::Input, message)
        .hint("pictures of one dataset do not belong to labels of another: open the pack again");
    exception(py, &[refusal]).into_value(py)
}

/// The refusal for a pack that was made of another dataset: the pack, the dataset, and the digests of what the pack was made
/// of and of the dataset.
#[pyfunction]
pub fn pack_of_other(
    py: Python<'_>,
    pack: &str,
    dataset: &str,
    source: (String, String),
    digest: &str,
) -> Py<PyBaseException> {
    let short = |digest: &str| digest.get(..12).unwrap_or(digest).to_owned();
    let message = format!(
        "the pack `{pack}` holds pictures of dataset {} (it was made of `{}`); `{dataset}` is dataset {}",
        short(&source.1),
        source.0,
        short(digest)
    );
    let refusal = Diagnostic::new("pack-of-other", Fault::Input, message)
        .hint("give the dataset that the pack was made of, or a copy of it")
        .hint(format!("`cosfly.pack({dataset:?}, ...)` makes a pack of this one"));
    exception(py, &[refusal]).into_value(py)
}

/// The refusal for an error of the system, by its number.
#[pyfunction]
pub fn refused_by_machine(py: Python<'_>, action: &str, errno: i32) -> Py<PyBaseException> {
    exception(py, &[Diagnostic::io(action, &std::io::Error::from_raw_os_error(errno))]).into_value(py)
}
