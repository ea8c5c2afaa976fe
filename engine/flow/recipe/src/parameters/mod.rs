//! A stage's parameters against the JSON Schema of its kind, every violation at its own place.
//!
//! * `check`: the walk over value and schema.
//! * `alternatives`: `oneOf` and `anyOf`: which alternative was meant.
//! * `scalars`: ranges, lengths and allowed values.
//! * `schema_words`: what a schema wants and documents, in words.

mod alternatives;
mod check;
mod scalars;
mod schema_words;

pub(crate) use check::{Subject, check_parameters};
pub(crate) use schema_words::{allowed_values, resolve, show_json, show_toml, type_words_of};
