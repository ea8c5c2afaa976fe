//! [`MapError`]: why a map cannot be used, where in the file, and the way out.

use core::ops::Range;
use std::fmt;

/// A map that cannot be used. `Display` is one lower-case fragment without the file's path.
#[derive(Clone, Debug, PartialEq)]
pub struct MapError {
    /// The value that was found and the rule it breaks.
    pub message: String,
    /// Place in the file, where the error is about one.
    pub place: Option<TextPlace>,
    /// Advice for the user, one sentence each.
    pub hints: Vec<String>,
}

/// A place in a map file's text (after decoding to UTF-8, without a byte-order mark).
#[derive(Clone, Debug, PartialEq)]
pub struct TextPlace {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// Bytes of the element or attribute value.
    pub byte_span: Range<usize>,
    /// The element and what it belongs to, such as ``<geometry> of road `12` ``.
    pub element: String,
}

impl MapError {
    /// An error about the file as a whole.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), place: None, hints: Vec::new() }
    }

    /// This error with one more piece of advice.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hints.push(hint.into());
        self
    }

    /// This error at a place.
    #[must_use]
    pub fn at(mut self, place: TextPlace) -> Self {
        self.place = Some(place);
        self
    }
}

impl fmt::Display for MapError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.message)?;
        if let Some(place) = &self.place {
            write!(out, " (line {}, column {}", place.line, place.column)?;
            if !place.element.is_empty() {
                write!(out, ", {}", place.element)?;
            }
            write!(out, ")")?;
        }
        Ok(())
    }
}

impl std::error::Error for MapError {}
