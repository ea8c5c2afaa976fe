//! The picture so far, coarsely: shapes that are nowhere nearer than what is drawn are hidden.

use crate::canvas::{Canvas, NEARER, Part, WIDE};
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Rows of a tile; a tile is a block wide.
const TILE_ROWS: usize = 8;

/// Parts of up to this many blocks are small.
const SMALL_BLOCKS: u32 = 8;

/// The least inverse depth in each tile of a canvas.
#[derive(Default)]
pub struct Hidden {
    blocks: usize,
    least: Vec<f32>,
}

impl Hidden {
    /// Measures a canvas.
    pub fn measure(&mut self, level: Level, canvas: &Canvas) {
        self.blocks = canvas.blocks;
        self.least.resize(canvas.blocks * canvas.height.div_ceil(TILE_ROWS), 0.0);
        if canvas.blocks > 0 {
            measure(level, &canvas.inverse_depth, canvas.blocks, &mut self.least);
        }
    }

    /// Whether all pixels of a part hold something nearer than an inverse depth: small parts are compared with the canvas
    /// itself.
    #[inline]
    pub fn hides(&self, canvas: &Canvas, part: Part, inverse_depth: f32) -> bool {
        if part.area() <= SMALL_BLOCKS { canvas.hides(part, inverse_depth) } else { self.covers(part, inverse_depth) }
    }

    fn covers(&self, part: Part, inverse_depth: f32) -> bool {
        let limit = inverse_depth * NEARER;
        let [from, to] = part.blocks.map(|block| block as usize);
        let rows = part.rows[0] as usize / TILE_ROWS..(part.rows[1] as usize).div_ceil(TILE_ROWS);
        for row in rows {
            for least in &self.least[row * self.blocks + from..row * self.blocks + to] {
                if *least <= limit {
                    return false;
                }
            }
        }
        true
    }
}

simd_kernel! {
    fn measure(inverse_depth: &[[f32; WIDE]], blocks: usize, least: &mut [f32]) {
        for (band, least) in inverse_depth.chunks(blocks.wrapping_mul(TILE_ROWS)).zip(least.chunks_exact_mut(blocks)) {
            for (block, least) in least.iter_mut().enumerate() {
                let mut lanes = [f32::INFINITY; WIDE];
                let mut at = block;
                while at < band.len() {
                    for k in 0..WIDE {
                        lanes[k] = if band[at][k] < lanes[k] { band[at][k] } else { lanes[k] };
                    }
                    at = at.wrapping_add(blocks);
                }
                let mut count = WIDE / 2;
                while count > 0 {
                    for k in 0..count {
                        let other = lanes[k + count];
                        lanes[k] = if other < lanes[k] { other } else { lanes[k] };
                    }
                    count /= 2;
                }
                *least = lanes[0];
            }
        }
    }
}
