//! [`drape`]: streets of a level map on the ground of a town.

use super::clearance::Clearance;
use cosfly_domain::{SemanticLabel, SurfaceMesh, Town, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::GroundIndex;
use cosfly_town::open_ground::OpenGround;

/// Carriageways lie so far above the ground, which lies so far below them after, metres.
const ABOVE_M: f64 = 0.04;
const BELOW_M: f64 = 0.11;
/// Streets lie on the mean of the ground so far around, metres: pieces that overlap agree on rough ground, too.
const SMOOTH_M: f64 = 2.0;
/// Within its triangles, ground lies so far below streets, metres; where that is looked at, metres apart, at most so often along a side.
const WITHIN_M: f64 = 0.02;
const SAMPLE_M: f64 = 0.25;
const MOST_SAMPLES: f64 = 24.0;
/// Largest distance of the ground from a plaza, metres: less than `verify` takes for a body in the ground.
const MOST_BEND_M: f64 = 0.05;
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
        let around = [-1.0, -0.5, 0.0, 0.5, 1.0].into_iter();
        let around = around.clone().flat_map(|x| around.clone().map(move |y| at + SMOOTH_M * DVec2::new(x, y)));
        let (sum_m, count) = around
            .filter_map(|at| ground.ground_height_m(at.x, at.y))
            .fold((0.0, 0.0), |(sum_m, count), height_m| (sum_m + height_m, count + 1.0));
        *point = at.extend(point.z + ABOVE_M + sum_m / f64::max(count, 1.0));
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
    keep_plazas_beside(town, &streets.surfaces, &ground);
    town.surfaces.append(&mut streets.surfaces);
    town.walkable.append(&mut streets.walkable);
    town.lanes.append(&mut streets.lanes);
}

/// Lowers the ground under streets: each corner there, then each triangle that still comes up through a street, such as one with a
/// corner beside it.
fn lower_below(ground: &mut [SurfaceMesh], streets: &[SurfaceMesh]) {
    let above = GroundIndex::of_surfaces(streets, |_| true);
    for SurfaceMesh { vertices_in_world: points, triangles, .. } in ground {
        for point in points.iter_mut() {
            if let Some(street_m) = above.ground_height_m(point.x, point.y) {
                point.z = point.z.min(street_m - BELOW_M);
            }
        }
        for triangle in triangles.iter() {
            let [a, b, c] = triangle.map(|corner| points[corner as usize]);
            let (right, left) = (b - a, c - a);
            let longest_m = [right, left, c - b].map(|side| side.truncate().length()).into_iter().fold(0.0, f64::max);
            let steps = (longest_m / SAMPLE_M).ceil().clamp(1.0, MOST_SAMPLES);
            let shares = || (0..=steps as u32).map(|step| f64::from(step) / steps);
            let mut rise_m: f64 = 0.0;
            for (u, v) in shares().flat_map(|u| shares().map(move |v| (u, v))).filter(|(u, v)| u + v <= 1.0) {
                let at = a + u * right + v * left;
                let street_m = above.ground_height_m(at.x, at.y);
                rise_m = rise_m.max(street_m.map_or(0.0, |street_m| at.z - street_m + WITHIN_M));
            }
            triangle.iter().for_each(|corner| points[*corner as usize].z -= rise_m);
        }
    }
}

/// Lays invented plazas anew: beside the streets, and not on carriageways.
fn keep_plazas_beside(town: &mut Town, streets: &[SurfaceMesh], ground: &GroundIndex) {
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
    let height_m = |at: DVec2| ground.ground_height_m(at.x, at.y);
    let mut open = OpenGround::new(low, high, CELL_M);
    open.most_bend_m = MOST_BEND_M;
    let corners = [DVec2::ZERO, DVec2::ONE, -DVec2::ONE, DVec2::new(1.0, -1.0), DVec2::new(-1.0, 1.0)];
    open.is_open = (0..open.is_open.len())
        .map(|cell| {
            let middle = open.middle(cell);
            let mut around = corners.iter().map(|corner| middle + 0.5 * open.cell_m * *corner);
            from_streets.at_m(middle) <= REACH_M
                && plazas.ground_height_m(middle.x, middle.y).is_some()
                && around.all(|at| roads.ground_height_m(at.x, at.y).is_none())
        })
        .collect();
    town.walkable.retain(|polygon| !is_invented(polygon));
    town.walkable.extend(open.plazas(&height_m));
}
