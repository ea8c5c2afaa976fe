//! The figures of table `trajectories`: against its frames, and against its own limits.

use super::body::size_problem;
use super::figures::{MAXIMA, MEANS};
use super::report::VerifyReport;
use super::rows::{PlacedFlight, PlacedFrame};
use cosfly_domain::{BodyKind, Camera};
use cosfly_frames::real;
use cosfly_schema::Role;
use cosfly_schema::tables::Trajectories;

/// Figures that are sums over frames may differ by rounding.
const TOLERANCE: f64 = 1e-9;
/// Kinematic limits are kept to rounding.
const LIMIT_TOLERANCE: f64 = 1e-4;
/// How far the mean visibility by rays may be from that by pixels over a flight, where boxes are large enough.
const VISIBILITY_TOLERANCE: f64 = 0.35;
/// Least height and width together of boxes that visibilities are compared over, pixels.
const LARGE_BOX_PX: f64 = 20.0;
/// Fewer frames with large boxes say nothing.
const ENOUGH_FRAMES: usize = 5;

/// Checks a row of `trajectories` by itself: camera, role, certificate.
pub fn check_row(flight: &PlacedFlight, report: &mut VerifyReport) {
    let figures = &flight.figures;
    let mut find = |rule, message: String| {
        let place = format!("row {}, `{}`", flight.place.1, flight.trajectory_id);
        report.find(&flight.place.0, place, rule, message);
    };
    let Camera { width, height, .. } = flight.camera;
    let expected = [flight.camera.focal_px(), 0.5 * f64::from(width), 0.5 * f64::from(height)];
    if !figures.focal_and_centre_px.iter().zip(expected).all(|(a, b)| is_near(*a, b)) {
        let found = figures.focal_and_centre_px;
        find(
            "verify-camera",
            format!("focal length and centre are {found:?}; size and field of view give {expected:?}"),
        );
    }
    let (said, is_wide) = (figures.depth_is_along_rays, flight.lens.is_wide(&flight.camera));
    if said != is_wide {
        find("verify-camera", format!("`camera_depth_is_along_rays` is {said}; the lens gives {is_wide}"));
    }
    if let Some(message) = target_kind(flight).and_then(|kind| size_problem(kind, flight.target_height_m, None)) {
        find("verify-kind", message);
    }
    if (figures.role == Role::Perturbed) != flight.expert_id.is_some() {
        find("verify-pair", "`role` and `expert_id` contradict each other".into());
    }
    let mut broken = vec![];
    let [limit_clearance_m, limits @ ..] = flight.limits;
    if limit_clearance_m.is_some_and(|limit| figures.min_clearance_m < limit) {
        broken.push(Trajectories::min_clearance_m.name);
    }
    for ((column, value), limit) in MAXIMA.into_iter().zip(figures.maxima).zip(limits) {
        if limit.is_some_and(|limit| value > limit + LIMIT_TOLERANCE) {
            broken.push(column.name);
        }
    }
    if figures.holds && !broken.is_empty() {
        find("verify-certificate", format!("the certificate holds, but its limits do not allow {}", broken.join(", ")));
    }
}

/// Checks the figures that follow from the frames of the flight.
pub fn check_frames(flight: &PlacedFlight, frames: &[PlacedFrame], report: &mut VerifyReport) {
    let figures = &flight.figures;
    let mut find = |rule, message: String| {
        let place = format!("row {}, `{}`", flight.place.1, flight.trajectory_id);
        report.find(&flight.place.0, place, rule, message);
    };
    let in_view = frames.iter().filter(|frame| frame.in_view).count();
    if in_view != figures.frames_in_view as usize {
        find("verify-figures", format!("`frames_in_view` is {}; counted are {in_view}", figures.frames_in_view));
    }
    for ((column, found), expected) in MEANS.into_iter().zip(figures.means).zip(of_frames(frames)) {
        if !is_near(found, expected) {
            find("verify-figures", format!("`{}` is {found}; table `frames` gives {expected}", column.name));
        }
    }
    let [.., yaw, pitch] = figures.maxima;
    for ((column, found), expected) in MAXIMA[3..].iter().zip([yaw, pitch]).zip(turning_deg_s(flight, frames)) {
        if !found.is_nan() && !is_near(found, expected) {
            find("verify-figures", format!("`{}` is {found}; table `frames` gives {expected}", column.name));
        }
    }
    let nearest_m = frames.iter().map(|frame| frame.clearance_m).fold(f64::INFINITY, f64::min);
    if figures.min_clearance_m > nearest_m + TOLERANCE {
        find("verify-figures", format!("`min_clearance_m` is {}; a frame has {nearest_m}", figures.min_clearance_m));
    }
    if let Some([rays, pixels]) = compared_visibility(flight, frames)
        && (rays - pixels).abs() > VISIBILITY_TOLERANCE
    {
        find("verify-visibility", format!("{rays:.3} of the target is visible by rays, {pixels:.3} by pixels"));
    }
}

