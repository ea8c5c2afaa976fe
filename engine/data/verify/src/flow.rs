//! Optical flow of what stands: against depth, and the camera's poses in the frame and in the one beside it.

use super::rows::{PlacedFlight, PlacedFrame};
use cosfly_domain::Channel;
use cosfly_domain::channels::{ChannelSource, FlowTo};
use cosfly_frames::{DVec3, Pose};

/// Every so many pixels are compared, of those that show what stands or the sky.
const EVERY: usize = 61;
/// Largest difference between the stored flow and the one of depth and poses, pixels and a share of its length: poses are stored
/// in degrees, numbers in 32 bits.
const MOST_PX: f64 = 0.01;
const MOST_SHARE: f64 = 1e-4;
/// Depths are at most this far from the ones that flows are of: half the step of the grid, metres.
const DEPTH_STEP_M: f64 = 5e-4;

/// Depths of pixels of one frame that show what stands or the sky.
#[derive(Default)]
pub struct StandingPoints {
    frame: usize,
    /// Pixel and depth, metres.
    points: Vec<(usize, f64)>,
}

impl StandingPoints {
    /// The points of a frame; `stands` tells for a pixel whether it shows something that stands.
    pub fn of(frame: usize, depths: &[u8], stands: impl Fn(usize) -> bool) -> Self {
        let depths = depths.as_chunks::<4>().0.iter().map(|four| f64::from(f32::from_le_bytes(*four)));
        let points = depths.enumerate().step_by(EVERY).filter(|(pixel, _)| stands(*pixel)).collect();
        Self { frame, points }
    }

    /// Pixels, their places in the frame beside and their depths there; none of a rolling shutter, whose rows are of other moments, and
    /// none where there is no such frame.
    pub fn ends(
        &self,
        flight: &PlacedFlight,
        frames: &[PlacedFrame],
        (frame, to): (usize, FlowTo),
    ) -> Vec<(usize, (f64, f64), f64)> {
        let here = frames.get(frame).filter(|_| self.frame == frame && flight.readout_s == 0.0);
        let Some((here, beside)) = here.zip(beside(frames, frame, to)) else { return vec![] };
        let poses = (&here.camera_pose, &beside.camera_pose);
        let end = |&(pixel, depth_m): &(usize, f64)| {
            let way = way_of(flight, poses, pixel, depth_m)?;
            Some((pixel, way.to, way.ahead_m))
        };
        self.points.iter().filter_map(end).collect()
    }

    /// What is wrong with the flow or the mask of `frames[frame]`.
    pub fn finding(
        &self,
        flight: &PlacedFlight,
        frames: &[PlacedFrame],
        (frame, channel): (usize, &Channel),
        stored: &[u8],
    ) -> Option<String> {
        let (ChannelSource::Flow(to) | ChannelSource::FlowValid(to)) = channel.source else { return None };
        let Some(beside) = beside(frames, frame, to) else {
            let all_are_0 = stored.iter().all(|byte| *byte == 0);
            return (!all_are_0).then(|| "there is no frame beside it, and not all of it is 0".into());
        };
        // Rows of a rolling shutter are of moments that the tables do not have.
        let is_comparable = matches!(channel.source, ChannelSource::Flow(_)) && flight.readout_s == 0.0;
        let here = frames.get(frame).filter(|_| is_comparable && self.frame == frame)?;
        self.points.iter().find_map(|(pixel, depth_m)| {
            let flow = |depth_m: f64| flow_px(flight, (&here.camera_pose, &beside.camera_pose), *pixel, depth_m);
            let (expected, nearer) = (flow(*depth_m)?, flow(depth_m - DEPTH_STEP_M)?);
            let pair = stored.get(8 * pixel..8 * pixel + 8)?;
            let found = [0, 4].map(|at| f64::from(f32::from_le_bytes(pair[at..at + 4].try_into().expect("four bytes"))));
            let length = |way: [f64; 2]| (way[0] * way[0] + way[1] * way[1]).sqrt();
            let between = |a: [f64; 2], b: [f64; 2]| length([a[0] - b[0], a[1] - b[1]]);
            let allowed = MOST_PX + MOST_SHARE * length(expected) + between(expected, nearer);
            (between(found, expected) > allowed).then(|| {
                let [right, down] = found;
                let [to_right, to_down] = expected;
                format!(
                    "pixel {pixel} moves by {right:.3} and {down:.3} px; by depth and poses it is {to_right:.3} and {to_down:.3} px"
                )
            })
        })
    }
}

/// The frame beside one of a film.
fn beside(frames: &[PlacedFrame], frame: usize, to: FlowTo) -> Option<&PlacedFrame> {
    match to {
        FlowTo::Previous => frame.checked_sub(1).and_then(|before| frames.get(before)),
        FlowTo::Next => frames.get(frame + 1),
    }
}

/// Way of a point on the finished picture.
struct Way {
    from: (f64, f64),
    to: (f64, f64),
    /// Depth at its end, metres; infinite for the sky.
    ahead_m: f64,
}

fn flow_px(flight: &PlacedFlight, poses: (&Pose, &Pose), pixel: usize, depth_m: f64) -> Option<[f64; 2]> {
    let Way { from, to, .. } = way_of(flight, poses, pixel, depth_m)?;
    Some([to.0 - from.0, to.1 - from.1])
}

/// Way on the picture of the standing point that a pixel shows; none where it is not before the other camera, or out of the lens's reach.
fn way_of(flight: &PlacedFlight, (here, beside): (&Pose, &Pose), pixel: usize, depth_m: f64) -> Option<Way> {
    let camera = &flight.camera;
    let (row, column) = (pixel / camera.width as usize, pixel % camera.width as usize);
    // Through a lens, a pixel shows the nearest pixel centre of the ideal picture, told in steps of 1/256 pixel.
    let nearest = |at: f64| (((at - 0.5) * 256.0).round() / 256.0 + 0.5).floor() + 0.5;
    let seen = flight.lens.unbend(camera, (column as f64 + 0.5, row as f64 + 0.5))?;
    let (u, v) = (nearest(seen.0), nearest(seen.1));
    let ray = camera.ray_in_world(here, u, v);
    let seen = if depth_m.is_finite() {
        beside.body_from_world_point(here.position_in_world + depth_m * ray)
    } else {
        beside.world_from_body().transpose() * ray
    };
    if seen.x < 0.05 {
        return None;
    }
    let DVec3 { x, y, z } = seen;
    let (centre_u, centre_v, focal_px) = camera.centre_and_focal_px();
    let bend = |u: f64, v: f64| flight.lens.bend(camera, (u, v));
    let (from, to) = (bend(u, v), bend(centre_u + focal_px * y / x, centre_v - focal_px * z / x));
    Some(Way { from, to, ahead_m: if depth_m.is_finite() { x } else { f64::INFINITY } })
}
