//! Softens stair steps along edges of the RGB image; depth and ids are left as sampled.
//!
//! Morphological anti-aliasing (Reshetov 2009) on edges that are known exactly, from the faces: where a border between
//! two surfaces runs along a row and steps to the next one, the true edge is taken as the straight line between the
//! middles of the steps, and each pixel beside it gets the other side's colour by the area that the line cuts off.

use crate::frame::FrameImages;
use crate::renderer::{DrawnFace, FaceSource};
use crate::visibility::{NO_FACE, Visibility};

/// Blends pixels of `picture` along all borders between surfaces into `images`.
pub(crate) fn smooth_edges(nearest: &Visibility, faces: &[DrawnFace], picture: &[u32], images: &mut FrameImages) {
    let (width, height) = (images.width as usize, images.height as usize);
    for (rgb, pixel) in images.rgb.chunks_exact_mut(3).zip(picture) {
        let [r, g, b, _] = pixel.to_le_bytes();
        rgb.copy_from_slice(&[r, g, b]);
    }
    if width < 3 || height < 3 {
        return;
    }
    let borders = Borders { seen: &nearest.face, faces, source: picture };
    for row in 0..height - 1 {
        borders.walk(row * width, width, 1, width, &mut images.rgb);
    }
    for column in 0..width - 1 {
        borders.walk(column, height, width, 1, &mut images.rgb);
    }
}

/// The image before smoothing and what is seen in it.
struct Borders<'a> {
    seen: &'a [u32],
    faces: &'a [DrawnFace],
    source: &'a [u32],
}

impl Borders<'_> {
    /// Goes along one line of `length` pixels from `start` by `along` and smooths its border to the line `across` it.
    fn walk(&self, start: usize, length: usize, along: usize, across: usize, rgb: &mut [u8]) {
        let mut position = 0;
        while position < length {
            let near = start + position * along;
            if self.seen[near] == self.seen[near + across] || !self.differ(near, near + across) {
                position += 1;
                continue;
            }
            let mut end = position + 1;
            while end < length {
                let (here, before) = (start + end * along, start + (end - 1) * along);
                let goes_on = self.differ(here, here + across)
                    && !self.differ(here, before)
                    && !self.differ(here + across, before + across);
                if !goes_on {
                    break;
                }
                end += 1;
            }
            let step_at = |inside: usize, outside: usize| {
                let near_steps = self.differ(start + inside * along, start + outside * along);
                let far_steps = self.differ(start + inside * along + across, start + outside * along + across);
                match (near_steps, far_steps) {
                    (true, false) => Step::Near,
                    (false, true) => Step::Far,
                    _ => Step::None,
                }
            };
            let first = if position > 0 { step_at(position, position - 1) } else { Step::None };
            let last = if end < length { step_at(end - 1, end) } else { Step::None };
            let piece = Piece { start: start + position * along, length: end - position, along, across };
            self.blend(&piece, first, false, rgb);
            self.blend(&piece, last, true, rgb);
            position = end;
        }
    }

    /// Whether two pixels show different surfaces. Triangles of one kind of ground are one surface.
    #[inline(always)]
    fn differ(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.seen[a], self.seen[b]);
        if a == b {
            return false;
        }
        if a == NO_FACE || b == NO_FACE {
            return true;
        }
        let (a, b) = (&self.faces[a as usize], &self.faces[b as usize]);
        let ground = |face: &DrawnFace| matches!(face.source, FaceSource::Ground { .. });
        let figure = |face: &DrawnFace| matches!(face.source, FaceSource::Figure { .. });
        !(ground(a) && ground(b) && a.label == b.label || figure(a) && figure(b))
    }

    /// Blends the half of a piece next to one of its ends: the edge starts half a pixel aside, where the step is,
    /// and comes back to the border in the middle of the piece.
    fn blend(&self, piece: &Piece, step: Step, from_end: bool, rgb: &mut [u8]) {
        if step == Step::None {
            return;
        }
        let half = 0.5 * piece.length as f32;
        // Area between border and edge from the end to t.
        let area = |t: f32| 0.5 * (t - t * t / (2.0 * half));
        for index in 0..piece.length.div_ceil(2) {
            let share = area((index as f32 + 1.0).min(half)) - area(index as f32);
            let place = if from_end { piece.length - 1 - index } else { index };
            let near = piece.start + place * piece.along;
            let (changed, other) = match step {
                Step::Near => (near, near + piece.across),
                _ => (near + piece.across, near),
            };
            let weight = (share * 256.0) as i32;
            let (own, foreign) = (self.source[changed].to_le_bytes(), self.source[other].to_le_bytes());
            for (channel, byte) in rgb[3 * changed..3 * changed + 3].iter_mut().enumerate() {
                let change = weight * (i32::from(foreign[channel]) - i32::from(own[channel])) / 256;
                *byte = (i32::from(*byte) + change).clamp(0, 255) as u8;
            }
        }
    }
}

/// A straight piece of border: its pixels on the near side, and the way to the far side.
struct Piece {
    start: usize,
    length: usize,
    along: usize,
    across: usize,
}

/// On which side of a border its piece ends with a step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Step {
    Near,
    Far,
    None,
}
