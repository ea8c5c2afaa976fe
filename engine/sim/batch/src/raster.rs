//! Drawing convex shapes: eight rows of ends of spans at a time, then eight pixels at a time.

use crate::canvas::{Canvas, Part, WIDE, whole};
use crate::eye::{Linear, NEAR_M};
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Most blocks of eight lines around a shape.
pub const MOST_LINES: usize = 3;

/// Greatest inverse depth that is drawn, 1/m.
const NEAREST: f32 = (1.0 / NEAR_M) as f32;
/// Parts of up to this many blocks are drawn pixel by pixel.
const SMALL_BLOCKS: u32 = 8;
/// Columns of a block from its first.
const STEPS: [f32; WIDE] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
/// Beyond every column.
const OUTSIDE: f32 = 1e30;

/// A box on the screen. Along a ray, the box lies between the planes by which the ray enters and those by which it leaves;
/// the inverse depths of all are linear over the image.
#[derive(Clone, Copy, Debug)]
pub struct BoxOnScreen {
    /// Inverse depths of the six planes, those of entry first.
    pub planes: [[f32; 3]; 6],
    /// Number of planes of entry, 1 to 3; 1 to 5 of steps of roofs.
    pub entries: usize,
    /// Face number of each plane of entry.
    pub faces: [f32; 5],
}

/// Width by which polygons reach beyond their edges, so that neighbours leave no gap, pixels.
pub const SEAM_PX: f32 = 2e-5;

/// The corners of a convex polygon of up to eight, pixels from the image's centre; beyond the last, the last again.
#[derive(Clone, Copy, Debug)]
struct Corners {
    u: [f32; WIDE],
    v: [f32; WIDE],
    count: usize,
}

impl Corners {
    /// The half planes between its edges.
    #[inline(always)]
    fn edges(&self) -> HalfPlanes<1> {
        let (u, v) = (&self.u, &self.v);
        let (mut next_u, mut next_v) = ([u[0]; WIDE], [v[0]; WIDE]);
        for k in 0..WIDE - 1 {
            (next_u[k], next_v[k]) = (u[k + 1], v[k + 1]);
        }
        let mut area = 0.0;
        for k in 1..WIDE - 1 {
            area += (u[k] - u[0]) * (v[k + 1] - v[0]) - (v[k] - v[0]) * (u[k + 1] - u[0]);
        }
        // Either way around.
        let side = if area < 0.0 { -1.0 } else { 1.0 };
        let mut within = HalfPlanes::new();
        within.count = WIDE;
        for k in 0..WIDE {
            let (across, down) = (side * (next_u[k] - u[k]), side * (next_v[k] - v[k]));
            let seam = SEAM_PX * (across.abs() + down.abs());
            within.constant[0][k] = (down * u[k] - across * v[k]) + seam;
            within.across[0][k] = 0.0 - down;
            within.down[0][k] = across;
        }
        // The edge from the last corner to the first comes right after the others.
        let last = self.count.wrapping_sub(1) % WIDE;
        within.constant[0][last] = within.constant[0][WIDE - 1];
        within.across[0][last] = within.across[0][WIDE - 1];
        within.down[0][last] = within.down[0][WIDE - 1];
        within.count = self.count.min(WIDE);
        within
    }
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
    /// Inverse depth, in full precision: that of a wall seen along itself changes by much from pixel to pixel.
    pub plane: Linear,
    /// Face number.
    pub face: f32,
}

/// The rows of a canvas that a shape is drawn into.
struct Rows<'a> {
    inverse_depth: &'a mut [[f32; WIDE]],
    face: &'a mut [[f32; WIDE]],
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

/// Draws a convex polygon of up to eight corners, pixels from the image's centre, where it is nearer than what is there.
pub fn draw_polygon(level: Level, canvas: &mut Canvas, part: Part, corners: &[[f32; 2]], surface: &Surface) {
    draw_between(level, Rows::of(canvas, part), corners, surface);
}

/// Draws polygon `lane` of eight side by side, of up to eight corners, where it is nearer than what is there.
pub fn draw_lane(
    level: Level,
    canvas: &mut Canvas,
    part: Part,
    (corners, lane, count): (&[[[f32; WIDE]; 2]], usize, usize),
    surface: &Surface,
) {
    draw_of_eight(level, Rows::of(canvas, part), corners, lane, count, surface);
}

/// Draws the part of a surface within half planes where it is nearer than what is there.
pub fn draw_within(level: Level, canvas: &mut Canvas, part: Part, within: &HalfPlanes<MOST_LINES>, surface: &Surface) {
    draw_many(level, Rows::of(canvas, part), within, surface);
}

