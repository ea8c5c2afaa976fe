//! Tables of results: Markdown for people, JSON for programs.

use super::card::Card;
use super::metrics::{METRICS, Metric, MetricSummary, strata, summary};
use crate::flight::Row;
use cosfly_diagnose::counted;
use cosfly_env::End;
use cosfly_plot::text::{markdown as in_markdown, markdown_code, markdown_words};
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

/// Metrics, for programs.
pub fn of_summaries(summaries: &[MetricSummary]) -> Value {
    let entry = |(metric, summary): (&Metric, &MetricSummary)| {
        let interval = summary.interval.map(|(low, high)| [low, high]);
        (metric.name.to_owned(), json!({ "mean": summary.mean, "interval_95": interval, "episodes": summary.count }))
    };
    Value::Object(METRICS.iter().zip(summaries).map(entry).collect())
}

/// A mean and its interval, for people.
pub fn cell(metric: &Metric, summary: &MetricSummary) -> String {
    let decimals = metric.decimals;
    match (summary.mean, summary.interval) {
        (None, _) => "-".to_owned(),
        (Some(mean), Some((low, high))) => format!("{mean:.decimals$} [{low:.decimals$}, {high:.decimals$}]"),
        (Some(mean), None) => format!("{mean:.decimals$}"),
    }
}

/// How an episode ended, in words.
pub fn ending(row: &Row) -> String {
    let after_s = f64::from(row.score.steps) * row.step_s;
    match row.score.end {
        _ if row.policy_failure.is_some() => format!("the policy failed after {after_s:.1} s"),
        Some(End::Finished) => "flown to the end".to_owned(),
        Some(End::Collision) => format!("collision after {after_s:.1} s"),
        Some(End::Lost) => format!("given up after {after_s:.1} s"),
        None => "not flown".to_owned(),
    }
}

/// The episodes with the lowest tracking rates, the lowest first.
pub fn worst(rows: &[Row], count: usize) -> Vec<&Row> {
    let mut worst: Vec<&Row> = rows.iter().collect();
    worst.sort_by(|a, b| a.score.tracking_rate().total_cmp(&b.score.tracking_rate()));
    worst.truncate(count);
    worst
}

/// The report of one policy.
pub fn markdown(card: &Card, rows: &[Row]) -> String {
    let mut text = format!("# {} on {}\n\n", markdown_code(&card.policy.name), markdown_code(&card.suite.name));
    let _ = writeln!(
        text,
        "{}, suite {}. Means with 95 % intervals over resampled episodes.\n",
        counted(rows.len(), "episode"),
        card.suite.hash
    );
    if card.is_measured() {
        text.push_str("Latencies are measured: another run gives other numbers.\n\n");
    }
    let groups = strata(rows);
    let several = groups.len() > 1;
    let all = summary(&rows.iter().collect::<Vec<_>>());
    let groups: Vec<(&str, Vec<MetricSummary>)> =
        groups.into_iter().filter(|_| several).map(|(name, rows)| (name, summary(&rows))).collect();
    let _ = write!(text, "| metric | all |");
    groups.iter().for_each(|(name, _)| _ = write!(text, " {} |", in_markdown(name)));
    let _ = writeln!(text, "\n| --- | --- |{}", " --- |".repeat(groups.len()));
    for (at, metric) in METRICS.iter().enumerate().filter(|(at, _)| all[*at].count > 0) {
        let _ = write!(text, "| {} | {} |", metric.title, cell(metric, &all[at]));
        groups.iter().for_each(|(_, group)| _ = write!(text, " {} |", cell(metric, &group[at])));
        text.push('\n');
    }
    let failures: Vec<&Row> = rows.iter().filter(|row| row.policy_failure.is_some()).collect();
    if !failures.is_empty() {
        let _ = writeln!(text, "\n## Episodes that the policy ended\n");
        for row in failures.iter().take(MOST_FAILURES) {
            let reason = markdown_words(row.policy_failure.as_deref().unwrap_or_default());
            let _ = writeln!(text, "* {}: {reason}", in_markdown(&row.episode));
        }
        if failures.len() > MOST_FAILURES {
            let _ = writeln!(text, "* ... and {} more", failures.len() - MOST_FAILURES);
        }
    }
    let _ = writeln!(text, "\n## Episodes with the lowest tracking rate\n");
    for row in worst(rows, 5) {
        let (name, rate) = (in_markdown(&row.episode), row.score.tracking_rate());
        let _ = writeln!(text, "* {name}: {rate:.3}, {} (logs/{name}.jsonl)", ending(row));
    }
    let _ = writeln!(text, "\n## Metrics\n");
    METRICS.iter().for_each(|metric| _ = writeln!(text, "* {}: {}", metric.title, metric.doc));
    text
}

/// Several policies side by side, a metric per line, in columns that a terminal and Markdown show.
pub fn beside(arms: &[(&str, &[Row])]) -> String {
    let is_known = |metric: &Metric| arms.iter().any(|(_, rows)| rows.iter().any(|row| (metric.of)(row).is_some()));
    let mut lines = vec![vec!["metric".to_owned()], vec!["episodes".to_owned()]];
    lines.extend(METRICS.iter().map(|metric| vec![metric.title.to_owned()]));
    for (name, rows) in arms {
        let summaries = summary(&rows.iter().collect::<Vec<_>>());
        let cells = METRICS.iter().zip(&summaries).map(|(metric, summary)| cell(metric, summary));
        let column = [in_markdown(name), rows.len().to_string()].into_iter().chain(cells);
        lines.iter_mut().zip(column).for_each(|(line, cell)| line.push(cell));
    }
    let is_shown = |at: &usize| at.checked_sub(2).is_none_or(|metric| is_known(&METRICS[metric]));
    let shown: Vec<Vec<String>> = (0..lines.len()).filter(is_shown).map(|at| lines[at].clone()).collect();
    let width = |column: usize| shown.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..=arms.len()).map(width).collect();
    let mut text = String::new();
    for (at, line) in shown.iter().enumerate() {
        line.iter().zip(&widths).for_each(|(cell, width)| _ = write!(text, "| {cell:<width$} "));
        text.push_str("|\n");
        if at == 0 {
            widths.iter().for_each(|width| _ = write!(text, "| {:-<width$} ", ""));
            text.push_str("|\n");
        }
    }
    text
}
