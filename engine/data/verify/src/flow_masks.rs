//! Masks of optical flow: against the depths that the frame beside has where the points go.

use super::film::Film;
use super::flow::ComparedPoints;
use super::rows::PlacedFlight;
use cosfly_domain::channels::FlowTo;

/// Pixels beyond the edge at which a point has certainly left the picture, and within it at which it certainly has not.
const OUTSIDE_PX: f64 = 0.6;
const INSIDE_PX: f64 = 0.01;
/// A point is hidden where all depths about its place are less than this share of its own, and metres less.
const HIDDEN: f64 = 0.9;
const HIDDEN_M: f64 = 0.5;
/// Share of a point's own depth: the point is not hidden where the pixel at its place is at least so far away.
const FREE: f64 = 0.999;
/// Points that may be wrong: a number, and a share, of those at edges.
const ALLOWED: f64 = 3.0;
const ALLOWED_SHARE: f64 = 0.005;

/// Where a point goes, and what the mask says of it.
struct End {
    pixel: usize,
    place_px: (f64, f64),
    /// Depth in the other frame, metres.
    ahead_m: f64,
    is_shown: bool,
}

/// Depths of the frames beside, and points whose frame is still to come.
#[derive(Default)]
pub struct FlowMasks {
    before: Vec<f32>,
    now: Vec<f32>,
    waiting: Vec<End>,
}

impl FlowMasks {
    /// Goes on to a frame with these depths; what is wrong with the mask that led there from the frame before.
    pub fn begin(&mut self, flight: &PlacedFlight, depths: &[u8]) -> Option<String> {
        let depths = depths.as_chunks::<4>().0.iter().map(|four| f32::from_le_bytes(*four)).collect();
        self.before = std::mem::replace(&mut self.now, depths);
        problem(&std::mem::take(&mut self.waiting), &self.now, flight)
    }

    /// Fault of the mask of a frame, in words; one to the next frame waits for it.
    pub fn finding(
        &mut self,
        points: &ComparedPoints,
        film: Film<'_>,
        (frame, to): (usize, FlowTo),
        stored: &[u8],
    ) -> Option<String> {
        let end = |(pixel, place_px, ahead_m)| {
            let is_shown = stored.get(pixel).is_some_and(|byte| *byte != 0);
            End { pixel, place_px, ahead_m, is_shown }
        };
        let ends: Vec<End> = points.ends(film, (frame, to)).into_iter().map(end).collect();
        match to {
            FlowTo::Previous => problem(&ends, &self.before, film.flight),
            FlowTo::Next => {
                self.waiting = ends;
                None
            }
        }
    }
}

/// Fault of points that go to a frame with these depths, in words.
fn problem(ends: &[End], depths: &[f32], flight: &PlacedFlight) -> Option<String> {
    let (width, height) = (flight.camera.width as usize, flight.camera.height as usize);
    if depths.len() != width * height {
        return None;
    }
    let is_wrong = |end: &&End| {
        let (u, v) = end.place_px;
        let (right, bottom) = (width as f64, height as f64);
        let beyond = |by: f64| u < -by || v < -by || u > right + by || v > bottom + by;
        if beyond(OUTSIDE_PX) {
            return end.is_shown;
        }
        if beyond(-INSIDE_PX) {
            return false;
        }
        let (near, far) = about(depths, width, (u as usize, v as usize));
        if end.is_shown {
            return far < HIDDEN * end.ahead_m - HIDDEN_M;
        }
        // Through a lens, the pixel at the place may show the one beside it.
        let nearest_m = if flight.lens.is_none() { depths[v as usize * width + u as usize].into() } else { near };
        nearest_m > FREE * end.ahead_m || nearest_m.is_infinite()
    };
    let wrong: Vec<&End> = ends.iter().filter(is_wrong).collect();
    let first = wrong.first().filter(|_| wrong.len() as f64 > ALLOWED + ALLOWED_SHARE * ends.len() as f64)?;
    let (count, all, said) = (wrong.len(), ends.len(), if first.is_shown { "seen" } else { "hidden" });
    let (pixel, (u, v)) = (first.pixel, first.place_px);
    Some(format!(
        "{count} of {all} points that were looked for in the frame beside are not as the mask says; the first, pixel {pixel}, \
         comes to ({u:.1}, {v:.1}) and is said to be {said}"
    ))
}

/// The least and the largest depth of a pixel and the eight around it, metres.
fn about(depths: &[f32], width: usize, (column, row): (usize, usize)) -> (f64, f64) {
    let height = depths.len() / width;
    let around = |at: usize, most: usize| at.saturating_sub(1)..=(at + 1).min(most - 1);
    let all = around(row, height).flat_map(|row| around(column, width).map(move |column| row * width + column));
    all.fold((f64::INFINITY, 0.0), |(near, far), at| (near.min(depths[at].into()), far.max(depths[at].into())))
}
