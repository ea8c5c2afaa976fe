//! Facades: the sides of a building, and how much of them a flight has seen.

use super::Site;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, Pose, real};

/// Side of a facade's cells, metres.
const CELL_M: f64 = 2.0;
/// A cell counts as seen from no further than this many stand-off distances.
const SEEN_WITHIN: f64 = 2.0;
/// A cell counts as seen up to this angle off its normal, degrees.
const STEEPEST_DEG: f64 = 65.0;
/// A cell counts as seen when it is no further than this from the middle of the picture, degrees.
const HALF_VIEW_DEG: f64 = 28.0;
/// Walls with something else this near are inside, metres.
const PARTY_WALL_M: f64 = 0.6;

/// One upright side of a box.
#[derive(Clone, Copy, Debug)]
pub struct FacadeSide {
    /// Lower corner of the wall, from which `along` leads to the other one.
    pub corner_in_world: DVec3,
    /// Unit vector along it, horizontal.
    pub along: DVec2,
    /// Unit vector away from the box, horizontal.
    pub normal: DVec2,
    /// Metres.
    pub length_m: f64,
    /// Metres.
    pub height_m: f64,
}

impl FacadeSide {
    /// The point `along_m` from the corner at `z_m`, `out_m` in front of it.
    pub fn point(&self, along_m: f64, z_m: f64, out_m: f64) -> DVec3 {
        (self.corner_in_world.truncate() + along_m * self.along + out_m * self.normal).extend(z_m)
    }
}

/// The four sides of a box, each beginning where the one before ends.
pub fn sides(shape: &OrientedBox) -> [FacadeSide; 4] {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let (ux, uy) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
    let (half, low) = (shape.half_extents_m, shape.center_in_world.z - shape.half_extents_m.z);
    let center = shape.center_in_world.truncate();
    let side = |normal: DVec2, along: DVec2, out: f64, reach: f64| FacadeSide {
        corner_in_world: (center + out * normal - reach * along).extend(low),
        along,
        normal,
        length_m: 2.0 * reach,
        height_m: 2.0 * half.z,
    };
    [
        side(ux, uy, half.x, half.y),
        side(uy, -ux, half.y, half.x),
        side(-ux, -uy, half.x, half.y),
        side(-uy, ux, half.y, half.x),
    ]
}

/// The smallest box with the yaw of the largest member around all boxes of a building; `None` of no box.
pub fn hull(boxes: &[OrientedBox]) -> Option<OrientedBox> {
    let volume = |shape: &OrientedBox| shape.half_extents_m.x * shape.half_extents_m.y * shape.half_extents_m.z;
    let yaw_rad = boxes.iter().max_by(|a, b| volume(a).total_cmp(&volume(b)))?.yaw_rad;
    let (sin, cos) = real::sin_cos(yaw_rad);
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for corner in boxes.iter().flat_map(OrientedBox::corners_in_world) {
        let own = DVec3::new(cos * corner.x + sin * corner.y, cos * corner.y - sin * corner.x, corner.z);
        (low, high) = (low.min(own), high.max(own));
    }
    let middle = 0.5 * (low + high);
    let center = DVec3::new(cos * middle.x - sin * middle.y, sin * middle.x + cos * middle.y, middle.z);
    Some(OrientedBox { center_in_world: center, half_extents_m: 0.5 * (high - low), yaw_rad })
}

/// Part of a building's outer walls that a flight has seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FacadeCoverage {
    /// Cells seen for the first time, per frame.
    pub new_cells: Vec<usize>,
    /// All cells in the open.
    pub cells: usize,
}

impl FacadeCoverage {
    /// Share of the cells seen at least once, 0..=1; 0 without cells.
    pub fn share(&self) -> f64 {
        self.new_cells.iter().sum::<usize>() as f64 / self.cells.max(1) as f64
    }

    /// Share of the cells seen for the first time, per frame.
    pub fn gained(&self) -> Vec<f64> {
        self.new_cells.iter().map(|new| *new as f64 / self.cells.max(1) as f64).collect()
    }
}

