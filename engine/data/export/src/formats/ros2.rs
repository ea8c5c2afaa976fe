//! ROS 2: a bag per flight, with the frames of REP 103 and REP 105.
//!
//! The left-handed world becomes the right-handed frame `map` by [`right_handed`] and nowhere else.

mod bag;
mod cameras;
mod cdr;
mod definitions;
pub(crate) mod flown;
mod flown_log;
mod messages;
mod readings;

use crate::card::ExportCard;
use crate::films::Films;
use crate::folder::OutFolder;
use crate::format::Format;
use crate::media::{FOLDER_LIMIT, ending};
use crate::shared_options::PictureAndTextOptions;
use crate::source::{ExportedFlight, LidarSweeps, SensorReadings, Source};
use bag::{Bag, Topic, topics_of_flight};
use cameras::CameraNames;
use cosfly_diagnose::Result;
use cosfly_domain::TARGET_INSTANCE;
use cosfly_frames::{DQuat, DVec3, Pose, real};
use cosfly_read::{LoggedFrame, LoggedSweep, PublishedFlight, SeenBody, SightingReader};
use cosfly_schema::log::reading::LoggedSensor;
use cosfly_schema::log::{messages::feet_pose, right_handed};
use messages::{Detected, Header, Motion, Placed};
use readings::ReadingCoder;
use std::collections::BTreeMap;

/// Bags.
pub struct Ros2;

/// Time of the first frame, nanoseconds. Time 0 means in ROS that there is no time.
const START_NS: u64 = 1_000_000_000;
/// Pictures that are in memory at the same time.
const MOMENTS: usize = 16;

impl Format for Ros2 {
    const NAME: &'static str = "ros2";
    const DOC: &'static str =
        "ROS 2: a bag per flight with pictures of all its cameras, depth, labels, transforms, odometry, detections";
    type Options = PictureAndTextOptions;

    fn write(options: &PictureAndTextOptions, source: &Source<'_>, out: &OutFolder) -> Result<Vec<String>> {
        let mut bodies = SightingReader::of(source.dataset)?;
        let films = Films::of(source);
        let mut number = 0;
        source.each_flight_of(&|flight| films.is_first(flight), &mut |episode| {
            let (flight, of_flight) = (episode.flight, films.of_flight(episode.flight));
            let id = if of_flight.len() > 1 { &flight.flight_id } else { &flight.trajectory_id };
            let folder = format!("{}/{:03}/{id}", flight.split, number / FOLDER_LIMIT);
            number += 1;
            let others = of_flight[1..].iter().map(|film| source.exported(film)).collect::<Result<Vec<_>>>()?;
            let names = CameraNames::of(of_flight);
            let mut cameras = vec![];
            for (episode, names) in std::iter::once(episode).chain(&others).zip(&names) {
                let place = source.dataset.place(&episode.flight.trajectory_id).unwrap_or_default();
                cameras.push(Film { episode, names, bodies: bodies.at(source.dataset, place)?.to_vec() });
            }
            let readings = of_each(&cameras, |film| film.readings(), |sensor| &sensor.name)?;
            let lidars = of_each(&cameras, |film| film.sweeps(), |lidar| lidar)?;
            let sensors: Vec<LoggedSensor> = readings.iter().map(|(sensor, _)| sensor.clone()).collect();
            let mut bag = Bag::begin(out, folder, topics_of_flight(&names, &sensors, &lidars))?;
            let recording = Recording::of(&cameras, &readings, &lidars);
            recording.write_once(&mut bag, source, episode.instruction(options.instructions.language))?;
            recording.write_frames(&mut bag, options.pictures.every)?;
            bag.finish()
        })?;
        let body = BODY.replace("SPLIT", source.splits().first().copied().unwrap_or_default());
        ExportCard { format: "ROS 2", front_matter: "task_categories:\n- robotics\n".into(), body }
            .write(source, out)?;
        Ok(vec![])
    }
}

/// Film of a flight by one camera.
struct Film<'a> {
    episode: &'a ExportedFlight<'a>,
    names: &'a CameraNames,
    bodies: Vec<SeenBody>,
}

