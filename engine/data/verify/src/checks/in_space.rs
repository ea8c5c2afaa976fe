//! Table `bodies_3d`: boxes and key points against the bodies, the camera's pose and the pictures' boxes.

use crate::flight_rows::FlightRows;
use crate::report::VerifyReport;
use crate::rows::PlacedFrame;
use cosfly_domain::{BodyKind, KEY_POINTS, TARGET_INSTANCE};
use cosfly_frames::{DVec3, Pose, real};
use cosfly_read::{SeenKeyPoint, SpaceRow};
use std::collections::BTreeSet;

/// Angles pass through degrees, metres.
const TOLERANCE: f64 = 1e-6;
/// Pixels of points that pass through degrees.
const SLACK_PX: f64 = 1e-3;

/// Every row is of a body that its frame shows, and says the same in the world, before the camera and in the picture; in a flight
/// with rows every body that a frame shows has one.
pub fn check(it: &FlightRows<'_>, report: &mut VerifyReport) {
    let Some((file, rows)) = it.in_space else { return };
    let mut known = BTreeSet::new();
    for (number, row) in rows {
        let Some(frame) = it.frames.get(row.frame as usize) else {
            let place = format!("row {number}, `{}`", it.flight.trajectory_id);
            report.find(file, place, "verify-reference", "the flight has no such frame");
            continue;
        };
        let is_second = !known.insert((row.frame, row.instance));
        let second = is_second.then(|| format!("a second row of the body with the id {}", row.instance));
        if let Some(message) = second.or_else(|| problem(it, frame, row)) {
            let place = format!("row {number}, `{}` frame {}", it.flight.trajectory_id, row.frame);
            report.find(file, place, "verify-3d", message);
        }
    }
    let targets = it.frames.iter().filter(|frame| frame.visible_pixels > 0).map(|it| (it.frame, TARGET_INSTANCE));
    let others = it.bodies.iter().filter(|body| body.pixels > 0).filter_map(|it| Some((it.frame, it.instance?)));
    for (frame, instance) in targets.chain(others).filter(|shown| !known.contains(shown)) {
        let place = format!("`{}` frame {frame}", it.flight.trajectory_id);
        report.find(
            file,
            place,
            "verify-3d",
            format!("the frame shows the body with the id {instance}; it has no row"),
        );
    }
}

fn problem(it: &FlightRows<'_>, frame: &PlacedFrame, row: &SpaceRow) -> Option<String> {
    let is_target = row.instance == TARGET_INSTANCE;
    let other = it.bodies.iter().find(|body| body.frame == row.frame && body.instance == Some(row.instance));
    let (feet, heading_rad, seen, size_m) = match other {
        _ if is_target => {
            let target = &frame.target;
            (target.feet_in_world, target.heading_rad, frame.visible_box(), size_of_target(it, row))
        }
        Some(body) => (body.space.feet, body.heading_rad, body.visible_box, body.size_m),
        None => return Some(format!("no body of table `bodies` has the id {} in this frame", row.instance)),
    };
    let off_m = (row.size_m - size_m).length();
    if off_m.is_nan() || off_m > TOLERANCE {
        return Some(format!("the box is {} m large, the body {size_m} m", row.size_m));
    }
    let apart_m = (row.centre_in_world - feet - DVec3::Z * (0.5 * row.size_m.z)).length();
    if apart_m.is_nan() || apart_m > TOLERANCE {
        return Some(format!("the middle of the box is {apart_m:.6} m from the body's"));
    }
    let turn = |of_deg: f64, from_rad: f64| real::wrap_angle_rad(of_deg.to_radians() - from_rad).abs() > TOLERANCE;
    if turn(row.yaw_in_world_deg, heading_rad) {
        return Some(format!("the box is turned by {} degrees, the body is not", row.yaw_in_world_deg));
    }
    let camera: &Pose = &frame.camera_pose;
    let off_m = (camera.body_from_world_point(row.centre_in_world) - row.centre_in_camera).length();
    if off_m.is_nan() || off_m > 1e3 * TOLERANCE {
        return Some(format!("the middle of the box before the camera is {off_m:.6} m from the one in the world"));
    }
    if turn(row.yaw_in_camera_deg, row.yaw_in_world_deg.to_radians() - camera.yaw_rad) {
        return Some(format!("the turn before the camera, {} degrees, is another one", row.yaw_in_camera_deg));
    }
    if ![0, KEY_POINTS.len()].contains(&row.key_points.len()) {
        return Some(format!("{} key points; there are 17, or none", row.key_points.len()));
    }
    if let Some(left) = crossed(row, heading_rad) {
        return Some(format!("`{left}` is to the right of its partner"));
    }
    let points = row.key_points.iter().zip(KEY_POINTS);
    points.into_iter().find_map(|(point, name)| Some(format!("`{name}` {}", point_problem(it, camera, point, seen)?)))
}

