//! Hard limits of a step: bodies stay apart whatever the others do, and feet stay on free ground.
//!
//! Two people of a crowd see the same snapshot. Each moves at most half of the gap towards the other, so the gap never closes:
//! along the line between them both together use up no more than the gap. Bodies that do not keep this rule (vehicles,
//! recorded people) are given the whole gap: the place where they will be at constant velocity is kept clear as well.

use crate::WalkableGrid;
use crate::crowd::surroundings::Neighbour;
use cosfly_frames::DVec2;

/// Gap that always remains, metres: far above rounding, far below sight.
const SKIN_M: f64 = 1e-6;

/// Distance that people keep from bodies that do not make way, metres.
const CLEAR_M: f64 = 0.15;

/// Sweeps of projecting a step on the limits.
const SWEEPS: usize = 4;

/// Turns of a step, as cosine and sine, that are tried where the ground ends ahead.
const TURNS: [(f64, f64); 8] = [
    (0.906, 0.423),
    (0.906, -0.423),
    (0.643, 0.766),
    (0.643, -0.766),
    (0.259, 0.966),
    (0.259, -0.966),
    (-0.259, 0.966),
    (-0.259, -0.966),
];

/// The part of a step along a direction is limited.
#[derive(Clone, Copy, Debug)]
struct Limit {
    normal: DVec2,
    at_most_m: f64,
}

/// Limits of the step of one person.
#[derive(Debug, Default)]
pub(crate) struct Limits {
    limits: Vec<Limit>,
}

impl Limits {
    /// The limits beside these neighbours for a step of `step_s` seconds that is at most `reach_m` long.
    pub fn beside(&mut self, neighbours: &[Neighbour], step_s: f64, reach_m: f64) {
        self.limits.clear();
        for other in neighbours {
            let half_m = 0.5 * (other.gap_m() - SKIN_M);
            if half_m < reach_m {
                self.limits.push(Limit { normal: other.normal(), at_most_m: half_m.max(0.0) });
            }
            if other.is_foreign {
                let next = other.away + other.velocity_mps * step_s;
                let distance_m = next.length();
                let room_m = distance_m - other.touch_m - CLEAR_M;
                if room_m < reach_m && distance_m > 0.0 {
                    self.limits.push(Limit { normal: next / distance_m, at_most_m: room_m.max(-reach_m) });
                }
            }
        }
    }

    /// The step nearest to the asked one that keeps all limits, or a shorter one.
    pub fn kept(&self, asked: DVec2) -> DVec2 {
        let mut step = asked;
        for _ in 0..SWEEPS {
            let mut is_kept = true;
            for limit in &self.limits {
                let excess_m = step.dot(limit.normal) - limit.at_most_m;
                if excess_m > 0.0 {
                    step -= excess_m * limit.normal;
                    is_kept = false;
                }
            }
            if is_kept {
                return step;
            }
        }
        // Whatever is left over is cut off the length; a limit below zero asks for a step away and cannot be met by that.
        let share = |limit: &Limit| {
            let along_m = step.dot(limit.normal);
            if along_m > limit.at_most_m && along_m > 0.0 { limit.at_most_m.max(0.0) / along_m } else { 1.0 }
        };
        step * self.limits.iter().map(share).fold(1.0, f64::min)
    }

    /// The asked step, bent or shortened so that it keeps all limits and the way from `frame_place` to its end is free.
    pub fn on_ground(&self, grid: &WalkableGrid, frame_place: DVec2, at: DVec2, asked: DVec2) -> DVec2 {
        let step = self.kept(asked);
        let is_free = |step: DVec2| grid.step_ends_on_ground(frame_place, at + step);
        if is_free(step) {
            return step;
        }
        for share in [1.0, 0.4] {
            for (cos, sin) in TURNS {
                let turned = DVec2::new(cos * step.x - sin * step.y, sin * step.x + cos * step.y);
                let kept = self.kept(share * cos.abs().max(0.3) * turned);
                if kept != DVec2::ZERO && is_free(kept) {
                    return kept;
                }
            }
        }
        DVec2::ZERO
    }
}
