//! Per-path obstacle filtering: the planning boxes near each stretch of the path (paper, section 3.3).

use crate::visibility::{BODY_POINTS, body_points};
use crate::{SeveralTargets, Surroundings, ground::GroundGrid, moving::Moving, moving::OtherDrones, solid::Solid};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetTrack};

/// Frames that share one list of boxes.
const FRAMES_PER_LIST: usize = 8;
/// Frames that share one coarse list, from which the fine ones are drawn.
const FRAMES_PER_COARSE_LIST: usize = 128;
/// Largest distance of a query from its frame's centre at which the frame's short lists are complete, metres.
const FOCUS_M: f64 = 2.6;

/// Body points whose shadows are told: ankle, middle, head, shoulders. The others lie between them.
pub const GUARDED_POINTS: [usize; 5] = [0, 2, 5, 6, 7];
/// Shadows further away than this are not told, metres.
const SHADOW_REACH_M: f64 = 2.0;

/// The boxes near a track, with short lists per frame around a current set of waypoints.
pub struct LocalObstacles<'a> {
    solids: Vec<Solid>,
    lists: Vec<Vec<u32>>,
    /// Body points of the target frame by frame, then those of its companions.
    bodies: Vec<Vec<[DVec3; BODY_POINTS]>>,
    seen_together: SeveralTargets,
    /// The boxes near the path that move, frame after frame.
    moving: Vec<Moving>,
    /// First place in `moving` of each frame, and the end; empty where nothing moves.
    moving_starts: Vec<u32>,
    radius_m: f64,
    /// Frames in which the target is to be lost; empty when in none.
    lost: Vec<bool>,
    ground: &'a GroundGrid,
    influence_m: f64,
    focus: Vec<Focus>,
}

/// The boxes that matter while a waypoint stays within [`FOCUS_M`] of `center`.
#[derive(Clone, Default)]
struct Focus {
    center: DVec3,
    /// May stand between waypoint and body.
    between: Vec<u32>,
    /// May be nearer than the safety influence radius.
    near: Vec<u32>,
    /// Places in the frame's moving boxes of those that may stand between waypoint and body.
    moving_between: Vec<u32>,
    /// Places in them of those that may be nearer than the safety influence radius.
    moving_near: Vec<u32>,
}

impl<'a> LocalObstacles<'a> {
    /// Keeps the boxes within `radius_m` (from above) of the track. Boxes that are not finite are left out.
    pub fn filter(
        track: &TargetTrack,
        boxes: &[OrientedBox],
        ground: &'a GroundGrid,
        radius_m: f64,
        influence_m: f64,
    ) -> Self {
        let (low, high) = bounds_from_above(&track.states);
        let all: Vec<Solid> =
            boxes.iter().filter(|shape| may_be_near(shape, low, high, radius_m)).map(Solid::new).collect();
        let everything: Vec<u32> = (0..all.len() as u32).collect();
        let mut new_index = vec![u32::MAX; all.len()];
        let (mut solids, mut lists) = (Vec::new(), Vec::new());
        for coarse_frames in track.states.chunks(FRAMES_PER_COARSE_LIST) {
            let coarse = near_from_above(&all, &everything, coarse_frames, radius_m);
            for frames in coarse_frames.chunks(FRAMES_PER_LIST) {
                let mut list = near_from_above(&all, &coarse, frames, radius_m);
                for index in &mut list {
                    let slot = &mut new_index[*index as usize];
                    if *slot == u32::MAX {
                        *slot = solids.len() as u32;
                        solids.push(all[*index as usize]);
                    }
                    *index = *slot;
                }
                lists.push(list);
            }
        }
        let bodies = vec![bodies_of(track)];
        Self {
            solids,
            lists,
            bodies,
            seen_together: SeveralTargets::Mean,
            moving: Vec::new(),
            moving_starts: Vec::new(),
            radius_m,
            lost: Vec::new(),
            ground,
            influence_m,
            focus: Vec::new(),
        }
    }

    /// Adds targets to be seen beside the one whose track it is.
    pub fn with_companions(mut self, companions: &[TargetTrack], together: SeveralTargets) -> Self {
        self.bodies.extend(companions.iter().map(bodies_of));
        self.seen_together = together;
        self
    }

    /// Adds boxes that move, each given by its places frame by frame. At each frame only those are kept that come within the
    /// filter's radius of the target (from above) until the next.
    pub fn with_movers(self, movers: &[Vec<OrientedBox>]) -> Self {
        self.with_drones(movers, OtherDrones::default(), 0.0)
    }

