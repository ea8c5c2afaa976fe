//! The mesh of a scene in a frame: its triangles in the place of boxes, its baked light, shadows of bodies on it.

use super::Renderer;
use crate::faces::{DrawnFace, FaceSource, ground_lift};
use crate::scene::Scene;
use crate::scene_mesh::SceneMesh;
use crate::setup::FrameSetup;
use cosfly_domain::SemanticLabel;
use cosfly_frames::DVec3;
use cosfly_materials::scan_light::CodeCurve;
use cosfly_models::mesh::{MeshTriangle, TexturedMesh};
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::{NEAR_M, PlaneOnScreen, Screen};
use rayon::prelude::*;
use std::ops::Range;

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
            if position >= FIRST_CLUSTERS
                && self.nearer.hides_box((eye, &self.screen), cluster.center_in_world, cluster.half_bounds_m)
            {
                continue;
            }
            cluster.triangles.clone().for_each(|number| self.draw_mesh_triangle(mesh, number, eye));
        }
    }

    fn draw_mesh_triangle(&mut self, scene: &SceneMesh, number: usize, eye: &Eye) {
        let triangle = &scene.mesh.triangles[number];
        let corners_in_world = triangle.corners();
        let corners = corners_in_world.map(|corner| eye.see(corner));
        let is_ahead = corners.iter().all(|corner| corner.x >= NEAR_M);
        let points = corners.map(|corner| self.screen.point(corner));
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

    /// The textures of the scene's mesh at each of its pixels.
    pub(super) fn find_albedo(&mut self, scene: &Scene, setup: &FrameSetup<'_>) {
        self.albedo.clear();
        let Some(own) = &scene.mesh else { return };
        let Self { albedo, nearest, faces, screen, parallel, .. } = self;
        albedo.resize(nearest.face.len(), [0.0; 3]);
        let (eye, screen, faces) = (Eye::new(&setup.pose), *screen, &*faces);
        for_each_row((*parallel, screen.width), &nearest.face, (albedo, 1), |row, seen, albedo| {
            for (face, columns) in runs_of(seen) {
                let Some((triangle, plane)) = mesh_face(faces, face) else { continue };
                let surface = MeshSurface::new(&own.mesh.triangles[triangle as usize], (&screen, &eye), plane);
                for column in columns {
                    let [red, green, blue, _] = surface.look_at(&own.mesh, column as f64 + 0.5, row as f64 + 0.5);
                    albedo[column] = [red, green, blue];
                }
            }
        });
    }

    /// The colours of the scene's mesh over its shaded faces, darker where bodies darken them.
    pub(super) fn draw_mesh(&mut self, scene: &Scene) {
        let Some(own) = scene.mesh.as_ref().filter(|own| !own.is_lit) else { return };
        let Self { nearest, faces, images, composer, screen, parallel, shader, albedo, .. } = self;
        let (faces, lit, width) = (&*faces, &composer.lit, screen.width);
        let (air, camera, depth_m) = (shader.scan_air(), shader.camera_light(), &images.depth_m);
        let curve = CodeCurve::default();
        for_each_row((*parallel, width), &nearest.face, (&mut images.rgb, 3), |row, seen, rgb| {
            for (_, columns) in runs_of(seen).filter(|(face, _)| mesh_face(faces, *face).is_some()) {
                for column in columns {
                    let pixel = row * width + column;
                    let factor = own.exposure * lit.get(pixel).copied().unwrap_or(1.0);
                    let kept = air.map_or(1.0, |air| air.kept(pixel, width, depth_m[pixel]));
                    let light = |k: usize| {
                        let light = factor * camera[k] * albedo[pixel][k];
                        air.map_or(light, |air| air.seen(light, kept, k))
                    };
                    let bytes = [0, 1, 2].map(|k| (255.0 * curve.encoded(light(k)) + 0.5) as u8);
                    rgb[3 * column..3 * column + 3].copy_from_slice(&bytes);
                }
            }
        });
    }
}

/// Triangle and plane of a drawn face of a mesh; none of others.
fn mesh_face(faces: &[DrawnFace], face: u32) -> Option<(u32, PlaneOnScreen)> {
    let face = faces.get(face as usize)?;
    let FaceSource::Mesh { triangle } = face.source else { return None };
    Some((triangle, face.plane))
}

/// Fills rows, each from the faces seen in it and with `per` values a pixel, on all threads or on this one.
fn for_each_row<T: Send>(
    (parallel, width): (bool, usize),
    seen: &[u32],
    (filled, per): (&mut [T], usize),
    fill: impl Fn(usize, &[u32], &mut [T]) + Sync,
) {
    let width = width.max(1);
    let fill = |(row, (seen, filled)): (usize, (&[u32], &mut [T]))| fill(row, seen, filled);
    if parallel {
        seen.par_chunks(width).zip(filled.par_chunks_mut(per * width)).enumerate().for_each(fill);
    } else {
        seen.chunks(width).zip(filled.chunks_mut(per * width)).enumerate().for_each(fill);
    }
}

/// Faces of a row, each with the columns of it that follow one another.
fn runs_of(row: &[u32]) -> impl Iterator<Item = (u32, Range<usize>)> {
    let mut first = 0;
    row.chunk_by(|left, right| left == right).map(move |run| {
        let columns = first..first + run.len();
        first = columns.end;
        (run[0], columns)
    })
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
