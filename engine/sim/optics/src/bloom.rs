//! The glow around bright lamps: light that lens and sensor scatter, from cells of eight by eight pixels.

use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Side of a cell, pixels.
const CELL: usize = 8;
/// Codes above this glow.
const BRIGHT: u8 = 200;
/// Glow that shows, codes.
const LEAST: f32 = 0.3;
/// Passes of the mean over three neighbours, both ways.
const PASSES: usize = 4;

/// Codes of a cell's row.
const CODES: usize = 3 * CELL;

/// Cells of bright light: red, green and blue of one after the other.
#[derive(Default)]
pub struct Bloom {
    cells: Vec<f32>,
    other: Vec<f32>,
    /// Highest codes of the rows of a row of cells.
    highest: Vec<u8>,
    /// Glow at the middles of cells in the height of a row.
    row: Vec<f32>,
}

impl Bloom {
    /// Adds the glow of an image `width` pixels wide to it.
    pub fn add(&mut self, level: Level, strength: f32, width: usize, rgb: &mut [u8]) {
        let bytes = 3 * width;
        if width == 0 || rgb.len() < bytes {
            return;
        }
        let (columns, rows) = (width.div_ceil(CELL), (rgb.len() / bytes).div_ceil(CELL));
        let floats = 3 * columns;
        self.cells.clear();
        self.cells.resize(floats * rows, 0.0);
        for (lines, cells) in rgb.chunks(CELL * bytes).zip(self.cells.chunks_exact_mut(floats)) {
            self.highest.clear();
            self.highest.resize(bytes, 0);
            lines.chunks_exact(bytes).for_each(|line| raise(level, line, &mut self.highest));
            gather(lines, &self.highest, cells);
        }
        if self.cells.iter().all(|light| *light == 0.0) {
            return;
        }
        self.other.resize(self.cells.len(), 0.0);
        for _ in 0..PASSES {
            mean_along(level, &self.cells, &mut self.other, floats);
            mean_across(level, &self.other, &mut self.cells, floats);
        }
        let scale = strength * 2.2 / (CELL * CELL) as f32;
        self.row.resize(floats, 0.0);
        for (y, line) in rgb.chunks_exact_mut(bytes).enumerate() {
            let v = ((y as f32 + 0.5) / CELL as f32 - 0.5).max(0.0);
            let upper = v as usize;
            let lower = (upper + 1).min(rows - 1);
            let t = v - upper as f32;
            let (above, below) = (&self.cells[upper * floats..][..floats], &self.cells[lower * floats..][..floats]);
            if blend(level, above, below, t, scale, &mut self.row) > LEAST {
                screen(level, &self.row, line);
            }
        }
    }
}

simd_kernel! {
    /// The higher codes of two rows.
    fn raise(line: &[u8], highest: &mut [u8]) {
        for (highest, code) in highest.iter_mut().zip(line) {
            *highest = (*highest).max(*code);
        }
    }
}

/// Adds the light of a row of cells' pixels beyond the limit to them.
fn gather(lines: &[u8], highest: &[u8], cells: &mut [f32]) {
    for (at, (part, cell)) in highest.chunks(CODES).zip(cells.as_chunks_mut::<3>().0).enumerate() {
        if part.iter().all(|code| *code <= BRIGHT) {
            continue;
        }
        for line in lines.chunks_exact(highest.len()) {
            for pixel in line[at * CODES..][..part.len()].as_chunks::<3>().0 {
                for (sum, code) in cell.iter_mut().zip(pixel) {
                    *sum += f32::from(code.saturating_sub(BRIGHT));
                }
            }
        }
    }
}

simd_kernel! {
    /// Means of each cell and its neighbours on the left and right, for rows of `floats` numbers.
    fn mean_along(from: &[f32], to: &mut [f32], floats: usize) {
        for (from, to) in from.chunks_exact(floats).zip(to.chunks_exact_mut(floats)) {
            let end = floats.wrapping_sub(3);
            let at = |start: usize, end: usize| from.get(start..end).unwrap_or(&[]);
            let inner = to.get_mut(3..end).unwrap_or(&mut []);
            for (((to, left), right), own) in
                inner.iter_mut().zip(at(0, end.wrapping_sub(3))).zip(at(6, floats)).zip(at(3, end))
            {
                *to = 0.25 * (left + right) + 0.5 * own;
            }
            // The border's neighbour is itself.
            for k in [0, 1, 2, end, end.wrapping_add(1), end.wrapping_add(2)] {
                let left = if k < 3 { k } else { k.wrapping_sub(3) };
                let right = if k >= end { k } else { k.wrapping_add(3) };
                to[k] = 0.25 * (from[left] + from[right]) + 0.5 * from[k];
            }
        }
    }
}

