//! Boxes that move, layer by layer of a voxel search: those that may hide the target, and those that may come near a drone.

use core::ops::Range;
use cosfly_frames::DVec3;
use cosfly_surroundings::local::LocalObstacles;
use cosfly_surroundings::moving::Moving;
use cosfly_surroundings::visibility::BODY_POINTS;

/// Boxes that move, by layer and by frame.
#[derive(Default)]
pub struct MovingLayers {
    /// Per layer, those that may hide a part of the target.
    hiding: Vec<Vec<Moving>>,
    /// Per frame, those that may come near a voxel.
    near: Vec<Vec<Moving>>,
}

impl MovingLayers {
    /// Of a search with layers at `frames` whose drone stays `lowest_m` above the target's feet and within `farthest_m` of them
    /// (from above), and asks for distances up to `within_m`.
    pub fn new(
        obstacles: &LocalObstacles<'_>,
        frames: &[usize],
        (lowest_m, farthest_m): (f64, f64),
        within_m: f64,
    ) -> Self {
        if !obstacles.has_movers() {
            return Self::default();
        }
        let feet = |frame: usize| obstacles.body(frame)[0];
        let may_hide = |&frame: &usize| {
            let chosen = |it: &&Moving| it.may_hide(feet(frame), (lowest_m, farthest_m));
            obstacles.moving_at(frame).iter().filter(chosen).copied().collect()
        };
        let may_be_near = |frame: usize| {
            let chosen = |it: &&Moving| it.swept().max.z + within_m >= feet(frame).z + lowest_m;
            obstacles.moving_at(frame).iter().filter(chosen).copied().collect()
        };
        let end = frames.last().map_or(0, |last| last + 1);
        Self { hiding: frames.iter().map(may_hide).collect(), near: (0..end).map(may_be_near).collect() }
    }

    /// Adds what moves to the `hidden` points of a `body`, in a layer.
    pub fn hide(&self, layer: usize, camera: DVec3, body: &[DVec3; BODY_POINTS], hidden: &mut [bool]) {
        for moving in self.hiding.get(layer).into_iter().flatten() {
            for (point, hidden) in body.iter().zip(&mut *hidden) {
                *hidden |= moving.here.meets_segment(*point, camera);
            }
        }
    }

    /// Distance of a place from what moves at a frame, capped at `within_m`.
    pub fn distance_m(&self, frame: usize, place: DVec3, within_m: f64) -> f64 {
        let near = self.near.get(frame).into_iter().flatten();
        near.fold(within_m, |smallest, moving| smallest.min(moving.around().signed_distance(place).0))
    }

    /// Whether a straight way through some frames keeps `keep_m` from what moves meanwhile.
    pub fn is_free(&self, frames: Range<usize>, from: DVec3, to: DVec3, keep_m: f64) -> bool {
        let (first, count) = (frames.start, frames.len() as f64);
        let at = |frame: usize| from.lerp(to, (frame - first) as f64 / count);
        frames.into_iter().all(|frame| {
            let mut near = self.near.get(frame).into_iter().flatten();
            near.all(|moving| moving.approach(at(frame), at(frame + 1)).distance_m >= keep_m)
        })
    }
}
