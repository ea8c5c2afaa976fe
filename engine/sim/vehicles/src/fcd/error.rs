//! [`FcdError`]: why a file cannot be used.

use std::fmt;

/// Reason why a file cannot be used. `Display` is one fragment with the line.
#[derive(Clone, Debug, PartialEq)]
pub struct FcdError {
    /// The value that was found and the rule it breaks.
    pub message: String,
    /// Line of the file, from 1.
    pub line: Option<u64>,
    /// Advice for the user.
    pub hint: Option<String>,
}

impl FcdError {
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), line: None, hint: None }
    }

    pub(super) fn because(mut self, cause: String) -> Self {
        self.message = format!("{}: {cause}", self.message);
        self
    }

    pub(super) fn at(mut self, line: u64) -> Self {
        self.line = self.line.or(Some(line));
        self
    }

    pub(super) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for FcdError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.message)?;
        self.line.map_or(Ok(()), |line| write!(out, " (line {line})"))
    }
}

impl std::error::Error for FcdError {}
