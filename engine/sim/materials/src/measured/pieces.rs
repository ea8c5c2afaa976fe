//! Parts of boxes below the planes of a measured roof.

use super::planes::{NONE, Plane, Planes};
use super::terraces::Terraces;
use crate::parts::SceneBox;
use crate::roof_step::RoofPiece;
use crate::roof_steps::{ends_m, half_m};
use cosfly_frames::DVec2;

/// What is drawn of a box lies at most so far below its upper face, metres.
pub const DEEPEST_M: f64 = 1.6;
/// Parts of less area are left out, square metres.
const LEAST_M2: f64 = 1e-4;
/// Share of a box's cells that must lie below planes.
const LEAST_SHARE: f64 = 0.3;
/// Shares of cells without a plane up to which they follow the others, and from which on all are level.
const FLAT_SHARES: [f64; 2] = [0.25, 0.8];
/// Share of a part's cells below a plane that it takes after.
const LEAST_LABEL: f64 = 0.05;
/// Most halvings of a box.
const MOST_HALVINGS: usize = 5;
/// Around a part, places that tell which of two planes is the lower one, metres.
const BESIDE_M: f64 = 0.8;
/// What stands on an upper face is higher by more, metres.
const STANDS_M: f64 = 0.02;
/// A roof goes on where it is not lower by more, metres.
const GOES_ON_M: f64 = 0.3;

/// A rectangle along a box's axes, from its middle, metres.
#[derive(Clone, Copy)]
struct Part {
    low: DVec2,
    high: DVec2,
}

/// A convex outline on the grid, and its plane; none where it is level.
struct Outline {
    corners: Vec<DVec2>,
    plane: Option<Plane>,
}

/// Cuts boxes of one building.
pub struct Cutter<'a> {
    /// Its upper faces.
    pub terraces: &'a Terraces,
    /// What lies below them.
    pub planes: &'a Planes,
}