simd_kernel! {
    fn draw_faces(rows: Rows<'_>, shape: &BoxOnScreen) {
        let mut rows = rows;
        let planes = &shape.planes;
        if rows.part.area() <= SMALL_BLOCKS {
            match shape.entries {
                1 => rows.draw_small_box::<1>(shape),
                2 => rows.draw_small_box::<2>(shape),
                3 => rows.draw_small_box::<3>(shape),
                4 => rows.draw_small_box::<4>(shape),
                _ => rows.draw_small_box::<5>(shape),
            }
            return;
        }
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
            rows.draw(&within, &Surface { plane: mine.map(f64::from), face: shape.faces[entry] });
        }
    }
}

simd_kernel! {
    fn draw_between(rows: Rows<'_>, corners: &[[f32; 2]], surface: &Surface) {
        let mut rows = rows;
        let last = corners.len().wrapping_sub(1);
        let mut found = Corners { u: [0.0; WIDE], v: [0.0; WIDE], count: corners.len() };
        for k in 0..WIDE {
            if let Some([u, v]) = corners.get(if k < last { k } else { last }) {
                (found.u[k], found.v[k]) = (*u, *v);
            }
        }
        rows.draw_polygon(&found, surface);
    }
}

simd_kernel! {
    fn draw_of_eight(rows: Rows<'_>, corners: &[[[f32; WIDE]; 2]], lane: usize, count: usize, surface: &Surface) {
        let mut rows = rows;
        // Brought here, and not by the caller: what was written piece by piece is slow to read as a whole.
        let lane = lane % WIDE;
        let last = corners.len().min(count).wrapping_sub(1);
        let mut found = Corners { u: [0.0; WIDE], v: [0.0; WIDE], count };
        for k in 0..WIDE {
            let at = if k < last { k } else { last };
            if let Some([u, v]) = corners.get(at) {
                (found.u[k], found.v[k]) = (u[lane], v[lane]);
            }
        }
        rows.draw_polygon(&found, surface);
    }
}

