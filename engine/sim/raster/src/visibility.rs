//! The visibility pass: convex polygons into a buffer of (inverse depth, face number), sampled at pixel centres.

use cosfly_domain::Camera;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, simd_kernel};

/// Nothing nearer than this along the optical axis is drawn, metres.
pub const NEAR_M: f64 = 0.01;

/// Most corners of a polygon before clipping.
pub const MAX_CORNERS: usize = 20;

/// The face number of a pixel that nothing covers.
pub const NO_FACE: u32 = u32::MAX;

/// Inverse planar depth of a plane over the image: `constant + across * u + down * v` at pixel coordinates (u, v).
#[derive(Clone, Copy, Debug)]
pub struct PlaneOnScreen {
    /// At (u, v) = (0, 0), 1/m.
    pub constant: f64,
    /// Per pixel to the right, 1/m.
    pub across: f64,
    /// Per pixel down, 1/m.
    pub down: f64,
}

impl PlaneOnScreen {
    /// The plane through `point` with normal `normal`, both in the camera's body axes; `None` when the camera lies in it.
    pub fn new(screen: &Screen, normal: DVec3, point: DVec3) -> Option<Self> {
        let distance = normal.dot(point);
        if distance.abs() < 1e-12 || !distance.is_finite() {
            return None;
        }
        let across = normal.y / (screen.focal_px * distance);
        let down = -normal.z / (screen.focal_px * distance);
        let constant = normal.x / distance - across * screen.center_u - down * screen.center_v;
        constant.is_finite().then_some(Self { constant, across, down })
    }

    /// The inverse depth at pixel coordinates, 1/m.
    #[inline]
    pub fn at(&self, u: f64, v: f64) -> f64 {
        self.constant + self.across * u + self.down * v
    }

    /// The plane with its inverse depth greater by a share.
    pub fn lifted(&self, bias: f64) -> Self {
        let factor = 1.0 + bias;
        Self { constant: self.constant * factor, across: self.across * factor, down: self.down * factor }
    }
}

/// The image plane in numbers.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Focal length, pixels.
    pub focal_px: f64,
    /// Column of the optical axis.
    pub center_u: f64,
    /// Row of the optical axis.
    pub center_v: f64,
}

impl Screen {
    /// The image plane of a camera.
    pub fn new(camera: &Camera) -> Self {
        Self {
            width: camera.width as usize,
            height: camera.height as usize,
            focal_px: camera.focal_px(),
            center_u: 0.5 * f64::from(camera.width),
            center_v: 0.5 * f64::from(camera.height),
        }
    }

    /// Column and row of a point in body axes (x along the optical axis, metres) that lies ahead, pixels.
    #[inline]
    pub fn point(&self, seen: DVec3) -> [f64; 2] {
        let scale = self.focal_px / seen.x;
        [self.center_u + seen.y * scale, self.center_v - seen.z * scale]
    }
}

/// Nearest face at each pixel centre.
pub struct VisibilityBuffer {
    width: usize,
    height: usize,
    /// Inverse depth with the drawing bias in it, 1/m; 0 where nothing was drawn.
    pub inverse_depth: Vec<f32>,
    /// Face number of each pixel, [`NO_FACE`] where nothing was drawn.
    pub face: Vec<u32>,
    left: Vec<f64>,
    right: Vec<f64>,
    level: Level,
    dirty_rows: (usize, usize),
}

impl VisibilityBuffer {
    /// Width and height, pixels.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// Vector instructions that kernels use.
    pub fn level(&self) -> Level {
        self.level
    }

