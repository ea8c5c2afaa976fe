//! Checks of a stage's parameters against the JSON Schema of its kind; every violation has its own place.
//!
//! * `check`: checks a value against a schema.
//! * `alternatives`: the intended alternative of `oneOf` and `anyOf`.
//! * `scalars`: ranges, lengths and allowed values.
//! * `context`: messages shared by all checks.
//! * `schema_words`: schemas in words.

mod alternatives;
mod check;
mod context;
mod scalars;
mod schema_words;

pub(crate) use check::check_parameters;
pub(crate) use context::Subject;
pub(crate) use schema_words::{allowed_values, resolve, show_json, show_toml, type_words_of};