/// Sensors of the films' logs, each from the first film that has it.
fn of_each<S, T>(
    films: &[Film<'_>],
    read: impl Fn(&ExportedFlight<'_>) -> Result<Vec<(S, T)>>,
    name: impl Fn(&S) -> &String,
) -> Result<Vec<(S, T)>> {
    let mut found: Vec<(S, T)> = vec![];
    for film in films {
        for it in read(film.episode)? {
            if found.iter().all(|(known, _)| name(known) != name(&it.0)) {
                found.push(it);
            }
        }
    }
    Ok(found)
}

/// A flight in the frames of ROS.
struct Recording<'a> {
    /// Its films; the first one has the drone's motion.
    films: &'a [Film<'a>],
    /// Places of `base_link` in `map`.
    drone: Vec<Placed>,
    /// Places of `target` in `map`; none where nobody is followed.
    target: Vec<Placed>,
    /// How the readings of each sensor become messages.
    coders: Vec<ReadingCoder<'a>>,
    /// Time, number of the sensor and values of each reading, by time.
    readings: Vec<(u64, usize, &'a [f64])>,
    lidars: &'a [LidarSweeps],
    /// Time and number of the lidar of each sweep, by time.
    sweeps: Vec<(u64, usize, &'a LoggedSweep)>,
}

/// Pictures of a frame as messages.
struct Pictures {
    colours: Vec<u8>,
    depths: Vec<u8>,
    labels: Vec<u8>,
}

impl Pictures {
    fn of(header: Header<'_>, logged: &LoggedFrame) -> Self {
        let size = [logged.width, logged.height];
        let format = if ending(&logged.rgb_format) == "png" { "png" } else { "jpeg" };
        let depths: Vec<u8> = logged.depth_m.iter().flat_map(|depth_m| depth_m.to_le_bytes()).collect();
        Self {
            colours: messages::compressed_image(header, format, &logged.rgb_file),
            depths: messages::image(header, size, "32FC1", &depths),
            labels: messages::image(header, size, "mono8", &logged.semantic),
        }
    }
}

/// Time of a frame, nanoseconds.
fn time_ns(flight: &PublishedFlight, frame: usize) -> u64 {
    START_NS + flight.times().ns(frame)
}

impl<'a> Recording<'a> {
    fn of(films: &'a [Film<'a>], sensors: &'a [SensorReadings], lidars: &'a [LidarSweeps]) -> Self {
        let episode = films[0].episode;
        let mut readings = vec![];
        for (number, (_, all)) in sensors.iter().enumerate() {
            let at = |(time_ns, values): &'a (u64, Vec<f64>)| (START_NS + time_ns, number, &values[..]);
            readings.extend(all.iter().map(at));
        }
        readings.sort_by_key(|(time_ns, number, ..)| (*time_ns, *number));
        let mut sweeps = vec![];
        for (number, (_, all)) in lidars.iter().enumerate() {
            sweeps.extend(all.iter().map(|sweep| (START_NS + sweep.time_ns, number, sweep)));
        }
        sweeps.sort_by_key(|(time_ns, number, _)| (*time_ns, *number));
        let followed = if episode.flight.target_kind.is_some() { &episode.frames[..] } else { &[] };
        Self {
            films,
            drone: episode.frames.iter().map(|row| in_map(&row.pose)).collect(),
            target: followed.iter().map(|row| in_map(&feet_pose(&row.target))).collect(),
            coders: sensors.iter().map(|(sensor, _)| ReadingCoder::of(sensor)).collect(),
            readings,
            lidars,
            sweeps,
        }
    }

    /// Transforms that stay, the town and the instruction.
    fn write_once(&self, bag: &mut Bag<'_>, source: &Source<'_>, instruction: &str) -> Result<()> {
        let still = Placed { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        let turned = |rotation: DQuat| Placed { rotation, ..still };
        let mut list = vec![("map", "odom", still)];
        for Film { episode, names, .. } in self.films {
            list.push((&names.link, &names.optical, turned(right_handed::BODY_FROM_OPTICAL)));
            if let (false, Some(row)) = (episode.flight.mount.levelled, episode.frames.first()) {
                list.push(("base_link", &names.link, camera_on_drone(&episode.flight.mount, &row.pose)));
            }
        }
        // Fixed to one airframe: what tells no place has the turn of the inertial unit, and its place.
        let unit = self.coders.iter().find(|coder| coder.has_pose());
        let beside = self.coders.iter().filter(|coder| coder.is_nowhere());
        list.extend(unit.iter().flat_map(|unit| beside.clone().map(|it| (unit.frame(), it.frame(), still))));
        bag.write(Topic::TfStatic, START_NS, &messages::transforms(START_NS, &list))?;
        let boxes = source.log(self.films[0].episode.flight)?.scene()?;
        bag.write(Topic::Town, START_NS, &messages::markers(Header { time_ns: START_NS, frame: "map" }, &boxes))?;
        bag.write(Topic::Instruction, START_NS, &messages::string(instruction))
    }

    /// Every `every`-th frame of all films, in the order of their times.
    fn write_frames(&self, bag: &mut Bag<'_>, every: usize) -> Result<()> {
        let mut moments: Vec<(u64, usize, usize)> = vec![];
        for (number, film) in self.films.iter().enumerate() {
            let of_film = film.episode.every_nth_frame(every).into_iter();
            moments.extend(of_film.map(|frame| (time_ns(film.episode.flight, frame), number, frame)));
        }
        moments.sort_unstable();
        let (mut rest, mut sweeps) = (&self.readings[..], &self.sweeps[..]);
        for some in moments.chunks(MOMENTS) {
            let mut pictures = self.pictures(some)?;
            for at @ (time_ns, number, frame) in some {
                let due = rest.partition_point(|(at_ns, ..)| at_ns <= time_ns);
                self.write_readings(bag, &rest[..due])?;
                rest = &rest[due..];
                let due = sweeps.partition_point(|(at_ns, ..)| at_ns <= time_ns);
                self.write_sweeps(bag, &sweeps[..due])?;
                sweeps = &sweeps[due..];
                if *number == 0 {
                    self.write_motion(bag, *frame)?;
                }
                if let Some(pictures) = pictures.remove(at) {
                    self.write_pictures(bag, *at, &pictures)?;
                }
            }
        }
        self.write_readings(bag, rest)?;
        self.write_sweeps(bag, sweeps)
    }

    /// Pictures at some moments: time, number of the film, and frame.
    fn pictures(&self, moments: &[(u64, usize, usize)]) -> Result<BTreeMap<(u64, usize, usize), Pictures>> {
        let mut found = BTreeMap::new();
        for (number, Film { episode, names, .. }) in self.films.iter().enumerate() {
            let frames: Vec<usize> = moments.iter().filter(|it| it.1 == number).map(|it| it.2).collect();
            let header = |frame| Header { time_ns: time_ns(episode.flight, frame), frame: &names.optical };
            let make = |frame: usize, logged: LoggedFrame| Ok(Pictures::of(header(frame), &logged));
            let take = |frame: usize, pictures| {
                found.insert((time_ns(episode.flight, frame), number, frame), pictures);
                Ok(())
            };
            match number {
                0 => episode.each_picture(&frames, make, take)?,
                _ => episode.each_picture_silently(&frames, make, take)?,
            }
        }
        Ok(found)
    }

    /// Messages of a camera at a moment, and the place of the drone, since the first film may have no frame then.
    fn write_pictures(
        &self,
        bag: &mut Bag<'_>,
        (time_ns, number, frame): (u64, usize, usize),
        pictures: &Pictures,
    ) -> Result<()> {
        let film @ Film { episode, names, .. } = &self.films[number];
        let flight = episode.flight;
        if number > 0 {
            let drone = &episode.frames[frame].pose;
            let mut list = vec![("odom", "base_link", in_map(drone))];
            if flight.mount.levelled {
                list.push(("base_link", &names.link, camera_on_drone(&flight.mount, drone)));
            }
            bag.write(Topic::Tf, time_ns, &messages::transforms(time_ns, &list))?;
        }
        let header = Header { time_ns, frame: &names.optical };
        let info = messages::camera_info(header, &flight.camera, &flight.lens, &flight.mount);
        bag.write(Topic::CameraInfo(number), time_ns, &info)?;
        bag.write(Topic::Image(number), time_ns, &pictures.colours)?;
        bag.write(Topic::DepthInfo(number), time_ns, &info)?;
        bag.write(Topic::Depth(number), time_ns, &pictures.depths)?;
        bag.write(Topic::Labels(number), time_ns, &pictures.labels)?;
        bag.write(Topic::Detections(number), time_ns, &messages::detections(header, &film.detected(frame)))
    }

    /// Readings, and the places of sensors that know theirs.
    fn write_readings(&self, bag: &mut Bag<'_>, readings: &[(u64, usize, &[f64])]) -> Result<()> {
        readings.iter().try_for_each(|(time_ns, number, values)| {
            let coder = &self.coders[*number];
            if let Some((frame, placed)) = coder.placed(values) {
                bag.write(Topic::Tf, *time_ns, &messages::transforms(*time_ns, &[("map", frame, placed)]))?;
            }
            bag.write(Topic::Sensor(*number), *time_ns, &coder.encode(*time_ns, values))
        })
    }

    /// Sweeps, and the places of the lidars at their beginnings.
    fn write_sweeps(&self, bag: &mut Bag<'_>, sweeps: &[(u64, usize, &LoggedSweep)]) -> Result<()> {
        sweeps.iter().try_for_each(|(time_ns, number, sweep)| {
            let frame = self.lidars[*number].0.as_str();
            let placed = Placed { position: sweep.position, rotation: sweep.rotation };
            bag.write(Topic::Tf, *time_ns, &messages::transforms(*time_ns, &[("map", frame, placed)]))?;
            let message = messages::point_cloud(Header { time_ns: *time_ns, frame }, &sweep.points);
            bag.write(Topic::Lidar(*number), *time_ns, &message)
        })
    }

    /// Clock, transforms and odometry.
    fn write_motion(&self, bag: &mut Bag<'_>, frame: usize) -> Result<()> {
        let Film { episode, names, .. } = &self.films[0];
        let flight = episode.flight;
        let time_ns = time_ns(flight, frame);
        bag.write(Topic::Clock, time_ns, &messages::clock(time_ns))?;
        let mut list = vec![("odom", "base_link", self.drone[frame])];
        if flight.mount.levelled {
            list.push(("base_link", &names.link, camera_on_drone(&flight.mount, &episode.frames[frame].pose)));
        }
        list.extend(self.target.get(frame).map(|placed| ("map", "target", *placed)));
        bag.write(Topic::Tf, time_ns, &messages::transforms(time_ns, &list))?;
        let odometry = |parent, child, places: &[Placed]| {
            let header = Header { time_ns, frame: parent };
            messages::odometry(header, child, &places[frame], &motion(places, frame, flight.dt_s))
        };
        bag.write(Topic::Odometry, time_ns, &odometry("odom", "base_link", &self.drone))?;
        if self.target.is_empty() {
            return Ok(());
        }
        bag.write(Topic::TargetOdometry, time_ns, &odometry("map", "target", &self.target))
    }
}

impl Film<'_> {
    /// The target, then the other bodies of a frame.
    fn detected(&self, frame: usize) -> Vec<Detected<'_>> {
        let kind = self.episode.flight.target_kind.as_deref().unwrap_or_default();
        let target = self.episode.frames[frame].visible_box_px;
        let target = target.map(|edges_px| Detected { kind, instance: TARGET_INSTANCE, edges_px });
        let number = frame as u32;
        let start = self.bodies.partition_point(|body| body.frame < number);
        let others = self.bodies[start..].iter().take_while(|body| body.frame == number);
        let others = others.map(|it| Detected { kind: &it.kind, instance: it.instance, edges_px: it.visible_box_px });
        target.into_iter().chain(others).collect()
    }
}

