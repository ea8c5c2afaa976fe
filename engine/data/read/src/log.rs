//! The log of one flight, read frame by frame through its index.

use super::damage::damaged;
use super::records::{NO_WRITER, RECORD_LIMIT};
use ::mcap::Summary;
use ::mcap::sans_io::indexed_reader::{IndexedReadEvent, IndexedReader, IndexedReaderOptions};
use ::mcap::sans_io::summary_reader::{SummaryReadEvent, SummaryReader, SummaryReaderOptions};
use cosfly_diagnose::{Diagnostic, Fault, Result, contained};
use cosfly_domain::channels::{ChannelSource, Element};
use cosfly_domain::{Channel, ChannelImage, channels};
use cosfly_frames::{DQuat, DVec3};
use cosfly_schema::log::messages::{MAP_FRAME, OPTICAL_FRAME};
use cosfly_schema::log::reading::{LoggedSensor, ReadingMessage, TOPICS};
use cosfly_schema::log::{FrameTimes, TargetStateMessage, cloud, formats, topic};
use foxglove::messages;
use prost::Message;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Encoding of all messages of our logs.
const ENCODING: &str = "protobuf";

/// Callback for the topic, time (nanoseconds) and bytes of a message; returns what is wrong with it.
pub type Visit<'a> = &'a mut dyn FnMut(&str, u64, &[u8]) -> Result<(), String>;

/// An open log.
pub struct LogReader {
    file: File,
    path: PathBuf,
    times: FrameTimes,
    summary: Summary,
    /// The channels of every frame, and those on request that the log has.
    channels: Vec<&'static Channel>,
}

/// A sweep of a lidar.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedSweep {
    /// Time of its beginning since the first frame, nanoseconds.
    pub time_ns: u64,
    /// Position of the lidar at that time in the `map` frame, metres.
    pub position: DVec3,
    /// Rotation from the lidar's axes (x ahead, y left, z up) to those of `map`.
    pub rotation: DQuat,
    /// Points in the lidar's axes, as [`cloud::CloudPoint`] reads them, with y to the left.
    pub points: Vec<[u8; cloud::POINT_BYTES]>,
}

/// Images, camera and target of one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoggedFrame {
    /// Width of all images, pixels.
    pub width: u32,
    /// Height of all images, pixels.
    pub height: u32,
    /// Colour image as a file.
    pub rgb_file: Vec<u8>,
    /// Format of the colour image: `jpeg` or `png`.
    pub rgb_format: String,
    /// Planar depth, metres, row-major; infinite for sky.
    pub depth_m: Vec<f32>,
    /// CARLA label ids, row-major.
    pub semantic: Vec<u8>,
    /// Instance ids, row-major; empty unless requested.
    pub instance: Vec<u32>,
    /// Channels on request that the log has.
    pub on_request: Vec<ChannelImage>,
    /// Position of the optical centre in the `map` frame (y is minus that of the world), metres.
    pub camera_in_map: DVec3,
    /// Rotation from the optical axes (x right, y down, z ahead) to those of `map`.
    pub map_from_optical: DQuat,
    /// State of the target.
    pub target: TargetStateMessage,
}

/// An obstacle of the logged scene, in the `map` frame.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedBox {
    /// CARLA's name of the obstacle's label, such as `Building`.
    pub label: String,
    /// Centre of the box, metres.
    pub center_in_map: DVec3,
    /// Half the size of the box along its own axes, metres.
    pub half_extents_m: DVec3,
    /// Rotation around z, counter-clockwise seen from above, radians.
    pub yaw_rad: f64,
    /// Colour: red, green, blue, 0..=1.
    pub colour: [f64; 3],
}

impl LogReader {
    /// Reads the index of the log at `path`, whose frames are `dt_s` apart.
    pub fn open(path: &Path, times: FrameTimes) -> Result<Self> {
        let (file, summary) = summary(path)?;
        let is_logged = |name: &str| summary.channels.values().any(|channel| channel.topic == name);
        let is_needed = |channel: &&Channel| !channel.is_on_request() || is_logged(&topic::images(channel));
        let channels = channels::ALL.iter().copied().filter(is_needed).collect();
        Ok(Self { file, path: path.to_owned(), times, summary, channels })
    }

    /// Sorted topics of the log.
    pub fn topics(&self) -> Vec<String> {
        let mut topics: Vec<String> = self.summary.channels.values().map(|channel| channel.topic.clone()).collect();
        topics.sort();
        topics
    }

    /// The log's channels.
    pub fn channels(&self) -> &[&'static Channel] {
        &self.channels
    }

    /// Images, camera and target of frame `frame`, without instance ids.
    pub fn frame(&mut self, frame: usize) -> Result<LoggedFrame> {
        self.read_frame(frame, |channel| channel.element() != Element::Id)
    }

