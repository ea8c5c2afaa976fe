//! The frames of one flight: numbering, actions against poses, the body reprojected into the image, twins.

use super::files::CheckedFiles;
use super::labels;
use super::log::{self, Known};
use super::people::{self, PersonRow};
use super::report::VerifyReport;
use super::rows::{self, PlacedFlight, PlacedFrame};
use super::sums;
use super::tables::{PairRow, SmallTables};
use cosfly_frames::{DVec3, Pose, real};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Numbers that were computed from others in 64-bit floats may differ by this much (metres or degrees).
const TOLERANCE: f64 = 1e-6;
/// A walking body reaches this far from its axis, in body heights: arms and legs swing beyond its radius.
const REACH_PER_HEIGHT: f64 = 0.42;
/// Heights on the axis that the silhouette covers, in body heights.
const AXIS_HEIGHTS: [f64; 3] = [0.12, 0.65, 0.93];
/// How far the silhouette may be from a point on the axis, in body heights.
const AXIS_SLACK_PER_HEIGHT: f64 = 0.1;
/// Below this height of the body in pixels, head and legs are thinner than a pixel's diagonal and may miss all pixel
/// centres.
const THIN_LIMBS_BELOW_PX: f64 = 20.0;
/// From each of [`AXIS_HEIGHTS`] to the trunk, in body heights: how much of the silhouette is missing without limbs.
const LIMB_LENGTHS: [f64; 3] = [0.38, 0.0, 0.15];
/// Below this height in pixels the trunk may miss pixel centres as well, and any single pixel may be all of the box.
const THIN_TRUNK_BELOW_PX: f64 = 8.0;
/// Pixels are sampled at their centres.
pub(super) const SLACK_PX: f64 = 1.5;

/// Checks all flights: rows of `frames`, then the log of each, then `waypoints` and twins.
pub fn check_all(
    folder: &Path,
    files: &CheckedFiles,
    tables: &SmallTables,
    report: &mut VerifyReport,
    progress: &mut dyn FnMut(u64, u64),
) {
    let total = tables.flights.len() as u64;
    let mut motions: BTreeMap<String, blake3::Hasher> = BTreeMap::new();
    let mut twins = Twins::of(tables);
    for file in files.sound_below("data/frames/") {
        let mut others = people::read(folder, files, file, report);
        let people_file = people::file_beside(file);
        let outcome = rows::frames(&folder.join(file), &mut |frames| {
            let id = frames[0].trajectory_id.clone();
            let Some(flight) = tables.flights.get(&id) else {
                let place = format!("row {}, `{id}`", frames[0].row);
                report.find(file, place, "verify-reference", "there is no such flight");
                return;
            };
            if motions.contains_key(&id) {
                report.find(file, format!("row {}, `{id}`", frames[0].row), "verify-duplicate", "its rows are apart");
                return;
            }
            let mut motion = blake3::Hasher::new();
            for frame in &frames {
                motion.update(&frame.motion_bytes());
            }
            motions.insert(id.clone(), motion);
            check_frames(file, flight, &frames, report);
            sums::check_frames(flight, &frames, report);
            labels::compare(file, flight, &frames, report);
            let (others, objects) = (others.remove(&id).unwrap_or_default(), tables.instances.get(&flight.town));
            people::check(&people_file, flight, &frames, &others, objects, report);
            check_occluders(file, objects, &others, &frames, report);
            check_pair(&tables.pairs, flight, &frames, report);
            twins.keep(&frames);
            if files.regular.contains(&flight.mcap_path) {
                let captions = tables.captions.get(&id).map_or(&[][..], Vec::as_slice);
                log::check(folder, flight, &frames, &Known { captions, objects, others: &others }, report);
            }
            report.flights += 1;
            report.frames += frames.len() as u64;
            progress(report.flights, total);
        });
        if let Err(message) = outcome {
            report.find(file, "", "verify-schema", message);
        }
        for (id, rows) in others {
            let place = format!("row {}, `{id}`", rows[0].row);
            report.find(&people_file, place, "verify-reference", "its frames are not in the file of this name");
        }
    }
    for (id, flight) in tables.flights.iter().filter(|(id, _)| !motions.contains_key(*id)) {
        let place = format!("row {}, `{id}`", flight.place.1);
        report.find(&flight.place.0, place, "verify-count", "table `frames` has no readable rows of it");
    }
    check_waypoints(folder, files, &motions, report);
    twins.check(tables, report);
}