    /// Obstacles among which some are drones, where flights keep `clearance_m` (metres) from all others.
    pub fn with_drones(mut self, movers: &[Vec<OrientedBox>], drones: OtherDrones, clearance_m: f64) -> Self {
        if movers.is_empty() {
            return self;
        }
        self.moving_starts.push(0);
        for (frame, body) in self.bodies[0].iter().enumerate() {
            let middle = 0.5 * (body[0] + body[5]);
            for (index, places) in movers.iter().enumerate() {
                let Some(here) = places.get(frame) else { continue };
                let next = places.get(frame + 1).unwrap_or(here);
                let reach_m = self.radius_m
                    + here.center_in_world.distance(next.center_in_world)
                    + here.half_extents_m.max(next.half_extents_m).truncate().length();
                let away = (here.center_in_world - middle).truncate();
                if away.length_squared() <= reach_m * reach_m {
                    let beyond_m = drones.beyond_m(index, movers.len(), clearance_m);
                    self.moving.push(Moving::new(here, next, middle).kept_from(beyond_m));
                }
            }
            self.moving_starts.push(self.moving.len() as u32);
        }
        self
    }

    /// Orders the target to be lost in some frames; there, visibility counts the other way round.
    pub fn order_losses(&mut self, lost: Vec<bool>) {
        self.lost = lost;
    }

    /// Whether the target is to be lost at `frame`.
    pub fn is_to_be_lost(&self, frame: usize) -> bool {
        self.lost.get(frame).copied().unwrap_or(false)
    }

    /// Body points of the target's companions at `frame`.
    pub fn companions(&self, frame: usize) -> impl Iterator<Item = &[DVec3; BODY_POINTS]> {
        self.bodies[1..].iter().map(move |body| &body[frame])
    }

    /// Which visibility of several targets counts.
    pub fn seen_together(&self) -> SeveralTargets {
        self.seen_together
    }

    /// The highest ground around the path, metres.
    pub fn highest_ground_m(&self) -> f64 {
        self.ground.highest_m()
    }

    /// Number of boxes that the filter left.
    pub fn count(&self) -> usize {
        self.solids.len()
    }

    /// The boxes that stand still and matter at `frame`.
    pub fn still_at(&self, frame: usize) -> impl Iterator<Item = &Solid> {
        self.lists[frame / FRAMES_PER_LIST].iter().map(|&index| &self.solids[index as usize])
    }

    /// The boxes that move and matter at `frame`.
    pub fn moving_at(&self, frame: usize) -> &[Moving] {
        match self.moving_starts.get(frame..frame + 2) {
            Some(&[first, end]) => &self.moving[first as usize..end as usize],
            _ => &[],
        }
    }

    /// Whether a box stands between the point of a body and `position` at `frame`. A moving box around the body's `middle` is
    /// the body itself.
    pub fn is_hidden(&self, frame: usize, (middle, point): (DVec3, DVec3), position: DVec3) -> bool {
        let (low, high) = (point.min(position), point.max(position));
        let meets = |solid: &Solid| solid.bounds_gap_m(low, high) <= 0.0 && solid.meets_segment(point, position);
        self.still_at(frame).any(meets)
            || self.moving_at(frame).iter().any(|it| meets(&it.here) && it.here.signed_distance(middle).0 > 0.0)
    }

    /// Whether any box moves.
    pub fn has_movers(&self) -> bool {
        !self.moving_starts.is_empty()
    }

    /// Share of the target's body that is seen from `position`.
    fn seen_share(&self, frame: usize, focus: Option<&Focus>, position: DVec3) -> f64 {
        let body = &self.bodies[0][frame];
        let all = &self.lists[frame / FRAMES_PER_LIST];
        let (list, moving) = (focus.map_or(all, |focus| &focus.between), self.moving_at(frame));
        let hides = |it: &Moving, point: DVec3| !it.is_target && it.here.meets_segment(point, position);
        let hidden = |point: DVec3| {
            list.iter().any(|&index| self.solids[index as usize].meets_segment(point, position))
                || match focus {
                    Some(focus) => focus.moving_between.iter().any(|&k| hides(&moving[k as usize], point)),
                    None => moving.iter().any(|it| hides(it, point)),
                }
        };
        body.iter().filter(|&&point| !hidden(point)).count() as f64 / BODY_POINTS as f64
    }

