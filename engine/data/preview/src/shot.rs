//! One frame of a log as pictures of any size.

use cosfly_channel_pictures::false_colours::{palette_image, picture_on_request};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_images::read::{Picture, decoded};
use cosfly_plot::canvas::{Canvas, ChartColour, WHITE};
use cosfly_read::LoggedFrame;

/// Box of the target without obstacles.
pub const FULL_BOX: ChartColour = [255, 220, 40];
/// Box of its visible pixels.
pub const VISIBLE_BOX: ChartColour = [60, 255, 90];

/// A frame whose colour image is decoded.
pub struct ClipShot {
    /// Images, camera and target of the log.
    pub logged: LoggedFrame,
    /// The colour image.
    pub rgb: Canvas,
}

impl ClipShot {
    /// Decodes the colour image.
    pub fn new(logged: LoggedFrame) -> Result<Self> {
        let decoded = decoded(&logged.rgb_file, &logged.rgb_format);
        let decoded = decoded.map(|Picture { size: [width, height], rgb }| Canvas { width, height, rgb });
        let size = (logged.width as usize, logged.height as usize);
        let rgb = decoded.and_then(|canvas| match (canvas.width, canvas.height) == size {
            true => Ok(canvas),
            false => Err(format!("it has {} x {} pixels, not {} x {}", canvas.width, canvas.height, size.0, size.1)),
        });
        let rgb = rgb.map_err(|cause| {
            let message = format!("the colour image of frame {} cannot be read", logged.target.frame);
            Diagnostic::new("preview-image", Fault::Input, message).because(cause)
        })?;
        Ok(Self { logged, rgb })
    }

    /// The colour image with `width` x `height` pixels and the target's boxes.
    pub fn colour(&self, width: usize, height: usize) -> Canvas {
        let mut canvas = resized(&self.rgb, [0, 0, self.rgb.width, self.rgb.height], width, height);
        let scale = [width as f64 / self.rgb.width as f64, height as f64 / self.rgb.height as f64];
        let target = &self.logged.target;
        for (edges, colour) in [(&target.full_box_px, FULL_BOX), (&target.visible_box_px, VISIBLE_BOX)] {
            if let [left, top, right, bottom] = edges[..] {
                let [left, right] = [left, right].map(|x| f64::from(x) * scale[0]);
                let [top, bottom] = [top, bottom].map(|y| f64::from(y) * scale[1]);
                let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
                canvas.outline(&corners, 1.2, colour, 0.9);
            }
        }
        canvas
    }

    /// Depths of pixels in the middles of `width` x `height` cells.
    pub fn depths(&self, width: usize, height: usize) -> Vec<f32> {
        self.cells(width, height).map(|at| self.logged.depth_m[at]).collect()
    }

    /// The labels in CARLA's colours.
    pub fn labels(&self, width: usize, height: usize) -> Canvas {
        let ids: Vec<u8> = self.cells(width, height).map(|at| self.logged.semantic[at]).collect();
        Canvas { width, height, rgb: palette_image(&ids) }
    }

    /// The channels on request.
    pub fn on_request(&self, width: usize, height: usize) -> impl Iterator<Item = Canvas> {
        self.logged.on_request.iter().map(move |image| {
            let size = image.channel.bytes_on_request();
            let bytes: Vec<&[u8]> =
                self.cells(width, height).map(|at| &image.bytes[size * at..size * (at + 1)]).collect();
            Canvas { width, height, rgb: picture_on_request(image.channel, &bytes.concat()) }
        })
    }

    /// Whether a point without extent is watched: it is not drawn and has no pixels.
    fn is_point(&self) -> bool {
        self.logged.target.radius_m == 0.0
    }

    /// The visible share of the target, 0..=1: by pixels, or by rays where it has none.
    pub fn visible(&self) -> f64 {
        if self.is_point() { self.logged.target.visible_by_rays } else { self.logged.target.visible_by_pixels }
    }