/// Numbering, times, shares, actions, distance and boxes of one flight.
pub(super) fn check_frames(file: &str, flight: &PlacedFlight, frames: &[PlacedFrame], report: &mut VerifyReport) {
    let id = &flight.trajectory_id;
    if frames.len() != flight.frames {
        let message = format!("{} rows; table `trajectories` says {} frames", frames.len(), flight.frames);
        report.find(file, format!("`{id}`"), "verify-count", message);
    }
    for (number, frame) in frames.iter().enumerate() {
        let mut find = |rule, message: String| {
            report.find(file, format!("row {}, `{id}` frame {number}", frame.row), rule, message);
        };
        let time_s = number as f64 * flight.dt_s;
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
        let distance_m = (frame.target.feet_in_world - frame.pose.position_in_world).length();
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
        if let Some(message) = box_problem(flight, frame) {
            find("verify-reprojection", message);
        }
        let turned = flight.mount.camera_pose(&frame.pose).world_from_body();
        let stored = frame.camera_pose.world_from_body();
        let apart = (turned.x_axis - stored.x_axis).length().max((turned.y_axis - stored.y_axis).length());
        if apart.is_nan() || apart > TOLERANCE {
            find("verify-camera", format!("the camera's attitude is {apart} from the drone's turned by its mount"));
        }
    }
    report.boxes += frames.iter().filter(|frame| frame.full_box_px.is_some()).count() as u64;
}

/// What hides the target is in table `objects`, or somebody who is seen in the same frame.
fn check_occluders(
    file: &str,
    objects: Option<&BTreeSet<u32>>,
    others: &[PersonRow],
    frames: &[PlacedFrame],
    report: &mut VerifyReport,
) {
    let people: BTreeSet<(u32, u32)> = others.iter().map(|person| (person.frame, person.instance)).collect();
    let is_known = |frame: &&PlacedFrame| {
        frame.occluder_instance == 0
            || objects.is_some_and(|ids| ids.contains(&frame.occluder_instance))
            || people.contains(&(frame.frame, frame.occluder_instance))
    };
    if let Some(frame) = frames.iter().find(|frame| !is_known(frame)) {
        let message = format!("its occluder {} is neither in table `objects` nor in `people`", frame.occluder_instance);
        let place = format!("row {}, `{}` frame {}", frame.row, frame.trajectory_id, frame.frame);
        report.find(file, place, "verify-reference", message);
    }
}

/// What is wrong with the stored boxes of a frame, if anything: they must agree with each other and with the body
/// projected through the stored camera.
fn box_problem(flight: &PlacedFlight, frame: &PlacedFrame) -> Option<String> {
    if frame.in_view != frame.full_box_px.is_some() || (frame.visible_pixels > 0) != frame.visible_box_px.is_some() {
        return Some("flags, pixel count and boxes contradict each other".into());
    }
    let body =
        Body { feet: frame.target.feet_in_world, height_m: flight.target_height_m, radius_m: flight.target_radius_m };
    let (width, height) = (f64::from(flight.camera.width), f64::from(flight.camera.height));
    let inside_image =
        |u: f64, v: f64| (SLACK_PX..width - SLACK_PX).contains(&u) && (SLACK_PX..height - SLACK_PX).contains(&v);
    let Some(full) = frame.full_box() else {
        let (u, v, depth) = flight.project(&frame.camera_pose, body.on_axis(AXIS_HEIGHTS[1]))?;
        let large = flight.camera.focal_px() * 0.1 * body.height_m / depth > SLACK_PX;
        return (large && inside_image(u, v))
            .then(|| format!("it is out of view, but its middle projects to pixel ({u:.1}, {v:.1})"));
    };
    if let Some(seen) = frame.visible_box()
        && !(contains(&full, seen[0], seen[1], 0.0) && contains(&full, seen[2], seen[3], 0.0))
    {
        return Some(format!("the visible box {seen:?} leaves the full box {full:?}"));
    }
    for (share, limb) in AXIS_HEIGHTS.into_iter().zip(LIMB_LENGTHS) {
        let Some((u, v, depth)) = flight.project(&frame.camera_pose, body.on_axis(share)) else {
            return Some("the body is behind the camera and has a box".into());
        };
        let slack = axis_slack_px(flight.camera.focal_px() * body.height_m / depth, limb);
        if inside_image(u, v) && !contains(&full, u, v, slack) {
            return Some(format!(
                "its body at {share} of its height projects to pixel ({u:.1}, {v:.1}), outside of box {full:?}"
            ));
        }
    }
    let hull = body.hull(flight, &frame.camera_pose)?;
    let fits = full[0] >= hull[0] - SLACK_PX
        && full[1] >= hull[1] - SLACK_PX
        && full[2] <= hull[2] + SLACK_PX
        && full[3] <= hull[3] + SLACK_PX;
    (!fits).then(|| format!("the box {full:?} is larger than the projected body {hull:.1?}"))
}

