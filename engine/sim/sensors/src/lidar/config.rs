//! Parameters of stage `scan`.

use super::device::{LIDARS, Lidar, lidar};
use super::pattern::{Beams, LidarPattern};
use crate::place::SensorPlace;
use cosfly_domain::Mount;
use cosfly_frames::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Most beams of a shot times shots a second.
const MOST_RAYS_HZ: u64 = 5_000_000;

/// A lidar on the drone, fixed to its airframe: a device, or a pattern of one's own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScanConfig {
    /// Name of the device, such as `os1_64`; left out where `pattern` is given.
    #[serde(default)]
    pub lidar: Option<String>,
    /// Beams and ranges of a device that is not in the list.
    #[serde(default)]
    pub pattern: Option<PatternConfig>,
    /// Name of the table with its sweeps; left out: the name of the device, or `lidar`. Two of one kind need two names.
    #[serde(default)]
    #[schemars(regex(pattern = "^[a-z][a-z0-9_]{0,63}$"))]
    pub table: Option<String>,
    /// Camera whose films are scanned, such as `front_left`; left out: each film has sweeps of its own. Those of other cameras have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[a-z][a-z0-9_]*$"))]
    pub camera: Option<String>,
    /// Sweeps a second; left out: 10. A sweep has a whole number of shots.
    #[serde(default)]
    #[schemars(range(min = 0.1, max = 1000))]
    pub rate_hz: Option<f64>,
    /// Position on the airframe: ahead, right, up, metres.
    #[serde(default)]
    #[schemars(inner(range(min = -10, max = 10)))]
    pub position_in_body_m: [f64; 3],
    /// Turn upwards against the airframe, degrees; -90 looks down.
    #[serde(default)]
    #[schemars(range(min = -90, max = 90))]
    pub pitch_deg: f64,
    /// Turn to the right against the airframe, degrees.
    #[serde(default)]
    #[schemars(range(min = -180, max = 180))]
    pub yaw_deg: f64,
}

/// Beams of one azimuth, which turns through a range in a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatternConfig {
    /// Elevations of the beams, degrees; 256 at most.
    #[schemars(inner(range(min = -90, max = 90)))]
    pub elevations_deg: Vec<f64>,
    /// Azimuths at which a sweep begins and ends, degrees to the right; left out: all around from ahead.
    #[serde(default = "all_around_deg")]
    #[schemars(inner(range(min = -360, max = 360)))]
    pub azimuths_deg: [f64; 2],
    /// Shots a second; all beams are fired together.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub shots_hz: u32,
    /// Distances of the nearest echo, and of the farthest one from a surface that reflects 80 %, metres.
    pub range_m: [f64; 2],
    /// Standard deviation of a distance, metres; `cosfly verify` allows points 0.15 m beside surfaces.
    #[serde(default = "deviation_m")]
    #[schemars(range(min = 0, max = 0.04))]
    pub deviation_m: f64,
}

fn all_around_deg() -> [f64; 2] {
    [0.0, 360.0]
}

fn deviation_m() -> f64 {
    0.02
}

/// A key of a [`ScanConfig`], and why its value is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScanRefusal {
    /// Key, with dots.
    pub key: &'static str,
    /// Reason, with what is allowed.
    pub reason: String,
}

fn refused<T>(key: &'static str, reason: impl Into<String>) -> Result<T, ScanRefusal> {
    Err(ScanRefusal { key, reason: reason.into() })
}

impl ScanConfig {
    /// The device; `None` for a pattern of one's own.
    pub fn device(&self) -> Option<&'static Lidar> {
        self.lidar.as_deref().and_then(lidar)
    }

    /// Beams and ranges.
    ///
    /// # Errors
    /// A value that is refused.
    pub fn read_pattern(&self) -> Result<LidarPattern, ScanRefusal> {
        let pattern = match (&self.lidar, &self.pattern) {
            (Some(name), None) => match self.device() {
                Some(device) => {
                    let (rate_hz, [least, _, most]) = (self.rate_hz(), device.rates_hz);
                    if !(least..=most).contains(&rate_hz) {
                        return refused(
                            "rate_hz",
                            format!("`{name}` makes {least} to {most} sweeps a second, not {rate_hz}"),
                        );
                    }
                    device.pattern()
                }
                None => {
                    let names: Vec<String> = LIDARS.iter().map(|it| format!("`{}`", it.name)).collect();
                    return refused("lidar", format!("there is no lidar `{name}`; there are {}", names.join(", ")));
                }
            },
            (None, Some(own)) => own.read()?,
            (Some(_), Some(_)) => {
                return refused("pattern", "`lidar` names a device with a pattern; leave one of the two out");
            }
            (None, None) => {
                return refused("lidar", "choose a device, such as `lidar = \"vlp16\"`, or give a `pattern`");
            }
        };
        let rate_hz = self.rate_hz();
        if pattern.shots(rate_hz).is_none() {
            let shots_hz = pattern.shots_hz;
            return refused(
                "rate_hz",
                format!("{rate_hz} sweeps a second do not divide the {shots_hz} shots a second"),
            );
        }
        Ok(pattern)
    }

    /// Sweeps a second.
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz.unwrap_or(10.0)
    }

    /// Name of the table.
    pub fn table(&self) -> &str {
        self.table.as_deref().or(self.lidar.as_deref()).unwrap_or("lidar")
    }

    /// Where the lidar sits.
    pub fn place(&self) -> SensorPlace {
        let (pitch_rad, yaw_rad) = (self.pitch_deg.to_radians(), self.yaw_deg.to_radians());
        let mount = Mount { pitch_rad, yaw_rad, ..Mount::default() };
        SensorPlace { position_in_body: DVec3::from_array(self.position_in_body_m), mount }
    }
}

impl PatternConfig {
    fn read(&self) -> Result<LidarPattern, ScanRefusal> {
        let Self { elevations_deg, azimuths_deg, shots_hz, range_m, deviation_m } = self;
        if !(1..=256).contains(&elevations_deg.len()) {
            return refused("pattern.elevations_deg", format!("{} beams; 1 to 256 are allowed", elevations_deg.len()));
        }
        let [begin, end] = azimuths_deg;
        if !(end > begin && end - begin <= 360.0) {
            return refused(
                "pattern.azimuths_deg",
                "the second azimuth is larger than the first, by 360 degrees at most",
            );
        }
        if u64::from(*shots_hz) * elevations_deg.len() as u64 > MOST_RAYS_HZ {
            return refused("pattern.shots_hz", format!("more than {MOST_RAYS_HZ} beams a second"));
        }
        let [near, far] = range_m;
        if !(*near > 0.0 && far > near && *far <= 1000.0) {
            return refused("pattern.range_m", "two distances: more than 0, the second one larger, 1,000 m at most");
        }
        let beams = Beams::rings(elevations_deg, *azimuths_deg);
        Ok(LidarPattern { shots_hz: *shots_hz, range_m: *range_m, deviation_m: *deviation_m, beams })
    }
}