    /// An empty buffer.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            inverse_depth: vec![0.0; width * height],
            face: vec![NO_FACE; width * height],
            left: vec![0.0; height],
            right: vec![0.0; height],
            level: Level::best(),
            dirty_rows: (height, 0),
        }
    }

    /// Draws with these vector instructions from now on.
    pub fn set_level(&mut self, level: Level) {
        self.level = level;
    }

    /// Empties the rows that were drawn into since the last call.
    pub fn clear(&mut self) {
        let (from, to) = self.dirty_rows;
        if from < to {
            self.inverse_depth[from * self.width..to * self.width].fill(0.0);
            self.face[from * self.width..to * self.width].fill(NO_FACE);
        }
        self.dirty_rows = (self.height, 0);
    }

    /// Rows that may hold something: first, and one past the last.
    pub fn drawn_rows(&self) -> (usize, usize) {
        (self.dirty_rows.0, self.dirty_rows.1.max(self.dirty_rows.0))
    }

    /// Empties a rectangle of pixels from `first` to before `end`, by column and row. Face numbers stay where nothing is
    /// drawn later: they count only where the inverse depth is not 0.
    pub fn clear_part(&mut self, first: [usize; 2], end: [usize; 2]) {
        for row in first[1]..end[1] {
            self.inverse_depth[row * self.width + first[0]..row * self.width + end[0]].fill(0.0);
        }
    }

    /// Those of [`Self::rows_of`] within a rectangle; `None` when nothing lies in it.
    pub fn rows_within(&self, points: &[[f64; 2]], first: [usize; 2], end: [usize; 2]) -> Option<(usize, usize)> {
        let (low, high) = bounds(points);
        let (from, to) = self.rows_between(low, high)?;
        let (from, to) = (from.max(first[1]), to.min(end[1]));
        let beside = high[0] < first[0] as f64 || low[0] > end[0] as f64;
        (from < to && !beside).then_some((from, to))
    }

    /// Takes over a whole picture that was found elsewhere: face numbers, and inverse depths in 1/m.
    ///
    /// # Panics
    /// Where either does not have exactly the pixels of this one.
    pub fn adopt_all(&mut self, faces: &[u32], inverse_depth: &[f32]) {
        self.dirty_rows = (0, self.height);
        self.face.copy_from_slice(faces);
        self.inverse_depth.copy_from_slice(inverse_depth);
    }

    /// Draws a flat convex polygon given by its corners in the camera's body axes (x ahead, y right, z up, metres).
    /// `bias` lifts its inverse depth by that share in the comparison only (coplanar road marks win over the road).
    /// Edges are computed from their lower end, so polygons that share an edge share its pixels without gap or overlap.
    pub fn draw_polygon(&mut self, screen: &Screen, corners: &[DVec3], plane: &PlaneOnScreen, bias: f64, face: u32) {
        let mut clipped = [DVec3::ZERO; 2 * MAX_CORNERS];
        let count = clip_near(corners, &mut clipped);
        if count < 3 {
            return;
        }
        let mut points = [[0.0f64; 2]; 2 * MAX_CORNERS];
        for (point, corner) in points.iter_mut().zip(&clipped[..count]) {
            *point = screen.point(*corner);
        }
        self.draw_projected(&points[..count], &plane.lifted(bias), face);
    }

    /// Draws a polygon as [`Self::draw_polygon`] does, but only the pixels whose centres `keep` tells.
    pub fn draw_polygon_where(
        &mut self,
        screen: &Screen,
        (corners, plane, bias): (&[DVec3], &PlaneOnScreen, f64),
        face: u32,
        keep: impl Fn(f64, f64) -> bool,
    ) {
        let mut clipped = [DVec3::ZERO; 2 * MAX_CORNERS];
        let count = clip_near(corners, &mut clipped);
        let mut points = [[0.0f64; 2]; 2 * MAX_CORNERS];
        for (point, corner) in points.iter_mut().zip(&clipped[..count]) {
            *point = screen.point(*corner);
        }
        let Some(rows) = (if count < 3 { None } else { self.rows_of(&points[..count]) }) else { return };
        self.dirty_rows = (self.dirty_rows.0.min(rows.0), self.dirty_rows.1.max(rows.1));
        let plane = plane.lifted(bias);
        scan_edges(&points[..count], rows.0, &mut self.left[rows.0..rows.1], &mut self.right[rows.0..rows.1]);
        for row in rows.0..rows.1 {
            let v = row as f64 + 0.5;
            for column in first_center(self.left[row], self.width)..first_center(self.right[row], self.width) {
                let (u, at) = (column as f64 + 0.5, row * self.width + column);
                let candidate = plane.at(u, v) as f32;
                if candidate > self.inverse_depth[at] && keep(u, v) {
                    (self.inverse_depth[at], self.face[at]) = (candidate, face);
                }
            }
        }
    }

    /// Draws a convex polygon given by pixel coordinates; larger values of `plane` win.
    pub fn draw_projected(&mut self, points: &[[f64; 2]], plane: &PlaneOnScreen, face: u32) {
        if let Some(rows) = self.rows_of(points) {
            self.draw_rows(points, rows, plane, face);
        }
    }

    /// Rows whose pixel centres a polygon may cover, first and one past the last; `None` when it covers none anywhere.
    #[inline]
    pub fn rows_of(&self, points: &[[f64; 2]]) -> Option<(usize, usize)> {
        let (low, high) = bounds(points);
        self.rows_between(low, high)
    }

    /// [`Self::rows_of`] what lies within bounds.
    #[inline]
    pub fn rows_between(&self, low: [f64; 2], high: [f64; 2]) -> Option<(usize, usize)> {
        if high[0] < 0.5 || low[0] > self.width as f64 || high[1] < 0.5 || low[1] > self.height as f64 {
            return None;
        }
        let columns = (first_center(low[0], self.width), first_center(high[0], self.width));
        let rows = (first_center(low[1], self.height), first_center(high[1], self.height));
        (rows.0 < rows.1 && columns.0 < columns.1).then_some(rows)
    }

    /// Draws a polygon into the rows that [`Self::rows_of`] gave.
    pub fn draw_rows(&mut self, points: &[[f64; 2]], rows: (usize, usize), plane: &PlaneOnScreen, face: u32) {
        self.dirty_rows = (self.dirty_rows.0.min(rows.0), self.dirty_rows.1.max(rows.1));
        let pixels = rows.0 * self.width..rows.1 * self.width;
        draw_rows(
            self.level,
            &mut self.inverse_depth[pixels.clone()],
            &mut self.face[pixels],
            self.width,
            rows.0,
            &mut self.left[rows.0..rows.1],
            &mut self.right[rows.0..rows.1],
            points,
            plane,
            face,
        );
    }
}

