//! The log of one flight: its own checksums, then its messages against the rows of the tables.

use super::body::{Body, PlacedBody};
use super::captions::Caption;
use super::film::{Film, readout_of};
use super::flow::Carrier;
use super::ground::BodiesOnGround;
use super::on_request::{KnownFrame, OnRequest, edges};
use super::report::VerifyReport;
use super::rows::{PlacedFlight, PlacedFrame};
use ::mcap::records::Record;
use cosfly_diagnose::{Stop, counted};
use cosfly_domain::channels::{ChannelSource, Element, depth, flow};
use cosfly_domain::{BodyKind, Channel, ChannelSet, SemanticLabel, TARGET_INSTANCE, channels};
use cosfly_frames::{DQuat, DVec3};
use cosfly_optics::{READOUT_KEYS, ReadoutStrips};
use cosfly_read::read_records;
use cosfly_schema::log::messages::shift_px;
use cosfly_schema::log::{BODIES_3D_ROWS, Frequency, TargetStateMessage, formats, right_handed, topic, topics};
use foxglove::messages;
use prost::Message;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Poses pass through quaternions on their way to the log.
const POSE_TOLERANCE: f64 = 1e-6;
/// Half the depth grid, and rounding of 32-bit floats at some hundred metres.
const DEPTH_SLACK_M: f64 = 1e-3;
/// Rows of tables about a flight, beside its frames.
pub struct Known<'a> {
    /// Its captions.
    pub captions: &'a [Caption],
    /// Instance ids of the town's objects.
    pub objects: Option<&'a BTreeSet<u32>>,
    /// Bodies around the target, by frame.
    pub others: &'a [PlacedBody],
    /// Number of its rows in table `bodies_3d`.
    pub boxes: usize,
    /// Ends the check.
    pub stop: &'a Stop,
}

impl<'a> Known<'a> {
    /// The bodies of a frame.
    fn others_in(&self, frame: u32) -> &'a [PlacedBody] {
        let first = self.others.partition_point(|body| body.frame < frame);
        let end = self.others.partition_point(|body| body.frame <= frame);
        self.others.get(first..end).unwrap_or_default()
    }
}

/// Checks the log of `flight`.
pub fn check(
    folder: &Path,
    flight: &PlacedFlight,
    frames: &[PlacedFrame],
    known: &Known<'_>,
    report: &mut VerifyReport,
) {
    let file = &flight.mcap_path;
    let Ok(input) = File::open(folder.join(file)) else { return };
    let mut log = LogCheck {
        flight,
        frames,
        known,
        report,
        topics: BTreeMap::new(),
        at_every_frame: at_every_frame(),
        counts: BTreeMap::new(),
        messages: 0,
        depth: None,
        labels: None,
        on_ground: BodiesOnGround::default(),
        on_request: OnRequest::default(),
        is_ours: false,
        readout: (flight.readout_s == 0.0).then(ReadoutStrips::at_once),
    };
    let mut input = known.stop.reading(BufReader::new(input));
    if let Err(damage) = read_records(&mut input, &mut |record| log.record(record)) {
        log.report.find(file, "", "verify-crc", damage.to_string());
        return;
    }
    log.finish();
}

fn at_every_frame() -> BTreeSet<String> {
    let topics = topics(&ChannelSet::default());
    topics.into_iter().filter(|topic| topic.frequency == Frequency::EveryFrame).map(|topic| topic.name).collect()
}

struct LogCheck<'a> {
    flight: &'a PlacedFlight,
    frames: &'a [PlacedFrame],
    known: &'a Known<'a>,
    report: &'a mut VerifyReport,
    topics: BTreeMap<u16, String>,
    /// Topics with a message at every frame of every log.
    at_every_frame: BTreeSet<String>,
    counts: BTreeMap<String, usize>,
    messages: u64,
    /// The last depth image and its frame, kept until the ids of the same frame say which pixels are the target's.
    depth: Option<(usize, messages::RawImage)>,
    /// The last label image and its frame, likewise.
    labels: Option<(usize, messages::RawImage)>,
    on_ground: BodiesOnGround,
    /// References for the other pictures of the last frame.
    on_request: OnRequest,
    is_ours: bool,
    /// Strips of its pictures; none where they are unknown.
    readout: Option<ReadoutStrips>,
}

