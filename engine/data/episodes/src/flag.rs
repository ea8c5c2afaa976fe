//! Findings of checks: a stable name, the severity, the place, and the values.

use serde::Serialize;
use std::fmt;

/// Severity of a flag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The episode is true but worse than others; a few of them do no harm (paper: less than 5 %).
    Imperfect,
    /// A statement of the data is false.
    Damage,
}

/// A finding.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Flag {
    /// Stable kebab-case name, such as `yaw-sign`.
    pub name: &'static str,
    /// Severity.
    pub severity: Severity,
    /// The episode or the file.
    pub place: String,
    /// Statement of the fault, with values.
    pub message: String,
}

impl Flag {
    /// A statement of the data is false.
    pub fn damage(name: &'static str, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { name, severity: Severity::Damage, place: place.into(), message: message.into() }
    }

    /// A flag of severity [`Severity::Imperfect`].
    pub fn imperfect(name: &'static str, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { name, severity: Severity::Imperfect, place: place.into(), message: message.into() }
    }
}

impl fmt::Display for Flag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} [{}]", self.place, self.message, self.name)
    }
}
