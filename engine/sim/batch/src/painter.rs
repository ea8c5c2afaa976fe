//! One picture: boxes from near to far, ground, bodies; then the channels.

mod bodies;

use crate::boxes::{Boxes, Grouped};
use crate::canvas::{Canvas, Part, WIDE};
use crate::colours::Colours;
use crate::eye::{Eye, Linear, NEAR_M, scaled};
use crate::faces::{DrawnFace, SKY};
use crate::ground::{FAR_OFF_PX, Ground, Pack, Polygon, SeenPack};
use crate::hidden::Hidden;
use crate::lanes::LaneCandidate;
use crate::on_request;
use crate::outputs::Outputs;
use crate::raster::{HalfPlanes, MOST_LINES, SEAM_PX, Surface, draw_box, draw_lane, draw_polygon, draw_within};
use crate::resolve::resolve;
use crate::view::BatchView;
use cosfly_figures::{FigureParts, FigureTriangle, Wardrobe};
use cosfly_frames::DVec3;
use cosfly_frames::simd::Level;
use cosfly_render::BodyPart;

/// Most corners of a polygon.
const MOST_CORNERS: usize = WIDE * MOST_LINES;
/// Where a corner is farther from the image's centre than this per metre that it lies ahead, a rounding of its place in the
/// world counts on the screen.
const COARSE_PX_PER_M: f32 = 100.0;

/// Draws pictures of one size, one at a time; owns all buffers.
pub struct Painter {
    level: Level,
    canvas: Canvas,
    hidden: Hidden,
    faces: Vec<DrawnFace>,
    groups: Vec<LaneCandidate>,
    candidates: Vec<LaneCandidate>,
    seen: SeenPack,
    wardrobe: Wardrobe,
    /// Parts of the body that is drawn.
    body: Option<Box<FigureParts>>,
    /// Triangles of a vehicle.
    vehicle: Vec<FigureTriangle>,
    /// Whether colours are asked for, and the parts of bodies that they need.
    has_colours: bool,
    parts: Vec<BodyPart>,
    colours: Colours,
}

