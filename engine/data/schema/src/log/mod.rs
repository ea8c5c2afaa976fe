//! The log of a trajectory: topics and messages.
//!
//! Here the world frame (left-handed, y right) is converted to the right-handed `map` frame of robotics tools, by
//! [`right_handed`] and nowhere else. Frame `i` is at `i * dt_s` after time 0.

pub mod messages;
pub mod right_handed;
pub mod target_state;

pub use target_state::TargetStateMessage;

/// Topics.
pub mod topic {
    /// `foxglove.CompressedImage`: the colour image.
    pub const RGB: &str = "/camera/rgb/image";
    /// `foxglove.CameraCalibration` of all images.
    pub const CAMERA: &str = "/camera/rgb/camera_info";
    /// `foxglove.ImageAnnotations`: boxes of the target and of other people.
    pub const ANNOTATIONS: &str = "/camera/rgb/annotations";
    /// `foxglove.CompressedImage`: small colour image.
    pub const RGB_PREVIEW: &str = "/camera/rgb/preview";
    /// `foxglove.RawImage` `32FC1`: planar depth, metres.
    pub const DEPTH: &str = "/camera/depth/image";
    /// `foxglove.CompressedImage`: depth in logarithmic colours.
    pub const DEPTH_PREVIEW: &str = "/camera/depth/preview";
    /// `foxglove.RawImage` `mono8`: CARLA label ids.
    pub const SEMANTIC: &str = "/camera/semantic/image";
    /// `foxglove.CompressedImage`: labels as palette PNG.
    pub const SEMANTIC_PREVIEW: &str = "/camera/semantic/preview";
    /// `foxglove.RawImage` `16UC1` or `32UC1`: instance ids.
    pub const INSTANCE: &str = "/camera/instance/image";
    /// `foxglove.FrameTransforms`.
    pub const TF: &str = "/tf";
    /// `foxglove.PoseInFrame` of the drone.
    pub const DRONE_POSE: &str = "/drone/pose";
    /// `foxglove.PoseInFrame` of the target's feet.
    pub const TARGET_POSE: &str = "/target/pose";
    /// `foxglove.PosesInFrame`: the whole trajectory of the drone, once.
    pub const DRONE_PATH: &str = "/drone/path";
    /// `foxglove.PosesInFrame`: the whole walk, once.
    pub const TARGET_PATH: &str = "/target/path";
    /// `foxglove.SceneUpdate`: obstacles near the flight and the target, once.
    pub const SCENE: &str = "/scene";
    /// `foxglove.Log`: captions, once.
    pub const CAPTIONS: &str = "/captions";
    /// `cosfly.TargetState`.
    pub const TARGET_STATE: &str = "/target/state";

    /// Channels whose messages are encoded with the frame pack; their channel ids in every log are 1, 2, 3.
    pub const PACKED: [&str; 3] = [DEPTH, SEMANTIC, INSTANCE];

    /// All topics with schema and meaning, in the order above.
    pub const ALL: [(&str, &str); 17] = [
        (RGB, "`foxglove.CompressedImage`: the colour image."),
        (CAMERA, "`foxglove.CameraCalibration` of all images."),
        (ANNOTATIONS, "`foxglove.ImageAnnotations`: boxes of the target and of other people."),
        (RGB_PREVIEW, "`foxglove.CompressedImage`: small colour image."),
        (DEPTH, "`foxglove.RawImage` `32FC1`: planar depth, metres."),
        (DEPTH_PREVIEW, "`foxglove.CompressedImage`: depth in logarithmic colours."),
        (SEMANTIC, "`foxglove.RawImage` `mono8`: CARLA label ids."),
        (SEMANTIC_PREVIEW, "`foxglove.CompressedImage`: labels as palette PNG."),
        (INSTANCE, "`foxglove.RawImage` `16UC1` or `32UC1`: instance ids."),
        (TF, "`foxglove.FrameTransforms`."),
        (DRONE_POSE, "`foxglove.PoseInFrame` of the drone."),
        (TARGET_POSE, "`foxglove.PoseInFrame` of the target's feet."),
        (DRONE_PATH, "`foxglove.PosesInFrame`: the whole flight, once."),
        (TARGET_PATH, "`foxglove.PosesInFrame`: the whole walk, once."),
        (SCENE, "`foxglove.SceneUpdate`: obstacles near the flight and the target, once."),
        (CAPTIONS, "`foxglove.Log`: captions, once."),
        (TARGET_STATE, "`cosfly.TargetState`."),
    ];
}

/// Time of frame `frame`, nanoseconds after the file's time 0.
pub fn frame_time_ns(dt_s: f64, frame: usize) -> u64 {
    (frame as f64 * dt_s * 1e9).round_ties_even() as u64
}
