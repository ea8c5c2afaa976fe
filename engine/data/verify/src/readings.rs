//! Readings of sensors against what their flight gives: airframe and camera, standard atmosphere, the Earth's field, boxes and ground below.

use super::sensed_rows::SensedRows;
use cosfly_frames::{DMat3, DVec3, Pose, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_schema::log::reading::TRUE;
use cosfly_sensors::{Airframe, CameraMotion, GRAVITY_MPS2, GeoOrigin, SensorPlace, SmoothFlight};

/// Longest arm from the drone to a sensor, metres: the corner of the places that recipes allow.
pub const LONGEST_ARM_M: f64 = 17.4;
/// Places, velocities, forces, fields and heights that are the same, metres, m/s, m/s^2, microtesla: poses pass through degrees.
const SAME: f64 = 2e-3;
/// Turns and angular velocities that are the same.
const SAME_TURN: f64 = 1e-4;
/// Pressure at height 0, hPa; scale of the standard atmosphere, metres, and its power.
const ATMOSPHERE: [f64; 3] = [1013.25, 44_330.77, 5.255_88];
/// Pressures and heights of one formula that are the same, hPa and metres.
const SAME_AIR: f64 = 1e-4;
/// Degrees that are the same on the globe.
const SAME_DEG: f64 = 1e-8;
/// Field of a dipole along the Earth's axis at the equator, microtesla.
const EQUATOR_UT: f64 = 31.2;
/// Range of a laser altimeter, metres.
const RANGE_M: f64 = 100.0;
/// Difference of ranges to boxes, metres. Share of the readings that bodies and mounds on boxes may shorten, and a number beside.
const SAME_RANGE_M: f64 = 0.01;
const SHORTER_SHARE: f64 = 0.2;
const SHORTER: f64 = 3.0;
/// Ground so near to a beam, metres, is as high, but for steps and bridges.
const NEAR_M: f64 = 1.5;
const STEP_M: f64 = 0.5;

/// A flight that carries sensors.
pub struct Carrying<'a> {
    /// Poses of the drone, at least one.
    pub poses: &'a [Pose],
    /// Points of the ground: feet of the target, and what some pictures show, where an altimeter asks for them.
    pub ground: &'a [DVec3],
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Place of the world on the globe.
    pub origin: GeoOrigin,
    /// All boxes of the town, where an altimeter asks for them.
    pub boxes: Option<&'a BoxBvh>,
}

/// Faults of the readings of a flight, in words.
///
/// # Errors
/// The first fault, in words.
pub fn check(rows: &SensedRows, of: &Carrying<'_>) -> Result<(), String> {
    if rows.times_s.is_empty() || of.poses.is_empty() {
        return Ok(());
    }
    let smooth = SmoothFlight::new(of.poses, of.dt_s);
    place_problem(rows, of, &smooth)?;
    air_problem(rows, of, &smooth)?;
    field_problem(rows, of, &smooth)?;
    globe_problem(rows, of)?;
    odometry_problem(rows, of)?;
    altimeter_problem(rows, of)
}

