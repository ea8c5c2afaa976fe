//! Fronts: where a pavement, or a road near one, borders open land.

use super::land::{Land, Plot, Use};
use cosfly_domain::{SemanticLabel, Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3, real};
use std::collections::BTreeSet;

/// Distance to walkable ground within which a road counts as part of the town, metres (up to twice as far).
const NEAR_M: f64 = 32.0;

/// A piece of a street's edge with open land behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Front {
    /// First point, on the edge.
    pub start_in_world: DVec3,
    /// Last point, on the edge.
    pub end_in_world: DVec3,
    /// Unit vector away from the street, seen from above.
    pub away: DVec2,
}

impl Front {
    /// The point `along_m` from the start.
    pub fn at(&self, along_m: f64) -> DVec3 {
        self.start_in_world.lerp(self.end_in_world, (along_m / self.length_m()).clamp(0.0, 1.0))
    }

    /// Length seen from above, metres.
    pub fn length_m(&self) -> f64 {
        (self.end_in_world - self.start_in_world).truncate().length()
    }

    /// Direction of the edge, radians.
    pub fn yaw_rad(&self) -> f64 {
        let step = self.end_in_world - self.start_in_world;
        real::atan2(step.y, step.x)
    }
}

/// Fronts of pavements, in the order of the walkable polygons.
pub fn pavement_fronts(town: &Town, land: &Land) -> Vec<Front> {
    let mut fronts = Vec::new();
    for area in &town.walkable {
        if !matches!(area.kind, WalkableKind::Sidewalk | WalkableKind::Shoulder | WalkableKind::Plaza) {
            continue;
        }
        let outline = &area.outline_in_world;
        let next = |index: usize| outline[(index + 1) % outline.len()];
        let twice_area: f64 = (0..outline.len()).map(|i| outline[i].truncate().perp_dot(next(i).truncate())).sum();
        for (index, &start_in_world) in outline.iter().enumerate() {
            let end_in_world = next(index);
            let Some(along) = (end_in_world - start_in_world).truncate().try_normalize() else { continue };
            let away = if twice_area > 0.0 { -along.perp() } else { along.perp() };
            let front = Front { start_in_world, end_in_world, away };
            if is_open(land, &front) {
                fronts.push(front);
            }
        }
    }
    fronts
}

/// Fronts of roads near walkable ground: edges of their surface's triangles with open land on the other side.
pub fn road_fronts(town: &Town, land: &Land) -> Vec<Front> {
    let cell = |at: DVec3| ((at.x / NEAR_M).floor() as i64, (at.y / NEAR_M).floor() as i64);
    let walkable: BTreeSet<(i64, i64)> =
        town.walkable.iter().flat_map(|area| &area.outline_in_world).map(|corner| cell(*corner)).collect();
    let is_near = |at: DVec3| {
        let (column, row) = cell(at);
        (-1..=1).any(|x| (-1..=1).any(|y| walkable.contains(&(column + x, row + y))))
    };
    let mut fronts = Vec::new();
    for mesh in town.surfaces.iter().filter(|mesh| mesh.label == SemanticLabel::Roads) {
        for triangle in &mesh.triangles {
            let corners = triangle.map(|corner| mesh.vertices_in_world[corner as usize]);
            for index in 0..3 {
                let [start_in_world, end_in_world, inner] = [0, 1, 2].map(|step| corners[(index + step) % 3]);
                let Some(along) = (end_in_world - start_in_world).truncate().try_normalize() else { continue };
                let is_left = along.perp_dot((inner - start_in_world).truncate()) > 0.0;
                let away = if is_left { -along.perp() } else { along.perp() };
                let front = Front { start_in_world, end_in_world, away };
                if is_near(front.at(0.5 * front.length_m())) && is_open(land, &front) {
                    fronts.push(front);
                }
            }
        }
    }
    fronts
}

/// Whether there is open land beyond the middle of the front.
fn is_open(land: &Land, front: &Front) -> bool {
    // Far enough that the edge's own street does not count: its marks reach one cell's diagonal beyond it.
    let probe_m = 1.5 * land.cell_m() + 0.1;
    let middle = front.at(0.5 * front.length_m()).truncate() + probe_m * front.away;
    let probe = Plot { center: middle, half_m: DVec2::splat(0.05), yaw_rad: 0.0 };
    front.length_m() > 0.5 && land.is_free(&probe.corners(0.0), Use::Street)
}
