//! The town of the sample: a plane with a wall.

use cosfly_domain::{MapOrigin, Obstacle, ObstacleKind, OrientedBox, SimplificationReport, Synthetic, Town};
use cosfly_frames::DVec3;

/// A plain with one wall, part of which hides the target in some frames.
pub fn town() -> Town {
    let wall = Obstacle {
        shape: OrientedBox {
            center_in_world: DVec3::new(-0.5, 0.75, 0.7),
            half_extents_m: DVec3::new(0.3, 0.6, 0.7),
            yaw_rad: 0.4,
        },
        kind: ObstacleKind::Wall,
        object_id: 4,
        synthetic: true,
    };
    Town {
        name: "plain".into(),
        origin: MapOrigin::default(),
        obstacles: vec![wall],
        planning_boxes: vec![],
        simplification: SimplificationReport::default(),
        walkable: vec![],
        surfaces: vec![],
        lanes: vec![],
        synthetic: Synthetic {
            buildings: true,
            trees: false,
            furniture: false,
            notes: vec!["one wall of a made-up plain".into()],
        },
        min_in_world: DVec3::splat(-100.0),
        max_in_world: DVec3::splat(100.0),
    }
}
