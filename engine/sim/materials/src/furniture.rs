//! Benches, market stalls, hedges, thickets and things that their measures tell, drawn of parts that lie within their boxes.

use crate::boats::boat;
use crate::containers::stack;
use crate::ground_kinds::GroundKinds;
use crate::parts::SceneBox;
use crate::plan::{Plan, shape_seed};
use crate::street_things::street_thing;
use crate::thing_form::ThingForm;
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, DVec3};

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
/// A bush that is so many times as deep as high is a thicket, and the least height that its shrubs are as wide as, metres.
const THICKET: f64 = 2.5;
const LOW_SHRUB_M: f64 = 0.8;
/// Most shrubs of a hedge or thicket, about.
const MOST_SHRUBS: f64 = 60.0;

/// Draws all boxes of benches, stalls, hedges and known measures as such; those of other sizes stay boxes.
pub fn furnish(boxes: &mut Vec<SceneBox>, ground: &GroundKinds) {
    let is_one = |b: &SceneBox| {
        matches!(b.kind, ObstacleKind::Bench | ObstacleKind::Stall | ObstacleKind::Bush | ObstacleKind::Static)
    };
    if !boxes.iter().any(is_one) {
        return;
    }
    let parts = |b: SceneBox| {
        let plan = Plan::of(&b);
        match b.kind {
            ObstacleKind::Bench if plan.is_within(BENCH_M) => plan.bench(),
            ObstacleKind::Stall if plan.is_within(STALL_M) => plan.stall(),
            ObstacleKind::Bush if !is_cut(&b) && plan.size_m.y >= THICKET * plan.size_m.z => {
                let side_m = SHRUB * plan.size_m.z.max(LOW_SHRUB_M);
                plan.shrubs(side_m.max((plan.size_m.x * plan.size_m.y / MOST_SHRUBS).sqrt()))
            }
            ObstacleKind::Bush if plan.size_m.x >= HEDGE * plan.size_m.y => {
                let side_m = SHRUB * plan.size_m.y.max(plan.size_m.z);
                plan.shrubs(side_m.max(plan.size_m.x / MOST_SHRUBS))
            }
            ObstacleKind::Static => {
                let is_afloat = || ground.is_water(b.center_in_world.truncate());
                let parts =
                    stack(&plan, shape_seed(&b)).or_else(|| boat(&b, &is_afloat)).or_else(|| street_thing(&b, ground));
                parts.unwrap_or_else(|| vec![b])
            }
            _ => vec![b],
        }
    };
    *boxes = std::mem::take(boxes).into_iter().flat_map(parts).collect();
}

/// Whether corners of a box were moved, as [`crate::round_crowns`] does.
fn is_cut(b: &SceneBox) -> bool {
    let half_m = b.half_extents_m.as_dvec3().length();
    b.corners_in_world.iter().any(|corner| (corner.distance(b.center_in_world) - half_m).abs() > 1e-3)
}

