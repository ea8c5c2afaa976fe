//! The town's shadow map: tiles of several sizes of texels, drawn where a view first needs them and kept for all cameras of
//! the town under the same sun.
//!
//! A tile depends on the town, the sun and its own place alone, so pictures do not depend on who drew it or when.

use super::sun_tiles::{Sun, Tile, TilePlace};
use super::sunlight::{
    LEAVES, PACKED_ROWS, SAMPLES, SOLID, SUMMARY_SIDE, Samples, TILE, Texels, WINDOW_TILES, add_sample, measure_tile,
    pack_tile,
};
use crate::props::Prop;
use crate::scene::Scene;
use crate::scene_mesh::{MeshCluster, SceneMesh};
use cosfly_domain::ObstacleKind;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3};
use cosfly_materials::parts::BOX_FACES;
use cosfly_raster::seen_region::SeenRegion;
use cosfly_raster::shadow_frame::ShadowFrame;
use cosfly_raster::visibility::{PlaneOnScreen, VisibilityBuffer};
use std::sync::Arc;

/// Posts thinner than this cast the shadow of a post this thick, half their width in texels: the map would tear them.
const LEAST_HALF_WIDTH_TEXELS: f64 = 0.25;
/// Places of samples from a texel's middle, texels: each has a column and a row of its own.
const SAMPLES_AT: [[f64; 2]; SAMPLES] = [[-0.375, -0.125], [-0.125, 0.375], [0.125, -0.375], [0.375, 0.125]];
/// Samples of a texel that differ by more in height belong to two surfaces, texels.
const GAP_TEXELS: f64 = 1.5;

/// Draws tiles; one for each renderer.
pub(super) struct Painter {
    canvas: VisibilityBuffer,
    samples: Samples,
    packed: Box<[u32]>,
    /// Tiles from a first to before an end, by column and row.
    parts: Vec<(usize, [i32; 2], [i32; 2])>,
}

impl Painter {
    pub(super) fn new() -> Self {
        let side = WINDOW_TILES as usize * TILE + 1;
        Self {
            canvas: VisibilityBuffer::new(side, side),
            samples: Samples {
                sums: vec![0.0; side * side],
                seen: vec![0; side * side],
                floors: vec![0.0; side * side],
            },
            packed: vec![0; PACKED_ROWS * TILE].into_boxed_slice(),
            parts: Vec::new(),
        }
    }

    /// Draws tiles, keeps them for all cameras, and hands them to `take`.
    pub(super) fn draw(
        &mut self,
        level: Level,
        (scene, sun): (&Scene, &Sun),
        places: &mut [TilePlace],
        mut take: impl FnMut(TilePlace, Option<&Tile>),
    ) {
        join(places, &mut self.parts);
        for at in 0..self.parts.len() {
            let (grain, first, end) = self.parts[at];
            let lattice = sun.lattice(grain);
            let corner = DVec2::new(f64::from(first[0]), f64::from(first[1])) * TILE as f64;
            let frame = ShadowFrame { corner, ..lattice };
            // Of the neighbours one row and column more.
            let size = [0, 1].map(|k| (end[k] - first[k]) as usize * TILE + 1);
            let anything = self.draw_samples(level, (scene, sun), &frame, size);
            for row in first[1]..end[1] {
                for column in first[0]..end[0] {
                    let texel = [(column - first[0]) as usize * TILE, (row - first[1]) as usize * TILE];
                    let tile = if anything { self.tile(level, texel, sun.steps_per_m) } else { None };
                    take((grain, row, column), tile.as_ref());
                    scene.sun_maps.keep(sun, (grain, row, column), tile);
                }
            }
        }
    }

    /// The tile whose first texel is at a place of the canvas; none where nothing stands.
    fn tile(&mut self, level: Level, [column, row]: [usize; 2], steps_per_m: f32) -> Option<Tile> {
        let (width, _) = self.canvas.size();
        let from = row * width + column;
        let Samples { sums, seen, floors } = &self.samples;
        if !pack_tile(level, &sums[from..], &seen[from..], width, steps_per_m, &mut self.packed) {
            return None;
        }
        let mut summary = [0; SUMMARY_SIDE * SUMMARY_SIDE];
        measure_tile(level, &self.packed, &floors[from..], width, steps_per_m, &mut summary);
        Some(Tile { texels: Arc::new(Texels::of(&self.packed)), summary: Arc::new(summary) })
    }