impl Painter {
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            level: Level::best(),
            canvas: Canvas::new(width, height),
            hidden: Hidden::default(),
            faces: Vec::new(),
            groups: Vec::new(),
            candidates: Vec::new(),
            seen: SeenPack::default(),
            wardrobe: Wardrobe::default(),
            body: None,
            vehicle: Vec::new(),
            has_colours: false,
            parts: Vec::new(),
            colours: Colours::default(),
        }
    }

    pub fn set_level(&mut self, level: Level) {
        self.level = level;
    }

    /// Draws a picture into buffers of its own size.
    pub fn paint(&mut self, view: &BatchView<'_>, outputs: &mut Outputs<'_>) {
        if view.scene.is_scan {
            return self.colours.draw_scan(self.level, view, [self.canvas.width, self.canvas.height], outputs);
        }
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
        self.draw_ground(&eye, &view.scene.ground);
        self.has_colours = outputs.rgb.is_some();
        self.parts.clear();
        self.draw_people(&eye, view);
        if let Some(rgb) = &mut outputs.rgb {
            self.colours.draw(self.level, view, &self.canvas, (&self.faces, &self.parts), rgb);
        }
        if outputs.has_geometry() {
            resolve(self.level, &self.canvas, &self.faces, outputs);
        }
        if !outputs.on_request.is_empty() {
            on_request::draw(&eye, &self.canvas, &self.faces, &mut outputs.on_request);
        }
    }

    /// Boxes that may be seen, from near to far.
    fn draw_boxes(&mut self, eye: &Eye, boxes: &Boxes, grouped: &Grouped) {
        let Self { level, canvas, hidden, .. } = self;
        self.groups.clear();
        grouped.around().gather(*level, eye, canvas, hidden, &mut self.groups);
        self.candidates.clear();
        for group in &self.groups {
            let (first, lanes) = grouped.group(group.index);
            let start = self.candidates.len();
            lanes.gather(*level, eye, canvas, hidden, &mut self.candidates);
            self.candidates[start..].iter_mut().for_each(|candidate| candidate.index += first);
        }
        near_first(&mut self.candidates);
        for LaneCandidate { index, part, nearest } in &self.candidates {
            if !hidden.hides(canvas, *part, *nearest)
                && let Some(shape) = boxes.on_screen(*index, eye, &mut self.faces)
            {
                draw_box(*level, canvas, *part, &shape);
            }
        }
    }

    fn draw_triangle(&mut self, eye: &Eye, corners_in_world: &[DVec3; 3], face: DrawnFace) {
        let corners = corners_in_world.map(|corner| eye.see(corner));
        self.draw_seen_triangle(eye, &corners, face);
    }

    /// Draws a triangle by its corners in body axes; the plane of `face` is set here.
    fn draw_seen_triangle(&mut self, eye: &Eye, corners: &[DVec3; 3], face: DrawnFace) {
        let points = corners.map(|corner| {
            [eye.focal_px * corner.y / corner.x, -eye.focal_px * corner.z / corner.x].map(|part| part as f32)
        });
        let nearest_m = corners.iter().map(|corner| corner.x).fold(f64::INFINITY, f64::min);
        if nearest_m >= NEAR_M && points.iter().flatten().all(|part| part.abs() < FAR_OFF_PX) {
            let (low, high) = bounds(&points);
            // Most are so small that they lie between pixel centres.
            let Some(part) = self.canvas.part(low, high) else { return };
            if let Some(plane) = plane_through(eye, corners) {
                self.draw_part(part, &points, DrawnFace { plane, ..face }, 0.0);
            }
        } else if let Some(plane) = plane_through(eye, corners) {
            self.draw_reaching(eye, corners, DrawnFace { plane, ..face }, 0.0);
        }
    }

    fn draw_ground(&mut self, eye: &Eye, ground: &Ground) {
        let mut groups = core::mem::take(&mut self.groups);
        let mut seen = core::mem::take(&mut self.seen);
        groups.clear();
        ground.around().gather(self.level, eye, &self.canvas, &self.hidden, &mut groups);
        near_first(&mut groups);
        let mut packs = core::mem::take(&mut self.candidates);
        for group in &groups {
            let cluster = ground.cluster(group.index);
            let origin = eye.pixels_ahead(eye.see(cluster.center_in_world)).as_vec3().to_array();
            packs.clear();
            cluster.around.gather(self.level, eye, &self.canvas, &self.hidden, &mut packs);
            for pack in &packs {
                let pack = ground.pack(cluster, pack.index);
                ground.project(self.level, eye, origin, pack, &mut seen);
                self.draw_pack(eye, ground, pack, &seen);
            }
        }
        self.candidates = packs;
        (self.groups, self.seen) = (groups, seen);
    }

    fn draw_pack(&mut self, eye: &Eye, ground: &Ground, pack: &Pack, seen: &SeenPack) {
        for k in 0..pack.count {
            let Some(part) = seen.parts.get(k) else { continue };
            if self.hidden.hides(&self.canvas, part, 1.0 / seen.nearest_m[k].max(NEAR_M as f32)) {
                continue;
            }
            let polygon = ground.polygon(pack, k);
            let Some(face) = ground_face(eye, polygon) else { continue };
            let count = polygon.count().min(MOST_CORNERS);
            if seen.nearest_m[k] >= NEAR_M as f32 && seen.coarse[k] < COARSE_PX_PER_M {
                if count <= WIDE {
                    let surface = self.surface(face, polygon.lift);
                    draw_lane(self.level, &mut self.canvas, part, (&seen.corners, k, count), &surface);
                } else {
                    let corner = |number: usize| [seen.corners[number][0][k], seen.corners[number][1][k]];
                    let points: [[f32; 2]; MOST_CORNERS] = core::array::from_fn(|k| corner(k.min(count - 1)));
                    self.draw_part(part, &points[..count], face, polygon.lift);
                }
            } else {
                let mut corners = [DVec3::ZERO; MOST_CORNERS];
                for (corner, in_world) in corners.iter_mut().zip(ground.corners_in_world(polygon)) {
                    *corner = eye.see(*in_world);
                }
                self.draw_reaching(eye, &corners[..count], face, polygon.lift);
            }
        }
    }

    /// Draws a polygon ahead of the camera, by its corners on the screen.
    fn draw_points(&mut self, points: &[[f32; 2]], face: DrawnFace, lift: f64) {
        let (low, high) = bounds(points);
        if let Some(part) = self.canvas.part(low, high) {
            self.draw_part(part, points, face, lift);
        }
    }

    fn draw_part(&mut self, part: Part, points: &[[f32; 2]], face: DrawnFace, lift: f64) {
        let surface = self.surface(face, lift);
        if points.len() <= WIDE {
            draw_polygon(self.level, &mut self.canvas, part, points, &surface);
            return;
        }
        let (mut area, mut from) = (0.0, points[points.len() - 1]);
        for to in points {
            area += (from[0] - points[0][0]) * (to[1] - from[1]) - (from[1] - points[0][1]) * (to[0] - from[0]);
            from = *to;
        }
        let within = between(points, if area < 0.0 { -1.0 } else { 1.0 });
        draw_within(self.level, &mut self.canvas, part, &within, &surface);
    }

    /// Draws a polygon that may reach behind the camera, by its corners in body axes.
    fn draw_reaching(&mut self, eye: &Eye, corners: &[DVec3], face: DrawnFace, lift: f64) {
        let (Some(part), Some(last)) = (self.part_ahead(eye, corners), corners.last()) else { return };
        let mut within = HalfPlanes::new();
        let normal = (1..corners.len().saturating_sub(1))
            .map(|k| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]))
            .sum::<DVec3>();
        let side = if normal.dot(*last) < 0.0 { -1.0 } else { 1.0 };
        let mut from = *last;
        for to in corners {
            // Positive for rays that pass on the inner side of the plane through the eye and the edge.
            let across = from.cross(*to);
            let scale = side / across.abs().max_element().max(1e-300);
            within.add([across.x, across.y / eye.focal_px, -across.z / eye.focal_px].map(|part| (part * scale) as f32));
            from = *to;
        }
        let surface = self.surface(face, lift);
        draw_within(self.level, &mut self.canvas, part, &within, &surface);
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

    /// Adds a face to the list.
    fn surface(&mut self, face: DrawnFace, lift: f64) -> Surface {
        let plane = scaled(face.plane, 1.0 + lift);
        let number = self.faces.len() as f32;
        self.faces.push(face);
        Surface { plane, face: number }
    }
}

