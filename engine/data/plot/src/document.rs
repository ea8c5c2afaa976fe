//! An SVG document: shapes, lines and words, written as text. Coordinates are pixels, x right, y down.

use crate::text::escaped;
use std::fmt::Write;

/// A place: x and y, pixels.
pub type PlotPoint = (f64, f64);

/// End of a text that is at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextAnchor {
    /// The beginning.
    Start,
    /// The middle.
    Middle,
    /// The end.
    End,
}

/// A document under construction.
pub struct ChartDocument {
    text: String,
}

impl ChartDocument {
    /// A white page with a title for screen readers.
    pub fn new(title: &str, width: f64, height: f64) -> Self {
        let title = escaped(title);
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" \
             font-size=\"12\" role=\"img\">\n\
             <title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        );
        Self { text }
    }

    /// Everything until [`Self::end_clip`] shows only inside a rectangle with this corner and size; `name` is unique.
    pub fn begin_clip(&mut self, name: &str, (x, y): PlotPoint, (width, height): (f64, f64)) {
        let _ = writeln!(
            self.text,
            "<clipPath id=\"{name}\"><rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>\
             </clipPath>\n<g clip-path=\"url(#{name})\">"
        );
    }

    /// Ends [`Self::begin_clip`].
    pub fn end_clip(&mut self) {
        self.text.push_str("</g>\n");
    }

    /// A filled rectangle with this corner and size.
    pub fn rectangle(&mut self, (x, y): PlotPoint, (width, height): (f64, f64), fill: &str, opacity: f64) {
        let _ = writeln!(
            self.text,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{fill}\" \
             fill-opacity=\"{opacity}\"/>"
        );
    }

    /// A filled polygon.
    pub fn polygon(&mut self, corners: &[PlotPoint], fill: &str, opacity: f64) {
        let points = points(corners);
        let _ = writeln!(self.text, "<polygon points=\"{points}\" fill=\"{fill}\" fill-opacity=\"{opacity}\"/>");
    }

    /// An open line; `dashes` as SVG writes them, empty for none.
    pub fn line(&mut self, corners: &[PlotPoint], colour: &str, width: f64, dashes: &str) {
        let points = points(corners);
        let dashes = if dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dashes}\"") };
        let _ = writeln!(
            self.text,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-linecap=\"round\" stroke-linejoin=\"round\"{dashes}/>"
        );
    }

    /// A disc.
    pub fn disc(&mut self, (x, y): PlotPoint, radius: f64, fill: &str) {
        let _ = writeln!(self.text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{fill}\"/>");
    }

    /// A line of text.
    pub fn words(&mut self, (x, y): PlotPoint, words: &str, anchor: TextAnchor, colour: &str) {
        self.styled_words((x, y), words, anchor, &format!("fill=\"{colour}\""));
    }

    /// A heading: a line of bold text.
    pub fn heading(&mut self, (x, y): PlotPoint, words: &str) {
        self.styled_words((x, y), words, TextAnchor::Start, "font-weight=\"bold\"");
    }

    fn styled_words(&mut self, (x, y): PlotPoint, words: &str, anchor: TextAnchor, style: &str) {
        let anchor = match anchor {
            TextAnchor::Start => "start",
            TextAnchor::Middle => "middle",
            TextAnchor::End => "end",
        };
        let words = escaped(words);
        let _ = writeln!(self.text, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" {style}>{words}</text>");
    }

    /// The finished document.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

fn points(corners: &[PlotPoint]) -> String {
    let points: Vec<String> = corners.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    points.join(" ")
}
