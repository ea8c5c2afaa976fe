//! Tables of sensors of motion against the poses of their flights, and what was measured against the truth beside it.

use crate::flights::Flights;
use crate::readings::{self, Carrying, LONGEST_ARM_M};
use crate::report::VerifyReport;
use crate::rows::PlacedFlight;
use crate::sensed_rows::SensedRows;
use arrow_array::cast::AsArray;
use arrow_schema::ArrowError;
use cosfly_diagnose::counted;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DMat3, DVec3, Pose, real};
use cosfly_geometry::BoxBvh;
use cosfly_read::LogReader;
use cosfly_schema::extras::is_taken;
use cosfly_schema::log::reading::{LoggedSensor, TOPICS, TRUE};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

/// Frames whose pictures tell where the ground is, points of each, and their farthest depth, metres.
const GROUND_FRAMES: usize = 5;
const GROUND_POINTS: usize = 2000;
const GROUND_M: f64 = 60.0;

/// Acceleration of free fall, m/s^2.
const GRAVITY_MPS2: f64 = 9.81;
/// Longest step between inertial readings that can be added up, seconds.
const LONGEST_STEP_S: f64 = 0.02;
/// Errors allowed of what inertial readings add up to from one frame to the next: metres, m/s, radians.
const ALLOWED: [f64; 3] = [2e-3, 5e-3, 2e-3];
/// Share of the way, of the change of velocity and of the turn that is allowed beside.
const ALLOWED_SHARE: f64 = 0.02;

/// Errors that readings may have: beginning and end of the column's name, root mean square, and density of white noise, which adds more the
/// higher the rate. Constant errors of five standard deviations pass. Those of a receiver are for a dilution of 1.
const NOISE: [(&str, &str, f64, f64); 6] = [
    ("altitude_", "m", 4.0, 0.0),
    ("field_", "_ut", 2.5, 0.0),
    ("force_", "_mps2", 0.1, 1.83e-3),
    ("pressure_", "hpa", 0.4, 0.0),
    ("rate_", "_rad_s", 5e-3, 1.92e-4),
    ("velocity_", "_mps", 1.0, 0.0),
];
/// Root mean square of a receiver's errors of position for a dilution of 1, metres.
const RECEIVER_M: f64 = 15.0;

/// Checks every table that has true columns, and those that a log has as a sensor's.
pub fn check(flights: &Flights<'_>, report: &mut VerifyReport) {
    let mut towns = None;
    for file in flights.files.sound_below("data/") {
        let Some(table) = file.split('/').nth(1).filter(|table| !is_taken(table)) else { continue };
        let read = each_flight(&flights.folder.join(file), &mut |id, rows, has_truth| {
            let Some(number) = flights.tables.flights.number(id).filter(|number| flights.wanted.has(*number)) else {
                return;
            };
            let flight = flights.tables.flights.at(number);
            // A log that cannot be opened is found elsewhere.
            let log = LogReader::open(&flights.folder.join(&flight.mcap_path), flight.times()).ok();
            let is_of_log = |log: &LogReader| log.sensors().into_iter().find(|sensor| sensor.name == table);
            let logged = log.and_then(|log| Some((is_of_log(&log)?, log)));
            if !has_truth && logged.is_none() {
                return;
            }
            let begins_s = flight.times().s(0);
            let is_altimeter = ["range_m", "is_hit"].iter().all(|name| rows.numbers.contains_key(*name));
            let mut ground = vec![];
            let in_log = logged.map_or(Ok(()), |(sensor, mut log)| {
                if is_altimeter {
                    ground = seen_ground(flight, &mut log);
                }
                compare(rows, &sensor, &log.readings(&sensor).map_err(|error| error.to_string())?)
            });
            if let Err(message) = in_log {
                report.find(&flight.mcap_path, format!("`{TOPICS}{table}`"), "verify-sensor", message);
            }
            rows.times_s.iter_mut().for_each(|time_s| *time_s -= begins_s);
            let tracks = flights.tracks(&[number].into());
            let Some(track) = tracks.get(&number) else { return };
            ground.extend(&track.feet);
            let towns = is_altimeter.then(|| towns.get_or_insert_with(|| boxes_of_towns(flights)));
            let carrying = Carrying {
                poses: &track.poses,
                ground: &ground,
                dt_s: flight.dt_s,
                origin: flight.origin,
                boxes: towns.and_then(|towns| towns.get(&flight.town)),
            };
            // Perturbed flights jump as no drone does: their readings are too far apart to be added up.
            let found = rows.finding(&track.poses, flight.dt_s, flight.expert_id.is_none());
            if let Err(message) = found.and_then(|()| readings::check(rows, &carrying)) {
                report.find(file, format!("`{id}`"), "verify-sensor", message);
            }
        });
        if let Err(error) = read {
            report.find_damage(file, format!("it cannot be read: {error}"));
        }
    }
}

