//! One diagnostic type: what was wrong, where, of which kind, what is allowed, what to do next.
//!
//! * [`Diagnostic`]: one failure, ready to be shown; [`Fault`] is its kind, [`Label`] a place in a text.
//! * [`render`], [`render_all`]: diagnostics as text for a terminal.
//! * [`ParameterError`]: a refused parameter, before anyone knows where it is written.
//! * [`nearest_name`]: the known name that a mistyped one was probably meant to be.

mod diagnostic;
mod excerpt;
mod nearest;
mod parameter;
mod print;
mod visible;

pub use diagnostic::{Diagnostic, Fault, Label, Result};
pub use nearest::nearest_name;
pub use parameter::ParameterError;
pub use print::{render, render_all};
