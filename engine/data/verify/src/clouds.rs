//! Tables of sweeps of lidars against the boxes of their towns: a share of the points is cast again.

use crate::flights::Flights;
use crate::report::VerifyReport;
use crate::rows::ReadResult;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use cosfly_diagnose::counted;
use cosfly_domain::{ObstacleKind, OrientedBox, SemanticLabel};
use cosfly_frames::{DMat3, DQuat, DVec3, Pose, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_read::{LogReader, LoggedSweep};
use cosfly_schema::extras::is_taken;
use cosfly_schema::log::cloud::{COLUMN, CloudPoint, POINT_BYTES, POSE};
use cosfly_schema::log::reading::TOPICS;
use cosfly_schema::tables::{Objects, kind_name};
use cosfly_sensors::SmoothFlight;
use cosfly_sensors::lidar::reflectivity;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

/// One point of so many is cast again.
const ONE_OF: usize = 61;
/// Distance between a point and what its ray meets that noise explains, metres.
const ALLOWED_M: f64 = 0.15;
/// Share of the points that may be wrong: rounded rays beside edges.
const ALLOWED_SHARE: f64 = 0.02;

/// Largest depth of a drawn pitched roof, which rays meet, below the upper face of its box, metres.
const ROOF_M: f64 = 1.6;
/// Share of a crown's box around its middle that round crowns fill; boxes so many times longer than wide are rows of trees,
/// with gaps anywhere.
const CORE: f64 = 0.25;
const ROW: f64 = 3.0;

/// Boxes of a town that rays meet as boxes: cars are drawn as vehicles.
struct Boxes {
    /// Boxes that no ray passes: buildings without their roofs, the middles of crowns; benches, stalls and static things are open.
    solid: BoxBvh,
    /// All boxes by their instance id.
    things: BTreeMap<u32, Vec<OrientedBox>>,
    /// Labels of an instance id, cars among them.
    labels: BTreeMap<u32, Vec<u8>>,
}

/// Kinds whose things may be drawn of parts that rays pass between: boats and things to play on are of kind `static`.
const OPEN_KINDS: [ObstacleKind; 3] = [ObstacleKind::Bench, ObstacleKind::Stall, ObstacleKind::Static];

/// How much of a box is drawn.
#[derive(Clone, Copy)]
enum Filled {
    All,
    /// All but a slope in its highest step.
    BelowRoof,
    Crown,
    /// Boards and posts alone.
    Parts,
}

impl Filled {
    fn of(label: SemanticLabel, kind: &str) -> Self {
        match label {
            _ if OPEN_KINDS.map(kind_name).contains(&kind) => Self::Parts,
            SemanticLabel::Building => Self::BelowRoof,
            SemanticLabel::Vegetation => Self::Crown,
            _ => Self::All,
        }
    }
}

impl Boxes {
    fn new(list: &[(u32, Filled, OrientedBox)]) -> Self {
        let mut things: BTreeMap<u32, Vec<OrientedBox>> = BTreeMap::new();
        list.iter().for_each(|(instance, _, shape)| things.entry(*instance).or_default().push(*shape));
        let solid = list.iter().map(|(_, filled, shape)| {
            let off_m = if matches!(filled, Filled::BelowRoof) { 0.5 * ROOF_M * DVec3::Z } else { DVec3::ZERO };
            let [least_m, most_m] = [
                shape.half_extents_m.x.min(shape.half_extents_m.y),
                shape.half_extents_m.x.max(shape.half_extents_m.y),
            ];
            let core = match filled {
                Filled::Parts => DVec3::ZERO,
                Filled::Crown if most_m >= ROW * least_m => DVec3::ZERO,
                Filled::Crown => DVec3::new(CORE, CORE, 1.0),
                Filled::All | Filled::BelowRoof => DVec3::ONE,
            };
            OrientedBox {
                center_in_world: shape.center_in_world - off_m,
                half_extents_m: core * (shape.half_extents_m - off_m),
                ..*shape
            }
        });
        let solid = BoxBvh::build(solid.filter(|shape| shape.half_extents_m.min_element() > 0.0).collect());
        Self { solid, things, labels: BTreeMap::new() }
    }
}

/// A sweep of a table.
struct Sweep {
    time_s: f64,
    position: DVec3,
    world_from_sensor: DMat3,
    points: Vec<CloudPoint>,
}

/// Checks every table of sweeps.
pub fn check(flights: &Flights<'_>, report: &mut VerifyReport) {
    let mut towns = None;
    for file in flights.files.sound_below("data/") {
        let Some(table) = file.split('/').nth(1).filter(|table| !is_taken(table)) else { continue };
        let read = each_flight(&flights.folder.join(file), &mut |id, sweeps| {
            let Some(number) = flights.tables.flights.number(id).filter(|number| flights.wanted.has(*number)) else {
                return;
            };
            let flight = flights.tables.flights.at(number);
            sweeps.iter_mut().for_each(|sweep| sweep.time_s -= flight.times().s(0));
            let towns = towns.get_or_insert_with(|| boxes_of_towns(flights));
            if let (Some(track), Some(boxes)) = (flights.tracks(&[number].into()).get(&number), towns.get(&flight.town))
                && let Err(message) = finding(sweeps, &track.poses, flight.dt_s, boxes)
            {
                report.find(file, format!("`{id}`"), "verify-cloud", message);
            }
            // A log that cannot be opened is found elsewhere.
            let log = flights.folder.join(&flight.mcap_path);
            if let (Ok(mut log), false) = (LogReader::open(&log, flight.times()), sweeps.is_empty()) {
                let logged = log.sweeps(table).map_err(|error| error.to_string());
                if let Err(message) = logged.and_then(|logged| compare(sweeps, &logged, flight.begins_ns)) {
                    report.find(&flight.mcap_path, format!("`{TOPICS}{table}`"), "verify-cloud", message);
                }
            }
        });
        if let Err(message) = read {
            report.find_damage(file, message);
        }
    }
}

/// Boxes of each town; damage of the table is reported elsewhere.
fn boxes_of_towns(flights: &Flights<'_>) -> BTreeMap<String, Boxes> {
    let mut found: BTreeMap<String, Vec<(u32, Filled, OrientedBox)>> = BTreeMap::new();
    let mut labels: BTreeMap<String, BTreeMap<u32, Vec<u8>>> = BTreeMap::new();
    flights.each_box(&mut |rows, row, town, shape| {
        let (label, instance) = (rows.get(Objects::label, row)?, rows.get(Objects::instance, row)?);
        let own: &mut Vec<u8> = labels.entry(town.clone()).or_default().entry(instance).or_default();
        own.push(label.id());
        let list = found.entry(town).or_default();
        if label != SemanticLabel::Car {
            let filled = Filled::of(label, &rows.get(Objects::kind, row)?);
            list.push((instance, filled, shape));
        }
        Ok(())
    });
    let boxes = |(town, list): (String, Vec<(u32, Filled, OrientedBox)>)| {
        let labels = labels.remove(&town).unwrap_or_default();
        (town, Boxes { labels, ..Boxes::new(&list) })
    };
    found.into_iter().map(boxes).collect()
}

/// Gives the sweeps of each flight of a file; none where it has no clouds.
///
/// # Errors
/// Damage of the file or of a cloud, in words.
fn each_flight(path: &Path, visit: &mut dyn FnMut(&str, &mut [Sweep])) -> ReadResult<()> {
    let in_words = |error: &dyn std::fmt::Display| format!("it cannot be read: {error}");
    let opened = File::open(path).map_err(|error| in_words(&error))?;
    let builder = ParquetRecordBatchReaderBuilder::try_new(opened).map_err(|error| in_words(&error))?;
    let builder = builder.with_batch_size(16);
    let has = |name: &str| builder.schema().field_with_name(name).is_ok();
    if !["trajectory_id", "time_s", COLUMN].into_iter().chain(POSE).all(has) {
        return Ok(());
    }
    let (mut id, mut sweeps, mut first) = (String::new(), vec![], 0);
    for batch in builder.build().map_err(|error| in_words(&error))? {
        let batch = batch.map_err(|error| format!("row {first} or one after it cannot be read: {error}"))?;
        let column = |name: &str| batch.column_by_name(name);
        let reals = |name: &str| column(name)?.as_primitive_opt::<Float64Type>();
        let ids = column("trajectory_id").and_then(|it| it.as_string_opt::<i32>());
        let clouds = column(COLUMN).and_then(|it| it.as_binary_opt::<i32>());
        let pose: Option<Vec<_>> = POSE.into_iter().map(reals).collect();
        let (Some(ids), Some(clouds), Some(times_s), Some(pose)) = (ids, clouds, reals("time_s"), pose) else {
            return Ok(());
        };
        let counts = column("points").and_then(|it| it.as_primitive_opt::<Int64Type>());
        for row in 0..batch.num_rows() {
            if ids.value(row) != id {
                visit(&id, &mut std::mem::take(&mut sweeps));
                ids.value(row).clone_into(&mut id);
            }
            let at = |place: usize| pose[place].value(row);
            let turn = DQuat::from_xyzw(at(3), at(4), at(5), at(6)).normalize();
            sweeps.push(Sweep {
                time_s: times_s.value(row),
                position: DVec3::new(at(0), at(1), at(2)),
                world_from_sensor: DMat3::from_quat(turn),
                points: points_of(clouds.value(row), counts.map(|it| it.value(row)))
                    .map_err(|message| format!("row {}, `{id}`: {message}", first + row))?,
            });
        }
        first += batch.num_rows();
    }
    visit(&id, &mut sweeps);
    Ok(())
}

/// The points of a cloud whose row says that there are `count`.
///
/// # Errors
/// The cloud is cut, has another number of points, or has a number that is not finite.
fn points_of(cloud: &[u8], count: Option<i64>) -> ReadResult<Vec<CloudPoint>> {
    let (points, rest) = cloud.as_chunks::<POINT_BYTES>();
    if !rest.is_empty() {
        return Err(format!("column `{COLUMN}` has {}, no multiple of {POINT_BYTES}", counted(cloud.len(), "byte")));
    }
    if let Some(count) = count.filter(|count| usize::try_from(*count) != Ok(points.len())) {
        return Err(format!("column `points` says {count}, column `{COLUMN}` has {}", counted(points.len(), "point")));
    }
    let points: Vec<CloudPoint> = points.iter().map(CloudPoint::of).collect();
    match points.iter().position(|point| !point.is_finite()) {
        Some(place) => Err(format!("point {place} has a number that is not finite")),
        None => Ok(points),
    }
}

/// Compares the sweeps of a flight with those of its log, where y is to the left.
///
/// # Errors
/// The first difference, in words.
fn compare(sweeps: &[Sweep], logged: &[LoggedSweep], begins_ns: u64) -> ReadResult<()> {
    if sweeps.len() != logged.len() {
        return Err(format!("it has {}, the table has {}", counted(logged.len(), "sweep"), sweeps.len()));
    }
    for (number, (sweep, logged)) in sweeps.iter().zip(logged).enumerate() {
        if sweep.points.len() != logged.points.len() {
            let [here, there] = [logged.points.len(), sweep.points.len()];
            return Err(format!(
                "sweep {number} has {here}, that of the table has {there}",
                here = counted(here, "point")
            ));
        }
        let at_s = (logged.time_ns as f64 - begins_ns as f64) / 1e9;
        let off_m = logged.position.distance(sweep.position * DVec3::new(1.0, -1.0, 1.0));
        if (at_s - sweep.time_s).abs() > 1e-6 || off_m > 1e-6 {
            let (there_s, here_s) = (sweep.time_s, at_s);
            return Err(format!(
                "sweep {number} is {here_s} s after the first frame, {off_m} m from that of the table, at {there_s} s"
            ));
        }
        let same = |(point, bytes): (&CloudPoint, &[u8; POINT_BYTES])| {
            let mut logged = CloudPoint::of(bytes);
            logged.place_m[1] = -logged.place_m[1];
            logged == *point
        };
        if let Some(place) = sweep.points.iter().zip(&logged.points).position(|both| !same(both)) {
            return Err(format!("point {place} of sweep {number} is not that of the table"));
        }
    }
    Ok(())
}

/// Faults of the sweeps of a flight with these poses, in words.
///
/// # Errors
/// The first fault, in words.
fn finding(sweeps: &[Sweep], poses: &[Pose], dt_s: f64, boxes: &Boxes) -> Result<(), String> {
    let (Some(first), false) = (sweeps.first(), poses.is_empty()) else { return Ok(()) };
    let smooth = SmoothFlight::new(poses, dt_s);
    // The lidar is fixed to the airframe; `verify-sensor` holds all sweeps to the place of the first.
    let start = smooth.at(first.time_s / dt_s);
    let body_from_world = start.world_from_body.transpose();
    let arm = body_from_world * (first.position - start.position_in_world);
    let body_from_sensor = body_from_world * first.world_from_sensor;
    for (number, sweep) in sweeps.iter().enumerate() {
        surface_problem(sweep, boxes).map_err(|message| format!("sweep {number}, at {} s: {message}", sweep.time_s))?;
        let (mut cast, mut wrong, mut worst) = (0, 0, None);
        for (place, point) in sweep.points.iter().enumerate().skip(number % ONE_OF).step_by(ONE_OF) {
            let airframe = smooth.at((sweep.time_s + f64::from(point.time_s)) / dt_s);
            let from = airframe.position_in_world + airframe.world_from_body * arm;
            let in_sensor = DVec3::from_array(point.place_m.map(f64::from));
            let (range_m, ray) = (in_sensor.length(), airframe.world_from_body * body_from_sensor * in_sensor);
            let is_right = range_m > 0.0 && is_right(boxes, point.instance, (from, ray / range_m), range_m);
            cast += 1;
            if !is_right {
                wrong += 1;
                worst.get_or_insert((place, range_m));
            }
        }
        if let Some((place, range_m)) = worst.filter(|_| exceeds(wrong, cast)) {
            return Err(format!(
                "sweep {number}, at {} s: {wrong} of {cast} points that were cast again are not where their rays meet the town; \
                 the first is point {place}, {range_m:.2} m away",
                sweep.time_s
            ));
        }
    }
    Ok(())
}

/// Points have the labels of their things, and send back no more light than the material does.
fn surface_problem(sweep: &Sweep, boxes: &Boxes) -> Result<(), String> {
    let is_other = |(_, point): &(usize, &CloudPoint)| {
        let known = boxes.labels.get(&point.instance);
        known.is_some_and(|known| !known.iter().any(|label| u16::from(*label) == point.label))
    };
    let wrong: Vec<_> = sweep.points.iter().enumerate().filter(is_other).collect();
    if let Some((place, point)) = wrong.first().filter(|_| exceeds(wrong.len(), sweep.points.len())) {
        let (label, instance) = (point.label, point.instance);
        return Err(format!(
            "{} have labels that their things do not have; the first is point {place}, label {label} of id {instance}",
            counted(wrong.len(), "point")
        ));
    }
    let is_bright = |(_, point): &(usize, &CloudPoint)| {
        let most = u8::try_from(point.label).map_or(1.0, reflectivity);
        !(0.0..=most + 1e-3).contains(&f64::from(point.intensity))
    };
    match sweep.points.iter().enumerate().find(is_bright) {
        Some((place, point)) => Err(format!(
            "point {place} has an intensity of {}; surfaces with label {} send back at most {}",
            point.intensity,
            point.label,
            u8::try_from(point.label).map_or(1.0, reflectivity)
        )),
        None => Ok(()),
    }
}

/// Whether so many of the points of a sweep are more than may be wrong.
fn exceeds(wrong: usize, all: usize) -> bool {
    wrong as f64 > 1.0 + ALLOWED_SHARE * all as f64
}

/// Whether a ray meets a thing at a range, and nothing solid before it.
fn is_right(boxes: &Boxes, instance: u32, (from, ray): (DVec3, DVec3), range_m: f64) -> bool {
    let is_free = boxes.solid.closest_hit(from, ray, range_m + 1.0).is_none_or(|hit| hit.t >= range_m - ALLOWED_M);
    let point = from + range_m * ray;
    is_free && boxes.things.get(&instance).is_none_or(|list| list.iter().any(|shape| is_at(shape, point)))
}

/// Whether a point lies in a box or beside it.
fn is_at(shape: &OrientedBox, point: DVec3) -> bool {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let off = point - shape.center_in_world;
    let own = DVec3::new(cos * off.x + sin * off.y, cos * off.y - sin * off.x, off.z);
    (own.abs() - shape.half_extents_m).max_element() < ALLOWED_M
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow_array::{ArrayRef, BinaryArray, Float64Array, Int64Array, RecordBatch, StringArray};
    use parquet::arrow::ArrowWriter;
    use std::sync::Arc;

    const DT_S: f64 = 0.1;

    /// A drone that flies along a wall and turns, and the points of a lidar on it.
    fn scanned() -> (Vec<Sweep>, Vec<Pose>, Boxes) {
        let pose = |frame: u32| {
            let time_s = f64::from(frame) * DT_S;
            let position_in_world = DVec3::new(6.0 * time_s, time_s, 5.0);
            Pose { position_in_world, pitch_rad: 0.0, yaw_rad: 0.5 * time_s, roll_rad: 0.0 }
        };
        let poses: Vec<Pose> = (0..11).map(pose).collect();
        let wall = OrientedBox::from_corners(DVec3::new(-90.0, 20.0, 0.0), DVec3::new(90.0, 22.0, 40.0));
        let boxes = Boxes::new(&[(7, Filled::All, wall)]);
        let smooth = SmoothFlight::new(&poses, DT_S);
        let sweep = |number: u32| {
            let time_s = f64::from(number) * DT_S;
            let start = smooth.at(time_s / DT_S);
            let point = |shot: u32| {
                let (time_s, azimuth_rad) = (f64::from(shot) * 1e-4, f64::from(shot) * 3e-3);
                let in_sensor = DVec3::new(0.3, 1.0, 0.2 - 0.1 * azimuth_rad).normalize();
                let at = smooth.at(f64::from(number) + time_s / DT_S);
                let hit = boxes.solid.closest_hit(at.position_in_world, at.world_from_body * in_sensor, 200.0)?;
                let place_m = (hit.t * in_sensor).to_array().map(|it| it as f32);
                Some(CloudPoint { place_m, time_s: time_s as f32, instance: 7, ..CloudPoint::default() })
            };
            let points = (0..1000).filter_map(point).collect();
            Sweep { time_s, position: start.position_in_world, world_from_sensor: start.world_from_body, points }
        };
        ((0..10).map(sweep).collect(), poses, boxes)
    }

    /// Outcome of reading a table of two sweeps whose clouds have these bytes, after `spoil` has changed the file.
    fn read(clouds: [&[u8]; 2], spoil: fn(&mut Vec<u8>)) -> ReadResult<usize> {
        let reals = || Arc::new(Float64Array::from(vec![0.0, 0.1])) as ArrayRef;
        let ids = Arc::new(StringArray::from(vec!["a"; 2])) as ArrayRef;
        let points = Arc::new(Int64Array::from(vec![40; 2])) as ArrayRef;
        let mut columns = vec![("trajectory_id", ids), ("time_s", reals()), ("points", points)];
        columns.extend(POSE.map(|name| (name, reals())));
        columns.push((COLUMN, Arc::new(BinaryArray::from(clouds.to_vec()))));
        let batch = RecordBatch::try_from_iter(columns).expect("columns of one length");
        let mut bytes = vec![];
        let mut writer = ArrowWriter::try_new(&mut bytes, batch.schema(), None).expect("a writer");
        writer.write(&batch).and_then(|()| writer.close()).expect("a file");
        spoil(&mut bytes);
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), bytes).expect("written");
        let mut count = 0;
        each_flight(file.path(), &mut |_, sweeps| count += sweeps.len()).map(|()| count)
    }

    /// Damages sweeps.
    type Spoil = fn(&mut Vec<LoggedSweep>);

    #[test]
    fn clouds_of_logs_that_are_cut_or_moved_are_found() {
        let (sweeps, ..) = scanned();
        let logged = |sweep: &Sweep| LoggedSweep {
            time_ns: (1e9 * sweep.time_s).round() as u64,
            position: sweep.position * DVec3::new(1.0, -1.0, 1.0),
            rotation: DQuat::IDENTITY,
            points: sweep.points.iter().map(|it| right_handed(*it).bytes()).collect(),
        };
        let spoilt = |spoil: Spoil| {
            let mut all: Vec<LoggedSweep> = sweeps.iter().map(logged).collect();
            spoil(&mut all);
            compare(&sweeps, &all, 0).err()
        };
        let faults: [(Spoil, &str); 5] = [
            (|all| all[2].time_ns += 50_000_000, "sweep 2 is 0.25"),
            (|all| all[2].position.y *= -1.0, "sweep 2 is "),
            (|all| drop(all.pop()), "it has 9 sweeps, the table has 10"),
            (|all| _ = all[3].points.pop(), "sweep 3 has "),
            (|all| all[4].points[5][1] ^= 4, "point 5 of sweep 4 "),
        ];
        assert_eq!(spoilt(|_| ()), None);
        for (fault, words) in faults {
            assert!(spoilt(fault).is_some_and(|message| message.starts_with(words)), "{words}");
        }
    }

    fn right_handed(mut point: CloudPoint) -> CloudPoint {
        point.place_m[1] = -point.place_m[1];
        point
    }

    #[test]
    fn slopes_of_roofs_lie_within_the_highest_step_of_a_building() {
        let house = OrientedBox::from_corners(DVec3::ZERO, DVec3::new(10.0, 10.0, 6.0));
        let ray = |filled, z_m: f64, range_m| {
            is_right(&Boxes::new(&[(7, filled, house)]), 7, (DVec3::new(5.0, -20.0, z_m), DVec3::Y), range_m)
        };
        let is_right = |label, z_m, range_m| ray(Filled::of(label, "any"), z_m, range_m);
        assert!(is_right(SemanticLabel::Building, 5.5, 24.0) && is_right(SemanticLabel::Building, 3.0, 20.0));
        // Planes of measured roofs lie deeper than steps are high.
        assert!(is_right(SemanticLabel::Building, 4.5, 24.0) && !is_right(SemanticLabel::Building, 4.3, 24.0));
        assert!(!is_right(SemanticLabel::Building, 3.0, 24.0) && !is_right(SemanticLabel::Building, 5.5, 19.0));
        assert!(!is_right(SemanticLabel::Wall, 5.5, 24.0));
        // Rays pass between the posts of a stall.
        let is_open = |kind| ray(Filled::of(SemanticLabel::Static, kind), 3.0, 24.0);
        assert!(is_open("stall") && is_open("bench") && is_open("static") && !is_open("wall"));
        // Crowns are round within their boxes.
        assert!(is_right(SemanticLabel::Vegetation, 5.5, 23.5) && !is_right(SemanticLabel::Vegetation, 5.5, 24.5));
    }

    #[test]
    fn clouds_that_are_cut_or_damaged_are_named() {
        let sound: Vec<u8> = (0..40).flat_map(|ring| CloudPoint { ring, ..CloudPoint::default() }.bytes()).collect();
        let mut endless = sound.clone();
        endless[28 * 7..28 * 7 + 4].copy_from_slice(&f32::NAN.to_le_bytes());
        let second = |cloud: &[u8]| read([&sound, cloud], |_| ()).expect_err("found");
        assert_eq!(read([&sound, &sound], |_| ()), Ok(2));
        assert_eq!(second(&sound[..1119]), "row 1, `a`: column `cloud` has 1119 bytes, no multiple of 28");
        assert_eq!(second(&sound[28..]), "row 1, `a`: column `points` says 40, column `cloud` has 39 points");
        assert_eq!(second(&endless), "row 1, `a`: point 7 has a number that is not finite");
        let cut = read([&sound, &sound], |bytes| bytes.truncate(bytes.len() / 2)).expect_err("found");
        assert!(cut.starts_with("it cannot be read: "), "{cut}");
        let overwritten = read([&sound, &sound], |bytes| bytes[4..400].fill(0xff)).expect_err("found");
        assert!(overwritten.starts_with("row 0 or one after it cannot be read: "), "{overwritten}");
    }

    #[test]
    fn planted_faults_are_found() {
        let sound = |change: &dyn Fn(&mut Sweep)| {
            let (mut sweeps, poses, boxes) = scanned();
            sweeps.iter_mut().skip(1).for_each(change);
            finding(&sweeps, &poses, DT_S, &boxes)
        };
        assert_eq!(sound(&|_| ()), Ok(()));
        let each = |change: fn(&mut CloudPoint)| sound(&|sweep| sweep.points.iter_mut().for_each(change));
        let scaled = each(|point| point.place_m = point.place_m.map(|it| 1.02 * it)).expect_err("a scaled range");
        assert!(scaled.starts_with("sweep 1, at 0.1 s: "), "{scaled}");
        assert!(each(|point| point.place_m.swap(0, 1)).is_err(), "swapped axes");
        assert!(each(|point| point.place_m[1] *= -1.0).is_err(), "a flipped sign");
        assert!(sound(&|sweep| sweep.time_s += 0.5).is_err(), "a shifted time stamp");
    }
}
