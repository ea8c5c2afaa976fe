//! Writes the log of a closed-loop flight: poses, target, actions, rewards and events, without pictures.

use super::channels::ChannelWriter;
use super::scene;
use cosfly_diagnose::Result;
use cosfly_domain::{Camera, Lens, Mount, OrientedBox, Town};
use cosfly_frames::{DQuat, DVec3, Pose, TargetState};
use cosfly_schema::log::flown_step::{FixMessage, FlownStepMessage, HeightMessage, InertialMessage};
use cosfly_schema::log::reading::{LoggedSensor, ReadingMessage};
use cosfly_schema::log::right_handed::map_from_world_point;
use cosfly_schema::log::{TargetStateMessage, flown_topics, messages, topic};
use foxglove::messages::{Log, log::Level};
use std::collections::BTreeMap;
use std::io::Write;

/// Steps whose messages are compressed together.
const CHUNK_STEPS: usize = 100;

/// A closed-loop flight.
pub struct FlownFlight<'a> {
    /// Metadata of the log, by name.
    pub about: &'a BTreeMap<String, String>,
    /// The town.
    pub town: &'a Town,
    /// The camera, whose pose is the drone's.
    pub camera: Camera,
    /// Height and radius of the target, metres.
    pub target_size_m: [f64; 2],
    /// Sensors that are no cameras.
    pub sensors: &'a [LoggedSensor],
    /// States of the target, the whole walk.
    pub walk: &'a [TargetState],
    /// The steps, in the order of their times.
    pub steps: &'a [FlownStep],
}

/// State after a step.
#[derive(Clone, Debug)]
pub struct FlownStep {
    /// Steps since the beginning.
    pub step: u32,
    /// Time since the beginning, seconds.
    pub time_s: f64,
    /// Pose of drone and camera.
    pub pose: Pose,
    /// Velocity of the drone, m/s.
    pub velocity_in_world: DVec3,
    /// The target.
    pub target: TargetState,
    /// Share of body points reached by unoccluded rays.
    pub visible: f64,
    /// Whether the middle of the target's body is in the picture.
    pub in_picture: bool,
    /// Whether the target counts as tracked.
    pub tracked: bool,
    /// Distance from the drone to the nearest obstacle, at most 50 m.
    pub clearance_m: f64,
    /// Numbers of the action that was given before the step; empty without one.
    pub action: Vec<f64>,
    /// Weighted sum of the reward's terms.
    pub reward: f64,
    /// The terms, unweighted.
    pub reward_terms: Vec<f64>,
    /// Boxes of people and vehicles beside the target.
    pub others: Vec<OrientedBox>,
    /// Attitude of a quadrotor in the `map` frame: x, y, z, w.
    pub attitude_xyzw: Option<[f64; 4]>,
    /// Samples of the sensors since the step before, by time.
    pub sensed: Vec<SensedSample>,
    /// Reading of each of the flight's sensors.
    pub readings: Vec<Vec<f64>>,
    /// Events of the step, and whether each is a fault.
    pub events: Vec<(bool, String)>,
}

/// A sample of sensors. Vectors of places and velocities are in the `map` frame, those of the inertial unit along the body's axes
/// (x ahead, y left, z up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensedSample {
    /// Time since the beginning, seconds.
    pub time_s: f64,
    /// Rates of turning, rad/s.
    pub rates_rad_s: DVec3,
    /// Specific force, m/s^2.
    pub force_mps2: DVec3,
    /// Height by the barometer, metres.
    pub height_m: Option<f64>,
    /// Position (metres) and velocity (m/s) by the satellite receiver.
    pub fix: Option<(DVec3, DVec3)>,
}

