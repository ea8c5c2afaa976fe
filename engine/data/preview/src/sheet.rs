//! The contact sheet: some frames of a flight, one row each: colours, depth, labels, channels on
//! request, the target enlarged.

use crate::shot::ClipShot;
use cosfly_channel_pictures::false_colours::DepthScale;
use cosfly_diagnose::counted;
use cosfly_plot::canvas::{Canvas, INK, WHITE};
use cosfly_read::PublishedFlight;

/// Longer side of a picture, about.
const CELL: usize = 384;
const GAP: usize = 6;
const HEADER: usize = 34;

/// A sheet that grows row by row.
pub struct Sheet<'a> {
    flight: &'a PublishedFlight,
    rows: Vec<Canvas>,
}

impl<'a> Sheet<'a> {
    /// An empty sheet.
    pub fn new(flight: &'a PublishedFlight) -> Self {
        Self { flight, rows: vec![] }
    }

    /// Adds a row.
    pub fn add(&mut self, shot: &ClipShot) {
        let (width, height) = cell(shot.rgb.width, shot.rgb.height);
        let side = height.clamp(CELL / 4, CELL);
        let tall = height.max(side);
        let depths = shot.depths(width, height);
        let depth = Canvas { width, height, rgb: DepthScale::of(depths.iter().copied()).colours(&depths) };
        let mut pictures = vec![shot.colour(width, height), depth, shot.labels(width, height)];
        pictures.extend(shot.on_request(width, height));
        let mut row = Canvas::new(pictures.len() * (width + GAP) + side, tall, WHITE);
        pictures.push(shot.target(side));
        for (place, picture) in pictures.iter().enumerate() {
            row.paste(picture, place * (width + GAP), 0);
        }
        if self.rows.is_empty() {
            let on_request = shot.logged.on_request.iter().map(|image| image.channel.name);
            let names = ["rgb", "depth", "semantic"].into_iter().chain(on_request).chain(["target"]);
            for (place, name) in names.enumerate().skip(1) {
                row.label((place * (width + GAP)) as i64 + 4, 4, 1, WHITE, name);
            }
        }
        let target = &shot.logged.target;
        let words = format!("frame {}  {:.1} s", target.frame, target.time_s);
        row.label(4, 4, 1, WHITE, &words);
        let words = format!("visible {:.0} %  at {:.1} m", 100.0 * shot.visible(), target.distance_m);
        row.label(4, height as i64 - 14, 1, WHITE, &words);
        self.rows.push(row);
    }

    /// The sheet.
    pub fn finish(self) -> Canvas {
        let width = self.rows.iter().map(|row| row.width).max().unwrap_or(CELL) + 2 * GAP;
        let height = HEADER + self.rows.iter().map(|row| row.height + GAP).sum::<usize>();
        let mut sheet = Canvas::new(width, height, [244, 243, 240]);
        let flight = self.flight;
        let end = sheet.text(GAP as i64 + 2, 10, 2, INK, &flight.trajectory_id);
        let (fov_deg, camera) = (flight.lens.span_rad(&flight.camera).to_degrees(), &flight.camera);
        let about = format!(
            "{}  {}  {}, {} s apart  {} x {}, {fov_deg:.0} degrees",
            flight.town,
            flight.weather,
            counted(flight.frames, "frame"),
            flight.dt_s,
            camera.width,
            camera.height
        );
        sheet.text(end + 14, 14, 1, [90, 92, 96], &about);
        let mut y = HEADER;
        for row in &self.rows {
            sheet.paste(row, GAP, y);
            y += row.height + GAP;
        }
        sheet
    }
}

/// Size of a picture on the sheet, within a square cell: images are shrunk or repeated a whole number of times.
fn cell(width: usize, height: usize) -> (usize, usize) {
    let longer = width.max(height);
    if longer < CELL {
        let times = CELL / longer;
        return (width * times, height * times);
    }
    ((width * CELL / longer).max(1), (height * CELL / longer).max(1))
}

#[cfg(test)]
mod tests {
    use super::cell;

    #[test]
    fn cells_keep_the_aspect() {
        assert_eq!((cell(1280, 720), cell(96, 54), cell(200, 100)), ((384, 216), (384, 216), (200, 100)));
        assert_eq!((cell(8000, 1), cell(16, 7680)), ((384, 1), (1, 384)));
    }
}
