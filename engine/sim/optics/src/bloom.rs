//! The glow around bright lamps: light that lens and sensor scatter, from cells of eight by eight pixels.

use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Side of a cell, pixels.
const CELL: usize = 8;
/// Codes above this glow.
const BRIGHT: u8 = 200;
/// Passes of the mean over three neighbours, both ways.
const PASSES: usize = 4;

/// Cells of bright light.
#[derive(Default)]
pub struct Bloom {
    cells: Vec<[f32; 3]>,
    other: Vec<[f32; 3]>,
    /// Glow at the middles of cells in the height of a row.
    row: Vec<[f32; 3]>,
}

impl Bloom {
    /// Adds the glow of an image `width` pixels wide to it.
    pub fn add(&mut self, level: Level, strength: f32, width: usize, rgb: &mut [u8]) {
        let bytes = 3 * width;
        if width == 0 || rgb.len() < bytes {
            return;
        }
        let (columns, rows) = (width.div_ceil(CELL), (rgb.len() / bytes).div_ceil(CELL));
        self.cells.clear();
        self.cells.resize(columns * rows, [0.0; 3]);
        for (y, line) in rgb.chunks_exact(bytes).enumerate() {
            gather(level, line, &mut self.cells[y / CELL * columns..][..columns]);
        }
        if self.cells.iter().all(|cell| *cell == [0.0; 3]) {
            return;
        }
        self.other.resize(self.cells.len(), [0.0; 3]);
        for _ in 0..PASSES {
            mean(&self.cells, &mut self.other, columns, 1);
            mean(&self.other, &mut self.cells, columns, columns);
        }
        let scale = strength * 2.2 / (CELL * CELL) as f32;
        for (y, line) in rgb.chunks_exact_mut(bytes).enumerate() {
            let v = ((y as f32 + 0.5) / CELL as f32 - 0.5).max(0.0);
            let upper = v as usize;
            let lower = (upper + 1).min(rows - 1);
            let t = v - upper as f32;
            self.row.clear();
            let (above, below) = (&self.cells[upper * columns..][..columns], &self.cells[lower * columns..][..columns]);
            self.row.extend(above.iter().zip(below).map(|(above, below)| {
                core::array::from_fn::<f32, 3, _>(|k| scale * (above[k] * (1.0 - t) + below[k] * t))
            }));
            if self.row.iter().any(|cell| cell.iter().any(|glow| *glow > 0.3)) {
                screen(level, &self.row, line);
            }
        }
    }
}

simd_kernel! {
    /// Adds the light of a row's pixels beyond the limit to their cells.
    fn gather(line: &[u8], cells: &mut [[f32; 3]]) {
        for (part, cell) in line.chunks(3 * CELL).zip(cells) {
            let mut brightest = 0;
            for byte in part {
                brightest = brightest.max(*byte);
            }
            if brightest <= BRIGHT {
                continue;
            }
            for pixel in part.as_chunks::<3>().0 {
                for (sum, byte) in cell.iter_mut().zip(pixel) {
                    *sum += f32::from(byte.saturating_sub(BRIGHT));
                }
            }
        }
    }
}

simd_kernel! {
    /// Adds glow to codes, less where they are bright: blended between the middles of cells.
    fn screen(cells: &[[f32; 3]], line: &mut [u8]) {
        const HALF: usize = 3 * CELL / 2;
        let last = cells.len().wrapping_sub(1);
        for (half, bytes) in line.chunks_mut(HALF).enumerate() {
            // The left or the right half of a cell.
            let at = half / 2;
            let is_left = half % 2 == 0;
            let other = if is_left { at.saturating_sub(1) } else { at.wrapping_add(1).min(last) };
            let (Some(own), Some(other)) = (cells.get(at), cells.get(other)) else { return };
            let mut brightest = 0.0f32;
            for light in own.iter().chain(other) {
                brightest = if *light > brightest { *light } else { brightest };
            }
            if brightest < 0.3 {
                continue;
            }
            let mut glow = [0.0f32; HALF];
            for (k, glow) in glow.iter_mut().enumerate() {
                let place = ((k / 3) as i32 as f32 + 0.5) / CELL as f32;
                let away = if is_left { 0.5 - place } else { place };
                *glow = own[k % 3] + (other[k % 3] - own[k % 3]) * away;
            }
            for (byte, glow) in bytes.iter_mut().zip(&glow) {
                let code = f32::from(*byte);
                let glow = if *glow < 255.0 { *glow } else { 255.0 };
                *byte = (code + glow * (1.0 - code * (1.0 / 255.0)) + 0.5) as i32 as u8;
            }
        }
    }
}

/// Means of each cell and its neighbours `step` away.
fn mean(from: &[[f32; 3]], to: &mut [[f32; 3]], columns: usize, step: usize) {
    let last = from.len() - 1;
    for (at, out) in to.iter_mut().enumerate() {
        let (left, right) = match step {
            1 => (if at % columns == 0 { at } else { at - 1 }, if at % columns + 1 == columns { at } else { at + 1 }),
            _ => (if at < step { at } else { at - step }, if at + step > last { at } else { at + step }),
        };
        *out = core::array::from_fn(|k| 0.25 * (from[left][k] + from[right][k]) + 0.5 * from[at][k]);
    }
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
