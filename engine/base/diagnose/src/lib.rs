//! One diagnostic type: what was wrong, where, whose fault, what is allowed, what to do next.

mod excerpt;
mod nearest;
mod print;

pub use nearest::nearest_name;
pub use print::{render, render_all};

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// Who can mend it; decides the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// The recipe or the command line asks for something that cannot be.
    Recipe,
    /// An input file (map, track, store) is broken or does not fit.
    Input,
    /// The machine refused: disk full, no permission, a file vanished.
    Machine,
    /// cosfly itself is wrong; please report it.
    Bug,
}

/// A piece of a text file that a diagnostic points at.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// File the text came from.
    pub path: PathBuf,
    /// The whole text of the file.
    pub text: Arc<str>,
    /// Bytes of `text` to underline.
    pub span: Range<usize>,
    /// What is there; may be empty.
    pub note: String,
}

/// One thing that went wrong, ready to be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Stable kebab-case name, such as `recipe-unknown-key`.
    pub code: &'static str,
    /// Who can mend it.
    pub fault: Fault,
    /// What was wrong: a lower-case fragment, literals in back-ticks.
    pub message: String,
    /// Where, when it is in a text file.
    pub labels: Vec<Label>,
    /// Why, from the nearest cause to the deepest.
    pub causes: Vec<String>,
    /// What is allowed and what to do next.
    pub hints: Vec<String>,
}

impl Diagnostic {
    /// A diagnostic with a code, a fault and a message.
    pub fn new(code: &'static str, fault: Fault, message: impl Into<String>) -> Box<Self> {
        Box::new(Self { code, fault, message: message.into(), labels: vec![], causes: vec![], hints: vec![] })
    }

    /// Adds a place in a text file.
    pub fn at(mut self: Box<Self>, label: Label) -> Box<Self> {
        self.labels.push(label);
        self
    }

    /// Adds a cause.
    pub fn because(mut self: Box<Self>, cause: impl fmt::Display) -> Box<Self> {
        self.causes.push(cause.to_string());
        self
    }

    /// Adds what is allowed or what to do next.
    pub fn hint(mut self: Box<Self>, hint: impl Into<String>) -> Box<Self> {
        self.hints.push(hint.into());
        self
    }

    /// The machine refused something; names the disk when it is full.
    pub fn io(action: impl fmt::Display, error: &std::io::Error) -> Box<Self> {
        let full = error.kind() == std::io::ErrorKind::StorageFull || error.kind() == std::io::ErrorKind::QuotaExceeded;
        let diagnostic =
            Self::new(if full { "disk-full" } else { "machine-io" }, Fault::Machine, format!("could not {action}"))
                .because(error);
        if full {
            diagnostic.hint("free some space or choose another disk with `--store` and `--out`, then run the same command again: finished items are kept")
        } else {
            diagnostic
        }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        self.causes.iter().try_for_each(|cause| write!(f, ": {cause}"))
    }
}

impl std::error::Error for Diagnostic {}

/// What fallible work of the engine returns.
pub type Result<T, E = Box<Diagnostic>> = std::result::Result<T, E>;