/// The sensor is where airframe or camera carry it, moves and turns as they do, and feels what they do.
fn place_problem(rows: &SensedRows, of: &Carrying<'_>, smooth: &SmoothFlight) -> Result<(), String> {
    let as_world = |list: Vec<DVec3>| list.into_iter().map(|it| DVec3::new(it.x, -it.y, it.z)).collect();
    let world = |names, enu: [&str; 3]| rows.vectors(names).or_else(|| rows.vectors(enu).map(as_world));
    let places = world(["true_x_m", "true_y_m", "true_z_m"], ["true_east_m", "true_north_m", "true_up_m"]);
    let Some(places) = places else { return Ok(()) };
    let start = smooth.at(rows.times_s[0] / of.dt_s);
    let arm = start.world_from_body.transpose() * (places[0] - start.position_in_world);
    let velocities = world(
        ["true_velocity_x_mps", "true_velocity_y_mps", "true_velocity_z_mps"],
        ["true_velocity_east_mps", "true_velocity_north_mps", "true_velocity_up_mps"],
    );
    let turns: Option<Vec<DMat3>> = rows.quaternions().map(|it| it.into_iter().map(DMat3::from_quat).collect());
    let mount = turns.as_ref().map_or(DMat3::IDENTITY, |turns| start.world_from_body.transpose() * turns[0]);
    let forces = rows.vectors(["true_force_x_mps2", "true_force_y_mps2", "true_force_z_mps2"]);
    let rates = rows.vectors(["true_rate_x_rad_s", "true_rate_y_rad_s", "true_rate_z_rad_s"]);
    let by_airframe = |row: usize| {
        let airframe = airframe_at(smooth, rows.times_s[row] / of.dt_s, arm);
        let sensor = airframe.world_from_body * mount;
        let felt = sensor.transpose() * (airframe.acceleration_in_world + GRAVITY_MPS2 * DVec3::Z);
        let off =
            |list: &Option<Vec<DVec3>>, expected: DVec3| list.as_ref().map_or(0.0, |list| list[row].distance(expected));
        let turned = turns.as_ref().map_or(0.0, |turns| {
            let apart = turns[row] - sensor;
            apart.x_axis.length().max(apart.y_axis.length()).max(apart.z_axis.length())
        });
        let errors = [
            ("place", places[row].distance(airframe.position_in_world), SAME),
            ("velocity", off(&velocities, airframe.velocity_in_world), SAME),
            ("turn", turned, SAME_TURN),
            ("force", off(&forces, felt), SAME),
            ("angular velocity", off(&rates, mount.transpose() * airframe.rates_in_body), SAME_TURN),
        ];
        errors.into_iter().find(|(_, error, allowed)| error.is_nan() || error > allowed)
    };
    let wrong = (0..places.len()).find_map(|row| Some((row, by_airframe(row)?)));
    let Some((row, (what, error, _))) = wrong else { return Ok(()) };
    // What has a place alone may sit on the camera.
    if velocities.is_none() && turns.is_none() && sits_on_camera(rows, of, &places) {
        return Ok(());
    }
    let time_s = rows.times_s[row];
    Err(format!(
        "reading {row}, at {time_s} s: its true {what} is {error:.4} from that of the airframe that carries it"
    ))
}

/// The airframe at a frame number, at a place on it.
fn airframe_at(smooth: &SmoothFlight, at: f64, arm: DVec3) -> Airframe {
    smooth.at(at).at(&SensorPlace { position_in_body: arm, ..SensorPlace::default() })
}

fn sits_on_camera(rows: &SensedRows, of: &Carrying<'_>, places: &[DVec3]) -> bool {
    let motion = |position_in_body| CameraMotion {
        poses_in_world: of.poses,
        dt_s: of.dt_s,
        place: SensorPlace { position_in_body, ..SensorPlace::default() },
    };
    let at = |row: usize| rows.times_s[row] / of.dt_s;
    let arm = motion(DVec3::ZERO).pose(at(0)).body_from_world_point(places[0]);
    let carried = motion(arm);
    (0..places.len()).all(|row| carried.pose(at(row)).position_in_world.distance(places[row]) < SAME)
}

