//! Scores with their intervals.

use serde::Serialize;
use std::collections::BTreeMap;

/// Scores by the keys of metrics; metrics without a value are left out.
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
