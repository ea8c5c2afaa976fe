//! Parameters of stage `sense`.

use crate::place::SensorPlace;
use crate::sensor::Sensor;
use cosfly_domain::Mount;
use cosfly_frames::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sensor on the drone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SenseConfig {
    /// Name of the sensor, such as `inertial_unit`, or one that you added.
    #[schemars(extend("enum" = names()))]
    pub sensor: String,
    /// Name of the table with its readings; left out: the name of the sensor. Two sensors of one kind need two names.
    #[serde(default)]
    #[schemars(regex(pattern = "^[a-z][a-z0-9_]{0,63}$"))]
    pub table: Option<String>,
    /// Camera whose films are read, such as `front_left`; left out: each film has readings of its own. Those of other cameras have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[a-z][a-z0-9_]*$"))]
    pub camera: Option<String>,
    /// Readings a second, from the first frame on; left out: one in each frame. Inertial units have 200 or more.
    #[serde(default)]
    #[schemars(range(min = 0.01, max = 10000))]
    pub rate_hz: Option<f64>,
    /// Position on the drone: ahead, right, up, metres.
    #[serde(default)]
    #[schemars(inner(range(min = -10, max = 10)))]
    pub position_in_body_m: [f64; 3],
    /// Turn upwards against the drone, degrees.
    #[serde(default)]
    #[schemars(range(min = -90, max = 90))]
    pub pitch_deg: f64,
    /// Turn to the right against the drone, degrees.
    #[serde(default)]
    #[schemars(range(min = -180, max = 180))]
    pub yaw_deg: f64,
    /// Holds the sensor level whatever the drone's tilt, as a gimbal does; not for sensors that are fixed to the airframe.
    #[serde(default)]
    pub levelled: bool,
}

fn names() -> Vec<&'static str> {
    crate::ALL.iter().map(|sensor| sensor.name).collect()
}

impl SenseConfig {
    /// The sensor; `None` where the list has none of that name.
    pub fn sensor(&self) -> Option<&'static Sensor> {
        crate::called(&self.sensor)
    }

    /// Name of the table.
    pub fn table(&self) -> &str {
        self.table.as_ref().unwrap_or(&self.sensor)
    }

    /// Where the sensor sits.
    pub fn place(&self) -> SensorPlace {
        let (pitch_rad, yaw_rad) = (self.pitch_deg.to_radians(), self.yaw_deg.to_radians());
        let mount = Mount { pitch_rad, yaw_rad, levelled: self.levelled, ..Mount::default() };
        SensorPlace { position_in_body: DVec3::from_array(self.position_in_body_m), mount }
    }
}
