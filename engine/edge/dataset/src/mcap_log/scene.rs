//! The obstacles near a flight as coloured cubes, and the captions as log lines.

use super::messages::{MAP_FRAME, timestamp};
use super::right_handed;
use crate::{CaptionRecord, RenderedTrajectory};
use cosfly_frames::{DVec3, Pose};
use cosfly_maps::{Obstacle, Town};
use foxglove::messages;

/// Obstacles whose bounds come this near to the flight are shown, metres.
const REACH_M: f64 = 80.0;

/// The cubes near the flight, one entity per label.
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
    messages::SceneUpdate { entities: entities.collect(), deletions: vec![] }
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
