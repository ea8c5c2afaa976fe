//! The obstacles near a flight and the target as coloured cubes, and the captions as log lines.

use cosfly_domain::{Obstacle, OrientedBox, Town};
use cosfly_frames::{DQuat, DVec3, Pose};
use cosfly_schema::CaptionRecord;
use cosfly_schema::log::messages::{MAP_FRAME, timestamp};
use cosfly_schema::log::right_handed;
use foxglove::messages;

/// Obstacles whose bounds come this near to the flight are shown, metres.
const REACH_M: f64 = 80.0;

/// The cubes near a flight, one entity per label, and the body of a target of this height and radius, metres.
pub fn scene(town: &Town, flight: &[Pose], height_m: f64, radius_m: f64) -> messages::SceneUpdate {
    let mut obstacles: Vec<&Obstacle> = town.obstacles.iter().filter(|it| near_flight(flight, it)).collect();
    obstacles.sort_by_key(|obstacle| obstacle.kind.label());
    let entities = obstacles.chunk_by(|a, b| a.kind.label() == b.kind.label()).map(|group| messages::SceneEntity {
        timestamp: Some(timestamp(0)),
        frame_id: MAP_FRAME.into(),
        id: format!("obstacles/{}", group[0].kind.label().name()),
        cubes: group.iter().map(|obstacle| cube(obstacle)).collect(),
        ..messages::SceneEntity::default()
    });
    messages::SceneUpdate { entities: entities.chain([target(height_m, radius_m)]).collect(), deletions: vec![] }
}

/// The target's body, which moves with its frame.
fn target(height_m: f64, radius_m: f64) -> messages::SceneEntity {
    let middle = DVec3::Z * (0.5 * height_m);
    let body = messages::CubePrimitive {
        pose: Some(messages::Pose {
            position: Some(right_handed::vector(middle)),
            orientation: Some(right_handed::quaternion(DQuat::IDENTITY)),
        }),
        size: Some(right_handed::vector(DVec3::new(2.0 * radius_m, 2.0 * radius_m, height_m))),
        color: Some(messages::Color { r: 1.0, g: 0.2, b: 0.2, a: 0.9 }),
    };
    messages::SceneEntity {
        timestamp: Some(timestamp(0)),
        frame_id: "target".into(),
        id: "target".into(),
        frame_locked: true,
        cubes: vec![body],
        ..messages::SceneEntity::default()
    }
}

/// Boxes of people and vehicles at a time; they take the place of those before.
pub fn bodies(time_ns: u64, boxes: &[OrientedBox]) -> messages::SceneUpdate {
    let cubes = boxes.iter().map(|shape| shaped(shape, [0.2, 0.45, 0.9])).collect();
    let entity = messages::SceneEntity {
        timestamp: Some(timestamp(time_ns)),
        frame_id: MAP_FRAME.into(),
        id: "bodies".into(),
        cubes,
        ..messages::SceneEntity::default()
    };
    messages::SceneUpdate { entities: vec![entity], deletions: vec![] }
}

/// Whether some pose of the flight lies within [`REACH_M`] of the obstacle's bounds.
fn near_flight(flight: &[Pose], obstacle: &Obstacle) -> bool {
    let (min, max) = obstacle.shape.bounds_in_world();
    flight.iter().any(|pose| {
        let point = pose.position_in_world;
        (point - point.clamp(min, max)).length_squared() <= REACH_M * REACH_M
    })
}

fn cube(obstacle: &Obstacle) -> messages::CubePrimitive {
    shaped(&obstacle.shape, obstacle.kind.label().colour().map(|channel| f64::from(channel) / 255.0))
}

fn shaped(shape: &OrientedBox, [r, g, b]: [f64; 3]) -> messages::CubePrimitive {
    let pose = Pose { position_in_world: shape.center_in_world, pitch_rad: 0.0, yaw_rad: shape.yaw_rad, roll_rad: 0.0 };
    let size: DVec3 = 2.0 * shape.half_extents_m;
    messages::CubePrimitive {
        pose: Some(right_handed::pose(&pose)),
        size: Some(right_handed::vector(size)),
        color: Some(messages::Color { r, g, b, a: 0.8 }),
    }
}

/// A caption as a log line.
pub fn caption(caption: &CaptionRecord) -> messages::Log {
    messages::Log {
        timestamp: Some(timestamp(0)),
        level: messages::log::Level::Info as i32,
        message: caption.text.clone(),
        name: format!("caption/{}/{}", caption.language, caption.style),
        ..messages::Log::default()
    }
}
