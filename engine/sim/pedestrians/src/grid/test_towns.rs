//! Small towns for the tests of this crate.

use cosfly_domain::{
    MapOrigin, Obstacle, ObstacleKind, OrientedBox, SimplificationReport, Synthetic, Town, WalkableKind,
    WalkablePolygon,
};
use cosfly_frames::DVec3;

/// A level rectangle of ground between two corners.
pub(crate) fn rectangle(kind: WalkableKind, min: (f64, f64), max: (f64, f64), z: f64) -> WalkablePolygon {
    let corners = [(min.0, min.1), (max.0, min.1), (max.0, max.1), (min.0, max.1)];
    let outline_in_world = corners.iter().map(|&(x, y)| DVec3::new(x, y, z)).collect();
    WalkablePolygon { kind, outline_in_world, synthetic: true }
}

/// A square post standing on z = 0.
pub(crate) fn pillar(center: (f64, f64), half_m: f64, height_m: f64) -> Obstacle {
    let shape = OrientedBox {
        center_in_world: DVec3::new(center.0, center.1, 0.5 * height_m),
        half_extents_m: DVec3::new(half_m, half_m, 0.5 * height_m),
        yaw_rad: 0.0,
    };
    Obstacle { shape, kind: ObstacleKind::Pole, object_id: 1, synthetic: true }
}

/// A town of this ground and these things, without surfaces.
pub(crate) fn town(walkable: Vec<WalkablePolygon>, obstacles: Vec<Obstacle>) -> Town {
    Town {
        name: "test".into(),
        origin: MapOrigin::default(),
        obstacles,
        planning_boxes: vec![],
        simplification: SimplificationReport::default(),
        lanes: vec![],
        walkable,
        surfaces: vec![],
        synthetic: Synthetic::default(),
        min_in_world: DVec3::ZERO,
        max_in_world: DVec3::ZERO,
    }
}

/// Three by three blocks of 40 m: pavements of 2.5 m round each block, crossings of 8 m between neighbours,
/// a house on each block and posts along the kerbs.
pub(crate) fn streets() -> Town {
    let (mut walkable, mut obstacles) = (vec![], vec![]);
    let (block, street, width) = (40.0, 8.0, 2.5);
    for row in 0..3 {
        for column in 0..3 {
            let (x, y) = (f64::from(column) * (block + street), f64::from(row) * (block + street));
            let sidewalk = WalkableKind::Sidewalk;
            walkable.push(rectangle(sidewalk, (x, y), (x + block, y + width), 0.0));
            walkable.push(rectangle(sidewalk, (x, y + block - width), (x + block, y + block), 0.0));
            walkable.push(rectangle(sidewalk, (x, y + width), (x + width, y + block - width), 0.0));
            walkable.push(rectangle(sidewalk, (x + block - width, y + width), (x + block, y + block - width), 0.0));
            let crossing = WalkableKind::Crossing;
            if column < 2 {
                walkable.push(rectangle(crossing, (x + block, y + 3.0), (x + block + street, y + 6.0), 0.0));
            }
            if row < 2 {
                walkable.push(rectangle(crossing, (x + 3.0, y + block), (x + 6.0, y + block + street), 0.0));
            }
            let mut house = pillar((x + 0.5 * block, y + 0.5 * block), 0.5 * block - width - 0.1, 12.0);
            house.kind = ObstacleKind::Building;
            obstacles.push(house);
            obstacles.extend((1..8).map(|i| pillar((x + 5.0 * f64::from(i), y + 0.4), 0.12, 5.0)));
        }
    }
    town(walkable, obstacles)
}