/// Share of a building's walls that the camera saw: cells of 2 m whose middle was in a picture's middle part (28 degrees
/// off the axis), nothing between, from within twice `standoff_m`, at 65 degrees off the wall's normal at most.
pub fn coverage(site: &Site<'_>, boxes: &[OrientedBox], poses: &[Pose], standoff_m: f64) -> FacadeCoverage {
    let cells = cells(site, boxes);
    let axes: Vec<DVec3> = poses.iter().map(|pose| pose.world_from_body() * DVec3::X).collect();
    let (steepest, view) = (real::cos(STEEPEST_DEG.to_radians()), real::cos(HALF_VIEW_DEG.to_radians()));
    let sees = |pose: &Pose, axis: DVec3, cell: DVec3, normal: DVec3| {
        let sight = cell - pose.position_in_world;
        let distance_m = sight.length();
        distance_m <= SEEN_WITHIN * standoff_m
            && -sight.dot(normal) >= steepest * distance_m
            && sight.dot(axis) >= view * distance_m
            && !site.exact.blocked(pose.position_in_world, cell)
    };
    let mut new_cells = vec![0; poses.len()];
    for &(cell, normal) in &cells {
        if let Some(frame) = poses.iter().zip(&axes).position(|(pose, &axis)| sees(pose, axis, cell, normal)) {
            new_cells[frame] += 1;
        }
    }
    FacadeCoverage { new_cells, cells: cells.len() }
}

/// Middles of the cells of all walls in the open, just in front of them, and the walls' normals.
fn cells(site: &Site<'_>, boxes: &[OrientedBox]) -> Vec<(DVec3, DVec3)> {
    let mut cells = Vec::new();
    for side in boxes.iter().flat_map(sides) {
        let top = side.corner_in_world.z + side.height_m;
        let columns = (side.length_m / CELL_M).ceil().max(1.0);
        for column in 0..columns as usize {
            let along = side.length_m * (column as f64 + 0.5) / columns;
            let foot = side.point(along, 0.0, PARTY_WALL_M);
            let ground = (site.ground)(foot.x, foot.y);
            let low = if ground.is_finite() { ground.max(side.corner_in_world.z) } else { side.corner_in_world.z };
            let rows = ((top - low) / CELL_M).ceil().max(0.0);
            for row in 0..rows as usize {
                let z = low + (top - low) * (row as f64 + 0.5) / rows;
                if site.exact.nearest(side.point(along, z, PARTY_WALL_M), 0.5 * PARTY_WALL_M).is_none() {
                    cells.push((side.point(along, z, 0.02), side.normal.extend(0.0)));
                }
            }
        }
    }
    cells
}

/// Whether a drone may stand where a wall is looked at from: clear of everything and above ground.
pub fn is_free(site: &Site<'_>, place: DVec3, clearance_m: f64) -> bool {
    let ground = (site.ground)(place.x, place.y);
    let is_above = !ground.is_finite() || place.z - ground >= clearance_m;
    is_above && site.exact.nearest(place, clearance_m).is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_go_round_the_box_and_look_away_from_it() {
        let shape = OrientedBox {
            center_in_world: DVec3::new(5.0, -3.0, 4.0),
            half_extents_m: DVec3::new(6.0, 2.0, 4.0),
            yaw_rad: 0.7,
        };
        let sides = sides(&shape);
        for (k, side) in sides.iter().enumerate() {
            let end = side.point(side.length_m, side.corner_in_world.z, 0.0);
            assert!((end - sides[(k + 1) % 4].corner_in_world).length() < 1e-9);
            let middle = side.point(0.5 * side.length_m, 4.0, 1.0);
            let out = middle.distance(shape.center_in_world);
            assert!(out > side.point(0.5 * side.length_m, 4.0, 0.0).distance(shape.center_in_world));
        }
        assert_eq!(hull(&[]), None);
        let around = hull(&[shape]).expect("a box");
        assert!((around.center_in_world - shape.center_in_world).length() < 1e-9);
        assert!((around.half_extents_m - shape.half_extents_m).length() < 1e-9);
    }
}
