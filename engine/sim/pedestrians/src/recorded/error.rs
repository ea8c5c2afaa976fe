//! [`RecordedError`]: why a file of tracks cannot be used, where, and the way out.

use std::fmt;

/// A file of tracks that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedError {
    /// The value that was found and the rule it breaks.
    pub message: String,
    /// Line of the file, from 1, where the error is about one.
    pub line: Option<u32>,
    /// Advice for the user.
    pub hint: String,
}

impl RecordedError {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), line: None, hint: String::new() }
    }

    /// Error with a line of the file, from 1; 0 is none.
    pub(crate) fn at(mut self, line: u32) -> Self {
        self.line = (line > 0).then_some(line);
        self
    }

    pub(crate) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = hint.into();
        self
    }
}

impl fmt::Display for RecordedError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(out, "{} (line {line})", self.message),
            None => out.write_str(&self.message),
        }
    }
}

impl std::error::Error for RecordedError {}