/// Place of a body with this world-frame pose in `map`; its axes are x ahead, y left, z up.
fn in_map(pose: &Pose) -> Placed {
    let position = right_handed::map_from_world_point(pose.position_in_world);
    Placed { position, rotation: right_handed::map_from_body(pose) }
}

/// Place of `camera_link` in `base_link`.
fn camera_on_drone(mount: &cosfly_domain::Mount, drone: &Pose) -> Placed {
    let rotation = right_handed::body_from_optical(mount, drone) * right_handed::BODY_FROM_OPTICAL.inverse();
    Placed { position: right_handed::camera_in_body(mount, drone), rotation }
}

/// Motion from a frame to the next one; in the last frame, from the one before.
fn motion(places: &[Placed], frame: usize, dt_s: f64) -> Motion {
    let from = frame.min(places.len().saturating_sub(2));
    let Some([start, end]) = places.get(from..).and_then(|rest| rest.first_chunk()) else { return Motion::default() };
    let turn = start.rotation.inverse() * end.rotation;
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let axis = DVec3::new(turn.x, turn.y, turn.z);
    let (sine, body) = (axis.length(), places[frame].rotation);
    let rate = if sine > 0.0 { axis * (2.0 * real::atan2(sine, turn.w) / (sine * dt_s)) } else { DVec3::ZERO };
    Motion { linear: body.inverse() * ((end.position - start.position) / dt_s), angular: rate }
}

