//! One picture: boxes from near to far, people, other figures, ground; then the channels.

use crate::boxes::{Boxes, Group, Projected};
use crate::canvas::{Canvas, Part};
use crate::eye::{Eye, Linear, NEAR_M};
use crate::faces::{DrawnFace, SKY};
use crate::figures::{Around, SeenPart, Stance, Wardrobe};
use crate::ground::{Cluster, Ground, Polygon, SeenPoints};
use crate::hidden::Hidden;
use crate::outputs::Outputs;
use crate::raster::{HalfPlanes, MAX_LINES, Surface, draw_box, draw_polygon};
use crate::resolve::resolve;
use crate::view::View;
use cosfly_frames::DVec3;
use cosfly_frames::simd::Level;
use cosfly_maps::SemanticLabel;
use cosfly_render::figure::FigureParts;
use cosfly_render::frame::TARGET_INSTANCE;
use cosfly_render::{LEAST_HEIGHT_PX, Walker};

/// Most corners of a polygon.
const MAX_CORNERS: usize = MAX_LINES;
/// Beyond this, pixels from the image's centre, corners are too coarse in single precision.
const FAR_OFF_PX: f32 = 3000.0;
/// Width by which polygons reach beyond their edges, so that neighbours leave no gap, pixels.
const SEAM_PX: f32 = 2e-5;

/// Draws pictures of one size, one at a time; owns all buffers.
pub struct Painter {
    level: Level,
    canvas: Canvas,
    hidden: Hidden,
    faces: Vec<DrawnFace>,
    /// Distance and place in a list of what may be seen.
    order: Vec<(u32, u32)>,
    candidates: Vec<Candidate>,
    seen: SeenPoints,
    wardrobe: Wardrobe,
}

/// A box that may be seen.
#[derive(Clone, Copy)]
struct Candidate {
    index: u32,
    part: Part,
    /// Greatest inverse depth that it may have.
    nearest: f32,
}

