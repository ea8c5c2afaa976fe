//! [`Planes`]: planes of a pitched roof, and which cells lie below which.

use super::terraces::{STEP_M, Terraces};
use crate::parts::SceneBox;
use cosfly_disjoint_sets::DisjointSets;
use cosfly_frames::{DVec2, DVec3};
use std::collections::VecDeque;

/// No plane.
pub const NONE: u16 = u16::MAX;
/// Cells around one from which its own plane is known.
const WINDOW: usize = 3;
/// Cells of a plane lie off it by less, metres.
const OFF_M: f64 = 0.18;
/// Rises of slopes, metres per metre.
const RISES: [f64; 2] = [0.12, 4.0];
/// Least area of a plane over the ground, square metres.
const LEAST_M2: f64 = 3.5;
/// Planes stand over a cell's top by less, metres, before they are lowered.
const OVER_M: f64 = 0.1;
/// Cells beside each other whose planes differ by less are of one roof, metres.
const JOINED_M: f64 = 0.5;

/// A plane over the grid: height at a place, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Rise along columns and rows, metres per metre.
    pub rise: DVec2,
    /// Height at the grid's corner, world, metres.
    pub base_m: f64,
}

impl Plane {
    /// Height at a place of the grid, metres.
    pub fn at(&self, place: DVec2) -> f64 {
        self.base_m + self.rise.dot(place)
    }
}

/// A plane, and how far the cells around lie off it, metres.
type OwnPlane = (Plane, f64);

/// Planes of a roof.
pub struct Planes {
    /// The planes.
    pub planes: Vec<Plane>,
    /// Number of each cell's plane, [`NONE`] for most flat ones.
    pub labels: Vec<u16>,
    /// Eaves of the roof that each plane is part of, world, metres.
    pub eaves_m: Vec<f64>,
    /// Share of the building over a plane.
    pub share: f64,
}

/// Sums for a plane through points by least squares.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    first: DVec3,
    /// Squares and products: xx, xy, yy, xz, yz.
    second: [f64; 5],
}

impl Sums {
    /// Adds a point as seen from `from`, near which all lie.
    fn add(&mut self, at: DVec2, height_m: f64) {
        self.count += 1.0;
        self.first += at.extend(height_m);
        let [xx, xy, yy, xz, yz] = self.second;
        self.second =
            [xx + at.x * at.x, xy + at.x * at.y, yy + at.y * at.y, xz + at.x * height_m, yz + at.y * height_m];
    }

    fn plane(&self) -> Option<Plane> {
        let mean = self.first / self.count.max(1.0);
        let [xx, xy, yy, xz, yz] = self.second;
        let (xx, xy, yy) =
            (xx - self.count * mean.x * mean.x, xy - self.count * mean.x * mean.y, yy - self.count * mean.y * mean.y);
        let (xz, yz) = (xz - self.count * mean.x * mean.z, yz - self.count * mean.y * mean.z);
        let det = xx * yy - xy * xy;
        if self.count < 6.0 || det < 1e-3 * (xx + yy) * (xx + yy) {
            return None;
        }
        let rise = DVec2::new(xz * yy - yz * xy, yz * xx - xz * xy) / det;
        Some(Plane { rise, base_m: mean.z - rise.dot(mean.truncate()) })
    }
}