const BODY: &str = "\
```
<split>/<thousands of flights>/<flight>/metadata.yaml
<split>/<thousands of flights>/<flight>/<flight>_0.mcap
```

```sh
ros2 bag play SPLIT/000/FLIGHT
```

```python
from pathlib import Path
import numpy
from rosbags.highlevel import AnyReader

for bag in sorted(Path(\"SPLIT\").glob(\"*/*\")):
    with AnyReader([bag]) as reader:
        for connection, time_ns, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic == \"/camera/depth/image_raw\":
                depth_m = numpy.frombuffer(message.data, numpy.float32).reshape(message.height, message.width)
            if connection.topic == \"/detections\":
                boxes = {found.id: (found.bbox.center.position, found.bbox.size_x, found.bbox.size_y) for found in message.detections}
```

A folder is a bag: MCAP, messages of ROS 2 Humble and later in CDR, with their definitions. Topics whose last message stays
(`transient_local`) are marked with *.

| topic | type | content |
| --- | --- | --- |
| `/tf_static`* | `tf2_msgs/TFMessage` | `map` to `odom` (the same: nothing drifts), `camera_link` to `camera_optical_frame`, `base_link` to `camera_link` |
| `/tf` | `tf2_msgs/TFMessage` | `odom` to `base_link`, `map` to `target`; `base_link` to `camera_link` where the mount keeps the camera level |
| `/clock` | `rosgraph_msgs/Clock` | the time of the frame; the first one is at 1 s, because time 0 means \"no time\" |
| `/odom`, `/target/odom` | `nav_msgs/Odometry` | true pose; motion to the next frame, along the body's axes |
| `/camera/image_raw/compressed` | `sensor_msgs/CompressedImage` | the colours, as in the dataset's log |
| `/camera/depth/image_raw` | `sensor_msgs/Image` | `32FC1`, metres along the optical axis; infinity is the sky |
| `/camera/semantic/image_raw` | `sensor_msgs/Image` | `mono8`, CARLA's labels |
| `/camera/camera_info`, `/camera/depth/camera_info` | `sensor_msgs/CameraInfo` | the pinhole, with `plumb_bob` (k1, k2) or, of a fisheye, `equidistant` (k1 to k4); the right camera of a pair has the base line in P |
| `/detections` | `vision_msgs/Detection2DArray` | boxes around visible pixels, with the body's kind; `id` is the dataset's instance id, 1 the target. No poses |
| `/sensor/NAME` | by its columns | readings of each sensor that the dataset has, in the frame `NAME`: inertial units as `sensor_msgs/Imu`, receivers as \
`NavSatFix`, barometers as `FluidPressure`, magnetometers as `MagneticField`; others as `std_msgs/Float64MultiArray`, \
the label of whose only dimension names the quantities. `/tf` has the true place of each inertial unit and receiver, `map` to `NAME`; \
barometers and magnetometers hang at the inertial unit in `/tf_static` |
| `/sensor/LIDAR` | `sensor_msgs/PointCloud2` | sweeps of each lidar, in the frame `LIDAR` at the time of each point's shot; `/tf` has its \
place at the beginning of the sweep |
| `/town`* | `visualization_msgs/MarkerArray` | boxes of obstacles near the flight |
| `/instruction`* | `std_msgs/String` | what the drone is told |

Where several cameras filmed a flight, its bag has all of them: topics `/camera/NAME/camera_info`, `/camera/NAME/image_raw/compressed`,
`/camera/NAME/depth/...`, `/camera/NAME/semantic/image_raw` and `/camera/NAME/detections`, frames `camera_NAME_link` and `camera_NAME_optical_frame`, each
camera at its own times. Motion is that of the film with the most frames a second; a sensor that was read along several films is that of the
first one.

Frames are those of REP 103 and REP 105: x ahead, y left, z up, right-handed; the optical frame is x right, y down, z ahead. A point
(x, y, z) of the dataset's left-handed world is (x, -y, z) in `map`; yaw and pitch change their sign. The origin of `target` is
between its feet. In pictures the middle of the top-left pixel is (0, 0), so that an edge of the dataset's tables is half a pixel
less here. Covariances are zero: not known. Vectors of sensors have the axes x ahead, y left, z up, too; an angular velocity changes the
signs of x and z. The height of `NavSatFix` is above the world's origin.
";
