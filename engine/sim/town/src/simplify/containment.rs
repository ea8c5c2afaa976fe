//! Containment: a box inside another adds nothing.

use super::candidate::BoxCandidate;
use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;
use cosfly_geometry::{Bounds, TurnedBox};
use cosfly_geometry::{Bvh, Shape, Visitor};

/// A corner may stick out by so much through rounding, metres.
const ROUNDING_M: f64 = 1e-9;
/// Boxes that are asked per box at most; bounds the work in a heap of boxes.
const MOST_MEETINGS: usize = 4096;

/// Drops every box that lies inside another one; of equal boxes the first stays.
pub fn drop_contained(boxes: &mut Vec<BoxCandidate>) {
    let shapes: Vec<OrientedBox> = boxes.iter().map(|one| one.shape).collect();
    let is_inside = covered_by_another(&shapes, |_| true, ROUNDING_M);
    retain_by(boxes, |index| !is_inside[index]);
}

/// Flags of the boxes that lie inside one other box grown by `margin_m`; only boxes for which `may_cover` holds count as the
/// other one.
pub fn covered_by_another(shapes: &[OrientedBox], may_cover: impl Fn(usize) -> bool, margin_m: f64) -> Vec<bool> {
    let bounds: Vec<Bounds> = shapes.iter().map(bounds_of).collect();
    let tree = Bvh::build(&bounds);
    let turned: Vec<Option<TurnedBox>> = shapes.iter().map(TurnedBox::prepare).collect();
    let is_covering: Vec<bool> = (0..shapes.len()).map(may_cover).collect();
    (0..shapes.len())
        .map(|index| {
            let corners = shapes[index].corners_in_world();
            let mut search = AnyCover {
                turned: &turned,
                is_covering: &is_covering,
                bounds: &bounds,
                order: tree.order(),
                shapes,
                index,
                corners,
                margin_m,
                met: 0,
                found: false,
            };
            tree.traverse(&mut search);
            search.found
        })
        .collect()
}

fn bounds_of(shape: &OrientedBox) -> Bounds {
    let (min_in_world, max_in_world) = shape.bounds_in_world();
    Bounds { min_in_world, max_in_world }
}

/// Keeps the elements whose index passes.
pub fn retain_by(boxes: &mut Vec<BoxCandidate>, mut keep: impl FnMut(usize) -> bool) {
    let mut index = 0;
    boxes.retain(|_| {
        index += 1;
        keep(index - 1)
    });
}

struct AnyCover<'a> {
    turned: &'a [Option<TurnedBox>],
    is_covering: &'a [bool],
    bounds: &'a [Bounds],
    order: &'a [u32],
    shapes: &'a [OrientedBox],
    index: usize,
    corners: [DVec3; 8],
    margin_m: f64,
    met: usize,
    found: bool,
}

impl AnyCover<'_> {
    /// A box that covers it has bounds that cover its bounds.
    fn bounds_can_cover(&self, bounds: &Bounds) -> bool {
        bounds.grown(self.margin_m + 1e-6).contains(&self.bounds[self.index])
    }
}

impl Visitor for AnyCover<'_> {
    fn key(&mut self, bounds: &Bounds) -> Option<f64> {
        self.bounds_can_cover(bounds).then_some(0.0)
    }
    fn matters(&self, _: f64) -> bool {
        true
    }
    fn visit(&mut self, slot: usize) -> bool {
        let other = self.order[slot] as usize;
        if other == self.index || !self.is_covering[other] || !self.bounds_can_cover(&self.bounds[other]) {
            return false;
        }
        self.met += 1;
        if self.met > MOST_MEETINGS {
            return true;
        }
        let Some(cover) = &self.turned[other] else { return false };
        // Two boxes can only cover each other when they are equal within rounding: then the first one stays.
        let is_later = other < self.index || !mutually_cover(&self.shapes[other], &self.shapes[self.index]);
        self.found = is_later && self.corners.iter().all(|&corner| cover.signed_distance(corner).0 <= self.margin_m);
        self.found
    }
}

/// Whether two boxes are so alike that each could be said to contain the other.
fn mutually_cover(a: &OrientedBox, b: &OrientedBox) -> bool {
    let (volume_a, volume_b) = (a.half_extents_m.length(), b.half_extents_m.length());
    (volume_a - volume_b).abs() <= 1e-6 * (1.0 + volume_a)
}
