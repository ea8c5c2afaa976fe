//! Bracketed distances of a segment from sixteen boxes: lower and upper bounds of the squared distances.

use super::tree::{Block, WideTree};
use crate::lanes::{LANES, Lane, Lanes, larger, smaller};
use glam::Vec3A;

/// Relative error by which squared distances are widened.
pub const SQUARE_SHARE: f32 = 8.0 / 16_777_216.0;

/// Number of projections between the segment and the box before the distance is bracketed.
const STEPS: usize = 2;

/// A segment, a point or a window, prepared for blocks.
pub struct Segment {
    from: [f32; 3],
    to: [f32; 3],
    /// Bounds of the segment, enlarged by the margin.
    low: [f32; 3],
    high: [f32; 3],
    margin: f32,
    is_point: bool,
}

/// Lower and upper bounds of squared distances, one per lane, square metres.
pub struct Bracket {
    /// Lower bounds.
    pub least: Lane,
    /// Upper bounds.
    pub most: Lane,
}

impl Segment {
    /// Segment between two points in local coordinates, which may be equal.
    #[inline(always)]
    pub fn new(from: Vec3A, to: Vec3A, margin: f32) -> Self {
        let margins = Vec3A::splat(margin);
        Self {
            from: from.to_array(),
            to: to.to_array(),
            low: (from.min(to) - margins).to_array(),
            high: (from.max(to) + margins).to_array(),
            margin,
            is_point: from == to,
        }
    }

    /// Window between two corners; only [`Segment::least_squares`] is valid for it.
    #[inline(always)]
    pub fn window(min: Vec3A, max: Vec3A, margin: f32) -> Self {
        Self::new(min, max, margin)
    }

    /// For each lane a lower bound of the squared distance between the bounds.
    #[inline(always)]
    pub fn least_squares(&self, lanes: impl Lanes, block: &Block) -> Lane {
        let mut squares = [0.0; LANES];
        for axis in 0..3 {
            let [min, max] = &block.faces[axis];
            for i in 0..LANES {
                let gap = larger(larger(min[i] - self.high[axis], self.low[axis] - max[i]), 0.0);
                squares[i] = lanes.multiply_add(gap, gap, squares[i]);
            }
        }
        for square in &mut squares {
            *square *= 1.0 - SQUARE_SHARE;
        }
        squares
    }

    /// Brackets the distances from the boxes of a leaf. `squares` is the result of [`Segment::least_squares`].
    #[inline(always)]
    pub fn bracket(&self, lanes: impl Lanes, tree: &WideTree, block: &Block, squares: &Lane) -> Bracket {
        let (mut low, mut high) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        let (mut from, mut step) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        for axis in 0..3 {
            for i in 0..LANES {
                low[axis][i] = block.faces[axis][0][i];
                high[axis][i] = block.faces[axis][1][i];
                from[axis][i] = self.from[axis];
                step[axis][i] = self.to[axis] - self.from[axis];
            }
        }
        if block.turned != 0 {
            let turned = &tree.turned[block.turned_lanes as usize];
            turned.in_own_axes(lanes, self.from, self.to, [&mut from, &mut step, &mut low, &mut high]);
        }
        let mut bracket = if self.is_point {
            self.of_point(lanes, &from, &low, &high)
        } else {
            self.of_segment(lanes, &from, &step, &low, &high)
        };
        #[expect(clippy::needless_range_loop, reason = "sixteen lanes of several arrays")]
        for i in 0..LANES {
            bracket.least[i] = larger(bracket.least[i] * (1.0 - SQUARE_SHARE), squares[i]);
            bracket.most[i] *= 1.0 + SQUARE_SHARE;
        }
        bracket
    }

    #[inline(always)]
    fn of_point(&self, lanes: impl Lanes, at: &[Lane; 3], low: &[Lane; 3], high: &[Lane; 3]) -> Bracket {
        let (mut least, mut most) = ([0.0; LANES], [0.0; LANES]);
        let margin = 2.0 * self.margin;
        for axis in 0..3 {
            for i in 0..LANES {
                let gap = larger(low[axis][i] - at[axis][i], at[axis][i] - high[axis][i]);
                let (less, more) = (larger(gap - margin, 0.0), larger(gap + margin, 0.0));
                least[i] = lanes.multiply_add(less, less, least[i]);
                most[i] = lanes.multiply_add(more, more, most[i]);
            }
        }
        Bracket { least, most }
    }

    /// The distance of any point of the segment is an upper bound. Any plane that touches the box gives a lower bound:
    /// the distance of the segment's nearer end from the plane. Both meet at the closest points, to which alternating
    /// projection converges.
    #[inline(always)]
    fn of_segment(
        &self,
        lanes: impl Lanes,
        from: &[Lane; 3],
        step: &[Lane; 3],
        low: &[Lane; 3],
        high: &[Lane; 3],
    ) -> Bracket {
        let length_squared: f32 =
            (0..3).map(|axis| (self.to[axis] - self.from[axis]) * (self.to[axis] - self.from[axis])).sum();
        let inverse = if length_squared > 0.0 { 1.0 / length_squared } else { 0.0 };
        let (mut least, mut most) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let mut t = 0.5;
            let (mut point, mut foot) = ([0.0; 3], [0.0; 3]);
            for turn in 0..=STEPS {
                let mut along = 0.0;
                for axis in 0..3 {
                    point[axis] = lanes.multiply_add(t, step[axis][i], from[axis][i]);
                    foot[axis] = smaller(larger(point[axis], low[axis][i]), high[axis][i]);
                    along = lanes.multiply_add(foot[axis] - from[axis][i], step[axis][i], along);
                }
                if turn < STEPS {
                    t = smaller(larger(along * inverse, 0.0), 1.0);
                }
            }
            let (mut square, mut start, mut rise) = (0.0, 0.0, 0.0);
            for axis in 0..3 {
                let away = point[axis] - foot[axis];
                square = lanes.multiply_add(away, away, square);
                start = lanes.multiply_add(away, from[axis][i] - foot[axis], start);
                rise = lanes.multiply_add(away, step[axis][i], rise);
            }
            let distance = larger(square.sqrt(), 1e-18);
            let below = (start + smaller(rise, 0.0)) / distance - 2.0 * self.margin;
            let (below, above) = (larger(below, 0.0), distance + 2.0 * self.margin);
            least[i] = below * below;
            most[i] = above * above;
        }
        Bracket { least, most }
    }
}
