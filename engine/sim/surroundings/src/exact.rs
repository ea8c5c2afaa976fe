//! Surroundings answered by the unsimplified map.

use crate::moving::{Encounter, OtherDrones, hides};
use crate::visibility::{aim_point, body_points, visibility};
use crate::{Surroundings, ground::GroundGrid, solid::Solid};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_geometry::SpatialQuery;

/// All unsimplified boxes, and those that move.
#[derive(Clone, Copy)]
pub struct ExactMap<'a> {
    /// Boxes that stand still.
    pub query: &'a dyn SpatialQuery,
    /// Places of each moving box, frame by frame; see the requests of the planner.
    pub movers: &'a [Vec<OrientedBox>],
    /// Those of them that are drones. Distances from them are smaller by what is kept from them beyond `clearance_m`.
    pub drones: OtherDrones,
    /// Distance that is kept from all, metres.
    pub clearance_m: f64,
}

impl<'a> ExactMap<'a> {
    /// A map in which nothing moves.
    pub fn still(query: &'a dyn SpatialQuery) -> Self {
        Self::among(query, &[])
    }

    /// A map in which some boxes move.
    pub fn among(query: &'a dyn SpatialQuery, movers: &'a [Vec<OrientedBox>]) -> Self {
        Self { query, movers, drones: OtherDrones::default(), clearance_m: 0.0 }
    }

    fn beyond_m(&self, index: usize) -> f64 {
        self.drones.beyond_m(index, self.movers.len(), self.clearance_m)
    }

    /// The boxes that move, where they are at a frame.
    fn moving_at(&self, frame: usize) -> impl Iterator<Item = &'a OrientedBox> {
        self.movers.iter().filter_map(move |places| places.get(frame))
    }

    /// Share of the body points that a camera sees, 0..=1. A moving box around the target's own middle is its body, which hides
    /// nothing of it.
    pub fn visibility(&self, frame: usize, camera: DVec3, target: &TargetState, height_m: f64) -> f64 {
        if self.movers.is_empty() {
            return visibility(self.query, camera, target, height_m);
        }
        let points = body_points(target, height_m);
        let mut blocked = [false; crate::visibility::BODY_POINTS];
        self.query.blocked_batch(camera, &points, &mut blocked);
        let middle = aim_point(target, height_m);
        for shape in self.moving_at(frame) {
            let is_own = || Solid::new(shape).signed_distance(middle).0 <= 0.0;
            for (point, blocked) in points.iter().zip(&mut blocked) {
                *blocked |= hides(shape, *point, camera) && !is_own();
            }
        }
        blocked.iter().filter(|&&hidden| !hidden).count() as f64 / points.len() as f64
    }

    /// Signed distance to the nearest obstacle and the direction away from it, when below `within_m`.
    pub fn nearest(&self, frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)> {
        let still = self.query.nearest(position, within_m).map(|near| (near.distance_m, near.away_in_world));
        let mut best = still;
        for (index, shape) in self.moving_at(frame).enumerate() {
            let (limit_m, beyond_m) = (best.map_or(within_m, |near| near.0), self.beyond_m(index));
            if position.distance(shape.center_in_world) - shape.half_extents_m.length() < limit_m + beyond_m {
                let (distance_m, away) = Solid::new(shape).signed_distance(position);
                let near = (distance_m - beyond_m, away);
                best = if near.0 < limit_m { Some(near) } else { best };
            }
        }
        best
    }

    /// Smallest distance of a drone that flies from `from` at `frame` to `to` at the next, capped at `within_m`. From boxes that
    /// move it is a lower bound in continuous time, see [`Encounter::clearance_m`].
    pub fn segment_clearance(&self, frame: usize, from: DVec3, to: DVec3, within_m: f64) -> f64 {
        let still = self.query.segment_clearance(from, to, within_m);
        self.movers.iter().enumerate().fold(still, |smallest, (index, places)| {
            let Some(here) = places.get(frame) else { return smallest };
            let (next, beyond_m) = (places.get(frame + 1).unwrap_or(here), self.beyond_m(index));
            Encounter { here, next, from, to }.clearance_m(smallest + beyond_m) - beyond_m
        })
    }
}

/// The exact map around a track.
pub struct ExactObstacles<'a> {
    /// The target that is looked at.
    pub track: &'a TargetTrack,
    /// All unsimplified boxes.
    pub map: ExactMap<'a>,
    /// Ground heights.
    pub ground: &'a GroundGrid,
    /// Waypoints whose visibility is known already.
    pub known: &'a [DVec3],
    /// Visibility at the known waypoints, 0..=1.
    pub known_visibility: &'a [f64],
}

impl<'a> ExactObstacles<'a> {
    /// Surroundings in which nothing moves and nothing is known yet.
    pub fn still(track: &'a TargetTrack, query: &'a dyn SpatialQuery, ground: &'a GroundGrid) -> Self {
        Self { track, map: ExactMap::still(query), ground, known: &[], known_visibility: &[] }
    }
}

impl Surroundings for ExactObstacles<'_> {
    fn visibility(&self, frame: usize, position: DVec3) -> f64 {
        match (self.known.get(frame), self.known_visibility.get(frame)) {
            (Some(known), Some(seen)) if *known == position => *seen,
            _ => self.map.visibility(frame, position, &self.track.states[frame], self.track.height_m),
        }
    }

    fn nearest(&self, frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)> {
        self.map.nearest(frame, position, within_m)
    }

    fn ground_z_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.ground.z_m(x_m, y_m)
    }
}
