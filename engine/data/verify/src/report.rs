//! Findings of a check.

use serde::{Deserialize, Serialize};
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
    /// Problem, with the values.
    pub message: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let colon = if self.place.is_empty() { "" } else { ", " };
        write!(f, "{}{colon}{}: {} [{}]", self.file, self.place, self.message, self.rule)
    }
}

/// A frame in which rays and pixels tell different shares of the target visible: no problem, but worth a look.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LabelGap {
    /// File, from the dataset's folder.
    pub file: String,
    /// Row, flight and frame.
    pub place: String,
    /// `visible_by_dense_rays`.
    pub by_rays: f64,
    /// `visible_by_pixels`.
    pub by_pixels: f64,
    /// Why, as far as the tables tell.
    pub reason: String,
}

impl fmt::Display for LabelGap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, place, by_rays, by_pixels, reason } = self;
        write!(f, "{file}, {place}: {by_rays:.2} visible by rays, {by_pixels:.2} by pixels; {reason}")
    }
}

/// Numbers of checked things, and findings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VerifyReport {
    /// The first findings, in the order of the checks.
    pub findings: Vec<Finding>,
    /// Number of all findings.
    pub found: u64,
    /// Files whose hash was checked.
    pub files: u64,
    /// Bytes of the checked files.
    pub bytes: u64,
    /// Flights whose frames and log were checked.
    pub flights: u64,
    /// Flights of the dataset.
    pub flights_of_dataset: u64,
    /// Number of flights in the sample, where only a sample was checked in full.
    pub sample: Option<u64>,
    /// Flights of these that an earlier check had found sound.
    pub resumed: u64,
    /// Frames of the checked flights.
    pub frames: u64,
    /// Frames whose stored boxes were compared with the reprojected body and with the images.
    pub boxes: u64,
    /// Frames whose visible shares by rays and by pixels were compared.
    pub labels: u64,
    /// Flights that were compared with the mesh of a scan.
    pub meshed: u64,
    /// Frames in which those are more than 5 points apart.
    pub gaps: u64,
    /// The first of them, in the order of the rows.
    pub label_gaps: Vec<LabelGap>,
}

impl VerifyReport {
    /// Whether nothing was found.
    pub fn is_sound(&self) -> bool {
        self.found == 0
    }

    /// Adds the numbers and findings of a later part of the check.
    pub(super) fn absorb(&mut self, part: Self) {
        self.found += part.found;
        self.sample = self.sample.or(part.sample);
        let room = KEPT_FINDINGS.saturating_sub(self.findings.len());
        self.findings.extend(part.findings.into_iter().take(room));
        self.files += part.files;
        self.bytes += part.bytes;
        self.flights += part.flights;
        self.frames += part.frames;
        self.boxes += part.boxes;
        self.labels += part.labels;
        self.gaps += part.gaps;
        self.meshed += part.meshed;
        self.resumed += part.resumed;
        let room = KEPT_FINDINGS.saturating_sub(self.label_gaps.len());
        self.label_gaps.extend(part.label_gaps.into_iter().take(room));
    }

    /// Notes a frame whose labels differ.
    pub(super) fn note_gap(&mut self, gap: LabelGap) {
        self.gaps += 1;
        if self.label_gaps.len() < KEPT_FINDINGS {
            self.label_gaps.push(gap);
        }
    }

    /// Notes what keeps a file from being read, unless a check before found it.
    pub(super) fn find_damage(&mut self, file: &str, message: String) {
        if self.findings.iter().all(|it| it.file != file || it.rule != "verify-schema") {
            self.find(file, "", "verify-schema", message);
        }
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