impl Planes {
    /// The planes below terraces.
    pub fn below(terraces: &Terraces, boxes: &[SceneBox], members: &[usize]) -> Self {
        let heights_m = terraces.slopes_m();
        let own = own_planes(terraces, &heights_m);
        let mut labels = vec![NONE; heights_m.len()];
        let mut planes: Vec<Plane> = Vec::new();
        let mut seeds: Vec<usize> = (0..own.len()).filter(|cell| own[*cell].is_some()).collect();
        let off = |cell: &usize| own[*cell].map_or(f64::INFINITY, |(_, off_m)| off_m);
        seeds.sort_by(|a, b| off(a).total_cmp(&off(b)).then(a.cmp(b)));
        let mut tried = vec![false; own.len()];
        for seed in seeds {
            let Some((plane, _)) = own[seed].filter(|_| labels[seed] == NONE && !tried[seed]) else { continue };
            if planes.len() >= usize::from(NONE) {
                break;
            }
            let (mut plane, mut members) = grown(terraces, (&heights_m, &own), &labels, seed, plane);
            (plane, members) = grown(terraces, (&heights_m, &own), &labels, members[members.len() / 2], plane);
            members.iter().for_each(|cell| tried[*cell] = true);
            let rise = plane.rise.length();
            if members.len() as f64 * terraces.cell_m * terraces.cell_m < LEAST_M2
                || !(RISES[0]..=RISES[1]).contains(&rise)
            {
                continue;
            }
            members.iter().for_each(|cell| labels[*cell] = planes.len() as u16);
            planes.push(plane);
        }
        let mut found = Self { planes, labels, eaves_m: Vec::new(), share: 0.0 };
        found.spread(terraces);
        found.lower(terraces, boxes, members);
        found.eaves_m = found.eaves(terraces);
        let all = terraces.tops_m.iter().filter(|top_m| top_m.is_finite()).count();
        found.share = found.labels.iter().filter(|label| **label != NONE).count() as f64 / all.max(1) as f64;
        found
    }

    /// Height of the cell's plane below its middle, metres.
    fn height_m(&self, terraces: &Terraces, cell: usize) -> Option<f64> {
        let plane = self.planes.get(usize::from(self.labels[cell]))?;
        Some(plane.at(terraces.middle(cell)).min(terraces.tops_m[cell]))
    }

    /// For each plane the eaves of all planes that hang together with it.
    fn eaves(&self, terraces: &Terraces) -> Vec<f64> {
        let mut roofs = DisjointSets::new(self.planes.len());
        for cell in 0..self.labels.len() {
            let Some(own_m) = self.height_m(terraces, cell) else { continue };
            for near in terraces.around(cell, 1) {
                let is_beside =
                    self.height_m(terraces, near).is_some_and(|height_m| (height_m - own_m).abs() < JOINED_M);
                if is_beside && self.labels[near] != self.labels[cell] {
                    let [a, b] = [cell, near].map(|cell| usize::from(self.labels[cell]));
                    roofs.join(a, b);
                }
            }
        }
        let mut heights_m: Vec<Vec<f64>> = vec![Vec::new(); self.planes.len()];
        for cell in 0..self.labels.len() {
            if let Some(height_m) = self.height_m(terraces, cell) {
                heights_m[roofs.smallest(usize::from(self.labels[cell]))].push(height_m);
            }
        }
        heights_m.iter_mut().for_each(|heights_m| heights_m.sort_by(f64::total_cmp));
        let lowest = |plane: usize| {
            let heights_m = &heights_m[roofs.smallest(plane)];
            heights_m.get(heights_m.len() / 50).copied().unwrap_or(f64::INFINITY)
        };
        (0..self.planes.len()).map(lowest).collect()
    }

    /// Gives cells beside a plane to it where it lies at most a step below them.
    fn spread(&mut self, terraces: &Terraces) {
        let mut queue: VecDeque<usize> = (0..self.labels.len()).filter(|cell| self.labels[*cell] != NONE).collect();
        while let Some(cell) = queue.pop_front() {
            let label = self.labels[cell];
            let plane = self.planes[usize::from(label)];
            for next in terraces.around(cell, 1) {
                let under_m = terraces.tops_m[next] - plane.at(terraces.middle(next));
                if self.labels[next] == NONE && (-OVER_M..STEP_M).contains(&under_m) {
                    self.labels[next] = label;
                    queue.push_back(next);
                }
            }
        }
    }