/// Writes the log; gives the number of messages.
///
/// # Errors
/// The output cannot be written.
pub fn write_flown_log(output: &mut dyn Write, flight: &FlownFlight<'_>) -> Result<u64> {
    let has_sensors = flight.steps.iter().any(|step| !step.sensed.is_empty());
    let mut topics = flown_topics(has_sensors);
    topics.extend(flight.sensors.iter().map(LoggedSensor::topic));
    let mut log = ChannelWriter::new(output, &topics)?;
    log.metadata("cosfly.flight", flight.about)?;
    let poses: Vec<Pose> = flight.steps.iter().map(|step| step.pose).collect();
    let [height_m, radius_m] = flight.target_size_m;
    log.write(topic::SCENE, 0, &scene::scene(flight.town, &poses, height_m, radius_m))?;
    log.write(topic::DRONE_PATH, 0, &messages::path_in_map(poses.into_iter()))?;
    log.write(topic::TARGET_PATH, 0, &messages::path_in_map(flight.walk.iter().map(messages::feet_pose)))?;
    log.end_compressed_chunk()?;
    for steps in flight.steps.chunks(CHUNK_STEPS) {
        steps.iter().try_for_each(|step| write_step(&mut log, flight, step))?;
        log.end_compressed_chunk()?;
    }
    log.finish()
}

fn write_step<W: Write>(log: &mut ChannelWriter<W>, flight: &FlownFlight<'_>, step: &FlownStep) -> Result<()> {
    step.sensed.iter().try_for_each(|sample| write_sample(log, sample))?;
    let time = time_ns(step.time_s);
    let target = messages::feet_pose(&step.target);
    let mut transforms = messages::transforms(time, &step.pose, &Mount::default(), &target);
    transforms.transforms.extend(step.attitude_xyzw.map(|attitude| {
        let place = map_from_world_point(step.pose.position_in_world);
        messages::transform(time, "body", place, DQuat::from_array(attitude))
    }));
    log.write(topic::TF, time, &transforms)?;
    if !step.others.is_empty() {
        log.write(topic::SCENE, time, &scene::bodies(time, &step.others))?;
    }
    log.write(topic::DRONE_POSE, time, &messages::pose_in_map(time, &step.pose))?;
    log.write(topic::TARGET_POSE, time, &messages::pose_in_map(time, &target))?;
    log.write(topic::TARGET_STATE, time, &target_state(flight, step))?;
    log.write(topic::CAMERA, time, &messages::calibration(time, &flight.camera, &Lens::default(), &Mount::default()))?;
    log.write(topic::STEP, time, &step_message(step))?;
    for (sensor, values) in flight.sensors.iter().zip(&step.readings) {
        log.write(&sensor.topic_name(), time, &ReadingMessage(values.clone()))?;
    }
    step.events.iter().try_for_each(|(is_fault, message)| {
        let level = if *is_fault { Level::Warning } else { Level::Info } as i32;
        let timestamp = Some(messages::timestamp(time));
        log.write(topic::EVENTS, time, &Log { timestamp, level, message: message.clone(), ..Log::default() })
    })
}

fn write_sample<W: Write>(log: &mut ChannelWriter<W>, sample: &SensedSample) -> Result<()> {
    let time = time_ns(sample.time_s);
    let list = |vector: DVec3| vector.to_array().to_vec();
    let SensedSample { rates_rad_s, force_mps2, .. } = *sample;
    let inertial = InertialMessage { rates_rad_s: list(rates_rad_s), force_mps2: list(force_mps2) };
    log.write(topic::INERTIAL, time, &inertial)?;
    if let Some(height_m) = sample.height_m {
        log.write(topic::BAROMETER, time, &HeightMessage { height_m })?;
    }
    sample.fix.map_or(Ok(()), |(position, velocity)| {
        log.write(topic::FIX, time, &FixMessage { position_m: list(position), velocity_mps: list(velocity) })
    })
}

fn time_ns(time_s: f64) -> u64 {
    (time_s * 1e9).round_ties_even() as u64
}

/// State of the target; there are no pictures, and what is read from them is left out.
fn target_state(flight: &FlownFlight<'_>, step: &FlownStep) -> TargetStateMessage {
    let feet = map_from_world_point(step.target.feet_in_world);
    TargetStateMessage {
        frame: step.step,
        time_s: step.time_s,
        feet_x_m: feet.x,
        feet_y_m: feet.y,
        feet_z_m: feet.z,
        heading_rad: -step.target.heading_rad,
        speed_mps: step.target.speed_mps,
        height_m: flight.target_size_m[0],
        radius_m: flight.target_size_m[1],
        in_view: step.in_picture,
        visible_by_rays: step.visible,
        distance_m: step.pose.position_in_world.distance(step.target.feet_in_world),
        drone_clearance_m: step.clearance_m,
        expert_frame: step.step,
        ..TargetStateMessage::default()
    }
}