/// Points of the ground that some frames show, world frame; none through a lens.
fn seen_ground(flight: &PlacedFlight, log: &mut LogReader) -> Vec<DVec3> {
    let (frames, mut points) = (flight.frames, vec![]);
    if !flight.lens.is_none() || flight.readout_s > 0.0 {
        return points;
    }
    let (centre_u, centre_v, focal_px) = flight.camera.centre_and_focal_px();
    for frame in (0..GROUND_FRAMES).map(|number| number * frames.saturating_sub(1) / (GROUND_FRAMES - 1)) {
        // Damage of pictures is found elsewhere.
        let Ok(logged) = log.frame_with_instances(frame) else { continue };
        let width = logged.width as usize;
        let step = (logged.instance.len() / GROUND_POINTS).max(1);
        for pixel in (0..logged.instance.len()).step_by(step).filter(|pixel| logged.instance[*pixel] == 0) {
            let depth_m = f64::from(logged.depth_m[pixel]);
            let [u, v] = [pixel % width, pixel / width].map(|at| at as f64 + 0.5);
            let ray = DVec3::new((u - centre_u) / focal_px, (v - centre_v) / focal_px, 1.0);
            let in_map = logged.camera_in_map + logged.map_from_optical * (depth_m * ray);
            if depth_m < GROUND_M {
                points.push(DVec3::new(in_map.x, -in_map.y, in_map.z));
            }
        }
    }
    points
}

/// All boxes of each town; damage of the table is reported elsewhere.
fn boxes_of_towns(flights: &Flights<'_>) -> BTreeMap<String, BoxBvh> {
    let mut found: BTreeMap<String, Vec<OrientedBox>> = BTreeMap::new();
    flights.each_box(&mut |_, _, town, shape| {
        found.entry(town).or_default().push(shape);
        Ok(())
    });
    found.into_iter().map(|(town, list)| (town, BoxBvh::build(list))).collect()
}

/// Compares the readings of a flight with those of its log.
///
/// # Errors
/// The first difference, in words.
fn compare(rows: &SensedRows, sensor: &LoggedSensor, logged: &[(u64, Vec<f64>)]) -> Result<(), String> {
    if logged.len() != rows.times_s.len() {
        return Err(format!("it has {}, the table has {}", counted(logged.len(), "reading"), rows.times_s.len()));
    }
    for (row, ((time_ns, numbers), time_s)) in logged.iter().zip(&rows.times_s).enumerate() {
        let at_s = *time_ns as f64 / 1e9;
        if (at_s - time_s).abs() > 1e-6 {
            return Err(format!("reading {row} is at {at_s} s; the table has it at {time_s} s"));
        }
        for (name, number) in sensor.quantities.iter().zip(numbers) {
            let in_table = rows.numbers.get(name).and_then(|list| list.get(row));
            if in_table != Some(number) {
                return Err(format!("reading {row}: `{name}` is {number}; the table has {in_table:?}"));
            }
        }
    }
    Ok(())
}

/// Gives the readings of each flight of a file; none where it has no frames and times. The last argument says
/// whether there are true columns.
fn each_flight(path: &Path, visit: &mut dyn FnMut(&str, &mut SensedRows, bool)) -> Result<(), ArrowError> {
    let builder = ParquetRecordBatchReaderBuilder::try_new(File::open(path)?)?;
    let has = |name: &str| builder.schema().field_with_name(name).is_ok();
    let has_truth = builder.schema().fields().iter().any(|field| field.name().starts_with(TRUE));
    if !(has("trajectory_id") && has("frame") && has("time_s")) {
        return Ok(());
    }
    // Clouds of lidars stay unread: a batch of them may be larger than an array can be.
    let fields = builder.schema().fields().iter().enumerate();
    let is_read = |field: &arrow_schema::FieldRef| field.data_type().is_numeric() || field.name() == "trajectory_id";
    let kept: Vec<usize> = fields.filter(|(_, field)| is_read(field)).map(|(place, _)| place).collect();
    let mask = ProjectionMask::roots(builder.parquet_schema(), kept);
    let (mut id, mut rows) = (String::new(), SensedRows::default());
    for batch in builder.with_projection(mask).build()? {
        let batch = batch?;
        let Some(ids) = batch.column_by_name("trajectory_id").and_then(|column| column.as_string_opt::<i32>()) else {
            return Ok(());
        };
        let mut from = 0;
        while from < batch.num_rows() {
            let own = ids.value(from);
            let count = (from..batch.num_rows()).take_while(|row| ids.value(*row) == own).count();
            if own != id {
                visit(&id, &mut std::mem::take(&mut rows), has_truth);
                own.clone_into(&mut id);
            }
            rows.push(&batch.slice(from, count));
            from += count;
        }
    }
    visit(&id, &mut rows, has_truth);
    Ok(())
}

