//! [`Tally`]: how often something happened, with the first few elements, for one line of warning.

use core::fmt::Display;

/// Elements that a warning names.
const MOST_NAMES: usize = 3;

/// A count and some names.
#[derive(Debug, Default)]
pub struct Tally {
    /// How often.
    pub count: usize,
    names: Vec<String>,
}

impl Tally {
    /// Counts an element.
    pub fn add(&mut self, name: impl Display) {
        self.count += 1;
        if self.names.len() < MOST_NAMES {
            self.names.push(name.to_string());
        }
    }

    /// A line such as `3 rings do not close (way 7, way 9, relation 2)`, unless nothing was counted.
    pub fn line(&self, what: &str) -> Option<String> {
        let more = if self.count > self.names.len() { ", ..." } else { "" };
        (self.count > 0).then(|| format!("{} {what} ({}{more})", self.count, self.names.join(", ")))
    }
}
