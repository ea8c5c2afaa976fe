//! Bags of closed-loop flights, from the logs that `cosfly fly` writes.

use super::bag::{Bag, NamedTopic, Topic, topics_of_sensors};
use super::flown_log::{FlownLog, FlownLogStep, FlownSample};
use super::messages::{self, Header, Motion, OPTICAL, Placed};
use super::readings::ReadingCoder;
use super::{START_NS, motion};
use crate::folder::{OutFolder, Written};
use crate::media::FOLDER_LIMIT;
use crate::whole_log::whole_log;
use cosfly_diagnose::Result;
use cosfly_domain::{Lens, Mount};
use cosfly_frames::{DQuat, DVec3, real};
use cosfly_read::{LogReader, LoggedBox};
use cosfly_schema::log::{FrameTimes, right_handed};
use std::path::{Path, PathBuf};

/// Topics of every flight.
const TOPICS: [(Topic, &str, &str, bool); 14] = [
    (Topic::TfStatic, "/tf_static", "tf2_msgs/TFMessage", true),
    (Topic::Town, "/town", "visualization_msgs/MarkerArray", true),
    (Topic::Clock, "/clock", "rosgraph_msgs/Clock", false),
    (Topic::Tf, "/tf", "tf2_msgs/TFMessage", false),
    (Topic::Odometry, "/odom", "nav_msgs/Odometry", false),
    (Topic::TargetOdometry, "/target/odom", "nav_msgs/Odometry", false),
    (Topic::CameraInfo(0), "/camera/camera_info", "sensor_msgs/CameraInfo", false),
    (Topic::Command, "/cmd_vel", "geometry_msgs/TwistStamped", false),
    (Topic::Action, "/flight/action", "std_msgs/Float64MultiArray", false),
    (Topic::Step, "/flight/step", "std_msgs/Float64MultiArray", false),
    (Topic::Event, "/flight/events", "std_msgs/String", false),
    (Topic::Inertial, "/imu", "sensor_msgs/Imu", false),
    (Topic::Height, "/barometer", "std_msgs/Float64MultiArray", false),
    (Topic::Fix, "/gnss", "nav_msgs/Odometry", false),
];

/// Frame of commands: at the drone, level, with its heading.
const LEVEL: &str = "base_stabilized";

/// Quantities of a step.
const STEP: [&str; 10] =
    ["tracked", "visible", "distance_m", "reward", "visibility", "framing", "distance", "effort", "collision", "loss"];

/// Writes the logs of flights, names with files, as bags into the new folder `out`. `result` is the folder that they are in;
/// `progress` is called with the number of flights that are done and of all.
///
/// # Errors
/// A log that is damaged or none of a closed-loop flight, a folder that exists, a system error. No folder is left then.
pub fn flown_bags(
    flights: &[(String, PathBuf)],
    result: &Path,
    out: &Path,
    progress: &dyn Fn(u64, u64),
) -> Result<Written> {
    let folder = OutFolder::begin(out, result)?;
    for (number, (name, log)) in flights.iter().enumerate() {
        let path = log;
        let mut log = LogReader::open(path, FrameTimes::default())?;
        whole_log(path)?;
        let (boxes, log) = (log.scene()?, FlownLog::read(&mut log)?);
        let topics =
            TOPICS.into_iter().map(|(topic, name, kind, is_latched)| (topic, name.to_owned(), kind, is_latched));
        let topics: Vec<NamedTopic> = topics.chain(topics_of_sensors(&log.sensors)).collect();
        let mut bag = Bag::begin(&folder, format!("{:03}/{name}", number / FOLDER_LIMIT), topics)?;
        Flown::of(&log).write(&mut bag, &boxes)?;
        bag.finish()?;
        progress(number as u64 + 1, flights.len() as u64);
    }
    folder.put("README.md", README.as_bytes())?;
    folder.finish()
}

