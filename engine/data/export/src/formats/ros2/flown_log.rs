//! [`FlownLog`]: the log of a closed-loop flight, as `cosfly fly` writes it.

use cosfly_diagnose::Result;
use cosfly_domain::Camera;
use cosfly_frames::{DQuat, DVec3, real};
use cosfly_read::LogReader;
use cosfly_schema::log::flown_step::{FixMessage, FlownStepMessage, HeightMessage, InertialMessage};
use cosfly_schema::log::reading::{LoggedSensor, ReadingMessage};
use cosfly_schema::log::topic;
use foxglove::messages;
use prost::{DecodeError, Message};
use std::collections::BTreeMap;

/// Child frame of a quadrotor's attitude.
const BODY: &str = "body";

/// A closed-loop flight, without pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct FlownLog {
    /// The camera, whose pose is the drone's.
    pub camera: Camera,
    /// Sensors that are no cameras, by name.
    pub sensors: Vec<LoggedSensor>,
    /// The steps, by time.
    pub steps: Vec<FlownLogStep>,
    /// Times since the beginning, nanoseconds, and samples of sensors, by time.
    pub samples: Vec<(u64, FlownSample)>,
}

/// State after a step. Places and rotations are those in the `map` frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlownLogStep {
    /// Time since the beginning, nanoseconds.
    pub time_ns: u64,
    /// Position (metres) and rotation of drone and camera.
    pub drone: (DVec3, DQuat),
    /// Rotation of a quadrotor's body.
    pub attitude: Option<DQuat>,
    /// Position of the target's feet (metres), and its heading as a rotation.
    pub target: (DVec3, DQuat),
    /// Action and outcome.
    pub outcome: FlownStepMessage,
    /// Losses, reacquisitions, collisions, the end.
    pub events: Vec<String>,
}

/// A sample of a sensor.
#[derive(Clone, Debug, PartialEq)]
pub enum FlownSample {
    /// Inertial unit.
    Inertial(InertialMessage),
    /// Height by the barometer, metres.
    Height(f64),
    /// Satellite receiver.
    Fix(FixMessage),
    /// Number of the sensor and the numbers of its quantities.
    Reading(usize, Vec<f64>),
}

impl FlownLog {
    /// The flight of the log of a closed-loop flight.
    ///
    /// # Errors
    /// `dataset-damaged` where a step is incomplete, or the log is none of a closed-loop flight.
    pub fn read(log: &mut LogReader) -> Result<Self> {
        let sensors = log.sensors();
        let mut readings: Vec<String> = sensors.iter().map(LoggedSensor::topic_name).collect();
        let own = [topic::TF, topic::DRONE_POSE, topic::TARGET_POSE, topic::STEP, topic::EVENTS, topic::CAMERA];
        readings.extend([topic::INERTIAL, topic::BAROMETER, topic::FIX].map(str::to_owned));
        let topics: Vec<&str> = own.into_iter().chain(readings.iter().map(String::as_str)).collect();
        let (mut camera, mut samples) = (None, vec![]);
        let mut steps: BTreeMap<u64, (FlownLogStep, Vec<&str>)> = BTreeMap::new();
        log.messages(0..=u64::MAX, &topics, &mut |name, time_ns, data| {
            let unreadable = |error: DecodeError| error.to_string();
            if name == topic::CAMERA {
                camera = Some(camera_of(&messages::CameraCalibration::decode(data).map_err(unreadable)?));
            } else if let Some(sample) = sample(name, &sensors, data).map_err(unreadable)? {
                samples.push((time_ns, sample));
            } else if let Some(known) = own.into_iter().find(|it| *it == name) {
                let (step, seen) = steps.entry(time_ns).or_default();
                seen.push(known);
                step.take(known, data).map_err(unreadable)?;
            }
            Ok(())
        })?;
        let needed = [topic::TF, topic::DRONE_POSE, topic::TARGET_POSE, topic::STEP];
        for (time_ns, (_, seen)) in &steps {
            if let Some(missing) = needed.iter().find(|it| !seen.contains(it)) {
                return Err(log.damaged(&format!("its step at {time_ns} ns has no message on `{missing}`")));
            }
        }
        let Some(camera) = camera.filter(|_| !steps.is_empty()) else {
            return Err(log.damaged("it has no steps of a closed-loop flight"));
        };
        let steps = steps.into_iter().map(|(time_ns, (step, _))| FlownLogStep { time_ns, ..step }).collect();
        Ok(Self { camera, sensors, steps, samples })
    }
}

impl FlownLogStep {
    fn take(&mut self, topic: &str, data: &[u8]) -> Result<(), DecodeError> {
        let place = |data| messages::PoseInFrame::decode(data).map(|it| place(&it.pose.unwrap_or_default()));
        match topic {
            topic::DRONE_POSE => self.drone = place(data)?,
            topic::TARGET_POSE => self.target = place(data)?,
            topic::STEP => self.outcome = FlownStepMessage::decode(data)?,
            topic::EVENTS => self.events.push(messages::Log::decode(data)?.message),
            _ => {
                let all = messages::FrameTransforms::decode(data)?.transforms;
                let body = all.into_iter().find(|it| it.child_frame_id == BODY);
                self.attitude = body.and_then(|it| it.rotation).map(|it| DQuat::from_xyzw(it.x, it.y, it.z, it.w));
            }
        }
        Ok(())
    }
}

fn place(pose: &messages::Pose) -> (DVec3, DQuat) {
    let position = pose.position.map_or(DVec3::ZERO, |it| DVec3::new(it.x, it.y, it.z));
    (position, pose.orientation.map_or(DQuat::IDENTITY, |it| DQuat::from_xyzw(it.x, it.y, it.z, it.w)))
}

fn camera_of(info: &messages::CameraCalibration) -> Camera {
    let focal_px = info.k.first().copied().unwrap_or(1.0);
    let horizontal_fov_rad = 2.0 * real::atan2(0.5 * f64::from(info.width), focal_px);
    Camera { width: info.width, height: info.height, horizontal_fov_rad }
}

/// The sample in a message of a sensor; `None` for other topics.
fn sample(name: &str, sensors: &[LoggedSensor], data: &[u8]) -> Result<Option<FlownSample>, DecodeError> {
    Ok(Some(match name {
        topic::INERTIAL => FlownSample::Inertial(InertialMessage::decode(data)?),
        topic::BAROMETER => FlownSample::Height(HeightMessage::decode(data)?.height_m),
        topic::FIX => FlownSample::Fix(FixMessage::decode(data)?),
        _ => match sensors.iter().position(|sensor| sensor.topic_name() == name) {
            Some(number) => {
                FlownSample::Reading(number, ReadingMessage::numbers(sensors[number].quantities.len(), data)?)
            }
            None => return Ok(None),
        },
    }))
}
