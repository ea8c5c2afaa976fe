//! The visibility pass: convex polygons into a buffer of (inverse depth, face number), sampled at pixel centres.

use crate::camera::Camera;
use cosfly_frames::DVec3;

/// Nothing nearer than this along the optical axis is drawn, metres.
pub const NEAR_M: f64 = 0.01;

/// Most corners of a polygon before clipping.
pub const MAX_CORNERS: usize = 12;

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
}

/// Nearest face at each pixel centre.
pub struct Visibility {
    width: usize,
    height: usize,
    /// Inverse depth with the drawing bias in it, 1/m; 0 where nothing was drawn.
    pub inverse_depth: Vec<f32>,
    /// Face number of each pixel, [`NO_FACE`] where nothing was drawn.
    pub face: Vec<u32>,
    left: Vec<f64>,
    right: Vec<f64>,
    dirty_rows: (usize, usize),
}

impl Visibility {
    /// An empty buffer.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            inverse_depth: vec![0.0; width * height],
            face: vec![NO_FACE; width * height],
            left: vec![f64::INFINITY; height],
            right: vec![f64::NEG_INFINITY; height],
            dirty_rows: (height, 0),
        }
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
            let scale = screen.focal_px / corner.x;
            *point = [screen.center_u + corner.y * scale, screen.center_v - corner.z * scale];
        }
        let lifted = PlaneOnScreen {
            constant: plane.constant * (1.0 + bias),
            across: plane.across * (1.0 + bias),
            down: plane.down * (1.0 + bias),
        };
        self.draw_projected(&points[..count], &lifted, face);
    }

    /// Draws a convex polygon given by pixel coordinates; larger values of `plane` win.
    pub fn draw_projected(&mut self, points: &[[f64; 2]], plane: &PlaneOnScreen, face: u32) {
        let (mut u_min, mut u_max) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut v_min, mut v_max) = (f64::INFINITY, f64::NEG_INFINITY);
        for point in points {
            u_min = u_min.min(point[0]);
            u_max = u_max.max(point[0]);
            v_min = v_min.min(point[1]);
            v_max = v_max.max(point[1]);
        }
        if u_max < 0.5 || u_min > self.width as f64 || v_max < 0.5 || v_min > self.height as f64 {
            return;
        }
        let rows = (first_center(v_min, self.height), first_center(v_max, self.height));
        if rows.0 < rows.1 {
            self.scan_edges(points);
            self.fill_rows(rows, plane, face);
        }
    }

    /// Notes for every row where the polygon's edges cross its centre line.
    fn scan_edges(&mut self, points: &[[f64; 2]]) {
        let mut from = points[points.len() - 1];
        for &to in points {
            let ordered = (from[1], from[0]) <= (to[1], to[0]);
            let (low, high) = if ordered { (from, to) } else { (to, from) };
            let first = first_center(low[1], self.height);
            let end = first_center(high[1], self.height);
            if first < end {
                let slope = (high[0] - low[0]) / (high[1] - low[1]);
                for row in first..end {
                    let u = low[0] + (row as f64 + 0.5 - low[1]) * slope;
                    self.left[row] = self.left[row].min(u);
                    self.right[row] = self.right[row].max(u);
                }
            }
            from = to;
        }
    }

    fn fill_rows(&mut self, rows: (usize, usize), plane: &PlaneOnScreen, face: u32) {
        self.dirty_rows = (self.dirty_rows.0.min(rows.0), self.dirty_rows.1.max(rows.1));
        for row in rows.0..rows.1 {
            let start = first_center(self.left[row], self.width);
            let end = first_center(self.right[row], self.width);
            self.left[row] = f64::INFINITY;
            self.right[row] = f64::NEG_INFINITY;
            if start < end {
                let base = plane.constant + plane.down * (row as f64 + 0.5);
                let span = row * self.width + start..row * self.width + end;
                fill_span(
                    &mut self.inverse_depth[span.clone()],
                    &mut self.face[span],
                    base + plane.across * (start as f64 + 0.5),
                    plane.across,
                    face,
                );
            }
        }
    }
}

/// Index of the first pixel whose centre is at or after the coordinate, within 0..=`limit`.
#[inline]
fn first_center(coordinate: f64, limit: usize) -> usize {
    // Casts saturate, and a NaN becomes 0.
    let shifted = coordinate - 0.5;
    let truncated = shifted as usize;
    (truncated + usize::from((truncated as f64) < shifted)).min(limit)
}

/// Writes one span. The base is taken anew every 64 pixels so that f32 steps never add up to an error that matters.
#[inline]
fn fill_span(inverse_depth: &mut [f32], faces: &mut [u32], start: f64, step: f64, face: u32) {
    let step_f32 = step as f32;
    for (block, (depths, ids)) in inverse_depth.chunks_mut(64).zip(faces.chunks_mut(64)).enumerate() {
        let base = (start + step * (64 * block) as f64) as f32;
        for (k, (depth, id)) in depths.iter_mut().zip(ids).enumerate() {
            let candidate = base + step_f32 * (k as i32 as f32);
            let nearer = candidate > *depth;
            *depth = if nearer { candidate } else { *depth };
            *id = if nearer { face } else { *id };
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

    fn draw(buffer: &mut Visibility, corners: &[DVec3], face: u32) {
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
                let mut buffer = Visibility::new(40, 30);
                triangles.iter().for_each(|triangle| draw(&mut buffer, triangle, 1));
                buffer.face.iter().filter(|&&face| face == 1).count()
            })
            .collect();
        assert_eq!(counts[0] + counts[1], counts[2]);
        assert!(counts[0] > 20 && counts[1] > 20);
    }

    #[test]
    fn a_polygon_across_the_near_plane_keeps_its_front_part() {
        let mut buffer = Visibility::new(40, 30);
        let floor = [[-5.0, -9.0], [50.0, -9.0], [50.0, 9.0], [-5.0, 9.0]].map(|[x, y]| DVec3::new(x, y, -1.0));
        draw(&mut buffer, &floor, 7);
        assert_eq!(buffer.face[29 * 40 + 20], 7);
        assert_eq!(buffer.face[10 * 40 + 20], NO_FACE);
    }

    #[test]
    fn clearing_forgets_everything_drawn() {
        let mut buffer = Visibility::new(40, 30);
        let wall = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[y, z]| DVec3::new(3.0, y, z));
        draw(&mut buffer, &wall, 3);
        assert!(buffer.face.contains(&3));
        buffer.clear();
        assert!(buffer.face.iter().all(|&face| face == NO_FACE) && buffer.inverse_depth.iter().all(|&d| d == 0.0));
    }
}
