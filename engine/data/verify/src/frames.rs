//! The frames of one flight: numbering, times, actions against poses, distances, boxes, occluders, and the row of its pair.

use super::body::PlacedBody;
use super::boxes::box_problem;
use super::film::Film;
use super::report::VerifyReport;
use super::rows::{PlacedFlight, PlacedFrame};
use super::tables::{Extent, PairRow, digest};
use cosfly_diagnose::counted;
use cosfly_frames::DVec3;
use cosfly_metrics::spread::APART_M;
use std::collections::{BTreeMap, BTreeSet};

/// Numbers that were computed from others in 64-bit floats may differ by this much (metres or degrees).
pub const TOLERANCE: f64 = 1e-6;

/// Numbering, times, shares, actions, distance and boxes of one flight.
pub fn check_frames(file: &str, flight: &PlacedFlight, frames: &[PlacedFrame], report: &mut VerifyReport) {
    let id = &flight.trajectory_id;
    if frames.len() != flight.frames {
        let message =
            format!("{}; table `trajectories` says {}", counted(frames.len(), "row"), counted(flight.frames, "frame"));
        report.find(file, format!("`{id}`"), "verify-count", message);
    }
    let film = Film { flight, frames, others: &[], readout: None };
    for (number, frame) in frames.iter().enumerate() {
        let mut find = |rule, message: String| {
            report.find(file, format!("row {}, `{id}` frame {number}", frame.row), rule, message);
        };
        let time_s = flight.times().s(number);
        if frame.frame as usize != number || (frame.time_s - time_s).abs() > TOLERANCE {
            find(
                "verify-order",
                format!("it is frame {} at {} s; frame {number} at {time_s} s belongs here", frame.frame, frame.time_s),
            );
        }
        match (frames.get(number + 1), frame.action_in_world) {
            (Some(next), Some(_)) => match frame.action_error(next) {
                Some(error) if error <= TOLERANCE => {}
                error => find(
                    "verify-action",
                    format!("its action and the way to the next pose differ by {}", error.unwrap_or(f64::NAN)),
                ),
            },
            (None, None) if frame.action_in_body.is_none() => {}
            _ => find("verify-action", "only the last frame has no action".into()),
        }
        let distance_m = (frame.target.feet_in_world - frame.camera_pose.position_in_world).length();
        if (distance_m - frame.distance_m).is_nan() || (distance_m - frame.distance_m).abs() > TOLERANCE {
            find(
                "verify-distance",
                format!("`distance_m` is {}; camera and feet are {distance_m} m apart", frame.distance_m),
            );
        }
        let visible = [frame.visible_by_rays, frame.visible_by_pixels];
        if !visible.iter().all(|share| (0.0..=1.0).contains(share)) {
            find("verify-visibility", format!("shares {visible:?} must lie between 0 and 1"));
        }
        if let Some(message) = box_problem(&film, number) {
            find("verify-reprojection", message);
        }
        let placed = flight.mount.camera_pose(&frame.pose);
        let off_m = (placed.position_in_world - frame.camera_pose.position_in_world).length();
        if off_m.is_nan() || off_m > TOLERANCE {
            find("verify-camera", format!("the camera is {off_m} m from the place that its mount has on the drone"));
        }
        let turned = placed.world_from_body();
        let stored = frame.camera_pose.world_from_body();
        let apart = (turned.x_axis - stored.x_axis).length().max((turned.y_axis - stored.y_axis).length());
        if apart.is_nan() || apart > TOLERANCE {
            find("verify-camera", format!("the camera's attitude is {apart} from the drone's turned by its mount"));
        }
    }
    report.boxes += frames.iter().filter(|frame| frame.full_box_px.is_some()).count() as u64;
}

/// Drone and target are in the town whose objects table `objects` lists, not kilometres from it.
pub fn check_town(
    file: &str,
    extent: Option<&Extent>,
    flight: &PlacedFlight,
    frames: &[PlacedFrame],
    report: &mut VerifyReport,
) {
    let Some([low, high]) = extent else { return };
    let away_m = |place: DVec3| {
        [(place.x, 0), (place.y, 1)]
            .map(|(value, axis)| (low[axis] - value).max(value - high[axis]))
            .into_iter()
            .fold(0.0, f64::max)
    };
    let worst = frames
        .iter()
        .map(|frame| (frame, away_m(frame.pose.position_in_world).max(away_m(frame.target.feet_in_world))));
    if let Some((frame, far_m)) = worst.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, far_m)| *far_m > APART_M) {
        let place = format!("row {}, `{}` frame {}", frame.row, flight.trajectory_id, frame.frame);
        let message = format!("it is {:.0} km from the nearest object of its town `{}`", far_m / 1000.0, flight.town);
        report.find(file, place, "verify-town", message);
    }
}

/// The occluder of the target is in table `objects`, or a body that is seen in the same frame.
pub fn check_occluders(
    file: &str,
    objects: Option<&BTreeSet<u32>>,
    others: &[PlacedBody],
    frames: &[PlacedFrame],
    report: &mut VerifyReport,
) {
    let seen = others.iter().filter(|body| body.pixels > 0);
    let bodies: BTreeSet<(u32, u32)> = seen.filter_map(|body| Some((body.frame, body.instance?))).collect();
    let is_known = |frame: &&PlacedFrame| {
        frame.occluder_instance == 0
            || objects.is_some_and(|ids| ids.contains(&frame.occluder_instance))
            || bodies.contains(&(frame.frame, frame.occluder_instance))
    };
    if let Some(frame) = frames.iter().find(|frame| !is_known(frame)) {
        let message =
            format!("its occluder {} is neither in table `objects` nor seen in `bodies`", frame.occluder_instance);
        let place = format!("row {}, `{}` frame {}", frame.row, frame.trajectory_id, frame.frame);
        report.find(file, place, "verify-reference", message);
    }
}

/// The row of a twin in table `pairs` sums up its frames.
pub fn check_pair(
    pairs: &BTreeMap<String, PairRow>,
    flight: &PlacedFlight,
    frames: &[PlacedFrame],
    report: &mut VerifyReport,
) {
    let Some(pair) = pairs.get(&flight.trajectory_id) else { return };
    let events = || frames.iter().filter_map(|frame| frame.disturbance.as_ref());
    let expert_frames = digest(events().map(|it| i64::from(it.expert_frame)));
    let max_offset_m = events().map(|it| it.drone_offset_in_world.length()).fold(0.0, f64::max);
    let counts = [frames.len(), events().filter(|it| it.position).count(), events().filter(|it| it.rotation).count()];
    let is_same = pair.expert_frames == expert_frames
        && (pair.max_offset_m - max_offset_m).abs() <= TOLERANCE
        && pair.counts == counts.map(|count| count as u32)
        && pair.pedestrian_id == flight.pedestrian_id;
    if !is_same {
        let place = format!("row {}, `{}`", pair.place.1, flight.trajectory_id);
        report.find(&pair.place.0, place, "verify-pair", "it does not sum up the frames of this flight");
    }
}
