//! Boxes that move: where each is at a frame, and how near a flight comes to it until the next, in continuous time.
//!
//! Between frames a box goes evenly from place to place and turns the shorter way. Seen from the box, the drone then flies a
//! straight segment past a box that only turns, so distances in space and time are those of a segment and a box.

use crate::solid::{Approach, HalfSpace, Solid};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, real};

/// [`clearance_m`] is at most this much below the true distance, and never above it, metres.
pub const TURN_ERROR_M: f64 = 0.01;
/// Halvings of the time between two frames after which the bound of [`TURN_ERROR_M`] is given up: only boxes whose corners
/// move by 300 m in a turn get there.
const MOST_HALVINGS: u32 = 15;

/// Half the size of a drone's own box, metres.
const DRONE_HALF_M: f64 = 0.3;

/// Boxes of a drone, frame by frame, from its places in the world frame.
pub fn drone_boxes(places: &[DVec3]) -> Vec<OrientedBox> {
    let half_extents_m = DVec3::splat(DRONE_HALF_M);
    places.iter().map(|&center_in_world| OrientedBox { center_in_world, half_extents_m, yaw_rad: 0.0 }).collect()
}

/// Other drones among the boxes that move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OtherDrones {
    /// So many of the boxes that move, the last ones, are drones ([`drone_boxes`]).
    pub count: usize,
    /// Smallest distance from drone to drone, middle to middle, metres.
    pub separation_m: f64,
}

impl OtherDrones {
    /// Distance from mover number `index` of `movers` that a flight keeps beyond the `clearance_m` of all, metres.
    pub fn beyond_m(&self, index: usize, movers: usize, clearance_m: f64) -> f64 {
        let is_drone = index + self.count >= movers;
        if is_drone { (self.separation_m - DRONE_HALF_M - clearance_m).max(0.0) } else { 0.0 }
    }
}

/// One moving box at a frame, and its way to the next.
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    /// The box at the frame: rays are cast against it.
    pub here: Solid,
    /// Way of its middle to the next frame, metres.
    pub step: DVec3,
    /// The target's own body, which hides nothing of it.
    pub is_target: bool,
    /// Growth of its half extents that covers how it turns and grows until the next frame, metres.
    growth_m: DVec3,
}

impl Moving {
    /// A box at two frames. `middle` is the middle of the target's body at the first of them.
    pub fn new(here: &OrientedBox, next: &OrientedBox, middle: DVec3) -> Self {
        let solid = Solid::new(here);
        let turn_rad = real::wrap_angle_rad(next.yaw_rad - here.yaw_rad).abs();
        let half = here.half_extents_m.max(next.half_extents_m);
        let growth_m = half + turned_growth(half, turn_rad) - here.half_extents_m;
        let step = next.center_in_world - here.center_in_world;
        Self { here: solid, step, is_target: solid.signed_distance(middle).0 <= 0.0, growth_m }
    }

    /// Box of which flights keep further away by `more_m`, metres.
    pub fn kept_from(mut self, more_m: f64) -> Self {
        self.growth_m += DVec3::splat(more_m);
        self
    }

    /// Whether it may hide something of a body at `feet` from a camera at least `lowest_m` above the feet and at most
    /// `farthest_m` from them, seen from above.
    pub fn may_hide(&self, feet: DVec3, (lowest_m, farthest_m): (f64, f64)) -> bool {
        let (middle, disc_m) = self.here.disc_from_above();
        let near_m = ((middle - feet).truncate().length() - disc_m).max(0.0);
        // The lowest line of sight there rises evenly from the feet to the camera.
        !self.is_target && self.here.max.z - feet.z >= near_m * lowest_m.max(0.0) / farthest_m && near_m <= farthest_m
    }

    /// A box that contains it, standing at its place, however far it turns until the next frame.
    pub fn around(&self) -> Solid {
        self.here.grown(self.growth_m)
    }

    /// A box around all that it passes until the next frame.
    pub fn swept(&self) -> Solid {
        self.around().stretched(self.step)
    }

    /// Lower bound of the distance from a drone that flies from `from` to `to` until the next frame, metres.
    pub fn gap_m(&self, from: DVec3, to: DVec3) -> f64 {
        let to = to - self.step;
        self.here.bounds_gap_m(from.min(to), from.max(to)) - (self.growth_m.x + self.growth_m.y + self.growth_m.z)
    }

    /// Closest approach of a drone that flies from `from` to `to` until the next frame. The plane separates where the box is at
    /// the frame; see [`Self::at_next`].
    pub fn approach(&self, from: DVec3, to: DVec3) -> Approach {
        self.around().approach(from, to - self.step)
    }

    /// A separating plane of [`Self::approach`], gone along with the box to the next frame. A drone that is beyond the one at
    /// the frame and beyond the other at the next is beyond both on all its straight way.
    pub fn at_next(&self, plane: HalfSpace) -> HalfSpace {
        HalfSpace { offset_m: plane.offset_m + plane.normal.dot(self.step), ..plane }
    }
}

/// Growth of half extents that covers a turn of at most a right angle to either side.
fn turned_growth(half: DVec3, turn_rad: f64) -> DVec3 {
    let sin = real::sin(turn_rad.min(real::FRAC_PI_2));
    DVec3::new(half.y * sin, half.x * sin, 0.0)
}

/// A drone that flies from `from` to `to` while a box goes from `here` to `next`.
pub struct Encounter<'a> {
    /// The box at the first time.
    pub here: &'a OrientedBox,
    /// The box at the second.
    pub next: &'a OrientedBox,
    /// The drone at the first time, world frame, metres.
    pub from: DVec3,
    /// The drone at the second.
    pub to: DVec3,
}