    /// Share of a companion's body that is seen from `position`.
    fn companion_share(&self, frame: usize, body: &[DVec3; BODY_POINTS], position: DVec3) -> f64 {
        let middle = 0.5 * (body[0] + body[5]);
        let seen = |point: &&DVec3| !self.is_hidden(frame, (middle, **point), position);
        body.iter().filter(seen).count() as f64 / BODY_POINTS as f64
    }

    /// The body points at `frame`.
    pub fn body(&self, frame: usize) -> &[DVec3; BODY_POINTS] {
        &self.bodies[0][frame]
    }

    /// Makes the short lists right for queries near `waypoints`; call it before a round of many queries.
    pub fn focus_on(&mut self, waypoints: &[DVec3]) {
        let mut focus = core::mem::take(&mut self.focus);
        focus.resize(waypoints.len(), Focus { center: DVec3::NAN, ..Focus::default() });
        for (frame, (&center, slot)) in waypoints.iter().zip(&mut focus).enumerate() {
            // Room is kept for the difference step and for some iterations of movement.
            if slot.center.distance(center) < FOCUS_M - 1.2 {
                continue;
            }
            self.focus_frame(frame, center, slot);
        }
        self.focus = focus;
    }

    fn focus_frame(&self, frame: usize, center: DVec3, slot: &mut Focus) {
        slot.center = center;
        slot.between.clear();
        slot.near.clear();
        slot.moving_between.clear();
        slot.moving_near.clear();
        let body = self.bodies[0][frame];
        let middle = 0.5 * (body[0] + body[5]);
        let body_radius = body.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
        let (low, high) = (middle.min(center), middle.max(center));
        let reach = FOCUS_M.max(body_radius);
        for &index in &self.lists[frame / FRAMES_PER_LIST] {
            let solid = &self.solids[index as usize];
            if solid.bounds_gap_m(low, high) <= reach && solid.approach(middle, center).distance_m <= reach {
                slot.between.push(index);
            }
            if solid.bounds_gap_m(center, center) <= self.influence_m + FOCUS_M {
                slot.near.push(index);
            }
        }
        for (k, moving) in (0..).zip(self.moving_at(frame)) {
            let solid = &moving.here;
            let may_hide = !moving.is_target && solid.bounds_gap_m(low, high) <= reach;
            if may_hide && solid.approach(middle, center).distance_m <= reach {
                slot.moving_between.push(k);
            }
            if moving.gap_m(center, center + moving.step) <= self.influence_m + FOCUS_M {
                slot.moving_near.push(k);
            }
        }
    }

    fn in_focus(&self, frame: usize, position: DVec3) -> Option<&Focus> {
        self.focus.get(frame).filter(|focus| focus.center.distance(position) <= FOCUS_M)
    }

    /// Smallest distance of a drone that flies from `from` at `frame` to `to` at the next, capped at `within_m`: from boxes that
    /// move, at the same times.
    pub fn segment_clearance_m(&self, frame: usize, from: DVec3, to: DVec3, within_m: f64) -> f64 {
        let (low, high) = (from.min(to), from.max(to));
        let mut smallest = within_m;
        for solid in self.still_at(frame) {
            if solid.bounds_gap_m(low, high) < smallest {
                smallest = smallest.min(solid.approach(from, to).distance_m);
            }
        }
        for moving in self.moving_at(frame) {
            if moving.gap_m(from, to) < smallest {
                smallest = smallest.min(moving.approach(from, to).distance_m);
            }
        }
        smallest
    }
}

fn bodies_of(track: &TargetTrack) -> Vec<[DVec3; BODY_POINTS]> {
    track.states.iter().map(|state| body_points(state, track.height_m)).collect()
}

/// A quick look from above that keeps every box within `radius_m` of the rectangle, and none that is not finite.
fn may_be_near(shape: &OrientedBox, low: DVec3, high: DVec3, radius_m: f64) -> bool {
    let (center, half) = (shape.center_in_world, shape.half_extents_m);
    let reach = radius_m + half.x.abs() + half.y.abs();
    let finite = center.z.is_finite() && half.is_finite() && shape.yaw_rad.is_finite();
    finite
        && center.x >= low.x - reach
        && center.x <= high.x + reach
        && center.y >= low.y - reach
        && center.y <= high.y + reach
}

