//! The interface in Rust, generated from `plugins/wit` by `plugins/write_bindings.sh` (wit-bindgen 0.61.1).
#![allow(missing_docs, clippy::all, reason = "generated")]

pub mod cost_term;
pub mod objective;
pub mod stage;

/// What all worlds share.
pub use cost_term::cosfly::plugin::types;