simd_kernel! {
    /// Means of each cell and its neighbours above and below, for rows of `floats` numbers.
    fn mean_across(from: &[f32], to: &mut [f32], floats: usize) {
        let last = from.len().wrapping_sub(floats);
        for (at, to) in to.chunks_exact_mut(floats).enumerate() {
            let own = at.wrapping_mul(floats);
            let row = |start: usize| from.get(start..start.wrapping_add(floats)).unwrap_or(&[]);
            let (above, below) = (row(own.saturating_sub(floats)), row(own.wrapping_add(floats).min(last)));
            for (((to, above), below), own) in to.iter_mut().zip(above).zip(below).zip(row(own)) {
                *to = 0.25 * (above + below) + 0.5 * own;
            }
        }
    }
}

simd_kernel! {
    /// Blends two rows of cells at `t` from the upper to the lower one, times a factor; the brightest.
    fn blend(above: &[f32], below: &[f32], t: f32, scale: f32, row: &mut [f32]) -> f32 {
        for ((light, above), below) in row.iter_mut().zip(above).zip(below) {
            *light = scale * (above * (1.0 - t) + below * t);
        }
        let mut brightest = [0.0f32; 16];
        let (chunks, rest) = row.as_chunks::<16>();
        for chunk in chunks {
            for (brightest, light) in brightest.iter_mut().zip(chunk) {
                *brightest = if *light > *brightest { *light } else { *brightest };
            }
        }
        brightest.iter().chain(rest).fold(0.0, |most, light| if *light > most { *light } else { most })
    }
}

/// Shares of the other cell between the middles of two neighbours, seen from the nearer one.
const SHARES: [f32; CODES] = {
    let mut shares = [0.0; CODES];
    let mut k = 0;
    while k < CODES {
        let pixel = k / 3;
        let away = if pixel < CELL / 2 { pixel } else { CELL - 1 - pixel };
        shares[k] = (away as f32 + 0.5) / CELL as f32;
        k += 1;
    }
    shares
};

simd_kernel! {
    /// Adds glow to codes, less where they are bright: blended between the middles of cells.
    fn screen(row: &[f32], line: &mut [u8]) {
        let cells = row.as_chunks::<3>().0;
        let (Some(first), Some(last)) = (cells.first(), cells.last()) else { return };
        let (edge, rest) = line.split_at_mut(line.len().min(CODES / 2));
        brighten(first, first, edge, CODES / 2);
        for (codes, [left, right]) in rest.chunks_mut(CODES).zip(cells.array_windows()) {
            brighten(left, right, codes, 0);
        }
        // Half a cell is left beyond the middle of the last one.
        let between = cells.len().wrapping_sub(1).wrapping_mul(CODES);
        brighten(last, last, rest.get_mut(between..).unwrap_or(&mut []), 0);
    }
}

/// Adds glow to codes between the middles of two cells, from the code `skipped` on.
#[inline(always)]
fn brighten(left: &[f32; 3], right: &[f32; 3], codes: &mut [u8], skipped: usize) {
    let mut brightest = 0.0f32;
    for light in left.iter().chain(right) {
        brightest = if *light > brightest { *light } else { brightest };
    }
    if brightest < LEAST {
        return;
    }
    let mut glow = [0.0f32; CODES];
    for (k, glow) in glow.iter_mut().enumerate() {
        let (own, other) = if k < CODES / 2 { (left, right) } else { (right, left) };
        let light = own[k % 3] + (other[k % 3] - own[k % 3]) * SHARES[k];
        *glow = if light < 255.0 { light } else { 255.0 };
    }
    if let Ok(codes) = <&mut [u8; CODES]>::try_from(&mut *codes) {
        for (code, glow) in codes.iter_mut().zip(glow) {
            *code = screened(*code, glow);
        }
        return;
    }
    for (code, glow) in codes.iter_mut().zip(glow.iter().skip(skipped)) {
        *code = screened(*code, *glow);
    }
}

/// A code of a surface with glow before it.
#[inline(always)]
fn screened(code: u8, glow: f32) -> u8 {
    let code = f32::from(code);
    let sum = code + glow * (1.0 - code * (1.0 / 255.0)) + 0.5;
    // The whole number below: with this added, the low bits are the nearest one. A cast that saturates is slow.
    const WHOLE: f32 = 12_582_912.0;
    let nearest = (sum + WHOLE) - WHOLE;
    let below = if nearest > sum { nearest - 1.0 } else { nearest };
    (below + WHOLE).to_bits() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lamps_glow_into_the_dark_and_dull_pictures_stay() {
        let lit = |level: Level| {
            let mut rgb: Vec<u8> = (0..3 * 100 * 60)
                .map(|i| if (48..52).contains(&(i / 3 % 100)) && (28..32).contains(&(i / 300)) { 255 } else { 10 })
                .collect();
            Bloom::default().add(level, 1.0, 100, &mut rgb);
            rgb
        };
        let rgb = lit(Level::best());
        let at = |x: usize, y: usize| rgb[3 * (100 * y + x)];
        assert!(at(56, 30) > at(66, 30) && at(66, 30) > 10 && at(2, 2) == 10, "{} {}", at(56, 30), at(66, 30));
        assert_eq!(lit(Level::PLAIN), rgb);
        let mut dull = vec![150; 3 * 64 * 9];
        Bloom::default().add(Level::best(), 1.0, 64, &mut dull);
        assert!(dull.iter().all(|byte| *byte == 150));
    }
}
