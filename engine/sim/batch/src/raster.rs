//! Drawing convex shapes: eight rows of ends of spans at a time, then eight pixels at a time.

use crate::canvas::{Canvas, Part, WIDE, whole};
use crate::eye::NEAR_M;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Most blocks of eight lines around a shape.
pub const MOST_LINES: usize = 3;

/// Greatest inverse depth that is drawn, 1/m.
const NEAREST: f32 = (1.0 / NEAR_M) as f32;
/// Beyond every column.
const OUTSIDE: f32 = 1e30;

/// A box on the screen. Along a ray, the box lies between the planes by which the ray enters and those by which it leaves;
/// the inverse depths of all are linear over the image.
#[derive(Clone, Copy, Debug)]
pub struct BoxOnScreen {
    /// Inverse depths of the six planes, those of entry first.
    pub planes: [[f32; 3]; 6],
    /// Number of planes of entry, 1 to 3.
    pub entries: usize,
    /// Face number of each plane of entry.
    pub faces: [u32; 3],
}

/// Half planes of the screen: where `constant + across * u + down * v` is at least 0. Eight by eight; those beyond the last
/// hold everywhere.
pub struct HalfPlanes<const BLOCKS: usize> {
    constant: [[f32; WIDE]; BLOCKS],
    across: [[f32; WIDE]; BLOCKS],
    down: [[f32; WIDE]; BLOCKS],
    count: usize,
}

impl<const BLOCKS: usize> HalfPlanes<BLOCKS> {
    /// The whole screen.
    #[inline(always)]
    pub fn new() -> Self {
        Self { constant: [[1.0; WIDE]; BLOCKS], across: [[0.0; WIDE]; BLOCKS], down: [[0.0; WIDE]; BLOCKS], count: 0 }
    }

    /// Adds a half plane; those beyond the last place are left out.
    #[inline(always)]
    pub fn add(&mut self, [constant, across, down]: [f32; 3]) {
        if self.count < WIDE * BLOCKS {
            let (block, lane) = (self.count / WIDE, self.count % WIDE);
            (self.constant[block][lane], self.across[block][lane], self.down[block][lane]) = (constant, across, down);
            self.count += 1;
        }
    }
}

/// A plane of the scene on the screen with its face number.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Inverse depth.
    pub plane: [f32; 3],
    /// Face number.
    pub face: u32,
}

/// The rows of a canvas that a shape is drawn into.
struct Rows<'a> {
    inverse_depth: &'a mut [[f32; WIDE]],
    face: &'a mut [[u32; WIDE]],
    columns: &'a [[f32; WIDE]],
    blocks: usize,
    part: Part,
    /// Column and row of the first pixel centre, from the image's centre.
    first: [f32; 2],
}

/// Draws a box where it is nearer than what is there.
pub fn draw_box(level: Level, canvas: &mut Canvas, part: Part, shape: &BoxOnScreen) {
    draw_faces(level, Rows::of(canvas, part), shape);
}

/// Draws a convex polygon, the part of a surface within half planes, where it is nearer than what is there.
pub fn draw_polygon(level: Level, canvas: &mut Canvas, part: Part, within: &HalfPlanes<1>, surface: &Surface) {
    draw_within(level, Rows::of(canvas, part), within, surface);
}

/// [`draw_polygon`] with up to `8 * MOST_LINES` edges.
pub fn draw_large_polygon(
    level: Level,
    canvas: &mut Canvas,
    part: Part,
    within: &HalfPlanes<MOST_LINES>,
    surface: &Surface,
) {
    draw_within_many(level, Rows::of(canvas, part), within, surface);
}

simd_kernel! {
    fn draw_faces(rows: Rows<'_>, shape: &BoxOnScreen) {
        let mut rows = rows;
        let planes = &shape.planes;
        for entry in 0..shape.entries {
            let mine = planes[entry];
            let mut within = HalfPlanes::<1>::new();
            for (k, other) in planes.iter().enumerate() {
                // Before all planes of exit; behind all planes of entry.
                let side = if k < shape.entries { -1.0 } else { 1.0 };
                within.constant[0][k] = side * (mine[0] - other[0]);
                within.across[0][k] = side * (mine[1] - other[1]);
                within.down[0][k] = side * (mine[2] - other[2]);
            }
            within.count = 6;
            rows.draw(&within, &Surface { plane: mine, face: shape.faces[entry] });
        }
    }
}

simd_kernel! {
    fn draw_within(rows: Rows<'_>, within: &HalfPlanes<1>, surface: &Surface) {
        let mut rows = rows;
        rows.draw(within, surface);
    }
}

simd_kernel! {
    fn draw_within_many(rows: Rows<'_>, within: &HalfPlanes<MOST_LINES>, surface: &Surface) {
        let mut rows = rows;
        rows.draw(within, surface);
    }
}

/// The left and right bound of each row that lines give: `at + slope * row`.
struct Sides<const BLOCKS: usize> {
    left: [[[f32; WIDE]; 2]; BLOCKS],
    right: [[[f32; WIDE]; 2]; BLOCKS],
}