    /// Lays each plane through the feet of the steps over it, which are known exactly, and moves it down until it touches them from
    /// below.
    fn lower(&mut self, terraces: &Terraces, boxes: &[SceneBox], members: &[usize]) {
        let mut feet: Vec<Vec<(DVec2, f64)>> = vec![Vec::new(); self.planes.len()];
        for (at, foot_m, cells) in members.iter().flat_map(|index| terraces.steps_of(&boxes[*index])) {
            let [inner, outer] = cells.map(|cell| self.labels[cell]);
            if inner == outer && inner != NONE {
                feet[usize::from(inner)].push((at, foot_m));
            }
        }
        for (plane, feet) in self.planes.iter_mut().zip(&feet) {
            let Some((from, _)) = feet.first() else { continue };
            let mut sums = Sums::default();
            feet.iter().for_each(|(at, foot_m)| sums.add(*at - *from, *foot_m));
            let exact = sums.plane().map(|new| Plane { base_m: new.base_m - new.rise.dot(*from), ..new });
            let is_alike = |new: &Plane| (new.rise - plane.rise).length() < 0.1 + 0.5 * plane.rise.length();
            *plane = exact.filter(is_alike).unwrap_or(*plane);
            let mut under_m: Vec<f64> = feet.iter().map(|(at, foot_m)| foot_m - plane.at(*at)).collect();
            under_m.sort_by(f64::total_cmp);
            plane.base_m += under_m[0];
        }
    }
}

/// The plane of each cell's surroundings, and how far they lie off it, metres.
fn own_planes(terraces: &Terraces, heights_m: &[f64]) -> Vec<Option<OwnPlane>> {
    let own = |cell: usize| {
        if heights_m[cell].is_nan() {
            return None;
        }
        let middle = terraces.middle(cell);
        let near = || terraces.around(cell, WINDOW).filter(|near| !heights_m[*near].is_nan());
        let mut sums = Sums::default();
        near().for_each(|near| sums.add(terraces.middle(near) - middle, heights_m[near]));
        let plane = sums.plane()?;
        let off = |near: usize| heights_m[near] - plane.at(terraces.middle(near) - middle);
        let off_m = (near().map(|near| off(near) * off(near)).sum::<f64>() / sums.count).sqrt();
        Some((Plane { base_m: plane.base_m - plane.rise.dot(middle), ..plane }, off_m))
    };
    (0..heights_m.len()).map(own).collect()
}

/// The cells that hang together with a seed and lie on its plane, and the plane through them.
fn grown(
    terraces: &Terraces,
    (heights_m, own): (&[f64], &[Option<OwnPlane>]),
    labels: &[u16],
    seed: usize,
    mut plane: Plane,
) -> (Plane, Vec<usize>) {
    let middle = terraces.middle(seed);
    let mut is_in = vec![false; heights_m.len()];
    let (mut members, mut next, mut sums) = (vec![seed], 0, Sums::default());
    is_in[seed] = true;
    let mut refit_at = 24.0;
    while next < members.len() {
        let cell = members[next];
        next += 1;
        sums.add(terraces.middle(cell) - middle, heights_m[cell]);
        if sums.count >= refit_at {
            refit_at *= 1.5;
            plane = sums.plane().map_or(plane, |new| Plane { base_m: new.base_m - new.rise.dot(middle), ..new });
        }
        for near in terraces.around(cell, 2) {
            if is_in[near] || labels[near] != NONE || heights_m[near].is_nan() {
                continue;
            }
            let is_alike =
                own[near].is_some_and(|(own, _)| (own.rise - plane.rise).length() < 0.15 + 0.4 * plane.rise.length());
            if is_alike && (heights_m[near] - plane.at(terraces.middle(near))).abs() < OFF_M {
                is_in[near] = true;
                members.push(near);
            }
        }
    }
    plane = sums.plane().map_or(plane, |new| Plane { base_m: new.base_m - new.rise.dot(middle), ..new });
    (plane, members)
}
