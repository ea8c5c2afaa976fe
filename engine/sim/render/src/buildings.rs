//! Buildings of a town, as what hides other things from a point.

use cosfly_domain::{ObstacleKind, OrientedBox, Town};
use cosfly_frames::{DVec3, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_materials::measured::pieces::DEEPEST_M;

/// Length by which each face of a building is moved inwards, metres: nothing that is seen past an edge counts as hidden.
const EDGE_M: f64 = 0.1;

/// Buildings, a little smaller than they are, and without the highest step of a roof, whose slopes lie below it.
pub struct Buildings(BoxBvh);

impl Buildings {
    /// Buildings of `town`.
    pub fn of(town: &Town) -> Self {
        let buildings = town.obstacles.iter().filter(|obstacle| obstacle.kind == ObstacleKind::Building);
        let off_m = DVec3::new(EDGE_M, EDGE_M, EDGE_M + 0.5 * DEEPEST_M);
        let smaller = |shape: &OrientedBox| OrientedBox {
            center_in_world: shape.center_in_world - 0.5 * DEEPEST_M * DVec3::Z,
            half_extents_m: shape.half_extents_m - off_m,
            ..*shape
        };
        let boxes = buildings.map(|obstacle| smaller(&obstacle.shape));
        Self(BoxBvh::build(boxes.filter(|shape| shape.half_extents_m.min_element() > 0.0).collect()))
    }

    /// True where one building hides the convex hull of `corners_in_world` from an eye. The points behind a convex body are
    /// a convex set: a building that hides all corners hides the hull. Several buildings that hide it together do not
    /// count, and neither does a building that the eye is in.
    pub fn hide(&self, eye_in_world: DVec3, corners_in_world: &[DVec3]) -> bool {
        let middle_in_world = corners_in_world.iter().sum::<DVec3>() / corners_in_world.len().max(1) as f64;
        let way = middle_in_world - eye_in_world;
        let nearest = self.0.closest_hit(eye_in_world, way, 1.0);
        let farthest = || self.0.closest_hit(middle_in_world, -way, 1.0);
        let hides_all = |hit: cosfly_geometry::Hit| {
            let shape = &self.0.boxes()[hit.primitive as usize];
            !is_around(shape, eye_in_world)
                && corners_in_world.iter().all(|corner| is_between(shape, eye_in_world, *corner))
        };
        nearest.is_some_and(|hit| hides_all(hit) || farthest().is_some_and(hides_all))
    }
}

/// A vector from world axes to those of a box.
fn own_axes(shape: &OrientedBox, vector: DVec3) -> DVec3 {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    DVec3::new(cos * vector.x + sin * vector.y, cos * vector.y - sin * vector.x, vector.z)
}

/// True where a building of this box, in its full size, has the point within.
fn is_around(shape: &OrientedBox, point_in_world: DVec3) -> bool {
    let from = own_axes(shape, point_in_world - shape.center_in_world);
    from.abs().cmple(shape.half_extents_m + 2.0 * EDGE_M).all()
}

/// True where the way between two points meets a box.
fn is_between(shape: &OrientedBox, from_in_world: DVec3, to_in_world: DVec3) -> bool {
    let from = own_axes(shape, from_in_world - shape.center_in_world);
    let way = own_axes(shape, to_in_world - from_in_world);
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for axis in 0..3 {
        let (start, step, half) = (from[axis], way[axis], shape.half_extents_m[axis]);
        if step == 0.0 {
            if start.abs() > half {
                return false;
            }
            continue;
        }
        let (a, b) = ((-half - start) / step, (half - start) / step);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    enter <= leave
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_hides_what_lies_wholly_behind_it() {
        let wall = OrientedBox {
            center_in_world: DVec3::new(10.0, 0.0, 5.0),
            half_extents_m: DVec3::new(1.0, 8.0, 5.0),
            yaw_rad: 0.3,
        };
        let buildings = Buildings(BoxBvh::build(vec![wall]));
        let eye = DVec3::new(0.0, 0.0, 4.0);
        let hides = |x: f64, y: f64, z: f64| {
            let shape = OrientedBox::from_corners(DVec3::new(x, y, z), DVec3::new(x + 1.0, y + 1.0, z + 2.0));
            buildings.hide(eye, &shape.corners_in_world())
        };
        assert!(hides(20.0, 0.0, 0.0) && hides(20.0, -6.0, 6.0));
        // Before it, beside it, above it, half behind it.
        assert!(!hides(3.0, 0.0, 0.0) && !hides(20.0, 30.0, 0.0) && !hides(20.0, 0.0, 30.0) && !hides(20.0, 0.0, 17.0));
    }

    #[test]
    fn ways_and_boxes_meet_as_the_tree_says() {
        let shape = OrientedBox {
            center_in_world: DVec3::new(1.0, -2.0, 0.5),
            half_extents_m: DVec3::new(1.5, 0.5, 1.0),
            yaw_rad: 0.9,
        };
        let tree = BoxBvh::build(vec![shape]);
        let mut stream = cosfly_frames::Seed([4; 32]).stream("ways");
        let mut point = || DVec3::from_array(core::array::from_fn(|_| stream.uniform(-4.0, 4.0)));
        let mut met = 0;
        for _ in 0..2000 {
            let (from, to) = (point(), point());
            assert_eq!(is_between(&shape, from, to), tree.blocked(from, to), "{from} {to}");
            met += u32::from(is_between(&shape, from, to));
        }
        assert!((100..1500).contains(&met), "{met}");
    }
}