/// Heights are those of the airframe or the camera, and pressures are those of the standard atmosphere.
fn air_problem(rows: &SensedRows, of: &Carrying<'_>, smooth: &SmoothFlight) -> Result<(), String> {
    let number = |name: &str| rows.numbers.get(name);
    let [ground_hpa, scale_m, power] = ATMOSPHERE;
    for start in ["", TRUE] {
        let both = (number(&format!("{start}pressure_hpa")), number(&format!("{start}altitude_m")));
        let (Some(pressures), Some(heights)) = both else { continue };
        for (row, (pressure_hpa, height_m)) in pressures.iter().zip(heights).enumerate() {
            let expected_hpa = ground_hpa * real::powf((1.0 - height_m / scale_m).max(0.0), power);
            if exceeds((pressure_hpa - expected_hpa).abs(), SAME_AIR) {
                return Err(format!(
                    "reading {row}: `{start}pressure_hpa` is {pressure_hpa:.4}; the standard atmosphere has {expected_hpa:.4} at \
                     `{start}altitude_m`"
                ));
            }
        }
    }
    let Some(heights) = number("true_altitude_m") else { return Ok(()) };
    let camera = CameraMotion { poses_in_world: of.poses, dt_s: of.dt_s, place: SensorPlace::default() };
    let by_airframe = |at: f64| {
        let airframe = smooth.at(at);
        (airframe.position_in_world, airframe.world_from_body)
    };
    let by_camera = |at: f64| {
        let pose = camera.pose(at);
        (pose.position_in_world, pose.world_from_body())
    };
    let of_airframe = height_error(rows, heights, of.dt_s, &by_airframe);
    match of_airframe.filter(|_| height_error(rows, heights, of.dt_s, &by_camera).is_some()) {
        Some((row, off_m)) => Err(format!(
            "reading {row}, at {} s: `true_altitude_m` is {off_m:.3} m from the height at which the drone carries it",
            rows.times_s[row]
        )),
        None => Ok(()),
    }
}

/// The first height that no arm on a carrier explains, with its error, metres.
fn height_error(
    rows: &SensedRows,
    heights: &[f64],
    dt_s: f64,
    carrier: &dyn Fn(f64) -> (DVec3, DMat3),
) -> Option<(usize, f64)> {
    let carried: Vec<(DVec3, f64)> = rows
        .times_s
        .iter()
        .zip(heights)
        .map(|(time_s, height_m)| {
            let (place, turn) = carrier(time_s / dt_s);
            (turn.transpose() * DVec3::Z, height_m - place.z)
        })
        .collect();
    let arm = fitted(&carried);
    let error = |(row, (up, above_m)): (usize, &(DVec3, f64))| {
        let off_m = (above_m - up.dot(arm)).abs();
        (exceeds(off_m, SAME) || arm.length() > LONGEST_ARM_M).then_some((row, off_m))
    };
    carried.iter().enumerate().find_map(error)
}

/// The vector whose products with these directions are nearest to these numbers.
fn fitted(products: &[(DVec3, f64)]) -> DVec3 {
    let outer = |v: &DVec3| DMat3::from_cols(*v * v.x, *v * v.y, *v * v.z);
    let sum = products.iter().fold(DMat3::ZERO, |sum, (direction, _)| sum + outer(direction));
    let right = products.iter().fold(DVec3::ZERO, |sum, (direction, number)| sum + *direction * *number);
    // Directions that never change leave the rest of the vector 0.
    let least = 1e-10 * (sum.x_axis.x + sum.y_axis.y + sum.z_axis.z) + 1e-12;
    (sum + DMat3::from_diagonal(DVec3::splat(least))).inverse() * right
}

/// The field is the Earth's, turned with the airframe and by one pitch and yaw of the mount.
fn field_problem(rows: &SensedRows, of: &Carrying<'_>, smooth: &SmoothFlight) -> Result<(), String> {
    let Some(found) = rows.vectors(["true_field_x_ut", "true_field_y_ut", "true_field_z_ut"]) else { return Ok(()) };
    let (sin, cos) = real::sin_cos(of.origin.latitude_deg.to_radians());
    let field_in_world = EQUATOR_UT * DVec3::new(0.0, -cos, -2.0 * sin);
    let in_body: Vec<DVec3> = rows
        .times_s
        .iter()
        .map(|time_s| smooth.at(time_s / of.dt_s).world_from_body.transpose() * field_in_world)
        .collect();
    let worst = |mount: DMat3| {
        let errors = found.iter().zip(&in_body).map(|(found, field)| found.distance(mount.transpose() * *field));
        errors
            .enumerate()
            .fold((0, 0.0), |worst, (row, error)| if exceeds(error, worst.1) { (row, error) } else { worst })
    };
    let best = mounts(in_body[0], found[0]).map(worst);
    let (row, off_ut) = if best[0].1 <= best[1].1 { best[0] } else { best[1] };
    match exceeds(off_ut, SAME) {
        true => Err(format!(
            "reading {row}, at {} s: its true field is {off_ut:.3} microtesla from the Earth's, turned with the airframe",
            rows.times_s[row]
        )),
        false => Ok(()),
    }
}

