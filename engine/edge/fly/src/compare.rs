//! Two results side by side: differences over the same episodes, with intervals of a paired bootstrap.

use crate::flight::Row;
use crate::results::{METRICS, Metric, mean_of};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_metrics::bootstrap::{RESAMPLES, resampled};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Seed of the resamples.
const SEED: u64 = 1;

/// A metric of two results over the same episodes.
#[derive(Clone, Debug, PartialEq)]
pub struct MetricDifference {
    /// Name of the metric.
    pub name: &'static str,
    /// Episodes where it is defined in both.
    pub episodes: usize,
    /// Means of the first and the second result over those.
    pub means: [f64; 2],
    /// Interval of the second mean minus the first: 95 % over resamples of pairs; `None` with fewer than two.
    pub interval: Option<(f64, f64)>,
}

impl MetricDifference {
    /// Second mean minus the first.
    pub fn difference(&self) -> f64 {
        self.means[1] - self.means[0]
    }

    /// Whether the interval leaves out 0.
    pub fn is_clear(&self) -> bool {
        self.interval.is_some_and(|(low, high)| low > 0.0 || high < 0.0)
    }
}

/// Differences in all metrics over the episodes that both results have.
///
/// # Errors
/// `fly-compare` where they have no episode in common.
pub fn compare(first: &[Row], second: &[Row]) -> Result<Vec<MetricDifference>> {
    let pairs = pairs(first, second);
    if pairs.is_empty() {
        return Err(Diagnostic::new("fly-compare", Fault::Input, "the two results have no episode in common"));
    }
    Ok(METRICS.iter().filter_map(|metric| difference(metric, &pairs)).collect())
}

/// Rows of the episodes that both results have.
pub fn pairs<'a>(first: &'a [Row], second: &'a [Row]) -> Vec<(&'a Row, &'a Row)> {
    let others: BTreeMap<&str, &Row> = second.iter().map(|row| (row.episode.as_str(), row)).collect();
    first.iter().filter_map(|row| Some((row, *others.get(row.episode.as_str())?))).collect()
}

/// Difference in a metric over pairs of rows; `None` where no pair has it.
pub fn difference(metric: &Metric, pairs: &[(&Row, &Row)]) -> Option<MetricDifference> {
    let both = |(a, b): &(&Row, &Row)| Some([(metric.of)(a)?, (metric.of)(b)?]);
    let values: Vec<[f64; 2]> = pairs.iter().filter_map(both).collect();
    if values.is_empty() {
        return None;
    }
    let column = |at: usize| values.iter().map(|pair| Some(pair[at])).collect::<Vec<_>>();
    let apart: Vec<Option<f64>> = values.iter().map(|pair| Some(pair[1] - pair[0])).collect();
    let once = vec![1; values.len()];
    let means = [0, 1].map(|at| mean_of(&column(at), &once).unwrap_or(f64::NAN));
    let mut intervals =
        resampled(values.len(), RESAMPLES, SEED, 1, &mut |times| vec![mean_of(&apart, times)]).into_iter();
    let interval = intervals.next().flatten();
    Some(MetricDifference { name: metric.name, episodes: values.len(), means, interval })
}

/// The differences, for people.
pub fn told(names: [&str; 2], differences: &[MetricDifference]) -> String {
    let mut text = format!(
        "{:<20}  {:>8}  {:>10}  {:>10}  {:>10}  95 % interval\n",
        "metric", "episodes", "first", "second", "change"
    );
    for it in differences {
        let decimals = METRICS.iter().find(|metric| metric.name == it.name).map_or(3, |metric| metric.decimals);
        let ([first, second], change) = (it.means, it.difference());
        let _ = write!(
            text,
            "{:<20}  {:>8}  {first:>10.decimals$}  {second:>10.decimals$}  {change:>+10.decimals$}  ",
            it.name, it.episodes
        );
        let mark = if it.is_clear() { " *" } else { "" };
        let _ = match it.interval {
            Some((low, high)) => writeln!(text, "[{low:+.decimals$}, {high:+.decimals$}]{mark}"),
            None => writeln!(text, "-"),
        };
    }
    let [first, second] = names;
    let _ = writeln!(text, "\nfirst: {first}, second: {second}; * the interval leaves out 0");
    text
}

/// The differences, for programs.
pub fn json(names: [&str; 2], differences: &[MetricDifference]) -> String {
    let entry = |it: &MetricDifference| {
        let interval = it.interval.map(|(low, high)| [low, high]);
        let value = json!({
            "episodes": it.episodes, "first": it.means[0], "second": it.means[1],
            "difference": it.difference(), "interval_95": interval,
        });
        (it.name.to_owned(), value)
    };
    let metrics: Map<String, Value> = differences.iter().map(entry).collect();
    format!("{:#}\n", json!({ "first": names[0], "second": names[1], "metrics": metrics }))
}