impl Painter {
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            level: Level::best(),
            canvas: Canvas::new(width, height),
            hidden: Hidden::default(),
            faces: Vec::new(),
            order: Vec::new(),
            candidates: Vec::new(),
            seen: SeenPoints::default(),
            wardrobe: Wardrobe::new(),
        }
    }

    pub fn set_level(&mut self, level: Level) {
        self.level = level;
    }

    /// Draws a picture into buffers of its own size.
    pub fn paint(&mut self, view: &View<'_>, outputs: &mut Outputs<'_>) {
        let eye = Eye::new(&view.pose, self.canvas.width, self.canvas.height, view.horizontal_fov_rad);
        self.canvas.clear();
        self.faces.clear();
        self.faces.push(SKY);
        let boxes = &view.scene.boxes;
        self.hidden.measure(self.level, &self.canvas);
        self.draw_boxes(&eye, boxes, boxes.large());
        self.hidden.measure(self.level, &self.canvas);
        self.draw_boxes(&eye, boxes, boxes.small());
        self.hidden.measure(self.level, &self.canvas);
        self.draw_people(&eye, view);
        self.draw_ground(&eye, &view.scene.ground);
        resolve(self.level, &self.canvas, &self.faces, outputs);
    }

    /// Boxes of groups that may be seen, from near to far.
    fn draw_boxes(&mut self, eye: &Eye, boxes: &Boxes, groups: &[Group]) {
        self.candidates.clear();
        for group in groups {
            if eye.may_see(group.center_in_world, group.half_m) {
                self.add_candidates(group, &group.project(self.level, eye));
            }
        }
        self.order.clear();
        // Greater inverse depths first; those of positive floats are ordered as their bits.
        self.order.extend((0u32..).zip(&self.candidates).map(|(place, it)| (!it.nearest.to_bits(), place)));
        self.order.sort_unstable();
        for position in 0..self.order.len() {
            let Candidate { index, part, nearest } = self.candidates[self.order[position].1 as usize];
            if !self.hidden.hides(part, nearest)
                && let Some(shape) = boxes.get(index).on_screen(eye, &mut self.faces)
            {
                draw_box(self.level, &mut self.canvas, part, &shape);
            }
        }
    }

    fn add_candidates(&mut self, group: &Group, on_screen: &Projected) {
        for k in 0..group.count as usize {
            if on_screen.farthest_m[k] < NEAR_M as f32 {
                continue;
            }
            let at = |bounds: &[[f32; 8]; 2]| [bounds[0][k], bounds[1][k]];
            if let Some(part) = self.canvas.part(at(&on_screen.low), at(&on_screen.high)) {
                let nearest = 1.0 / on_screen.nearest_m[k].max(NEAR_M as f32);
                if !self.hidden.hides(part, nearest) {
                    self.candidates.push(Candidate { index: group.first + k as u32, part, nearest });
                }
            }
        }
    }

    fn draw_people(&mut self, eye: &Eye, view: &View<'_>) {
        if let Some(target) = view.target.as_ref().filter(|target| target.has_body()) {
            self.draw_walker(eye, target, TARGET_INSTANCE);
        }
        for other in view.others.iter().filter(|other| other.walker.has_body()) {
            self.draw_walker(eye, &other.walker, other.instance);
        }
        for figure in view.figures {
            for corners in figure.triangles_in_world {
                self.draw_triangle(eye, corners, figure.instance, figure.label);
            }
        }
    }

    fn draw_walker(&mut self, eye: &Eye, walker: &Walker, instance: u32) {
        let (low, high) = walker.bounds_in_world();
        if !eye.may_see(0.5 * (low + high), 0.5 * (high - low)) {
            return;
        }
        let away_m = (eye.position_in_world - eye.position_in_world.clamp(low, high)).length();
        if instance != TARGET_INSTANCE && eye.focal_px * walker.height_m < LEAST_HEIGHT_PX * away_m {
            return;
        }
        let around = Around::of_box(eye, low, high);
        let Some(part) = self.canvas.part(around.low, around.high) else { return };
        if around.nearest_m >= NEAR_M && self.hidden.hides(part, (1.0 / around.nearest_m) as f32) {
            return;
        }
        let parts = FigureParts::of(walker, &self.wardrobe.clothes(&walker.clothes_seed));
        let stance = Stance::new(eye, walker, parts.lowest());
        let face = DrawnFace { plane: [0.0; 3], instance, label: SemanticLabel::Pedestrian.id() };
        for part in parts.iter() {
            self.draw_body_part(eye, &stance.see(self.level, part), face);
        }
    }

    /// A closed frustum: its sides as two triangles each, its ends.
    fn draw_body_part(&mut self, eye: &Eye, seen: &SeenPart, face: DrawnFace) {
        if seen.nearest_m < NEAR_M as f32 {
            for corners in seen.triangles() {
                self.draw_seen_triangle(eye, &corners, face);
            }
            return;
        }
        let Some(part) = self.canvas.part(seen.low, seen.high) else { return };
        if self.hidden.hides(part, 1.0 / seen.nearest_m) {
            return;
        }
        for corners in seen.corners() {
            let points = corners.map(|(ring, k)| [seen.pixels[ring][0][k], seen.pixels[ring][1][k]]);
            let (low, high) = bounds(&points);
            if self.canvas.part(low, high).is_some() {
                let corners = corners.map(|(ring, k)| seen.point(ring, k));
                self.draw_seen_triangle(eye, &corners, face);
            }
        }
    }

    fn draw_triangle(&mut self, eye: &Eye, corners_in_world: &[DVec3; 3], instance: u32, label: u8) {
        let corners = corners_in_world.map(|corner| eye.see(corner));
        self.draw_seen_triangle(eye, &corners, DrawnFace { plane: [0.0; 3], instance, label });
    }

    /// Draws a triangle by its corners in body axes; the plane of `face` is set here.
    fn draw_seen_triangle(&mut self, eye: &Eye, corners: &[DVec3; 3], face: DrawnFace) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let distance = normal.dot(corners[0]);
        if distance == 0.0 || !distance.is_finite() {
            return;
        }
        let plane = [normal.x, normal.y / eye.focal_px, -normal.z / eye.focal_px].map(|part| part / distance);
        let points = corners.map(|corner| {
            [eye.focal_px * corner.y / corner.x, -eye.focal_px * corner.z / corner.x].map(|part| part as f32)
        });
        let nearest_m = corners.iter().map(|corner| corner.x).fold(f64::INFINITY, f64::min);
        let face = DrawnFace { plane, ..face };
        if nearest_m >= NEAR_M && is_close(&points) {
            self.draw_points(&points, face, 0.0);
        } else {
            self.draw_reaching(eye, corners, face, 0.0);
        }
    }

    fn draw_ground(&mut self, eye: &Eye, ground: &Ground) {
        self.order.clear();
        for (index, cluster) in (0u32..).zip(&ground.clusters) {
            if eye.may_see(cluster.center_in_world, cluster.half_m) {
                let away = (cluster.center_in_world - eye.position_in_world).abs() - cluster.half_m;
                let nearest_m = away.max(DVec3::ZERO).length() as f32;
                self.order.push((nearest_m.to_bits(), index));
            }
        }
        self.order.sort_unstable();
        for position in 0..self.order.len() {
            self.draw_cluster(eye, ground, &ground.clusters[self.order[position].1 as usize]);
        }
    }

    fn draw_cluster(&mut self, eye: &Eye, ground: &Ground, cluster: &Cluster) {
        let around =
            Around::of_box(eye, cluster.center_in_world - cluster.half_m, cluster.center_in_world + cluster.half_m);
        let Some(part) = self.canvas.part(around.low, around.high) else { return };
        if around.nearest_m >= NEAR_M && self.hidden.hides(part, (1.0 / around.nearest_m) as f32) {
            return;
        }
        let mut seen = core::mem::take(&mut self.seen);
        ground.project(self.level, eye, cluster, &mut seen);
        for polygon in ground.polygons(cluster) {
            let numbers = ground.corners(polygon);
            let count = numbers.len().min(MAX_CORNERS);
            let mut points = [[0.0f32; 2]; MAX_CORNERS];
            let (mut nearest_m, mut farthest_m) = (f32::INFINITY, f32::NEG_INFINITY);
            let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
            for (point, number) in points.iter_mut().zip(numbers) {
                let [ahead, u, v] = seen.get(*number);
                *point = [u, v];
                nearest_m = if ahead < nearest_m { ahead } else { nearest_m };
                farthest_m = if ahead > farthest_m { ahead } else { farthest_m };
                for axis in 0..2 {
                    low[axis] = if point[axis] < low[axis] { point[axis] } else { low[axis] };
                    high[axis] = if point[axis] > high[axis] { point[axis] } else { high[axis] };
                }
            }
            let is_ahead = nearest_m >= NEAR_M as f32;
            if is_ahead {
                let Some(part) = self.canvas.part(low, high) else { continue };
                if self.hidden.hides(part, 1.0 / nearest_m) {
                    continue;
                }
                if is_close(&[low, high]) {
                    if let Some(face) = ground_face(eye, polygon) {
                        self.draw_part(part, &points[..count], face, polygon.lift);
                    }
                    continue;
                }
            } else if farthest_m < NEAR_M as f32 {
                continue;
            }
            {
                let mut corners = [DVec3::ZERO; MAX_CORNERS];
                for (corner, number) in corners.iter_mut().zip(numbers) {
                    *corner = eye.see(ground.exact_in_world(cluster, *number));
                }
                if let Some(face) = ground_face(eye, polygon) {
                    self.draw_reaching(eye, &corners[..count], face, polygon.lift);
                }
            }
        }
        self.seen = seen;
    }

    /// Draws a polygon ahead of the camera, by its corners on the screen.
    fn draw_points(&mut self, points: &[[f32; 2]], face: DrawnFace, lift: f64) {
        let (low, high) = bounds(points);
        if let Some(part) = self.canvas.part(low, high) {
            self.draw_part(part, points, face, lift);
        }
    }

    fn draw_part(&mut self, part: Part, points: &[[f32; 2]], face: DrawnFace, lift: f64) {
        let mut within = HalfPlanes::new();
        let mut area = 0.0;
        let origin = points[0];
        let Some(mut from) = points.last().copied() else { return };
        for to in points {
            area += (from[0] - origin[0]) * (to[1] - from[1]) - (from[1] - origin[1]) * (to[0] - from[0]);
            from = *to;
        }
        let side = if area < 0.0 { -1.0 } else { 1.0 };
        for to in points {
            let step = [side * (to[0] - from[0]), side * (to[1] - from[1])];
            let seam = SEAM_PX * (step[0].abs() + step[1].abs());
            within.add([step[1] * from[0] - step[0] * from[1] + seam, -step[1], step[0]]);
            from = *to;
        }
        self.draw_within(part, &within, face, lift);
    }

    /// Draws a polygon that may reach behind the camera, by its corners in body axes.
    fn draw_reaching(&mut self, eye: &Eye, corners: &[DVec3], face: DrawnFace, lift: f64) {
        if corners.iter().all(|corner| corner.x < NEAR_M) {
            return;
        }
        let mut within = HalfPlanes::new();
        let normal = (1..corners.len().saturating_sub(1))
            .map(|k| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]))
            .sum::<DVec3>();
        let Some(mut from) = corners.last().copied() else { return };
        let side = if normal.dot(from) < 0.0 { -1.0 } else { 1.0 };
        for to in corners {
            // Positive for rays that pass on the inner side of the plane through the eye and the edge.
            let across = from.cross(*to);
            let scale = side / across.abs().max_element().max(1e-300);
            within.add([across.x, across.y / eye.focal_px, -across.z / eye.focal_px].map(|part| (part * scale) as f32));
            from = *to;
        }
        if let Some(part) = self.part_ahead(eye, corners) {
            self.draw_within(part, &within, face, lift);
        }
    }

    /// The part of the screen that a polygon covers with its points ahead of the camera.
    fn part_ahead(&self, eye: &Eye, corners: &[DVec3]) -> Option<Part> {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        let mut add = |point: DVec3| {
            let at = [eye.focal_px * point.y / point.x, -eye.focal_px * point.z / point.x].map(|part| part as f32);
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        };
        let mut from = *corners.last()?;
        for to in corners {
            if (from.x >= NEAR_M) != (to.x >= NEAR_M) {
                let mut cut = from + (*to - from) * ((NEAR_M - from.x) / (to.x - from.x));
                cut.x = NEAR_M;
                add(cut);
            }
            if to.x >= NEAR_M {
                add(*to);
            }
            from = *to;
        }
        self.canvas.part(low, high)
    }

    fn draw_within(&mut self, part: Part, within: &HalfPlanes, face: DrawnFace, lift: f64) {
        let plane = face.plane.map(|part| (part * (1.0 + lift)) as f32);
        let number = self.faces.len() as u32;
        self.faces.push(face);
        draw_polygon(self.level, &mut self.canvas, part, within, &Surface { plane, face: number });
    }
}

fn ground_face(eye: &Eye, polygon: &Polygon) -> Option<DrawnFace> {
    let plane: Linear = eye.plane(polygon.normal_in_world, polygon.point_in_world)?;
    Some(DrawnFace { plane, instance: 0, label: polygon.label })
}

/// Lowest and highest coordinates of points.
#[inline(always)]
fn bounds(points: &[[f32; 2]]) -> ([f32; 2], [f32; 2]) {
    let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    for point in points {
        for axis in 0..2 {
            low[axis] = if point[axis] < low[axis] { point[axis] } else { low[axis] };
            high[axis] = if point[axis] > high[axis] { point[axis] } else { high[axis] };
        }
    }
    (low, high)
}

/// Whether points are near enough to the image for single precision.
fn is_close(points: &[[f32; 2]]) -> bool {
    points.iter().flatten().all(|part| part.abs() < FAR_OFF_PX)
}