/// A flight in the frames of ROS.
struct Flown<'a> {
    log: &'a FlownLog,
    /// Places of `base_link` in `map`.
    drone: Vec<Placed>,
    /// Places of `target` in `map`.
    target: Vec<Placed>,
    coders: Vec<ReadingCoder<'a>>,
    dt_s: f64,
}

impl<'a> Flown<'a> {
    fn of(log: &'a FlownLog) -> Self {
        let placed = |(position, rotation)| Placed { position, rotation };
        let body = |step: &FlownLogStep| placed((step.drone.0, step.attitude.unwrap_or(step.drone.1)));
        let dt_ns = log.steps.windows(2).next().map_or(0, |pair| pair[1].time_ns - pair[0].time_ns);
        Self {
            log,
            drone: log.steps.iter().map(body).collect(),
            target: log.steps.iter().map(|step| placed(step.target)).collect(),
            coders: log.sensors.iter().map(ReadingCoder::of).collect(),
            dt_s: 1e-9 * dt_ns as f64,
        }
    }

    fn write(&self, bag: &mut Bag<'_>, boxes: &[LoggedBox]) -> Result<()> {
        let still = Placed { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        let optical = Placed { rotation: right_handed::BODY_FROM_OPTICAL, ..still };
        let list = [("map", "odom", still), ("camera_link", OPTICAL, optical)];
        bag.write(Topic::TfStatic, START_NS, &messages::transforms(START_NS, &list))?;
        bag.write(Topic::Town, START_NS, &messages::markers(Header { time_ns: START_NS, frame: "map" }, boxes))?;
        let mut samples = &self.log.samples[..];
        for (number, step) in self.log.steps.iter().enumerate() {
            let due = samples.partition_point(|(time_ns, _)| *time_ns <= step.time_ns);
            self.write_samples(bag, &samples[..due])?;
            samples = &samples[due..];
            self.write_step(bag, number, step)?;
        }
        self.write_samples(bag, samples)
    }

    fn write_step(&self, bag: &mut Bag<'_>, number: usize, step: &FlownLogStep) -> Result<()> {
        let (time_ns, drone, target) = (START_NS + step.time_ns, self.drone[number], self.target[number]);
        let header = |frame| Header { time_ns, frame };
        bag.write(Topic::Clock, time_ns, &messages::clock(time_ns))?;
        let camera = Placed { position: DVec3::ZERO, rotation: drone.rotation.inverse() * step.drone.1 };
        // The camera never rolls: its left is level.
        let left = step.drone.1 * DVec3::Y;
        let (sin, cos) = real::sin_cos(0.5 * real::atan2(-left.x, left.y));
        let level = Placed { rotation: DQuat::from_xyzw(0.0, 0.0, sin, cos), ..drone };
        let list = [
            ("odom", "base_link", drone),
            ("odom", LEVEL, level),
            ("base_link", "camera_link", camera),
            ("map", "target", target),
        ];
        bag.write(Topic::Tf, time_ns, &messages::transforms(time_ns, &list))?;
        let velocity = vector(&step.outcome.velocity_mps);
        let flown = Motion {
            linear: drone.rotation.inverse() * velocity,
            angular: motion(&self.drone, number, self.dt_s).angular,
        };
        bag.write(Topic::Odometry, time_ns, &messages::odometry(header("odom"), "base_link", &drone, &flown))?;
        let walked = motion(&self.target, number, self.dt_s);
        bag.write(Topic::TargetOdometry, time_ns, &messages::odometry(header("map"), "target", &target, &walked))?;
        let info = messages::camera_info(header(OPTICAL), &self.log.camera, &Lens::default(), &Mount::default());
        bag.write(Topic::CameraInfo(0), time_ns, &info)?;
        match step.outcome.action[..] {
            [ahead, right, up, pitch_deg_s, yaw_deg_s] => {
                let (pitch, yaw) = (pitch_deg_s.to_radians(), yaw_deg_s.to_radians());
                // Up and to the right are turns around minus y and minus z.
                let asked = Motion { linear: DVec3::new(ahead, -right, up), angular: DVec3::new(0.0, -pitch, -yaw) };
                bag.write(Topic::Command, time_ns, &messages::twist(header(LEVEL), &asked))?;
            }
            [] => {}
            _ => {
                let names: Vec<String> = (0..step.outcome.action.len()).map(|it| format!("action_{it}")).collect();
                bag.write(Topic::Action, time_ns, &messages::reading(&names, &step.outcome.action))?;
            }
        }
        let outcome = &step.outcome;
        let mut values = vec![f64::from(outcome.tracked), outcome.visible, outcome.distance_m, outcome.reward];
        values.extend(&outcome.reward_terms);
        bag.write(Topic::Step, time_ns, &messages::reading(&STEP.map(str::to_owned), &values))?;
        step.events.iter().try_for_each(|event| bag.write(Topic::Event, time_ns, &messages::string(event)))
    }

    fn write_samples(&self, bag: &mut Bag<'_>, samples: &[(u64, FlownSample)]) -> Result<()> {
        for (time_ns, sample) in samples {
            let time_ns = START_NS + time_ns;
            let (topic, message) = match sample {
                FlownSample::Inertial(it) => {
                    let header = Header { time_ns, frame: "base_link" };
                    (Topic::Inertial, messages::imu(header, &it.rates_rad_s, &it.force_mps2))
                }
                FlownSample::Height(height_m) => {
                    (Topic::Height, messages::reading(&["height_m".to_owned()], &[*height_m]))
                }
                FlownSample::Fix(it) => {
                    let placed = Placed { position: vector(&it.position_m), rotation: DQuat::IDENTITY };
                    let motion = Motion { linear: vector(&it.velocity_mps), angular: DVec3::ZERO };
                    (Topic::Fix, messages::odometry(Header { time_ns, frame: "map" }, "gnss", &placed, &motion))
                }
                FlownSample::Reading(number, values) => {
                    (Topic::Sensor(*number), self.coders[*number].encode(time_ns, values))
                }
            };
            bag.write(topic, time_ns, &message)?;
        }
        Ok(())
    }
}

fn vector(numbers: &[f64]) -> DVec3 {
    numbers.first_chunk().map_or(DVec3::ZERO, |xyz| DVec3::from_array(*xyz))
}

const README: &str = "\
# Closed-loop flights as ROS 2 bags

`<thousands of flights>/<episode>/` is a bag: MCAP, messages of ROS 2 Humble and later in CDR, with their definitions. The first time is 1 s
plus the first step. Frames are those of REP 103 and REP 105: `map`, `odom`, `base_link`, `camera_link`, `camera_optical_frame`, `target`; `base_stabilized` is level at the drone, with
its heading.

| topic | type | content |
| --- | --- | --- |
| `/tf_static`, `/tf` | `tf2_msgs/TFMessage` | `odom` to `base_link` and `base_stabilized`, `base_link` to `camera_link`, `map` to `target` |
| `/clock` | `rosgraph_msgs/Clock` | the time of the step |
| `/odom`, `/target/odom` | `nav_msgs/Odometry` | true pose and motion along the body's axes |
| `/cmd_vel` | `geometry_msgs/TwistStamped` | the action before the step: velocities ahead, left and up in `base_stabilized`, rates of the camera's pitch and the drone's yaw |
| `/flight/action` | `std_msgs/Float64MultiArray` | numbers of an action of another kind |
| `/flight/step` | `std_msgs/Float64MultiArray` | tracked, visible, distance_m, reward and its six terms |
| `/flight/events` | `std_msgs/String` | losses, reacquisitions, collisions, the end |
| `/imu`, `/barometer`, `/gnss` | `sensor_msgs/Imu`, `std_msgs/Float64MultiArray`, `nav_msgs/Odometry` | sensors of a quadrotor; places in `map` |
| `/sensor/NAME` | by its columns | other sensors |
| `/town` | `visualization_msgs/MarkerArray` | boxes of the town near the flight |
| `/camera/camera_info` | `sensor_msgs/CameraInfo` | the nominal camera; there are no pictures |
";
