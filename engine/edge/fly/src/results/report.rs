//! Tables of results: Markdown for people, JSON for programs.

use super::card::Card;
use super::metrics::{METRICS, Metric, Summary, strata, summary};
use crate::flight::Row;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// Failures of policies that are listed.
const MOST_FAILURES: usize = 10;

/// All metrics over all episodes and by stratum, for programs.
pub fn scores(rows: &[Row]) -> Value {
    let by_stratum: Map<String, Value> =
        strata(rows).into_iter().map(|(name, rows)| (name.to_owned(), of_summaries(&summary(&rows)))).collect();
    json!({
        "episodes": rows.len(),
        "all": of_summaries(&summary(&rows.iter().collect::<Vec<_>>())),
        "strata": by_stratum,
    })
}

fn of_summaries(summaries: &[Summary]) -> Value {
    let entry = |(metric, summary): (&Metric, &Summary)| {
        let interval = summary.interval.map(|(low, high)| [low, high]);
        (metric.name.to_owned(), json!({ "mean": summary.mean, "interval_95": interval, "episodes": summary.count }))
    };
    Value::Object(METRICS.iter().zip(summaries).map(entry).collect())
}

/// A mean and its interval, for people.
pub fn cell(metric: &Metric, summary: &Summary) -> String {
    let decimals = metric.decimals;
    match (summary.mean, summary.interval) {
        (None, _) => "-".to_owned(),
        (Some(mean), Some((low, high))) => format!("{mean:.decimals$} [{low:.decimals$}, {high:.decimals$}]"),
        (Some(mean), None) => format!("{mean:.decimals$}"),
    }
}

/// The report of one policy.
pub fn markdown(card: &Card, rows: &[Row]) -> String {
    let mut text = format!("# `{}` on `{}`\n\n", card.policy.name, card.suite.name);
    let _ = writeln!(
        text,
        "{} episodes, suite {}. Means with 95 % intervals over resampled episodes.\n",
        rows.len(),
        card.suite.hash
    );
    let groups = strata(rows);
    let several = groups.len() > 1;
    let all = summary(&rows.iter().collect::<Vec<_>>());
    let groups: Vec<(&str, Vec<Summary>)> =
        groups.into_iter().filter(|_| several).map(|(name, rows)| (name, summary(&rows))).collect();
    let _ = write!(text, "| metric | all |");
    groups.iter().for_each(|(name, _)| _ = write!(text, " {name} |"));
    let _ = writeln!(text, "\n| --- | --- |{}", " --- |".repeat(groups.len()));
    for (at, metric) in METRICS.iter().enumerate() {
        let _ = write!(text, "| {} | {} |", metric.title, cell(metric, &all[at]));
        groups.iter().for_each(|(_, group)| _ = write!(text, " {} |", cell(metric, &group[at])));
        text.push('\n');
    }
    let failures: Vec<&Row> = rows.iter().filter(|row| row.policy_failure.is_some()).collect();
    if !failures.is_empty() {
        let _ = writeln!(text, "\n## Episodes that the policy ended\n");
        for row in failures.iter().take(MOST_FAILURES) {
            let reason = row.policy_failure.as_deref().unwrap_or_default().replace('\n', " ");
            let _ = writeln!(text, "* {}: {reason}", row.episode);
        }
        if failures.len() > MOST_FAILURES {
            let _ = writeln!(text, "* ... and {} more", failures.len() - MOST_FAILURES);
        }
    }
    let mut worst: Vec<&Row> = rows.iter().collect();
    worst.sort_by(|a, b| a.score.tracking_rate().total_cmp(&b.score.tracking_rate()));
    let _ = writeln!(text, "\n## Episodes with the lowest tracking rate\n");
    for row in worst.iter().take(5) {
        let end = row.score.end.and_then(|end| serde_json::to_value(end).ok());
        let end = end.as_ref().and_then(Value::as_str).unwrap_or("policy failed").to_owned();
        let _ =
            writeln!(text, "* {}: {:.3}, {end} (logs/{}.jsonl)", row.episode, row.score.tracking_rate(), row.episode);
    }
    let _ = writeln!(text, "\n## Metrics\n");
    METRICS.iter().for_each(|metric| _ = writeln!(text, "* {}: {}", metric.title, metric.doc));
    text
}

/// Several policies side by side.
pub fn beside(arms: &[(&str, &[Row])]) -> String {
    let mut text = String::from("| policy | episodes |");
    METRICS.iter().for_each(|metric| _ = write!(text, " {} |", metric.title));
    let _ = writeln!(text, "\n| --- | --- |{}", " --- |".repeat(METRICS.len()));
    for (name, rows) in arms {
        let _ = write!(text, "| {name} | {} |", rows.len());
        for (metric, summary) in METRICS.iter().zip(summary(&rows.iter().collect::<Vec<_>>())) {
            let _ = write!(text, " {} |", cell(metric, &summary));
        }
        text.push('\n');
    }
    text
}
