//! The picture: final errors with their intervals, and errors waypoint by waypoint, method beside method.

use super::drawing::{BAR_PX, TOP_PX, grid, label, line, marks, opened, ticks, words};
use super::result::{Evaluation, MethodReport};
use std::fmt::Write;

const COLOURS: [&str; 9] =
    ["#c0392b", "#7f8c8d", "#2471a3", "#5dade2", "#b7950b", "#1e8449", "#82c596", "#6c3483", "#34495e"];
/// An axis ends at most at so many times the median of the methods, so that one that goes far astray does not flatten
/// all others.
const MOST_MEDIANS: f64 = 2.5;
/// Left edges and width of the two panels.
const BARS: (f64, f64) = (170.0, 300.0);
const LINES: (f64, f64) = (620.0, 320.0);

impl Evaluation {
    /// The picture, SVG.
    pub fn to_svg(&self) -> String {
        picture(self)
    }
}

/// An SVG document.
fn picture(evaluation: &Evaluation) -> String {
    let methods = &evaluation.methods;
    let panel = (BAR_PX * methods.len() as f64).max(200.0);
    let height = TOP_PX + panel + 56.0;
    let mut svg = opened(&format!("Errors of predictions and baselines on {}", evaluation.dataset.name), height);
    words(
        &mut svg,
        (16.0, 26.0),
        "start",
        "Final displacement error with 95 % interval, metres",
        "font-weight=\"bold\"",
    );
    words(&mut svg, (LINES.0 - 40.0, 26.0), "start", "Displacement error by waypoint, metres", "font-weight=\"bold\"");
    bars(&mut svg, methods, panel);
    lines(&mut svg, methods, panel);
    svg.push_str("</svg>\n");
    svg
}

fn colour(place: usize) -> &'static str {
    COLOURS[place % COLOURS.len()]
}

fn bars(svg: &mut String, methods: &[MethodReport], panel: f64) {
    let ends = methods.iter().filter_map(|method| method.scores.get("fde_m"));
    let ends: Vec<f64> = ends.map(|score| score.high.unwrap_or(score.value).max(score.value)).collect();
    let (longest, is_cut) = end_of_axis(&ends);
    let (step, top) = ticks(longest);
    let x = |value: f64| BARS.0 + BARS.1 * (value / top).min(1.0);
    if is_cut {
        let note = format!("axis cut at {} m; bars with an arrow are longer", label(top));
        words(svg, (16.0, 44.0), "start", &note, "fill=\"#555\"");
    }
    grid(svg, step, top, |value| (x(value), TOP_PX - 8.0, x(value), TOP_PX + panel));
    for tick in marks(step, top) {
        words(svg, (x(tick), TOP_PX + panel + 18.0), "middle", &label(tick), "fill=\"#555\"");
    }
    for (place, method) in methods.iter().enumerate() {
        let Some(score) = method.scores.get("fde_m") else { continue };
        let y = TOP_PX + BAR_PX * place as f64;
        words(svg, (BARS.0 - 8.0, y + 13.0), "end", &method.name, "");
        let _ = writeln!(
            svg,
            "<rect x=\"{:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"17\" fill=\"{}\" fill-opacity=\"0.85\"/>",
            BARS.0,
            x(score.value) - BARS.0,
            colour(place)
        );
        if let (Some(low), Some(high)) = (score.low, score.high) {
            let middle = y + 8.5;
            line(svg, (x(low), middle, x(high), middle), "#111111", 1.5);
            for end in [low, high].into_iter().filter(|end| *end <= top) {
                line(svg, (x(end), middle - 4.0, x(end), middle + 4.0), "#111111", 1.5);
            }
        }
        let arrow = if score.high.unwrap_or(score.value).max(score.value) > top { "\u{2192} " } else { "" };
        let end = x(score.high.unwrap_or(score.value).max(score.value)) + 6.0;
        words(svg, (end, y + 13.0), "start", &format!("{arrow}{:.2}", score.value), "");
    }
}

fn lines(svg: &mut String, methods: &[MethodReport], panel: f64) {
    let last: Vec<f64> = methods.iter().map(|method| method.by_step_m.iter().copied().fold(0.0, f64::max)).collect();
    let (highest, is_cut) = end_of_axis(&last);
    let steps = methods.iter().map(|method| method.by_step_m.len()).max().unwrap_or(0);
    let (step, top) = ticks(highest);
    let y = |value: f64| TOP_PX + panel * (1.0 - value / top);
    let x = |at: usize| LINES.0 + LINES.1 * at as f64 / (steps.max(2) - 1) as f64;
    grid(svg, step, top, |value| (LINES.0, y(value), LINES.0 + LINES.1, y(value)));
    for tick in marks(step, top) {
        words(svg, (LINES.0 - 8.0, y(tick) + 4.0), "end", &label(tick), "fill=\"#555\"");
    }
    for at in 0..steps {
        words(svg, (x(at), TOP_PX + panel + 18.0), "middle", &(at + 1).to_string(), "fill=\"#555\"");
    }
    words(
        svg,
        (LINES.0 + LINES.1 / 2.0, TOP_PX + panel + 38.0),
        "middle",
        "waypoint; colours as on the left",
        "fill=\"#555\"",
    );
    if is_cut {
        let note = format!("axis cut at {} m; lines that leave it go on", label(top));
        words(svg, (LINES.0 - 40.0, 44.0), "start", &note, "fill=\"#555\"");
    }
    let _ = writeln!(
        svg,
        "<clipPath id=\"inside\"><rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\"/></clipPath>\n<g clip-path=\"url(#inside)\">",
        LINES.0 - 6.0,
        TOP_PX - 4.0,
        LINES.1 + 12.0,
        panel + 8.0
    );
    for (place, method) in methods.iter().enumerate().rev() {
        let mut points = String::new();
        for (at, value) in method.by_step_m.iter().enumerate() {
            let _ = write!(points, "{:.1},{:.1} ", x(at), y(*value));
            let _ = writeln!(
                svg,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"{}\"/>",
                x(at),
                y(*value),
                colour(place)
            );
        }
        let width = if place == 0 { 2.5 } else { 1.5 };
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"/>",
            points.trim_end(),
            colour(place)
        );
    }
    svg.push_str("</g>\n");
}

/// Where an axis of these values ends, and whether some of them are beyond it. The first method is never cut.
fn end_of_axis(values: &[f64]) -> (f64, bool) {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (Some(longest), Some(first)) = (sorted.last(), values.first()) else { return (0.0, false) };
    let most = (MOST_MEDIANS * sorted[sorted.len() / 2]).max(*first);
    // A little beyond is not worth a cut.
    if *longest <= 1.5 * most { (*longest, false) } else { (most, true) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_that_goes_far_astray_is_cut_and_predictions_never_are() {
        assert_eq!(end_of_axis(&[4.0, 5.0, 6.0]), (6.0, false));
        assert_eq!(end_of_axis(&[4.0, 5.0, 80.0]), (12.5, true));
        assert_eq!(end_of_axis(&[80.0, 5.0, 4.0]), (80.0, false));
        assert_eq!(end_of_axis(&[]), (0.0, false));
    }
}
