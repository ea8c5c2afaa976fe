//! The result of an evaluation of pictures, and its forms.

use super::settings::PictureSettings;
use crate::report::result::DatasetFacts;
use crate::report::score::Scores;
use cosfly_metrics::Metric;
use serde::Serialize;
use std::collections::BTreeMap;

/// Everything that was found; serialised it is the JSON report.
#[derive(Clone, Debug, Serialize)]
pub struct PictureEvaluation {
    /// `cosfly-picture-evaluation`.
    pub format: &'static str,
    /// Version of the format.
    pub version: u32,
    /// Choices.
    pub settings: PictureSettings,
    /// Dataset and splits that were scored.
    pub dataset: DatasetFacts,
    /// Files or rows of predictions.
    pub files: FileFacts,
    /// Frames.
    pub frames: FrameFacts,
    /// Definitions.
    pub metrics: Vec<Metric>,
    /// Scores of all scored frames.
    pub scores: Scores,
    /// Kinds of frames in the order of tables.
    #[serde(skip)]
    pub kinds: Vec<(&'static str, String)>,
    /// By kind of frame; empty ones are left out.
    pub strata: BTreeMap<&'static str, BTreeMap<String, KindReport>>,
    /// Class by class; none for depth.
    pub classes: Vec<ClassReport>,
    /// Depth by true distance; none for others.
    pub distances: Vec<DistanceReport>,
    /// Sequence by sequence, for trackers alone.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sequences: Vec<SequenceReport>,
    /// Remarks for the reader.
    pub notes: Vec<String>,
    /// Whether the scores are of less than was expected: frames without a prediction, or no detection at all.
    pub is_partial: bool,
}

/// Files of predictions, or rows of a file: read, scored, left out.
#[derive(Clone, Debug, Serialize)]
pub struct FileFacts {
    /// Name of what was handed in.
    pub name: String,
    /// Pictures, or rows.
    pub read: u64,
    /// Those that were scored.
    pub scored: u64,
    /// Those of flights in other splits, or of frames and classes that were not asked for.
    pub elsewhere: u64,
    /// Files that are no pictures, or pictures of another kind.
    pub passed_over: u64,
    /// Those that could not be scored.
    pub malformed: u64,
    /// How many of each kind.
    pub kinds: BTreeMap<&'static str, u64>,
    /// All of them.
    pub problems: Vec<FileProblem>,
}

/// A file, or a row, that could not be scored.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct FileProblem {
    /// Path from the folder that was handed in, or `line 7`.
    pub place: String,
    /// Short kebab-case name of what kind of problem it is.
    pub kind: &'static str,
    /// Problem, in words.
    pub reason: String,
}

impl FileProblem {
    /// A problem of what is at `place`.
    pub fn new(place: impl std::fmt::Display, kind: &'static str, reason: impl Into<String>) -> Self {
        Self { place: place.to_string(), kind, reason: reason.into() }
    }
}

/// Frames.
#[derive(Clone, Debug, Serialize)]
pub struct FrameFacts {
    /// Frames of the scored splits.
    pub expected: usize,
    /// Frames behind the scores.
    pub scored: usize,
    /// Frames that have no prediction, by trajectory: lists of numbers and ranges such as `0-4, 7`.
    pub missing: BTreeMap<String, String>,
    /// How many these are.
    pub without_prediction: usize,
    /// Predicted pixels in them that are neither depths nor labels.
    pub nonsense: Nonsense,
}

/// Pixels whose predicted depth is not a number, below 0 or implausibly large, or whose label CARLA does not have. They
/// count as wrong.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Nonsense {
    /// Pixels among those that are scored.
    pub pixels: u64,
    /// Frames with such pixels.
    pub frames: usize,
    /// Path of the first of them, from the folder that was handed in.
    pub first: Option<String>,
}

/// Scores of a kind of frames.
#[derive(Clone, Debug, Serialize)]
pub struct KindReport {
    /// Frames in it.
    pub frames: usize,
    /// Groups of flights with such frames.
    pub clusters: usize,
    /// Scores.
    pub scores: Scores,
}

/// Scores of a class.
#[derive(Clone, Debug, Serialize)]
pub struct ClassReport {
    /// CARLA's label; for tracks MOTChallenge's class.
    pub id: u8,
    /// Name of the class.
    pub name: &'static str,
    /// True pixels, or true things.
    pub truth: u64,
    /// Scores.
    pub scores: BTreeMap<&'static str, f64>,
}

/// Scores of a tracker on a sequence, for trackers of many bodies in a class.
#[derive(Clone, Debug, Serialize)]
pub struct SequenceReport {
    /// Name of the sequence.
    pub sequence: String,
    /// Its flight.
    pub trajectory_id: String,
    /// Split of the flight.
    pub split: String,
    /// Class of the bodies; none for the target.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub class: Option<&'static str>,
    /// Pictures of the sequence.
    pub pictures: usize,
    /// True boxes.
    pub truth: u64,
    /// Scores.
    pub scores: BTreeMap<&'static str, f64>,
}

/// Depth errors of pixels in a range of true depths, over all images at once.
#[derive(Clone, Debug, Serialize)]
pub struct DistanceReport {
    /// From, metres.
    pub from_m: f64,
    /// To, metres.
    pub to_m: f64,
    /// Pixels.
    pub pixels: u64,
    /// Mean of |predicted - true| / true.
    pub abs_rel: f64,
}

impl PictureEvaluation {
    /// Whether something that was handed in, or was not, keeps the scores from being those of the whole.
    pub fn has_problems(&self) -> bool {
        self.is_partial || self.files.malformed > 0
    }

    /// Kinds of frames that there are, as they are called in tables, in order.
    pub fn strata_in_order(&self) -> impl Iterator<Item = (String, &KindReport)> {
        let report = |(kind, name): &(&'static str, String)| {
            Some((format!("{kind}: {name}"), self.strata.get(kind)?.get(name)?))
        };
        self.kinds.iter().filter_map(report)
    }

    /// Sequences, those with the lowest first score first.
    pub fn worst_sequences(&self) -> Vec<&SequenceReport> {
        let first = self.metrics.first().map_or("", |metric| metric.key);
        let score = |report: &SequenceReport| report.scores.get(first).copied().unwrap_or(0.0);
        let mut sequences: Vec<&SequenceReport> = self.sequences.iter().collect();
        sequences.sort_by(|a, b| score(a).total_cmp(&score(b)));
        sequences
    }

    /// The JSON report.
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// Numbers as a list of single ones and ranges: `0-4, 7`.
pub fn ranges(numbers: &[usize]) -> String {
    let mut parts: Vec<[usize; 2]> = vec![];
    for number in numbers {
        match parts.last_mut() {
            Some([_, last]) if *last + 1 == *number => *last = *number,
            _ => parts.push([*number; 2]),
        }
    }
    let part = |[first, last]: &[usize; 2]| if first == last { first.to_string() } else { format!("{first}-{last}") };
    parts.iter().map(part).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_a_range() {
        assert_eq!(ranges(&[0, 1, 2, 5, 7, 8]), "0-2, 5, 7-8");
        assert_eq!(ranges(&[]), "");
    }
}