/// The two mounts, each a yaw and a pitch, that turn a vector of the body into one of the sensor, as near as that is possible.
fn mounts(in_body: DVec3, in_sensor: DVec3) -> [DMat3; 2] {
    let flat = in_body.truncate().length();
    let ahead = real::atan2(in_body.y, in_body.x);
    let aside = in_sensor.y.clamp(-flat, flat);
    let along = (flat * flat - aside * aside).max(0.0).sqrt();
    [along, -along].map(|along| {
        let (yaw_sin, yaw_cos) = real::sin_cos(ahead - real::atan2(aside, along));
        let pitch = real::atan2(in_body.z, along) - real::atan2(in_sensor.z, in_sensor.x);
        let (sin, cos) = real::sin_cos(pitch);
        DMat3::from_cols(
            DVec3::new(yaw_cos * cos, yaw_sin * cos, sin),
            DVec3::new(-yaw_sin, yaw_cos, 0.0),
            DVec3::new(-yaw_cos * sin, -yaw_sin * sin, cos),
        )
    })
}

/// Latitude and longitude are those of the position beside them.
fn globe_problem(rows: &SensedRows, of: &Carrying<'_>) -> Result<(), String> {
    let names = ["latitude_deg", "longitude_deg"].map(|name| rows.numbers.get(name));
    let (Some(found), [Some(latitudes), Some(longitudes)]) = (rows.vectors(["east_m", "north_m", "up_m"]), names)
    else {
        return Ok(());
    };
    let is_fix = rows.numbers.get("is_fix");
    for (row, place) in found.iter().enumerate().filter(|(row, _)| is_fix.is_none_or(|fix| fix[*row] == 1.0)) {
        let [latitude, longitude] = of.origin.degrees_at(DVec3::new(place.x, -place.y, place.z));
        if exceeds((latitude - latitudes[row]).abs().max((longitude - longitudes[row]).abs()), SAME_DEG) {
            return Err(format!(
                "reading {row}: it is at {:.7}, {:.7} degrees; `east_m` and `north_m` lie at {latitude:.7}, {longitude:.7}",
                latitudes[row], longitudes[row]
            ));
        }
    }
    Ok(())
}

