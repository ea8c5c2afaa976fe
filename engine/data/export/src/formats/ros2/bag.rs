//! A bag: an MCAP file of messages, and the `metadata.yaml` that ROS 2 looks for beside it.

use super::cameras::CameraNames;
use super::definitions::whole_definition;
use super::readings::ReadingCoder;
use crate::folder::OutFolder;
use crate::source::LidarSweeps;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_schema::log::reading::{self, LoggedSensor};
use mcap::records::MessageHeader;
use mcap::{McapError, WriteOptions, Writer};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};

/// A topic of a bag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Topic {
    /// Transforms that stay.
    TfStatic,
    /// Boxes of the town.
    Town,
    /// Commands to the drone.
    Instruction,
    /// Time.
    Clock,
    /// Transforms that change.
    Tf,
    /// Pose and motion of the drone.
    Odometry,
    /// Pose and motion of the target.
    TargetOdometry,
    /// Camera of the colours, by the number of the camera.
    CameraInfo(usize),
    /// Colours, by the number of the camera.
    Image(usize),
    /// Camera of the depths, by the number of the camera.
    DepthInfo(usize),
    /// Depths, by the number of the camera.
    Depth(usize),
    /// Labels, by the number of the camera.
    Labels(usize),
    /// Boxes and ids of bodies, by the number of the camera.
    Detections(usize),
    /// Readings of the flight's sensor of this number.
    Sensor(usize),
    /// Sweeps of the flight's lidar of this number.
    Lidar(usize),
    /// Velocities that a policy asked for.
    Command,
    /// Numbers of an action of another kind.
    Action,
    /// State and reward after a step.
    Step,
    /// Losses, collisions, the end.
    Event,
    /// Inertial unit of a closed-loop flight.
    Inertial,
    /// Its barometer.
    Height,
    /// Its satellite receiver.
    Fix,
}

/// A topic with its name and the type of its messages, and whether those who come late still get the last one.
pub type NamedTopic = (Topic, String, &'static str, bool);

use Topic as T;

/// Topics of every flight of a dataset beside those of its cameras.
const TOPICS: [(Topic, &str, &str, bool); 7] = [
    (T::TfStatic, "/tf_static", "tf2_msgs/TFMessage", true),
    (T::Town, "/town", "visualization_msgs/MarkerArray", true),
    (T::Instruction, "/instruction", "std_msgs/String", true),
    (T::Clock, "/clock", "rosgraph_msgs/Clock", false),
    (T::Tf, "/tf", "tf2_msgs/TFMessage", false),
    (T::Odometry, "/odom", "nav_msgs/Odometry", false),
    (T::TargetOdometry, "/target/odom", "nav_msgs/Odometry", false),
];

/// Topics of the camera of this number: below `/camera` or, of one of several, below `/camera/NAME`.
fn topics_of_camera(number: usize, names: &CameraNames) -> [NamedTopic; 6] {
    let below = |topic: Topic, name: &str, kind: &'static str| (topic, format!("{}/{name}", names.topics), kind, false);
    let detections = if names.is_only() { "/detections".to_owned() } else { format!("{}/detections", names.topics) };
    [
        below(T::CameraInfo(number), "camera_info", "sensor_msgs/CameraInfo"),
        below(T::Image(number), "image_raw/compressed", "sensor_msgs/CompressedImage"),
        below(T::DepthInfo(number), "depth/camera_info", "sensor_msgs/CameraInfo"),
        below(T::Depth(number), "depth/image_raw", "sensor_msgs/Image"),
        below(T::Labels(number), "semantic/image_raw", "sensor_msgs/Image"),
        (T::Detections(number), detections, "vision_msgs/Detection2DArray", false),
    ]
}

/// Quality of service of topics whose last message stays: keep the last one, reliable, transient local.
const LATCHED: &str = "\
- history: 1
  depth: 1
  reliability: 1
  durability: 1
  deadline:
    sec: 9223372036
    nsec: 854775807
  lifespan:
    sec: 9223372036
    nsec: 854775807
  liveliness: 1
  liveliness_lease_duration:
    sec: 9223372036
    nsec: 854775807
  avoid_ros_namespace_conventions: false";

fn quality(is_latched: bool) -> &'static str {
    if is_latched { LATCHED } else { "" }
}

/// A bag that is being written.
pub struct Bag<'a> {
    out: &'a OutFolder,
    folder: String,
    /// Name of the MCAP file in the folder.
    file: String,
    writer: Writer<BufWriter<File>>,
    topics: Vec<NamedTopic>,
    /// Numbers of the channels, and of the messages so far.
    channels: BTreeMap<Topic, (u16, u32)>,
    times_ns: Option<[u64; 2]>,
}

