//! Pictures inside of the page.

use crate::sketch::FlightSketch;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use cosfly_plot::text::escaped;
use std::fmt::Write;

/// Returns the small colour image of a frame of a flight as a JPEG file, where there is one.
pub type Source<'a, E> = &'a mut dyn FnMut(&FlightSketch, usize) -> Result<Option<Vec<u8>>, E>;

/// Smallest side of the frame around the target, share of the picture's width.
const LEAST_FRAME: f32 = 0.05;

/// The picture of a frame with a frame around the target, hidden or not.
pub fn image(jpeg: &[u8], flight: &FlightSketch, frame: usize, alternative: &str) -> String {
    let data = BASE64_STANDARD.encode(jpeg);
    let mut html =
        format!("<div class=\"shot\"><img src=\"data:image/jpeg;base64,{data}\" alt=\"{}\">", escaped(alternative));
    let [width, height] = flight.image_px.map(|pixels| pixels.max(1) as f32);
    if let Some([left, top, right, bottom]) = flight.box_px.get(frame).copied().flatten() {
        let side = (1.6 * (right - left).max(bottom - top)).max(LEAST_FRAME * width);
        let (x, y) = (0.5 * (left + right - side), 0.5 * (top + bottom - side));
        let is_seen = flight.visible.get(frame).is_some_and(|share| *share >= 0.5);
        let _ = write!(
            html,
            "<i class=\"{}\" style=\"left:{:.1}%;top:{:.1}%;width:{:.1}%;height:{:.1}%\"></i>",
            if is_seen { "ring" } else { "ring lost" },
            100.0 * x / width,
            100.0 * y / height,
            100.0 * side / width,
            100.0 * side / height
        );
    }
    html.push_str("</div>");
    html
}
