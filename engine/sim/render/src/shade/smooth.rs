//! Softens stair steps along edges of the RGB image; depth and ids are left as sampled.
//!
//! Morphological anti-aliasing (Reshetov 2009) on edges that are known exactly, from the surfaces: where a border between
//! two surfaces runs along a row and steps to the next one, the true edge is taken as the straight line between the
//! middles of the steps, and each pixel beside it gets the other side's colour by the area that the line cuts off.
//! Borders are found as bits, 64 pixels at a time.

use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Bits of the borders around the row at hand; kept between frames.
#[derive(Default)]
pub(crate) struct Smoother {
    /// Bit c: pixels c and c + 1 of the row differ.
    right: Vec<u64>,
    /// The same in the row below.
    right_below: Vec<u64>,
    /// And above.
    right_above: Vec<u64>,
    /// Bit c: pixel c differs from the one below.
    below: Vec<u64>,
    /// And from the one above.
    above: Vec<u64>,
    /// For every column with an upright border that goes on: its first row and the step there.
    first: Vec<(u32, Step)>,
}

/// An image to smooth.
pub(crate) struct Picture<'a> {
    /// Equal numbers for pixels of one surface.
    pub surface: &'a [u32],
    /// Pixels before smoothing: red in the lowest byte, then green and blue.
    pub source: &'a [u32],
    /// The same as bytes, to be smoothed.
    pub rgb: &'a mut [u8],
    /// Pixels per row.
    pub width: usize,
}

impl Smoother {
    /// Blends pixels along all borders between surfaces.
    pub fn smooth(&mut self, level: Level, picture: &mut Picture<'_>) {
        let width = picture.width;
        if width < 3 || picture.surface.len() < 3 * width {
            return;
        }
        let height = picture.surface.len() / width;
        let words = width.div_ceil(64);
        for bits in [&mut self.right, &mut self.right_below, &mut self.right_above, &mut self.below, &mut self.above] {
            bits.clear();
            bits.resize(words, 0);
        }
        self.first.clear();
        self.first.resize(width, (0, Step::None));
        let row = |row: usize| &picture.surface[row * width..(row + 1) * width];
        differences(level, &row(0)[1..], &row(0)[..width - 1], &mut self.right);
        for number in 0..height {
            let has_next = number + 1 < height;
            if has_next {
                let (here, next) = (row(number), row(number + 1));
                differences(level, &next[1..], &next[..width - 1], &mut self.right_below);
                differences(level, here, next, &mut self.below);
            }
            let borders = Borders { source: picture.source, width };
            self.upright(&borders, number, picture.rgb);
            if has_next {
                self.level(&borders, number, picture.rgb);
            }
            core::mem::swap(&mut self.right_above, &mut self.right);
            core::mem::swap(&mut self.right, &mut self.right_below);
            core::mem::swap(&mut self.above, &mut self.below);
        }
        // What reaches the last row ends there.
        for word in 0..words {
            for column in bits(self.right_above[word], word) {
                let (first, step) = self.first[column];
                let piece = Piece {
                    start: first as usize * width + column,
                    length: height - first as usize,
                    along: width,
                    across: 1,
                };
                let borders = Borders { source: picture.source, width };
                borders.blend(&piece, step, false, picture.rgb);
            }
        }
    }

    /// Ends and begins pieces of upright borders at a row.
    fn upright(&mut self, borders: &Borders<'_>, row: usize, rgb: &mut [u8]) {
        for word in 0..self.right.len() {
            let (now, before) = (self.right[word], self.right_above[word]);
            if now | before == 0 {
                continue;
            }
            let step_left = self.above[word];
            let step_right = shifted_down(&self.above, word);
            let goes_on = now & before & !step_left & !step_right;
            let step_at = |column: usize| Step::of(step_left >> (column % 64), step_right >> (column % 64));
            for column in bits(before & !goes_on, word) {
                let (first, step) = self.first[column];
                let first = first as usize;
                let piece = Piece {
                    start: first * borders.width + column,
                    length: row - first,
                    along: borders.width,
                    across: 1,
                };
                borders.blend(&piece, step, false, rgb);
                borders.blend(&piece, step_at(column), true, rgb);
            }
            for column in bits(now & !goes_on, word) {
                self.first[column] = (row as u32, step_at(column));
            }
        }
    }

    /// Smooths the border between a row and the next one.
    fn level(&self, borders: &Borders<'_>, row: usize, rgb: &mut [u8]) {
        let width = borders.width;
        // Bit c: one of the rows changes between c - 1 and c.
        let breaks = |word: usize| shifted_up(&self.right, word) | shifted_up(&self.right_below, word);
        let is_set = |bits: &[u64], column: usize| bits[column / 64] >> (column % 64) & 1;
        let step_at = |column: usize| {
            if column == 0 || column >= width {
                return Step::None;
            }
            Step::of(is_set(&self.right, column - 1), is_set(&self.right_below, column - 1))
        };
        for word in 0..self.below.len() {
            let differs = self.below[word];
            if differs == 0 {
                continue;
            }
            let starts = differs & (breaks(word) | !shifted_up(&self.below, word));
            for start in bits(starts, word) {
                // The next column where the border ends or either row changes.
                let mut at = word;
                let beyond = if start % 64 == 63 { 0 } else { u64::MAX << (start % 64 + 1) };
                let mut stops = (!differs | breaks(word)) & beyond;
                while stops == 0 && at + 1 < self.below.len() {
                    at += 1;
                    stops = !self.below[at] | breaks(at);
                }
                let end = (64 * at + stops.trailing_zeros() as usize).min(width);
                let piece = Piece { start: row * width + start, length: end - start, along: 1, across: width };
                borders.blend(&piece, step_at(start), false, rgb);
                borders.blend(&piece, step_at(end), true, rgb);
            }
        }
    }
}

