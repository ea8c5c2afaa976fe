//! A tree's crown as nested boxes, differently high, wide and turned: narrow at its foot and top, wide in the middle.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, Seed, real};

/// One box of a crown, in shares of the crown's half width and height; the turn is from the layer before, radians.
struct Layer {
    half_width: f64,
    bottom: f64,
    top: f64,
    turn_rad: f64,
}

/// From the slender core to the wide girdle. The core spans the whole height, so that the crown sits on its trunk.
const LAYERS: [Layer; 4] = [
    Layer { half_width: 0.50, bottom: 0.00, top: 1.00, turn_rad: 0.0 },
    Layer { half_width: 0.68, bottom: 0.08, top: 0.90, turn_rad: 0.55 },
    Layer { half_width: 0.76, bottom: 0.19, top: 0.78, turn_rad: 0.70 },
    Layer { half_width: 0.86, bottom: 0.30, top: 0.64, turn_rad: 0.65 },
];

/// Boxes of the crown that fills `space`, all inside it, with the same foot and top; `tree` draws their shapes.
pub fn crown_boxes(space: &OrientedBox, tree: u32) -> [OrientedBox; LAYERS.len()] {
    let mut stream = Seed([0; 32]).child("tree crown", u64::from(tree)).stream("layers");
    let half = space.half_extents_m;
    let foot_m = space.center_in_world.z - half.z;
    let mut turn_rad = stream.uniform(-0.4, 0.4);
    LAYERS.each_ref().map(|layer| {
        turn_rad += layer.turn_rad * stream.uniform(0.8, 1.2);
        let (sin, cos) = real::sin_cos(turn_rad);
        let longer = stream.uniform(0.94, 1.06);
        // A turned box reaches out to its corners: it is no wider than fits beside its offset.
        let offset = 0.05 * DVec3::new(stream.uniform(-1.0, 1.0), stream.uniform(-1.0, 1.0), 0.0);
        let widest = (1.0 - offset.abs().max_element()) / (sin.abs() + cos.abs()) / 1.06;
        let width = (layer.half_width * stream.uniform(0.95, 1.05)).min(widest) * half.truncate().min_element();
        let shift = |share: f64, by: f64| if share > 0.0 && share < 1.0 { share + by } else { share };
        let (bottom, top) =
            (shift(layer.bottom, stream.uniform(-0.03, 0.03)), shift(layer.top, stream.uniform(-0.04, 0.04)));
        let (sin_space, cos_space) = real::sin_cos(space.yaw_rad);
        let aside = offset * half;
        let turned =
            DVec3::new(cos_space * aside.x - sin_space * aside.y, sin_space * aside.x + cos_space * aside.y, 0.0);
        OrientedBox {
            center_in_world: (space.center_in_world + turned).with_z(foot_m + (bottom + top) * half.z),
            half_extents_m: DVec3::new(width * longer, width / longer, (top - bottom) * half.z),
            yaw_rad: space.yaw_rad + turn_rad,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space() -> OrientedBox {
        OrientedBox {
            center_in_world: DVec3::new(30.0, -8.0, 6.0),
            half_extents_m: DVec3::new(2.4, 2.4, 2.5),
            yaw_rad: 0.7,
        }
    }

    #[test]
    fn a_crown_keeps_the_foot_and_top_of_its_space_and_stays_inside() {
        let space = space();
        let (sin, cos) = real::sin_cos(space.yaw_rad);
        for tree in 0..500 {
            let boxes = crown_boxes(&space, tree);
            for corner in boxes.iter().flat_map(OrientedBox::corners_in_world) {
                let away = corner - space.center_in_world;
                let local = DVec3::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z);
                assert!((local.abs() - space.half_extents_m).max_element() < 1e-9, "tree {tree}: {local}");
            }
            assert_eq!(boxes[0].half_extents_m.z, space.half_extents_m.z);
        }
    }

    #[test]
    fn a_crown_is_widest_in_the_middle_and_no_two_trees_are_alike() {
        for tree in 0..500 {
            let boxes = crown_boxes(&space(), tree);
            for pair in boxes.windows(2) {
                assert!(pair[0].half_extents_m.z > pair[1].half_extents_m.z);
                assert!(pair[0].half_extents_m.element_product() > 0.0);
            }
            let wide = |one: &OrientedBox| one.half_extents_m.x * one.half_extents_m.y;
            assert!(wide(&boxes[0]) < 0.7 * wide(&boxes[3]));
            assert_eq!(boxes, crown_boxes(&space(), tree));
            assert_ne!(boxes, crown_boxes(&space(), tree + 1));
        }
    }
}