/// The sensor looks along one axis of the drone, or of the drone held level, and moves as one of its points does.
fn odometry_problem(rows: &SensedRows, of: &Carrying<'_>) -> Result<(), String> {
    let axes = rows.vectors(["axis_x", "axis_y", "axis_z"]);
    let velocities = rows.vectors(["velocity_x_mps", "velocity_y_mps", "velocity_z_mps"]);
    let (Some(axes), Some(velocities)) = (axes, velocities) else { return Ok(()) };
    let motion = |position_in_body| CameraMotion {
        poses_in_world: of.poses,
        dt_s: of.dt_s,
        place: SensorPlace { position_in_body, ..SensorPlace::default() },
    };
    let at = |row: usize| rows.times_s[row] / of.dt_s;
    let (drone, arms) = (motion(DVec3::ZERO), [DVec3::X, DVec3::Y, DVec3::Z].map(motion));
    let turned = |row: usize, is_level: bool| {
        let pose = drone.pose(at(row));
        let pose = if is_level { Pose { pitch_rad: 0.0, roll_rad: 0.0, ..pose } } else { pose };
        pose.world_from_body().transpose() * axes[row]
    };
    let off = |is_level: bool| {
        let first = turned(0, is_level);
        (0..axes.len()).find(|row| exceeds(turned(*row, is_level).distance(first), SAME_TURN))
    };
    if let Some(row) = off(false).filter(|_| off(true).is_some()) {
        return Err(format!("reading {row}, at {} s: its axis does not turn with the drone", rows.times_s[row]));
    }
    // A velocity is that of the drone and, for each metre of arm, what its turning adds.
    let added = |row: usize| {
        let own = drone.velocity(at(row));
        (own, DMat3::from_cols_array_2d(&arms.map(|arm| (arm.velocity(at(row)) - own).to_array())))
    };
    let products = (0..axes.len()).flat_map(|row| {
        let (own, of_arm) = added(row);
        let (lines, rest) = (of_arm.transpose(), velocities[row] - own);
        [(lines.x_axis, rest.x), (lines.y_axis, rest.y), (lines.z_axis, rest.z)]
    });
    let arm = fitted(&products.collect::<Vec<_>>());
    let wrong = (0..axes.len()).find_map(|row| {
        let (own, of_arm) = added(row);
        let off_mps = velocities[row].distance(own + of_arm * arm);
        (exceeds(off_mps, SAME) || arm.length() > LONGEST_ARM_M).then_some((row, off_mps))
    });
    match wrong {
        Some((row, off_mps)) => Err(format!(
            "reading {row}, at {} s: its velocity is {off_mps:.3} m/s from that of the drone",
            rows.times_s[row]
        )),
        None => Ok(()),
    }
}

/// A beam straight down is as long as the way to the first box, or shorter; on ground it ends as high as feet stand and pictures show it there.
fn altimeter_problem(rows: &SensedRows, of: &Carrying<'_>) -> Result<(), String> {
    let [ranges, hits] = ["range_m", "is_hit"].map(|name| rows.numbers.get(name));
    let places = rows.vectors(["true_x_m", "true_y_m", "true_z_m"]);
    let (Some(ranges), Some(hits), Some(places), Some(boxes)) = (ranges, hits, places, of.boxes) else { return Ok(()) };
    let (mut on_boxes, mut shorter, mut on_ground, mut wrong) = (0.0, vec![], 0.0, vec![]);
    for (row, (range_m, from)) in ranges.iter().zip(&places).enumerate() {
        let (time_s, is_hit) = (rows.times_s[row], hits[row]);
        if !(0.0..=RANGE_M).contains(range_m)
            || is_hit != f64::from(u8::from(*range_m < RANGE_M)) && *range_m != RANGE_M
        {
            return Err(format!("reading {row}, at {time_s} s: `range_m` is {range_m}, `is_hit` {is_hit}"));
        }
        let below_m = boxes.closest_hit(*from, -DVec3::Z, RANGE_M).map(|hit| hit.t);
        if let Some(below_m) = below_m {
            if *range_m > below_m + SAME_RANGE_M {
                return Err(format!(
                    "reading {row}, at {time_s} s: the range is {range_m:.3} m; a box lies {below_m:.3} m below"
                ));
            }
            on_boxes += 1.0;
            if *range_m < below_m - SAME_RANGE_M {
                shorter.push((row, *range_m, below_m));
            }
            continue;
        }
        let near = |ground: &&DVec3| ground.truncate().distance(from.truncate()) < NEAR_M;
        let Some(ground) = of.ground.iter().find(near).filter(|_| *range_m < RANGE_M) else { continue };
        on_ground += 1.0;
        if (from.z - range_m - ground.z).abs() > STEP_M {
            wrong.push((row, *range_m, from.z - ground.z));
        }
    }
    for (list, all, what) in
        [(&shorter, on_boxes, "the box below it is"), (&wrong, on_ground, "the ground below it is")]
    {
        if let Some((row, range_m, expected_m)) =
            list.first().filter(|_| list.len() as f64 > SHORTER + SHORTER_SHARE * all)
        {
            return Err(format!(
                "{} of {all} readings, the first {row}: the range is {range_m:.3} m, {what} {expected_m:.3} m away",
                list.len()
            ));
        }
    }
    Ok(())
}