/// How far a point on the axis may lie outside of the box of a body that is `height_px` high, when it is `limb` body
/// heights from the trunk.
fn axis_slack_px(height_px: f64, limb: f64) -> f64 {
    let missed = match height_px {
        height if height < THIN_TRUNK_BELOW_PX => 0.5,
        height if height < THIN_LIMBS_BELOW_PX => limb,
        _ => 0.0,
    };
    SLACK_PX + height_px * (AXIS_SLACK_PER_HEIGHT + missed)
}

fn contains(pixel_box: &[f64; 4], u: f64, v: f64, slack: f64) -> bool {
    (pixel_box[0] - slack..=pixel_box[2] + slack).contains(&u)
        && (pixel_box[1] - slack..=pixel_box[3] + slack).contains(&v)
}

/// The space a walking body may fill: an upright cylinder.
pub(super) struct Body {
    pub feet: DVec3,
    pub height_m: f64,
    pub radius_m: f64,
}

impl Body {
    /// The point on the axis at `share` of the height.
    fn on_axis(&self, share: f64) -> DVec3 {
        self.feet + DVec3::Z * (share * self.height_m)
    }

    /// Corners of a polygonal prism around the cylinder.
    fn corners(&self) -> impl Iterator<Item = DVec3> {
        const SIDES: u32 = 16;
        // A polygon around a circle is wider than it by 1 / cos(pi / sides).
        let reach = self.radius_m.max(REACH_PER_HEIGHT * self.height_m) / real::cos(real::PI / f64::from(SIDES));
        (0..SIDES).flat_map(move |side| {
            let (sin, cos) = real::sin_cos(real::TAU * f64::from(side) / f64::from(SIDES));
            [-0.02, 1.03].map(|share| self.on_axis(share) + DVec3::new(reach * cos, reach * sin, 0.0))
        })
    }

    /// Edges of the projected prism; `None` when part of it is behind the camera.
    pub fn hull(&self, flight: &PlacedFlight, pose: &Pose) -> Option<[f64; 4]> {
        self.corners().try_fold([f64::MAX, f64::MAX, f64::MIN, f64::MIN], |hull, corner| {
            let (u, v, depth) = flight.project(pose, corner)?;
            (depth > 0.1).then(|| [hull[0].min(u), hull[1].min(v), hull[2].max(u), hull[3].max(v)])
        })
    }

    /// Nearest and farthest planar depth of the prism.
    pub fn depths_m(&self, pose: &Pose) -> (f64, f64) {
        let ahead = pose.world_from_body() * DVec3::X;
        self.corners()
            .map(|corner| (corner - pose.position_in_world).dot(ahead))
            .fold((f64::MAX, f64::MIN), |(near, far), depth| (near.min(depth), far.max(depth)))
    }
}

/// The row of a twin in table `pairs` sums up its frames.
fn check_pair(
    pairs: &BTreeMap<String, PairRow>,
    flight: &PlacedFlight,
    frames: &[PlacedFrame],
    report: &mut VerifyReport,
) {
    let Some(pair) = pairs.get(&flight.trajectory_id) else { return };
    let events = || frames.iter().filter_map(|frame| frame.disturbance.as_ref());
    let expert_frames: Vec<i64> = events().map(|it| i64::from(it.expert_frame)).collect();
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

/// The motion in `waypoints` is that of `frames`, bit for bit.
fn check_waypoints(
    folder: &Path,
    files: &CheckedFiles,
    motions: &BTreeMap<String, blake3::Hasher>,
    report: &mut VerifyReport,
) {
    let mut found: BTreeMap<String, (u32, blake3::Hasher)> = BTreeMap::new();
    for file in files.sound_below("data/waypoints/") {
        let outcome = rows::waypoints(&folder.join(file), &mut |id, step, motion| {
            let (next, hasher) = found.entry(id).or_insert((0, blake3::Hasher::new()));
            hasher.update(&motion);
            // A step out of order spoils the hash.
            if step != *next {
                hasher.update(b"order");
            }
            *next += 1;
        });
        if let Err(message) = outcome {
            report.find(file, "", "verify-schema", message);
        }
    }
    let names: BTreeSet<&String> = motions.keys().chain(found.keys()).collect();
    for id in names {
        let same = matches!((motions.get(id), found.get(id)), (Some(a), Some((_, b))) if a.finalize() == b.finalize());
        if !same {
            report.find(
                "data/waypoints",
                format!("`{id}`"),
                "verify-waypoints",
                "its steps are not those of table `frames`",
            );
        }
    }
}

/// One frame of a perturbed flight, as far as its expert is concerned.
struct TwinFrame {
    row: usize,
    position: DVec3,
    angles_deg: [f64; 3],
    expert_frame: Option<u32>,
    undisturbed: bool,
    offset: DVec3,
}

/// Experts and twins, kept until both have been read.
struct Twins<'a> {
    tables: &'a SmallTables,
    wanted: BTreeSet<&'a str>,
    experts: BTreeMap<String, Vec<(DVec3, [f64; 3], DVec3)>>,
    twins: BTreeMap<String, Vec<(TwinFrame, DVec3)>>,
}