fn step_message(step: &FlownStep) -> FlownStepMessage {
    FlownStepMessage {
        step: step.step,
        time_s: step.time_s,
        tracked: step.tracked,
        visible: step.visible,
        distance_m: step.pose.position_in_world.distance(step.target.feet_in_world),
        speed_mps: step.velocity_in_world.length(),
        velocity_mps: map_from_world_point(step.velocity_in_world).to_array().to_vec(),
        action: step.action.clone(),
        reward: step.reward,
        reward_terms: step.reward_terms.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::mcap::MessageStream;

    #[test]
    fn a_flight_is_read_back_by_the_reader_of_others_and_twice_the_same() {
        let town = cosfly_sample::town();
        let state = |step: u32| TargetState {
            feet_in_world: DVec3::new(f64::from(step), 2.0, 0.0),
            heading_rad: 0.0,
            speed_mps: 1.0,
        };
        let town_box = town.obstacles[0].shape;
        let step = |step: u32| FlownStep {
            step,
            time_s: 0.1 * f64::from(step),
            pose: Pose::looking_at(DVec3::new(0.0, 0.0, 20.0), state(step).feet_in_world),
            velocity_in_world: DVec3::Y,
            target: state(step),
            visible: 1.0,
            in_picture: true,
            tracked: true,
            clearance_m: 3.0,
            action: vec![1.0; 5],
            reward: 1.0,
            reward_terms: vec![1.0; 6],
            others: vec![town_box],
            attitude_xyzw: Some([0.0, 0.0, 0.0, 1.0]),
            sensed: vec![SensedSample {
                time_s: 0.1 * f64::from(step) - 0.05,
                rates_rad_s: DVec3::X,
                force_mps2: DVec3::Z,
                height_m: Some(20.0),
                fix: Some((DVec3::Z, DVec3::X)),
            }],
            readings: vec![vec![f64::from(step), 1.0]],
            events: if step == 150 { vec![(true, "lost".to_owned())] } else { vec![] },
        };
        let steps: Vec<FlownStep> = (1..=250).map(step).collect();
        let walk = [state(0), state(1)];
        let about = BTreeMap::from([("episode".to_owned(), "e".to_owned())]);
        let camera = Camera { width: 64, height: 48, horizontal_fov_rad: 1.5 };
        let target_size_m = [1.7, 0.3];
        let quantities = ["range_m", "is_hit"].map(str::to_owned).to_vec();
        let sensors = &[LoggedSensor { name: "laser".to_owned(), quantities }];
        let (about, town, walk, steps) = (&about, &town, &walk, &steps);
        let flight = FlownFlight { about, town, camera, target_size_m, sensors, walk, steps };
        let written = || {
            let mut bytes = vec![];
            let count = write_flown_log(&mut bytes, &flight).expect("memory takes all bytes");
            (bytes, count)
        };
        let (bytes, count) = written();
        assert_eq!((count, &bytes), (3 + 11 * 250 + 1, &written().0));
        let messages: Vec<_> = MessageStream::new(&bytes).expect("a log").map(|it| it.expect("a message")).collect();
        assert_eq!(messages.len() as u64, count);
        let events: Vec<_> = messages.iter().filter(|it| it.channel.topic == topic::EVENTS).collect();
        assert_eq!((events.len(), events[0].log_time), (1, 15_000_000_000));
        let read = messages.iter().filter(|it| it.channel.topic == "/sensor/laser");
        let read: Vec<_> = read.map(|it| ReadingMessage::numbers(2, &it.data).expect("a reading")).collect();
        assert_eq!((read.len(), &read[249]), (250, &vec![250.0, 1.0]));
    }
}