    /// Adds samples of everything that throws shadows up, in the first columns and rows; whether there is anything.
    fn draw_samples(
        &mut self,
        level: Level,
        (scene, sun): (&Scene, &Sun),
        frame: &ShadowFrame,
        [columns, rows]: [usize; 2],
    ) -> bool {
        let (width, _) = self.canvas.size();
        let lines = (0..rows).map(|row| row * width..row * width + columns);
        for line in lines.clone() {
            self.samples.sums[line.clone()].fill(0.0);
            self.samples.seen[line.clone()].fill(0);
            self.samples.floors[line].fill(f32::MAX);
        }
        let gap_m = (GAP_TEXELS * frame.texels_m.x) as f32;
        for at in SAMPLES_AT {
            let frame = ShadowFrame { corner: frame.corner + DVec2::from_array(at), ..*frame };
            if !self.draw_part(scene, sun, &frame, SeenRegion { first: [0; 2], end: [columns, rows] }) {
                return false;
            }
            for line in lines.clone() {
                let (heights, classes) = (&self.canvas.inverse_depth[line.clone()], &self.canvas.face[line.clone()]);
                let Samples { sums, seen, floors } = &mut self.samples;
                let rows = (&mut sums[line.clone()], &mut seen[line.clone()], &mut floors[line]);
                add_sample(level, heights, classes, gap_m, rows);
            }
        }
        true
    }

    /// Draws everything that throws shadows into a part of the canvas; whether there is anything.
    fn draw_part(&mut self, scene: &Scene, sun: &Sun, frame: &ShadowFrame, part: SeenRegion) -> bool {
        self.canvas.clear_part(part.first, part.end);
        if let Some(mesh) = scene.lit_mesh() {
            return self.draw_mesh(mesh, frame, sun.to_sun, part);
        }
        let mut anything = false;
        let least_m = LEAST_HALF_WIDTH_TEXELS * frame.texels_m.x;
        for b in &scene.boxes {
            let class = if b.kind == ObstacleKind::TreeCrown { LEAVES } else { SOLID };
            let thin = f64::from(b.half_extents_m.x.min(b.half_extents_m.y));
            let grow = (least_m / thin.max(0.01)).clamp(1.0, 8.0);
            let upright = b.half_extents_m.z > b.half_extents_m.x.max(b.half_extents_m.y);
            let wide = if upright { DVec3::new(grow, grow, 1.0) } else { DVec3::ONE };
            if frame.misses(&part, b.center_in_world, wide * b.half_bounds_m) {
                continue;
            }
            anything = true;
            for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                let normal = b.normal_in_world(face);
                if normal.dot(sun.to_sun) > 1e-6 {
                    let corners = around
                        .map(|corner| b.center_in_world + wide * (b.corners_in_world[corner] - b.center_in_world));
                    draw(&mut self.canvas, (frame, part), sun.to_sun, normal, &corners, class);
                }
            }
        }
        anything | self.draw_props(scene, frame, sun.to_sun, part)
    }

    /// Triangles of a lit mesh throw shadows in the place of boxes and models, those of cut-outs as leaves do.
    fn draw_mesh(&mut self, own: &SceneMesh, frame: &ShadowFrame, to_sun: DVec3, part: SeenRegion) -> bool {
        let is_seen = |it: &&MeshCluster| !frame.misses(&part, it.center_in_world, it.half_bounds_m);
        for cluster in own.clusters.iter().filter(is_seen) {
            for triangle in &own.mesh.triangles[cluster.triangles.clone()] {
                let corners = triangle.corners();
                let [a, b, c] = corners;
                let normal = (b - a).cross(c - a).normalize_or_zero();
                let is_cut = own.mesh.materials[triangle.material as usize].least_alpha.is_some();
                draw(&mut self.canvas, (frame, part), to_sun, normal, &corners, if is_cut { LEAVES } else { SOLID });
            }
        }
        own.clusters.iter().any(|it| is_seen(&it))
    }

    /// Both sides of a model's triangles throw shadows.
    fn draw_props(&mut self, scene: &Scene, frame: &ShadowFrame, to_sun: DVec3, part: SeenRegion) -> bool {
        let is_seen = |it: &&Prop| !frame.misses(&part, it.center_in_world, it.half_bounds_m);
        for prop in scene.props.props.iter().filter(is_seen) {
            let class = if prop.is_leafy { LEAVES } else { SOLID };
            for triangle in &scene.props.triangles[prop.triangles.clone()] {
                let (normal, corners) = (triangle.normal_in_world, &triangle.corners_in_world);
                draw(&mut self.canvas, (frame, part), to_sun, normal, corners, class);
            }
        }
        scene.props.props.iter().any(|it| is_seen(&it))
    }
}

/// Joins tiles to few rectangles that fit the canvas.
fn join(places: &mut [TilePlace], parts: &mut Vec<(usize, [i32; 2], [i32; 2])>) {
    places.sort_unstable();
    parts.clear();
    let mut rest = &*places;
    while let Some(&(grain, row, column)) = rest.first() {
        let run = rest.iter().zip(column..).take_while(|(place, next)| **place == (grain, row, *next));
        let count = run.take(WINDOW_TILES as usize).count();
        rest = &rest[count..];
        let (first, end) = ([column, row], [column + count as i32, row + 1]);
        let above = parts.iter_mut().find(|(of, from, to)| {
            let fits = to[1] == row && row - from[1] < WINDOW_TILES;
            *of == grain && fits && (from[0], to[0]) == (first[0], end[0])
        });
        match above {
            Some((_, _, to)) => to[1] = end[1],
            None => parts.push((grain, first, end)),
        }
    }
}

