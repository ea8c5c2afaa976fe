//! The log of one flight: its own checksums, then its messages against the rows of the tables.

use super::body::Body;
use super::people::PersonRow;
use super::report::VerifyReport;
use super::rows::{PlacedFlight, PlacedFrame};
use ::mcap::records::Record;
use cosfly_frames::{DQuat, DVec3};
use cosfly_maps::SemanticLabel;
use cosfly_read::read_records;
use cosfly_render::frame::TARGET_INSTANCE;
use cosfly_schema::log::{TargetStateMessage, frame_time_ns, right_handed, topic};
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
/// Topics with a message at every frame.
const PER_FRAME: [&str; 10] = [
    topic::RGB,
    topic::CAMERA,
    topic::ANNOTATIONS,
    topic::DEPTH,
    topic::SEMANTIC,
    topic::INSTANCE,
    topic::TF,
    topic::DRONE_POSE,
    topic::TARGET_POSE,
    topic::TARGET_STATE,
];

/// Rows of tables about a flight, beside its frames.
pub struct Known<'a> {
    /// Language and text of its captions.
    pub captions: &'a [(String, String)],
    /// Instance ids of the town's objects.
    pub objects: Option<&'a BTreeSet<u32>>,
    /// People seen beside the target, by frame.
    pub others: &'a [PersonRow],
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
        counts: BTreeMap::new(),
        messages: 0,
        instance: None,
        is_ours: false,
    };
    if let Err(message) = read_records(&mut BufReader::new(input), &mut |record| log.record(record)) {
        log.report.find(file, "", "verify-crc", message);
        return;
    }
    log.finish();
}

