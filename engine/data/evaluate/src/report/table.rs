//! Markdown tables whose columns line up, and numbers in them.

use super::score::Score;
use cosfly_metrics::scores::{Metric, Unit};

/// A table: the first column is words, the others are numbers.
pub fn table(head: &[String], rows: &[Vec<String>]) -> String {
    let widths: Vec<usize> = (0..head.len())
        .map(|column| {
            rows.iter()
                .chain([&head.to_vec()])
                .filter_map(|row| row.get(column))
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
        })
        .map(|width| width.max(3))
        .collect();
    let line = |cells: &[String]| {
        let padded = cells.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            let gap = " ".repeat(width.saturating_sub(cell.chars().count()));
            if column == 0 { format!(" {cell}{gap} ") } else { format!(" {gap}{cell} ") }
        });
        format!("|{}|\n", padded.collect::<Vec<_>>().join("|"))
    };
    let rule = widths.iter().enumerate().map(|(column, width)| {
        if column == 0 { format!(" {} ", "-".repeat(*width)) } else { format!(" {}: ", "-".repeat(width - 1)) }
    });
    let mut text = line(head);
    text.push_str(&format!("|{}|\n", rule.collect::<Vec<_>>().join("|")));
    rows.iter().for_each(|row| text.push_str(&line(row)));
    text
}

/// A value in the unit of its metric.
pub fn number(metric: &Metric, value: f64) -> String {
    match metric.unit {
        Unit::Share => format!("{:.1}", 100.0 * value),
        Unit::Degrees => format!("{value:.2}"),
        Unit::Metres | Unit::Mixed | Unit::Plain => format!("{value:.3}"),
    }
}

/// A score, with its interval when asked for and known.
pub fn score(metric: &Metric, score: Option<&Score>, with_interval: bool) -> String {
    match score {
        None => "-".to_owned(),
        Some(Score { value, low: Some(low), high: Some(high) }) if with_interval => {
            format!("{} [{}, {}]", number(metric, *value), number(metric, *low), number(metric, *high))
        }
        Some(score) => number(metric, score.value),
    }
}

/// The name of a metric with its unit.
pub fn title(metric: &Metric) -> String {
    let unit = match metric.unit {
        Unit::Share => " %",
        Unit::Metres => " m",
        Unit::Degrees => " deg",
        Unit::Mixed | Unit::Plain => "",
    };
    format!("{}{unit}", metric.name)
}
