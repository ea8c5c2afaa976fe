//! A panel of horizontal bars with intervals.

use crate::axis::{Axis, label};
use crate::document::{ChartDocument, TextAnchor};

/// Height of a bar with the gap below it, pixels.
pub const BAR_PX: f64 = 26.0;

const GREY: &str = "#555";
const INK: &str = "#111111";
const GRID: &str = "#dddddd";

/// A bar.
#[derive(Clone, Copy, Debug)]
pub struct Bar<'a> {
    /// Name, on the left.
    pub name: &'a str,
    /// Length.
    pub value: f64,
    /// Ends of an interval.
    pub interval: Option<(f64, f64)>,
    /// Colour.
    pub colour: &'a str,
}

impl Bar<'_> {
    /// The bar's or the interval's end, whichever is further.
    pub fn end(&self) -> f64 {
        self.interval.map_or(self.value, |(_, high)| high.max(self.value))
    }
}

/// Place of a panel of bars, pixels, and the form of its numbers.
#[derive(Clone, Copy, Debug)]
pub struct Bars {
    /// Left end of the bars; names are on its left.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Length of the axis.
    pub width: f64,
    /// Height of the panel.
    pub height: f64,
    /// Decimals of the values.
    pub decimals: usize,
}

impl Bars {
    /// A value as text; with an exponent where it would be long.
    fn number(&self, value: f64) -> String {
        if value.abs() < 1e7 { format!("{value:.0$}", self.decimals) } else { format!("{value:.0$e}", self.decimals) }
    }

    /// Draws the bars one below the other.
    pub fn draw(&self, document: &mut ChartDocument, axis: Axis, bars: &[Bar<'_>]) {
        let x = |value: f64| self.left + self.width * axis.share(value);
        let bottom = self.top + self.height;
        for mark in axis.marks() {
            document.line(&[(x(mark), self.top - 8.0), (x(mark), bottom)], GRID, 1.0, "");
            document.words((x(mark), bottom + 18.0), &label(mark), TextAnchor::Middle, GREY);
        }
        for (place, bar) in bars.iter().enumerate() {
            let y = self.top + BAR_PX * place as f64;
            document.words((self.left - 8.0, y + 13.0), bar.name, TextAnchor::End, INK);
            document.rectangle((self.left, y), (x(bar.value) - self.left, 17.0), bar.colour, 0.85);
            if let Some((low, high)) = bar.interval {
                let middle = y + 8.5;
                document.line(&[(x(low), middle), (x(high), middle)], INK, 1.5, "");
                for end in [low, high].into_iter().filter(|end| *end <= axis.end) {
                    document.line(&[(x(end), middle - 4.0), (x(end), middle + 4.0)], INK, 1.5, "");
                }
            }
            let arrow = if bar.end() > axis.end { "\u{2192} " } else { "" };
            let words = format!("{arrow}{}", self.number(bar.value));
            document.words((x(bar.end()) + 6.0, y + 13.0), &words, TextAnchor::Start, INK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_beyond_the_axis_has_an_arrow_and_its_value() {
        let bar =
            |value: f64| Bar { name: "a<b", value, interval: Some((value - 1.0, value + 1.0)), colour: "#123456" };
        let bars = [bar(4.0), bar(5.0), bar(80.0)];
        let axis = Axis::of(&bars.map(|bar| bar.end()));
        let mut document = ChartDocument::new("errors", 400.0, 200.0);
        Bars { left: 100.0, top: 20.0, width: 200.0, height: 100.0, decimals: 2 }.draw(&mut document, axis, &bars);
        let svg = document.finish();
        assert!(svg.contains("\u{2192} 80.00") && svg.contains(">4.00<") && svg.contains("a&lt;b"), "{svg}");
    }

    #[test]
    fn absurd_values_make_a_small_picture_without_what_is_no_number() {
        let bars =
            [1e24, f64::INFINITY, 3.0, -2.0].map(|value| Bar { name: "a", value, interval: None, colour: "#123456" });
        let mut document = ChartDocument::new("errors", 400.0, 200.0);
        let axis = Axis::of(&bars.map(|bar| bar.end()));
        Bars { left: 100.0, top: 20.0, width: 200.0, height: 100.0, decimals: 2 }.draw(&mut document, axis, &bars);
        let svg = document.finish();
        assert!(svg.len() < 5_000 && svg.contains("1.00e24") && !svg.contains("NaN") && !svg.contains("=\"-"), "{svg}");
    }
}
