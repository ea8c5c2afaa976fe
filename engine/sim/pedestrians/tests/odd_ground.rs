//! Odd ground: crossed, flat, doubled and steep polygons, things everywhere. Nothing panics, and every walk that
//! comes out keeps to the ground.

use cosfly_domain::{
    MapOrigin, Obstacle, ObstacleKind, OrientedBox, SimplificationReport, Synthetic, Town, WalkableKind,
    WalkablePolygon,
};
use cosfly_frames::{DVec3, RandomStream, Seed};
use cosfly_pedestrians::{PedestrianConfig, WalkableGrid, walk};

const KINDS: [WalkableKind; 5] =
    [WalkableKind::Sidewalk, WalkableKind::Crossing, WalkableKind::Shoulder, WalkableKind::Plaza, WalkableKind::Road];

fn point(stream: &mut RandomStream, size_m: f64, height_m: f64) -> DVec3 {
    let point = DVec3::new(stream.uniform(0.0, size_m), stream.uniform(0.0, size_m), stream.uniform(0.0, height_m));
    // Whole numbers now and then: corners that meet, edges along the axes and along cell borders.
    if stream.chance(0.4) { point.round() } else { point }
}

fn odd_town(stream: &mut RandomStream) -> Town {
    let height_m = if stream.chance(0.5) { 0.0 } else { 4.0 };
    let walkable = (0..1 + stream.index(6))
        .map(|_| {
            let mut outline_in_world: Vec<DVec3> =
                (0..stream.index(9)).map(|_| point(stream, 60.0, height_m)).collect();
            if stream.chance(0.3) {
                outline_in_world.extend(outline_in_world.first().copied());
            }
            WalkablePolygon { kind: KINDS[stream.index(KINDS.len())], outline_in_world, synthetic: true }
        })
        .collect();
    let obstacles = (0..stream.index(60))
        .map(|_| Obstacle {
            shape: OrientedBox {
                center_in_world: point(stream, 60.0, 3.0),
                half_extents_m: point(stream, 1.5, 2.0),
                yaw_rad: stream.uniform(-4.0, 4.0),
            },
            kind: ObstacleKind::Static,
            object_id: 1,
            synthetic: true,
        })
        .collect();
    Town {
        name: "odd".into(),
        origin: MapOrigin::default(),
        obstacles,
        planning_boxes: vec![],
        simplification: SimplificationReport::default(),
        lanes: vec![],
        walkable,
        surfaces: vec![],
        synthetic: Synthetic::default(),
        min_in_world: DVec3::ZERO,
        max_in_world: DVec3::splat(60.0),
    }
}

#[test]
fn odd_ground_gives_a_walk_on_it_or_an_error() {
    let mut stream = Seed::of_item(1, "odd", "ground").stream("towns");
    let (mut walked, mut refused) = (0, 0);
    for item in 0..300 {
        let town = odd_town(&mut stream);
        let config = PedestrianConfig {
            frames: 60,
            min_route_m: 5.0,
            grid_m: stream.uniform(0.2, 1.5),
            edge_distance_m: stream.uniform(0.0, 2.0),
            simplify_m: stream.uniform(0.0, 1.0),
            ..PedestrianConfig::default()
        };
        let path = WalkableGrid::build(&town, &config)
            .and_then(|grid| Ok((walk(&grid, &config, Seed::of_item(1, "odd", &format!("p{item}")))?, grid)));
        match path {
            Ok((path, grid)) => {
                walked += 1;
                assert_eq!(path.track.len(), 60);
                for (state, kind) in path.track.states.iter().zip(&path.ground) {
                    let feet = state.feet_in_world;
                    assert!(feet.is_finite() && state.heading_rad.is_finite() && state.speed_mps.is_finite());
                    // Where several levels overlap within a step's reach, either is the ground.
                    let ground = grid.ground().at(feet.truncate(), feet.z);
                    assert!(ground.is_some_and(|(_, z)| (z - feet.z).abs() <= 1.0), "town {item}: {kind:?} at {feet}");
                }
            }
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().is_empty() && !error.hint().is_empty());
            }
        }
    }
    assert!(walked > 150 && refused > 10, "{walked} walked, {refused} refused");
}

#[test]
fn ground_far_from_the_origin_and_flat_ground_do_no_harm() {
    let config = PedestrianConfig::default();
    let mut town = odd_town(&mut Seed::of_item(2, "odd", "far").stream("towns"));
    town.obstacles.clear();
    let corner = DVec3::new(5.0e6, -3.0e6, 900.0);
    let rectangle = |corner: DVec3, width_m: f64| {
        let corners = [(0.0, 0.0), (60.0, 0.0), (60.0, width_m), (0.0, width_m)];
        WalkablePolygon {
            kind: WalkableKind::Sidewalk,
            outline_in_world: corners.iter().map(|&(x, y)| corner + DVec3::new(x, y, 0.0)).collect(),
            synthetic: true,
        }
    };
    town.walkable = vec![rectangle(corner, 3.0)];
    let grid = WalkableGrid::build(&town, &config).unwrap();
    assert_eq!(walk(&grid, &config, Seed::of_item(1, "odd", "p0")).unwrap().track.len(), 200);
    town.walkable = vec![rectangle(DVec3::ZERO, 0.0)];
    assert!(WalkableGrid::build(&town, &config).is_err());
}
