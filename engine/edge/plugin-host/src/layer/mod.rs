//! From the bytes of a file to a component: a component stays as it is, a core module gets a layer around it.
//!
//! Compilers for `wasm32-unknown-unknown` write core modules: functions of numbers and a memory. The layer says which function of the
//! interface each of them is and how texts and lists lie in the memory (the canonical ABI of the component model), so that the host
//! knows components only.
//!
//! * [`module`]: the names that a core module imports and exports.
//! * [`types`]: the types of the interface.
//! * [`shim`]: two small modules that let a plugin import functions which need the plugin's own memory.
//! * [`wrap`]: the component.

mod module;
mod shim;
mod types;
mod wrap;

pub use wrap::{component_of, is_cost_term};