impl LogCheck<'_> {
    fn find(&mut self, place: String, rule: &'static str, message: String) {
        self.report.find(&self.flight.mcap_path, place, rule, message);
    }

    fn record(&mut self, record: Record<'_>) {
        match record {
            Record::Channel(channel) => {
                self.topics.insert(channel.id, channel.topic);
            }
            Record::Metadata(metadata) if metadata.name == "cosfly.trajectory" => {
                self.is_ours = metadata.metadata.get("trajectory_id") == Some(&self.flight.trajectory_id);
                let boxes = metadata.metadata.get(BODIES_3D_ROWS);
                if let Some(boxes) = boxes.filter(|boxes| **boxes != self.known.boxes.to_string()) {
                    let message = format!(
                        "it had {boxes} in table `bodies_3d`; there are {}",
                        self.known.boxes,
                        boxes = counted(boxes, "row")
                    );
                    self.find(String::new(), "verify-3d", message);
                }
            }
            Record::Metadata(metadata) if metadata.name == "cosfly.camera" => {
                let text = |key: &str| metadata.metadata.get(key).map(String::as_str);
                let [ends, offsets] = READOUT_KEYS.map(text);
                match readout_of(self.flight, ends, offsets) {
                    Ok(readout) => self.readout = readout,
                    Err(message) => self.find(String::new(), "verify-camera", message),
                }
            }
            Record::Message { header, data } => {
                let topic = self.topics.get(&header.channel_id).cloned().unwrap_or_default();
                self.messages += 1;
                let count = self.counts.entry(topic.clone()).or_default();
                let frame = *count;
                *count += 1;
                self.message(&topic, frame, header.log_time, &data);
            }
            _ => {}
        }
    }

    fn message(&mut self, topic: &str, frame: usize, time_ns: u64, data: &[u8]) {
        if topic == topic::CAPTIONS {
            let text = messages::Log::decode(data).map(|log| log.message).unwrap_or_default();
            if !self.known.captions.iter().any(|caption| caption.is(&text)) {
                self.find(format!("caption {frame}"), "verify-caption", "table `captions` does not have it".into());
            }
            return;
        }
        let (frames, channel) = (self.frames, topic::channel_of(topic));
        let is_at_every_frame = channel.is_some() || self.at_every_frame.contains(topic);
        let (Some(row), true) = (frames.get(frame), is_at_every_frame) else { return };
        let place = format!("`{topic}` frame {frame}");
        if time_ns != self.flight.times().ns(frame) {
            self.find(place.clone(), "verify-time", format!("it is at {time_ns} ns"));
        }
        let problem = match topic {
            topic::DRONE_POSE => pose_problem(data, row),
            topic::TARGET_STATE => state_problem(data, row),
            topic::CAMERA => self.camera_problem(data),
            topic::TF => camera_turn_problem(data, row),
            _ => None,
        };
        if let Some(message) = problem {
            self.find(place, "verify-log", message);
        } else if let Some(channel) = channel.filter(|channel| channel.element() != Element::Colour) {
            match self.image(channel, data) {
                Some(image) => self.check_pixels(channel, frame, image, row, place),
                None => self.find(place, "verify-log", UNREADABLE.into()),
            }
        }
    }

    /// The pixels of a raw image against the tables, or each on its own where tables say nothing of the channel.
    fn check_pixels(
        &mut self,
        channel: &Channel,
        frame: usize,
        image: messages::RawImage,
        row: &PlacedFrame,
        place: String,
    ) {
        match channel.source {
            ChannelSource::Ids => {
                let ids = ids_of(&image);
                let (of_target, problem) = self.bodies_in(&ids, row);
                if let Some(message) = problem {
                    self.find(place, "verify-log", message);
                }
                let labels = self.labels.take().filter(|(of, _)| *of == frame);
                if let Some((_, depth)) = self.depth.take().filter(|(of, _)| *of == frame) {
                    self.check_depth(&depth, &of_target, frame);
                    if let Some((_, labels)) = &labels {
                        let pixels = [&depth.data[..], &labels.data[..]];
                        self.on_ground.add(self.flight, row, self.known.others_in(row.frame), pixels);
                    }
                    self.begin_others(frame, (&depth, labels.as_ref().map(|(_, it)| &it.data[..])), &ids, of_target);
                }
            }
            ChannelSource::Labels => {
                self.check_labels(&image, row, place);
                self.labels = Some((frame, image));
            }
            ChannelSource::Depth => self.depth = Some((frame, image)),
            ChannelSource::Colour => {}
            // On request.
            _ => {
                let mut pixels = image.data.chunks_exact(channel.bytes_on_request());
                if let Some(at) = pixels.position(|pixel| !(channel.is_value)(pixel)) {
                    self.find(place, "verify-pixels", format!("pixel {at} holds no value of `{}`", channel.name));
                } else {
                    let (readout, width) = (self.readout.as_ref(), image.width as usize);
                    let film = Film { flight: self.flight, frames: self.frames, others: self.known.others, readout };
                    if let Some((rule, message)) = self.on_request.finding(film, (frame, channel), &image.data, width) {
                        self.find(place, rule, message);
                    }
                }
            }
        }
    }

    /// Goes on to a frame: what its pictures on request are compared with.
    fn begin_others(
        &mut self,
        frame: usize,
        (depth, labels): (&messages::RawImage, Option<&[u8]>),
        ids: &[u32],
        of_target: Vec<usize>,
    ) {
        let is_flow =
            |channel: &&&Channel| matches!(channel.source, ChannelSource::Flow(_) | ChannelSource::FlowValid(_));
        let is_logged = |channel: &Channel| self.topics.values().any(|topic| *topic == topic::images(channel));
        let objects = self.known.objects;
        let has_flow = objects.is_some() && channels::ALL.iter().filter(is_flow).any(|channel| is_logged(channel));
        let stands = |id: u32| id == 0 || objects.is_some_and(|ids| ids.contains(&id));
        let (kind_of_target, others) =
            (self.flight.target_kind.as_deref(), self.known.others_in(self.frames[frame].frame));
        let carries = |id: u32| {
            let kind = match id {
                TARGET_INSTANCE => BodyKind::ON_THE_GROUND.iter().copied().find(|it| Some(it.name()) == kind_of_target),
                _ => others.iter().find(|body| body.instance == Some(id)).and_then(|body| body.kind),
            }?;
            Some(if kind.is_person() { Carrier::Limbs } else { Carrier::Rigid })
        };
        let known = KnownFrame {
            carries: &carries,
            frame,
            depths: &depth.data,
            labels,
            ids,
            of_target,
            has_flow,
            stands: &stands,
        };
        if let Some(message) = self.on_request.begin(self.flight, &self.frames[frame], known) {
            let place = format!("`{}` frame {}", topic::images(&flow::FORWARD_VALID), frame.saturating_sub(1));
            self.find(place, "verify-flow", message);
        }
    }

    fn camera_problem(&self, data: &[u8]) -> Option<String> {
        let Ok(calibration) = messages::CameraCalibration::decode(data) else { return Some(UNREADABLE.into()) };
        let camera = &self.flight.camera;
        let same = (calibration.width, calibration.height) == (camera.width, camera.height)
            && calibration.k.first().is_some_and(|focal| (focal - camera.focal_px()).abs() < 1e-6 * focal)
            && calibration.distortion_model == self.flight.lens.model.ros_name()
            && calibration.d == self.flight.lens.coefficients()
            && calibration
                .p
                .get(3)
                .is_some_and(|px| (px - shift_px(camera.focal_px(), &self.flight.mount)).abs() < 1e-6);
        (!same).then(|| "size, focal length, distortion or base line differ from table `trajectories`".into())
    }

    /// The target's pixels in the instance image; and what is wrong with them or with those of others against counts and
    /// boxes of the tables, or ids that are of no object.
    fn bodies_in(&self, ids: &[u32], row: &PlacedFrame) -> (Vec<usize>, Option<String>) {
        let width = self.flight.camera.width as usize;
        let mut pixels: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        let mut start = 0;
        for run in ids.chunk_by(|a, b| a == b) {
            let id = run[0];
            if id != 0 && !self.known.objects.is_some_and(|ids| ids.contains(&id)) {
                pixels.entry(run[0]).or_default().extend(start..start + run.len());
            }
            start += run.len();
        }
        let of_target = pixels.remove(&TARGET_INSTANCE).unwrap_or_default();
        let (count, found) = (of_target.len() as u32, edges(&of_target, width));
        for body in self.known.others_in(row.frame) {
            let Some(instance) = body.instance else { continue };
            let seen = pixels.remove(&instance).unwrap_or_default();
            let (count, found) = (seen.len() as u32, edges(&seen, width));
            if (count, found) != (body.pixels, body.visible_box) {
                let message = format!(
                    "{count} of id {instance} in {found:?}; table `bodies` says {} in {:?}",
                    body.pixels,
                    body.visible_box,
                    count = counted(count, "pixel")
                );
                return (of_target, Some(message));
            }
        }
        if let Some((id, seen)) = pixels.first_key_value() {
            let count = seen.len();
            let message = format!("id {id}, of {}, is neither in `objects` nor in `bodies`", counted(count, "pixel"));
            return (of_target, Some(message));
        }
        let problem = (count != row.visible_pixels || found != row.visible_box()).then(|| {
            format!(
                "{count} of the target in {found:?}; table `frames` says {} in {:?}",
                row.visible_pixels,
                row.visible_box(),
                count = counted(count, "pixel")
            )
        });
        (of_target, problem)
    }

    /// Labels by their number alone: they come before the ids, which say whose pixels are whose.
    fn check_labels(&mut self, image: &messages::RawImage, row: &PlacedFrame, place: String) {
        let mut pixels = [0u32; 256];
        for label in &image.data {
            pixels[usize::from(*label)] += 1;
        }
        // People, riders, vehicles, and what people take along: whatever may be followed.
        let moving = usize::from(SemanticLabel::Pedestrian.id())..=usize::from(SemanticLabel::Bicycle.id());
        let bodies = pixels[moving].iter().sum::<u32>() + pixels[usize::from(SemanticLabel::Dynamic.id())];
        if pixels[SemanticLabel::ALL.len()..].iter().any(|count| *count > 0) || bodies < row.visible_pixels {
            self.find(
                place,
                "verify-pixels",
                "labels are unknown, or too few of them are of people and vehicles".into(),
            );
        }
    }

    /// Depths of the target's pixels against the space that its body may fill.
    fn check_depth(&mut self, image: &messages::RawImage, of_target: &[usize], frame: usize) {
        let film = Film {
            flight: self.flight,
            frames: self.frames,
            others: self.known.others,
            readout: self.readout.as_ref(),
        };
        // Rows of a rolling shutter see the body from other poses than the frame's.
        let row = &self.frames[frame];
        let body = Body::of_target(self.flight, row);
        let reach = |offset_s: &f64| {
            let (pose, state) = (film.pose(frame, *offset_s)?, film.body(TARGET_INSTANCE, frame, *offset_s)?);
            Some(Body { feet: state.0, ..body.clone() }.depths_m(self.flight, &pose))
        };
        let Some(reaches) = film.readout.and_then(|it| it.offsets_s.iter().map(reach).collect::<Option<Vec<_>>>())
        else {
            return;
        };
        let is_beyond = |(at, depth_m): &(usize, f64)| {
            let reach = film.strip_of(*at).and_then(|strip| reaches.get(strip));
            reach.is_some_and(|(near, far)| !(near - DEPTH_SLACK_M..=far + DEPTH_SLACK_M).contains(depth_m))
        };
        let depth_m = |at: usize| {
            image
                .data
                .get(4 * at..4 * at + 4)
                .map(|it| f64::from(f32::from_le_bytes(it.try_into().expect("four bytes"))))
        };
        let wrong = of_target.iter().filter_map(|at| Some((*at, depth_m(*at)?))).find(is_beyond);
        if let Some((at, depth_m)) = wrong {
            let (near, far) = film.strip_of(at).map_or((0.0, 0.0), |strip| reaches[strip]);
            let message =
                format!("a pixel of the target is {depth_m} m deep; its body lies between {near:.3} and {far:.3} m");
            self.find(format!("`{}` frame {}", topic::images(&depth::CHANNEL), row.frame), "verify-depth", message);
        }
    }

    /// A raw image of the channel with the flight's size and all its bytes.
    fn image(&self, channel: &Channel, data: &[u8]) -> Option<messages::RawImage> {
        let image = messages::RawImage::decode(data).ok()?;
        let format = formats(channel).iter().find(|format| format.encoding == image.encoding)?;
        let camera = &self.flight.camera;
        let fits = (image.width, image.height) == (camera.width, camera.height)
            && image.data.len() == format.pixel_bytes * camera.width as usize * camera.height as usize;
        fits.then_some(image)
    }

    fn finish(mut self) {
        for (place, message) in self.on_ground.problems().collect::<Vec<_>>() {
            self.find(place, "verify-ground", message);
        }
        if !self.is_ours {
            self.find(String::new(), "verify-log", format!("it is not the log of `{}`", self.flight.trajectory_id));
        }
        let declared = |channel: &&Channel| self.topics.values().any(|topic| *topic == topic::images(channel));
        let on_request = channels::ALL.iter().copied().filter(|channel| channel.is_on_request()).filter(declared);
        let on_request: Vec<String> = on_request.map(topic::images).collect();
        for topic in self.at_every_frame.clone().iter().chain(&on_request) {
            let count = self.counts.get(topic).copied().unwrap_or(0);
            if count != self.frames.len() {
                self.find(
                    format!("`{topic}`"),
                    "verify-count",
                    format!("{count} for {}", counted(self.frames.len(), "frame"), count = counted(count, "message")),
                );
            }
        }
        let captions = self.counts.get(topic::CAPTIONS).copied().unwrap_or(0);
        if captions != self.known.captions.len() {
            let message = format!("{captions} captions; table `captions` has {}", self.known.captions.len());
            self.find(format!("`{}`", topic::CAPTIONS), "verify-count", message);
        }
        if self.messages != self.flight.mcap_messages {
            let message = format!(
                "{}; table `trajectories` says {}",
                counted(self.messages, "message"),
                self.flight.mcap_messages
            );
            self.find(String::new(), "verify-count", message);
        }
    }
}

