//! Where the flat roof of a building that is made of several boxes goes on from box to box: no parapet stands there.

use crate::parts::{BOX_FACES, SceneBox};
use cosfly_domain::ObstacleKind;
use cosfly_frames::DVec2;
use std::collections::BTreeMap;

/// Places beside a side that are looked at, as shares of its length.
const PLACES: [f64; 5] = [0.05, 0.275, 0.5, 0.725, 0.95];
/// Places that must be covered for the roof to go on.
const COVERED: usize = 3;
/// Distance of the places from the side, metres: strips that follow a slanted wall overlap, or leave cracks.
const BESIDE_M: f64 = 0.3;
/// Roofs whose heights differ by less are one, metres.
const ONE_HEIGHT_M: f64 = 0.1;

/// For each box the sides on which its roof goes on.
pub fn roofs_that_go_on(boxes: &[SceneBox]) -> Vec<[bool; 4]> {
    let mut buildings: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (index, b) in boxes.iter().enumerate().filter(|(_, b)| b.kind == ObstacleKind::Building) {
        buildings.entry(b.instance).or_default().push(index);
    }
    let mut sides = vec![[false; 4]; boxes.len()];
    for members in buildings.values().filter(|members| members.len() > 1) {
        // Along x, so that only neighbours are compared.
        let reach_m = |index: usize| boxes[index].half_bounds_m.x + BESIDE_M;
        let low = |index: &usize| boxes[*index].center_in_world.x - reach_m(*index);
        let mut members = members.clone();
        members.sort_by(|a, b| low(a).total_cmp(&low(b)).then(a.cmp(b)));
        for (place, &index) in members.iter().enumerate() {
            let high = boxes[index].center_in_world.x + reach_m(index);
            for &other in members[place + 1..].iter().take_while(|other| low(other) <= high) {
                join(&boxes[index], &boxes[other], &mut sides[index]);
                join(&boxes[other], &boxes[index], &mut sides[other]);
            }
        }
    }
    sides
}

/// Marks the sides of the roof of `b` beside which `other` is as high or higher.
fn join(b: &SceneBox, other: &SceneBox, sides: &mut [bool; 4]) {
    let top_m = b.center_in_world.z + f64::from(b.half_extents_m.z);
    let [foot_m, other_top_m] =
        [-1.0, 1.0].map(|end| other.center_in_world.z + end * f64::from(other.half_extents_m.z));
    if other_top_m < top_m - ONE_HEIGHT_M || foot_m >= top_m {
        return;
    }
    let half = b.half_extents_m.truncate().as_dvec2();
    let axes = b.axes_in_world.map(|axis| axis.truncate());
    for (side, goes_on) in sides.iter_mut().enumerate() {
        let (axis, sign, _) = BOX_FACES[side];
        let along = 1 - axis;
        let out = axes[axis] * (sign * (half[axis] + BESIDE_M));
        let is_covered = |share: &&f64| {
            let place = b.center_in_world.truncate() + out + axes[along] * (half[along] * (2.0 * **share - 1.0));
            contains(other, place)
        };
        *goes_on |= PLACES.iter().filter(is_covered).count() >= COVERED;
    }
}

fn contains(b: &SceneBox, place: DVec2) -> bool {
    let away = place - b.center_in_world.truncate();
    let [x, y] = b.axes_in_world.map(|axis| away.dot(axis.truncate()).abs());
    x <= f64::from(b.half_extents_m.x) && y <= f64::from(b.half_extents_m.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::boxes_of;
    use cosfly_domain::{Obstacle, OrientedBox, Town};
    use cosfly_frames::DVec3;

    /// Boxes of one building: middle, half size.
    fn sides_of(parts: &[([f64; 3], [f64; 3])]) -> Vec<[bool; 4]> {
        let obstacle = |(center, half): &([f64; 3], [f64; 3])| Obstacle {
            shape: OrientedBox {
                center_in_world: DVec3::from_array(*center),
                half_extents_m: DVec3::from_array(*half),
                yaw_rad: 0.0,
            },
            kind: ObstacleKind::Building,
            object_id: 1,
            synthetic: false,
        };
        let town = Town { obstacles: parts.iter().map(obstacle).collect(), ..Town::default() };
        roofs_that_go_on(&boxes_of(&town, 1))
    }

    #[test]
    fn a_roof_goes_on_over_strips_of_one_height_and_ends_at_a_higher_wall() {
        let strips = sides_of(&[
            ([0.0, 0.0, 5.0], [5.0, 10.0, 5.0]),
            ([10.0, 0.0, 5.0], [5.0, 10.0, 5.0]),
            ([20.0, 0.0, 8.0], [5.0, 10.0, 8.0]),
        ]);
        assert_eq!(strips, [[false, true, false, false], [true, true, false, false], [false; 4]]);
    }

    #[test]
    fn a_roof_ends_where_less_than_half_of_a_side_has_a_neighbour() {
        let wings = sides_of(&[([0.0, 0.0, 5.0], [5.0, 10.0, 5.0]), ([10.0, -8.0, 5.0], [5.0, 2.0, 5.0])]);
        assert_eq!(wings, [[false; 4], [true, false, false, false]]);
    }
}