    /// Images with instance ids, camera and target of frame `frame`.
    pub fn frame_with_instances(&mut self, frame: usize) -> Result<LoggedFrame> {
        let logged = self.read_frame(frame, |_| true)?;
        let is_whole = logged.instance.len() == logged.semantic.len();
        if is_whole { Ok(logged) } else { Err(self.damaged(&format!("the images of frame {frame} differ in size"))) }
    }

    fn read_frame(&mut self, frame: usize, is_wanted: impl Fn(&Channel) -> bool) -> Result<LoggedFrame> {
        let time = self.times.ns(frame);
        let mut logged = LoggedFrame::default();
        let images = self.channels.iter().filter(|channel| is_wanted(channel)).map(|channel| topic::images(channel));
        let topics: Vec<String> = images.chain([topic::TF.to_owned(), topic::TARGET_STATE.to_owned()]).collect();
        let topics: Vec<&str> = topics.iter().map(String::as_str).collect();
        let mut found = vec![false; topics.len()];
        self.messages(time..=time, &topics, &mut |topic, _, data| {
            found[topics.iter().position(|it| *it == topic).unwrap_or(0)] = true;
            logged.take(topic, data)
        })?;
        match topics.iter().zip(found).find(|(_, found)| !found) {
            Some((topic, _)) => Err(self.damaged(&format!("frame {frame} has no message on `{topic}`"))),
            None if logged.is_whole() => Ok(logged),
            None => Err(self.damaged(&format!("the images of frame {frame} differ in size"))),
        }
    }

    /// Obstacles near the flight.
    ///
    /// # Errors
    /// `dataset-damaged`, also where the log does not tell of them.
    pub fn scene(&mut self) -> Result<Vec<LoggedBox>> {
        let (mut boxes, mut is_told) = (vec![], false);
        self.messages(0..=0, &[topic::SCENE], &mut |_, _, data| {
            is_told = true;
            let update = messages::SceneUpdate::decode(data).map_err(|error| error.to_string())?;
            for entity in update.entities.iter().filter(|entity| entity.frame_id == MAP_FRAME) {
                let label = entity.id.rsplit('/').next().unwrap_or_default();
                boxes.extend(entity.cubes.iter().filter_map(|cube| LoggedBox::read(label, cube)));
            }
            Ok(())
        })?;
        if is_told { Ok(boxes) } else { Err(self.damaged(&format!("it has no message on `{}`", topic::SCENE))) }
    }

    /// Sensors that are no cameras, by name.
    pub fn sensors(&self) -> Vec<LoggedSensor> {
        let of =
            |channel: &Arc<::mcap::Channel<'static>>| LoggedSensor::of(&channel.topic, &channel.schema.as_ref()?.data);
        let mut sensors: Vec<LoggedSensor> = self.summary.channels.values().filter_map(of).collect();
        sensors.sort_by(|a, b| a.name.cmp(&b.name));
        sensors
    }

    /// All readings of a sensor: time since the first frame, nanoseconds, and numbers of its quantities.
    pub fn readings(&mut self, sensor: &LoggedSensor) -> Result<Vec<(u64, Vec<f64>)>> {
        let mut readings = vec![];
        let (name, count) = (sensor.topic_name(), sensor.quantities.len());
        self.messages(0..=u64::MAX, &[name.as_str()], &mut |_, time_ns, data| {
            let numbers = ReadingMessage::numbers(count, data).map_err(|error| error.to_string())?;
            readings.push((time_ns, numbers));
            Ok(())
        })?;
        Ok(readings)
    }