const UNREADABLE: &str = "the message cannot be read or has another size";

/// Instance ids of an image.
fn ids_of(image: &messages::RawImage) -> Vec<u32> {
    match image.encoding == "32UC1" {
        true => image.data.as_chunks().0.iter().map(|id| u32::from_le_bytes(*id)).collect(),
        false => image.data.as_chunks().0.iter().map(|id| u16::from_le_bytes(*id).into()).collect(),
    }
}

fn pose_problem(data: &[u8], row: &PlacedFrame) -> Option<String> {
    let pose = messages::PoseInFrame::decode(data).ok().and_then(|it| it.pose);
    let Some((Some(p), Some(q))) = pose.map(|pose| (pose.position, pose.orientation)) else {
        return Some(UNREADABLE.into());
    };
    let logged = right_handed::world_pose_from_map(DVec3::new(p.x, p.y, p.z), DQuat::from_xyzw(q.x, q.y, q.z, q.w));
    let apart = (logged.position_in_world - row.pose.position_in_world).length();
    let (a, b) = (logged.world_from_body(), row.pose.world_from_body());
    let turned = (a.x_axis - b.x_axis).length().max((a.y_axis - b.y_axis).length());
    let same = apart <= POSE_TOLERANCE && turned <= POSE_TOLERANCE;
    (!same).then(|| format!("the pose is {apart:.6} m and {turned:.6} rad from that of table `frames`"))
}

