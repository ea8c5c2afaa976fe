//! The mesh of a scene in a frame: its triangles in the place of boxes, its baked light, shadows of bodies on it.

use super::Renderer;
use crate::faces::{DrawnFace, FaceSource, ground_lift};
use crate::passes::ids::Run;
use crate::scene::Scene;
use crate::scene_mesh::{MeshCluster, SceneMesh};
use crate::setup::FrameSetup;
use cosfly_domain::SemanticLabel;
use cosfly_frames::DVec3;
use cosfly_materials::scan_light::CodeCurve;
use cosfly_models::mesh::{MeshTriangle, TexturedMesh};
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::{NEAR_M, PlaneOnScreen, Screen, bounds};
use rayon::prelude::*;

/// Share of its inverse depth with which ground is drawn behind a mesh: it shows through holes, and hides nothing. A power of two.
pub(super) const BEHIND: f32 = 1.0 / 1_048_576.0;
/// Clusters that are drawn before the tiles of what hides others are measured; then twice as many, and so on.
const FIRST_CLUSTERS: usize = 64;

impl Renderer {
    /// Triangles of a mesh from near to far; what hides others is measured as the picture fills.
    pub(super) fn draw_mesh_faces(&mut self, mesh: &SceneMesh, eye: &Eye) {
        self.visible.clear();
        for (index, cluster) in mesh.clusters.iter().enumerate() {
            if let Some(key) = eye.order_if_seen(&self.screen, cluster.center_in_world, cluster.half_bounds_m) {
                self.visible.push((key, index as u32));
            }
        }
        self.visible.sort_unstable();
        let mut next_look = FIRST_CLUSTERS;
        for position in 0..self.visible.len() {
            if position == next_look {
                self.nearer.measure(&self.nearest);
                next_look *= 2;
            }
            let cluster = &mesh.clusters[self.visible[position].1 as usize];
            if position >= FIRST_CLUSTERS && self.is_hidden_box(cluster, eye) {
                continue;
            }
            cluster.triangles.clone().for_each(|number| self.draw_mesh_triangle(mesh, number, eye));
        }
    }

    /// Whether the bounds of a cluster lie behind what is drawn.
    fn is_hidden_box(&self, cluster: &MeshCluster, eye: &Eye) -> bool {
        let (mut nearest_m, mut points) = (f64::INFINITY, [[0.0; 2]; 8]);
        for (number, point) in points.iter_mut().enumerate() {
            let side = |axis: usize| if number >> axis & 1 == 1 { 1.0 } else { -1.0 };
            let seen = eye.see(cluster.center_in_world + DVec3::new(side(0), side(1), side(2)) * cluster.half_bounds_m);
            nearest_m = nearest_m.min(seen.x);
            *point = self.screen_point(seen);
        }
        let (low, high) = bounds(&points);
        nearest_m >= NEAR_M && self.nearer.hides(low, high, 1.0 / nearest_m)
    }

    fn screen_point(&self, seen: DVec3) -> [f64; 2] {
        let scale = self.screen.focal_px / seen.x;
        [self.screen.center_u + seen.y * scale, self.screen.center_v - seen.z * scale]
    }

    fn draw_mesh_triangle(&mut self, scene: &SceneMesh, number: usize, eye: &Eye) {
        let triangle = &scene.mesh.triangles[number];
        let corners_in_world = triangle.corners();
        let corners = corners_in_world.map(|corner| eye.see(corner));
        let is_ahead = corners.iter().all(|corner| corner.x >= NEAR_M);
        let points = corners.map(|corner| self.screen_point(corner));
        // Most triangles of a scan are small: those between pixel centres are no faces.
        let rows = if is_ahead { self.nearest.rows_of(&points) } else { Some((0, 0)) };
        let Some(rows) = rows else { return };
        let [a, b, c] = corners_in_world;
        let normal_in_world = (b - a).cross(c - a).normalize_or_zero();
        let normal = eye.turn(normal_in_world);
        let side = if normal.dot(corners[0]) < 0.0 { 1.0 } else { -1.0 };
        let screen = self.screen;
        let Some(plane) = PlaneOnScreen::new(&screen, side * normal, corners[0]) else { return };
        let look = scene.looks[number];
        let bias = if look.instance == 0 { label_lift(look.label) } else { 0.0 };
        let face = self.faces.len() as u32;
        match scene.mesh.materials[triangle.material as usize].least_alpha {
            Some(least) => {
                let surface = MeshSurface::new(triangle, (&screen, eye), plane);
                let keep = |u, v| surface.look_at(&scene.mesh, u, v)[3] >= least;
                self.nearest.draw_polygon_where(&screen, (&corners, &plane, bias), face, keep);
            }
            None if is_ahead => self.nearest.draw_rows(&points, rows, &plane.lifted(bias), face),
            None => self.nearest.draw_polygon(&screen, &corners, &plane, bias, face),
        }
        let normal = (side * normal_in_world).as_vec3().to_array();
        let source = FaceSource::Mesh { triangle: number as u32 };
        self.faces.push(DrawnFace { plane, normal, source, label: look.label, instance: look.instance });
    }

    /// Gives ground that was drawn behind a mesh its own depth.
    pub(super) fn bring_ground_forward(&mut self) {
        let Self { nearest, faces, .. } = self;
        for (inverse, face) in nearest.inverse_depth.iter_mut().zip(&nearest.face) {
            if let Some(FaceSource::Ground { .. }) = faces.get(*face as usize).map(|face| face.source) {
                *inverse /= BEHIND;
            }
        }
    }