    /// Names of the lidars.
    pub fn lidars(&self) -> Vec<String> {
        let name = |channel: &Arc<::mcap::Channel<'static>>| {
            let is_cloud = channel.schema.as_ref().is_some_and(|schema| schema.name == cloud::SCHEMA);
            channel.topic.strip_prefix(TOPICS).filter(|_| is_cloud).map(str::to_owned)
        };
        let mut names: Vec<String> = self.summary.channels.values().filter_map(name).collect();
        names.sort();
        names
    }

    /// All sweeps of a lidar.
    pub fn sweeps(&mut self, lidar: &str) -> Result<Vec<LoggedSweep>> {
        let (topic, mut sweeps) = (format!("{TOPICS}{lidar}"), vec![]);
        self.messages(0..=u64::MAX, &[topic.as_str()], &mut |_, time_ns, data| {
            let cloud = messages::PointCloud::decode(data).map_err(|error| error.to_string())?;
            let pose = cloud.pose.unwrap_or_default();
            let position = pose.position.map_or(DVec3::ZERO, |it| DVec3::new(it.x, it.y, it.z));
            let rotation = pose.orientation.map_or(DQuat::IDENTITY, |it| DQuat::from_xyzw(it.x, it.y, it.z, it.w));
            let (points, rest) = cloud.data.as_chunks();
            let (number, bytes) = (sweeps.len(), cloud.data.len());
            if cloud.point_stride as usize != cloud::POINT_BYTES || !rest.is_empty() {
                return Err(format!("sweep {number} is cut: {bytes} bytes, no multiple of {}", cloud::POINT_BYTES));
            }
            if let Some(place) = points.iter().position(|point| !cloud::CloudPoint::of(point).is_finite()) {
                return Err(format!("point {place} of sweep {number} has a number that is not finite"));
            }
            sweeps.push(LoggedSweep { time_ns, position, rotation, points: points.to_vec() });
            Ok(())
        })?;
        Ok(sweeps)
    }

    /// The error of a log that is incomplete.
    pub fn damaged(&self, what: &str) -> Box<Diagnostic> {
        damaged(&self.path, what, "it was written by another program, or incompletely")
    }

    /// Calls `visit` with the messages of `topics` at the times `times_ns`, in the order of their times.
    ///
    /// # Errors
    /// `dataset-damaged`.
    pub fn messages(&mut self, times_ns: RangeInclusive<u64>, topics: &[&str], visit: Visit<'_>) -> Result<()> {
        let mut known = self.summary.channels.values().filter(|channel| topics.contains(&channel.topic.as_str()));
        if let Some(other) = known.clone().find(|channel| channel.message_encoding != ENCODING) {
            let (topic, found) = (&other.topic, &other.message_encoding);
            return Err(self.damaged(&format!("messages on `{topic}` have the encoding `{found}`, not `{ENCODING}`")));
        }
        if known.next().is_none() {
            // Without a topic that it knows, the library would read all of them.
            return Ok(());
        }
        let options = IndexedReaderOptions::new()
            .include_topics(topics.iter().copied())
            .starting_at(*times_ns.start())
            .ending_at(*times_ns.end())
            .with_record_length_limit(RECORD_LIMIT);
        let path = &self.path;
        let unreadable = |error: ::mcap::McapError| damaged(path, "a part of it cannot be read", error);
        let panicked = || damaged(path, "a part of it cannot be read", NO_WRITER);
        let bytes =
            self.file.metadata().map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?;
        let reader = contained(|| IndexedReader::new_with_options(&self.summary, options));
        let mut reader = reader.ok_or_else(panicked)?.map_err(unreadable)?;
        let mut chunk = vec![];
        while let Some(event) = contained(|| reader.next_event()).ok_or_else(panicked)? {
            match event.map_err(unreadable)? {
                IndexedReadEvent::ReadChunkRequest { offset, length } => {
                    if offset.saturating_add(length as u64) > bytes.len() {
                        return Err(damaged(path, "a part of it cannot be read", "a chunk lies beyond its end"));
                    }
                    chunk.resize(length, 0);
                    let read = self.file.seek(SeekFrom::Start(offset)).and_then(|_| self.file.read_exact(&mut chunk));
                    read.map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?;
                    let inserted = contained(|| reader.insert_chunk_record_data(offset, &chunk));
                    inserted.ok_or_else(panicked)?.map_err(unreadable)?;
                }
                IndexedReadEvent::Message { header, data } => {
                    let topic = self.summary.channels.get(&header.channel_id).map_or("", |channel| &channel.topic);
                    visit(topic, header.log_time, data).map_err(|what| {
                        let message = format!("`{}` has a message on `{topic}` that cannot be read", path.display());
                        Diagnostic::new("dataset-damaged", Fault::Input, message).because(what)
                    })?;
                }
            }
        }
        Ok(())
    }
}

/// Opens the log at `path` and reads its index.
pub(super) fn summary(path: &Path) -> Result<(File, Summary)> {
    let refused = |error: std::io::Error| Diagnostic::io(format!("read `{}`", path.display()), &error);
    let mut file = File::open(path).map_err(refused)?;
    let size = file.metadata().map_err(refused)?.len();
    let options = SummaryReaderOptions::default().with_file_size(size).with_record_length_limit(RECORD_LIMIT);
    let mut reader = SummaryReader::new_with_options(options);
    let panicked = || damaged(path, "its index cannot be read", NO_WRITER);
    while let Some(event) = contained(|| reader.next_event()).ok_or_else(panicked)? {
        match event.map_err(|error| damaged(path, "its index cannot be read", error))? {
            SummaryReadEvent::ReadRequest(wanted) => {
                let read = file.read(reader.insert(wanted)).map_err(refused)?;
                reader.notify_read(read);
            }
            SummaryReadEvent::SeekRequest(to) => reader.notify_seeked(file.seek(to).map_err(refused)?),
        }
    }
    let summary = reader.finish().ok_or_else(|| damaged(path, "it has no index", "the file was cut short"))?;
    Ok((file, summary))
}