/// Whether a number is more than is allowed, or none.
fn exceeds(number: f64, allowed: f64) -> bool {
    number.is_nan() || number > allowed
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::OrientedBox;

    const DT_S: f64 = 0.5;
    const ORIGIN: GeoOrigin = GeoOrigin { latitude_deg: 48.0, longitude_deg: 11.0 };

    fn poses() -> Vec<Pose> {
        let pose = |frame: u32| {
            let time_s = f64::from(frame) * DT_S;
            let position_in_world = DVec3::new(4.0 * time_s, 3.0 * real::sin(time_s), 20.0 + real::sin(0.7 * time_s));
            Pose { position_in_world, pitch_rad: -0.1, yaw_rad: 0.6 * real::sin(time_s), roll_rad: 0.0 }
        };
        (0..20).map(pose).collect()
    }

    /// Columns of readings at 20 Hz, `count` numbers each.
    fn rows(names: &[&str], reading: &dyn Fn(f64) -> Vec<f64>) -> SensedRows {
        let times_s: Vec<f64> = (0..190).map(|row| 0.05 * f64::from(row)).collect();
        let mut rows = SensedRows {
            frames: times_s.iter().map(|it| (it / DT_S) as i64).collect(),
            times_s,
            ..SensedRows::default()
        };
        let all: Vec<Vec<f64>> = rows.times_s.iter().map(|time_s| reading(*time_s)).collect();
        for (place, name) in names.iter().enumerate() {
            rows.numbers.insert((*name).to_owned(), all.iter().map(|numbers| numbers[place]).collect());
        }
        rows
    }

    fn judged(rows: &SensedRows) -> Result<(), String> {
        let poses = poses();
        let roof = OrientedBox::from_corners(DVec3::new(-50.0, -50.0, 0.0), DVec3::new(50.0, 50.0, 5.0));
        let boxes = BoxBvh::build(vec![roof]);
        check(
            rows,
            &Carrying {
                poses: &poses,
                ground: &[DVec3::new(500.0, 0.0, 0.0)],
                dt_s: DT_S,
                origin: ORIGIN,
                boxes: Some(&boxes),
            },
        )
    }

    /// Passes as it is, and no more when columns are multiplied or change places.
    fn finds(sound: &SensedRows, faults: &[(&str, f64)], swaps: &[(&str, &str)]) {
        assert_eq!(judged(sound), Ok(()));
        for (name, factor) in faults {
            let mut rows = sound.clone();
            rows.numbers.get_mut(*name).expect("a column").iter_mut().for_each(|number| *number *= factor);
            assert!(judged(&rows).is_err(), "{name} x {factor}");
        }
        for (one, other) in swaps {
            let mut rows = sound.clone();
            let taken = rows.numbers.remove(*one).expect("a column");
            let given = rows.numbers.insert((*other).to_owned(), taken).expect("a column");
            rows.numbers.insert((*one).to_owned(), given);
            assert!(judged(&rows).is_err(), "{one} for {other}");
        }
    }

    #[test]
    fn odometry_moves_and_turns_with_the_drone_wherever_it_sits() {
        let names = ["axis_x", "axis_y", "axis_z", "velocity_x_mps", "velocity_y_mps", "velocity_z_mps"];
        let poses = poses();
        let place = SensorPlace { position_in_body: DVec3::new(1.0, -0.5, 0.2), ..SensorPlace::default() };
        let motion = CameraMotion { poses_in_world: &poses, dt_s: DT_S, place };
        let sound = rows(&names, &|time_s| {
            let (axis, velocity) =
                (motion.pose(time_s / DT_S).world_from_body() * DVec3::X, motion.velocity(time_s / DT_S));
            [axis.to_array(), velocity.to_array()].concat()
        });
        let faults = [("axis_y", -1.0), ("velocity_x_mps", -1.0), ("velocity_y_mps", 1.05)];
        finds(&sound, &faults, &[("axis_x", "axis_y"), ("velocity_x_mps", "velocity_y_mps")]);
    }

    #[test]
    fn fields_heights_and_places_are_those_of_the_airframe() {
        let poses = poses();
        let smooth = SmoothFlight::new(&poses, DT_S);
        let (sin, cos) = real::sin_cos(ORIGIN.latitude_deg.to_radians());
        let field = rows(&["true_field_x_ut", "true_field_y_ut", "true_field_z_ut"], &|time_s| {
            let turn = smooth.at(time_s / DT_S).world_from_body.transpose();
            (turn * (EQUATOR_UT * DVec3::new(0.0, -cos, -2.0 * sin))).to_array().to_vec()
        });
        let swaps = [("true_field_x_ut", "true_field_y_ut"), ("true_field_y_ut", "true_field_z_ut")];
        finds(&field, &[("true_field_x_ut", -1.0), ("true_field_y_ut", -1.0), ("true_field_z_ut", 1.05)], &swaps);
        let air = rows(&["true_altitude_m", "true_pressure_hpa"], &|time_s| {
            let height_m = smooth.at(time_s / DT_S).position_in_world.z;
            vec![height_m, 1013.25 * real::powf(1.0 - height_m / 44_330.77, 5.255_88)]
        });
        finds(&air, &[("true_altitude_m", 1.001), ("true_pressure_hpa", 1.001)], &[]);
        let east = [
            "true_east_m",
            "true_north_m",
            "true_up_m",
            "true_velocity_east_mps",
            "true_velocity_north_mps",
            "true_velocity_up_mps",
        ];
        let receiver = rows(&east, &|time_s| {
            let airframe = smooth.at(time_s / DT_S);
            let enu = |it: DVec3| [it.x, -it.y, it.z];
            [enu(airframe.position_in_world), enu(airframe.velocity_in_world)].concat()
        });
        let swaps = [("true_east_m", "true_north_m"), ("true_velocity_east_mps", "true_velocity_north_mps")];
        finds(
            &receiver,
            &[("true_north_m", -1.0), ("true_velocity_up_mps", -1.0), ("true_velocity_east_mps", 1.02)],
            &swaps,
        );
    }

    #[test]
    fn degrees_lie_where_metres_do_and_beams_end_on_boxes() {
        let names = ["east_m", "north_m", "up_m", "latitude_deg", "longitude_deg"];
        let globe = rows(&names, &|time_s| {
            let [latitude, longitude] = ORIGIN.degrees_at(DVec3::new(30.0 + time_s, -80.0, 20.0));
            vec![30.0 + time_s, 80.0, 20.0, latitude, longitude]
        });
        finds(
            &globe,
            &[("latitude_deg", -1.0), ("north_m", 1.1)],
            &[("latitude_deg", "longitude_deg"), ("east_m", "north_m")],
        );
        let poses = poses();
        let motion = CameraMotion { poses_in_world: &poses, dt_s: DT_S, place: SensorPlace::default() };
        let beam = rows(&["range_m", "is_hit", "true_x_m", "true_y_m", "true_z_m"], &|time_s| {
            let from = motion.pose(time_s / DT_S).position_in_world;
            [vec![from.z - 5.0, 1.0], from.to_array().to_vec()].concat()
        });
        finds(&beam, &[("range_m", 1.02), ("range_m", 0.98), ("is_hit", 0.0), ("true_x_m", 1.1)], &[]);
    }
}