struct LogCheck<'a> {
    flight: &'a PlacedFlight,
    frames: &'a [PlacedFrame],
    known: &'a Known<'a>,
    report: &'a mut VerifyReport,
    topics: BTreeMap<u16, String>,
    counts: BTreeMap<String, usize>,
    messages: u64,
    /// Pixels of the target at the frame being read.
    instance: Option<(usize, Vec<usize>)>,
    is_ours: bool,
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
            if !self.known.captions.iter().any(|caption| caption.1 == text) {
                self.find(format!("caption {frame}"), "verify-caption", "table `captions` does not have it".into());
            }
            return;
        }
        let frames = self.frames;
        let (Some(row), true) = (frames.get(frame), PER_FRAME.contains(&topic)) else { return };
        let place = format!("`{topic}` frame {frame}");
        if time_ns != frame_time_ns(self.flight.dt_s, frame) {
            self.find(place.clone(), "verify-time", format!("it is at {time_ns} ns"));
        }
        let problem = match topic {
            topic::DRONE_POSE => pose_problem(data, row),
            topic::TARGET_STATE => state_problem(data, row),
            topic::CAMERA => self.camera_problem(data),
            topic::TF => camera_turn_problem(data, row),
            topic::INSTANCE => self.instance_problem(frame, data, row),
            topic::SEMANTIC | topic::DEPTH => None,
            _ => None,
        };
        if let Some(message) = problem {
            self.find(place.clone(), "verify-log", message);
        }
        if [topic::SEMANTIC, topic::DEPTH].contains(&topic) {
            self.keep_or_check_pixels(topic, frame, data, row, place);
        }
    }

    fn camera_problem(&self, data: &[u8]) -> Option<String> {
        let Ok(calibration) = messages::CameraCalibration::decode(data) else { return Some(UNREADABLE.into()) };
        let camera = &self.flight.camera;
        let same = (calibration.width, calibration.height) == (camera.width, camera.height)
            && calibration.k.first().is_some_and(|focal| (focal - camera.focal_px()).abs() < 1e-6 * focal)
            && calibration.d.get(..2) == Some(&[self.flight.lens.k1, self.flight.lens.k2]);
        (!same).then(|| "size, focal length or distortion differ from table `trajectories`".into())
    }

    /// The pixels of the target and of others in the instance image against counts and boxes of the tables; no other
    /// ids than those of objects.
    fn instance_problem(&mut self, frame: usize, data: &[u8], row: &PlacedFrame) -> Option<String> {
        let Some(image) = self.image(data) else { return Some(UNREADABLE.into()) };
        let bytes = if image.encoding == "32UC1" { 4 } else { 2 };
        let width = self.flight.camera.width as usize;
        let ids: Vec<u32> = image
            .data
            .chunks_exact(bytes)
            .map(|id| id.iter().rev().fold(0u32, |sum, byte| sum << 8 | u32::from(*byte)))
            .collect();
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
        self.instance = Some((frame, of_target));
        let others = self.known.others;
        let first = others.partition_point(|person| person.frame < row.frame);
        for person in others[first..].iter().take_while(|person| person.frame == row.frame) {
            let seen = pixels.remove(&person.instance).unwrap_or_default();
            let (count, found) = (seen.len() as u32, edges(&seen, width));
            if (count, found) != (person.pixels, Some(person.visible_box)) {
                return Some(format!(
                    "{count} pixels of id {} in {found:?}; table `people` says {} in {:?}",
                    person.instance, person.pixels, person.visible_box
                ));
            }
        }
        if let Some((id, seen)) = pixels.first_key_value() {
            let count = seen.len();
            return Some(format!("{count} pixels have the id {id}, which is neither in `objects` nor in `people`"));
        }
        (count != row.visible_pixels || found != row.visible_box()).then(|| {
            format!(
                "{count} pixels of the target in {found:?}; table `frames` says {} in {:?}",
                row.visible_pixels,
                row.visible_box()
            )
        })
    }

    /// Labels and depths of the target's pixels. Instance images come first at every frame but labels, which
    /// come before, are compared by their own count.
    fn keep_or_check_pixels(&mut self, topic: &str, frame: usize, data: &[u8], row: &PlacedFrame, place: String) {
        let Some(image) = self.image(data) else {
            self.find(place, "verify-log", UNREADABLE.into());
            return;
        };
        if topic == topic::SEMANTIC {
            let last = SemanticLabel::ALL.len() as u8;
            let people = image.data.iter().filter(|label| **label == SemanticLabel::Pedestrian.id()).count();
            if image.data.iter().any(|label| *label >= last) || people < row.visible_pixels as usize {
                self.find(place, "verify-pixels", "labels are unknown, or too few of them are pedestrian".into());
            }
            return;
        }
        let Some((_, pixels)) = self.instance.take().filter(|(of, _)| *of == frame) else { return };
        let body = Body {
            feet: row.target.feet_in_world,
            height_m: self.flight.target_height_m,
            radius_m: self.flight.target_radius_m,
        };
        let (near, far) = body.depths_m(&row.camera_pose);
        let depth = |at: usize| {
            image
                .data
                .get(4 * at..4 * at + 4)
                .map(|it| f64::from(f32::from_le_bytes(it.try_into().expect("four bytes"))))
        };
        let wrong = pixels
            .iter()
            .filter_map(|at| depth(*at))
            .find(|d| !(near - DEPTH_SLACK_M..=far + DEPTH_SLACK_M).contains(d));
        if let Some(depth_m) = wrong {
            let message =
                format!("a pixel of the target is {depth_m} m deep; its body lies between {near:.3} and {far:.3} m");
            self.find(place, "verify-depth", message);
        }
    }

    /// A raw image of the flight's size with all its bytes.
    fn image(&self, data: &[u8]) -> Option<messages::RawImage> {
        let image = messages::RawImage::decode(data).ok()?;
        let bytes = match image.encoding.as_str() {
            "mono8" => 1,
            "16UC1" => 2,
            "32FC1" | "32UC1" => 4,
            _ => return None,
        };
        let camera = &self.flight.camera;
        let fits = (image.width, image.height) == (camera.width, camera.height)
            && image.data.len() == bytes * camera.width as usize * camera.height as usize;
        fits.then_some(image)
    }

    fn finish(mut self) {
        if !self.is_ours {
            self.find(String::new(), "verify-log", format!("it is not the log of `{}`", self.flight.trajectory_id));
        }
        for topic in PER_FRAME {
            let count = self.counts.get(topic).copied().unwrap_or(0);
            if count != self.frames.len() {
                self.find(
                    format!("`{topic}`"),
                    "verify-count",
                    format!("{count} messages for {} frames", self.frames.len()),
                );
            }
        }
        let captions = self.counts.get(topic::CAPTIONS).copied().unwrap_or(0);
        if captions != self.known.captions.len() {
            let message = format!("{captions} captions; table `captions` has {}", self.known.captions.len());
            self.find(format!("`{}`", topic::CAPTIONS), "verify-count", message);
        }
        if self.messages != self.flight.mcap_messages {
            let message =
                format!("{} messages; table `trajectories` says {}", self.messages, self.flight.mcap_messages);
            self.find(String::new(), "verify-count", message);
        }
    }
}

const UNREADABLE: &str = "the message cannot be read or has another size";

/// Edges around pixels of an image that is `width` wide.
fn edges(pixels: &[usize], width: usize) -> Option<[f64; 4]> {
    let columns = || pixels.iter().map(|at| at % width);
    let rows = || pixels.iter().map(|at| at / width);
    let (left, top) = (columns().min()?, rows().min()?);
    let (right, bottom) = (columns().max()? + 1, rows().max()? + 1);
    Some([left as f64, top as f64, right as f64, bottom as f64])
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
    let rotation = |child: &str| {
        let found = transforms.transforms.iter().find(|it| it.child_frame_id == child)?.rotation.as_ref()?;
        Some(DQuat::from_xyzw(found.x, found.y, found.z, found.w))
    };
    let (Some(drone), Some(camera)) = (rotation("drone"), rotation("camera_optical")) else {
        return Some("the transforms do not lead from the map to the camera".into());
    };
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