impl LoggedFrame {
    fn take(&mut self, topic: &str, data: &[u8]) -> Result<(), String> {
        let unreadable = |error: prost::DecodeError| error.to_string();
        match topic {
            topic::TF => {
                let transforms = messages::FrameTransforms::decode(data).map_err(unreadable)?.transforms;
                (self.camera_in_map, self.map_from_optical) = camera_in_map(&transforms)?;
            }
            topic::TARGET_STATE => self.target = TargetStateMessage::decode(data).map_err(unreadable)?,
            _ => match topic::channel_of(topic) {
                Some(channel) if channel.element() == Element::Colour => {
                    let image = messages::CompressedImage::decode(data).map_err(unreadable)?;
                    (self.rgb_file, self.rgb_format) = (image.data.to_vec(), image.format);
                }
                Some(channel) => self.take_raw(channel, messages::RawImage::decode(data).map_err(unreadable)?)?,
                None => {}
            },
        }
        Ok(())
    }

    fn take_raw(&mut self, channel: &'static Channel, image: messages::RawImage) -> Result<(), String> {
        let format = formats(channel).iter().find(|format| format.encoding == image.encoding).ok_or_else(|| {
            let known: Vec<String> = formats(channel).iter().map(|format| format!("`{}`", format.encoding)).collect();
            format!("its encoding is `{}`, not {}", image.encoding, known.join(" or "))
        })?;
        match channel.source {
            ChannelSource::Depth => {
                (self.width, self.height) = (image.width, image.height);
                let (depths, _) = image.data.as_chunks::<4>();
                self.depth_m = depths.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
            }
            ChannelSource::Labels => self.semantic = image.data.to_vec(),
            ChannelSource::Ids => {
                let id = |bytes: &[u8]| bytes.iter().rev().fold(0, |id, byte| id << 8 | u32::from(*byte));
                self.instance = image.data.chunks_exact(format.pixel_bytes).map(id).collect();
            }
            ChannelSource::Colour => {}
            // On request.
            _ => {
                self.on_request.push(ChannelImage { channel, bytes: image.data.to_vec() });
            }
        }
        Ok(())
    }

    fn is_whole(&self) -> bool {
        let pixels = self.width as usize * self.height as usize;
        let has_all = |image: &ChannelImage| image.bytes.len() == image.channel.bytes_on_request() * pixels;
        pixels > 0
            && self.depth_m.len() == pixels
            && self.semantic.len() == pixels
            && self.on_request.iter().all(has_all)
    }
}

/// Pose of the optical frame in the `map` frame, through all frames in between.
fn camera_in_map(transforms: &[messages::FrameTransform]) -> Result<(DVec3, DQuat), String> {
    let (mut place, mut turn, mut frame) = (DVec3::ZERO, DQuat::IDENTITY, OPTICAL_FRAME);
    // A chain is never longer than the list, which excludes cycles.
    for _ in transforms {
        let Some(next) = transforms.iter().find(|it| it.child_frame_id == frame) else { break };
        let (Some(t), Some(r)) = (&next.translation, &next.rotation) else {
            return Err("a transform is incomplete".into());
        };
        let rotation = DQuat::from_xyzw(r.x, r.y, r.z, r.w);
        (place, turn) = (DVec3::new(t.x, t.y, t.z) + rotation * place, rotation * turn);
        frame = &next.parent_frame_id;
    }
    let sound = frame == MAP_FRAME && place.is_finite() && turn.is_finite();
    if sound { Ok((place, turn)) } else { Err(format!("`{OPTICAL_FRAME}` is not connected to `{MAP_FRAME}`")) }
}

impl LoggedBox {
    fn read(label: &str, cube: &messages::CubePrimitive) -> Option<Self> {
        let (pose, size, colour) = (cube.pose.as_ref()?, cube.size.as_ref()?, cube.color.as_ref()?);
        let (p, q) = (pose.position.as_ref()?, pose.orientation.as_ref()?);
        let ahead = DQuat::from_xyzw(q.x, q.y, q.z, q.w) * DVec3::X;
        let scene_box = Self {
            label: label.to_owned(),
            center_in_map: DVec3::new(p.x, p.y, p.z),
            half_extents_m: 0.5 * DVec3::new(size.x, size.y, size.z),
            yaw_rad: cosfly_frames::real::atan2(ahead.y, ahead.x),
            colour: [colour.r, colour.g, colour.b],
        };
        (scene_box.center_in_map.is_finite() && scene_box.half_extents_m.is_finite()).then_some(scene_box)
    }
}