impl Cutter<'_> {
    /// What is drawn of the upper part of a box; `None` where that is the whole box. The second value are the planes of a box below one or two,
    /// sorted; where each goes on over all of its part of the box, whatever stands there, the third is true.
    pub fn pieces(&self, b: &SceneBox) -> Option<(Vec<RoofPiece>, Vec<u16>, bool)> {
        let cells = self.terraces.cells_of(b, 0.5 * self.terraces.cell_m);
        let labelled = cells.iter().filter(|cell| self.planes.labels[**cell] != NONE).count();
        if (labelled as f64) < LEAST_SHARE * cells.len() as f64 || labelled == 0 {
            return None;
        }
        let half = half_m(b);
        let (mut outlines, whole) = (Vec::new(), Part { low: -half, high: half });
        self.part(b, whole, MOST_HALVINGS, &mut outlines);
        let mut labels: Vec<u16> = self.labels(b, whole, 0.0).into_iter().map(|(label, _)| label).collect();
        labels.sort_unstable();
        let mut goes_on = labels.len() < 3 && !labels.contains(&NONE);
        let [foot_m, top_m] = ends_m(b);
        let floor_m = foot_m.max(top_m - DEEPEST_M);
        let mut pieces = Vec::new();
        for Outline { corners, plane } in outlines {
            let level = Plane { rise: DVec2::ZERO, base_m: top_m };
            let Some(plane) = plane else {
                self.add(&corners, &level, &level, &mut pieces);
                goes_on = false;
                continue;
            };
            let over = |limit_m: f64, sign: f64| move |at: DVec2| sign * (plane.at(at) - limit_m);
            let cut_off = clipped(&corners, over(top_m, 1.0));
            if self.is_within(&cut_off, &plane) {
                // The slope goes on within the boxes that stand on this one.
                self.add(&clipped(&corners, over(floor_m, 1.0)), &plane, &plane, &mut pieces);
                if floor_m > foot_m {
                    let floor = Plane { base_m: floor_m, ..level };
                    self.add(&clipped(&corners, over(floor_m, -1.0)), &floor, &plane, &mut pieces);
                }
                continue;
            }
            goes_on = false;
            if !self.is_hidden(&cut_off, top_m, &level) {
                self.add(&cut_off, &level, &plane, &mut pieces);
            }
            let below = clipped(&corners, over(top_m, -1.0));
            let sloped = clipped(&below, over(floor_m, 1.0));
            if !self.is_hidden(&sloped, top_m, &plane) {
                self.add(&sloped, &plane, &plane, &mut pieces);
            }
            if floor_m > foot_m {
                let floor = Plane { base_m: floor_m, ..level };
                self.add(&clipped(&below, over(floor_m, -1.0)), &floor, &plane, &mut pieces);
            }
        }
        Some((pieces, labels, goes_on))
    }

    /// Whether higher boxes stand over all of an outline on a surface.
    fn is_hidden(&self, outline: &[DVec2], top_m: f64, surface: &Plane) -> bool {
        let Terraces { tops_m, feet_m, .. } = self.terraces;
        self.holds_on(outline, |at, cell| {
            let most_m = surface.at(at) + STANDS_M;
            self.terraces.around(cell, 1).all(|near| tops_m[near] > top_m + STANDS_M && feet_m[near] < most_m)
        })
    }

    /// Whether a plane lies within the boxes all over an outline. It touches the feet of steps: half a cell beside them it may seem to stand out.
    fn is_within(&self, outline: &[DVec2], plane: &Plane) -> bool {
        let slack_m = 0.75 * self.terraces.cell_m * plane.rise.length();
        self.holds_on(outline, |at, cell| {
            let is_own = self.planes.planes.get(usize::from(self.planes.labels[cell])) == Some(plane);
            is_own && self.terraces.tops_m[cell] > plane.at(at) - slack_m
        })
    }

    /// Whether something holds at places all over an outline, in their cells.
    fn holds_on(&self, outline: &[DVec2], holds: impl Fn(DVec2, usize) -> bool) -> bool {
        let is_below = |at: DVec2| self.terraces.cell_at(at).is_some_and(|cell| holds(at, cell));
        let sides = (0..outline.len()).map(|k| [outline[k], outline[(k + 1) % outline.len()]]);
        let middle = outline.iter().copied().sum::<DVec2>() / outline.len().max(1) as f64;
        let mut rays = sides.flat_map(|[from, to]| {
            let count = (from.distance(to) / self.terraces.cell_m).ceil() as usize;
            (0..count).map(move |k| from.lerp(to, (k as f64 + 0.5) / count as f64))
        });
        rays.all(|end| {
            let count = (end.distance(middle) / self.terraces.cell_m).ceil() as usize;
            (0..=count).all(|k| is_below(end.lerp(middle, k as f64 / count.max(1) as f64)))
        })
    }

    /// Whether the roof goes on beyond a side of a piece at about its height.
    fn goes_on(&self, [from, to]: [DVec2; 2], height_m: f64) -> bool {
        let along = to - from;
        let out = DVec2::new(along.y, -along.x).normalize_or_zero() * (1.2 * self.terraces.cell_m);
        let beside = self.terraces.cell_at(0.5 * (from + to) + out);
        beside.is_some_and(|cell| self.terraces.tops_m[cell] > height_m - GOES_ON_M)
    }

    /// The lowest eaves of the planes that a box is cut to, metres.
    pub fn eaves_m(&self, b: &SceneBox) -> f64 {
        let cells = self.terraces.cells_of(b, 0.5 * self.terraces.cell_m);
        let labels = cells.iter().map(|cell| self.planes.labels[*cell]).filter(|label| *label != NONE);
        labels.map(|label| self.planes.eaves_m[usize::from(label)]).fold(f64::INFINITY, f64::min)
    }

    fn corners_of(&self, b: &SceneBox, part: Part) -> Vec<DVec2> {
        let [x, y] = b.axes_in_world.map(|axis| axis.truncate());
        let place = |u: f64, v: f64| self.terraces.local(b.center_in_world.truncate() + u * x + v * y);
        let Part { low, high } = part;
        vec![place(low.x, low.y), place(high.x, low.y), place(high.x, high.y), place(low.x, high.y)]
    }

    /// Counts of the planes below a part, the most frequent first, [`NONE`] among them.
    fn labels(&self, b: &SceneBox, part: Part, margin_m: f64) -> Vec<(u16, usize)> {
        let [x, y] = b.axes_in_world.map(|axis| axis.truncate());
        let middle = 0.5 * (part.low + part.high);
        let half = 0.5 * (part.high - part.low) + margin_m;
        let center = self.terraces.local(b.center_in_world.truncate() + middle.x * x + middle.y * y);
        let own = [x, y].map(|axis| self.terraces.turned(axis));
        let mut counts: Vec<(u16, usize)> = Vec::new();
        let mut count = |label: u16| match counts.iter_mut().find(|(other, _)| *other == label) {
            Some((_, count)) => *count += 1,
            None => counts.push((label, 1)),
        };
        let step = |axis: usize| (2.0 * half[axis] / self.terraces.cell_m).ceil().clamp(1.0, 400.0);
        let (across, along) = (step(0), step(1));
        for i in 0..across as usize {
            for j in 0..along as usize {
                let share = 2.0 * (DVec2::new(i as f64, j as f64) + 0.5) / DVec2::new(across, along) - 1.0;
                let at = center + share.x * half.x * own[0] + share.y * half.y * own[1];
                if let Some(cell) = self.terraces.cell_at(at).filter(|cell| self.terraces.tops_m[*cell].is_finite()) {
                    count(self.planes.labels[cell]);
                }
            }
        }
        counts.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
        counts
    }

    /// Adds the outlines of a part.
    fn part(&self, b: &SceneBox, part: Part, halvings: usize, outlines: &mut Vec<Outline>) {
        let counts = self.labels(b, part, 0.0);
        let all: usize = counts.iter().map(|(_, count)| count).sum();
        let flat = counts.iter().find(|(label, _)| *label == NONE).map_or(0, |(_, count)| *count) as f64;
        let flat_share = if all == 0 { 1.0 } else { flat / all as f64 };
        let least = (LEAST_LABEL * all as f64) as usize;
        let labels: Vec<u16> =
            counts.iter().filter(|(label, count)| *label != NONE && *count > least).map(|(label, _)| *label).collect();
        let corners = self.corners_of(b, part);
        let size = part.high - part.low;
        let may_halve = halvings > 0 && size.max_element() > 4.0 * self.terraces.cell_m;
        let [follow, level] = FLAT_SHARES;
        if labels.is_empty() || flat_share > level {
            outlines.push(Outline { corners, plane: None });
        } else if may_halve && (flat_share > follow || labels.len() > 2) {
            let axis = usize::from(size.y > size.x);
            let middle = 0.5 * (part.low + part.high)[axis];
            let (mut lower, mut upper) = (part, part);
            (lower.high[axis], upper.low[axis]) = (middle, middle);
            self.part(b, lower, halvings - 1, outlines);
            self.part(b, upper, halvings - 1, outlines);
        } else if flat_share > 0.5 {
            outlines.push(Outline { corners, plane: None });
        } else {
            let plane = |label: u16| self.planes.planes[usize::from(label)];
            let first = plane(labels[0]);
            match labels.get(1).map(|label| plane(*label)) {
                None => outlines.push(Outline { corners, plane: Some(first) }),
                Some(second) => {
                    let sign = self.sign(b, part, [labels[0], labels[1]]);
                    let apart = |sign: f64| move |at: DVec2| sign * (second.at(at) - first.at(at));
                    outlines.push(Outline { corners: clipped(&corners, apart(sign)), plane: Some(first) });
                    outlines.push(Outline { corners: clipped(&corners, apart(-sign)), plane: Some(second) });
                }
            }
        }
    }

    /// 1 where the lower of two planes is the roof, at ridges and hips; -1 where the upper one is, in valleys.
    fn sign(&self, b: &SceneBox, part: Part, [first, second]: [u16; 2]) -> f64 {
        let wide = Part { low: part.low - BESIDE_M, high: part.high + BESIDE_M };
        let low = self.corners_of(b, wide);
        let (from, to) = low.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), c| (l.min(*c), h.max(*c)));
        let [first_plane, second_plane] = [first, second].map(|label| self.planes.planes[usize::from(label)]);
        let cell_m = self.terraces.cell_m;
        let mut vote = 0.0;
        let mut at = from;
        while at.y <= to.y {
            at.x = from.x;
            while at.x <= to.x {
                if let Some(cell) = self.terraces.cell_at(at) {
                    let apart_m = second_plane.at(at) - first_plane.at(at);
                    let label = self.planes.labels[cell];
                    vote += if label == first {
                        apart_m
                    } else if label == second {
                        -apart_m
                    } else {
                        0.0
                    };
                }
                at.x += cell_m;
            }
            at.y += cell_m;
        }
        if vote >= 0.0 { 1.0 } else { -1.0 }
    }

    /// Adds an outline as pieces of four corners on `surface`; the tiles are those of `slope`.
    fn add(&self, outline: &[DVec2], surface: &Plane, slope: &Plane, pieces: &mut Vec<RoofPiece>) {
        let twice_m2: f64 =
            (0..outline.len()).map(|k| outline[k].perp_dot(outline[(k + 1) % outline.len()])).sum::<f64>();
        if outline.len() < 3 || twice_m2 < 2.0 * LEAST_M2 {
            return;
        }
        let rise = slope.rise.length();
        let run = (1.0 + rise * rise).sqrt();
        let falls = if rise > 1e-6 { self.terraces.in_world(-slope.rise / rise) } else { DVec2::ZERO };
        let corner = |at: DVec2| self.terraces.place(at).extend(surface.at(at));
        let mut next = 1;
        while next + 1 < outline.len() {
            let last = (next + 2).min(outline.len() - 1);
            let quad = [outline[0], outline[next], outline[next + 1], outline[last]];
            let corners_in_world = quad.map(corner);
            let goes_on = core::array::from_fn(|side| {
                let ends = [quad[side], quad[(side + 1) % 4]];
                // Sides between the pieces of one outline lie within it.
                let is_inner = side == 0 && next > 1 || side == 3 && last + 1 < outline.len();
                is_inner || self.goes_on(ends, surface.at(0.5 * (ends[0] + ends[1])))
            });
            let normal = self.terraces.in_world(-surface.rise).extend(1.0).normalize();
            pieces.push(RoofPiece {
                corners_in_world,
                goes_on,
                normal_in_world: normal,
                falls: [falls.x as f32, falls.y as f32],
                pitch: [(rise / run) as f32, (1.0 / run) as f32],
            });
            next += 2;
        }
    }
}

/// The part of a convex outline where a linear function is not negative.
fn clipped(outline: &[DVec2], side: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut out = Vec::with_capacity(outline.len() + 1);
    for (k, from) in outline.iter().enumerate() {
        let to = outline[(k + 1) % outline.len()];
        let (a, b) = (side(*from), side(to));
        if a >= 0.0 {
            out.push(*from);
        }
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            // From the same end whichever way round.
            let (low, high, at, end) = if a < b { (*from, to, a, b) } else { (to, *from, b, a) };
            out.push(low + (high - low) * (at / (at - end)));
        }
    }
    out
}
