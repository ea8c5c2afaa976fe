//! Axes of charts inside of HTML pages.

use crate::statistics;
use crate::text::{escaped, told_apart};
use std::fmt::Write;

const WIDTH: f64 = 360.0;
const HEIGHT: f64 = 190.0;
/// Left, top, right and bottom of the area of a chart.
const AREA: [f64; 4] = [46.0, 10.0, 350.0, 156.0];

/// The beginning of a chart with a name for screen readers.
pub fn open(name: &str) -> String {
    format!("<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\">", escaped(name))
}

/// Values at the edges of the area.
pub struct Axes {
    /// Values at the left and right edges.
    pub x: (f64, f64),
    /// Values at the bottom and top edges.
    pub y: (f64, f64),
}

impl Axes {
    /// Place of a value on the x axis, pixels.
    pub fn x(&self, value: f64) -> f64 {
        AREA[0] + (AREA[2] - AREA[0]) * (value - self.x.0) / (self.x.1 - self.x.0).max(1e-12)
    }

    /// Place of a value on the y axis, pixels.
    pub fn y(&self, value: f64) -> f64 {
        AREA[3] - (AREA[3] - AREA[1]) * (value - self.y.0) / (self.y.1 - self.y.0).max(1e-12)
    }

    /// Lines with labels at round values of the y axis, and labels at those of the x axis.
    pub fn grid(&self, svg: &mut String, y_label: &dyn Fn(f64) -> String) {
        for value in ticks(self.y, 4.0) {
            self.grid_line(svg, self.y(value), &y_label(value));
        }
        let values = ticks(self.x, 6.0);
        for (value, label) in values.iter().zip(told_apart(&values)) {
            self.x_label(svg, *value, "mid", &label);
        }
    }

    /// A line across the area at the height `y`, with a label.
    pub fn grid_line(&self, svg: &mut String, y: f64, label: &str) {
        let _ = write!(
            svg,
            "<path class=\"grid\" d=\"M{} {y:.1}H{}\"/><text x=\"{}\" y=\"{:.1}\" class=\"end\">{label}</text>",
            AREA[0],
            AREA[2],
            AREA[0] - 5.0,
            y + 3.5
        );
    }

    /// A label below the x axis at a value; `anchor` is `start`, `mid` or `end`.
    pub fn x_label(&self, svg: &mut String, value: f64, anchor: &str, label: &str) {
        let (x, y) = (self.x(value), AREA[3] + 16.0);
        let _ = write!(svg, "<text x=\"{x:.1}\" y=\"{y}\" class=\"{anchor}\">{label}</text>");
    }
}

/// Round values of a range, about `wanted` of them: few, whatever the range is.
pub fn ticks((low, high): (f64, f64), wanted: f64) -> Vec<f64> {
    let step = statistics::round_step((high - low) / wanted);
    let inside = statistics::edges(low, high, wanted as usize).into_iter();
    inside.map(|it| (it / step).round() * step).filter(|it| *it >= low - 1e-9 && *it <= high + 1e-9).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_few_whatever_the_range_is() {
        for range in [(0.0, 1e24), (-1e300, 1e300), (5.0, 5.0), (0.0, 1e-12), (1e12, 1e12), (0.0, f64::INFINITY)] {
            assert!(ticks(range, 6.0).len() <= 9, "{range:?}");
        }
        assert!(ticks((f64::NAN, f64::NAN), 6.0).len() <= 9);
        assert_eq!(ticks((0.0, 1.0), 4.0), [0.0, 0.5, 1.0]);
    }
}
