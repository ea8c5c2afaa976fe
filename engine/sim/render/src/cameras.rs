//! Keys of a camera: its turn against the drone, and what one of several cameras has in the place of the stage's keys.

use cosfly_domain::{Lens, MotionBlur, Noise, RollingShutter};
use cosfly_optics::OpticsConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A camera among several: what is left out is as the stage says.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CameraConfig {
    /// Image width, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 16, max = 7680))]
    pub width: Option<u32>,
    /// Image height, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 16, max = 4320))]
    pub height: Option<u32>,
    /// Horizontal field of view, degrees; in the place of `fov_range_deg`, too.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 5, max = 150))]
    pub fov_deg: Option<f64>,
    /// Distance between the two cameras of a stereo pair, metres, along their right axis: both film every flight, and the films
    /// are named `<camera>_left`, where the place of the camera says, and `<camera>_right`. Left out: one camera.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.001, max = 10))]
    pub base_line_m: Option<f64>,
    /// Films every n-th frame of a flight, from the first one on, 1 to 1000: 0.1 s between frames and 5 are two pictures a second.
    /// Left out: every frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000))]
    pub every: Option<u32>,
    /// Time of each picture after its frame, seconds: at least 0 and less than the time from one picture to the next. People,
    /// vehicles, poses and time stamps are those of that time. Left out: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub offset_s: Option<f64>,
    /// Place and turn of the camera on the drone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gimbal: Option<GimbalConfig>,
    /// Lens, sensor and image processor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub optics: Option<OpticsConfig>,
    /// Distortion of the lens.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lens: Option<Lens>,
    /// Motion blur of colour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion_blur: Option<MotionBlur>,
    /// Rows that are taken one after the other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rolling_shutter: Option<RollingShutter>,
    /// Sensor noise on colour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<Noise>,
}

/// Place of the camera on the drone, and ranges of its turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GimbalConfig {
    /// Position along the drone's axes: ahead, right, up, metres, -10 to 10. The drone's pitch and roll are those of the table `frames`.
    pub position_in_body_m: [f64; 3],
    /// Turn around the optical axis, after yaw and pitch, degrees; positive: right side down.
    #[schemars(range(min = -180, max = 180))]
    pub roll_deg: f64,
    /// Lowest and highest turn upwards, degrees, -90 to 90.
    pub pitch_range_deg: [f64; 2],
    /// Lowest and highest turn to the right, degrees, -180 to 180.
    pub yaw_range_deg: [f64; 2],
    /// Holds the horizon level in the pictures whatever the drone's tilt, as gimbals do: the turns add to the drone's yaw and
    /// pitch. `false`: the camera is turned in the drone's body frame, and the horizon tilts with it.
    pub levelled: bool,
}

impl Default for GimbalConfig {
    fn default() -> Self {
        Self {
            position_in_body_m: [0.0; 3],
            roll_deg: 0.0,
            pitch_range_deg: [0.0; 2],
            yaw_range_deg: [0.0; 2],
            levelled: true,
        }
    }
}
