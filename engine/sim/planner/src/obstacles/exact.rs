//! Surroundings answered by the unsimplified map.

use super::local::swept_box;
use super::{Surroundings, ground::GroundGrid, solid::Solid};
use crate::visibility::{body_points, visibility};
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_geometry::{OrientedBox, SpatialQuery};

/// All unsimplified boxes, and those that move.
#[derive(Clone, Copy)]
pub struct ExactMap<'a> {
    /// Boxes that stand still.
    pub query: &'a dyn SpatialQuery,
    /// Places of each moving box, frame by frame; see [`crate::PlanRequest::movers`].
    pub movers: &'a [Vec<OrientedBox>],
}

impl<'a> ExactMap<'a> {
    /// A map in which nothing moves.
    pub fn still(query: &'a dyn SpatialQuery) -> Self {
        Self { query, movers: &[] }
    }

    fn moving_at(&self, frame: usize) -> impl Iterator<Item = Solid> {
        self.movers.iter().filter_map(move |places| places.get(frame)).map(Solid::new)
    }

    /// The space that the moving boxes sweep from `frame` to the next.
    fn swept_at(&self, frame: usize) -> impl Iterator<Item = Solid> {
        self.movers.iter().filter_map(move |places| {
            let here = places.get(frame)?;
            Some(Solid::new(&swept_box(here, places.get(frame + 1).unwrap_or(here))))
        })
    }

    /// Share of the body points that a camera sees, 0..=1.
    pub fn visibility(&self, frame: usize, camera: DVec3, target: &TargetState, height_m: f64) -> f64 {
        if self.movers.is_empty() {
            return visibility(self.query, camera, target, height_m);
        }
        let points = body_points(target, height_m);
        let mut blocked = [false; crate::visibility::BODY_POINTS];
        self.query.blocked_batch(camera, &points, &mut blocked);
        for solid in self.moving_at(frame) {
            for (point, blocked) in points.iter().zip(&mut blocked) {
                *blocked |= solid.meets_segment(*point, camera);
            }
        }
        blocked.iter().filter(|&&hidden| !hidden).count() as f64 / points.len() as f64
    }

    /// Signed distance to the nearest obstacle and the direction away from it, when below `within_m`.
    pub fn nearest(&self, frame: usize, position: DVec3, within_m: f64) -> Option<(f64, DVec3)> {
        let still = self.query.nearest(position, within_m).map(|near| (near.distance_m, near.away_in_world));
        let moving = self.moving_at(frame).map(|solid| solid.signed_distance(position));
        let near = moving.filter(|near| near.0 < within_m).chain(still);
        near.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Smallest distance of the segment from `frame` to the next, capped at `within_m`.
    pub fn segment_clearance(&self, frame: usize, from: DVec3, to: DVec3, within_m: f64) -> f64 {
        let still = self.query.segment_clearance(from, to, within_m);
        self.swept_at(frame).map(|solid| solid.approach(from, to).distance_m).fold(still, f64::min)
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
