//! The extension module `cosfly._cosfly`: calls of the command line, tables and images of datasets for Python.
//!
//! The Python half of the package (`python/cosfly`) gives these functions their types, documentation and names.

mod calls;
mod channels;
mod console;
mod dataset;
mod errors;
mod expert;
mod flock;
mod images;
mod table;

use pyo3::prelude::*;

/// Functions behind the package `cosfly`.
#[pymodule]
fn _cosfly(module: &Bound<'_, PyModule>) -> PyResult<()> {
    cosfly::prepare().map_err(pyo3::exceptions::PyValueError::new_err)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("STATE", cosfly_env::Observation::NAMES)?;
    module.add("ACTION", cosfly_env::Action::NAMES)?;
    module.add_function(wrap_pyfunction!(calls::main, module)?)?;
    module.add_function(wrap_pyfunction!(calls::call, module)?)?;
    module.add_function(wrap_pyfunction!(channels::channels, module)?)?;
    module.add_function(wrap_pyfunction!(channels::sensors, module)?)?;
    module.add_function(wrap_pyfunction!(channels::weathers, module)?)?;
    module.add_function(wrap_pyfunction!(images::decode_rgb, module)?)?;
    module.add_function(wrap_pyfunction!(images::shown, module)?)?;
    module.add_function(wrap_pyfunction!(errors::damaged_pack, module)?)?;
    module.add_function(wrap_pyfunction!(errors::refused_by_machine, module)?)?;
    module.add_function(wrap_pyfunction!(errors::changed_dataset, module)?)?;
    module.add_function(wrap_pyfunction!(errors::changed_pack, module)?)?;
    module.add_function(wrap_pyfunction!(errors::pack_of_other, module)?)?;
    module.add_class::<dataset::Reader>()?;
    module.add_class::<expert::ExpertService>()?;
    module.add_class::<flock::PyFlock>()?;
    module.add_class::<table::Table>()
}
