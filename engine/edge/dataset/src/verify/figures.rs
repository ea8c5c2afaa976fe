//! The figures of table `trajectories`: against its frames, and against its own limits.

use super::report::VerifyReport;
use super::rows::{Batch, FlightRow, FrameRow};
use cosfly_render::Camera;

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

/// What table `trajectories` says about the frames and the certificate of a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    is_perturbed: Option<bool>,
    focal_and_centre_px: [f64; 3],
    frames_in_view: i64,
    /// Name and value of what must follow from the frames, in the order of [`of_frames`].
    means: [f64; 5],
    min_clearance_m: f64,
    /// Largest speed, acceleration, jerk.
    maxima: [f64; 3],
    limit_clearance_m: Option<f64>,
    /// Of speed, acceleration, jerk.
    limits: [Option<f64>; 3],
    holds: bool,
}

const MEANS: [&str; 5] =
    ["mean_visible_by_pixels", "mean_visibility", "frames_half_visible", "mean_distance_m", "length_m"];
const MAXIMA: [&str; 3] = ["max_speed_mps", "max_acceleration_mps2", "max_jerk_mps3"];
const LIMITS: [&str; 3] = ["limit_speed_mps", "limit_acceleration_mps2", "limit_jerk_mps3"];

impl Figures {
    /// The figures in a row of `trajectories`.
    pub fn read(batch: &Batch, row: usize) -> Self {
        let real = |name| batch.real(name, row).unwrap_or(f64::NAN);
        Self {
            is_perturbed: batch.integer("role", row).and_then(|role| [false, true].get(role as usize).copied()),
            focal_and_centre_px: ["camera_focal_px", "camera_cx_px", "camera_cy_px"].map(real),
            frames_in_view: batch.integer("frames_in_view", row).unwrap_or(-1),
            means: MEANS.map(real),
            min_clearance_m: real("min_clearance_m"),
            maxima: MAXIMA.map(real),
            limit_clearance_m: batch.real("limit_clearance_m", row),
            limits: LIMITS.map(|name| batch.real(name, row)),
            holds: batch.flag("certificate_holds", row).unwrap_or(false),
        }
    }
}

/// Checks a row of `trajectories` by itself: camera, role, certificate.
pub fn check_row(flight: &FlightRow, report: &mut VerifyReport) {
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
    if figures.is_perturbed != Some(!flight.expert_id.is_empty()) {
        find("verify-pair", "`role` and `expert_id` contradict each other".into());
    }
    let mut broken = vec![];
    if figures.limit_clearance_m.is_some_and(|limit| figures.min_clearance_m < limit) {
        broken.push("min_clearance_m");
    }
    for ((name, value), limit) in MAXIMA.into_iter().zip(figures.maxima).zip(figures.limits) {
        if limit.is_some_and(|limit| value > limit + LIMIT_TOLERANCE) {
            broken.push(name);
        }
    }
    if figures.holds && !broken.is_empty() {
        find("verify-certificate", format!("the certificate holds, but its limits do not allow {}", broken.join(", ")));
    }
}

/// Checks the figures that follow from the frames of the flight.
pub fn check_frames(flight: &FlightRow, frames: &[FrameRow], report: &mut VerifyReport) {
    let figures = &flight.figures;
    let mut find = |rule, message: String| {
        let place = format!("row {}, `{}`", flight.place.1, flight.trajectory_id);
        report.find(&flight.place.0, place, rule, message);
    };
    let in_view = frames.iter().filter(|frame| frame.in_view).count() as i64;
    if in_view != figures.frames_in_view {
        find("verify-figures", format!("`frames_in_view` is {}; {in_view} frames are", figures.frames_in_view));
    }
    for ((name, found), expected) in MEANS.into_iter().zip(figures.means).zip(of_frames(frames)) {
        if !is_near(found, expected) {
            find("verify-figures", format!("`{name}` is {found}; table `frames` gives {expected}"));
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

/// What the frames give for [`MEANS`].
fn of_frames(frames: &[FrameRow]) -> [f64; 5] {
    let count = frames.len().max(1) as f64;
    let mean = |value: &dyn Fn(&FrameRow) -> f64| frames.iter().map(value).sum::<f64>() / count;
    [
        mean(&|frame| frame.visible[1]),
        mean(&|frame| frame.visible[0]),
        mean(&|frame| f64::from(u8::from(frame.visible[0] >= 0.5))),
        mean(&|frame| frame.distance_m),
        frames.windows(2).map(|pair| pair[1].pose.position_in_world.distance(pair[0].pose.position_in_world)).sum(),
    ]
}

/// Mean visibility by rays and by pixels over the frames in which the whole body is large and in the image; `None`
/// when there are too few.
fn compared_visibility(flight: &FlightRow, frames: &[FrameRow]) -> Option<[f64; 2]> {
    let (width, height) = (f64::from(flight.camera.width), f64::from(flight.camera.height));
    let is_compared = |frame: &&FrameRow| {
        frame.full_box.is_some_and(|[left, top, right, bottom]| {
            let is_whole = left > 0.0 && top > 0.0 && right < width && bottom < height;
            is_whole && right - left + bottom - top >= LARGE_BOX_PX
        })
    };
    let compared: Vec<&FrameRow> = frames.iter().filter(is_compared).collect();
    let mean = |by: usize| compared.iter().map(|frame| frame.visible[by]).sum::<f64>() / compared.len() as f64;
    (compared.len() >= ENOUGH_FRAMES).then(|| [mean(0), mean(1)])
}

/// Whether two numbers are the same but for rounding; never with NaN.
fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE * b.abs().max(1.0)
}
