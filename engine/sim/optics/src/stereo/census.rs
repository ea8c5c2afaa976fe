//! Census codes: which of two opposite neighbours is brighter, for 31 pairs within 9 x 7 pixels.

use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Neighbours to each side, and rows above and below.
const SIDE: usize = 4;
const ROWS: usize = 3;
/// Pairs of neighbours, and thus the largest difference of two codes.
pub(super) const PAIRS: u8 = 31;

/// Brightness of a picture with its edges repeated, so that all pixels have neighbours.
#[derive(Default)]
pub(super) struct Grey {
    width: usize,
    rows: Vec<u8>,
}

impl Grey {
    /// Takes the brightness of a picture in sRGB; mirrored, its columns go from right to left.
    pub(super) fn take(&mut self, rgb: &[u8], width: usize, is_mirrored: bool) {
        self.width = width;
        let height = rgb.len() / 3 / width;
        let stride = width + 2 * SIDE;
        self.rows.resize(stride * (height + 2 * ROWS), 0);
        for (row, to) in self.rows.chunks_mut(stride).enumerate() {
            let row = row.saturating_sub(ROWS).min(height - 1);
            let from = &rgb[3 * row * width..3 * (row + 1) * width];
            for (column, to) in to.iter_mut().enumerate() {
                let column = column.saturating_sub(SIDE).min(width - 1);
                let column = if is_mirrored { width - 1 - column } else { column };
                let [r, g, b] = [0, 1, 2].map(|part| u16::from(from[3 * column + part]));
                *to = ((r + 2 * g + b) / 4) as u8;
            }
        }
    }

    /// Codes of the pixels of a row.
    pub(super) fn codes(&self, level: Level, row: usize, codes: &mut [u32]) {
        let stride = self.width + 2 * SIDE;
        codes_of(level, &self.rows[row * stride..(row + 2 * ROWS + 1) * stride], stride, codes);
    }
}

simd_kernel! {
    /// Codes of a row from it and the rows around it.
    fn codes_of(rows: &[u8], stride: usize, codes: &mut [u32]) {
        codes.fill(0);
        let (width, middle) = (codes.len(), ROWS * stride + SIDE);
        for pair in 0..usize::from(PAIRS) {
            let off = (pair / (2 * SIDE + 1)) * stride + pair % (2 * SIDE + 1);
            let before = &rows[off..off + width];
            let behind = &rows[2 * middle - off..2 * middle - off + width];
            for ((code, before), behind) in codes.iter_mut().zip(before).zip(behind) {
                *code |= u32::from(before > behind) << pair;
            }
        }
    }
}
