//! Sixteen rotated boxes side by side, in their own axes.

use crate::lanes::{LANES, Lane, Lanes};
use crate::turned_box::TurnedBox;
use cosfly_frames::DVec3;

/// Middles, half sizes and turns of the boxes of a leaf, seen from above, about the local origin.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct TurnedLanes {
    pub(super) center: [Lane; 2],
    pub(super) half: [Lane; 2],
    pub(super) sin: Lane,
    pub(super) cos: Lane,
}

impl TurnedLanes {
    /// Boxes of no size; their lanes are not valid in the block.
    pub const EMPTY: Self =
        Self { center: [[0.0; LANES]; 2], half: [[0.0; LANES]; 2], sin: [0.0; LANES], cos: [1.0; LANES] };

    /// Puts a box into a lane.
    pub fn set(&mut self, lane: usize, shape: &TurnedBox, origin_in_world: DVec3) {
        let (center, half) = (shape.center_in_world() - origin_in_world, shape.half_extents_m());
        for axis in 0..2 {
            self.center[axis][lane] = center[axis] as f32;
            self.half[axis][lane] = half[axis] as f32;
        }
        let (sin, cos) = shape.sin_cos();
        (self.sin[lane], self.cos[lane]) = (sin as f32, cos as f32);
    }

    /// Puts a segment's start and step and the boxes' lower and upper faces into the boxes' axes, seen from above.
    #[inline(always)]
    pub fn in_own_axes(
        &self,
        lanes: impl Lanes,
        from: [f32; 3],
        to: [f32; 3],
        [start, step, low, high]: [&mut [Lane; 3]; 4],
    ) {
        let (step_x, step_y) = (to[0] - from[0], to[1] - from[1]);
        for i in 0..LANES {
            let (sin, cos) = (self.sin[i], self.cos[i]);
            let (x, y) = (from[0] - self.center[0][i], from[1] - self.center[1][i]);
            start[0][i] = lanes.multiply_add(cos, x, sin * y);
            start[1][i] = lanes.multiply_add(cos, y, -(sin * x));
            step[0][i] = lanes.multiply_add(cos, step_x, sin * step_y);
            step[1][i] = lanes.multiply_add(cos, step_y, -(sin * step_x));
            (low[0][i], low[1][i]) = (-self.half[0][i], -self.half[1][i]);
            (high[0][i], high[1][i]) = (self.half[0][i], self.half[1][i]);
        }
    }
}
