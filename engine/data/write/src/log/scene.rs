//! The obstacles near a flight and the target as coloured cubes, and the captions as log lines.

use cosfly_frames::{DQuat, DVec3, Pose};
use cosfly_maps::{Obstacle, Town};
use cosfly_schema::log::messages::{MAP_FRAME, timestamp};
use cosfly_schema::log::right_handed;
use cosfly_schema::{CaptionRecord, RenderedTrajectory};
use foxglove::messages;

/// Obstacles whose bounds come this near to the flight are shown, metres.
const REACH_M: f64 = 80.0;

/// The cubes near the flight, one entity per label, and the target's.
pub fn scene(record: &RenderedTrajectory, town: &Town) -> messages::SceneUpdate {
    let mut obstacles: Vec<&Obstacle> = town.obstacles.iter().filter(|it| near_flight(record, it)).collect();
    obstacles.sort_by_key(|obstacle| obstacle.kind.label());
    let entities = obstacles.chunk_by(|a, b| a.kind.label() == b.kind.label()).map(|group| messages::SceneEntity {
        timestamp: Some(timestamp(0)),
        frame_id: MAP_FRAME.into(),
        id: format!("obstacles/{}", group[0].kind.label().name()),
        cubes: group.iter().map(|obstacle| cube(obstacle)).collect(),
        ..messages::SceneEntity::default()
    });
    messages::SceneUpdate { entities: entities.chain([target(record)]).collect(), deletions: vec![] }
}

/// The target's body, which moves with its frame.
fn target(record: &RenderedTrajectory) -> messages::SceneEntity {
    let (height_m, radius_m) = (record.trajectory.track.height_m, record.trajectory.track.radius_m);
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

/// Whether some pose of the flight lies within [`REACH_M`] of the obstacle's bounds.
fn near_flight(record: &RenderedTrajectory, obstacle: &Obstacle) -> bool {
    let (min, max) = obstacle.shape.bounds_in_world();
    record.trajectory.poses_in_world.iter().any(|pose| {
        let point = pose.position_in_world;
        (point - point.clamp(min, max)).length_squared() <= REACH_M * REACH_M
    })
}

fn cube(obstacle: &Obstacle) -> messages::CubePrimitive {
    let shape = &obstacle.shape;
    let pose = Pose { position_in_world: shape.center_in_world, pitch_rad: 0.0, yaw_rad: shape.yaw_rad, roll_rad: 0.0 };
    let size: DVec3 = 2.0 * shape.half_extents_m;
    let [r, g, b] = obstacle.kind.label().colour().map(|channel| f64::from(channel) / 255.0);
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