simd_kernel! {
    fn draw_many(rows: Rows<'_>, within: &HalfPlanes<MOST_LINES>, surface: &Surface) {
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
                let at = if steep > 0.0 { at } else { nowhere };
                let slope = if steep > 0.0 { slope } else { 0.0 };
                // A left bound where the function grows to the right.
                let rate = if steep > 0.0 { rate } else { 1.0 };
                left[0][k] = if rate > 0.0 { at } else { -OUTSIDE };
                left[1][k] = if rate > 0.0 { slope } else { 0.0 };
                right[0][k] = if rate > 0.0 { OUTSIDE } else { at };
                right[1][k] = if rate > 0.0 { 0.0 } else { slope };
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
    fn draw_polygon(&mut self, corners: &Corners, surface: &Surface) {
        let within = corners.edges();
        if self.part.area() <= SMALL_BLOCKS {
            match corners.count {
                3 => self.draw_small::<3>(&within, surface),
                4 => self.draw_small::<4>(&within, surface),
                5 => self.draw_small::<5>(&within, surface),
                6 => self.draw_small::<6>(&within, surface),
                _ => self.draw_small::<8>(&within, surface),
            }
            return;
        }
        self.draw(&within, surface);
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
        let base = surface.plane[0] + surface.plane[2] * f64::from(y);
        let pixels = self.inverse_depth[span.clone()].iter_mut().zip(&mut self.face[span]);
        for ((depths, faces), x) in pixels.zip(&self.columns[blocks[0]..blocks[1]]) {
            let mut entry = [0.0f32; WIDE];
            let (first, step) = ((base + surface.plane[1] * f64::from(x[0])) as f32, surface.plane[1] as f32);
            for k in 0..WIDE {
                let here = first + step * STEPS[k];
                let here = if here <= NEAREST { here } else { 0.0 };
                let here = if x[k] >= left { here } else { 0.0 };
                entry[k] = if x[k] <= right { here } else { 0.0 };
            }
            put(&entry, &[surface.face; WIDE], depths, faces);
        }
    }

    /// A row of the part: its place from the image's centre, depths and faces.
    #[inline(always)]
    fn row(&mut self, row: u32) -> (f32, &mut [[f32; WIDE]], &mut [[f32; WIDE]]) {
        let start = (row as usize).wrapping_mul(self.blocks);
        let [from, to] = self.part.blocks.map(|block| start.wrapping_add(block as usize));
        (self.first[1] + row as i32 as f32, &mut self.inverse_depth[from..to], &mut self.face[from..to])
    }

    /// Columns of pixel centres of a row of the part.
    #[inline(always)]
    fn columns(&self) -> &'a [[f32; WIDE]] {
        &self.columns[self.part.blocks[0] as usize..self.part.blocks[1] as usize]
    }

    /// Draws a small part, every pixel against every line.
    #[inline(always)]
    fn draw_small<const COUNT: usize>(&mut self, within: &HalfPlanes<1>, surface: &Surface) {
        let ([constant], [across], [down]) = (&within.constant, &within.across, &within.down);
        let columns = self.columns();
        for row in self.part.rows[0]..self.part.rows[1] {
            let (y, depths, faces) = self.row(row);
            let mut base = [0.0f32; COUNT];
            for i in 0..COUNT {
                base[i] = constant[i] + down[i] * y;
            }
            let depth = surface.plane[0] + surface.plane[2] * f64::from(y);
            for ((depths, faces), x) in depths.iter_mut().zip(faces).zip(columns) {
                let mut inside = [0.0f32; WIDE];
                for k in 0..WIDE {
                    inside[k] = base[0] + across[0] * x[k];
                }
                for i in 1..COUNT {
                    for k in 0..WIDE {
                        let other = base[i] + across[i] * x[k];
                        inside[k] = if other < inside[k] { other } else { inside[k] };
                    }
                }
                let mut entry = [0.0f32; WIDE];
                let (first, step) = ((depth + surface.plane[1] * f64::from(x[0])) as f32, surface.plane[1] as f32);
                for k in 0..WIDE {
                    let here = first + step * STEPS[k];
                    let here = if here <= NEAREST { here } else { 0.0 };
                    entry[k] = if inside[k] >= 0.0 { here } else { 0.0 };
                }
                put(&entry, &[surface.face; WIDE], depths, faces);
            }
        }
    }

    /// Draws a box into a small part, every pixel against every plane.
    #[inline(always)]
    fn draw_small_box<const ENTRIES: usize>(&mut self, shape: &BoxOnScreen) {
        let (planes, numbers) = (&shape.planes, shape.faces);
        let columns = self.columns();
        for row in self.part.rows[0]..self.part.rows[1] {
            let (y, depths, faces) = self.row(row);
            let mut base = [0.0f32; 6];
            for i in 0..6 {
                base[i] = planes[i][0] + planes[i][2] * y;
            }
            for ((depths, faces), x) in depths.iter_mut().zip(faces).zip(columns) {
                let mut entry = [0.0f32; WIDE];
                let mut exit = [0.0f32; WIDE];
                let mut face = [numbers[0]; WIDE];
                for k in 0..WIDE {
                    entry[k] = base[0] + planes[0][1] * x[k];
                    exit[k] = base[5] + planes[5][1] * x[k];
                }
                for i in 1..ENTRIES {
                    for k in 0..WIDE {
                        let other = base[i] + planes[i][1] * x[k];
                        face[k] = if other < entry[k] { numbers[i] } else { face[k] };
                        entry[k] = if other < entry[k] { other } else { entry[k] };
                    }
                }
                for i in ENTRIES..5 {
                    for k in 0..WIDE {
                        let other = base[i] + planes[i][1] * x[k];
                        exit[k] = if other > exit[k] { other } else { exit[k] };
                    }
                }
                for k in 0..WIDE {
                    let here = if entry[k] <= NEAREST { entry[k] } else { 0.0 };
                    entry[k] = if entry[k] >= exit[k] { here } else { 0.0 };
                }
                put(&entry, &face, depths, faces);
            }
        }
    }
}

/// Puts faces where they are nearer than what is there; 0 for pixels that they do not cover.
#[inline(always)]
fn put(entry: &[f32; WIDE], face: &[f32; WIDE], depths: &mut [f32; WIDE], faces: &mut [f32; WIDE]) {
    let (old_depths, old_faces) = (*depths, *faces);
    for k in 0..WIDE {
        // Exact for whole numbers. Not a choice between both: compilers make slow masked stores of that.
        let nearer = if entry[k] > old_depths[k] { 1.0 } else { 0.0 };
        faces[k] = old_faces[k] + (face[k] - old_faces[k]) * nearer;
    }
    for k in 0..WIDE {
        depths[k] = if entry[k] > old_depths[k] { entry[k] } else { old_depths[k] };
    }
}
