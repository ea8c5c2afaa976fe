//! [`Observation`]: what a policy is told, apart from pictures.

use crate::action::heading_from_world;
use cosfly_drone::Motion;
use cosfly_frames::{DVec3, TargetState};

/// Number of the entries of [`Observation::features`].
pub const FEATURES: usize = 16;

/// The target when it was last tracked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetSighting {
    /// Time, seconds from the beginning of the episode.
    pub time_s: f64,
    /// Place, heading and speed.
    pub target: TargetState,
    /// Velocity, world frame, m/s.
    pub velocity_in_world: DVec3,
}

/// Observation of a policy, apart from pictures. The target is known where it is tracked, and else as it was last seen; in the
/// first observation it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Steps since the beginning.
    pub step: u32,
    /// Time since the beginning, seconds.
    pub time_s: f64,
    /// Motion of the drone.
    pub motion: Motion,
    /// Yaw of drone and camera, radians.
    pub yaw_rad: f64,
    /// Pitch of the camera, radians.
    pub pitch_rad: f64,
    /// Height above ground, metres.
    pub above_ground_m: f64,
    /// Share of the target that an unoccluded ray reaches, 0..=1, whether it is in the picture or not.
    pub visible: f64,
    /// Whether the middle of the target's body is inside the picture's borders.
    pub in_picture: bool,
    /// Whether the target counts as tracked: visible enough, in the picture, near enough.
    pub tracked: bool,
    /// The target when it was last tracked.
    pub sighting: TargetSighting,
}

impl Observation {
    /// Names of [`Self::features`], each with its unit.
    pub const NAMES: [&'static str; FEATURES] = [
        "target_ahead_m",
        "target_right_m",
        "target_up_m",
        "target_velocity_ahead_mps",
        "target_velocity_right_mps",
        "target_velocity_up_mps",
        "velocity_ahead_mps",
        "velocity_right_mps",
        "velocity_up_mps",
        "acceleration_ahead_mps2",
        "acceleration_right_mps2",
        "acceleration_up_mps2",
        "camera_pitch_deg",
        "above_ground_m",
        "is_tracked",
        "sighting_age_s",
    ];

    /// The observation as numbers, lengths in metres, vectors along the axes of the heading (ahead, right, up):
    /// 0-2 place of the sighted target's feet from the drone, 3-5 its velocity (m/s), 6-8 velocity of the drone (m/s),
    /// 9-11 its acceleration (m/s^2), 12 pitch of the camera (degrees), 13 height above ground, 14 whether the target is tracked
    /// (0 or 1), 15 age of the sighting (s).
    pub fn features(&self) -> [f64; FEATURES] {
        let turn = heading_from_world(self.yaw_rad);
        let along = |vector: DVec3| turn(vector).to_array();
        let place = along(self.sighting.target.feet_in_world - self.motion.position_in_world);
        let [velocity, own, acceleration] =
            [self.sighting.velocity_in_world, self.motion.velocity_in_world, self.motion.acceleration_in_world]
                .map(along);
        let mut features = [0.0; FEATURES];
        for (group, vector) in [place, velocity, own, acceleration].into_iter().enumerate() {
            features[3 * group..3 * group + 3].copy_from_slice(&vector);
        }
        let age_s = self.time_s - self.sighting.time_s;
        features[12..].copy_from_slice(&[
            self.pitch_rad.to_degrees(),
            self.above_ground_m,
            f64::from(self.tracked),
            age_s,
        ]);
        features
    }

    /// A vector of the world along the axes of the heading: ahead, right, up.
    pub fn along_heading(&self, vector_in_world: DVec3) -> DVec3 {
        heading_from_world(self.yaw_rad)(vector_in_world)
    }

    /// Place of the target's feet as a policy may suppose it at a time: it walks on as it was last seen, for `trust_s` seconds at
    /// most.
    pub fn supposed_feet(&self, time_s: f64, trust_s: f64) -> DVec3 {
        let since_s = (time_s - self.sighting.time_s).clamp(0.0, trust_s);
        self.sighting.target.feet_in_world + since_s * self.sighting.velocity_in_world
    }
}
