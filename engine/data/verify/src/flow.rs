//! Optical flow of what stands and of bodies: against depth, and the poses of camera and bodies in the frame and in the one beside it.

use super::film::{Film, ShownPoint};
use cosfly_domain::Channel;
use cosfly_domain::channels::{ChannelSource, FlowTo};

/// Every so many pixels are compared.
const EVERY: usize = 61;
/// Largest difference between the stored flow and the one of depth and poses, pixels and a share of its length: poses are stored
/// in degrees, numbers in 32 bits.
const MOST_PX: f64 = 0.01;
const MOST_SHARE: f64 = 1e-4;
/// Depths are at most this far from the ones that flows are of: half the step of the grid, metres.
const DEPTH_STEP_M: f64 = 5e-4;
/// Most speed of a limb against its body, m/s, and how much nearer than the point it may come, metres.
const LIMB_MPS: f64 = 8.0;
const LIMB_M: f64 = 1.0;
const NEAREST_M: f64 = 0.5;

/// Carrier of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// Nothing: it stands, or is the sky.
    Ground,
    /// A body that moves as one piece.
    Rigid,
    /// Somebody whose parts move against each other.
    Limbs,
}

/// Depths of pixels of one frame.
#[derive(Default)]
pub struct ComparedPoints {
    frame: usize,
    points: Vec<(ShownPoint, Carrier)>,
}

impl ComparedPoints {
    /// The points of a frame; `carrier` tells for a pixel whose it is, and none where nobody knows.
    pub fn of(frame: usize, depths: &[u8], carrier: impl Fn(usize) -> Option<(u32, Carrier)>) -> Self {
        let depths = depths.as_chunks::<4>().0.iter().map(|four| f64::from(f32::from_le_bytes(*four)));
        let point = |(pixel, depth_m)| {
            let (carrier, kind) = carrier(pixel)?;
            Some((ShownPoint { pixel, depth_m, carrier }, kind))
        };
        Self { frame, points: depths.enumerate().step_by(EVERY).filter_map(point).collect() }
    }

    /// Pixels of what stands, their places in the frame beside and their depths there; none where there is no such frame.
    pub fn ends(&self, film: Film<'_>, (frame, to): (usize, FlowTo)) -> Vec<(usize, (f64, f64), f64)> {
        let Some(beside) = beside(film.frames.len(), frame, to).filter(|_| self.frame == frame) else { return vec![] };
        let end = |(point, _): &(ShownPoint, Carrier)| {
            let ways = film.ways(*point, (frame, beside));
            // Where two strips show it, each at its own place, either is right.
            let [(_, way)] = ways[..] else { return None };
            Some((point.pixel, way.to, way.ahead_m))
        };
        self.points.iter().filter(|(_, kind)| *kind == Carrier::Ground).filter_map(end).collect()
    }

    /// Fault of the flow or the mask of a frame, in words.
    pub fn finding(&self, film: Film<'_>, (frame, channel): (usize, &Channel), stored: &[u8]) -> Option<String> {
        let (ChannelSource::Flow(to) | ChannelSource::FlowValid(to)) = channel.source else { return None };
        let Some(beside) = beside(film.frames.len(), frame, to) else {
            let all_are_0 = stored.iter().all(|byte| *byte == 0);
            return (!all_are_0).then(|| "there is no frame beside it, and not all of it is 0".into());
        };
        if !matches!(channel.source, ChannelSource::Flow(_)) || self.frame != frame {
            return None;
        }
        self.points.iter().find_map(|(point, kind)| {
            let pair = stored.get(8 * point.pixel..8 * point.pixel + 8)?;
            let found = [0, 4].map(|at| f64::from(f32::from_le_bytes(pair[at..at + 4].try_into().expect("four bytes"))));
            let limb_px = |ahead_m: f64| match kind {
                Carrier::Limbs => {
                    let reach_m = LIMB_MPS * film.flight.dt_s;
                    reach_m * film.flight.camera.focal_px() / (ahead_m - LIMB_M).max(NEAREST_M)
                }
                _ => 0.0,
            };
            let mut expected = None;
            for (strip, way) in film.ways(*point, (frame, beside)) {
                let nearer = ShownPoint { depth_m: point.depth_m - DEPTH_STEP_M, ..*point };
                let nearer = film.way(nearer, (frame, beside), strip)?.flow_px();
                let flow = way.flow_px();
                let allowed = MOST_PX + MOST_SHARE * length(flow) + between(flow, nearer) + limb_px(way.ahead_m);
                if between(found, flow) <= allowed {
                    return None;
                }
                expected.get_or_insert(flow);
            }
            let ([right, down], [to_right, to_down]) = (found, expected?);
            let pixel = point.pixel;
            Some(format!(
                "pixel {pixel} moves by {right:.3} and {down:.3} px; by depth and poses it is {to_right:.3} and {to_down:.3} px"
            ))
        })
    }
}

fn length([right, down]: [f64; 2]) -> f64 {
    (right * right + down * down).sqrt()
}

fn between(a: [f64; 2], b: [f64; 2]) -> f64 {
    length([a[0] - b[0], a[1] - b[1]])
}

/// The frame beside one of a film.
fn beside(frames: usize, frame: usize, to: FlowTo) -> Option<usize> {
    match to {
        FlowTo::Previous => frame.checked_sub(1),
        FlowTo::Next => Some(frame + 1).filter(|next| *next < frames),
    }
}
