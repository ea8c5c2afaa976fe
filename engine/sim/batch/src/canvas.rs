//! The nearest face at each pixel centre so far, in blocks of eight pixels.

/// Pixels of a block.
pub const WIDE: usize = 8;

/// A rectangle of the canvas: blocks and rows, first and one past the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    pub blocks: [u32; 2],
    pub rows: [u32; 2],
}

/// Nearest face so far. Pixels beyond the picture's width fill the last block of each row; they are never read out.
pub struct Canvas {
    pub width: usize,
    pub height: usize,
    /// Blocks of a row.
    pub blocks: usize,
    /// Inverse depth with the lift of coplanar faces in it, 1/m; 0 where nothing was drawn.
    pub inverse_depth: Vec<[f32; WIDE]>,
    /// Number of the face in this picture's list, whole, below 2^24; 0 where nothing was drawn.
    pub face: Vec<[f32; WIDE]>,
    /// Columns of pixel centres from the image's centre.
    pub columns: Vec<[f32; WIDE]>,
}

impl Canvas {
    pub fn new(width: usize, height: usize) -> Self {
        let blocks = width.div_ceil(WIDE);
        let column = |at: usize| (at as f64 + 0.5 - 0.5 * width as f64) as f32;
        Self {
            width,
            height,
            blocks,
            inverse_depth: vec![[0.0; WIDE]; blocks * height],
            face: vec![[0.0; WIDE]; blocks * height],
            columns: (0..blocks).map(|block| core::array::from_fn(|k| column(WIDE * block + k))).collect(),
        }
    }

    pub fn clear(&mut self) {
        self.inverse_depth.fill([0.0; WIDE]);
        self.face.fill([0.0; WIDE]);
    }

    /// Size in pixels.
    pub fn size(&self) -> [f32; 2] {
        [self.width as f32, self.height as f32]
    }

    /// The part that holds the pixel centres between two points, pixels from the image's centre; `None` without any.
    #[inline]
    pub fn part(&self, low: [f32; 2], high: [f32; 2]) -> Option<Part> {
        let (low, high) = (low.map(|low| [low]), high.map(|high| [high]));
        let mut parts = Parts::<1>::default();
        parts.find(self.size(), &low, &high);
        parts.get(0)
    }

    /// Whether all pixels of a small part hold something nearer than an inverse depth.
    #[inline]
    pub fn hides(&self, part: Part, inverse_depth: f32) -> bool {
        let limit = inverse_depth * NEARER;
        let mut least = [f32::INFINITY; WIDE];
        for row in part.rows[0]..part.rows[1] {
            let start = row as usize * self.blocks;
            for block in &self.inverse_depth[start + part.blocks[0] as usize..start + part.blocks[1] as usize] {
                for k in 0..WIDE {
                    least[k] = if block[k] < least[k] { block[k] } else { least[k] };
                }
            }
        }
        least.iter().all(|least| *least > limit)
    }
}

/// Share by which something is nearer than what it hides: a margin for rounding and for the lift of coplanar faces.
pub const NEARER: f32 = 1.000_05;

impl Part {
    /// Blocks in all rows.
    #[inline]
    pub fn area(&self) -> u32 {
        (self.blocks[1] - self.blocks[0]) * (self.rows[1] - self.rows[0])
    }
}

/// Parts of shapes.
#[derive(Clone, Copy)]
pub struct Parts<const COUNT: usize> {
    /// First pixel column and row of each, and one past the last.
    first: [[i32; COUNT]; 2],
    end: [[i32; COUNT]; 2],
}

impl<const COUNT: usize> Default for Parts<COUNT> {
    fn default() -> Self {
        Self { first: [[0; COUNT]; 2], end: [[0; COUNT]; 2] }
    }
}

impl<const COUNT: usize> Parts<COUNT> {
    /// Finds the pixel centres between two points of each shape, pixels from the image's centre, in an image of a size.
    #[inline(always)]
    pub fn find(&mut self, size: [f32; 2], low: &[[f32; COUNT]; 2], high: &[[f32; COUNT]; 2]) {
        // A margin for the rounding of the points.
        const MARGIN_PX: f32 = 1e-3;
        for axis in 0..2 {
            let half = 0.5 * size[axis] - 0.5;
            for k in 0..COUNT {
                // Also nothing for what is no number.
                let from = low[axis][k] + (half - MARGIN_PX);
                let from = if from > 0.0 { from } else { 0.0 };
                let from = if from < size[axis] { from } else { size[axis] };
                let to = high[axis][k] + (half + MARGIN_PX);
                let to = if to > -1.0 { to } else { -1.0 };
                let to = if to < size[axis] - 1.0 { to } else { size[axis] - 1.0 };
                self.first[axis][k] = whole(-from).wrapping_neg();
                self.end[axis][k] = whole(to).wrapping_add(1);
            }
        }
    }

    /// The part of a shape; `None` where it holds no pixel centre.
    #[inline(always)]
    pub fn get(&self, k: usize) -> Option<Part> {
        let (columns, rows) = ([self.first[0][k], self.end[0][k]], [self.first[1][k], self.end[1][k]]);
        let is_some = (columns[0] < columns[1]) & (rows[0] < rows[1]);
        let blocks = [columns[0] as u32 / WIDE as u32, (columns[1] as u32).div_ceil(WIDE as u32)];
        is_some.then_some(Part { blocks, rows: [rows[0] as u32, rows[1] as u32] })
    }
}

/// The whole part of a number from -2^22 to 2^22, rounded towards minus infinity.
#[inline(always)]
pub fn whole(number: f32) -> i32 {
    // Adding it leaves the nearest whole number in the low bits.
    const MAGIC: f32 = 12_582_912.0;
    let nearest = (number + MAGIC) - MAGIC;
    let below = if nearest > number { nearest - 1.0 } else { nearest };
    ((below + MAGIC).to_bits() as i32).wrapping_sub(MAGIC.to_bits() as i32)
}
