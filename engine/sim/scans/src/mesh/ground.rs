//! The ground of a scene: surfaces with labels, the relief under everything, walkable pavements.

use super::names::Thing;
use super::parts::Part;
use super::solid::height_at;
use super::uncovered::{Uncovered, uncovered};
use crate::grid::Grid;
use crate::relief::Relief;
use cosfly_domain::{SemanticLabel, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::mesh::MeshBuilder;

/// Cells of the relief, metres, and most of them.
const CELL_M: f64 = 1.0;
const MOST_CELLS: f64 = 4e6;
/// Ground that is invented around a scene without any, metres.
const MARGIN_M: f64 = 30.0;
/// Triangles steeper than this are faces of kerbs: the share of their normal that points up.
const STEEPEST: f64 = 0.5;
/// Smallest triangle to walk on, square metres.
const SMALLEST_M2: f64 = 1e-3;
/// Most walkable polygons.
const MOST_POLYGONS: usize = 200_000;

/// Adds a part as ground.
pub fn add_surface(meshes: &mut MeshBuilder, label: SemanticLabel, part: &Part) {
    let vertices: Vec<(DVec3, DVec2)> = part.vertices.iter().map(|vertex| (*vertex, vertex.truncate())).collect();
    meshes.polygon(label, false, &vertices, &part.triangles);
}

/// Whether one can stand on a triangle.
pub fn is_level([a, b, c]: &[DVec3; 3]) -> bool {
    let normal = (*b - *a).cross(*c - *a);
    normal.z.abs() > STEEPEST * normal.length() && 0.5 * normal.z.abs() > SMALLEST_M2
}

/// Triangles of the ground that one can stand on.
fn level_triangles(things: &[Thing]) -> impl Iterator<Item = [DVec3; 3]> {
    let ground = things.iter().filter(|thing| thing.kind.is_ground()).flat_map(|thing| &thing.parts);
    ground.flat_map(|part| part.triangles.iter().map(|triangle| part.corners(*triangle))).filter(is_level)
}

/// Height of the highest ground on a grid; a level square at the lowest point where the scene has no ground.
pub fn relief(things: &[Thing], low: DVec3, high: DVec3, notes: &mut Vec<String>) -> Relief {
    let size = (high - low).truncate() + 2.0 * MARGIN_M;
    let cell_m = CELL_M.max((size.element_product() / MOST_CELLS).sqrt());
    let grid = Grid::around([low.truncate() - MARGIN_M, high.truncate() + MARGIN_M].into_iter(), cell_m, 0.0);
    let mut heights_m = vec![f32::NAN; grid.cells()];
    for triangle in level_triangles(things) {
        let plan = triangle.map(|corner| grid.in_cells(corner.truncate()));
        let from = plan.iter().copied().fold(DVec2::INFINITY, DVec2::min).floor().max(DVec2::ZERO);
        let to = plan.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        for row in from.y as usize..(to.y as usize + 1).min(grid.rows) {
            for column in from.x as usize..(to.x as usize + 1).min(grid.columns) {
                let cell = row * grid.columns + column;
                if let Some(height_m) = height_at(&triangle, grid.center(cell)) {
                    heights_m[cell] = heights_m[cell].max(height_m as f32);
                }
            }
        }
    }
    if heights_m.iter().all(|height| height.is_nan()) {
        notes.push("the ground is invented, level with the lowest point: the scene has none".to_owned());
        heights_m.fill(low.z as f32);
    }
    Relief::new(grid, heights_m)
}

/// Pavements as walkable polygons, seen from above: what lies under other ground is left out.
pub fn walkable(things: &[Thing], notes: &mut Vec<String>) -> Vec<WalkablePolygon> {
    let Uncovered { outlines, lost_m2, unchecked } = uncovered(things);
    if lost_m2 > 1.0 {
        notes.push(format!(
            "{lost_m2:.0} m2 of pavements lie under other ground, or without headroom below it: nobody walks there"
        ));
    }
    if unchecked > 0 {
        notes.push(format!(
            "{unchecked} faces of pavements may lie under others: there are too many to compare; simplify their meshes"
        ));
    }
    if outlines.len() > MOST_POLYGONS {
        notes.push(format!(
            "of {} faces to walk on, {MOST_POLYGONS} are read: simplify the meshes of the pavements",
            outlines.len()
        ));
    }
    let polygon =
        |outline_in_world| WalkablePolygon { kind: WalkableKind::Sidewalk, outline_in_world, synthetic: false };
    outlines.into_iter().take(MOST_POLYGONS).map(polygon).collect()
}