impl SensedRows {
    /// Faults of the readings of a flight with these poses, in words.
    ///
    /// # Errors
    /// The first fault, in words.
    fn finding(&self, poses: &[Pose], dt_s: f64, is_smooth: bool) -> Result<(), String> {
        let count = self.times_s.len();
        if self.frames.len() != count || self.numbers.values().any(|list| list.len() != count) {
            return Err("a column has another type than its readings".to_owned());
        }
        self.check_times(poses.len(), dt_s)?;
        self.check_errors()?;
        self.check_places(poses, dt_s)?;
        if is_smooth { self.check_sums() } else { Ok(()) }
    }

    /// Readings come evenly, from the first frame on, each with the frame of its time.
    fn check_times(&self, frames: usize, dt_s: f64) -> Result<(), String> {
        let step_s = self.step_s();
        for (row, (time_s, frame)) in self.times_s.iter().zip(&self.frames).enumerate() {
            let (due_s, due) = (row as f64 * step_s, (time_s / dt_s + 1e-6) as i64);
            if (time_s - due_s).abs() > 1e-6 || !time_s.is_finite() {
                return Err(format!("reading {row} is at {time_s} s; readings {step_s} s apart have it at {due_s} s"));
            }
            if *frame != due || *frame >= frames as i64 {
                return Err(format!("reading {row}, at {time_s} s, is of frame {frame}; at that time it is {due}"));
            }
        }
        Ok(())
    }

    /// Measured numbers are near the truth.
    fn check_errors(&self) -> Result<(), String> {
        let is_fix = self.numbers.get("is_fix");
        for (name, measured) in &self.numbers {
            let Some(exact) = self.numbers.get(&format!("{TRUE}{name}")) else { continue };
            let dilution = match name.as_str() {
                "east_m" | "north_m" | "velocity_east_mps" | "velocity_north_mps" => {
                    self.numbers.get("horizontal_dilution")
                }
                "up_m" | "velocity_up_mps" => self.numbers.get("vertical_dilution"),
                _ => None,
            };
            let noise = NOISE.iter().find(|(start, end, ..)| name.starts_with(start) && name.ends_with(end));
            let noise = noise.map(|(_, _, rms, density)| rms + 2.0 * density / self.step_s().max(1e-6).sqrt());
            let Some(allowed) = noise.or(dilution.map(|_| RECEIVER_M)) else { continue };
            let (mut sum, mut rows) = (0.0, 0);
            for row in (0..measured.len()).filter(|row| is_fix.is_none_or(|fix| fix[*row] == 1.0)) {
                let error = (measured[row] - exact[row]) / dilution.map_or(1.0, |list| list[row].max(0.5));
                sum += error * error;
                rows += 1;
            }
            let error = (sum / f64::from(rows.max(1))).sqrt();
            if exceeds(error, allowed) {
                return Err(format!(
                    "`{name}` is {error:.3} from `{TRUE}{name}` on the mean; noise explains {allowed:.3}"
                ));
            }
        }
        Ok(())
    }

    /// The sensor is where the drone carries it: at readings on a frame, one arm from the frame's position.
    fn check_places(&self, poses: &[Pose], dt_s: f64) -> Result<(), String> {
        let turns = self.quaternions();
        let places = self.vectors(["true_x_m", "true_y_m", "true_z_m"]);
        let east_north = self.vectors(["true_east_m", "true_north_m", "true_up_m"]);
        let places =
            places.or(east_north.map(|list| list.into_iter().map(|it| DVec3::new(it.x, -it.y, it.z)).collect()));
        let heights = self.numbers.get("true_altitude_m");
        let mut first: Option<DVec3> = None;
        for (row, time_s) in self.times_s.iter().enumerate() {
            let at = time_s / dt_s;
            let Some(pose) = poses.get(at.round() as usize).filter(|_| (at - at.round()).abs() < 1e-6) else {
                continue;
            };
            let from = pose.position_in_world;
            let far = match (&places, heights) {
                (Some(places), _) => {
                    let away = places[row] - from;
                    let arm = turns.as_ref().map_or(DVec3::new(away.length(), 0.0, 0.0), |list| {
                        DMat3::from_quat(list[row]).transpose() * away
                    });
                    let expected = *first.get_or_insert(arm);
                    (arm.length() > LONGEST_ARM_M || arm.distance(expected) > 2e-3).then_some(arm.distance(expected))
                }
                (None, Some(heights)) => {
                    let away_m = (heights[row] - from.z).abs();
                    (away_m > LONGEST_ARM_M).then_some(away_m)
                }
                (None, None) => return Ok(()),
            };
            if let Some(far) = far {
                return Err(format!("reading {row}: its true place is {far:.3} m from where frame {at:.0} carries it"));
            }
        }
        Ok(())
    }

