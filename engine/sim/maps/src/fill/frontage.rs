//! Fronts: where a pavement borders open land.

use super::land::{Land, Plot, Use};
use crate::{Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3, real};

/// A piece of a pavement's edge with open land behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Front {
    /// Where it begins, on the edge.
    pub start_in_world: DVec3,
    /// Where it ends.
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

/// All fronts, in the order of the walkable polygons.
pub fn fronts(town: &Town, land: &Land) -> Vec<Front> {
    let mut fronts = Vec::new();
    // Far enough that the edge's own pavement does not count: its marks reach one cell's diagonal beyond it.
    let probe_m = 1.5 * land.cell_m() + 0.1;
    for area in &town.walkable {
        if !matches!(area.kind, WalkableKind::Sidewalk | WalkableKind::Shoulder | WalkableKind::Plaza) {
            continue;
        }
        let outline = &area.outline_in_world;
        let next = |index: usize| outline[(index + 1) % outline.len()];
        let twice_area: f64 = (0..outline.len()).map(|i| outline[i].truncate().perp_dot(next(i).truncate())).sum();
        for (index, &start_in_world) in outline.iter().enumerate() {
            let end_in_world = next(index);
            let step = (end_in_world - start_in_world).truncate();
            let Some(along) = step.try_normalize() else { continue };
            let away = if twice_area > 0.0 { -along.perp() } else { along.perp() };
            let middle = start_in_world.lerp(end_in_world, 0.5).truncate() + probe_m * away;
            let probe = Plot { center: middle, half_m: DVec2::splat(0.05), yaw_rad: 0.0 };
            if step.length() > 0.5 && land.is_free(&probe.corners(0.0), Use::Street) {
                fronts.push(Front { start_in_world, end_in_world, away });
            }
        }
    }
    fronts
}
