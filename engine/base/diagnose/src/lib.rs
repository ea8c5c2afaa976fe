//! The type of all diagnostics: code, kind, message, places, causes, hints.
//!
//! * [`Diagnostic`]: one failure, ready to be shown; [`Fault`] is its kind, [`Label`] a place in a text.
//! * [`render`], [`render_all`]: diagnostics as text for a terminal.
//! * [`ParameterError`]: an invalid parameter whose place in a file is not known yet.
//! * [`visible_text`]: foreign text, made harmless for a terminal.
//! * [`counted`]: a number of things, `1 frame` or `2 frames`.
//! * [`nearest_name`]: the known name most similar to a mistyped one.
//! * [`absent`]: why a path leads to nothing.
//! * [`contained`]: work of a library that may panic on damaged bytes.
//! * [`plausible`]: the rule for numbers from outside.
//! * [`Stop`]: the flag by which the user ends long work.

mod contained;
mod diagnostic;
mod excerpt;
mod nearest;
mod parameter;
mod plausible;
mod print;
mod stop;
mod visible;

pub use contained::contained;
pub use diagnostic::{Diagnostic, Fault, Label, Result, absent};
pub use nearest::nearest_name;
pub use parameter::ParameterError;
pub use plausible::{Implausible, LARGEST_MAGNITUDE, plausible};
pub use print::{counted, render, render_all};
pub use stop::{Stop, StoppableReader};
pub use visible::visible_text;
