//! Merging: boxes of one orientation that together nearly fill a box become that box.

use super::candidate::BoxCandidate;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, real};
use cosfly_geometry::Bounds;
use cosfly_geometry::{Bvh, Visitor};

/// Boxes turned by less than this against each other count as parallel, radians.
const PARALLEL_RAD: f64 = 1e-7;
/// Faces closer than this count as one plane, metres.
const SAME_PLANE_M: f64 = 1e-6;
/// Neighbours that are tried per box and round.
const MOST_NEIGHBOURS: usize = 64;
/// Neighbours that are met per box and round, tried or already taken; bounds the work in a heap of boxes.
const MOST_MEETINGS: usize = 4096;
/// Rounds of pairing; each at most halves the number of boxes.
const MOST_ROUNDS: usize = 40;

/// A box in the frame of its group.
#[derive(Clone, Copy, Debug)]
struct Item {
    extent: Bounds,
    filled_m3: f64,
    growth_m: f64,
    first: usize,
    /// The candidate it came from while it is not joined with any other.
    alone: Option<BoxCandidate>,
    /// Whether it was made in the last round: two boxes that did not fit each other never will.
    is_new: bool,
}

/// Joins neighbours of one orientation. A joined box holds at most `max_empty_share` of empty volume and no point
/// farther than `tolerance_m` from an original.
pub fn merge_neighbours(boxes: Vec<BoxCandidate>, max_empty_share: f64, tolerance_m: f64) -> Vec<BoxCandidate> {
    let mut turned: Vec<(f64, BoxCandidate)> =
        boxes.into_iter().map(|one| (quarter_turn_rest(one.shape.yaw_rad), one)).collect();
    turned.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.first.cmp(&b.1.first)));
    let limits = Limits { max_empty_share, tolerance_m };
    let mut joined = Vec::new();
    let mut rest = turned.as_slice();
    while let Some(&(yaw_rad, _)) = rest.first() {
        let length = rest.iter().take_while(|(yaw, _)| *yaw - yaw_rad <= PARALLEL_RAD).count().max(1);
        let (group, later) = rest.split_at(length);
        rest = later;
        let frame = Frame::new(yaw_rad);
        let mut items: Vec<Item> = group.iter().map(|(_, one)| frame.item(one)).collect();
        items.sort_by_key(|item| item.first);
        for axis in [2, 0, 1] {
            items = join_runs(items, axis);
        }
        items = join_pairs(items, limits);
        joined.extend(items.into_iter().map(|item| frame.candidate(&item)));
    }
    joined
}

#[derive(Clone, Copy)]
struct Limits {
    max_empty_share: f64,
    tolerance_m: f64,
}

/// The angle without whole quarter turns, in -45 to 45 degrees.
fn quarter_turn_rest(yaw_rad: f64) -> f64 {
    yaw_rad - (yaw_rad / real::FRAC_PI_2).round() * real::FRAC_PI_2
}

/// A frame turned about the world's origin.
struct Frame {
    yaw_rad: f64,
    sin: f64,
    cos: f64,
}

impl Frame {
    fn new(yaw_rad: f64) -> Self {
        let (sin, cos) = real::sin_cos(yaw_rad);
        Self { yaw_rad, sin, cos }
    }

    fn item(&self, one: &BoxCandidate) -> Item {
        let extent = one.shape.corners_in_world().iter().fold(Bounds::EMPTY, |sum, corner| {
            let (x, y) = (self.cos * corner.x + self.sin * corner.y, self.cos * corner.y - self.sin * corner.x);
            sum.with_point(DVec3::new(x, y, corner.z))
        });
        Item {
            extent,
            filled_m3: one.filled_m3,
            growth_m: one.growth_m,
            first: one.first,
            alone: Some(*one),
            is_new: true,
        }
    }

    fn candidate(&self, item: &Item) -> BoxCandidate {
        item.alone.unwrap_or_else(|| {
            let center = item.extent.center_in_world();
            let half_extents_m = 0.5 * (item.extent.max_in_world - item.extent.min_in_world);
            let (x, y) = (self.cos * center.x - self.sin * center.y, self.sin * center.x + self.cos * center.y);
            let shape = OrientedBox {
                center_in_world: DVec3::new(x, y, center.z),
                // A hair larger, so that rounding loses nothing.
                half_extents_m: half_extents_m + DVec3::splat(1e-9),
                yaw_rad: self.yaw_rad,
            };
            BoxCandidate { shape, filled_m3: item.filled_m3, growth_m: item.growth_m, first: item.first }
        })
    }
}

fn volume_m3(extent: &Bounds) -> f64 {
    (extent.max_in_world - extent.min_in_world).max(DVec3::ZERO).element_product()
}

