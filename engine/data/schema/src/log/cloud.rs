//! Clouds of points of lidars: the bytes of a point, in tables and in logs.

use super::messages::{MAP_FRAME, timestamp};
use super::reading::TOPICS;
use super::right_handed::{map_from_world_point, quaternion, vector};
use super::topic::{Frequency, Topic};
use crate::flight_table::{ColumnKind, DeclaredColumn, Values};
use cosfly_frames::{DQuat, DVec3};
use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{PackedElementField, PointCloud, Pose};

/// Schema of the messages.
pub const SCHEMA: &str = "foxglove.PointCloud";

/// Name of the column with the points of a sweep.
pub const COLUMN: &str = "cloud";

/// Columns of a table of sweeps with the place and the turn of the lidar.
pub const POSE: [&str; 7] = ["true_x_m", "true_y_m", "true_z_m", "true_qx", "true_qy", "true_qz", "true_qw"];

/// Bytes of a point.
pub const POINT_BYTES: usize = 28;

/// Numbers of a point: name, first byte, type, meaning; little-endian.
const FIELDS: [(&str, u32, NumericType, &str); 8] = [
    ("x", 0, NumericType::Float32, "ahead, metres"),
    ("y", 4, NumericType::Float32, "to the right, metres"),
    ("z", 8, NumericType::Float32, "up, metres"),
    ("intensity", 12, NumericType::Float32, "share of the light that the surface sends back"),
    ("time", 16, NumericType::Float32, "since the sweep's beginning, seconds"),
    ("ring", 20, NumericType::Uint16, "number of the beam in a shot"),
    ("label", 22, NumericType::Uint16, "of CARLA"),
    ("instance", 24, NumericType::Uint32, "as in pictures"),
];

/// A point. The place is in the axes of the sensor at the time of the shot (x ahead, y right, z up).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CloudPoint {
    /// Metres.
    pub place_m: [f32; 3],
    /// Share of the light that the surface sends back.
    pub intensity: f32,
    /// Time since the sweep's beginning, seconds.
    pub time_s: f32,
    /// Number of the beam.
    pub ring: u16,
    /// CARLA's label.
    pub label: u16,
    /// Instance id.
    pub instance: u32,
}

impl CloudPoint {
    /// The point of some bytes.
    pub fn of(bytes: &[u8; POINT_BYTES]) -> Self {
        let word = |at: usize| [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
        Self {
            place_m: [0, 4, 8].map(|at| f32::from_le_bytes(word(at))),
            intensity: f32::from_le_bytes(word(12)),
            time_s: f32::from_le_bytes(word(16)),
            ring: u16::from_le_bytes([bytes[20], bytes[21]]),
            label: u16::from_le_bytes([bytes[22], bytes[23]]),
            instance: u32::from_le_bytes(word(24)),
        }
    }

    /// Whether all of its numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.place_m.iter().chain([&self.intensity, &self.time_s]).all(|number| number.is_finite())
    }

    /// The bytes.
    pub fn bytes(&self) -> [u8; POINT_BYTES] {
        let mut bytes = [0; POINT_BYTES];
        let [x, y, z] = self.place_m;
        for (place, value) in bytes[..20].as_chunks_mut::<4>().0.iter_mut().zip([x, y, z, self.intensity, self.time_s])
        {
            *place = value.to_le_bytes();
        }
        bytes[20..22].copy_from_slice(&self.ring.to_le_bytes());
        bytes[22..24].copy_from_slice(&self.label.to_le_bytes());
        bytes[24..].copy_from_slice(&self.instance.to_le_bytes());
        bytes
    }
}

/// Columns of a table of sweeps.
pub fn columns() -> Vec<DeclaredColumn> {
    let column = |name: &str, kind, doc: &str| DeclaredColumn { name: name.to_owned(), kind, doc: doc.to_owned() };
    let mut columns = vec![
        column("frame", ColumnKind::Integer, "frame at the time of the sweep's beginning, or the last one before it"),
        column("time_s", ColumnKind::Real, "time of the sweep's beginning since the first frame, seconds"),
        column("points", ColumnKind::Integer, "number of points"),
    ];
    let pose =
        "place of the lidar at that time, world frame, metres, or quaternion that turns its vectors into the world";
    columns.extend(POSE.map(|name| column(name, ColumnKind::Real, pose)));
    columns.push(column(COLUMN, ColumnKind::Bytes, &doc()));
    columns
}

/// Rows of a table of sweeps.
#[derive(Clone, Debug, Default)]
pub struct SweepRows {
    frames: Vec<i64>,
    times_s: Vec<f64>,
    points: Vec<i64>,
    pose: [Vec<f64>; 7],
    clouds: Vec<Vec<u8>>,
}