    /// The colours of the scene's mesh over its shaded faces, darker where bodies darken them.
    pub(super) fn draw_mesh(&mut self, scene: &Scene, setup: &FrameSetup<'_>) {
        let Some(own) = &scene.mesh else { return };
        let eye = Eye::new(&setup.pose);
        let Self { runs, faces, images, composer, screen, parallel, shader, .. } = self;
        let (faces, lit, screen) = (&*faces, &composer.lit, *screen);
        let (air, camera, depth_m) = (shader.scan_air(), shader.camera_light(), &images.depth_m);
        let curve = CodeCurve::default();
        let fill = |row: usize, runs: &[Run], rgb: &mut [u8]| {
            for run in runs {
                let Some(DrawnFace { source: FaceSource::Mesh { triangle }, plane, .. }) = faces.get(run.face as usize)
                else {
                    continue;
                };
                let surface = MeshSurface::new(&own.mesh.triangles[*triangle as usize], (&screen, &eye), *plane);
                let first = run.start as usize % screen.width;
                for column in first..first + run.length as usize {
                    let look = surface.look_at(&own.mesh, column as f64 + 0.5, row as f64 + 0.5);
                    let pixel = row * screen.width + column;
                    let factor = own.exposure * lit.get(pixel).copied().unwrap_or(1.0);
                    let kept = air.map_or(1.0, |air| air.kept(pixel, screen.width, depth_m[pixel]));
                    let light = |k: usize| {
                        let light = factor * camera[k] * look[k];
                        air.map_or(light, |air| air.seen(light, kept, k))
                    };
                    let bytes = [0, 1, 2].map(|k| (255.0 * curve.encoded(light(k)) + 0.5) as u8);
                    rgb[3 * column..3 * column + 3].copy_from_slice(&bytes);
                }
            }
        };
        let rows: Vec<(usize, &[Run])> = runs.rows().enumerate().collect();
        let width = 3 * screen.width.max(1);
        if *parallel {
            rows.into_par_iter()
                .zip(images.rgb.par_chunks_mut(width))
                .for_each(|((row, runs), rgb)| fill(row, runs, rgb));
        } else {
            rows.into_iter().zip(images.rgb.chunks_mut(width)).for_each(|((row, runs), rgb)| fill(row, runs, rgb));
        }
    }
}

/// [`ground_lift`] of a label by its id.
fn label_lift(label: u8) -> f64 {
    [SemanticLabel::Terrain, SemanticLabel::Ground, SemanticLabel::Water, SemanticLabel::Roads, SemanticLabel::RoadLine]
        .into_iter()
        .find(|known| known.id() == label)
        .map_or_else(|| ground_lift(SemanticLabel::SideWalks), ground_lift)
}

/// A triangle as a camera sees it: from pixels to places in its texture.
struct MeshSurface<'a> {
    triangle: &'a MeshTriangle,
    plane: PlaneOnScreen,
    /// Weights of the second and third corner at the eye.
    at_eye: [f64; 2],
    /// Their change along a pixel's ray for a metre of depth: at pixel (0, 0), more per pixel to the right, and down.
    along_ray: [DVec3; 2],
    /// From the first corner's place in the texture to those of the second and third.
    sides: [[f32; 2]; 2],
}

impl<'a> MeshSurface<'a> {
    fn new(triangle: &'a MeshTriangle, (screen, eye): (&Screen, &Eye), plane: PlaneOnScreen) -> Self {
        let [a, b, c] = triangle.corners();
        let (along, aside) = (b - a, c - a);
        let normal = along.cross(aside);
        let per_m = [aside.cross(normal), normal.cross(along)].map(|dual| dual / normal.length_squared());
        let [ahead, right, up] = [0, 1, 2].map(|axis| eye.world_from_body.col(axis));
        let (right, down) = (right / screen.focal_px, -up / screen.focal_px);
        let first = ahead - right * screen.center_u - down * screen.center_v;
        let along_ray = per_m.map(|dual| DVec3::new(dual.dot(first), dual.dot(right), dual.dot(down)));
        let at_eye = per_m.map(|dual| dual.dot(eye.position_in_world - a));
        let [from, to, other] = triangle.texture_places;
        let sides = [to, other].map(|there| [0, 1].map(|k| there[k] - from[k]));
        Self { triangle, plane, at_eye, along_ray, sides }
    }

    /// Linear colour and opacity of a pixel, by the part of the texture that it covers.
    fn look_at(&self, mesh: &TexturedMesh, u: f64, v: f64) -> [f32; 4] {
        let depth_m = 1.0 / self.plane.at(u, v);
        let rays = self.along_ray.map(|ray| depth_m * (ray.x + ray.y * u + ray.z * v));
        let [second, third] = [0, 1].map(|k| (self.at_eye[k] + rays[k]) as f32);
        // What one pixel to the right and one down change.
        let change = |axis: usize, of_plane: f64| {
            let of_weights = [0, 1].map(|k| (depth_m * (self.along_ray[k][axis] - rays[k] * of_plane)) as f32);
            [0, 1].map(|k| of_weights[0] * self.sides[0][k] + of_weights[1] * self.sides[1][k])
        };
        let pixel = [change(1, self.plane.across), change(2, self.plane.down)];
        mesh.look_at(self.triangle, [1.0 - second - third, second, third], pixel)
    }
}