impl<const BLOCKS: usize> Sides<BLOCKS> {
    #[inline(always)]
    fn of(within: &HalfPlanes<BLOCKS>) -> Self {
        let mut bounds = Self { left: [[[0.0; WIDE]; 2]; BLOCKS], right: [[[0.0; WIDE]; 2]; BLOCKS] };
        for block in 0..BLOCKS {
            let (constant, across, down) = (&within.constant[block], &within.across[block], &within.down[block]);
            let (left, right) = (&mut bounds.left[block], &mut bounds.right[block]);
            for k in 0..WIDE {
                let steep = if across[k].abs() > down[k].abs() { across[k].abs() } else { down[k].abs() };
                // A level line becomes one that is almost level; no line is everywhere or nowhere.
                let least = 1e-9 * steep;
                let rate = if across[k].abs() > least { across[k] } else { least };
                let by = -1.0 / rate;
                let (at, slope) = (constant[k] * by, down[k] * by);
                let nowhere = if constant[k] >= 0.0 { -OUTSIDE } else { OUTSIDE };
                let is_line = steep > 0.0;
                let (at, slope) = (if is_line { at } else { nowhere }, if is_line { slope } else { 0.0 });
                let is_left = (rate > 0.0) | !is_line;
                left[0][k] = if is_left { at } else { -OUTSIDE };
                left[1][k] = if is_left { slope } else { 0.0 };
                right[0][k] = if is_left { OUTSIDE } else { at };
                right[1][k] = if is_left { 0.0 } else { slope };
            }
        }
        bounds
    }
}

impl<'a> Rows<'a> {
    fn of(canvas: &'a mut Canvas, part: Part) -> Self {
        Self {
            first: [canvas.width, canvas.height].map(|size| 0.5 - 0.5 * size as f32),
            inverse_depth: &mut canvas.inverse_depth,
            face: &mut canvas.face,
            columns: &canvas.columns,
            blocks: canvas.blocks,
            part,
        }
    }

    #[inline(always)]
    fn draw<const BLOCKS: usize>(&mut self, within: &HalfPlanes<BLOCKS>, surface: &Surface) {
        let bounds = Sides::of(within);
        let [first_row, end_row] = self.part.rows;
        let mut row = first_row;
        while row < end_row {
            let y = self.first[1] + row as i32 as f32;
            let (mut left, mut right) = ([-OUTSIDE; WIDE], [OUTSIDE; WIDE]);
            for line in 0..within.count {
                let (block, lane) = (line / WIDE % BLOCKS, line % WIDE);
                let [from, from_slope] = [bounds.left[block][0][lane], bounds.left[block][1][lane]];
                let [to, to_slope] = [bounds.right[block][0][lane], bounds.right[block][1][lane]];
                for k in 0..WIDE {
                    let at = y + k as i32 as f32;
                    let (from, to) = (from + from_slope * at, to + to_slope * at);
                    left[k] = if from > left[k] { from } else { left[k] };
                    right[k] = if to < right[k] { to } else { right[k] };
                }
            }
            // Blocks that hold the columns between both ends.
            let (mut first, mut end) = ([0i32; WIDE], [0i32; WIDE]);
            let (low, high) = (self.part.blocks[0] as i32 as f32, self.part.blocks[1] as i32 as f32);
            for k in 0..WIDE {
                let from = (left[k] - self.first[0]) * (1.0 / WIDE as f32) - 0.01;
                let to = (right[k] - self.first[0]) * (1.0 / WIDE as f32) + 1.01;
                let from = if from > low { from } else { low };
                let to = if to < high { to } else { high };
                let to = if left[k] <= right[k] { to } else { 0.0 };
                // Both lie within the canvas.
                (first[k], end[k]) = (whole(from), whole(to));
            }
            let count = end_row.wrapping_sub(row).min(WIDE as u32) as usize;
            for k in 0..count {
                if first[k] < end[k] {
                    let start = (row as usize).wrapping_add(k).wrapping_mul(self.blocks);
                    self.draw_span(
                        start,
                        [first[k] as usize, end[k] as usize],
                        [left[k], right[k]],
                        y + k as f32,
                        surface,
                    );
                }
            }
            row = row.wrapping_add(WIDE as u32);
        }
    }

    /// Draws the pixels of a row between two columns.
    #[inline(always)]
    fn draw_span(&mut self, start: usize, blocks: [usize; 2], [left, right]: [f32; 2], y: f32, surface: &Surface) {
        let span = start.wrapping_add(blocks[0])..start.wrapping_add(blocks[1]);
        let base = surface.plane[0] + surface.plane[2] * y;
        let pixels = self.inverse_depth[span.clone()].iter_mut().zip(&mut self.face[span]);
        for ((depths, faces), x) in pixels.zip(&self.columns[blocks[0]..blocks[1]]) {
            let (old_depths, old_faces) = (*depths, *faces);
            let mut entry = [0.0f32; WIDE];
            for k in 0..WIDE {
                let here = base + surface.plane[1] * x[k];
                let is_inside = (x[k] >= left) & (x[k] <= right) & (here <= NEAREST);
                entry[k] = if is_inside { here } else { 0.0 };
            }
            for k in 0..WIDE {
                let nearer = 0u32.wrapping_sub(u32::from(entry[k] > old_depths[k]));
                faces[k] = (surface.face & nearer) | (old_faces[k] & !nearer);
            }
            for k in 0..WIDE {
                depths[k] = if entry[k] > old_depths[k] { entry[k] } else { old_depths[k] };
            }
        }
    }
}
