//! Hiding of shapes by others, told for whole shapes: the frame so far in tiles of pixels.

use crate::eye::Eye;
use crate::visibility::{NEAR_M, Screen, VisibilityBuffer, bounds};
use cosfly_frames::{DVec3, simd_kernel};

/// Size of a tile, pixels.
const TILE: [usize; 2] = [32, 8];

/// The frame so far, coarsely: the least inverse depth in each tile. Shapes that are nowhere nearer are hidden.
#[derive(Default)]
pub struct Nearer {
    columns: usize,
    least: Vec<f32>,
}

impl Nearer {
    /// Measures the tiles of a drawing.
    pub fn measure(&mut self, drawn: &VisibilityBuffer) {
        let (width, height) = drawn.size();
        self.columns = width.div_ceil(TILE[0]);
        self.least.clear();
        self.least.resize(self.columns * height.div_ceil(TILE[1]), f32::INFINITY);
        if width > 0 {
            measure(drawn.level(), &drawn.inverse_depth, width, &mut self.least);
        }
    }

    /// Whether all pixels between the coordinates hold something nearer than an inverse depth.
    pub fn hides(&self, low: [f64; 2], high: [f64; 2], inverse_depth: f64) -> bool {
        if self.columns == 0 {
            return false;
        }
        let rows = self.least.len() / self.columns;
        let tile = |at: f64, k: usize, count: usize| ((at.max(0.0) as usize) / TILE[k]).min(count - 1);
        let columns = tile(low[0] - 1.0, 0, self.columns)..=tile(high[0] + 1.0, 0, self.columns);
        // A margin for rounding and for the bias of road marks.
        let limit = (inverse_depth * 1.000_02) as f32;
        (tile(low[1] - 1.0, 1, rows)..=tile(high[1] + 1.0, 1, rows)).all(|row| {
            let tiles = &self.least[row * self.columns..(row + 1) * self.columns];
            tiles[columns.clone()].iter().all(|least| *least > limit)
        })
    }

    /// Whether a box of the world, by its centre and half its sides, metres, lies ahead and behind what is drawn.
    pub fn hides_box(&self, (eye, screen): (&Eye, &Screen), center_in_world: DVec3, half: DVec3) -> bool {
        let (mut nearest_m, mut points) = (f64::INFINITY, [[0.0; 2]; 8]);
        for (number, point) in points.iter_mut().enumerate() {
            let side = |axis: usize| if number >> axis & 1 == 1 { 1.0 } else { -1.0 };
            let seen = eye.see(center_in_world + DVec3::new(side(0), side(1), side(2)) * half);
            nearest_m = nearest_m.min(seen.x);
            *point = screen.point(seen);
        }
        let (low, high) = bounds(&points);
        nearest_m >= NEAR_M && self.hides(low, high, 1.0 / nearest_m)
    }
}

simd_kernel! {
    fn measure(inverse_depth: &[f32], width: usize, least: &mut [f32]) {
        let columns = width.div_ceil(TILE[0]);
        for (band, least) in inverse_depth.chunks(width.wrapping_mul(TILE[1])).zip(least.chunks_exact_mut(columns)) {
            for row in band.chunks_exact(width) {
                for (tile, least) in row.chunks(TILE[0]).zip(least.iter_mut()) {
                    let mut halves = [*least; 16];
                    let (whole, rest) = tile.as_chunks::<16>();
                    for sixteen in whole {
                        for k in 0..16 {
                            halves[k] = if sixteen[k] < halves[k] { sixteen[k] } else { halves[k] };
                        }
                    }
                    let mut count = 8;
                    while count > 0 {
                        for k in 0..count {
                            let other = halves[k + count];
                            halves[k] = if other < halves[k] { other } else { halves[k] };
                        }
                        count /= 2;
                    }
                    *least = rest.iter().fold(halves[0], |a, b| if *b < a { *b } else { a });
                }
            }
        }
    }
}
