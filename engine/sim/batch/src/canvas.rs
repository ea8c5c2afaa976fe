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
    /// Number of the face in this picture's list; 0 where nothing was drawn.
    pub face: Vec<[u32; WIDE]>,
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
            face: vec![[0; WIDE]; blocks * height],
            columns: (0..blocks).map(|block| core::array::from_fn(|k| column(WIDE * block + k))).collect(),
        }
    }

    pub fn clear(&mut self) {
        self.inverse_depth.fill([0.0; WIDE]);
        self.face.fill([0; WIDE]);
    }

    /// The part that holds the pixel centres between two points, pixels from the image's centre; `None` without any.
    #[inline(always)]
    pub fn part(&self, low: [f32; 2], high: [f32; 2]) -> Option<Part> {
        // A margin for the rounding of the points.
        const MARGIN_PX: f32 = 1e-3;
        let half = [0.5 * self.width as f32 - 0.5, 0.5 * self.height as f32 - 0.5];
        let size = [self.width, self.height];
        let mut first = [0u32; 2];
        let mut end = [0u32; 2];
        for axis in 0..2 {
            let from = (low[axis] + half[axis] - MARGIN_PX).clamp(0.0, size[axis] as f32);
            let to = (high[axis] + half[axis] + MARGIN_PX).clamp(-1.0, (size[axis] as f32) - 1.0);
            first[axis] = from as u32;
            first[axis] += u32::from((first[axis] as f32) < from);
            end[axis] = (to + 1.0) as u32;
        }
        let is_some = first[0] < end[0] && first[1] < end[1];
        let blocks = [first[0] / WIDE as u32, end[0].div_ceil(WIDE as u32)];
        is_some.then_some(Part { blocks, rows: [first[1], end[1]] })
    }
}