/// The chain of transforms from the map to the camera is the stored pose of the camera.
fn camera_turn_problem(data: &[u8], row: &PlacedFrame) -> Option<String> {
    let Ok(transforms) = messages::FrameTransforms::decode(data) else { return Some(UNREADABLE.into()) };
    let placed = |child: &str| {
        let found = transforms.transforms.iter().find(|it| it.child_frame_id == child)?;
        let (place, turn) = (found.translation.as_ref()?, found.rotation.as_ref()?);
        Some((DVec3::new(place.x, place.y, place.z), DQuat::from_xyzw(turn.x, turn.y, turn.z, turn.w)))
    };
    let (Some((drone_in_map, drone)), Some((place, camera))) = (placed("drone"), placed("camera_optical")) else {
        return Some("the transforms do not lead from the map to the camera".into());
    };
    let camera_in_world = right_handed::map_from_world_point(drone_in_map + drone * place);
    let off_m = (camera_in_world - row.camera_pose.position_in_world).length();
    if off_m.is_nan() || off_m > POSE_TOLERANCE {
        return Some(format!("the camera is {off_m:.6} m from its place in table `frames`"));
    }
    let ahead = right_handed::map_from_world_point(drone * camera * DVec3::Z);
    let right = right_handed::map_from_world_point(drone * camera * DVec3::X);
    let stored = row.camera_pose.world_from_body();
    let apart = (ahead - stored.x_axis).length().max((right - stored.y_axis).length());
    let same = apart <= POSE_TOLERANCE;
    (!same).then(|| format!("the camera is turned {apart:.6} rad against table `frames`"))
}

fn state_problem(data: &[u8], row: &PlacedFrame) -> Option<String> {
    let Ok(state) = TargetStateMessage::decode(data) else { return Some(UNREADABLE.into()) };
    let feet = right_handed::map_from_world_point(DVec3::new(state.feet_x_m, state.feet_y_m, state.feet_z_m));
    let same = state.frame == row.frame
        && (feet - row.target.feet_in_world).length() <= POSE_TOLERANCE
        && state.visible_pixels == row.visible_pixels
        && [state.visible_by_rays, state.visible_by_pixels] == [row.visible_by_rays, row.visible_by_pixels];
    (!same).then(|| "frame, feet or visibility differ from table `frames`".into())
}
