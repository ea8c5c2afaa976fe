//! Readings of sensors as messages: those that ROS 2 has a type for, by their columns; all others as numbers.

use super::cdr::Cdr;
use super::messages::{self, Header, Placed};
use cosfly_frames::{DQuat, DVec3};
use cosfly_schema::log::reading::LoggedSensor;

/// A kind of sensor that ROS 2 has a type for.
struct Kind {
    /// Type of the messages.
    message: &'static str,
    /// Columns that make a sensor one of this kind, in the order in which `encode` takes their numbers.
    columns: &'static [&'static str],
    /// Encodes a reading; axes are left-handed as the dataset has them.
    encode: fn(Header<'_>, &[f64]) -> Vec<u8>,
}

/// All kinds.
const KINDS: [Kind; 4] = [
    Kind {
        message: "sensor_msgs/Imu",
        columns: &["force_x_mps2", "force_y_mps2", "force_z_mps2", "rate_x_rad_s", "rate_y_rad_s", "rate_z_rad_s"],
        encode: imu,
    },
    Kind {
        message: "sensor_msgs/NavSatFix",
        columns: &["is_fix", "latitude_deg", "longitude_deg", "up_m"],
        encode: nav_sat_fix,
    },
    Kind { message: "sensor_msgs/FluidPressure", columns: &["pressure_hpa"], encode: fluid_pressure },
    Kind {
        message: "sensor_msgs/MagneticField",
        columns: &["field_x_ut", "field_y_ut", "field_z_ut"],
        encode: magnetic_field,
    },
];

/// Columns with the true place and turn of a sensor.
const POSE: [&str; 7] = ["true_x_m", "true_y_m", "true_z_m", "true_qx", "true_qy", "true_qz", "true_qw"];

/// Columns with the true place of a sensor that has no turn, east, north and up: axes of `map`.
const PLACE: [&str; 3] = ["true_east_m", "true_north_m", "true_up_m"];

/// How readings of a sensor become messages.
pub struct ReadingCoder<'a> {
    sensor: &'a LoggedSensor,
    /// Kind, and places of its columns.
    kind: Option<(&'static Kind, Vec<usize>)>,
    /// Places of the columns with its pose.
    pose: Option<Vec<usize>>,
    /// Places of the columns with its place alone.
    place: Option<Vec<usize>>,
}

impl<'a> ReadingCoder<'a> {
    /// The layout of a sensor's readings.
    pub fn of(sensor: &'a LoggedSensor) -> Self {
        let place = |name: &&str| sensor.quantities.iter().position(|it| it == name);
        let places = |names: &[&str]| names.iter().map(place).collect::<Option<Vec<usize>>>();
        let kind = KINDS.iter().find_map(|kind| Some((kind, places(kind.columns)?)));
        Self { sensor, kind, pose: places(&POSE), place: places(&PLACE) }
    }

    /// Type of its messages.
    pub fn message(&self) -> &'static str {
        self.kind.as_ref().map_or("std_msgs/Float64MultiArray", |(kind, _)| kind.message)
    }

    /// A reading as a message, in the frame that is named after the sensor.
    pub fn encode(&self, time_ns: u64, values: &[f64]) -> Vec<u8> {
        let header = Header { time_ns, frame: &self.sensor.name };
        match &self.kind {
            Some((kind, places)) => (kind.encode)(header, &picked(places, values)),
            None => messages::reading(&self.sensor.quantities, values),
        }
    }

    /// Name of the sensor and of its frame.
    pub fn frame(&self) -> &'a str {
        &self.sensor.name
    }

    /// Whether its readings tell its pose.
    pub fn has_pose(&self) -> bool {
        self.pose.is_some()
    }

    /// Whether its messages have a frame whose place no reading tells.
    pub fn is_nowhere(&self) -> bool {
        self.kind.is_some() && self.pose.is_none() && self.place.is_none()
    }

    /// True place of the sensor in `map`, of those that know it.
    pub fn placed(&self, values: &[f64]) -> Option<(&'a str, Placed)> {
        if let Some(place) = &self.place {
            let position = DVec3::from_array(picked(place, values).try_into().ok()?);
            return Some((&self.sensor.name, Placed { position, rotation: DQuat::IDENTITY }));
        }
        let pose = picked(self.pose.as_ref()?, values);
        let [x, y, z, qx, qy, qz, qw] = pose.try_into().ok()?;
        // The mirror of y turns a rotation's axis as that of a turn: x and z change their signs.
        let rotation = DQuat::from_xyzw(-qx, qy, -qz, qw);
        Some((&self.sensor.name, Placed { position: DVec3::new(x, -y, z), rotation }))
    }
}

fn picked(places: &[usize], values: &[f64]) -> Vec<f64> {
    places.iter().map(|place| values.get(*place).copied().unwrap_or_default()).collect()
}

/// `sensor_msgs/Imu`, without orientation. A vector changes the sign of y, an angular velocity those of x and z.
fn imu(header: Header<'_>, values: &[f64]) -> Vec<u8> {
    let [fx, fy, fz, wx, wy, wz] = values.try_into().unwrap_or_default();
    messages::imu(header, &[-wx, wy, -wz], &[fx, -fy, fz])
}

