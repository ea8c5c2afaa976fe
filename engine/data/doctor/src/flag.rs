//! What a check raises: a stable name, how grave it is, where, and what the numbers are.

use serde::Serialize;
use std::fmt;

/// How grave a flag is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The episode is true and not as good as others; a few of them do no harm (paper: less than 5 %).
    Imperfect,
    /// The data say what is not so.
    Damage,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Flag {
    /// Stable kebab-case name, such as `yaw-sign`.
    pub name: &'static str,
    /// How grave it is.
    pub severity: Severity,
    /// The episode or the file.
    pub place: String,
    /// What is wrong, with the values.
    pub message: String,
}

impl Flag {
    /// The data say what is not so.
    pub fn damage(name: &'static str, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { name, severity: Severity::Damage, place: place.into(), message: message.into() }
    }

    /// True, but not good.
    pub fn imperfect(name: &'static str, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { name, severity: Severity::Imperfect, place: place.into(), message: message.into() }
    }
}

impl fmt::Display for Flag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} [{}]", self.place, self.message, self.name)
    }
}