/// The box around two, with lower bounds on its filling and an upper bound on its growth.
///
/// Along any one axis the two and the gap between them span the union. A point of the union is then at most half the
/// gap away along that axis, and across it at most as far as the smaller of the two falls short of the union.
fn union(a: &Item, b: &Item) -> Item {
    let extent = a.extent.union(&b.extent);
    let overlap = Bounds {
        min_in_world: a.extent.min_in_world.max(b.extent.min_in_world),
        max_in_world: a.extent.max_in_world.min(b.extent.max_in_world),
    };
    let short_of = |one: &Bounds| (one.min_in_world - extent.min_in_world).max(extent.max_in_world - one.max_in_world);
    let short = short_of(&a.extent).max(short_of(&b.extent));
    let gap = (overlap.min_in_world - overlap.max_in_world).max(DVec3::ZERO);
    let reach_m = (0..3)
        .map(|axis| {
            let mut away = short;
            away[axis] = 0.5 * gap[axis];
            away.length()
        })
        .fold(f64::INFINITY, f64::min);
    Item {
        extent,
        filled_m3: (a.filled_m3 + b.filled_m3 - volume_m3(&overlap)).max(a.filled_m3).max(b.filled_m3),
        growth_m: reach_m + a.growth_m.max(b.growth_m),
        first: a.first.min(b.first),
        alone: None,
        is_new: true,
    }
}

/// Joins rows along one axis whose other sides are equal: what a finely cut town is made of.
fn join_runs(mut items: Vec<Item>, axis: usize) -> Vec<Item> {
    let plane = |x: f64| (x / SAME_PLANE_M).round();
    let sides = |item: &Item| {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (low, high) = (item.extent.min_in_world, item.extent.max_in_world);
        [low[u], high[u], low[v], high[v]].map(plane)
    };
    items.sort_by(|a, b| {
        let by_sides = sides(a).iter().zip(sides(b)).map(|(x, y)| x.total_cmp(&y)).find(|order| order.is_ne());
        let by_start = a.extent.min_in_world[axis].total_cmp(&b.extent.min_in_world[axis]);
        by_sides.unwrap_or(by_start).then(a.first.cmp(&b.first))
    });
    let mut joined: Vec<Item> = Vec::with_capacity(items.len());
    for item in items {
        match joined.last_mut() {
            Some(last)
                if sides(last) == sides(&item)
                    && item.extent.min_in_world[axis] <= last.extent.max_in_world[axis] + SAME_PLANE_M =>
            {
                let growth_m = last.growth_m.max(item.growth_m);
                *last = Item { growth_m, ..union(last, &item) };
            }
            _ => joined.push(item),
        }
    }
    joined
}

/// Joins pairs, best fit first for each box in turn, until nothing fits any more.
fn join_pairs(mut items: Vec<Item>, limits: Limits) -> Vec<Item> {
    for _ in 0..MOST_ROUNDS {
        items.sort_by_key(|item| item.first);
        let extents: Vec<Bounds> = items.iter().map(|item| item.extent).collect();
        let tree = Bvh::build(&extents);
        let mut is_taken = vec![false; items.len()];
        let mut joined = Vec::with_capacity(items.len());
        for at in 0..items.len() {
            if is_taken[at] {
                continue;
            }
            if !items[at].is_new {
                continue;
            }
            is_taken[at] = true;
            let mut search = BestPartner {
                items: &items,
                order: tree.order(),
                is_taken: &is_taken,
                asked: extents[at].grown(limits.tolerance_m + SAME_PLANE_M),
                own: &items[at],
                limits,
                tried: 0,
                met: 0,
                best: None,
            };
            tree.traverse(&mut search);
            let partner = search.best;
            joined.push(partner.map_or(Item { is_new: false, ..items[at] }, |(_, partner)| {
                is_taken[partner] = true;
                union(&items[at], &items[partner])
            }));
        }
        joined.extend(items.iter().zip(&is_taken).filter(|(_, is_taken)| !**is_taken).map(|(item, _)| *item));
        let has_joined_any = joined.len() < items.len();
        items = joined;
        if !has_joined_any {
            break;
        }
    }
    items
}

struct BestPartner<'a> {
    items: &'a [Item],
    order: &'a [u32],
    is_taken: &'a [bool],
    asked: Bounds,
    own: &'a Item,
    limits: Limits,
    tried: usize,
    met: usize,
    /// Share of empty volume, and the partner.
    best: Option<(f64, usize)>,
}

impl Visitor for BestPartner<'_> {
    fn key(&mut self, bounds: &Bounds) -> Option<f64> {
        bounds.meets(&self.asked).then_some(0.0)
    }
    fn matters(&self, _: f64) -> bool {
        true
    }
    fn visit(&mut self, slot: usize) -> bool {
        let other = self.order[slot] as usize;
        self.met += 1;
        if self.met > MOST_MEETINGS {
            return true;
        }
        if self.is_taken[other] || !self.items[other].extent.meets(&self.asked) {
            return false;
        }
        self.tried += 1;
        let whole = union(self.own, &self.items[other]);
        let volume = volume_m3(&whole.extent);
        let empty_share = if volume > 0.0 { (1.0 - whole.filled_m3 / volume).max(0.0) } else { 0.0 };
        let fits = empty_share <= self.limits.max_empty_share && whole.growth_m <= self.limits.tolerance_m;
        let is_better = self.best.is_none_or(|(least, index)| (empty_share, other) < (least, index));
        if fits && is_better {
            self.best = Some((empty_share, other));
        }
        self.tried >= MOST_NEIGHBOURS
    }
}
