//! Key points of people in pictures: COCO's seventeen, in its order, and the 3-D box around a body.

use cosfly_frames::DVec3;
use serde::{Deserialize, Serialize};

/// Names of the key points, in COCO's order. Left and right are the person's own.
pub const KEY_POINTS: [&str; 17] = [
    "nose",
    "left_eye",
    "right_eye",
    "left_ear",
    "right_ear",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
];

/// Lines between key points that draw a person, as COCO has them, counted from 0.
pub const SKELETON: [[usize; 2]; 19] = [
    [15, 13],
    [13, 11],
    [16, 14],
    [14, 12],
    [11, 12],
    [5, 11],
    [6, 12],
    [5, 6],
    [5, 7],
    [6, 8],
    [7, 9],
    [8, 10],
    [1, 2],
    [0, 1],
    [0, 2],
    [1, 3],
    [2, 4],
    [3, 5],
    [4, 6],
];

/// Whether a picture shows a key point; the numbers are COCO's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shown {
    /// Out of the picture, or behind the camera.
    Outside = 0,
    /// In the picture, behind something else or behind the body itself.
    Occluded = 1,
    /// On the body's own pixels.
    Visible = 2,
}

/// A key point in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeyPoint {
    /// World frame, metres.
    pub point_in_world: DVec3,
    /// Pixel coordinates, right and down from the top-left corner; 0 out of the picture.
    pub pixel: [f64; 2],
    /// Planar depth, metres; 0 behind the camera.
    pub depth_m: f64,
    /// Whether the picture shows it.
    pub shown: Shown,
}

/// Box and key points of a body that a frame shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyInSpace {
    /// Number of the frame.
    pub frame: u32,
    /// Instance id.
    pub instance: u32,
    /// Middle of the box, world frame, metres.
    pub centre_in_world: DVec3,
    /// Length along the heading, width and height, metres.
    pub size_m: DVec3,
    /// Heading, radians.
    pub heading_rad: f64,
    /// The key points in the order of [`KEY_POINTS`]; none of vehicles and drones.
    pub key_points: Vec<KeyPoint>,
}