/// `sensor_msgs/NavSatFix`; the height is that above the world's origin.
fn nav_sat_fix(header: Header<'_>, values: &[f64]) -> Vec<u8> {
    let [is_fix, latitude_deg, longitude_deg, height_m] = values.try_into().unwrap_or_default();
    let mut cdr = Cdr::new();
    cdr.header(header);
    // Status: -1 without a fix, 0 with one; service: 1, GPS.
    cdr.u8(if is_fix == 1.0 { 0 } else { u8::MAX });
    cdr.u16(1);
    cdr.f64s(&[latitude_deg, longitude_deg, height_m]);
    cdr.f64s(&[0.0; 9]);
    // The covariance is not known.
    cdr.u8(0);
    cdr.finish()
}

/// `sensor_msgs/FluidPressure`, pascals.
fn fluid_pressure(header: Header<'_>, values: &[f64]) -> Vec<u8> {
    let [pressure_hpa] = values.try_into().unwrap_or_default();
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.f64s(&[100.0 * pressure_hpa, 0.0]);
    cdr.finish()
}

/// `sensor_msgs/MagneticField`, tesla. The field turns as a vector does here: north is -y of the world and y of `map`.
fn magnetic_field(header: Header<'_>, values: &[f64]) -> Vec<u8> {
    let [x, y, z] = values.try_into().unwrap_or_default();
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.f64s(&[1e-6 * x, -1e-6 * y, 1e-6 * z]);
    cdr.f64s(&[0.0; 9]);
    cdr.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensor(quantities: &[&str]) -> LoggedSensor {
        LoggedSensor { name: "unit".into(), quantities: quantities.iter().map(|it| (*it).to_owned()).collect() }
    }

    fn reals(message: &[u8], from: usize, count: usize) -> Vec<f64> {
        let bytes = message[4 + from..4 + from + 8 * count].as_chunks::<8>().0;
        bytes.iter().map(|it| f64::from_le_bytes(*it)).collect()
    }

    #[test]
    fn an_inertial_reading_is_right_handed_wherever_its_columns_stand() {
        let columns: Vec<&str> = KINDS[0].columns.iter().rev().chain(&POSE).copied().collect();
        let unit = sensor(&columns);
        let coder = ReadingCoder::of(&unit);
        assert_eq!(coder.message(), "sensor_msgs/Imu");
        let values = [0.3, 0.2, 0.1, 9.8, 2.0, 1.0, 4.0, 5.0, 6.0, 0.0, 0.0, 0.6, 0.8];
        let message = coder.encode(2_000_000_005, &values);
        // Time, `unit`: 4 + 4 + 4 + 5 bytes, aligned to 24; quaternion and its covariance.
        assert_eq!(reals(&message, 24 + 32, 1), [-1.0]);
        assert_eq!(reals(&message, 24 + 104, 3), [-0.1, 0.2, -0.3]);
        assert_eq!(reals(&message, 24 + 200, 3), [1.0, -2.0, 9.8]);
        assert_eq!(message.len(), 4 + 24 + 296);
        // A turn to the right by the left-handed z is one by the negative right-handed z.
        let (name, placed) = coder.placed(&values).expect("a pose");
        assert_eq!((name, placed.position, placed.rotation.z), ("unit", DVec3::new(4.0, -5.0, 6.0), -0.6));
    }

    #[test]
    fn kinds_are_found_by_their_columns() {
        for (columns, message) in [
            (&["is_fix", "satellites", "up_m", "latitude_deg", "longitude_deg"][..], "sensor_msgs/NavSatFix"),
            (&["pressure_hpa", "altitude_m"], "sensor_msgs/FluidPressure"),
            (&["field_x_ut", "field_y_ut", "field_z_ut"], "sensor_msgs/MagneticField"),
            (&["range_m", "is_hit"], "std_msgs/Float64MultiArray"),
        ] {
            let unit = sensor(columns);
            let coder = ReadingCoder::of(&unit);
            assert_eq!(coder.message(), message);
            assert!(coder.placed(&[0.0; 5]).is_none());
        }
        let unit = sensor(&["true_up_m", "pressure_hpa", "true_east_m", "true_north_m"]);
        let (_, placed) = ReadingCoder::of(&unit).placed(&[3.0, 0.0, 1.0, 2.0]).expect("a place");
        assert_eq!((placed.position, placed.rotation), (DVec3::new(1.0, 2.0, 3.0), DQuat::IDENTITY));
        let unit = sensor(&["is_fix", "up_m", "latitude_deg", "longitude_deg"]);
        let message = ReadingCoder::of(&unit).encode(0, &[0.0, 0.0, 0.0, 0.0]);
        assert_eq!(message[4 + 17], u8::MAX, "no fix");
        let unit = sensor(&["pressure_hpa"]);
        assert_eq!(reals(&ReadingCoder::of(&unit).encode(0, &[1000.0]), 24, 2), [100_000.0, 0.0]);
    }
}
