//! The report for people.

use super::report::{PictureEvaluation, SequenceReport};
use super::settings::PictureKind;
use crate::report::table::{number, score, table, title};
use cosfly_diagnose::counted;
use cosfly_plot::text::{markdown, markdown_code, markdown_words};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Malformed files or rows, and flights with missing frames, that are shown; the JSON report has all.
const SHOWN: usize = 5;
/// Sequences that are shown.
const WORST: usize = 20;

impl PictureEvaluation {
    /// The Markdown report.
    pub fn to_markdown(&self) -> String {
        report(self)
    }
}

/// The whole page.
fn report(evaluation: &PictureEvaluation) -> String {
    let (settings, dataset) = (&evaluation.settings, &evaluation.dataset);
    let (name, of) = (markdown_code(&evaluation.files.name), markdown_code(&dataset.name));
    let mut text = format!("# Evaluation of {} in {name} on {of}\n\n", settings.kind.name());
    text.push_str(&partial(evaluation));
    text.push_str(&facts(evaluation));
    text.push_str("\n## All frames and kinds of frames\n\n");
    text.push_str(&strata(evaluation));
    text.push_str(&distances(evaluation));
    text.push_str(&classes(evaluation));
    text.push_str(&sequences(evaluation));
    text.push_str(&problems(evaluation));
    if !evaluation.notes.is_empty() {
        text.push_str("\n## Notes\n\n");
        evaluation.notes.iter().for_each(|note| text.push_str(&format!("- {}\n", markdown_words(note))));
    }
    text
}

/// The line above all others where the scores are not those of the whole.
fn partial(evaluation: &PictureEvaluation) -> String {
    let (missing, all) = (evaluation.frames.without_prediction, evaluation.frames.expected);
    match (evaluation.is_partial, missing) {
        (false, _) => String::new(),
        (true, 0) => "**Empty: there is no detection. Everything counts as missed.**\n\n".to_owned(),
        (true, _) => format!(
            "**Partial: {missing} of {} without a prediction. The scores are of the others alone, and no scores of this \
             dataset.**\n\n",
            counted(all, "frame")
        ),
    }
}

fn facts(evaluation: &PictureEvaluation) -> String {
    let (settings, dataset) = (&evaluation.settings, &evaluation.dataset);
    let (files, frames) = (&evaluation.files, &evaluation.frames);
    let unit = match settings.kind {
        PictureKind::Depth | PictureKind::Semantic => "picture",
        PictureKind::Boxes | PictureKind::Masks => "row",
        PictureKind::Tracks | PictureKind::Target => "file",
    };
    let mut text = format!(
        "{} of {} ({}, split {}){}.\n",
        frames.scored,
        counted(frames.expected, "frame"),
        counted(dataset.flights, "flight"),
        markdown(&dataset.splits.join(" and ")),
        if frames.without_prediction > 0 {
            format!(", {} without a prediction left out", counted(frames.without_prediction, "frame"))
        } else {
            String::new()
        }
    );
    let _ = writeln!(
        text,
        "{}: {} scored, {} malformed, {} of other splits, frames or classes; {} passed over.",
        counted(files.read, unit),
        files.scored,
        files.malformed,
        files.elsewhere,
        counted(files.passed_over, "other file")
    );
    if settings.kind == PictureKind::Depth {
        let _ = writeln!(text, "Pixels count whose true depth is at most {} m.", settings.max_depth_m);
    }
    let _ = writeln!(
        text,
        "In brackets: 95 % intervals, {} of {} of trajectories (one pedestrian each).",
        counted(settings.resamples, "resample"),
        counted(dataset.clusters, "group")
    );
    text
}

fn strata(evaluation: &PictureEvaluation) -> String {
    let metrics: Vec<_> =
        evaluation.metrics.iter().filter(|metric| evaluation.scores.contains_key(metric.key)).collect();
    let head = ["frames of kind", "frames", "groups"].map(str::to_owned).into_iter();
    let head: Vec<String> = head.chain(metrics.iter().map(|metric| title(metric))).collect();
    let all = ["all".to_owned(), evaluation.frames.scored.to_string(), evaluation.dataset.clusters.to_string()];
    let cells = metrics.iter().map(|metric| score(metric, evaluation.scores.get(metric.key), true));
    let mut rows = vec![all.into_iter().chain(cells).collect::<Vec<_>>()];
    for (name, stratum) in evaluation.strata_in_order() {
        let cells = metrics.iter().map(|metric| score(metric, stratum.scores.get(metric.key), true));
        let first = [markdown(&name), stratum.frames.to_string(), stratum.clusters.to_string()];
        rows.push(first.into_iter().chain(cells).collect());
    }
    table(&head, &rows)
}