    /// True inertial readings add up, from frame to frame, to the true velocities, places and turns.
    fn check_sums(&self) -> Result<(), String> {
        let step_s = self.step_s();
        let vectors = |names: [&str; 3]| self.vectors(names);
        let (Some(turns), Some(force), Some(rates), Some(velocity), Some(place)) = (
            self.quaternions(),
            vectors(["true_force_x_mps2", "true_force_y_mps2", "true_force_z_mps2"]),
            vectors(["true_rate_x_rad_s", "true_rate_y_rad_s", "true_rate_z_rad_s"]),
            vectors(["true_velocity_x_mps", "true_velocity_y_mps", "true_velocity_z_mps"]),
            vectors(["true_x_m", "true_y_m", "true_z_m"]),
        ) else {
            return Ok(());
        };
        if step_s > LONGEST_STEP_S {
            return Ok(());
        }
        let attitudes: Vec<DMat3> = turns.iter().map(|turn| DMat3::from_quat(*turn)).collect();
        let felt = |row: usize| attitudes[row] * force[row] - GRAVITY_MPS2 * DVec3::Z;
        let mut errors = [(DVec3::ZERO, 0.0); 3];
        for row in 1..place.len() {
            if self.frames[row] != self.frames[row - 1] {
                errors = [(DVec3::ZERO, 0.0); 3];
            }
            let mean = |list: &[DVec3]| 0.5 * step_s * (list[row - 1] + list[row]);
            let turn = turn_between(&attitudes[row - 1], &attitudes[row]);
            let steps = [
                (place[row] - place[row - 1], mean(&velocity)),
                (velocity[row] - velocity[row - 1], 0.5 * step_s * (felt(row - 1) + felt(row))),
                (turn, mean(&rates)),
            ];
            let what = [
                "velocities do not add up to its places",
                "force does not add up to its velocities",
                "angular velocity does not add up to its turns",
            ];
            for ((error, way), (step, read)) in errors.iter_mut().zip(steps) {
                (*error, *way) = (*error + step - read, *way + step.length());
            }
            for ((error, way), (allowed, what)) in errors.iter().zip(ALLOWED.iter().zip(what)) {
                if exceeds(error.length(), allowed + ALLOWED_SHARE * way) {
                    let time_s = self.times_s[row];
                    return Err(format!("reading {row}, at {time_s} s: the true {what}, by {:.4}", error.length()));
                }
            }
        }
        Ok(())
    }
}

/// Turn from one attitude to the next, along the axes of the first, radians.
fn turn_between(before: &DMat3, after: &DMat3) -> DVec3 {
    let turned = before.transpose() * *after;
    let axis = DVec3::new(
        turned.y_axis.z - turned.z_axis.y,
        turned.z_axis.x - turned.x_axis.z,
        turned.x_axis.y - turned.y_axis.x,
    );
    let (twice_sine, twice_cosine) = (axis.length(), turned.x_axis.x + turned.y_axis.y + turned.z_axis.z - 1.0);
    if twice_sine < 1e-9 { 0.5 * axis } else { axis * (real::atan2(twice_sine, twice_cosine) / twice_sine) }
}

