//! Benches, market stalls and hedges, drawn of parts that lie within their boxes.

use crate::parts::{BOX_FACES, SceneBox};
use cosfly_domain::ObstacleKind;
use cosfly_frames::DVec3;

/// Least and greatest length, depth and height of a box that is drawn as a bench, and as a stall, metres.
const BENCH_M: [[f64; 3]; 2] = [[0.9, 0.25, 0.35], [4.0, 1.0, 1.4]];
const STALL_M: [[f64; 3]; 2] = [[1.6, 1.2, 1.9], [8.0, 4.0, 4.0]];
/// Thickness of boards, posts and legs, metres.
const BOARD_M: f64 = 0.06;
/// Height of a table, and of the goods on it, metres.
const TABLE_M: f64 = 0.8;
const GOODS_M: f64 = 0.28;
/// Least side of a crate on a table, unless the table is narrower, and half the gap between two, metres.
const CRATE_M: f64 = 0.75;
const GAP_M: f64 = 0.04;
/// Height of the cloth that hangs from an awning, and of the awning, metres.
const CLOTH_M: f64 = 0.2;
const AWNING_M: f64 = 0.45;
/// A bush that is so many times as long as deep is a hedge, and the length of each of its shrubs, in the greater of depth and height.
const HEDGE: f64 = 3.0;
const SHRUB: f64 = 1.2;
/// Most shrubs of a hedge.
const MOST_SHRUBS: f64 = 60.0;

/// Draws all boxes of benches, stalls and hedges as such; those of other sizes stay boxes.
pub fn furnish(boxes: &mut Vec<SceneBox>) {
    if !boxes.iter().any(|b| matches!(b.kind, ObstacleKind::Bench | ObstacleKind::Stall | ObstacleKind::Bush)) {
        return;
    }
    let parts = |b: SceneBox| {
        let plan = Plan::of(&b);
        match b.kind {
            ObstacleKind::Bench if plan.is_within(BENCH_M) => plan.bench(),
            ObstacleKind::Stall if plan.is_within(STALL_M) => plan.stall(),
            ObstacleKind::Bush if plan.size_m.x >= HEDGE * plan.size_m.y => plan.hedge(),
            _ => vec![b],
        }
    };
    *boxes = std::mem::take(boxes).into_iter().flat_map(parts).collect();
}

fn swapped(at: DVec3) -> DVec3 {
    DVec3::new(at.y, at.x, at.z)
}

/// A box with its longer side first.
struct Plan<'a> {
    of: &'a SceneBox,
    /// Length, depth and height, metres.
    size_m: DVec3,
    is_across: bool,
}

impl<'a> Plan<'a> {
    fn of(of: &'a SceneBox) -> Self {
        let size_m = 2.0 * of.half_extents_m.as_dvec3();
        let is_across = size_m.y > size_m.x;
        Self { of, size_m: if is_across { swapped(size_m) } else { size_m }, is_across }
    }

    fn is_within(&self, [least, most]: [[f64; 3]; 2]) -> bool {
        self.size_m.cmpge(least.into()).all() && self.size_m.cmple(most.into()).all()
    }

    /// A seat and a back of boards on two legs.
    fn bench(&self) -> Vec<SceneBox> {
        let DVec3 { x: length, y: depth, z: height } = self.size_m;
        let (seat, back) = (0.55 * height, depth - BOARD_M);
        let leg = |at: f64| self.part(ObstacleKind::Pole, [at, 0.1 * depth, 0.0], [at + BOARD_M, back, seat - BOARD_M]);
        vec![
            leg(0.12 * length),
            leg(0.88 * length - BOARD_M),
            self.part(ObstacleKind::Bench, [0.0, 0.0, seat - BOARD_M], [length, back, seat]),
            self.part(ObstacleKind::Bench, [0.0, back, 0.66 * height], [length, depth, height]),
            self.part(ObstacleKind::Pole, [0.12 * length, back, 0.0], [0.12 * length + BOARD_M, depth, 0.66 * height]),
            self.part(ObstacleKind::Pole, [0.88 * length - BOARD_M, back, 0.0], [0.88 * length, depth, 0.66 * height]),
        ]
    }

