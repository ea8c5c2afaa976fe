//! [`drape`]: streets of a level map on the ground of a town.

use super::clearance::Clearance;
use cosfly_domain::{SemanticLabel, SurfaceMesh, Town, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::open_ground::OpenGround;

/// Carriageways lie so far above the ground, which lies so far below them after, metres.
const ABOVE_M: f64 = 0.04;
const BELOW_M: f64 = 0.11;
/// Plazas reach so far from streets, metres: people walk there.
const REACH_M: f64 = 8.0;
/// Side of the cells in which plazas are laid, metres.
const CELL_M: f64 = 1.0;

/// Lays the streets of a town without relief onto the ground of another. Of invented plazas there, those beside the streets stay.
pub(super) fn drape(town: &mut Town, mut streets: Town) {
    streets.surfaces.retain(|mesh| mesh.label != SemanticLabel::Terrain);
    let ground = GroundIndex::of_surfaces(&town.surfaces, |_| true);
    let moved = streets.origin.offset_m.truncate();
    let lay = |point: &mut DVec3| {
        let at = point.truncate() + moved;
        *point = at.extend(point.z + ABOVE_M + ground.ground_height_m(at.x, at.y).unwrap_or(0.0));
    };
    for mesh in &mut streets.surfaces {
        mesh.synthetic = true;
        mesh.vertices_in_world.iter_mut().for_each(lay);
    }
    for polygon in &mut streets.walkable {
        polygon.synthetic = true;
        polygon.outline_in_world.iter_mut().for_each(lay);
    }
    streets.lanes.iter_mut().for_each(|lane| lane.middle_in_world.iter_mut().for_each(lay));
    lower_below(&mut town.surfaces, &streets.surfaces);
    keep_plazas_beside(town, &streets.surfaces);
    town.surfaces.append(&mut streets.surfaces);
    town.walkable.append(&mut streets.walkable);
    town.lanes.append(&mut streets.lanes);
}

/// Lowers the ground under streets.
fn lower_below(ground: &mut [SurfaceMesh], streets: &[SurfaceMesh]) {
    let above = GroundIndex::of_surfaces(streets, |_| true);
    for point in ground.iter_mut().flat_map(|mesh| &mut mesh.vertices_in_world) {
        if let Some(street_m) = above.ground_height_m(point.x, point.y) {
            point.z = point.z.min(street_m - BELOW_M);
        }
    }
}

/// Lays invented plazas anew: beside the streets, and not on carriageways.
fn keep_plazas_beside(town: &mut Town, streets: &[SurfaceMesh]) {
    let is_invented = |polygon: &WalkablePolygon| polygon.synthetic && polygon.kind == WalkableKind::Plaza;
    let mut plazas = SurfaceMesh {
        label: SemanticLabel::Ground,
        vertices_in_world: vec![],
        along_across_m: vec![],
        triangles: vec![],
        synthetic: true,
    };
    for plaza in town.walkable.iter().filter(|polygon| is_invented(polygon)) {
        let first = plazas.vertices_in_world.len() as u32;
        plazas.vertices_in_world.extend(&plaza.outline_in_world);
        let corners = cosfly_town::polygons::triangulated(&plaza.plan());
        plazas.triangles.extend(corners.into_iter().map(|triangle| triangle.map(|corner| first + corner)));
    }
    let corners = || streets.iter().flat_map(|mesh| &mesh.vertices_in_world).map(|point| point.truncate());
    let low = corners().fold(DVec2::INFINITY, DVec2::min) - REACH_M;
    let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max) + REACH_M;
    let plazas = GroundIndex::of_surfaces(&[plazas], |_| true);
    let from_streets = Clearance::of_meshes(streets, low, high, CELL_M);
    let roads = GroundIndex::of_surfaces(streets, |mesh| mesh.label == SemanticLabel::Roads);
    let height_m = |at: DVec2| plazas.ground_height_m(at.x, at.y);
    let mut open = OpenGround::new(low, high, CELL_M);
    let corners = [DVec2::ZERO, DVec2::ONE, -DVec2::ONE, DVec2::new(1.0, -1.0), DVec2::new(-1.0, 1.0)];
    open.is_open = (0..open.is_open.len())
        .map(|cell| {
            let middle = open.middle(cell);
            let mut around = corners.iter().map(|corner| middle + 0.5 * open.cell_m * *corner);
            from_streets.at_m(middle) <= REACH_M
                && height_m(middle).is_some()
                && around.all(|at| roads.ground_height_m(at.x, at.y).is_none())
        })
        .collect();
    town.walkable.retain(|polygon| !is_invented(polygon));
    town.walkable.extend(open.plazas(&height_m));
}