impl Encounter<'_> {
    /// Smallest distance over all times between the two, capped at `within_m`: never above the true one, at most
    /// [`TURN_ERROR_M`] below it.
    pub fn clearance_m(&self, within_m: f64) -> f64 {
        let (from, to) = (self.from - self.here.center_in_world, self.to - self.next.center_in_world);
        let reach_m = self.here.half_extents_m.max(self.next.half_extents_m).length();
        if origin_gap_m(from, to) - reach_m >= within_m {
            return within_m;
        }
        self.between(0.0, 1.0, MOST_HALVINGS, within_m)
    }

    /// Smallest distance for the times between two shares of the way, metres.
    fn between(&self, start: f64, end: f64, halvings: u32, within_m: f64) -> f64 {
        let turn_rad = real::wrap_angle_rad(self.next.yaw_rad - self.here.yaw_rad);
        let middle = 0.5 * (start + end);
        let half_at = |share: f64| self.here.half_extents_m.lerp(self.next.half_extents_m, share);
        let (low, high) = (half_at(start).min(half_at(end)), half_at(start).max(half_at(end)));
        let half_extents_m = high + turned_growth(high, 0.5 * (end - start) * turn_rad.abs());
        let yaw_rad = self.here.yaw_rad + middle * turn_rad;
        let around = Solid::new(&OrientedBox { center_in_world: DVec3::ZERO, half_extents_m, yaw_rad });
        let (from, to) = (self.from - self.here.center_in_world, self.to - self.next.center_in_world);
        let found = around.approach(from.lerp(to, start), from.lerp(to, end)).distance_m;
        if found >= within_m {
            return within_m;
        }
        if halvings == 0 || (half_extents_m - low).length() <= TURN_ERROR_M {
            return found;
        }
        let first = self.between(start, middle, halvings - 1, within_m);
        self.between(middle, end, halvings - 1, first)
    }
}

/// Distance of a segment from the origin.
fn origin_gap_m(from: DVec3, to: DVec3) -> f64 {
    let way = to - from;
    let share = (-from.dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
    (from + share * way).length()
}

/// Whether a box stands between two points.
pub fn hides(shape: &OrientedBox, from: DVec3, to: DVec3) -> bool {
    let center = shape.center_in_world;
    let is_near = origin_gap_m(from - center, to - center) <= shape.half_extents_m.length();
    is_near && Solid::new(shape).meets_segment(from, to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;

    /// The box at a share of the way, and its distance, written out here on purpose.
    fn distance_m(encounter: &Encounter<'_>, share: f64) -> f64 {
        let (here, next) = (encounter.here, encounter.next);
        let turn = (next.yaw_rad - here.yaw_rad + real::PI).rem_euclid(real::TAU) - real::PI;
        let (sin, cos) = real::sin_cos(here.yaw_rad + share * turn);
        let away = encounter.from.lerp(encounter.to, share) - here.center_in_world.lerp(next.center_in_world, share);
        let local = DVec3::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z);
        (local.abs() - here.half_extents_m.lerp(next.half_extents_m, share)).max(DVec3::ZERO).length()
    }

    #[test]
    fn the_clearance_is_that_of_finely_sampled_times_within_the_stated_bound() {
        let mut stream = Seed::of_item(1, "moving", "clearance").stream("t");
        let mut v = |low: f64, high: f64| stream.uniform(low, high);
        let mut near = 0;
        for _ in 0..400 {
            let mut shape = || OrientedBox {
                center_in_world: DVec3::new(v(-6.0, 6.0), v(-6.0, 6.0), v(-2.0, 2.0)),
                half_extents_m: DVec3::new(v(0.0, 4.0), v(0.0, 2.0), v(0.0, 2.0)),
                yaw_rad: v(-4.0, 4.0),
            };
            let (here, mut next) = (shape(), shape());
            next.half_extents_m = if next.yaw_rad > 0.0 { here.half_extents_m } else { next.half_extents_m };
            let from = DVec3::new(v(-9.0, 9.0), v(-9.0, 9.0), v(-4.0, 4.0));
            let to = DVec3::new(v(-9.0, 9.0), v(-9.0, 9.0), v(-4.0, 4.0));
            let encounter = Encounter { here: &here, next: &next, from, to };
            let sampled = (0..=4000).map(|i| distance_m(&encounter, f64::from(i) / 4000.0)).fold(20.0, f64::min);
            let found = encounter.clearance_m(20.0);
            assert!(found <= sampled + 1e-9, "{found} {sampled}");
            assert!(found.max(0.0) > sampled - TURN_ERROR_M - 0.02, "{found} {sampled}");
            assert_eq!(encounter.clearance_m(0.5), found.min(0.5));
            near += usize::from(sampled > 0.0 && sampled < 2.0);
            let moving = Moving::new(&here, &next, DVec3::splat(1e9));
            let approach = moving.approach(from, to);
            assert!(
                approach.distance_m <= sampled + 1e-9 && moving.gap_m(from, to) <= approach.distance_m.max(0.0) + 1e-9
            );
            if approach.distance_m > 1e-6 {
                let (first, last) = (approach.separation, moving.at_next(approach.separation));
                assert!(first.slack_m(from) > approach.distance_m - 1e-9);
                assert!(last.slack_m(to) > approach.distance_m - 1e-9);
            }
        }
        assert!(near > 100, "{near}");
    }
}
