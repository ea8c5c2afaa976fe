//! An RGB picture to draw on: rectangles, lines, areas and text with smooth edges.

use crate::font;
use cosfly_diagnose::{Diagnostic, Fault, Result};

/// Red, green, blue.
pub type ChartColour = [u8; 3];

/// White.
pub const WHITE: ChartColour = [255, 255, 255];
/// Nearly black.
pub const INK: ChartColour = [24, 26, 30];

/// A point of a picture: right, down, pixels.
pub type Point = [f64; 2];

/// Levels of a row of pixels at which an area is cut.
const LEVELS: u32 = 4;

/// A picture, 3 bytes a pixel, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The pixels.
    pub rgb: Vec<u8>,
}

impl Canvas {
    /// A picture of one colour.
    pub fn new(width: usize, height: usize, colour: ChartColour) -> Self {
        Self { width, height, rgb: colour.repeat(width * height) }
    }

    /// The colour at a pixel inside.
    pub fn pixel(&self, x: usize, y: usize) -> ChartColour {
        let at = 3 * (y * self.width + x);
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }

    /// Lays `share` (0..=1) of a colour over a pixel; does nothing outside of the picture.
    pub fn blend(&mut self, x: i64, y: i64, colour: ChartColour, share: f64) {
        if share <= 0.0 || x < 0 || y < 0 || x >= self.width as i64 || y >= self.height as i64 {
            return;
        }
        let at = 3 * (y as usize * self.width + x as usize);
        for (old, new) in self.rgb[at..at + 3].iter_mut().zip(colour) {
            let mixed = f64::from(*old) + (f64::from(new) - f64::from(*old)) * share.min(1.0);
            *old = (mixed + 0.5) as u8;
        }
    }

    /// Copies another picture to the corner (x, y), as far as it fits.
    pub fn paste(&mut self, picture: &Self, x: usize, y: usize) {
        let columns = picture.width.min(self.width.saturating_sub(x));
        for row in 0..picture.height.min(self.height.saturating_sub(y)) {
            let (from, to) = (3 * row * picture.width, 3 * ((y + row) * self.width + x));
            self.rgb[to..to + 3 * columns].copy_from_slice(&picture.rgb[from..from + 3 * columns]);
        }
    }

    /// Fills a rectangle with `share` of a colour.
    pub fn fill(&mut self, corner: [i64; 2], size: [i64; 2], colour: ChartColour, share: f64) {
        for y in corner[1].max(0)..(corner[1] + size[1]).min(self.height as i64) {
            for x in corner[0].max(0)..(corner[0] + size[0]).min(self.width as i64) {
                self.blend(x, y, colour, share);
            }
        }
    }

    /// A line of `thickness` pixels with round ends.
    pub fn line(&mut self, from: Point, to: Point, thickness: f64, colour: ChartColour, share: f64) {
        let reach = 0.5 * thickness + 1.0;
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = length_of(along);
        self.for_pixels(&[from, to], reach, |canvas, x, y, middle| {
            let offset = [middle[0] - from[0], middle[1] - from[1]];
            let t = if length > 0.0 { (offset[0] * along[0] + offset[1] * along[1]) / (length * length) } else { 0.0 };
            let t = t.clamp(0.0, 1.0);
            let distance = length_of([offset[0] - t * along[0], offset[1] - t * along[1]]);
            canvas.blend(x, y, colour, share * (0.5 * thickness + 0.5 - distance).clamp(0.0, 1.0));
        });
    }

    /// A full circle.
    pub fn disc(&mut self, middle: Point, radius: f64, colour: ChartColour) {
        self.line(middle, middle, 2.0 * radius, colour, 1.0);
    }

    /// Fills an area of any shape by the even-odd rule: convex or not, crossed, with bridges to its holes.
    pub fn area(&mut self, corners: &[Point], colour: ChartColour, share: f64) {
        let columns = pixels_of(corners, 0, self.width);
        let mut covered = vec![0.0; columns.len()];
        let mut crossings: Vec<f64> = Vec::new();
        for y in pixels_of(corners, 1, self.height) {
            covered.fill(0.0);
            for part in 0..LEVELS {
                let level = y as f64 + (f64::from(part) + 0.5) / f64::from(LEVELS);
                let across = edges(corners).filter(|(a, b)| (a[1] > level) != (b[1] > level));
                crossings.clear();
                crossings.extend(across.map(|(a, b)| a[0] + (b[0] - a[0]) * (level - a[1]) / (b[1] - a[1])));
                crossings.sort_by(f64::total_cmp);
                crossings.chunks_exact(2).for_each(|run| add_run(&mut covered, columns.start, run[0], run[1]));
            }
            for (x, covered) in columns.clone().zip(&covered) {
                self.blend(x as i64, y as i64, colour, share * covered / f64::from(LEVELS));
            }
        }
    }

