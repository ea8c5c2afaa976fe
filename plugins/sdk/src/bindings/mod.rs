//! The interface in Rust, generated from `plugins/wit` by `wit-bindgen rust ../wit --world WORLD --pub-export-macro
//! --export-macro-name export_WORLD --default-bindings-module cosfly_plugin::bindings::WORLD --format` (0.61).
#![allow(missing_docs, clippy::all, reason = "generated")]

pub mod cost_term;
pub mod objective;
pub mod stage;