/// Draws a face, of which the sun may see either side, where a part of the map needs it: its height is affine over the sheared
/// ground. A face along the light throws no shadow.
pub(super) fn draw(
    map: &mut VisibilityBuffer,
    (frame, part): (&ShadowFrame, SeenRegion),
    to_sun: DVec3,
    normal: DVec3,
    corners: &[DVec3],
    class: u32,
) {
    let mut points = [[0.0; 2]; 4];
    for (point, corner) in points.iter_mut().zip(corners) {
        *point = frame.place(*corner);
    }
    let points = &points[..corners.len().min(4)];
    let Some(rows) = map.rows_within(points, part.first, part.end) else { return };
    if normal.dot(to_sun).abs() <= 1e-6 {
        return;
    }
    // Along the map's x axis the face's point moves by (1, 0, 0) + slope * sun / sun.z with no way along the normal.
    let facing = normal.dot(to_sun) / to_sun.z;
    let slope = -normal.truncate() / facing;
    let across = slope.dot(frame.axes[0]) * frame.texels_m.x;
    let down = slope.dot(frame.axes[1]) * frame.texels_m.y;
    let constant = frame.height(corners[0]) - across * points[0][0] - down * points[0][1];
    map.draw_rows(points, rows, &PlaneOnScreen { constant, across, down }, class);
}

#[cfg(test)]
mod tests {
    use super::super::sunlight::LOWEST_M;
    use super::*;
    use cosfly_domain::{Obstacle, OrientedBox, Town};
    use cosfly_frames::{Seed, real};
    use cosfly_materials::vector::Vec3;

    #[test]
    fn edges_of_shadows_at_a_slant_are_no_stairs_on_the_ground_and_on_a_roof() {
        let yaw_rad = -0.1;
        let (center_in_world, half_extents_m) = (DVec3::new(-26.0, 16.0, 8.0), DVec3::new(20.0, 20.0, 8.0));
        let building = |center_in_world, half_extents_m, yaw_rad| Obstacle {
            shape: OrientedBox { center_in_world, half_extents_m, yaw_rad },
            kind: ObstacleKind::Building,
            object_id: 0,
            synthetic: false,
        };
        let house = building(center_in_world, half_extents_m, yaw_rad);
        let low = building(DVec3::new(0.0, 0.0, 4.0), DVec3::new(90.0, 90.0, 4.0), 0.0);
        // The roof's edge, whose shadow runs along the light but for its slant.
        let (sin, cos) = real::sin_cos(yaw_rad);
        let edge_at = center_in_world + 20.0 * DVec3::new(cos, sin, 0.0);
        for (obstacles, surface_m) in [(vec![house.clone()], 0.1), (vec![low, house], 8.1)] {
            let town = Town { obstacles, ..Town::default() };
            let sun = Sun::new(Vec3::new(0.0, 0.5, 0.8).unit(), [0.0, 16.0]);
            let mut painter = Painter::new();
            let mut floors = vec![];
            painter.draw(Level::best(), (&Scene::new(&town, Seed([1; 32])), &sun), &mut [(0, 0, 0)], |_, tile| {
                floors.extend(tile.expect("a tile").summary.iter().map(|square| square & 0xffff));
            });
            let surface = ((surface_m + LOWEST_M) * 16.0) as u32;
            for (row, texels) in (0..).zip(painter.packed.chunks(TILE).take(TILE)) {
                let share = |texel: u32| if texel >> 4 > surface { 0.25 + 0.125 * f64::from(texel & 6) } else { 0.0 };
                let dark: f64 = texels.iter().map(|texel| share(texel & 0xffff)).sum();
                let y = 0.1 * (f64::from(row) + 0.5) + 16.0 * 0.625;
                let x = edge_at.x - sin / cos * (y - edge_at.y);
                let exact = TILE as f64 + x / 0.1;
                let what = format!("{surface_m} m, row {row}: {dark} texels are dark, not {exact}");
                assert!((dark - exact).abs() < 0.2, "{what}");
            }
            // What lies under the low roof is dark throughout, under the edge, too.
            assert_eq!(floors.iter().any(|floor| *floor < surface - 2), surface_m < 1.0);
        }
    }

    #[test]
    fn tiles_join_to_rectangles_that_hold_each_of_them_once() {
        let mut places: Vec<TilePlace> = vec![(1, 5, 2), (0, 5, 3), (0, 5, 2), (0, 6, 2), (0, 6, 3), (0, 7, 2)];
        places.extend((0..9).map(|column| (2, -1, column)));
        let mut parts = vec![];
        join(&mut places, &mut parts);
        let mut held: Vec<TilePlace> = parts
            .iter()
            .flat_map(|&(grain, from, to)| {
                (from[1]..to[1]).flat_map(move |row| (from[0]..to[0]).map(move |column| (grain, row, column)))
            })
            .collect();
        held.sort_unstable();
        assert_eq!(held, places);
        assert!(parts.len() == 5 && parts.iter().all(|(_, from, to)| to[0] - from[0] <= WINDOW_TILES), "{parts:?}");
    }
}
