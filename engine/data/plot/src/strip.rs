//! Visibility over time as a strip of colours, and its classes.

use crate::text::escaped;
use std::fmt::Write;

/// The class of a share of visibility, 0 (lost) to 4 (seen).
pub fn class_of(visible: f32) -> usize {
    ((visible * 5.0) as usize).min(4)
}

/// Names of the classes of [`class_of`].
pub const CLASSES: [&str; 5] = ["under 20 %", "20 to 40 %", "40 to 60 %", "60 to 80 %", "over 80 %"];

/// Visibility over time as a strip of colours, as wide as `longest` frames would fill the page.
pub fn strip(visible: &[f32], longest: usize, name: &str) -> String {
    let mut svg = format!(
        "<svg class=\"strip\" viewBox=\"0 0 {longest} 10\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{}\">",
        escaped(name)
    );
    let mut start = 0;
    while start < visible.len() {
        let class = class_of(visible[start]);
        let end = (start..visible.len()).find(|at| class_of(visible[*at]) != class).unwrap_or(visible.len());
        let _ = write!(svg, "<path class=\"f{class}\" d=\"M{start} 0H{end}V10H{start}Z\"/>");
        start = end;
    }
    svg.push_str("</svg>");
    svg
}
