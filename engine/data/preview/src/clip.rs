//! The clip: an animated GIF with colours at the left, depth and labels at the right, visibility below.

use crate::shot::{ClipShot, FULL_BOX, VISIBLE_BOX};
use color_quant::NeuQuant;
use cosfly_channel_pictures::false_colours::DepthScale;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::SemanticLabel;
use cosfly_plot::canvas::{Canvas, ChartColour, INK, WHITE};
use std::borrow::Cow;
use std::cell::OnceCell;

/// Width of the colour image.
const WIDE: usize = 480;
/// Height of the strip with the visibility of all frames.
const STRIP: usize = 26;
/// Duration of a picture, hundredths of a second.
const DELAY_CS: u16 = 10;
/// Palette entries of the colour image and of depth; labels and drawings have theirs exactly.
const COLOURS: usize = 150;
const DEPTHS: usize = 64;
/// Pictures from which the palette is learnt.
const SAMPLED: usize = 12;

/// A clip that grows frame by frame.
#[derive(Default)]
pub struct Clip {
    size: [usize; 2],
    frames: Vec<ClipFrame>,
}

struct ClipFrame {
    colour: Canvas,
    depths: Vec<f32>,
    labels: Canvas,
    frame: u32,
    time_s: f64,
    visible: f64,
}

impl Clip {
    /// Adds a frame.
    pub fn add(&mut self, shot: &ClipShot) {
        // Even sides, so that two half pictures fill one; tall images are narrower than wide ones.
        let (width, height) = (shot.rgb.width, shot.rgb.height);
        let wide = WIDE.min(width.max(160)).min((WIDE * width).div_ceil(height));
        let wide = wide.next_multiple_of(2).max(16);
        let high = (height * wide / width).clamp(2, WIDE).next_multiple_of(2);
        self.size = [wide, high];
        let target = &shot.logged.target;
        self.frames.push(ClipFrame {
            colour: shot.colour(wide, high),
            depths: shot.depths(wide / 2, high / 2),
            labels: shot.labels(wide / 2, high / 2),
            frame: target.frame,
            time_s: target.time_s,
            visible: shot.visible(),
        });
    }

    /// The clip as a GIF file that repeats forever.
    pub fn finish(self) -> Result<Vec<u8>> {
        let refused = |error: gif::EncodingError| {
            Diagnostic::new("preview-encode", Fault::Bug, "could not encode a GIF clip").because(error)
        };
        let [wide, high] = self.size;
        let (width, height) = (wide + wide / 2, high + STRIP);
        let scale = DepthScale::of(self.frames.iter().flat_map(|frame| frame.depths.iter().copied()));
        let palette = Palette::learn(&self.frames, scale);
        let mut encoder =
            gif::Encoder::new(vec![], width as u16, height as u16, &palette.colours()).map_err(refused)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(refused)?;
        for place in 0..self.frames.len() {
            let frame = gif::Frame {
                delay: DELAY_CS,
                width: width as u16,
                height: height as u16,
                buffer: Cow::Owned(self.indices(place, &palette, scale)),
                ..gif::Frame::default()
            };
            encoder.write_frame(&frame).map_err(refused)?;
        }
        encoder.into_inner().map_err(refused)
    }

    /// Palette entries of a whole picture, row by row.
    fn indices(&self, place: usize, palette: &Palette, scale: DepthScale) -> Vec<u8> {
        let [wide, high] = self.size;
        let frame = &self.frames[place];
        let depth = Canvas { width: wide / 2, height: high / 2, rgb: scale.colours(&frame.depths) };
        let strip = self.strip(place);
        let mut indices = Vec::with_capacity((wide + wide / 2) * (high + STRIP));
        for y in 0..high {
            indices.extend((0..wide).map(|x| palette.colour.of(frame.colour.pixel(x, y), x, y)));
            indices.extend((0..wide / 2).map(|x| match y.checked_sub(high / 2) {
                None => palette.depth.of(depth.pixel(x, y), x, y),
                Some(row) => palette.exact.of(frame.labels.pixel(x, row)),
            }));
        }
        indices.extend((0..STRIP).flat_map(|y| {
            let (strip, palette) = (&strip, palette);
            (0..wide + wide / 2).map(move |x| palette.exact.of(strip.pixel(x, y)))
        }));
        indices
    }

    /// The visibility of all frames, a mark at the current one, and its number.
    fn strip(&self, place: usize) -> Canvas {
        let width = self.size[0] * 3 / 2;
        let mut strip = Canvas::new(width, STRIP, INK);
        let frame = &self.frames[place];
        let words = format!("frame {}  {:.1} s  visible {:.0} %", frame.frame, frame.time_s, 100.0 * frame.visible);
        let left = 200.min(width * 2 / 5);
        strip.text(6, 10, 1, WHITE, &words);
        for x in left..width - 4 {
            let at = (x - left) * self.frames.len() / (width - 4 - left);
            let tall = (self.frames[at].visible * (STRIP - 8) as f64 + 0.5) as i64;
            let colour = ramp(self.frames[at].visible);
            strip.fill([x as i64, (STRIP - 4) as i64 - tall], [1, tall], colour, 1.0);
            if at == place {
                strip.fill([x as i64, 2], [1, (STRIP - 4) as i64], WHITE, 1.0);
            }
        }
        strip
    }
}

