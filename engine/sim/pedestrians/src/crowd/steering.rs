//! How a person means to walk on: a heading that leads towards the target without a collision ahead (Moussaid, Helbing and
//! Theraulaz 2011), a speed that leaves time to stop, and short-range repulsion (Helbing and Molnar 1995).

use crate::crowd::surroundings::Neighbour;
use cosfly_frames::{DVec2, real};

/// Distance within which collisions ahead matter, metres.
const HORIZON_M: f64 = 8.0;

/// Time to the first collision ahead that people leave by walking slower, seconds.
const HEADWAY_S: f64 = 0.3;

/// Distance that people leave to others when they pass, metres.
const PASSING_M: f64 = 0.05;

/// Weight of going on as now beside the squared distance that a direction leaves, square metres: without it people in a dense
/// crowd change their minds at every step, and their velocities cancel.
const STEADY_M2: f64 = 6.0;

/// Slower than this, the present velocity counts for less, m/s.
const GOING_MPS: f64 = 0.2;

/// Strength and range of the repulsion: m/s2, metres; share that acts from behind.
const PUSH_MPS2: f64 = 1.6;
const PUSH_M: f64 = 0.2;
const FROM_BEHIND: f64 = 0.25;

/// Turns from the straight way that are considered, degrees; of two equal ones the first is taken, which is to the right.
const TURNS_DEG: [f64; 13] = [0.0, 8.0, -8.0, 17.0, -17.0, 28.0, -28.0, 42.0, -42.0, 60.0, -60.0, 85.0, -85.0];

/// Direction and speed that a person wants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Intent {
    pub velocity_mps: DVec2,
}

/// The turns as cosine and sine.
#[derive(Debug)]
pub(crate) struct Steering {
    turns: [DVec2; TURNS_DEG.len()],
}

impl Default for Steering {
    fn default() -> Self {
        Self {
            turns: TURNS_DEG.map(|turn| {
                let (sin, cos) = real::sin_cos(turn.to_radians());
                DVec2::new(cos, sin)
            }),
        }
    }
}

impl Steering {
    /// Velocity towards `ahead` (a unit vector) at `pace_mps` that avoids the neighbours and is steady beside the present
    /// velocity; `has_ground` says whether a direction leads on over walkable ground.
    pub fn intent(
        &self,
        neighbours: &[Neighbour],
        ahead: DVec2,
        (pace_mps, present_mps): (f64, DVec2),
        has_ground: impl Fn(DVec2) -> bool,
    ) -> Intent {
        let going = present_mps / present_mps.length().max(GOING_MPS);
        let mut best = (f64::INFINITY, ahead, HORIZON_M);
        for turn in self.turns {
            let direction = DVec2::new(ahead.x * turn.x - ahead.y * turn.y, ahead.x * turn.y + ahead.y * turn.x);
            let mut free_m = free_way_m(neighbours, direction * pace_mps, pace_mps);
            if turn.y != 0.0 && !has_ground(direction) {
                free_m = free_m.min(0.3);
            }
            // Distance left to the horizon straight ahead after the free way (law of cosines).
            let left_m2 = HORIZON_M * HORIZON_M + free_m * free_m - 2.0 * HORIZON_M * free_m * turn.x;
            let left = left_m2 + STEADY_M2 * (1.0 - direction.dot(going));
            if left < best.0 - 1e-9 {
                best = (left, direction, free_m);
            }
            if turn.y == 0.0 && free_m >= HORIZON_M {
                break;
            }
        }
        Intent { velocity_mps: best.1 * pace_mps.min(best.2 / HEADWAY_S) }
    }

    /// Acceleration away from those who are very near, m/s2.
    pub fn push(&self, neighbours: &[Neighbour], heading: DVec2) -> DVec2 {
        let mut sum = DVec2::ZERO;
        for other in neighbours {
            let gap_m = other.gap_m();
            if gap_m > 1.5 {
                break;
            }
            let sight = 0.5 * (1.0 + heading.dot(other.normal()));
            let weight = FROM_BEHIND + (1.0 - FROM_BEHIND) * sight;
            let scale = if other.is_mate {
                0.5
            } else if other.is_person {
                1.0
            } else {
                2.0
            };
            sum -= other.normal() * (scale * weight * PUSH_MPS2 * real::exp(-gap_m.max(0.0) / PUSH_M));
        }
        sum
    }
}

/// Distance that a person walks at a velocity before touching somebody who goes on as now, metres; at most the horizon.
fn free_way_m(neighbours: &[Neighbour], velocity_mps: DVec2, pace_mps: f64) -> f64 {
    let mut free_s = HORIZON_M / pace_mps.max(0.05);
    for other in neighbours {
        let closing = velocity_mps - other.velocity_mps;
        let along = other.away.dot(closing);
        if along <= 0.0 {
            continue;
        }
        let touch_m = other.touch_m + if other.is_mate { 0.0 } else { PASSING_M };
        let beyond = other.distance_m * other.distance_m - touch_m * touch_m;
        if beyond <= 0.0 {
            // Already nearer than people like: only the direct way towards the other is closed.
            if along > 0.7 * other.distance_m * closing.length() {
                return other.gap_m().max(0.0);
            }
            continue;
        }
        let square = closing.length_squared();
        let under_root = along * along - square * beyond;
        if under_root > 0.0 {
            free_s = free_s.min(beyond / (along + under_root.sqrt()));
        }
    }
    free_s * pace_mps.max(0.05)
}
