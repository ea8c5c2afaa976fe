//! Softens stair steps along edges of the RGB image; depth and ids are left as sampled.
//!
//! Morphological anti-aliasing (Reshetov 2009) on edges that are known exactly, from the surfaces: where a border between
//! two surfaces runs along a row and steps to the next one, the true edge is taken as the straight line between the
//! middles of the steps, and each pixel beside it gets the other side's colour by the area that the line cuts off, one piece of
//! border after the other.
//! Borders are found as bits, 64 pixels at a time.

use crate::passes::ids::{Run, for_each_bit};

/// Bits of the borders around the row at hand; kept between frames.
#[derive(Default)]
pub(crate) struct Smoother {
    /// Bit c: pixels c and c + 1 of the row differ.
    right: Vec<u64>,
    /// Bit c: pixels c and c + 1 of the row below differ.
    right_below: Vec<u64>,
    /// Bit c: pixels c and c + 1 of the row above differ.
    right_above: Vec<u64>,
    /// Bit c: pixel c differs from the one below.
    below: Vec<u64>,
    /// Bit c: pixel c differs from the one above.
    above: Vec<u64>,
    /// For every column with an upright border that goes on: its first row and the step there.
    first: Vec<(u32, Step)>,
}

impl Smoother {
    /// Blends pixels along all borders between surfaces, given each row's runs.
    pub fn smooth<'a>(&mut self, rows: impl Iterator<Item = &'a [Run]>, width: usize, rgb: &mut [u8]) {
        if width < 3 || rgb.len() < 9 * width {
            return;
        }
        let height = rgb.len() / 3 / width;
        let words = width.div_ceil(64);
        for bits in [&mut self.right, &mut self.right_below, &mut self.right_above, &mut self.below, &mut self.above] {
            bits.clear();
            bits.resize(words, 0);
        }
        self.first.clear();
        self.first.resize(width, (0, Step::None));
        let mut borders = Borders { rgb, width };
        let mut rows = rows.peekable();
        let mut number = 0;
        while let Some(row) = rows.next() {
            if number == 0 {
                borders_right(row, width, &mut self.right);
            }
            if let Some(next) = rows.peek() {
                borders_right(next, width, &mut self.right_below);
                borders_below(row, next, width, &mut self.below);
            }
            self.upright(&mut borders, number);
            if rows.peek().is_some() {
                self.level(&mut borders, number);
            }
            core::mem::swap(&mut self.right_above, &mut self.right);
            core::mem::swap(&mut self.right, &mut self.right_below);
            core::mem::swap(&mut self.above, &mut self.below);
            number += 1;
        }
        // Edges that reach the last row end there.
        for_each_bit(&self.right_above, |column| {
            let (first, step) = self.first[column];
            borders.blend(&Piece::upright(column, first as usize..height, width), step, false);
        });
    }

    /// Ends and begins pieces of upright borders at a row.
    fn upright(&mut self, borders: &mut Borders<'_>, row: usize) {
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
                let piece = Piece::upright(column, first as usize..row, borders.width);
                borders.blend(&piece, step, false);
                borders.blend(&piece, step_at(column), true);
            }
            for column in bits(now & !goes_on, word) {
                self.first[column] = (row as u32, step_at(column));
            }
        }
    }

    /// Smooths the border between a row and the next one.
    fn level(&self, borders: &mut Borders<'_>, row: usize) {
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
                borders.blend(&piece, step_at(start), false);
                borders.blend(&piece, step_at(end), true);
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

/// Sets the bits of a row's pixels that differ from the next one.
fn borders_right(row: &[Run], width: usize, bits: &mut [u64]) {
    bits.fill(0);
    let mut end = 0;
    for pair in row.windows(2) {
        end += pair[0].length as usize;
        if pair[0].surface != pair[1].surface && end < width {
            bits[(end - 1) / 64] |= 1 << ((end - 1) % 64);
        }
    }
}

/// Sets the bits of a row's pixels that differ from the ones below.
fn borders_below(row: &[Run], below: &[Run], width: usize, bits: &mut [u64]) {
    bits.fill(0);
    let (mut upper, mut lower) = (row.iter(), below.iter());
    let (Some(mut here), Some(mut there)) = (upper.next(), lower.next()) else { return };
    let (mut end_here, mut end_there) = (here.length as usize, there.length as usize);
    let mut at = 0;
    loop {
        let end = end_here.min(end_there).min(width);
        if here.surface != there.surface {
            set_bits(bits, at, end);
        }
        at = end;
        if end_here == end {
            let Some(next) = upper.next() else { return };
            (here, end_here) = (next, end_here + next.length as usize);
        }
        if end_there == end {
            let Some(next) = lower.next() else { return };
            (there, end_there) = (next, end_there + next.length as usize);
        }
    }
}

/// Sets bits `from` to before `to`.
fn set_bits(bits: &mut [u64], from: usize, to: usize) {
    if from >= to {
        return;
    }
    let (first, last) = (from / 64, (to - 1) / 64);
    let (low, high) = (u64::MAX << (from % 64), u64::MAX >> (63 - (to - 1) % 64));
    if first == last {
        bits[first] |= low & high;
        return;
    }
    bits[first] |= low;
    bits[first + 1..last].fill(u64::MAX);
    bits[last] |= high;
}

/// The image on its way.
struct Borders<'a> {
    rgb: &'a mut [u8],
    width: usize,
}

