//! Lines, words and axes of our pictures, SVG.

use std::fmt::Write;

/// Height of a bar with the gap below it, pixels.
pub const BAR_PX: f64 = 26.0;
/// Width of a picture, pixels.
pub const WIDTH_PX: f64 = 980.0;
/// Where panels begin, pixels from the top.
pub const TOP_PX: f64 = 64.0;

/// Distance between marks of an axis that reaches `highest`, and its end.
pub fn ticks(highest: f64) -> (f64, f64) {
    let mut step = 0.01;
    for factor in [2.0, 2.5, 2.0].into_iter().cycle().take(60) {
        if highest / step <= 6.0 {
            break;
        }
        step *= factor;
    }
    (step, step * (highest / step).ceil().max(1.0))
}

/// Places of the marks of an axis that ends at `top`.
pub fn marks(step: f64, top: f64) -> impl Iterator<Item = f64> {
    (0..=(top / step).round() as u32).map(move |number| f64::from(number) * step)
}

/// The number of a mark.
pub fn label(tick: f64) -> String {
    let text = format!("{tick:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The beginning of a document of `height` pixels.
pub fn opened(title: &str, height: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH_PX}\" height=\"{height}\" viewBox=\"0 0 {WIDTH_PX} {height}\" \
         font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"12\" role=\"img\">\n\
         <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        escaped(title)
    )
}

/// Thin lines at the marks.
pub fn grid(svg: &mut String, step: f64, top: f64, at: impl Fn(f64) -> (f64, f64, f64, f64)) {
    marks(step, top).for_each(|tick| line(svg, at(tick), "#dddddd", 1.0));
}

/// A straight line.
pub fn line(svg: &mut String, (x1, y1, x2, y2): (f64, f64, f64, f64), colour: &str, width: f64) {
    let _ = writeln!(
        svg,
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    );
}

/// A line of text.
pub fn words(svg: &mut String, (x, y): (f64, f64), anchor: &str, text: &str, more: &str) {
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" {more}>{}</text>", escaped(text));
}

/// Text as it stands in XML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_a_few_round_marks() {
        for (highest, expected) in
            [(0.0, (0.01, 0.01)), (0.045, (0.01, 0.05)), (0.55, (0.1, 0.6)), (4.9, (1.0, 5.0)), (37.0, (10.0, 40.0))]
        {
            let (step, top) = ticks(highest);
            assert!((step - expected.0).abs() < 1e-9 && (top - expected.1).abs() < 1e-9, "{highest} {step} {top}");
        }
        assert!(ticks(1e30).1.is_finite());
        assert_eq!([2.0, 0.5, 0.02, 10.0].map(label), ["2", "0.5", "0.02", "10"]);
    }
}