fn distances(evaluation: &PictureEvaluation) -> String {
    if evaluation.distances.is_empty() {
        return String::new();
    }
    let head = ["true depth, m", "pixels", "AbsRel"].map(str::to_owned);
    let row = |range: &super::report::DistanceReport| {
        vec![format!("{} to {}", range.from_m, range.to_m), range.pixels.to_string(), format!("{:.4}", range.abs_rel)]
    };
    let rows: Vec<Vec<String>> = evaluation.distances.iter().map(row).collect();
    format!("\n## By true depth\n\nPixels of all images at once.\n\n{}", table(&head, &rows))
}

fn classes(evaluation: &PictureEvaluation) -> String {
    if evaluation.classes.is_empty() {
        return String::new();
    }
    let named = || evaluation.metrics.iter().map(|metric| (metric.key, title(metric))).collect();
    let (truth, keys) = match evaluation.settings.kind {
        PictureKind::Semantic => ("true pixels", vec![("iou", "IoU".to_owned())]),
        PictureKind::Tracks => ("true boxes", named()),
        _ => ("true things", named()),
    };
    let head = ["class", "id", truth].map(str::to_owned).into_iter();
    let head: Vec<String> = head.chain(keys.iter().map(|(_, name)| name.clone())).collect();
    let rows: Vec<Vec<String>> = evaluation
        .classes
        .iter()
        .map(|class| {
            let cells = keys.iter().map(|(key, _)| cell(evaluation, &class.scores, key));
            [class.name.to_owned(), class.id.to_string(), class.truth.to_string()].into_iter().chain(cells).collect()
        })
        .collect();
    format!("\n## By class\n\n{}", table(&head, &rows))
}

/// The score called `key`, without an interval.
fn cell(evaluation: &PictureEvaluation, scores: &BTreeMap<&str, f64>, key: &str) -> String {
    let metric = evaluation.metrics.iter().find(|metric| metric.key == key);
    match (scores.get(key), metric) {
        (Some(value), Some(metric)) => number(metric, *value),
        (Some(value), None) => format!("{value:.3}"),
        (None, _) => "-".to_owned(),
    }
}

/// The worst sequences.
fn sequences(evaluation: &PictureEvaluation) -> String {
    if evaluation.sequences.is_empty() {
        return String::new();
    }
    let has_classes = evaluation.sequences.iter().any(|report| report.class.is_some());
    let head = ["sequence"].into_iter().chain(has_classes.then_some("class")).chain(["pictures", "true boxes"]);
    let head: Vec<String> = head.map(str::to_owned).chain(evaluation.metrics.iter().map(title)).collect();
    let row = |report: &&SequenceReport| -> Vec<String> {
        let first = [markdown_code(&report.sequence)].into_iter().chain(report.class.map(str::to_owned));
        let numbers = [report.pictures.to_string(), report.truth.to_string()];
        let scores = evaluation.metrics.iter().map(|metric| cell(evaluation, &report.scores, metric.key));
        first.chain(numbers).chain(scores).collect()
    };
    let worst = evaluation.worst_sequences();
    let rows: Vec<Vec<String>> = worst.iter().take(WORST).map(row).collect();
    let mut text = format!("\n## By sequence, the worst first\n\n{}", table(&head, &rows));
    if worst.len() > WORST {
        let _ = writeln!(text, "\n{} rows of {}; all are in the JSON report.", WORST, worst.len());
    }
    text
}

fn problems(evaluation: &PictureEvaluation) -> String {
    let (files, frames) = (&evaluation.files, &evaluation.frames);
    let mut text = String::new();
    if files.malformed > 0 {
        let kinds: Vec<String> = files.kinds.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
        let _ = write!(text, "\n## Malformed\n\n{} of {}: {}.\n\n", files.malformed, files.read, kinds.join(", "));
        for problem in files.problems.iter().take(SHOWN) {
            let _ = writeln!(text, "- {}: {}", markdown(&problem.place), markdown_words(&problem.reason));
        }
        more(&mut text, files.problems.len());
    }
    if frames.without_prediction > 0 {
        let _ = write!(text, "\n## Frames without a prediction\n\n");
        for (id, frames) in frames.missing.iter().take(SHOWN) {
            let _ = writeln!(text, "- {}: {frames}", markdown_code(id));
        }
        more(&mut text, frames.missing.len());
        text.push_str(match evaluation.settings.kind {
            PictureKind::Tracks => {
                "\nA tracker writes a file for every sequence, an empty one where it finds nobody.\n"
            }
            PictureKind::Target => "\nA tracker writes a file for every sequence, with a line for each picture.\n",
            _ => "\nIf only some frames were meant to be predicted, say so with `--every N`.\n",
        });
    }
    text
}

fn more(text: &mut String, all: usize) {
    if all > SHOWN {
        let _ = writeln!(text, "- and {} more, all in the JSON report", all - SHOWN);
    }
}
