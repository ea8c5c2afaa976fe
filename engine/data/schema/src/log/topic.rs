//! Topics of a log: two for each channel (images, previews), and the other topics.

use super::raw_format::formats;
use super::{flown_step, own_message, target_state};
use cosfly_domain::channels::Element;
use cosfly_domain::{Channel, ChannelSet, channels};
use foxglove::{Encode, Schema, messages};

/// Calibration of all images.
pub const CAMERA: &str = "/camera/rgb/camera_info";
/// Boxes of the target and of bystanders.
pub const ANNOTATIONS: &str = "/camera/rgb/annotations";
/// Transforms between `map`, drone, camera and target.
pub const TF: &str = "/tf";
/// Pose of the drone.
pub const DRONE_POSE: &str = "/drone/pose";
/// Pose of the target's feet.
pub const TARGET_POSE: &str = "/target/pose";
/// Trajectory of the drone.
pub const DRONE_PATH: &str = "/drone/path";
/// The whole walk.
pub const TARGET_PATH: &str = "/target/path";
/// Obstacles near the flight, and the target.
pub const SCENE: &str = "/scene";
/// Captions.
pub const CAPTIONS: &str = "/captions";
/// State of the target.
pub const TARGET_STATE: &str = "/target/state";

/// Action and outcome of each step of a closed-loop flight.
pub const STEP: &str = "/flight/step";
/// Inertial unit.
pub const INERTIAL: &str = "/imu";
/// Barometer.
pub const BAROMETER: &str = "/barometer";
/// Satellite receiver.
pub const FIX: &str = "/gnss";
/// Events of a closed-loop flight.
pub const EVENTS: &str = "/flight/events";

/// Topic of a channel's images.
pub fn images(channel: &Channel) -> String {
    format!("/camera/{}/image", channel.name)
}

/// Topic of a channel's previews.
pub fn previews(channel: &Channel) -> String {
    format!("/camera/{}/preview", channel.name)
}

/// Channel whose images are on `topic`.
pub fn channel_of(topic: &str) -> Option<&'static Channel> {
    let name = topic.strip_prefix("/camera/")?.strip_suffix("/image")?;
    channels::called(name)
}

/// Frequency of a topic's messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frequency {
    /// At every frame.
    EveryFrame,
    /// At every frame of logs with previews.
    Previews,
    /// At time 0.
    Once,
    /// At time 0, one message for each caption.
    Captions,
    /// At every reading of a sensor.
    Readings,
}

/// A topic of a log.
#[derive(Clone, Debug)]
pub struct Topic {
    /// Name of the topic.
    pub name: String,
    /// Schema, then meaning of the messages.
    pub doc: String,
    /// Schema of the messages.
    pub schema: Schema,
    /// Keys and texts that a log contains for the topic.
    pub notes: &'static [(&'static str, &'static str)],
    /// Frequency of the messages.
    pub frequency: Frequency,
}

impl Topic {
    pub(super) fn new<M: Encode>(name: impl Into<String>, doc: &str, frequency: Frequency) -> Self {
        let schema = M::get_schema().expect("every Foxglove message has a schema");
        let doc = format!("`{}`{doc}", schema.name);
        Self { name: name.into(), doc, schema, notes: &[], frequency }
    }
}

/// All topics of a log with these channels, in the order of their declaration in logs. Raw images come first: their
/// numbers are in frame packs.
pub fn topics(channels: &ChannelSet) -> Vec<Topic> {
    let is_raw = |channel: &&Channel| channel.element() != Element::Colour;
    let mut topics: Vec<Topic> = channels.iter().filter(is_raw).map(raw_images).collect();
    for channel in channels.iter().filter(|channel| !is_raw(channel)) {
        let doc = format!(": {}", channel.doc);
        topics.push(Topic::new::<messages::CompressedImage>(images(channel), &doc, Frequency::EveryFrame));
    }
    topics.push(Topic::new::<messages::CameraCalibration>(CAMERA, " of all images.", Frequency::EveryFrame));
    let boxes = ": boxes of the target and of other people.";
    topics.push(Topic::new::<messages::ImageAnnotations>(ANNOTATIONS, boxes, Frequency::EveryFrame));
    for channel in channels.iter() {
        if let Some(doc) = preview_doc(channel) {
            let doc = format!(": {doc}");
            topics.push(Topic::new::<messages::CompressedImage>(previews(channel), &doc, Frequency::Previews));
        }
    }
    topics.extend(of_poses());
    topics.push(Topic::new::<messages::Log>(CAPTIONS, ": captions, once.", Frequency::Captions));
    topics.push(of_target_state());
    topics
}

