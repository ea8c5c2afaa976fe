//! What a check found.

use std::fmt;

/// Findings that are kept; more are only counted.
const KEPT_FINDINGS: usize = 1_000;

/// One violated rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// File, from the dataset's folder.
    pub file: String,
    /// Where in it: flight and frame, row, channel; empty for the whole file.
    pub place: String,
    /// Stable kebab-case name of the rule, such as `verify-hash`.
    pub rule: &'static str,
    /// What is wrong, with the values.
    pub message: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let colon = if self.place.is_empty() { "" } else { ", " };
        write!(f, "{}{colon}{}: {} [{}]", self.file, self.place, self.message, self.rule)
    }
}

/// What was checked and what was found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VerifyReport {
    /// The first findings, in the order of the checks.
    pub findings: Vec<Finding>,
    /// Number of all findings.
    pub found: u64,
    /// Files whose hash was checked.
    pub files: u64,
    /// Their bytes.
    pub bytes: u64,
    /// Flights whose frames and log were checked.
    pub flights: u64,
    /// Their frames.
    pub frames: u64,
    /// Frames whose stored boxes were compared with the reprojected body and with the images.
    pub boxes: u64,
}

impl VerifyReport {
    /// Whether nothing was found.
    pub fn is_sound(&self) -> bool {
        self.found == 0
    }

    /// Notes a finding.
    pub(super) fn find(
        &mut self,
        file: &str,
        place: impl Into<String>,
        rule: &'static str,
        message: impl Into<String>,
    ) {
        self.found += 1;
        if self.findings.len() < KEPT_FINDINGS {
            self.findings.push(Finding { file: file.to_owned(), place: place.into(), rule, message: message.into() });
        }
    }
}