impl<'a> Twins<'a> {
    fn of(tables: &'a SmallTables) -> Self {
        let wanted = tables.flights.values().filter_map(|flight| flight.expert_id.as_deref());
        Self { tables, wanted: wanted.collect(), experts: BTreeMap::new(), twins: BTreeMap::new() }
    }

    fn keep(&mut self, frames: &[PlacedFrame]) {
        let id = &frames[0].trajectory_id;
        if self.wanted.contains(id.as_str()) {
            let poses =
                frames.iter().map(|it| (it.pose.position_in_world, it.angles_deg, it.target.feet_in_world)).collect();
            self.experts.insert(id.clone(), poses);
        }
        if self.tables.flights.get(id).is_some_and(|flight| flight.expert_id.is_some()) {
            let twin = |frame: &PlacedFrame| {
                let event = frame.disturbance.as_ref();
                let twin = TwinFrame {
                    row: frame.row,
                    position: frame.pose.position_in_world,
                    angles_deg: frame.angles_deg,
                    expert_frame: event.map(|it| it.expert_frame),
                    undisturbed: event.is_none_or(|it| !it.position && !it.rotation),
                    offset: event.map_or(DVec3::ZERO, |it| it.drone_offset_in_world),
                };
                (twin, frame.target.feet_in_world)
            };
            self.twins.insert(id.clone(), frames.iter().map(twin).collect());
        }
    }

    /// A twin is its expert plus the stored displacement, and exactly its expert where nothing happened.
    fn check(&self, tables: &SmallTables, report: &mut VerifyReport) {
        for (id, frames) in &self.twins {
            let flight = &tables.flights[id];
            let file = flight.place.0.replace("data/trajectories/", "data/frames/");
            let Some(expert_id) = &flight.expert_id else { continue };
            let Some(expert) = self.experts.get(expert_id) else { continue };
            for (number, (frame, feet)) in frames.iter().enumerate() {
                let of_expert = frame.expert_frame.and_then(|it| expert.get(it as usize));
                let aligned = of_expert.is_some_and(|(position, angles, expert_feet)| {
                    let turned = angles.iter().zip(frame.angles_deg).any(|(a, b)| (a - b).abs() > TOLERANCE);
                    (*position + frame.offset - frame.position).length() <= TOLERANCE
                        && (*expert_feet - *feet).length() <= TOLERANCE
                        && !(frame.undisturbed && turned)
                });
                if !aligned {
                    let expert_frame = frame.expert_frame.map_or("?".to_owned(), |it| it.to_string());
                    let message =
                        format!("it is not frame {expert_frame} of `{expert_id}` plus its stored displacement");
                    report.find(&file, format!("row {}, `{id}` frame {number}", frame.row), "verify-pair", message);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_may_leave_the_box_only_as_far_as_thin_parts_can_be_missed() {
        // A body of normal size: a box that is shifted by several pixels is found.
        assert!(axis_slack_px(24.0, LIMB_LENGTHS[2]) < 4.0);
        // Twelve pixels high: head and legs may be missing, the trunk may not.
        assert!(axis_slack_px(12.0, LIMB_LENGTHS[2]) > 2.5 && axis_slack_px(12.0, LIMB_LENGTHS[1]) < 3.0);
        // Three pixels high: one covered pixel centre anywhere on the body is a sound box.
        assert!(axis_slack_px(3.0, 0.0) > 3.0);
    }
}
