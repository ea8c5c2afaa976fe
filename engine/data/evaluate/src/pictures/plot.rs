//! The picture: the first metric by kind of frame with its intervals, beside classes or distances.

use super::report::PictureEvaluation;
use crate::report::drawing::{BAR_PX, TOP_PX, WIDTH_PX, label, line, marks, opened, ticks, words};
use crate::report::score::Score;
use crate::report::table::title;
use std::fmt::Write;

/// Left edges and width of the two panels.
const LEFT: (f64, f64) = (210.0, 270.0);
const RIGHT: (f64, f64) = (660.0, 270.0);

impl PictureEvaluation {
    /// The picture, SVG.
    pub fn to_svg(&self) -> String {
        picture(self)
    }
}

/// An SVG document.
fn picture(evaluation: &PictureEvaluation) -> String {
    let Some(metric) = evaluation.metrics.first() else { return String::new() };
    let mut kinds: Vec<(String, Option<&Score>)> = vec![("all".to_owned(), evaluation.scores.get(metric.key))];
    kinds.extend(evaluation.strata_in_order().map(|(name, report)| (name, report.scores.get(metric.key))));
    let plain = |value: f64| Score { value, low: None, high: None };
    let (heading, others): (String, Vec<(String, Score)>) = if evaluation.distances.is_empty() {
        let key =
            if evaluation.classes.iter().any(|class| class.scores.contains_key("iou")) { "iou" } else { metric.key };
        let of_class =
            |class: &super::report::ClassReport| Some((class.name.to_owned(), plain(*class.scores.get(key)?)));
        let name = if key == "iou" { "IoU" } else { metric.name };
        (format!("{name} by class"), evaluation.classes.iter().filter_map(of_class).collect())
    } else {
        let of_range = |range: &super::report::DistanceReport| {
            (format!("{} to {} m", range.from_m, range.to_m), plain(range.abs_rel))
        };
        ("AbsRel by true depth".to_owned(), evaluation.distances.iter().map(of_range).collect())
    };
    let panel = BAR_PX * kinds.len().max(others.len()) as f64;
    let name = format!("Scores of {} on {}", evaluation.settings.kind.name(), evaluation.dataset.name);
    let mut svg = opened(&name, TOP_PX + panel + 40.0);
    words(&mut svg, (16.0, 26.0), "start", &format!("{} with 95 % interval", title(metric)), "font-weight=\"bold\"");
    words(&mut svg, (RIGHT.0 - 130.0, 26.0), "start", &heading, "font-weight=\"bold\"");
    let kinds: Vec<(String, Score)> = kinds.into_iter().filter_map(|(name, score)| Some((name, *score?))).collect();
    bars(&mut svg, LEFT, &kinds, panel, "#2471a3");
    bars(&mut svg, RIGHT, &others, panel, "#1e8449");
    debug_assert!(RIGHT.0 + RIGHT.1 < WIDTH_PX);
    svg.push_str("</svg>\n");
    svg
}

fn bars(svg: &mut String, (left, width): (f64, f64), rows: &[(String, Score)], panel: f64, colour: &str) {
    let longest = rows.iter().map(|(_, score)| score.high.unwrap_or(score.value).max(score.value)).fold(0.0, f64::max);
    let (step, top) = ticks(longest);
    let x = |value: f64| left + width * value / top;
    for tick in marks(step, top) {
        line(svg, (x(tick), TOP_PX - 8.0, x(tick), TOP_PX + panel), "#dddddd", 1.0);
        words(svg, (x(tick), TOP_PX + panel + 18.0), "middle", &label(tick), "fill=\"#555\"");
    }
    for (place, (name, score)) in rows.iter().enumerate() {
        let y = TOP_PX + BAR_PX * place as f64;
        words(svg, (left - 8.0, y + 13.0), "end", name, "");
        let _ = writeln!(
            svg,
            "<rect x=\"{left:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"17\" fill=\"{colour}\" fill-opacity=\"0.85\"/>",
            x(score.value) - left
        );
        if let (Some(low), Some(high)) = (score.low, score.high) {
            line(svg, (x(low), y + 8.5, x(high), y + 8.5), "#111111", 1.5);
            for end in [low, high] {
                line(svg, (x(end), y + 4.5, x(end), y + 12.5), "#111111", 1.5);
            }
        }
        let end = x(score.high.unwrap_or(score.value).max(score.value)) + 6.0;
        words(svg, (end, y + 13.0), "start", &format!("{:.3}", score.value), "");
    }
}