impl Plan<'_> {
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

    /// Shrubs in rows, about as long and as deep as `side_m`: leaves on a round crown as large as a hedge or a thicket would be
    /// drawn out to streaks.
    fn shrubs(&self, side_m: f64) -> Vec<SceneBox> {
        let DVec3 { x: length, y: depth, z: height } = self.size_m;
        let [columns, rows] = [length, depth].map(|m| (m / side_m).round().clamp(1.0, MOST_SHRUBS) as u32);
        let ends = |number: u32, of: u32, m: f64| [number, number + 1].map(|end| m * f64::from(end) / f64::from(of));
        let shrub = |column: u32, row: u32| {
            let ([left, right], [near, far]) = (ends(column, columns, length), ends(row, rows, depth));
            let mut shrub = self.part(ObstacleKind::Bush, [left, near, 0.0], [right, far, height]);
            shrub.whole = [shrub.center_in_world, shrub.half_bounds_m].map(|v| v.as_vec3a());
            shrub
        };
        (0..rows).flat_map(|row| (0..columns).map(move |column| shrub(column, row)).collect::<Vec<_>>()).collect()
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
        // The upper face of the awning is drawn in to a ridge along the length.
        let near = 0.5 * (depth - BOARD_M);
        let across = |low: f64, high: f64| [[0.0, low], [length, low], [0.0, high], [length, high]].map(DVec2::from);
        let awning = self.prism(ThingForm::Plain, [across(0.0, depth), across(near, depth - near)], [ridge, height]);
        parts.push(SceneBox { kind: ObstacleKind::Stall, ..awning });
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::{BOX_FACES, boxes_of};
    use cosfly_domain::{Obstacle, OrientedBox, SemanticLabel, SurfaceMesh, Town};

    /// A thing on the ground, or on water that lies around it.
    fn drawn(kind: ObstacleKind, size_m: [f64; 3], is_afloat: bool) -> (SceneBox, Vec<SceneBox>) {
        let half_extents_m = 0.5 * DVec3::from(size_m);
        let shape = OrientedBox { center_in_world: DVec3::new(3.0, -4.0, 1.0), half_extents_m, yaw_rad: 0.6 };
        let obstacles = vec![Obstacle { shape, kind, object_id: 7, synthetic: false }];
        let water = SurfaceMesh {
            label: SemanticLabel::Water,
            vertices_in_world: [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
            along_across_m: vec![DVec2::ZERO; 3],
            triangles: vec![[0, 1, 2]],
            synthetic: false,
        };
        let surfaces = if is_afloat { vec![water] } else { vec![] };
        let town = Town { obstacles, surfaces, ..Town::default() };
        let mut boxes = boxes_of(&town, 1);
        let whole = boxes[0].clone();
        furnish(&mut boxes, &GroundKinds::of(&town));
        (whole, boxes)
    }

    #[test]
    fn parts_lie_within_the_box_reach_its_ends_and_keep_its_name() {
        for (kind, size_m, is_afloat) in [
            (ObstacleKind::Bench, [1.8, 0.6, 0.85], false),
            (ObstacleKind::Bench, [0.5, 1.8, 0.8], false),
            (ObstacleKind::Stall, [3.2, 2.0, 2.4], false),
            (ObstacleKind::Stall, [2.2, 3.2, 2.5], false),
            (ObstacleKind::Bush, [12.0, 0.8, 1.5], false),
            (ObstacleKind::Bush, [12.0, 11.0, 2.0], false),
            (ObstacleKind::Bush, [3.0, 10.0, 0.6], false),
            (ObstacleKind::Static, [12.2, 2.44, 2.6], false),
            (ObstacleKind::Static, [2.44, 12.2, 7.8], false),
            (ObstacleKind::Static, [6.06, 2.44, 5.2], false),
            (ObstacleKind::Static, [9.1, 2.3, 1.7], true),
            (ObstacleKind::Static, [2.9, 8.2, 2.4], true),
            (ObstacleKind::Static, [6.0, 3.2, 1.2], true),
            (ObstacleKind::Static, [74.0, 13.0, 8.0], true),
            (ObstacleKind::Static, [13.0, 61.0, 8.0], true),
            (ObstacleKind::Static, [4.0, 1.4, 2.62], false),
            (ObstacleKind::Static, [2.0, 5.2, 2.4], false),
            (ObstacleKind::Static, [3.6, 0.5, 2.3], false),
            (ObstacleKind::Static, [2.4, 2.4, 2.6], false),
            (ObstacleKind::Static, [0.8, 3.0, 1.6], false),
            (ObstacleKind::Static, [2.8, 2.8, 2.6], false),
            (ObstacleKind::Static, [3.2, 3.2, 1.1], false),
            (ObstacleKind::Static, [1.0, 5.3, 2.0], false),
        ] {
            let (whole, parts) = drawn(kind, size_m, is_afloat);
            let is_stack = kind == ObstacleKind::Static && size_m[0].min(size_m[1]) == 2.44;
            assert!(parts.len() > 4 || is_stack, "{kind:?} {size_m:?}");
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
            // Containers stand back, and sides of hulls and slides lie within.
            let back_m = if kind == ObstacleKind::Static { 0.021 * half.max_element().max(5.0) } else { 1e-6 };
            assert!(
                (high - half).abs().max_element() < back_m && (low + half).abs().max_element() < back_m,
                "{size_m:?}"
            );
            assert!(parts.iter().all(|part| (part.instance, part.label) == (whole.instance, whole.label)));
            for part in &parts {
                assert!(part.half_extents_m.min_element() > 0.0, "{kind:?} {size_m:?}");
                for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                    let [from, normal] = [part.corners_in_world[around[0]], part.normal_in_world(face)];
                    assert!((normal.length() - 1.0).abs() < 1e-9 && normal.dot(from - part.center_in_world) > 0.0);
                    let off = around.map(|corner| (part.corners_in_world[corner] - from).dot(normal).abs());
                    assert!(off.into_iter().all(|off_m| off_m < 1e-5), "{kind:?} {size_m:?} {face}: {off:?}");
                }
            }
        }
    }

    #[test]
    fn containers_of_a_stack_are_boxes_of_their_own_that_differ() {
        for size_m in [[12.2, 2.44, 7.8], [6.06, 2.44, 7.8]] {
            let (_, parts) = drawn(ObstacleKind::Static, size_m, false);
            assert!((3..=6).contains(&parts.len()), "{}", parts.len());
            assert!(parts.iter().all(|part| part.thing == ThingForm::Container));
            let seeds: std::collections::BTreeSet<u32> = parts.iter().map(|part| part.seed).collect();
            assert_eq!(seeds.len(), parts.len());
        }
    }

    #[test]
    fn shelters_open_to_their_street() {
        for side in [-1.0, 1.0] {
            let shape = OrientedBox::from_corners(DVec3::new(-2.0, -0.7, 0.0), DVec3::new(2.0, 0.7, 2.6));
            let obstacles = vec![Obstacle { shape, kind: ObstacleKind::Static, object_id: 7, synthetic: false }];
            let corners = [[-9.0, 1.5 * side], [9.0, 1.5 * side], [0.0, 9.0 * side]];
            let road = SurfaceMesh {
                label: SemanticLabel::Roads,
                vertices_in_world: corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
                along_across_m: vec![DVec2::ZERO; 3],
                triangles: vec![[0, 1, 2]],
                synthetic: false,
            };
            let town = Town { obstacles, surfaces: vec![road], ..Town::default() };
            let mut boxes = boxes_of(&town, 1);
            furnish(&mut boxes, &GroundKinds::of(&town));
            let panes: Vec<f64> = boxes
                .iter()
                .filter(|part| part.thing == ThingForm::Glass && part.half_extents_m.y < 0.1)
                .map(|part| part.center_in_world.y * side)
                .collect();
            assert!(panes.len() == 3 && panes.iter().all(|away_m| *away_m < -0.3), "{side}: {panes:?}");
        }
    }

    #[test]
    fn leaves_of_hedges_and_thickets_are_on_shrubs_that_are_no_streaks() {
        for size_m in [[12.0, 0.8, 1.5], [12.0, 12.0, 2.5], [4.0, 9.0, 1.0], [12.0, 12.0, 0.5]] {
            let (_, shrubs) = drawn(ObstacleKind::Bush, size_m, false);
            assert!((4..80).contains(&shrubs.len()), "{size_m:?}: {}", shrubs.len());
            for shrub in shrubs {
                let side_m = 2.0 * f64::from(shrub.whole[1].truncate().max_element());
                // Turned by 0.6: bounds of a square are 1.4 times as wide.
                assert!(side_m <= 1.4 * 1.3 * size_m[2].max(1.2), "{size_m:?}: {side_m}");
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
            // No boat lies on land, and no container is as wide as that.
            (ObstacleKind::Static, [9.1, 2.3, 1.7]),
            (ObstacleKind::Static, [74.0, 13.0, 8.0]),
            (ObstacleKind::Static, [12.2, 3.1, 2.6]),
            (ObstacleKind::Static, [12.2, 2.44, 3.9]),
        ] {
            assert_eq!(drawn(kind, size_m, false).1.len(), 1, "{kind:?}");
        }
    }
}