    /// The neighbourhood of the target, `side` x `side` pixels: the middle of the image where a point is watched, grey
    /// where it is out of view.
    pub fn target(&self, side: usize) -> Canvas {
        let (middle, reach) = ([self.logged.width / 2, self.logged.height / 2], self.logged.height / 8);
        let around =
            [middle[0].saturating_sub(reach), middle[1].saturating_sub(reach), middle[0] + reach, middle[1] + reach];
        let edges = if self.is_point() { &around[..] } else { &self.logged.target.full_box_px[..] };
        let [left, top, right, bottom] = *edges else {
            let mut nothing = Canvas::new(side, side, [70, 72, 76]);
            nothing.text(8, (side / 2) as i64 - 4, 1, WHITE, "out of view");
            return nothing;
        };
        let (width, height) = (self.rgb.width, self.rgb.height);
        let size = (right.saturating_sub(left)).max(bottom.saturating_sub(top)) as usize;
        let window = (size * 7 / 4).clamp(24, width.min(height).max(24)).min(width).min(height);
        let corner = |low: u32, high: u32, limit: usize| {
            ((low as usize + high as usize) / 2).saturating_sub(window / 2).min(limit - window)
        };
        resized(&self.rgb, [corner(left, right, width), corner(top, bottom, height), window, window], side, side)
    }

    fn cells(&self, width: usize, height: usize) -> impl Iterator<Item = usize> {
        let (full_width, full_height) = (self.rgb.width, self.rgb.height);
        let middle = |i: usize, count: usize, total: usize| (2 * i + 1) * total / (2 * count);
        (0..height).flat_map(move |y| {
            let start = middle(y, height, full_height) * full_width;
            (0..width).map(move |x| start + middle(x, width, full_width))
        })
    }
}

/// A window (left, top, width, height) of a picture in another size: each pixel is the mean of those under it.
fn resized(picture: &Canvas, [left, top, wide, high]: [usize; 4], width: usize, height: usize) -> Canvas {
    let range = |i: usize, count: usize, total: usize| {
        let first = i * total / count;
        first..((i + 1) * total / count).max(first + 1)
    };
    let mut canvas = Canvas::new(width, height, WHITE);
    let mut pixels = canvas.rgb.chunks_exact_mut(3);
    for y in 0..height {
        for x in 0..width {
            let mut sums = [0u32; 3];
            let (rows, columns) = (range(y, height, high), range(x, width, wide));
            let count = (rows.len() * columns.len()) as u32;
            for row in rows {
                for column in columns.clone() {
                    let pixel = picture.pixel(left + column, top + row);
                    sums.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += u32::from(value));
                }
            }
            let mean = sums.map(|sum| ((sum + count / 2) / count) as u8);
            pixels.next().expect("one per cell").copy_from_slice(&mean);
        }
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_shrink_to_means_and_grow_by_repetition() {
        let mut canvas = Canvas::new(4, 2, [10, 20, 30]);
        canvas.blend(0, 0, [30, 20, 30], 1.0);
        let small = resized(&canvas, [0, 0, 4, 2], 2, 1);
        assert_eq!((small.pixel(0, 0), small.pixel(1, 0)), ([15, 20, 30], [10, 20, 30]));
        let large = resized(&canvas, [0, 0, 2, 2], 4, 4);
        assert_eq!((large.pixel(1, 1), large.pixel(2, 2)), ([30, 20, 30], [10, 20, 30]));
    }

    #[test]
    fn files_that_are_no_images_are_refused() {
        assert!(decoded(b"no image", "jpeg").is_err() && decoded(&[0; 40], "png").is_err());
        let logged = LoggedFrame { rgb_format: "bmp".into(), ..LoggedFrame::default() };
        assert!(ClipShot::new(logged).err().is_some_and(|error| error.causes[0].contains("`bmp`")));
    }
}