    /// The outline of an area.
    pub fn outline(&mut self, corners: &[Point], thickness: f64, colour: ChartColour, share: f64) {
        for (from, to) in edges(corners).collect::<Vec<_>>() {
            self.line(from, to, thickness, colour, share);
        }
    }

    /// Text with its top-left corner at (x, y); returns the x behind it.
    pub fn text(&mut self, x: i64, y: i64, scale: usize, colour: ChartColour, text: &str) -> i64 {
        let mut left = x;
        for letter in text.chars() {
            for column in 0..font::ADVANCE - 1 {
                for row in (0..font::HEIGHT).filter(|row| font::dot(letter, column, *row)) {
                    let corner = [left + (column * scale) as i64, y + (row * scale) as i64];
                    self.fill(corner, [scale as i64; 2], colour, 1.0);
                }
            }
            left += (font::ADVANCE * scale) as i64;
        }
        left
    }

    /// Text on a dark strip, so that it can be read on any picture.
    pub fn label(&mut self, x: i64, y: i64, scale: usize, colour: ChartColour, text: &str) {
        let size = [text_width(text, scale) + scale as i64 * 2, (font::HEIGHT * scale + scale * 3) as i64];
        self.fill([x, y], size, INK, 0.65);
        self.text(x + scale as i64 * 3 / 2, y + scale as i64 * 3 / 2, scale, colour, text);
    }

    /// Calls `draw` with every pixel near some points and its middle.
    fn for_pixels(&mut self, points: &[Point], reach: f64, mut draw: impl FnMut(&mut Self, i64, i64, Point)) {
        let range = |axis: usize, limit: usize| {
            let low = points.iter().map(|point| point[axis]).fold(f64::INFINITY, f64::min) - reach;
            let high = points.iter().map(|point| point[axis]).fold(f64::NEG_INFINITY, f64::max) + reach;
            let limit = limit as f64;
            low.clamp(0.0, limit) as i64..((high + 1.0).clamp(0.0, limit)) as i64
        };
        let columns = range(0, self.width);
        for y in range(1, self.height) {
            for x in columns.clone() {
                draw(self, x, y, [x as f64 + 0.5, y as f64 + 0.5]);
            }
        }
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    /// `preview-encode` when the encoder refuses the picture.
    pub fn png(&self) -> Result<Vec<u8>> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Balanced);
        encoder.write_header().and_then(|mut writer| writer.write_image_data(&self.rgb)).map_err(|error| {
            Diagnostic::new("preview-encode", Fault::Bug, "could not encode a PNG picture").because(error)
        })?;
        Ok(file)
    }
}

/// Width of a text, pixels.
pub fn text_width(text: &str, scale: usize) -> i64 {
    (text.chars().count() * font::ADVANCE * scale) as i64
}

/// Pixels along an axis that some points reach over, as far as the picture has them.
fn pixels_of(points: &[Point], axis: usize, limit: usize) -> std::ops::Range<usize> {
    let low = points.iter().map(|point| point[axis]).fold(f64::INFINITY, f64::min);
    let high = points.iter().map(|point| point[axis]).fold(f64::NEG_INFINITY, f64::max);
    let end = (high.ceil().max(0.0) as usize).min(limit);
    (low.max(0.0) as usize).min(end)..end
}

/// Adds a run along a row to how much of each pixel is covered; the first pixel is number `first`.
fn add_run(covered: &mut [f64], first: usize, from: f64, to: f64) {
    let (from, to) = ((from - first as f64).max(0.0), (to - first as f64).min(covered.len() as f64));
    let cells = covered.iter_mut().enumerate().skip(from as usize).take_while(|(cell, _)| (*cell as f64) < to);
    cells.for_each(|(cell, covered)| *covered += (to.min(cell as f64 + 1.0) - from.max(cell as f64)).max(0.0));
}

