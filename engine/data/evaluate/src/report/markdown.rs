//! The report for people.

use super::result::{Evaluation, MethodReport, RowFacts, metric};
use super::score::Scores;
use super::table::{score, table, title};
use crate::strata::STRATA;
use cosfly_diagnose::counted;
use cosfly_metrics::baselines::Anchor;
use cosfly_metrics::{METRICS, Metric};
use cosfly_plot::text::{markdown, markdown_code, markdown_words};
use std::fmt::Write;

/// Malformed rows that are shown; the JSON report has all.
const SHOWN: usize = 5;
/// Metrics of the table of strata.
const OF_STRATA: [&str; 6] = ["sr_1m", "ade_m", "fde_m", "rot_acc_1deg", "yaw_mae_deg", "miou"];

impl Evaluation {
    /// The Markdown report.
    pub fn to_markdown(&self) -> String {
        report(self)
    }
}

/// The whole page.
fn report(evaluation: &Evaluation) -> String {
    let mut text = String::new();
    let first = evaluation.methods.first();
    let of_what = evaluation.rows.as_ref().map_or("baselines".to_owned(), |rows| markdown_code(&rows.file));
    let _ = writeln!(text, "# Evaluation of {of_what} on {}\n", markdown_code(&evaluation.dataset.name));
    if evaluation.is_partial {
        let (missing, all) = (evaluation.windows.without_prediction, evaluation.windows.expected);
        let _ = writeln!(
            text,
            "**Partial: {missing} of {} without a prediction. The scores are of the others alone, and no scores of \
             this dataset.** `--missing-as-zero` counts them as standing still.\n",
            counted(all, "window")
        );
    }
    text.push_str(&facts(evaluation));
    let _ = writeln!(text, "\n## All windows\n");
    let methods = evaluation.methods.iter().map(|method| (method.name.as_str(), &method.scores));
    text.push_str(&overall(&methods.collect::<Vec<_>>()));
    let other = &evaluation.other_anchor;
    let _ = writeln!(
        text,
        "\n## The same windows with `--anchor {}`\n\nThe first increment starts at {}. With `expert` the \
         displacement of a perturbed input does not count. The paper does not say which it takes; its untrained models \
         have the scores of `expert`.\n",
        format!("{:?}", other.anchor).to_lowercase(),
        start_of(other.anchor)
    );
    let methods = other.methods.iter().map(|method| (method.name.as_str(), &method.scores));
    text.push_str(&overall(&methods.collect::<Vec<_>>()));
    if let Some(first) = first {
        let _ = writeln!(text, "\n## By kind of window: {}\n", first.name);
        text.push_str(&strata(first, evaluation));
    }
    if let Some(rows) = evaluation.rows.as_ref().filter(|rows| rows.malformed > 0) {
        text.push_str(&malformed(rows));
    }
    if !evaluation.notes.is_empty() {
        let _ = writeln!(text, "\n## Notes\n");
        evaluation.notes.iter().for_each(|note| text.push_str(&format!("- {note}\n")));
    }
    text
}

fn facts(evaluation: &Evaluation) -> String {
    let (settings, dataset, windows) = (&evaluation.settings, &evaluation.dataset, &evaluation.windows);
    let mut text = String::new();
    let shape = &settings.window;
    let _ = writeln!(
        text,
        "{} of {} ({}, split {}), {} in, {} out, {}.",
        windows.scored,
        counted(windows.expected, "window"),
        counted(dataset.flights, "flight"),
        markdown(&dataset.splits.join(" and ")),
        counted(shape.history, "frame"),
        counted(shape.horizon, "waypoint"),
        if shape.stride == 1 { "every frame".to_owned() } else { format!("every {} frames", shape.stride) }
    );
    if let Some(rows) = &evaluation.rows {
        let _ = writeln!(
            text,
            "{}: {} scored, {} malformed, {} of other splits; {} without a prediction{}.",
            counted(rows.read, "row"),
            rows.scored,
            rows.malformed,
            rows.elsewhere,
            counted(windows.without_prediction, "window"),
            if windows.without_prediction == 0 {
                ""
            } else if settings.missing_as_zero {
                ", counted as predict-zero"
            } else {
                ", left out"
            }
        );
    }
    let _ = writeln!(
        text,
        "Increments are along the {} axes, from the {}; the first one starts at {}.",
        format!("{:?}", settings.delta_frame).to_lowercase(),
        match settings.delta_origin {
            cosfly_metrics::DeltaOrigin::Previous => "waypoint before",
            cosfly_metrics::DeltaOrigin::Current => "current pose",
        },
        start_of(settings.anchor)
    );
    let _ = writeln!(
        text,
        "In brackets: 95 % intervals, {} resamples of {} groups of trajectories (one pedestrian each).",
        settings.resamples, dataset.clusters
    );
    text
}

/// Words for the pose that the first increment starts from.
fn start_of(anchor: Anchor) -> &'static str {
    match anchor {
        Anchor::Input => "the pose of the input's last frame",
        Anchor::Expert => "the expert's pose in that frame",
    }
}

/// Scores of methods, a column each.
fn overall(methods: &[(&str, &Scores)]) -> String {
    let head = ["metric".to_owned()].into_iter().chain(methods.iter().map(|(name, _)| (*name).to_owned()));
    let rows = METRICS.iter().filter(|metric| methods.iter().any(|(_, scores)| scores.contains_key(metric.key)));
    let row = |metric: &Metric| {
        let cells = methods.iter().enumerate();
        let cells = cells.map(|(place, (_, scores))| score(metric, scores.get(metric.key), place == 0));
        [title(metric)].into_iter().chain(cells).collect::<Vec<_>>()
    };
    table(&head.collect::<Vec<_>>(), &rows.map(row).collect::<Vec<_>>())
}

fn strata(method: &MethodReport, evaluation: &Evaluation) -> String {
    let metrics: Vec<_> = OF_STRATA
        .iter()
        .filter_map(|key| metric(key))
        .filter(|metric| method.scores.contains_key(metric.key))
        .collect();
    let head = ["kind".to_owned(), "windows".to_owned(), "groups".to_owned()].into_iter();
    let head = head.chain(metrics.iter().map(|metric| title(metric))).collect::<Vec<_>>();
    let mut rows = vec![];
    for (kind, name) in STRATA {
        let Some(stratum) = method.strata.get(kind).and_then(|names| names.get(name)) else { continue };
        let cells = metrics.iter().map(|metric| score(metric, stratum.scores.get(metric.key), true));
        let first = [format!("{kind}: {name}"), stratum.windows.to_string(), stratum.clusters.to_string()];
        rows.push(first.into_iter().chain(cells).collect::<Vec<_>>());
    }
    let mut text = table(&head, &rows);
    if evaluation.methods.len() > 1 {
        text.push_str("\nThe JSON report has the strata of every method.\n");
    }
    text
}

fn malformed(rows: &RowFacts) -> String {
    let kinds: Vec<String> = rows.kinds.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    let mut text = format!(
        "\n## Malformed rows\n\n{} of {}: {}.\n\n",
        rows.malformed,
        counted(rows.read, "row"),
        kinds.join(", ")
    );
    for problem in rows.problems.iter().take(SHOWN) {
        let _ = writeln!(text, "- line {}: {}", problem.line, markdown_words(&problem.reason));
    }
    if rows.problems.len() > SHOWN {
        let _ = writeln!(text, "- and {} more, all in the JSON report", rows.problems.len() - SHOWN);
    }
    text
}
