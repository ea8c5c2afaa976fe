//! The space that a walking body may fill, projected into the image.

use super::rows::{PlacedFlight, PlacedFrame};
use cosfly_domain::BodyKind;
use cosfly_frames::{DVec3, Pose, real};

/// A walking body reaches this far from its axis, in body heights: arms and legs swing beyond its radius.
const REACH_PER_HEIGHT: f64 = 0.42;
/// Highest point, in body heights: of a head while it bobs, of an umbrella.
const TOP_PER_HEIGHT: f64 = 1.03;
const UMBRELLA_PER_HEIGHT: f64 = 1.25;
/// Slack of edges through a wide lens, share of width and height together.
const WIDE_SLACK: f64 = 0.1;
/// Difference between sizes that are the same, metres.
const NEAR_M: f64 = 1e-6;
/// Slack of projected edges, pixels: pixels are sampled at their centres.
pub const SLACK_PX: f64 = 1.5;

/// Fault of the size of a body of a kind, metres, in words; the outline is asked of those who take something along.
pub fn size_problem(kind: BodyKind, height_m: f64, outline_m: Option<[f64; 2]>) -> Option<String> {
    let (name, walking) = (kind.name(), kind.row().walking.as_ref()?);
    if let Some([low, high]) =
        walking.heights_m.filter(|[low, high]| height_m < low - NEAR_M || height_m > high + NEAR_M)
    {
        return Some(format!("it is {height_m} m tall; the kind `{name}` is {low} to {high} m"));
    }
    let (found, expected) = (outline_m?, walking.outline_m?);
    let is_off = found.iter().zip(expected).any(|(found, expected)| (found - expected).abs() > NEAR_M);
    is_off.then(|| format!("it is {found:?} m long and wide; the kind `{name}` is {expected:?} m"))
}

/// The space a walking body may fill: an upright cylinder, with the umbrella.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Point on the ground between the feet, world frame, metres.
    pub feet: DVec3,
    /// Height, metres.
    pub height_m: f64,
    /// Radius of the trunk, metres.
    pub radius_m: f64,
    /// Whether an open umbrella is held above it.
    pub has_umbrella: bool,
}

/// A body around the target in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedBody {
    /// Row in its file.
    pub row: usize,
    /// The frame.
    pub frame: u32,
    /// Id in instance images; `None` for a body that no picture can show.
    pub instance: Option<u32>,
    /// Visible pixels.
    pub pixels: u32,
    /// Edges around the visible pixels: left, top, right, bottom.
    pub visible_box: Option<[f64; 4]>,
    /// Id of the body.
    pub body_id: String,
    /// Kind; none of an unknown one.
    pub kind: Option<BodyKind>,
    /// Length, width and height, metres.
    pub size_m: DVec3,
    /// Heading, radians.
    pub heading_rad: f64,
    /// Place of the body, and the space that it may fill.
    pub space: Body,
}

impl Body {
    /// The target of a frame.
    pub fn of_target(flight: &PlacedFlight, frame: &PlacedFrame) -> Self {
        Self {
            feet: frame.target.feet_in_world,
            height_m: flight.target_height_m,
            radius_m: flight.target_radius_m,
            has_umbrella: flight.target_has_umbrella,
        }
    }

    /// The point on the axis at `share` of the height.
    pub fn on_axis(&self, share: f64) -> DVec3 {
        self.feet + DVec3::Z * (share * self.height_m)
    }

    /// Corners of a polygonal prism around the cylinder.
    fn corners(&self) -> impl Iterator<Item = DVec3> {
        const SIDES: u32 = 16;
        // A polygon around a circle is wider than it by 1 / cos(pi / sides).
        let reach = self.radius_m.max(REACH_PER_HEIGHT * self.height_m) / real::cos(real::PI / f64::from(SIDES));
        let top = if self.has_umbrella { UMBRELLA_PER_HEIGHT } else { TOP_PER_HEIGHT };
        (0..SIDES).flat_map(move |side| {
            let (sin, cos) = real::sin_cos(real::TAU * f64::from(side) / f64::from(SIDES));
            [-0.02, top].map(|share| self.on_axis(share) + DVec3::new(reach * cos, reach * sin, 0.0))
        })
    }

    /// Edges of the projected prism, pixels: left, top, right, bottom; `None` when part of it is behind the camera, or where it is
    /// all around it.
    pub fn hull(&self, flight: &PlacedFlight, pose: &Pose) -> Option<[f64; 4]> {
        let hull = self.corners_in(flight, pose)?;
        if !flight.lens.is_wide(&flight.camera) {
            return Some(hull);
        }
        // Edges of the prism are curves in such a picture, and a body across its seam is on both sides.
        let [left, top, right, bottom] = hull;
        let bow = WIDE_SLACK * (right - left + bottom - top);
        let is_whole = right - left < 0.25 * f64::from(flight.camera.width);
        is_whole.then_some([left - bow, top - bow, right + bow, bottom + bow])
    }

    fn corners_in(&self, flight: &PlacedFlight, pose: &Pose) -> Option<[f64; 4]> {
        self.corners().try_fold([f64::MAX, f64::MAX, f64::MIN, f64::MIN], |hull, corner| {
            let (u, v, depth) = flight.project(pose, corner)?;
            (depth > 0.1).then(|| [hull[0].min(u), hull[1].min(v), hull[2].max(u), hull[3].max(v)])
        })
    }

    /// Nearest and farthest depth of the prism, metres: along the optical axis, of a wide lens along the rays.
    pub fn depths_m(&self, flight: &PlacedFlight, pose: &Pose) -> (f64, f64) {
        if flight.lens.is_wide(&flight.camera) {
            let eye = pose.position_in_world;
            let far_m = self.corners().map(|corner| corner.distance(eye)).fold(0.0, f64::max);
            let nearest = self.on_axis(((eye.z - self.feet.z) / self.height_m).clamp(0.0, 1.0));
            let reach_m = self.corners().map(|corner| corner.distance(self.on_axis(0.0))).fold(f64::MAX, f64::min);
            return (nearest.distance(eye) - reach_m - 0.25 * self.height_m, far_m);
        }
        let ahead = pose.world_from_body() * DVec3::X;
        self.corners()
            .map(|corner| (corner - pose.position_in_world).dot(ahead))
            .fold((f64::MAX, f64::MIN), |(near, far), depth| (near.min(depth), far.max(depth)))
    }
}
