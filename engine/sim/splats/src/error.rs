//! [`SplatError`]: why a file of splats cannot be used, and the way out.

use std::fmt;

/// A file of splats that cannot be used. `Display` is one lower-case fragment without the file's path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SplatError {
    /// The value that was found and the rule it breaks.
    pub message: String,
    /// Advice for the user, one sentence each.
    pub hints: Vec<String>,
}

impl SplatError {
    /// An error about the file as a whole, with a way out.
    pub fn new(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { message: message.into(), hints: vec![hint.into()] }
    }

    /// A file that ends too early.
    pub(crate) fn cut_off(message: impl Into<String>) -> Self {
        Self::new(message, "the file seems to be cut off: fetch or export it again")
    }
}

impl fmt::Display for SplatError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.message)
    }
}

impl std::error::Error for SplatError {}