/// Notes for rows from `first_row` where a polygon's edges cross their centre lines.
#[inline(always)]
fn scan_edges(points: &[[f64; 2]], first_row: usize, left: &mut [f64], right: &mut [f64]) {
    let end_row = first_row.wrapping_add(left.len());
    left.fill(f64::INFINITY);
    right.fill(f64::NEG_INFINITY);
    let Some(&last) = points.last() else { return };
    let mut from = last;
    for &to in points {
        let ordered = (from[1], from[0]) <= (to[1], to[0]);
        let (low, high) = if ordered { (from, to) } else { (to, from) };
        let first = first_center(low[1], end_row).max(first_row);
        let end = first_center(high[1], end_row);
        if first < end {
            let slope = (high[0] - low[0]) / (high[1] - low[1]);
            let rows = first.wrapping_sub(first_row)..end.wrapping_sub(first_row);
            let base = first as u32 as f64 + 0.5;
            for (row, (left, right)) in left[rows.clone()].iter_mut().zip(&mut right[rows]).enumerate() {
                let u = low[0] + (base + row as i32 as f64 - low[1]) * slope;
                *left = if u < *left { u } else { *left };
                *right = if u > *right { u } else { *right };
            }
        }
        from = to;
    }
}

/// Lowest and highest coordinates of points.
#[inline]
pub fn bounds(points: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in points {
        for k in 0..2 {
            low[k] = if point[k] < low[k] { point[k] } else { low[k] };
            high[k] = if point[k] > high[k] { point[k] } else { high[k] };
        }
    }
    (low, high)
}

/// Index of the first pixel whose centre is at or after the coordinate, within 0..=`limit`.
#[inline(always)]
fn first_center(coordinate: f64, limit: usize) -> usize {
    whole(center_from(coordinate, limit))
}

/// Adding it leaves the nearest whole number in the low bits.
const MAGIC: f64 = 6_755_399_441_055_744.0;