fn edges(corners: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| (*a, *b))
}

/// Length of a vector.
fn length_of([x, y]: Point) -> f64 {
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_and_lines_cover_what_they_should_and_nothing_outside_is_touched() {
        let mut canvas = Canvas::new(20, 10, WHITE);
        canvas.area(&[[2.0, 2.0], [8.0, 2.0], [8.0, 6.0], [2.0, 6.0]], INK, 1.0);
        assert_eq!((canvas.pixel(4, 4), canvas.pixel(12, 4), canvas.pixel(4, 8)), (INK, WHITE, WHITE));
        canvas.area(&[[2.0, 6.0], [8.0, 6.0], [8.0, 2.0], [2.0, 2.0]], [9, 9, 9], 1.0);
        assert_eq!(canvas.pixel(4, 4), [9, 9, 9], "either way round");
        canvas.line([-50.0, 8.5], [60.0, 8.5], 1.0, INK, 1.0);
        assert_eq!((canvas.pixel(0, 8), canvas.pixel(19, 8)), (INK, INK));
        canvas.disc([500.0, -20.0], 3.0, INK);
        assert_eq!(canvas.rgb.len(), 600);
    }

    #[test]
    fn areas_of_any_shape_are_filled_and_nothing_else_is() {
        let darkness = |corners: &[Point]| {
            let mut canvas = Canvas::new(40, 40, WHITE);
            canvas.area(corners, [0, 0, 0], 1.0);
            let sum: f64 = canvas.rgb.chunks(3).map(|pixel| 1.0 - f64::from(pixel[0]) / 255.0).sum();
            (canvas, sum)
        };
        let bend =
            [[0.0, 0.0], [40.0, 0.0], [40.0, 4.0], [20.0, 4.0], [10.0, 6.0], [6.0, 10.0], [4.0, 40.0], [0.0, 40.0]];
        let (canvas, sum) = darkness(&bend);
        for (x, y) in [(38, 2), (20, 3), (2, 2), (2, 38), (7, 7)] {
            assert_eq!(canvas.pixel(x, y), [0, 0, 0], "{x} {y}");
        }
        assert_eq!(canvas.pixel(20, 20), WHITE);
        let area: f64 = 0.5 * edges(&bend).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>();
        assert!((sum - area).abs() < 1.0, "{sum} {area}");
        // A bridge leads to the hole and back.
        let ring = [
            [2.0, 2.0],
            [38.0, 2.0],
            [38.0, 38.0],
            [2.0, 38.0],
            [2.0, 2.0],
            [10.0, 10.0],
            [10.0, 30.0],
            [30.0, 30.0],
            [30.0, 10.0],
            [10.0, 10.0],
        ];
        let (canvas, sum) = darkness(&ring);
        assert_eq!((canvas.pixel(20, 20), canvas.pixel(6, 6), canvas.pixel(5, 20)), (WHITE, [0; 3], [0; 3]));
        assert!((sum - (36.0 * 36.0 - 400.0)).abs() < 1e-6, "{sum}");
        // Crossed, beyond all edges, empty, not a number.
        let (canvas, _) = darkness(&[[-90.0, -90.0], [130.0, 130.0], [130.0, -90.0], [-90.0, 130.0]]);
        assert_eq!((canvas.pixel(2, 20), canvas.pixel(20, 5)), ([0; 3], WHITE));
        for corners in [
            &[][..],
            &[[5.0, 5.0]],
            &[[f64::NAN, 3.0], [9.0, f64::NAN], [4.0, 9.0]],
            &[[1e300, 0.0], [-1e300, 9.0], [0.0, 1e300]],
        ] {
            assert_eq!(darkness(corners).0.rgb.len(), 4800);
        }
    }

    #[test]
    fn text_is_drawn_and_cut_at_the_edges() {
        let mut canvas = Canvas::new(14, 9, WHITE);
        assert_eq!(canvas.text(1, 1, 1, INK, "I I"), 19);
        assert_eq!((canvas.pixel(3, 4), canvas.pixel(9, 4)), (INK, WHITE));
        assert_eq!(text_width("I I", 1), 18);
    }
}