/// Topics of a flight of a dataset with these cameras, sensors and lidars.
pub fn topics_of_flight(cameras: &[CameraNames], sensors: &[LoggedSensor], lidars: &[LidarSweeps]) -> Vec<NamedTopic> {
    let own = TOPICS.into_iter().map(|(topic, name, kind, is_latched)| (topic, name.to_owned(), kind, is_latched));
    let of_lidar = |(number, (name, _)): (usize, &LidarSweeps)| {
        (Topic::Lidar(number), format!("{}{name}", reading::TOPICS), "sensor_msgs/PointCloud2", false)
    };
    let of_cameras = cameras.iter().enumerate().flat_map(|(number, names)| topics_of_camera(number, names));
    own.chain(of_cameras).chain(topics_of_sensors(sensors)).chain(lidars.iter().enumerate().map(of_lidar)).collect()
}

/// Topics of these sensors.
pub fn topics_of_sensors(sensors: &[LoggedSensor]) -> impl Iterator<Item = NamedTopic> {
    sensors
        .iter()
        .enumerate()
        .map(|(number, sensor)| (Topic::Sensor(number), sensor.topic_name(), ReadingCoder::of(sensor).message(), false))
}

impl<'a> Bag<'a> {
    /// Begins a bag of these topics in a new folder, named after its last part.
    pub fn begin(out: &'a OutFolder, folder: String, topics: Vec<NamedTopic>) -> Result<Self> {
        let file = format!("{}_0.mcap", folder.rsplit('/').next().unwrap_or_default());
        // Threads of the compressor would show in the bytes.
        let options = WriteOptions::new().profile("ros2").library("cosfly").compression_threads(0);
        let output = out.create(&format!("{folder}/{file}"))?;
        let refused = |error: McapError| refusal(out, &folder, &file, error);
        let mut writer = options.create(output).map_err(refused)?;
        let mut channels = BTreeMap::new();
        for (topic, name, kind, is_latched) in &topics {
            let definition = whole_definition(kind);
            let schema = writer.add_schema(&full_name(kind), "ros2msg", definition.as_bytes()).map_err(refused)?;
            let notes = BTreeMap::from([("offered_qos_profiles".to_owned(), quality(*is_latched).to_owned())]);
            channels.insert(*topic, (writer.add_channel(schema, name, "cdr", &notes).map_err(refused)?, 0));
        }
        Ok(Self { out, folder, file, writer, topics, channels, times_ns: None })
    }

    /// Adds a message.
    pub fn write(&mut self, topic: Topic, time_ns: u64, message: &[u8]) -> Result<()> {
        let Some((channel_id, count)) = self.channels.get_mut(&topic) else { return Ok(()) };
        *count += 1;
        let header =
            MessageHeader { channel_id: *channel_id, sequence: *count, log_time: time_ns, publish_time: time_ns };
        let [first, last] = self.times_ns.unwrap_or([time_ns; 2]);
        self.times_ns = Some([first.min(time_ns), last.max(time_ns)]);
        let written = self.writer.write_to_known_channel(&header, message);
        written.map_err(|error| refusal(self.out, &self.folder, &self.file, error))
    }

    /// Writes the index of the file, and `metadata.yaml`.
    pub fn finish(mut self) -> Result<()> {
        self.writer.finish().map_err(|error| refusal(self.out, &self.folder, &self.file, error))?;
        let metadata = self.metadata();
        let ended = self.writer.into_inner().flush();
        ended.map_err(|error| self.out.refusal(&format!("{}/{}", self.folder, self.file), &error))?;
        self.out.put(&format!("{}/metadata.yaml", self.folder), metadata.as_bytes())
    }

    /// The description of the bag, version 5: that of Humble, which later ones read.
    fn metadata(&self) -> String {
        let [first, last] = self.times_ns.unwrap_or_default();
        let (file, duration) = (&self.file, last - first);
        let messages: u32 = self.channels.values().map(|(_, count)| count).sum();
        let mut text = format!(
            "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  duration:\n    \
             nanoseconds: {duration}\n  starting_time:\n    nanoseconds_since_epoch: {first}\n  \
             message_count: {messages}\n  topics_with_message_count:\n"
        );
        for (topic, name, kind, is_latched) in &self.topics {
            let (quality, kind) = (quality(*is_latched).replace('\n', "\\n"), full_name(kind));
            let count = self.channels.get(topic).map_or(0, |(_, count)| *count);
            let _ = write!(
                text,
                "    - topic_metadata:\n        name: {name}\n        type: {kind}\n        \
                 serialization_format: cdr\n        offered_qos_profiles: \"{quality}\"\n      message_count: {count}\n"
            );
        }
        let _ = write!(
            text,
            "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - \"{file}\"\n  \
             files:\n    - path: \"{file}\"\n      starting_time:\n        nanoseconds_since_epoch: {first}\n      \
             duration:\n        nanoseconds: {duration}\n      message_count: {messages}\n"
        );
        text
    }
}

/// `sensor_msgs/Image` as ROS 2 calls it: `sensor_msgs/msg/Image`.
fn full_name(kind: &str) -> String {
    kind.replace('/', "/msg/")
}

fn refusal(out: &OutFolder, folder: &str, file: &str, error: McapError) -> Box<Diagnostic> {
    let error = match error {
        McapError::Io(error) => error,
        error => std::io::Error::other(error),
    };
    out.refusal(&format!("{folder}/{file}"), &error)
}