    /// Shrubs in a row: leaves on a round crown as long as a hedge would be drawn out to streaks.
    fn hedge(&self) -> Vec<SceneBox> {
        let DVec3 { x: length, y: depth, z: height } = self.size_m;
        let count = (length / (SHRUB * depth.max(height))).round().clamp(1.0, MOST_SHRUBS);
        let shrub = |number: u32| {
            let [from, to] = [number, number + 1].map(|end| length * f64::from(end) / count);
            let mut shrub = self.part(ObstacleKind::Bush, [from, 0.0, 0.0], [to, depth, height]);
            shrub.whole = [shrub.center_in_world, shrub.half_bounds_m].map(|v| v.as_vec3a());
            shrub
        };
        (0..count as u32).map(shrub).collect()
    }

    /// An awning with a ridge on four posts, under it a table with crates.
    fn stall(&self) -> Vec<SceneBox> {
        let DVec3 { x: length, y: depth, z: height } = self.size_m;
        let (cloth, ridge) = (height - AWNING_M - CLOTH_M, height - AWNING_M);
        let mut parts = Vec::new();
        for x in [0.04, length - 0.04 - BOARD_M] {
            for y in [0.04, depth - 0.04 - BOARD_M] {
                parts.push(self.part(ObstacleKind::Pole, [x, y, 0.0], [x + BOARD_M, y + BOARD_M, cloth]));
            }
        }
        let (from, to) = ([0.12 * length, 0.15 * depth], [0.88 * length, 0.85 * depth]);
        parts.push(self.part(ObstacleKind::Bench, [from[0], from[1], 0.0], [to[0], to[1], TABLE_M]));
        let size = [0, 1].map(|axis| to[axis] - from[axis]);
        let crates = size.map(|side_m| (side_m / CRATE_M).floor().max(1.0));
        let each = [size[0] / crates[0], size[1] / crates[1]];
        for number in 0..(crates[0] * crates[1]) as usize {
            let place = [number % crates[0] as usize, number / crates[0] as usize];
            let low = [0, 1].map(|axis| from[axis] + each[axis] * place[axis] as f64 + GAP_M);
            let high = [low[0] + each[0] - 2.0 * GAP_M, low[1] + each[1] - 2.0 * GAP_M, TABLE_M + GOODS_M];
            parts.push(self.part(ObstacleKind::Stall, [low[0], low[1], TABLE_M], high));
        }
        parts.push(self.part(ObstacleKind::Stall, [0.0, 0.0, cloth], [length, depth, ridge]));
        let mut awning = self.part(ObstacleKind::Stall, [0.0, 0.0, ridge], [length, depth, height]);
        self.draw_in(&mut awning);
        parts.push(awning);
        parts
    }

    /// A part between two corners, metres from the lowest corner of the box along its length, depth and height.
    fn part(&self, kind: ObstacleKind, low: [f64; 3], high: [f64; 3]) -> SceneBox {
        let (low, high) = (DVec3::from(low), DVec3::from(high));
        let turned = |at: DVec3| if self.is_across { swapped(at) } else { at };
        let (middle, half) = (turned(0.5 * (low + high) - 0.5 * self.size_m), turned(0.5 * (high - low)));
        let [x, y] = self.of.axes_in_world;
        let in_world = |at: DVec3| self.of.center_in_world + at.x * x + at.y * y + at.z * DVec3::Z;
        let mut part = self.of.clone();
        for (number, corner) in part.corners_in_world.iter_mut().enumerate() {
            let side = |bit: usize| if number >> bit & 1 == 0 { -1.0 } else { 1.0 };
            *corner = in_world(middle + half * DVec3::new(side(0), side(1), side(2)));
        }
        part.center_in_world = in_world(middle);
        part.half_extents_m = half.as_vec3a();
        let bounds = |corner: &DVec3| (*corner - part.center_in_world).abs();
        part.half_bounds_m = part.corners_in_world.iter().map(bounds).fold(DVec3::ZERO, DVec3::max);
        part.kind = kind;
        part.whole = [part.center_in_world.as_vec3a(), part.half_extents_m];
        part
    }

