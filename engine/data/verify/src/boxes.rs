//! The stored boxes of a frame, against each other and against the body projected through the stored camera.

use super::body::{Body, SLACK_PX};
use super::film::Film;
use super::rows::PlacedFlight;
use cosfly_domain::{LensModel, TARGET_INSTANCE};
use cosfly_frames::{DVec3, Pose, real};

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

/// The fault of the stored boxes of a frame, in words; `None` for sound ones.
pub fn box_problem(film: &Film, number: usize) -> Option<String> {
    let (flight, frame) = (film.flight, film.frames.get(number)?);
    if frame.in_view != frame.full_box_px.is_some() || (frame.visible_pixels > 0) != frame.visible_box_px.is_some() {
        return Some("flags, pixel count and boxes contradict each other".into());
    }
    let sights = film.sights(number, TARGET_INSTANCE, &Body::of_target(flight, frame));
    let projected = |share: f64| -> Option<Vec<(f64, f64, f64)>> {
        sights.iter().map(|(pose, body)| flight.project(pose, body.on_axis(share))).collect()
    };
    let (width, height) = (f64::from(flight.camera.width), f64::from(flight.camera.height));
    let inside_image =
        |u: f64, v: f64| (SLACK_PX..width - SLACK_PX).contains(&u) && (SLACK_PX..height - SLACK_PX).contains(&v);
    let Some(full) = frame.full_box() else {
        let middle = projected(AXIS_HEIGHTS[1])?;
        let (u, v, _) = *middle.first()?;
        let is_large = |depth: f64| flight.camera.focal_px() * 0.1 * flight.target_height_m / depth > SLACK_PX;
        return middle
            .iter()
            .all(|(u, v, depth)| is_large(*depth) && inside_image(*u, *v))
            .then(|| format!("it is out of view, but its middle projects to pixel ({u:.1}, {v:.1})"));
    };
    if let Some(seen) = frame.visible_box()
        && !(contains(&full, seen[0], seen[1], 0.0) && contains(&full, seen[2], seen[3], 0.0))
    {
        return Some(format!("the visible box {seen:?} leaves the full box {full:?}"));
    }
    for (share, limb) in AXIS_HEIGHTS.into_iter().zip(LIMB_LENGTHS) {
        let Some(places) = projected(share) else {
            return Some("the body is behind the camera and has a box".into());
        };
        let slack_px = |((pose, body), (_, _, depth)): (&(Pose, Body), &(f64, f64, f64))| {
            let slack = axis_slack_px(flight.camera.focal_px() * body.height_m / depth, limb);
            slack * stretch(flight, pose, body.on_axis(share))
        };
        let slack = sights.iter().zip(&places).map(slack_px).fold(0.0, f64::max);
        let way = places
            .iter()
            .fold([f64::MAX, f64::MAX, f64::MIN, f64::MIN], |way, (u, v, _)| around(way, [*u, *v, *u, *v]));
        if places.iter().all(|(u, v, _)| inside_image(*u, *v)) && !meets(&full, &way, slack) {
            let (u, v, _) = places[places.len() / 2];
            return Some(format!(
                "its body at {share} of its height projects to pixel ({u:.1}, {v:.1}), outside of box {full:?}"
            ));
        }
    }
    let hull = hull_of(flight, &sights)?;
    let fits = full[0] >= hull[0] - SLACK_PX
        && full[1] >= hull[1] - SLACK_PX
        && full[2] <= hull[2] + SLACK_PX
        && full[3] <= hull[3] + SLACK_PX;
    (!fits).then(|| format!("the box {full:?} is larger than the projected body {hull:.1?}"))
}

/// Edges, pixels, of the space that a body fills while the rows of a picture are taken; none where part of it is behind the camera.
pub fn hull_of(flight: &PlacedFlight, sights: &[(Pose, Body)]) -> Option<[f64; 4]> {
    let (first, rest) = sights.split_first()?;
    let hull = |(pose, body): &(Pose, Body)| body.hull(flight, pose);
    rest.iter().try_fold(hull(first)?, |all, sight| Some(around(all, hull(sight)?)))
}

fn around(one: [f64; 4], other: [f64; 4]) -> [f64; 4] {
    [one[0].min(other[0]), one[1].min(other[1]), one[2].max(other[2]), one[3].max(other[3])]
}

/// How much wider than long an equirectangular picture shows a point near its upper and lower edge; 1 of other lenses.
fn stretch(flight: &PlacedFlight, pose: &Pose, point_in_world: DVec3) -> f64 {
    let seen = pose.body_from_world_point(point_in_world);
    let is_around = flight.lens.model == LensModel::Equirectangular;
    if is_around { (seen.length() / real::hypot(seen.x, seen.y).max(1e-6)).clamp(1.0, 20.0) } else { 1.0 }
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

fn meets(one: &[f64; 4], other: &[f64; 4], slack: f64) -> bool {
    (0..2).all(|axis| other[axis] <= one[axis + 2] + slack && other[axis + 2] >= one[axis] - slack)
}

fn contains(pixel_box: &[f64; 4], u: f64, v: f64, slack: f64) -> bool {
    (pixel_box[0] - slack..=pixel_box[2] + slack).contains(&u)
        && (pixel_box[1] - slack..=pixel_box[3] + slack).contains(&v)
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