/// Means of [`MEANS`] over the frames.
fn of_frames(frames: &[PlacedFrame]) -> [f64; 5] {
    let count = frames.len().max(1) as f64;
    let mean = |value: &dyn Fn(&PlacedFrame) -> f64| frames.iter().map(value).sum::<f64>() / count;
    [
        mean(&|frame| frame.visible_by_pixels),
        mean(&|frame| frame.visible_by_rays),
        mean(&|frame| f64::from(u8::from(frame.visible_by_rays >= 0.5))),
        mean(&|frame| frame.target.feet_in_world.distance(frame.pose.position_in_world)),
        frames.windows(2).map(|pair| pair[1].pose.position_in_world.distance(pair[0].pose.position_in_world)).sum(),
    ]
}

/// Largest rates of yaw and of pitch between two frames, degrees/s.
fn turning_deg_s(flight: &PlacedFlight, frames: &[PlacedFrame]) -> [f64; 2] {
    let angles: [fn(&PlacedFrame) -> f64; 2] = [|frame| frame.pose.yaw_rad, |frame| frame.pose.pitch_rad];
    angles.map(|angle| {
        let turned = |pair: &[PlacedFrame]| real::wrap_angle_rad(angle(&pair[1]) - angle(&pair[0])).abs().to_degrees();
        frames.windows(2).map(turned).fold(0.0, f64::max) / flight.dt_s
    })
}

/// Mean visibility by rays and by pixels over the frames in which the whole body is large and in the image; `None`
/// when there are too few. The points of the planner's rays lie within an upright person; of wider bodies, dense rays
/// tell how much is seen.
fn compared_visibility(flight: &PlacedFlight, frames: &[PlacedFrame]) -> Option<[f64; 2]> {
    let (width, height) = (f64::from(flight.camera.width), f64::from(flight.camera.height));
    let is_compared = |frame: &&PlacedFrame| {
        frame.full_box().is_some_and(|[left, top, right, bottom]| {
            let is_whole = left > 0.0 && top > 0.0 && right < width && bottom < height;
            is_whole && right - left + bottom - top >= LARGE_BOX_PX
        })
    };
    let by_rays: fn(&PlacedFrame) -> f64 = match target_kind(flight) {
        Some(kind) if !is_upright(kind) => |frame| frame.visible_by_dense_rays.unwrap_or(frame.visible_by_rays),
        _ => |frame| frame.visible_by_rays,
    };
    let compared: Vec<&PlacedFrame> = frames.iter().filter(is_compared).collect();
    let mean =
        |share: fn(&PlacedFrame) -> f64| compared.iter().map(|frame| share(frame)).sum::<f64>() / compared.len() as f64;
    (compared.len() >= ENOUGH_FRAMES).then(|| [mean(by_rays), mean(|frame| frame.visible_by_pixels)])
}

fn target_kind(flight: &PlacedFlight) -> Option<BodyKind> {
    BodyKind::ON_THE_GROUND.iter().copied().find(|kind| flight.target_kind.as_deref() == Some(kind.name()))
}

/// Whether bodies of a kind are people on foot without anything beside them.
fn is_upright(kind: BodyKind) -> bool {
    kind.row().walking.is_some_and(|walking| walking.outline_m.is_none())
}

/// Whether two numbers are the same but for rounding; never with NaN.
fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE * b.abs().max(1.0)
}
