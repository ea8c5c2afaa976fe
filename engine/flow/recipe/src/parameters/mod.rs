//! Parameters of a stage against the JSON Schema of its kind, every violation at its own place.
//!
//! * `check`: the walk over a value and its schema.
//! * `alternatives`: the alternative of `oneOf` and `anyOf` that was meant.
//! * `scalars`: ranges, lengths and allowed values.
//! * `context`: the messages that all checks share.
//! * `schema_words`: schemas in words.

mod alternatives;
mod check;
mod context;
mod scalars;
mod schema_words;

pub(crate) use check::check_parameters;
pub(crate) use context::Subject;
pub(crate) use schema_words::{allowed_values, resolve, show_json, show_toml, type_words_of};