/// All topics of the log of a closed-loop flight, which has no pictures.
pub fn flown_topics(has_sensors: bool) -> Vec<Topic> {
    let mut topics = vec![Topic::new::<messages::CameraCalibration>(CAMERA, ".", Frequency::EveryFrame)];
    topics.extend(of_poses());
    topics.push(of_target_state());
    topics.push(Topic {
        name: STEP.into(),
        doc: format!("`{}`: action and outcome.", flown_step::SCHEMA_NAME),
        schema: Schema::new(flown_step::SCHEMA_NAME, "protobuf", flown_step::descriptor_set()),
        notes: &[],
        frequency: Frequency::EveryFrame,
    });
    let events = ": losses, reacquisitions, collisions, the end.";
    topics.push(Topic::new::<messages::Log>(EVENTS, events, Frequency::EveryFrame));
    let sensors = flown_step::SENSORS.iter().zip([INERTIAL, BAROMETER, FIX]).filter(|_| has_sensors);
    topics.extend(sensors.map(|((message, fields), topic)| {
        let name = format!("cosfly.{message}");
        let schema = Schema::new(name.clone(), "protobuf", own_message::descriptor_set(message, fields));
        Topic { name: topic.into(), doc: format!("`{name}`."), schema, notes: &[], frequency: Frequency::EveryFrame }
    }));
    topics
}

fn of_poses() -> Vec<Topic> {
    let mut topics = vec![Topic::new::<messages::FrameTransforms>(TF, ".", Frequency::EveryFrame)];
    topics.push(Topic::new::<messages::PoseInFrame>(DRONE_POSE, " of the drone.", Frequency::EveryFrame));
    topics.push(Topic::new::<messages::PoseInFrame>(TARGET_POSE, " of the target's feet.", Frequency::EveryFrame));
    topics.push(Topic::new::<messages::PosesInFrame>(DRONE_PATH, ": the whole flight, once.", Frequency::Once));
    topics.push(Topic::new::<messages::PosesInFrame>(TARGET_PATH, ": the whole walk, once.", Frequency::Once));
    let scene = ": obstacles near the flight and the target, once.";
    topics.push(Topic::new::<messages::SceneUpdate>(SCENE, scene, Frequency::Once));
    topics
}

fn of_target_state() -> Topic {
    Topic {
        name: TARGET_STATE.into(),
        doc: format!("`{}`.", target_state::SCHEMA_NAME),
        schema: Schema::new(target_state::SCHEMA_NAME, "protobuf", target_state::descriptor_set()),
        notes: &[],
        frequency: Frequency::EveryFrame,
    }
}

fn raw_images(channel: &Channel) -> Topic {
    let encodings: Vec<String> = formats(channel).iter().map(|format| format!("`{}`", format.encoding)).collect();
    let on_request = if channel.is_on_request() { " On request." } else { "" };
    let doc = format!(" {}: {}{on_request}", encodings.join(" or "), channel.doc);
    let topic = Topic::new::<messages::RawImage>(images(channel), &doc, Frequency::EveryFrame);
    Topic { notes: channel.notes, ..topic }
}

/// Description of a channel's previews; `None` for channels without previews.
fn preview_doc(channel: &Channel) -> Option<String> {
    match channel.element() {
        Element::Colour => Some("small colour image.".into()),
        Element::Float => Some(format!("{} in logarithmic colours.", channel.name)),
        Element::Label => Some("labels as palette PNG.".into()),
        Element::Flag | Element::Bytes => Some(format!("{} as PNG.", channel.name)),
        Element::Pair => Some(format!("{} in the colours of a wheel, as PNG.", channel.name)),
        Element::Id => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_is_found_by_the_topic_of_its_images() {
        for channel in channels::ALL {
            assert_eq!(channel_of(&images(channel)), Some(*channel));
            assert_eq!(channel_of(&previews(channel)), None);
        }
        assert_eq!(channel_of("/camera/sound/image"), None);
    }

    #[test]
    fn every_topic_has_a_name_of_its_own() {
        let mut names: Vec<String> = topics(&ChannelSet::of(|_| true)).into_iter().map(|topic| topic.name).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