/// [`first_center`] as a float.
#[inline(always)]
fn center_from(coordinate: f64, limit: usize) -> f64 {
    let shifted = coordinate - 0.5;
    // A NaN becomes 0.
    let positive = if shifted > 0.0 { shifted } else { 0.0 };
    let highest = limit as u32 as f64;
    let inside = if positive < highest { positive } else { highest };
    let nearest = (inside + MAGIC) - MAGIC;
    if nearest < inside { nearest + 1.0 } else { nearest }
}

/// A whole number below 2^31 as an index.
#[inline(always)]
fn whole(number: f64) -> usize {
    (number + MAGIC).to_bits() as u32 as usize
}

/// Pixels that are compared at a time.
const WIDE: usize = 16;

/// A window that lets values through between two walls; slices of it close the ends of spans.
const WINDOW: [f32; 3 * WIDE] = {
    let mut window = [f32::NEG_INFINITY; 3 * WIDE];
    let mut k = WIDE;
    while k < 2 * WIDE {
        window[k] = f32::INFINITY;
        k += 1;
    }
    window
};

simd_kernel! {
    /// Writes the spans between a polygon's edges in neighbouring rows. `left` and `right` are room for their ends.
    #[expect(clippy::too_many_arguments, reason = "the parts of a buffer, apart so that compilers know that they are")]
    fn draw_rows(
        inverse_depth: &mut [f32],
        faces: &mut [u32],
        width: usize,
        first_row: usize,
        left: &mut [f64],
        right: &mut [f64],
        points: &[[f64; 2]],
        plane: &PlaneOnScreen,
        face: u32,
    ) {
        scan_edges(points, first_row, left, right);
        for (left, right) in left.iter_mut().zip(right.iter_mut()) {
            *left = center_from(*left, width);
            *right = center_from(*right, width);
        }
        let step = plane.across as f32;
        let rows = inverse_depth.chunks_exact_mut(width).zip(faces.chunks_exact_mut(width));
        for (row, ((depths, ids), (left, right))) in rows.zip(left.iter().zip(right.iter())).enumerate() {
            // Whole numbers already.
            let (start, end) = (whole(*left), whole(*right));
            if start >= end {
                continue;
            }
            let base = plane.constant + plane.down * (first_row.wrapping_add(row) as f64 + 0.5);
            if width < WIDE {
                for column in start..end {
                    let candidate = (base + plane.across * (column as f64 + 0.5)) as f32;
                    if candidate > depths[column] {
                        (depths[column], ids[column]) = (candidate, face);
                    }
                }
                continue;
            }
            // Whole blocks; the last of a row may begin earlier. Their first value is exact, so that steps in f32
            // never add up to an error that matters.
            let mut at = start;
            while at < end {
                let block = at.min(width.wrapping_sub(WIDE));
                let value = (base + plane.across * (block as f64 + 0.5)) as f32;
                // How far the span reaches into the block.
                let from = start.max(block).wrapping_sub(block) & 15;
                let to = end.wrapping_sub(block).min(WIDE);
                let (open_from, open_to) = (&WINDOW[WIDE - from..], &WINDOW[2 * WIDE - to..]);
                if let (Some(depths), Some(ids), Some(open_from), Some(open_to)) = (
                    depths[block..].first_chunk_mut::<WIDE>(),
                    ids[block..].first_chunk_mut::<WIDE>(),
                    open_from.first_chunk::<WIDE>(),
                    open_to.first_chunk::<WIDE>(),
                ) {
                    let mut candidates = [0.0f32; WIDE];
                    for k in 0..WIDE {
                        let candidate = value + step * (k as i32 as f32);
                        let candidate = if candidate < open_from[k] { candidate } else { open_from[k] };
                        candidates[k] = if candidate < open_to[k] { candidate } else { open_to[k] };
                    }
                    let (old_depths, old_ids) = (*depths, *ids);
                    // Bits of positive floats are ordered as they are: the sign of a difference is a mask for whole stores. A
                    // comparison would become masked stores, which are slow on many processors.
                    let mut nearer = [0u32; WIDE];
                    for k in 0..WIDE {
                        let candidate = if candidates[k] > 0.0 { candidates[k] } else { 0.0 };
                        let (old, new) = (old_depths[k].to_bits() as i32, candidate.to_bits() as i32);
                        nearer[k] = (old.wrapping_sub(new) >> 31) as u32;
                    }
                    for k in 0..WIDE {
                        depths[k] = if candidates[k] > old_depths[k] { candidates[k] } else { old_depths[k] };
                    }
                    for k in 0..WIDE {
                        ids[k] = old_ids[k] ^ ((old_ids[k] ^ face) & nearer[k]);
                    }
                }
                at = block.wrapping_add(WIDE);
            }
        }
    }
}