/// The half planes between the edges of a polygon; `side` is -1 where its corners go around it the other way.
#[inline(always)]
fn between<const BLOCKS: usize>(points: &[[f32; 2]], side: f32) -> HalfPlanes<BLOCKS> {
    let mut within = HalfPlanes::new();
    let mut from = points[points.len() - 1];
    for to in points {
        let step = [side * (to[0] - from[0]), side * (to[1] - from[1])];
        let seam = SEAM_PX * (step[0].abs() + step[1].abs());
        within.add([step[1] * from[0] - step[0] * from[1] + seam, -step[1], step[0]]);
        from = *to;
    }
    within
}

/// From near to far: greater inverse depths first; those of positive floats are ordered as their bits.
fn near_first(candidates: &mut [LaneCandidate]) {
    candidates.sort_unstable_by_key(|candidate| (!candidate.nearest.to_bits(), candidate.index));
}

/// The plane through three points in body axes; `None` where the camera lies in it.
fn plane_through(eye: &Eye, corners: &[DVec3; 3]) -> Option<Linear> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let scale = 1.0 / normal.dot(corners[0]);
    let by_focal = scale / eye.focal_px;
    scale.is_finite().then_some([normal.x * scale, normal.y * by_focal, -normal.z * by_focal])
}

fn ground_face(eye: &Eye, polygon: &Polygon) -> Option<DrawnFace> {
    let plane: Linear = eye.plane(polygon.normal_in_world, polygon.offset_m)?;
    Some(DrawnFace { plane, instance: 0, number: polygon.number, triangle: 0, label: polygon.label })
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
