//! A panel of lines over numbered steps.

use crate::axis::{Axis, label};
use crate::document::{ChartDocument, TextAnchor};

const GREY: &str = "#555";
const GRID: &str = "#dddddd";

/// Steps with a number below them at most, and how far outside of the panel a line is drawn, in heights of it.
const MOST_NUMBERS: usize = 25;
const OUTSIDE: f64 = 100.0;

/// A line.
#[derive(Clone, Copy, Debug)]
pub struct Line<'a> {
    /// Value of every step.
    pub values: &'a [f64],
    /// Colour.
    pub colour: &'a str,
}

/// Place of a panel of lines, pixels.
#[derive(Clone, Copy, Debug)]
pub struct Lines<'a> {
    /// Left end of the x axis.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Length of the x axis.
    pub width: f64,
    /// Height of the panel.
    pub height: f64,
    /// Text below the x axis.
    pub caption: &'a str,
}

impl Lines<'_> {
    /// Draws the lines, the first one thick and on top of the others. Steps are numbered from 1.
    pub fn draw(&self, document: &mut ChartDocument, axis: Axis, lines: &[Line<'_>]) {
        let steps = lines.iter().map(|line| line.values.len()).max().unwrap_or(0);
        let (right, bottom) = (self.left + self.width, self.top + self.height);
        let y = |value: f64| self.top + self.height * (1.0 - value / axis.end).clamp(-OUTSIDE, OUTSIDE);
        let x = |at: usize| self.left + self.width * at as f64 / (steps.max(2) - 1) as f64;
        for mark in axis.marks() {
            document.line(&[(self.left, y(mark)), (right, y(mark))], GRID, 1.0, "");
            document.words((self.left - 8.0, y(mark) + 4.0), &label(mark), TextAnchor::End, GREY);
        }
        for at in (0..steps).step_by(steps.div_ceil(MOST_NUMBERS).max(1)) {
            document.words((x(at), bottom + 18.0), &(at + 1).to_string(), TextAnchor::Middle, GREY);
        }
        document.words((self.left + self.width / 2.0, bottom + 38.0), self.caption, TextAnchor::Middle, GREY);
        document.begin_clip("lines", (self.left - 6.0, self.top - 4.0), (self.width + 12.0, self.height + 8.0));
        for (place, line) in lines.iter().enumerate().rev() {
            let known = line.values.iter().enumerate().filter(|(_, value)| !value.is_nan());
            let places: Vec<_> = known.map(|(at, value)| (x(at), y(*value))).collect();
            places.iter().for_each(|place| document.disc(*place, 3.0, line.colour));
            document.line(&places, line.colour, if place == 0 { 2.5 } else { 1.5 }, "");
        }
        document.end_clip();
    }
}