/// Keeps the part of the polygon with x at least [`NEAR_M`]; returns its number of corners.
fn clip_near(corners: &[DVec3], clipped: &mut [DVec3; 2 * MAX_CORNERS]) -> usize {
    let mut count = 0;
    let Some(&last) = corners.last() else { return 0 };
    let mut from = last;
    for &to in corners.iter().take(MAX_CORNERS) {
        let (from_kept, to_kept) = (from.x >= NEAR_M, to.x >= NEAR_M);
        if from_kept != to_kept {
            // From the kept end, whichever way the edge runs: neighbours then get the same point.
            let (kept, lost) = if from_kept { (from, to) } else { (to, from) };
            let mut cut = kept + (lost - kept) * ((NEAR_M - kept.x) / (lost.x - kept.x));
            cut.x = NEAR_M;
            clipped[count] = cut;
            count += 1;
        }
        if to_kept {
            clipped[count] = to;
            count += 1;
        }
        from = to;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn screen() -> Screen {
        Screen { width: 40, height: 30, focal_px: 20.0, center_u: 20.0, center_v: 15.0 }
    }

    fn draw(buffer: &mut VisibilityBuffer, corners: &[DVec3], face: u32) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if let Some(plane) = PlaneOnScreen::new(&screen(), normal, corners[0]) {
            buffer.draw_polygon(&screen(), corners, &plane, 0.0, face);
        }
    }

    #[test]
    fn triangles_that_share_an_edge_cover_each_pixel_once() {
        let (a, b) = (DVec3::new(3.0, -4.1, 2.9), DVec3::new(5.0, 3.3, -2.2));
        let (c, d) = (DVec3::new(4.0, 2.0, 3.0), DVec3::new(4.0, -3.0, -2.7));
        let counts: Vec<usize> = [vec![[a, b, c]], vec![[b, a, d]], vec![[a, b, c], [b, a, d]]]
            .iter()
            .map(|triangles| {
                let mut buffer = VisibilityBuffer::new(40, 30);
                triangles.iter().for_each(|triangle| draw(&mut buffer, triangle, 1));
                buffer.face.iter().filter(|&&face| face == 1).count()
            })
            .collect();
        assert_eq!(counts[0] + counts[1], counts[2]);
        assert!(counts[0] > 20 && counts[1] > 20);
    }

    #[test]
    fn a_polygon_across_the_near_plane_keeps_its_front_part() {
        let mut buffer = VisibilityBuffer::new(40, 30);
        let floor = [[-5.0, -9.0], [50.0, -9.0], [50.0, 9.0], [-5.0, 9.0]].map(|[x, y]| DVec3::new(x, y, -1.0));
        draw(&mut buffer, &floor, 7);
        assert_eq!(buffer.face[29 * 40 + 20], 7);
        assert_eq!(buffer.face[10 * 40 + 20], NO_FACE);
    }

    #[test]
    fn clearing_forgets_everything_drawn() {
        let mut buffer = VisibilityBuffer::new(40, 30);
        let wall = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[y, z]| DVec3::new(3.0, y, z));
        draw(&mut buffer, &wall, 3);
        assert!(buffer.face.contains(&3));
        buffer.clear();
        assert!(buffer.face.iter().all(|&face| face == NO_FACE) && buffer.inverse_depth.iter().all(|&d| d == 0.0));
    }
}