fn bounds_from_above(frames: &[cosfly_frames::TargetState]) -> (DVec3, DVec3) {
    let first = frames.first().map_or(DVec3::ZERO, |state| state.feet_in_world);
    frames.iter().fold((first, first), |(low, high), s| (low.min(s.feet_in_world), high.max(s.feet_in_world)))
}

/// The boxes of `candidates` within `radius_m` of the frames' bounding rectangle.
fn near_from_above(
    solids: &[Solid],
    candidates: &[u32],
    frames: &[cosfly_frames::TargetState],
    radius_m: f64,
) -> Vec<u32> {
    let (low, high) = bounds_from_above(frames);
    let near = |solid: &Solid| {
        let x = (solid.min.x - high.x).max(low.x - solid.max.x).max(0.0);
        let y = (solid.min.y - high.y).max(low.y - solid.max.y).max(0.0);
        x * x + y * y <= radius_m * radius_m
    };
    candidates.iter().copied().filter(|&index| near(&solids[index as usize])).collect()
}

impl Surroundings for LocalObstacles<'_> {
    fn visibility(&self, frame: usize, position: DVec3) -> f64 {
        let mut seen = self.seen_share(frame, self.in_focus(frame, position), position);
        if self.bodies.len() > 1 {
            let others = self.companions(frame).map(|body| self.companion_share(frame, body, position));
            seen = match self.seen_together {
                SeveralTargets::Mean => (seen + others.sum::<f64>()) / self.bodies.len() as f64,
                SeveralTargets::Minimum => others.fold(seen, f64::min),
            };
        }
        if self.is_to_be_lost(frame) { 1.0 - seen } else { seen }
    }

    fn nearest(&self, frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)> {
        let focus = self.in_focus(frame, position).filter(|_| within_m <= self.influence_m);
        let list = focus.map_or(&self.lists[frame / FRAMES_PER_LIST], |focus| &focus.near);
        let mut best: Option<(f64, DVec3)> = None;
        let mut limit = within_m;
        for &index in list {
            let solid = &self.solids[index as usize];
            if solid.bounds_gap_m(position, position) < limit.max(1e-12) || limit <= 0.0 {
                let found = solid.signed_distance(position);
                if found.0 < limit {
                    limit = found.0;
                    best = Some(found);
                }
            }
        }
        let mut look_at = |moving: &Moving| {
            if moving.gap_m(position, position + moving.step) < limit {
                let found = moving.around().signed_distance(position);
                if found.0 < limit {
                    limit = found.0;
                    best = Some(found);
                }
            }
        };
        let moving = self.moving_at(frame);
        match focus {
            Some(focus) => focus.moving_near.iter().for_each(|&k| look_at(&moving[k as usize])),
            None => moving.iter().for_each(look_at),
        }
        best
    }

    fn shadows(&self, frame: usize, position: DVec3, each: &mut dyn FnMut(f64, DVec3)) {
        if self.is_to_be_lost(frame) {
            return;
        }
        let all = &self.lists[frame / FRAMES_PER_LIST];
        let (focus, moving) = (self.in_focus(frame, position), self.moving_at(frame));
        for (target, body) in self.bodies.iter().enumerate() {
            let focus = focus.filter(|_| target == 0);
            let list = focus.map_or(all, |focus| &focus.between);
            let middle = 0.5 * (body[frame][0] + body[frame][5]);
            let is_other = |it: &&Moving| match target {
                0 => !it.is_target,
                _ => it.here.signed_distance(middle).0 > 0.0,
            };
            for point in GUARDED_POINTS.map(|k| body[frame][k]) {
                let mut deepest: Option<(f64, DVec3)> = None;
                let mut look_at = |solid: &Solid| {
                    let limit = deepest.map_or(SHADOW_REACH_M, |(slack, _)| slack);
                    if let Some((slack, plane)) = solid.lit_side_below(point, position, limit) {
                        deepest = Some((slack, plane.normal));
                    }
                };
                list.iter().for_each(|&index| look_at(&self.solids[index as usize]));
                match focus {
                    Some(focus) => focus.moving_between.iter().for_each(|&k| look_at(&moving[k as usize].here)),
                    None => moving.iter().filter(is_other).for_each(|it| look_at(&it.here)),
                }
                if let Some((slack, away)) = deepest {
                    each(slack, away);
                }
            }
        }
    }

    fn ground_z_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.ground.z_m(x_m, y_m)
    }
}
