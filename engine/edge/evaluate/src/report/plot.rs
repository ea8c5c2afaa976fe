//! The picture: final errors with their intervals, and errors waypoint by waypoint, method beside method.

use super::{Evaluation, MethodReport};
use std::fmt::Write;

const COLOURS: [&str; 9] =
    ["#c0392b", "#7f8c8d", "#2471a3", "#5dade2", "#b7950b", "#1e8449", "#82c596", "#6c3483", "#34495e"];
/// Height of a bar with the gap below it, pixels.
const BAR_PX: f64 = 26.0;
const WIDTH_PX: f64 = 980.0;
const TOP_PX: f64 = 64.0;
/// Left edges and width of the two panels.
const BARS: (f64, f64) = (170.0, 300.0);
const LINES: (f64, f64) = (620.0, 320.0);

/// An SVG document.
pub fn picture(evaluation: &Evaluation) -> String {
    let methods = &evaluation.methods;
    let panel = (BAR_PX * methods.len() as f64).max(200.0);
    let height = TOP_PX + panel + 56.0;
    let mut svg = String::new();
    let _ = writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH_PX}\" height=\"{height}\" viewBox=\"0 0 {WIDTH_PX} {height}\" \
         font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"12\" role=\"img\">\n\
         <title>Errors of predictions and baselines on {name}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>",
        name = escaped(&evaluation.dataset.name)
    );
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
    let longest = ends.map(|score| score.high.unwrap_or(score.value).max(score.value)).fold(0.0, f64::max);
    let (step, top) = ticks(longest);
    let x = |value: f64| BARS.0 + BARS.1 * value / top;
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
            for end in [low, high] {
                line(svg, (x(end), middle - 4.0, x(end), middle + 4.0), "#111111", 1.5);
            }
        }
        words(svg, (x(score.high.unwrap_or(score.value)) + 6.0, y + 13.0), "start", &format!("{:.2}", score.value), "");
    }
}

fn lines(svg: &mut String, methods: &[MethodReport], panel: f64) {
    let highest = methods.iter().flat_map(|method| &method.by_step_m).copied().fold(0.0, f64::max);
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
}

/// Distance between marks of an axis that reaches `highest`, and its end.
fn ticks(highest: f64) -> (f64, f64) {
    let mut step = 0.1;
    for factor in [2.0, 2.5, 2.0].into_iter().cycle().take(60) {
        if highest / step <= 6.0 {
            break;
        }
        step *= factor;
    }
    (step, step * (highest / step).ceil().max(1.0))
}

fn marks(step: f64, top: f64) -> impl Iterator<Item = f64> {
    (0..=(top / step).round() as u32).map(move |number| f64::from(number) * step)
}

fn label(tick: f64) -> String {
    let text = format!("{tick:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

fn grid(svg: &mut String, step: f64, top: f64, at: impl Fn(f64) -> (f64, f64, f64, f64)) {
    marks(step, top).for_each(|tick| line(svg, at(tick), "#dddddd", 1.0));
}

fn line(svg: &mut String, (x1, y1, x2, y2): (f64, f64, f64, f64), colour: &str, width: f64) {
    let _ = writeln!(
        svg,
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    );
}

fn words(svg: &mut String, (x, y): (f64, f64), anchor: &str, text: &str, more: &str) {
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" {more}>{}</text>", escaped(text));
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_a_few_round_marks() {
        for (highest, expected) in [(0.0, (0.1, 0.1)), (0.55, (0.1, 0.6)), (4.9, (1.0, 5.0)), (37.0, (10.0, 40.0))] {
            let (step, top) = ticks(highest);
            assert!((step - expected.0).abs() < 1e-9 && (top - expected.1).abs() < 1e-9, "{highest} {step} {top}");
        }
        assert!(ticks(1e30).1.is_finite());
        assert_eq!((label(2.0), label(0.5)), ("2".to_owned(), "0.5".to_owned()));
    }
}
