//! The result of an evaluation, and its forms.

pub(crate) mod drawing;
mod markdown;
mod plot;
mod table;

pub(crate) use table::{number, score, table, title};

use crate::settings::Settings;
use crate::study::Study;
use cosfly_metrics::{METRICS, Metric};
use cosfly_read::predictions::RowProblem;
use serde::Serialize;
use std::collections::BTreeMap;

/// Everything that an evaluation found; serialised it is the JSON report.
#[derive(Clone, Debug, Serialize)]
pub struct Evaluation {
    /// `cosfly-evaluation`.
    pub format: &'static str,
    /// Version of the format.
    pub version: u32,
    /// Choices.
    pub settings: Settings,
    /// What was scored.
    pub dataset: DatasetFacts,
    /// What was handed in; null for baselines alone.
    pub rows: Option<RowFacts>,
    /// Windows.
    pub windows: WindowFacts,
    /// Definitions.
    pub metrics: Vec<Metric>,
    /// Predictions first, then baselines.
    pub methods: Vec<MethodReport>,
    /// Networks that test two findings of the paper; null unless asked for.
    pub study: Option<Study>,
    /// What a reader has to know.
    pub notes: Vec<String>,
}

/// What was scored.
#[derive(Clone, Debug, Serialize)]
pub struct DatasetFacts {
    /// Name of its folder.
    pub name: String,
    /// Splits.
    pub splits: Vec<String>,
    /// Flights with windows in them.
    pub flights: usize,
    /// Groups of flights that are resampled together.
    pub clusters: usize,
}

/// What became of the rows of predictions.
#[derive(Clone, Debug, Serialize)]
pub struct RowFacts {
    /// Name of the file.
    pub file: String,
    /// Rows in it.
    pub read: u64,
    /// Rows that were scored.
    pub scored: u64,
    /// Rows of flights in other splits.
    pub elsewhere: u64,
    /// Rows that could not be scored.
    pub malformed: u64,
    /// How many of each kind.
    pub kinds: BTreeMap<&'static str, u64>,
    /// All of them.
    pub problems: Vec<RowProblem>,
}

/// Windows.
#[derive(Clone, Debug, Serialize)]
pub struct WindowFacts {
    /// Windows of the scored splits.
    pub expected: usize,
    /// Windows behind the scores.
    pub scored: usize,
    /// Windows without a prediction.
    pub without_prediction: usize,
}

/// What a method scores.
#[derive(Clone, Debug, Serialize)]
pub struct MethodReport {
    /// Name.
    pub name: String,
    /// Of all windows.
    pub scores: Scores,
    /// Mean distance from the truth at each waypoint, metres.
    pub by_step_m: Vec<f64>,
    /// By kind of stratum, then by stratum; empty ones are left out.
    pub strata: BTreeMap<&'static str, BTreeMap<&'static str, StratumReport>>,
}

/// What a method scores in a stratum.
#[derive(Clone, Debug, Serialize)]
pub struct StratumReport {
    /// Windows in it.
    pub windows: usize,
    /// Groups of flights with such windows.
    pub clusters: usize,
    /// Scores.
    pub scores: Scores,
}

/// Scores by the keys of metrics; those of which there is nothing are left out.
pub type Scores = BTreeMap<&'static str, Score>;

/// A score with the interval that holds it with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Score {
    /// The mean.
    pub value: f64,
    /// Lower end; null for fewer than two groups of flights.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

impl Evaluation {
    /// The JSON report.
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// The metric called `key`.
fn metric(key: &str) -> Option<&'static Metric> {
    METRICS.iter().find(|metric| metric.key == key)
}
