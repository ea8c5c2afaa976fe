//! The boxes that matter near a flight, kept ready per frame: lines of sight eight at a time, distances to few boxes.

use super::body_rays::{BodyLanes, RayBox, blocked, level, seen_share};
use super::focus::FocusedSurroundings;
use cosfly_frames::{DVec3, simd::Level};
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::local::LocalObstacles;
use cosfly_surroundings::solid::Solid;

/// Largest distance of a query from its frame's centre at which the frame's lists are complete, metres.
const FOCUS_M: f64 = 2.6;
/// Centres that have moved less keep their lists: room for the difference step and some iterations, metres.
const KEEP_M: f64 = 1.4;
/// Pieces of the line of sight, each with its own distance within which boxes may come between.
const PIECES: u32 = 4;

/// Planning boxes with short lists per frame around a current set of waypoints. Answers are those of
/// [`LocalObstacles`], but for lines that graze an edge within rounding.
pub struct NearBoxes<'a> {
    obstacles: &'a LocalObstacles<'a>,
    influence_m: f64,
    level: Level,
    bodies: Vec<BodyLanes>,
    frames: Vec<Near<'a>>,
}

/// Boxes that matter while a waypoint stays within [`FOCUS_M`] of `center`.
#[derive(Clone)]
struct Near<'a> {
    center: DVec3,
    between: Vec<RayBox>,
    around: Vec<&'a Solid>,
}

impl<'a> NearBoxes<'a> {
    /// For a track of so many frames, and for distances up to `influence_m` (the reach of the safety term). `None` where
    /// there is more to ask than one target among boxes that stand still: companions, moving boxes, ordered losses.
    pub fn new(obstacles: &'a LocalObstacles<'a>, frames: usize, influence_m: f64) -> Option<Self> {
        let alone = |frame| obstacles.companions(frame).next().is_none() && !obstacles.is_to_be_lost(frame);
        if obstacles.has_movers() || !(0..frames).all(alone) {
            return None;
        }
        let bodies = (0..frames).map(|frame| BodyLanes::new(obstacles.body(frame))).collect();
        Some(Self { obstacles, influence_m, level: level(), bodies, frames: Vec::new() })
    }

    /// The boxes, queried with the vector instructions of `level`.
    pub fn at_level(self, level: Level) -> Self {
        Self { level, ..self }
    }

    fn focus_frame(obstacles: &'a LocalObstacles<'a>, influence_m: f64, frame: usize, near: &mut Near<'a>) {
        let (center, body) = (near.center, obstacles.body(frame));
        near.between.clear();
        near.around.clear();
        let middle = 0.5 * (body[0] + body[5]);
        let body_m = body.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
        let (low, high) = (middle.min(center), middle.max(center));
        let reach_m = FOCUS_M.max(body_m);
        for solid in obstacles.still_at(frame) {
            if solid.bounds_gap_m(low, high) <= reach_m && may_come_between(solid, (middle, body_m), (center, FOCUS_M))
            {
                near.between.push(RayBox::new(solid));
            }
            if solid.bounds_gap_m(center, center) <= influence_m + FOCUS_M {
                near.around.push(solid);
            }
        }
    }

    fn in_focus(&self, frame: usize, position: DVec3) -> Option<&Near<'a>> {
        self.frames.get(frame).filter(|near| near.center.distance(position) <= FOCUS_M)
    }
}

/// Whether the box reaches into the tapering tube between two balls (middle and radius), piece by piece.
fn may_come_between(solid: &Solid, from: (DVec3, f64), to: (DVec3, f64)) -> bool {
    let share = |piece: u32| f64::from(piece) / f64::from(PIECES);
    let radius = |piece: u32| from.1 + share(piece) * (to.1 - from.1);
    (0..PIECES).any(|piece| {
        let (start, end) = (from.0.lerp(to.0, share(piece)), from.0.lerp(to.0, share(piece + 1)));
        solid.approach(start, end).distance_m <= radius(piece).max(radius(piece + 1))
    })
}

impl Surroundings for NearBoxes<'_> {
    fn visibility(&self, frame: usize, position: DVec3) -> f64 {
        if let Some(near) = self.in_focus(frame, position) {
            return seen_share(blocked(self.level, &near.between, &self.bodies[frame], position));
        }
        let body = self.obstacles.body(frame);
        let (low, high) = body.iter().fold((position, position), |(low, high), p| (low.min(*p), high.max(*p)));
        let mut mask = 0;
        for solid in self.obstacles.still_at(frame) {
            if solid.bounds_gap_m(low, high) <= 0.0 {
                mask |= blocked(self.level, &[RayBox::new(solid)], &self.bodies[frame], position);
                if mask == u8::MAX {
                    break;
                }
            }
        }
        seen_share(mask)
    }

    fn nearest(&self, frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)> {
        let Some(near) = self.in_focus(frame, position).filter(|_| within_m <= self.influence_m) else {
            return self.obstacles.nearest(frame, position, within_m);
        };
        let mut best: Option<(f64, DVec3)> = None;
        let mut limit = within_m;
        for solid in &near.around {
            if solid.bounds_gap_m(position, position) < limit.max(1e-12) || limit <= 0.0 {
                let found = solid.signed_distance(position);
                if found.0 < limit {
                    limit = found.0;
                    best = Some(found);
                }
            }
        }
        best
    }

    fn shadows(&self, frame: usize, position: DVec3, each: &mut dyn FnMut(f64, DVec3)) {
        self.obstacles.shadows(frame, position, each);
    }

    fn ground_z_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.obstacles.ground_z_m(x_m, y_m)
    }
}

impl FocusedSurroundings for NearBoxes<'_> {
    fn answers(&self) -> &(dyn Surroundings + Sync) {
        self
    }

    fn focus_on(&mut self, waypoints: &[DVec3]) {
        self.frames.resize(waypoints.len(), Near { center: DVec3::NAN, between: Vec::new(), around: Vec::new() });
        for (frame, (&center, near)) in waypoints.iter().zip(&mut self.frames).enumerate() {
            if near.center.distance(center) < KEEP_M {
                continue;
            }
            near.center = center;
            Self::focus_frame(self.obstacles, self.influence_m, frame, near);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::with_street;
    use super::*;
    use cosfly_random::Seed;

    #[test]
    fn answers_are_those_of_all_boxes_in_and_out_of_focus() {
        with_street(|problem, obstacles, _, path| {
            let mut near = NearBoxes::new(obstacles, path.len(), problem.view.safety_influence_m).unwrap();
            near.focus_on(path);
            let mut stream = Seed::of_item(1, "paper", "near").stream("t");
            let mut partly = 0;
            for round in 0..40 {
                let reach = if round % 2 == 0 { 1.4 } else { 15.0 };
                for (frame, center) in path.iter().enumerate() {
                    let mut shift = || stream.uniform(-reach, reach);
                    let place = *center + DVec3::new(shift(), shift(), shift());
                    let seen = near.visibility(frame, place);
                    assert_eq!(seen, obstacles.visibility(frame, place), "{frame} {place}");
                    for within_m in [1.5, 8.0, 12.0] {
                        assert_eq!(near.nearest(frame, place, within_m), obstacles.nearest(frame, place, within_m));
                    }
                    partly += usize::from(seen > 0.0 && seen < 1.0);
                }
            }
            assert!(partly > 30, "{partly}");
        });
    }
}
