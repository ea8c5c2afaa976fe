//! A minimal SVG writer: shapes, lines and text.

use std::fmt::Write;

/// A page under construction; coordinates in pixels, y down.
pub struct Page {
    text: String,
}

impl Page {
    /// Creates a white page.
    pub fn new(width: f64, height: f64) -> Self {
        let mut text = String::new();
        let _ = writeln!(
            text,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"12\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>"
        );
        Self { text }
    }

    /// Clips everything until [`Self::end_clip`] to a rectangle.
    pub fn begin_clip(&mut self, name: &str, x: f64, y: f64, width: f64, height: f64) {
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

    /// Adds a filled polygon.
    pub fn polygon(&mut self, corners: &[(f64, f64)], fill: &str, opacity: f64) {
        let points = points(corners);
        let _ = writeln!(self.text, "<polygon points=\"{points}\" fill=\"{fill}\" fill-opacity=\"{opacity}\"/>");
    }

    /// Adds an open line; `dashes` is SVG's dash array, empty for none.
    pub fn line(&mut self, corners: &[(f64, f64)], colour: &str, width: f64, dashes: &str) {
        let points = points(corners);
        let dashes = if dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dashes}\"") };
        let _ = writeln!(
            self.text,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-linecap=\"round\" stroke-linejoin=\"round\"{dashes}/>"
        );
    }

    /// Adds a disc.
    pub fn disc(&mut self, (x, y): (f64, f64), radius: f64, fill: &str) {
        let _ = writeln!(self.text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{fill}\"/>");
    }

    /// Adds text; `anchor` is `start`, `middle` or `end`.
    pub fn words(&mut self, (x, y): (f64, f64), words: &str, anchor: &str, colour: &str) {
        let escaped = words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{escaped}</text>"
        );
    }

    /// Finished document.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

fn points(corners: &[(f64, f64)]) -> String {
    let mut text = String::new();
    for (x, y) in corners {
        let _ = write!(text, "{x:.1},{y:.1} ");
    }
    text.truncate(text.trim_end().len());
    text
}