/// Bit c of the result is bit c - 1 of the row's bits.
fn shifted_up(bits: &[u64], word: usize) -> u64 {
    let carried = if word > 0 { bits[word - 1] >> 63 } else { 0 };
    bits[word] << 1 | carried
}

/// Bit c of the result is bit c + 1 of the row's bits.
fn shifted_down(bits: &[u64], word: usize) -> u64 {
    let carried = bits.get(word + 1).map_or(0, |next| next << 63);
    bits[word] >> 1 | carried
}

/// Columns of the set bits of a word.
fn bits(mut bits: u64, word: usize) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let bit = bits.trailing_zeros() as usize;
        (bits != 0).then(|| {
            bits &= bits - 1;
            64 * word + bit
        })
    })
}

simd_kernel! {
    /// Sets the bits of the places where two rows differ.
    fn differences(a: &[u32], b: &[u32], bits: &mut [u64]) {
        for ((a, b), word) in a.chunks(64).zip(b.chunks(64)).zip(bits.iter_mut()) {
            let mut flags = [0u8; 64];
            if let (Some(a), Some(b)) = (a.first_chunk::<64>(), b.first_chunk::<64>()) {
                for k in 0..64 {
                    flags[k] = u8::from(a[k] != b[k]);
                }
            } else {
                for ((a, b), flag) in a.iter().zip(b).zip(&mut flags) {
                    *flag = u8::from(a != b);
                }
            }
            *word = 0;
            for (k, eight) in flags.chunks_exact(8).enumerate() {
                let mut bytes = [0; 8];
                bytes.copy_from_slice(eight);
                // Gathers the lowest bits of eight bytes in the highest byte.
                let gathered = u64::from_le_bytes(bytes).wrapping_mul(0x0102_0408_1020_4080) >> 56;
                *word |= gathered << (8 * k);
            }
        }
    }
}

/// The image before smoothing.
struct Borders<'a> {
    source: &'a [u32],
    width: usize,
}

impl Borders<'_> {
    /// Blends the half of a piece next to one of its ends: the edge starts half a pixel aside, where the step is,
    /// and comes back to the border in the middle of the piece.
    #[inline]
    fn blend(&self, piece: &Piece, step: Step, from_end: bool, rgb: &mut [u8]) {
        if step == Step::None {
            return;
        }
        let half = 0.5 * piece.length as f32;
        // Area between border and edge from the end to t.
        let slope = 0.5 / (2.0 * half);
        let area = |t: f32| 0.5 * t - t * t * slope;
        let mut before = 0.0;
        for index in 0..piece.length.div_ceil(2) {
            let after = area((index as f32 + 1.0).min(half));
            let weight = ((after - before) * 256.0) as i32;
            before = after;
            let place = if from_end { piece.length - 1 - index } else { index };
            let near = piece.start + place * piece.along;
            let (changed, other) = match step {
                Step::Near => (near, near + piece.across),
                _ => (near + piece.across, near),
            };
            let (own, foreign) = (self.source[changed].to_le_bytes(), self.source[other].to_le_bytes());
            for (channel, byte) in rgb[3 * changed..3 * changed + 3].iter_mut().enumerate() {
                let change = (weight * (i32::from(foreign[channel]) - i32::from(own[channel]))) >> 8;
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

impl Step {
    /// From the lowest bits: whether the near and the far side step.
    fn of(near: u64, far: u64) -> Self {
        match (near & 1, far & 1) {
            (1, 0) => Self::Near,
            (0, 1) => Self::Far,
            _ => Self::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn smoothed(surface: &[u32], width: usize) -> Vec<u8> {
        let source: Vec<u32> = surface.iter().map(|number| if *number == 1 { 0x00ff_ffff } else { 0 }).collect();
        let mut rgb: Vec<u8> = source.iter().flat_map(|pixel| pixel.to_le_bytes()[..3].to_vec()).collect();
        let mut picture = Picture { surface, source: &source, rgb: &mut rgb, width };
        Smoother::default().smooth(Level::best(), &mut picture);
        rgb
    }

    #[test]
    fn slanted_edges_get_greys_either_way_and_straight_ones_stay() {
        let (width, height) = (150, 40);
        let slanted = |x: usize, y: usize| u32::from(4 * y > x);
        let flat: Vec<u32> = (0..width * height).map(|i| slanted(i % width, i / width)).collect();
        let grey = |rgb: &[u8]| rgb.iter().filter(|byte| !matches!(byte, 0 | 255)).count();
        let along_rows = grey(&smoothed(&flat, width));
        assert!(along_rows > 200, "{along_rows}");
        let turned: Vec<u32> = (0..width * height).map(|i| slanted(i / height, i % height)).collect();
        assert_eq!(grey(&smoothed(&turned, height)), along_rows);
        let straight: Vec<u32> = (0..width * height).map(|i| u32::from(i % width > 70)).collect();
        assert_eq!(grey(&smoothed(&straight, width)), 0);
    }

    #[test]
    fn differences_are_bits() {
        let a: Vec<u32> = (0..130).collect();
        let mut b = a.clone();
        (b[0], b[64], b[129]) = (9, 9, 9);
        let mut bits = [0; 3];
        differences(Level::best(), &a, &b, &mut bits);
        assert_eq!(bits, [1, 1, 2]);
    }
}