impl Borders<'_> {
    /// Blends the half of a piece next to one of its ends: the edge starts half a pixel aside, where the step is,
    /// and comes back to the border in the middle of the piece.
    #[inline]
    fn blend(&mut self, piece: &Piece, step: Step, from_end: bool) {
        if step == Step::None {
            return;
        }
        let Piece { start, length, along, across } = *piece;
        let half = 0.5 * length as u32 as f32;
        // Area between border and edge from the end to t.
        let slope = 0.5 / (2.0 * half);
        let area = |t: f32| 0.5 * t - t * t * slope;
        let mut before = 0.0;
        let (mut near, step_on) = match from_end {
            true => (start.wrapping_add(length.wrapping_sub(1).wrapping_mul(along)), along.wrapping_neg()),
            false => (start, along),
        };
        for index in 1..=length.div_ceil(2) as u32 {
            let after = area((index as f32).min(half));
            let weight = ((after - before) * 256.0) as i32;
            before = after;
            let far = near.wrapping_add(across);
            let (changed, other) = if step == Step::Near { (near, far) } else { (far, near) };
            near = near.wrapping_add(step_on);
            let pixel = |number: usize| self.rgb.get(number.wrapping_mul(3)..).and_then(|rest| rest.first_chunk::<3>());
            if let (Some(&own), Some(&foreign)) = (pixel(changed), pixel(other))
                && let Some(rest) = self.rgb.get_mut(changed.wrapping_mul(3)..)
                && let Some(pixel) = rest.first_chunk_mut::<3>()
            {
                for k in 0..3 {
                    let difference = i32::from(foreign[k]) - i32::from(own[k]);
                    pixel[k] = (i32::from(own[k]) + (weight.wrapping_mul(difference) >> 8)) as u8;
                }
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

impl Piece {
    /// Along the right side of a column's pixels.
    fn upright(column: usize, rows: core::ops::Range<usize>, width: usize) -> Self {
        Self { start: rows.start * width + column, length: rows.len(), along: width, across: 1 }
    }
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
        let mut rgb: Vec<u8> = surface.iter().flat_map(|number| [if *number == 1 { 255 } else { 0 }; 3]).collect();
        let runs = |row: &[u32]| -> Vec<Run> {
            row.chunk_by(|a, b| a == b)
                .scan(0, |start, run| {
                    let length = run.len() as u32;
                    *start += length;
                    Some(Run { start: *start - length, length, face: run[0], surface: run[0] })
                })
                .collect()
        };
        let rows: Vec<Vec<Run>> = surface.chunks(width).map(runs).collect();
        Smoother::default().smooth(rows.iter().map(Vec::as_slice), width, &mut rgb);
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
    fn bits_are_set_over_words() {
        let mut bits = [0; 4];
        set_bits(&mut bits, 60, 130);
        assert_eq!(bits, [0xf << 60, u64::MAX, 3, 0]);
        set_bits(&mut bits, 192, 256);
        assert_eq!(bits[3], u64::MAX);
        set_bits(&mut bits, 3, 3);
        assert_eq!(bits[0], 0xf << 60);
    }
}