/// Whether a number is more than is allowed, or none.
fn exceeds(number: f64, allowed: f64) -> bool {
    number.is_nan() || number > allowed
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.25;

    /// A sensor at 200 Hz that swings to the side, 0.1 m ahead of a drone that turns with it; and the drone's poses.
    fn swinging() -> (SensedRows, Vec<Pose>) {
        let pose = |time_s: f64| Pose {
            position_in_world: DVec3::new(3.0 * time_s, real::sin(time_s), 20.0),
            pitch_rad: 0.0,
            yaw_rad: 0.5 * time_s,
            roll_rad: 0.0,
        };
        let poses = (0..9).map(|frame| pose(f64::from(frame) * DT_S)).collect();
        let mut rows = SensedRows::default();
        for step in 0..=400_i32 {
            let time_s = f64::from(step) / 200.0;
            rows.times_s.push(time_s);
            rows.frames.push(i64::from(step / 50));
            let body = pose(time_s);
            let (ahead, right) = (body.world_from_body().x_axis, body.world_from_body().y_axis);
            let place = body.position_in_world + 0.1 * ahead;
            let velocity = DVec3::new(3.0, real::cos(time_s), 0.0) + 0.05 * right;
            let acceleration = DVec3::new(0.0, -real::sin(time_s), 0.0) - 0.025 * ahead;
            let force = body.world_from_body().transpose() * (acceleration + GRAVITY_MPS2 * DVec3::Z);
            let (sin, cos) = real::sin_cos(0.25 * time_s);
            let mut push = |name: String, value: f64| rows.numbers.entry(name).or_default().push(value);
            for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                for start in ["", TRUE] {
                    push(format!("{start}force_{letter}_mps2"), force[axis]);
                    push(format!("{start}rate_{letter}_rad_s"), [0.0, 0.0, 0.5][axis]);
                }
                push(format!("true_velocity_{letter}_mps"), velocity[axis]);
                push(format!("true_{letter}_m"), place[axis]);
            }
            for (name, value) in [("x", 0.0), ("y", 0.0), ("z", sin), ("w", cos)] {
                push(format!("true_q{name}"), value);
            }
        }
        (rows, poses)
    }

    #[test]
    fn sound_readings_pass_and_every_planted_fault_is_found() {
        let (sound, poses) = swinging();
        assert_eq!(sound.finding(&poses, DT_S, true), Ok(()));
        let found = |words: &str, plant: &dyn Fn(&mut SensedRows)| {
            let mut rows = sound.clone();
            plant(&mut rows);
            let problem = rows.finding(&poses, DT_S, true).expect_err(words);
            assert!(problem.contains(words), "{words}: {problem}");
        };
        let scale = |rows: &mut SensedRows, name: &str, factor: f64| {
            rows.numbers.get_mut(name).expect("a column").iter_mut().for_each(|value| *value *= factor);
        };
        let swap = |rows: &mut SensedRows, a: &str, b: &str| {
            let [first, second] = [a, b].map(|name| rows.numbers.remove(name).expect("a column"));
            rows.numbers.extend([(a.to_owned(), second), (b.to_owned(), first)]);
        };
        // Time stamps: all of them, and one.
        found("reading 0 is at", &|rows| rows.times_s.iter_mut().for_each(|time_s| *time_s += 0.01));
        found("reading 7 is at", &|rows| rows.times_s[7] += 0.001);
        found("is of frame", &|rows| rows.frames[60] = 0);
        // All numbers a reading late.
        found("frame 1 carries it", &|rows| rows.numbers.values_mut().for_each(|list| list.rotate_right(1)));
        for (start, words) in [("", "noise explains"), (TRUE, "noise explains")] {
            let name = |rest: &str| format!("{start}{rest}");
            found(words, &|rows| scale(rows, &name("force_z_mps2"), -1.0));
            found(words, &|rows| scale(rows, &name("force_z_mps2"), 1.02));
            found(words, &|rows| scale(rows, &name("rate_z_rad_s"), -1.0));
            found(words, &|rows| scale(rows, &name("rate_z_rad_s"), 1.05));
            found(words, &|rows| swap(rows, &name("force_x_mps2"), &name("force_y_mps2")));
            found(words, &|rows| swap(rows, &name("rate_x_rad_s"), &name("rate_z_rad_s")));
        }
        // Measured and true readings alike: what they add up to tells.
        for (name, words) in [("force_y_mps2", "force does not add up"), ("rate_z_rad_s", "angular velocity does not")]
        {
            for factor in [-1.0, 1.1] {
                found(words, &|rows| {
                    ["", TRUE].iter().for_each(|start| scale(rows, &format!("{start}{name}"), factor))
                });
            }
        }
        found("velocities do not add up", &|rows| scale(rows, "true_velocity_x_mps", 1.05));
        found("carries it", &|rows| scale(rows, "true_y_m", -1.0));
        found("carries it", &|rows| swap(rows, "true_x_m", "true_z_m"));
        found("carries it", &|rows| scale(rows, "true_qz", -1.0));
    }
}