/// Size of the target: of a person on foot the cylinder of the flight, with what the person takes along the outline of the kind; other
/// targets have no size in tables.
fn size_of_target(it: &FlightRows<'_>, row: &SpaceRow) -> DVec3 {
    let is_kind = |kind: &&BodyKind| it.flight.target_kind.as_deref() == Some(kind.name());
    let kind = BodyKind::ON_THE_GROUND.iter().find(is_kind);
    let outline_m = kind.and_then(|kind| kind.row().walking.as_ref()?.outline_m);
    let [length_m, width_m] = outline_m.unwrap_or([2.0 * it.flight.target_radius_m; 2]);
    let is_known = outline_m.is_some() || !row.key_points.is_empty();
    if is_known { DVec3::new(length_m, width_m, it.flight.target_height_m) } else { row.size_m }
}

/// The left one of the pairs of the trunk, where it is to the right: shoulders and hips of those who walk swing, but do not cross.
fn crossed(row: &SpaceRow, heading_rad: f64) -> Option<&'static str> {
    let (sin, cos) = real::sin_cos(heading_rad);
    let named = |name: &str| Some(&row.key_points.get(KEY_POINTS.iter().position(|it| *it == name)?)?.point_in_world);
    let to_right = |left: &str, right: &str| Some((*named(right)? - *named(left)?).dot(DVec3::new(-sin, cos, 0.0)));
    let pairs = [("left_shoulder", "right_shoulder"), ("left_hip", "right_hip")];
    pairs.into_iter().find(|(left, right)| to_right(left, right).is_some_and(|way_m| way_m < 0.0)).map(|(left, _)| left)
}

/// Fault of a key point of a body whose visible pixels have these edges, in words.
fn point_problem(it: &FlightRows<'_>, camera: &Pose, point: &SeenKeyPoint, seen: Option<[f64; 4]>) -> Option<String> {
    let [u, v] = point.pixel;
    let Some((right, down, depth_m)) = it.flight.project(camera, point.point_in_world) else {
        return (point.shown != 0).then(|| "is behind the camera".into());
    };
    if (depth_m - point.depth_m).abs() > 1e3 * TOLERANCE {
        return Some(format!("is {:.4} m deep; its place is {depth_m:.4} m deep", point.depth_m));
    }
    let (width, height) = (f64::from(it.flight.camera.width), f64::from(it.flight.camera.height));
    let within = |slack: f64| (-slack..width + slack).contains(&right) && (-slack..height + slack).contains(&down);
    if point.shown == 0 {
        // Beyond the place where a lens's curve turns, nothing shows the point.
        let is_shown = within(-SLACK_PX) && it.flight.shows(camera, point.point_in_world, (right, down));
        return is_shown.then(|| "is in the picture, and said to be out of it".into());
    }
    if !within(SLACK_PX) || (right - u).abs() > SLACK_PX || (down - v).abs() > SLACK_PX {
        return Some(format!("is at pixel ({u:.2}, {v:.2}); its place is at ({right:.2}, {down:.2})"));
    }
    let is_on_body =
        seen.is_some_and(|[left, top, right, bottom]| (left..=right).contains(&u) && (top..=bottom).contains(&v));
    (point.shown == 2 && !is_on_body).then(|| format!("is seen at ({u:.2}, {v:.2}), where the body has no pixel"))
}