impl SweepRows {
    /// Adds a sweep: its frame, time and pose at its beginning, and its points.
    pub fn add(&mut self, frame: usize, time_s: f64, pose: &[f64; 7], points: impl Iterator<Item = CloudPoint>) {
        self.frames.push(frame as i64);
        self.times_s.push(time_s);
        self.pose.iter_mut().zip(pose).for_each(|(column, value)| column.push(*value));
        let cloud: Vec<u8> = points.flat_map(|point| point.bytes()).collect();
        self.points.push((cloud.len() / POINT_BYTES) as i64);
        self.clouds.push(cloud);
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Values of [`columns`].
    pub fn into_values(self) -> Vec<Values> {
        let first = [Values::Integers(self.frames), Values::Reals(self.times_s), Values::Integers(self.points)];
        let pose = self.pose.into_iter().map(Values::Reals);
        first.into_iter().chain(pose).chain([Values::Bytes(self.clouds)]).collect()
    }
}

/// Meaning of the column [`COLUMN`].
fn doc() -> String {
    let fields: Vec<String> = FIELDS
        .iter()
        .zip(fields())
        .map(|((name, first, _, doc), (.., kind))| format!("{name} (byte {first}, {kind}, {doc})"))
        .collect();
    format!(
        "the points, {POINT_BYTES} bytes each, little-endian, in the left-handed axes of the lidar at the time of the shot: {}",
        fields.join(", ")
    )
}

/// Topic of the lidar with a table of this name.
pub fn topic(table: &str) -> Topic {
    Topic::new::<PointCloud>(format!("{TOPICS}{table}"), ": a sweep of the lidar.", Frequency::Readings)
}

/// A sweep whose lidar has a pose, as [`POSE`] names its numbers. Axes are right-handed: y points to the left.
pub fn message(time_ns: u64, pose: &[f64; 7], points: &[u8]) -> PointCloud {
    let [x, y, z, qx, qy, qz, qw] = *pose;
    let mut data = points.to_vec();
    for point in data.as_chunks_mut::<POINT_BYTES>().0 {
        // The sign of `y`.
        point[7] ^= 0x80;
    }
    let field = |(name, offset, kind, _): &(&str, u32, NumericType, &str)| PackedElementField {
        name: (*name).to_owned(),
        offset: *offset,
        r#type: i32::from(*kind),
    };
    PointCloud {
        timestamp: Some(timestamp(time_ns)),
        frame_id: MAP_FRAME.into(),
        pose: Some(Pose {
            position: Some(vector(map_from_world_point(DVec3::new(x, y, z)))),
            orientation: Some(quaternion(DQuat::from_xyzw(-qx, qy, -qz, qw))),
        }),
        point_stride: POINT_BYTES as u32,
        fields: FIELDS.iter().map(field).collect(),
        data: data.into(),
    }
}

/// Numbers of a point: name, first byte, and type as numpy calls it.
pub fn fields() -> impl ExactSizeIterator<Item = (&'static str, u32, &'static str)> {
    FIELDS.iter().map(|(name, offset, kind, _)| {
        let kind = match kind {
            NumericType::Uint16 => "u2",
            NumericType::Uint32 => "u4",
            _ => "f4",
        };
        (*name, *offset, kind)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_lies_as_the_fields_say_and_is_right_handed_in_logs() {
        let point = CloudPoint {
            place_m: [1.0, 2.0, 3.0],
            intensity: 0.4,
            time_s: 0.05,
            ring: 15,
            label: 14,
            instance: 70_000,
        };
        let bytes = point.bytes();
        let real = |bytes: &[u8], at: usize| f32::from_le_bytes(core::array::from_fn(|byte| bytes[at + byte]));
        assert_eq!([0, 4, 8, 12, 16].map(|at| real(&bytes, at)), [1.0, 2.0, 3.0, 0.4, 0.05]);
        assert_eq!((&bytes[20..24], &bytes[24..]), (&[15, 0, 14, 0][..], &70_000_u32.to_le_bytes()[..]));
        assert_eq!((CloudPoint::of(&bytes), topic("top").schema.name.as_str()), (point, SCHEMA));
        let mut rows = SweepRows::default();
        rows.add(3, 0.3, &[0.0; 7], [point, point].into_iter());
        assert_eq!(rows.len(), 1);
        let (values, columns) = (rows.into_values(), columns());
        assert_eq!((values.len(), &values[2]), (columns.len(), &Values::Integers(vec![2])));
        let cloud = message(0, &[4.0, 5.0, 6.0, 0.0, 0.0, 0.6, 0.8], &bytes);
        assert_eq!((real(&cloud.data, 4), cloud.point_stride, cloud.fields.len()), (-2.0, 28, 8));
        let pose = cloud.pose.expect("a pose");
        assert_eq!((pose.position.expect("a place").y, pose.orientation.expect("a turn").z), (-5.0, -0.6));
        assert!(doc().contains("instance (byte 24, u4, as in pictures)"));
    }
}
