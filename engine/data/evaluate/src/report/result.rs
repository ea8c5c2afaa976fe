//! The result of an evaluation.

use super::score::Scores;
use crate::settings::Settings;
use cosfly_metrics::baselines::Anchor;
use cosfly_metrics::{METRICS, Metric};
use cosfly_read::predictions::RowProblem;
use serde::Serialize;
use std::collections::BTreeMap;

/// The result of an evaluation; serialised it is the JSON report.
#[derive(Clone, Debug, Serialize)]
pub struct Evaluation {
    /// `cosfly-evaluation`.
    pub format: &'static str,
    /// Version of the format.
    pub version: u32,
    /// Choices of the evaluation.
    pub settings: Settings,
    /// Dataset and splits that were scored.
    pub dataset: DatasetFacts,
    /// Rows of predictions; null for baselines alone.
    pub rows: Option<RowFacts>,
    /// Numbers of windows.
    pub windows: WindowFacts,
    /// Definitions of the metrics.
    pub metrics: Vec<Metric>,
    /// Predictions first, then baselines.
    pub methods: Vec<MethodReport>,
    /// Results of these methods with increments that start at the other pose: input's or expert's.
    pub other_anchor: AnchorReport,
    /// Remarks for the reader, such as baselines that are left out.
    pub notes: Vec<String>,
    /// Whether windows without a prediction are left out of the scores.
    pub is_partial: bool,
}

/// Dataset and splits that were scored.
#[derive(Clone, Debug, Serialize)]
pub struct DatasetFacts {
    /// Name of the dataset.
    pub name: String,
    /// Names of the scored splits.
    pub splits: Vec<String>,
    /// Flights with windows.
    pub flights: usize,
    /// Groups of flights that are resampled together.
    pub clusters: usize,
}

/// Rows of predictions: read, scored, left out.
#[derive(Clone, Debug, Serialize)]
pub struct RowFacts {
    /// Name of the predictions' file.
    pub file: String,
    /// Rows of the file.
    pub read: u64,
    /// Rows that were scored.
    pub scored: u64,
    /// Rows of flights in other splits.
    pub elsewhere: u64,
    /// Rows that could not be scored.
    pub malformed: u64,
    /// Malformed rows by kind of problem.
    pub kinds: BTreeMap<&'static str, u64>,
    /// All malformed rows.
    pub problems: Vec<RowProblem>,
}

/// Numbers of windows.
#[derive(Clone, Debug, Serialize)]
pub struct WindowFacts {
    /// Windows of the scored splits.
    pub expected: usize,
    /// Windows behind the scores.
    pub scored: usize,
    /// Windows without a prediction.
    pub without_prediction: usize,
}

/// Scores of a method.
#[derive(Clone, Debug, Serialize)]
pub struct MethodReport {
    /// Name of the method.
    pub name: String,
    /// Scores over all windows.
    pub scores: Scores,
    /// Mean distance from the truth at each waypoint, metres.
    pub by_step_m: Vec<f64>,
    /// By kind of stratum, then by stratum; empty ones are left out.
    pub strata: BTreeMap<&'static str, BTreeMap<&'static str, StratumReport>>,
}

/// Scores over all windows with another anchor than that of the settings.
#[derive(Clone, Debug, Serialize)]
pub struct AnchorReport {
    /// Pose that the first increment starts from.
    pub anchor: Anchor,
    /// Predictions first, then baselines.
    pub methods: Vec<AnchoredMethod>,
}

/// Scores of a method over all windows.
#[derive(Clone, Debug, Serialize)]
pub struct AnchoredMethod {
    /// Name of the method.
    pub name: String,
    /// Scores over all windows.
    pub scores: Scores,
}

/// Scores of a method in a stratum.
#[derive(Clone, Debug, Serialize)]
pub struct StratumReport {
    /// Windows in the stratum.
    pub windows: usize,
    /// Groups of flights with such windows.
    pub clusters: usize,
    /// Scores over the stratum's windows.
    pub scores: Scores,
}

impl Evaluation {
    /// Whether something that was handed in, or was not, keeps the scores from being those of the whole.
    pub fn has_problems(&self) -> bool {
        self.is_partial || self.rows.as_ref().is_some_and(|rows| rows.malformed > 0)
    }

    /// The JSON report.
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// The metric called `key`.
pub(super) fn metric(key: &str) -> Option<&'static Metric> {
    METRICS.iter().find(|metric| metric.key == key)
}