    /// Draws the upper face of an awning in to a ridge along the length.
    fn draw_in(&self, awning: &mut SceneBox) {
        let across = usize::from(!self.is_across);
        let axis = awning.axes_in_world[across];
        let half_m = 0.5 * self.size_m.y;
        let in_m = half_m - 0.5 * BOARD_M;
        for number in 4..8 {
            let side = if number >> across & 1 == 0 { 1.0 } else { -1.0 };
            awning.corners_in_world[number] += side * in_m * axis;
        }
        let rise_m = 2.0 * awning.half_bounds_m.z;
        for (side, (_, sign, _)) in awning.sides_in_world.iter_mut().zip(BOX_FACES).skip(2 * across).take(2) {
            *side = (rise_m * sign * axis + in_m * DVec3::Z).normalize_or(DVec3::Z);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::boxes_of;
    use cosfly_domain::{Obstacle, OrientedBox, Town};

    fn drawn(kind: ObstacleKind, size_m: [f64; 3]) -> (SceneBox, Vec<SceneBox>) {
        let half_extents_m = 0.5 * DVec3::from(size_m);
        let shape = OrientedBox { center_in_world: DVec3::new(3.0, -4.0, 1.0), half_extents_m, yaw_rad: 0.6 };
        let obstacles = vec![Obstacle { shape, kind, object_id: 7, synthetic: false }];
        let mut boxes = boxes_of(&Town { obstacles, ..Town::default() }, 1);
        let whole = boxes[0].clone();
        furnish(&mut boxes);
        (whole, boxes)
    }

    #[test]
    fn parts_lie_within_the_box_reach_its_ends_and_keep_its_name() {
        for (kind, size_m) in [
            (ObstacleKind::Bench, [1.8, 0.6, 0.85]),
            (ObstacleKind::Bench, [0.5, 1.8, 0.8]),
            (ObstacleKind::Stall, [3.2, 2.0, 2.4]),
            (ObstacleKind::Stall, [2.2, 3.2, 2.5]),
            (ObstacleKind::Bush, [12.0, 0.8, 1.5]),
        ] {
            let (whole, parts) = drawn(kind, size_m);
            assert!(parts.len() > 4, "{kind:?}");
            let own = |at: DVec3| {
                let away = at - whole.center_in_world;
                let [x, y] = whole.axes_in_world.map(|axis| away.dot(axis));
                DVec3::new(x, y, away.z)
            };
            let half = whole.half_extents_m.as_dvec3();
            let corners = || parts.iter().flat_map(|part| part.corners_in_world).map(own);
            assert!(corners().all(|at| at.abs().cmple(half + 1e-6).all()), "{kind:?} {size_m:?}");
            let (low, high) =
                corners().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
            assert!((high - half).abs().max_element() < 1e-6 && (low + half).abs().max_element() < 1e-6, "{kind:?}");
            assert!(parts.iter().all(|part| (part.instance, part.label) == (whole.instance, whole.label)));
            for part in &parts {
                for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                    let [from, normal] = [part.corners_in_world[around[0]], part.normal_in_world(face)];
                    let off = around.map(|corner| (part.corners_in_world[corner] - from).dot(normal).abs());
                    assert!(off.into_iter().all(|off_m| off_m < 1e-5), "{kind:?} {face}: {off:?}");
                }
            }
        }
    }

    #[test]
    fn boxes_of_other_sizes_and_kinds_stay() {
        for (kind, size_m) in [
            (ObstacleKind::Bench, [12.0, 0.6, 0.8]),
            (ObstacleKind::Stall, [3.0, 2.0, 1.0]),
            (ObstacleKind::Static, [1.8, 0.6, 0.8]),
            (ObstacleKind::Bush, [2.0, 0.8, 1.5]),
        ] {
            assert_eq!(drawn(kind, size_m).1.len(), 1, "{kind:?}");
        }
    }
}