const RAMP: [ChartColour; 5] = [[215, 48, 39], [244, 120, 60], [250, 200, 70], [150, 205, 90], [40, 165, 80]];

/// Red (nothing is visible) to green (all of it), in five steps.
pub fn ramp(visible: f64) -> ChartColour {
    RAMP[(visible.clamp(0.0, 1.0) * 4.0 + 0.5) as usize]
}

/// One palette whose parts belong to the pictures of a frame.
struct Palette {
    colour: Learnt,
    depth: Learnt,
    exact: Exact,
}

/// Colours learnt from pictures, and the nearest of them to every colour.
struct Learnt {
    first: usize,
    colours: Vec<ChartColour>,
    /// By 6 bits of red, green and blue; found when a picture has the colour, which few colours are.
    nearest: Vec<OnceCell<u8>>,
}

/// Colours that are used as they are.
struct Exact {
    first: usize,
    colours: Vec<ChartColour>,
}

impl Palette {
    fn learn(frames: &[ClipFrame], scale: DepthScale) -> Self {
        let sampled = crate::selection::spread(frames.len(), SAMPLED);
        let colour = sampled.iter().flat_map(|at| frames[*at].colour.rgb.iter().copied()).collect();
        let depth = sampled.iter().flat_map(|at| scale.colours(&frames[*at].depths)).collect();
        let colour = Learnt::learn(0, COLOURS, colour, &[FULL_BOX, VISIBLE_BOX]);
        let depth = Learnt::learn(COLOURS, DEPTHS, depth, &[[0, 0, 0]]);
        let mut exact: Vec<ChartColour> = SemanticLabel::ALL.iter().map(|label| label.colour()).collect();
        exact.extend(RAMP.into_iter().chain([INK, WHITE]));
        exact.truncate(256 - COLOURS - DEPTHS);
        Self { colour, depth, exact: Exact { first: COLOURS + DEPTHS, colours: exact } }
    }

    fn colours(&self) -> Vec<u8> {
        let all = self.colour.colours.iter().chain(&self.depth.colours).chain(&self.exact.colours);
        all.flatten().copied().collect()
    }
}

impl Learnt {
    /// `count` colours from `first` on, `kept` among them.
    fn learn(first: usize, count: usize, rgb: Vec<u8>, kept: &[ChartColour]) -> Self {
        let rgba: Vec<u8> = rgb.chunks_exact(3).flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255]).collect();
        let learnt = NeuQuant::new(7, count - kept.len(), &rgba).color_map_rgb();
        let mut colours: Vec<ChartColour> = learnt.chunks_exact(3).map(|it| [it[0], it[1], it[2]]).collect();
        colours.extend(kept);
        Self { first, colours, nearest: vec![OnceCell::new(); 1 << 18] }
    }

    /// The entry that is nearest to a colour of 6 bits each.
    fn find(&self, cell: usize) -> u8 {
        let colour = [cell >> 12, cell >> 6, cell].map(|bits| ((bits & 63) * 255 / 63) as i32);
        let distance = |other: &ChartColour| {
            let d: [i32; 3] = core::array::from_fn(|i| colour[i] - i32::from(other[i]));
            2 * d[0] * d[0] + 4 * d[1] * d[1] + 3 * d[2] * d[2]
        };
        let nearest = self.colours.iter().enumerate().min_by_key(|(_, other)| distance(other));
        (self.first + nearest.map_or(0, |(at, _)| at)) as u8
    }

    /// The entry for a colour at a place: ordered dithering, so that still parts of a picture stay still.
    fn of(&self, colour: ChartColour, x: usize, y: usize) -> u8 {
        const ORDER: [[i32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
        let shift = (ORDER[y % 4][x % 4] - 7) / 2;
        let bits = colour.map(|value| ((i32::from(value) + shift).clamp(0, 255) as usize * 63 + 127) / 255);
        let cell = bits[0] << 12 | bits[1] << 6 | bits[2];
        let entry = *self.nearest[cell].get_or_init(|| self.find(cell));
        debug_assert!(usize::from(entry) >= self.first);
        entry
    }
}

impl Exact {
    /// The entry for a colour; the first one for a colour that is not listed.
    fn of(&self, colour: ChartColour) -> u8 {
        (self.first + self.colours.iter().position(|it| *it == colour).unwrap_or(0)) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_palette_has_room_for_every_label_and_drawing() {
        assert!(SemanticLabel::ALL.len() + RAMP.len() + 2 <= 256 - COLOURS - DEPTHS);
        assert_eq!((ramp(0.0), ramp(1.0), ramp(7.0)), (RAMP[0], RAMP[4], RAMP[4]));
    }

    #[test]
    fn a_learnt_palette_finds_near_colours() {
        let rgb: Vec<u8> = (0..3000u32).flat_map(|i| [(i % 256) as u8, (i % 200) as u8, 30]).collect();
        let learnt = Learnt::learn(10, 70, rgb, &[VISIBLE_BOX]);
        let found = learnt.colours[usize::from(learnt.of([100, 100, 30], 1, 1)) - 10];
        assert!(found.iter().zip([100, 100, 30]).all(|(a, b)| a.abs_diff(b) < 40), "{found:?}");
        let kept = learnt.colours[usize::from(learnt.of(VISIBLE_BOX, 1, 1)) - 10];
        assert_eq!(kept, VISIBLE_BOX);
    }
}
