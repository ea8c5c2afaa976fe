//! The town's shadow map: tiles of several sizes of texels, drawn where a view first needs them and kept for all cameras of
//! the town under the same sun.
//!
//! A tile depends on the town, the sun and its own place alone, so pictures do not depend on who drew it or when.

use super::shadow_frame::Frame;
use super::shadow_region::Region;
use super::sun_tiles::{Sun, Tile, TilePlace};
use super::sunlight::{LEAVES, PACKED_ROWS, SOLID, SUMMARY_SIDE, TILE, Texels, WINDOW_TILES, measure_tile, pack_tile};
use crate::scene::Scene;
use crate::scene_mesh::SceneMesh;
use cosfly_domain::ObstacleKind;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3};
use cosfly_materials::parts::BOX_FACES;
use cosfly_raster::visibility::{PlaneOnScreen, Visibility};
use std::sync::Arc;

/// Posts thinner than this cast the shadow of a post this thick, half their width in texels: the map would tear them.
const LEAST_HALF_WIDTH_TEXELS: f64 = 0.65;

/// Draws tiles; one for each renderer.
pub(super) struct Painter {
    canvas: Visibility,
    packed: Box<[u32]>,
    /// Tiles from a first to before an end, by column and row.
    parts: Vec<(usize, [i32; 2], [i32; 2])>,
}

impl Painter {
    pub(super) fn new() -> Self {
        let side = WINDOW_TILES as usize * TILE + 1;
        Self {
            canvas: Visibility::new(side, side),
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
            let frame = Frame { corner, ..lattice };
            // Of the neighbours one row and column more.
            let size = [0, 1].map(|k| (end[k] - first[k]) as usize * TILE + 1);
            let anything = self.draw_part(scene, sun, &frame, Region { first: [0; 2], end: size });
            for row in first[1]..end[1] {
                for column in first[0]..end[0] {
                    let texel = [(column - first[0]) as usize * TILE, (row - first[1]) as usize * TILE];
                    let tile = if anything { self.tile(level, texel) } else { None };
                    take((grain, row, column), tile.as_ref());
                    scene.sun_maps.keep(sun, (grain, row, column), tile);
                }
            }
        }
    }

    /// The tile whose first texel is at a place of the canvas; none where nothing stands.
    fn tile(&mut self, level: Level, [column, row]: [usize; 2]) -> Option<Tile> {
        let (width, _) = self.canvas.size();
        let from = row * width + column;
        let (heights, classes) = (&self.canvas.inverse_depth[from..], &self.canvas.face[from..]);
        if !pack_tile(level, heights, classes, width, &mut self.packed) {
            return None;
        }
        let mut summary = [0; SUMMARY_SIDE * SUMMARY_SIDE];
        measure_tile(level, &self.packed, &mut summary);
        Some(Tile { texels: Arc::new(Texels::of(&self.packed)), summary: Arc::new(summary) })
    }

    /// Draws everything that throws shadows into a part of the canvas; whether there is anything.
    fn draw_part(&mut self, scene: &Scene, sun: &Sun, frame: &Frame, part: Region) -> bool {
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
    fn draw_mesh(&mut self, own: &SceneMesh, frame: &Frame, to_sun: DVec3, part: Region) -> bool {
        let mut anything = false;
        for cluster in &own.clusters {
            if frame.misses(&part, cluster.center_in_world, cluster.half_bounds_m) {
                continue;
            }
            anything = true;
            for triangle in &own.mesh.triangles[cluster.triangles.clone()] {
                let corners = triangle.corners();
                let [a, b, c] = corners;
                let normal = (b - a).cross(c - a).normalize_or_zero();
                let facing = normal.dot(to_sun);
                if facing.abs() > 1e-6 {
                    let is_cut = own.mesh.materials[triangle.material as usize].least_alpha.is_some();
                    let class = if is_cut { LEAVES } else { SOLID };
                    draw(&mut self.canvas, (frame, part), to_sun, normal * facing.signum(), &corners, class);
                }
            }
        }
        anything
    }

    /// Both sides of a model's triangles throw shadows.
    fn draw_props(&mut self, scene: &Scene, frame: &Frame, to_sun: DVec3, part: Region) -> bool {
        let mut anything = false;
        for prop in &scene.props.props {
            if frame.misses(&part, prop.center_in_world, prop.half_bounds_m) {
                continue;
            }
            anything = true;
            let class = if prop.is_leafy { LEAVES } else { SOLID };
            for triangle in &scene.props.triangles[prop.triangles.clone()] {
                let facing = triangle.normal_in_world.dot(to_sun);
                if facing.abs() > 1e-6 {
                    let normal = triangle.normal_in_world * facing.signum();
                    draw(&mut self.canvas, (frame, part), to_sun, normal, &triangle.corners_in_world, class);
                }
            }
        }
        anything
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

/// Draws a face that the sun shines on, where a part of the map needs it: its height is affine over the sheared ground.
pub(super) fn draw(
    map: &mut Visibility,
    (frame, part): (&Frame, Region),
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
    use super::*;

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
