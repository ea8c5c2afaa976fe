//! Boats and ships: boxes of their measures that lie on water.

use crate::containers::{HIGH_M, WIDE_M, place};
use crate::parts::SceneBox;
use crate::pattern::{draw, hash};
use crate::plan::{Plan, shape_seed};
use crate::thing_form::ThingForm;
use cosfly_domain::ObstacleKind;
use cosfly_frames::DVec2;

/// Least and greatest length, width and height of boats and of ships, metres.
const BOAT_M: [[f64; 3]; 2] = [[4.0, 1.4, 0.8], [16.0, 5.0, 4.0]];
const SHIP_M: [[f64; 3]; 2] = [[30.0, 7.0, 6.0], [200.0, 34.0, 40.0]];
/// Outline of decks from stern to bow: places in lengths and half widths in widths.
const BOAT: [[f64; 2]; 5] = [[0.0, 0.42], [0.25, 0.49], [0.60, 0.49], [0.84, 0.32], [1.0, 0.02]];
const SHIP: [[f64; 2]; 5] = [[0.0, 0.42], [0.07, 0.49], [0.82, 0.49], [0.93, 0.32], [1.0, 0.015]];
/// Where the open part of a boat ends and its foredeck begins, among [`BOAT`].
const FOREDECK: usize = 2;
/// Thickness of rims of boats, metres; their floor lies so far below them.
const RIM_M: f64 = 0.10;
const DEEP_M: f64 = 0.32;
/// Height of the deck of a ship, of the superstructure on it, and of hatches, shares of the ship's height.
const DECK: f64 = 0.52;
const HOUSE: f64 = 0.85;
/// Height of coamings below hatches, metres, and the bay of a row of containers with the way beside it.
const HATCH_M: f64 = 0.45;
const BAY_M: f64 = 13.1;

/// The parts of a box that has the measures of a boat or ship and lies on water.
pub(crate) fn boat(b: &SceneBox, is_afloat: &dyn Fn() -> bool) -> Option<Vec<SceneBox>> {
    // Shapes are the same under every seed of looks.
    let seed = shape_seed(b);
    let plan = Plan::of(b).turned(draw(seed, 720) < 0.5);
    if plan.is_within(BOAT_M) && plan.size_m.x >= 1.8 * plan.size_m.y && is_afloat() {
        Some(small(&plan, seed))
    } else if plan.is_within(SHIP_M) && plan.size_m.x >= 3.0 * plan.size_m.y && is_afloat() {
        Some(ship(&plan, seed))
    } else {
        None
    }
}

/// A hull between two heights below an outline of its deck: sides lean out by `lean_m`, and with them the stem of one that
/// comes to a point.
fn hull(plan: &Plan<'_>, form: ThingForm, outline: &[[f64; 2]], heights_m: [f64; 2], lean_m: f64) -> Vec<SceneBox> {
    let middle = 0.5 * plan.size_m.y;
    let at = |[x, half]: [f64; 2]| [x * plan.size_m.x, half * plan.size_m.y];
    let last = outline.len().saturating_sub(2);
    let section = |(number, pair): (usize, &[[f64; 2]])| {
        let ([x0, w0], [x1, w1]) = (at(pair[0]), at(pair[1]));
        let face = |[x0, w0]: [f64; 2], [x1, w1]: [f64; 2]| {
            [[x0, middle - w0], [x1, middle - w1], [x0, middle + w0], [x1, middle + w1]].map(DVec2::from)
        };
        // The sides of the foremost part meet farther aft at the waterline.
        let is_stem = number == last && w1 < lean_m;
        let stem = if is_stem { [x1 - lean_m * (x1 - x0) / (w0 - w1), w1] } else { [x1, w1 - lean_m] };
        let faces = [face([x0, w0 - lean_m], stem), face([x0, w0], [x1, w1])];
        plan.prism(form, faces, heights_m)
    };
    outline.windows(2).enumerate().map(section).collect()
}

/// The rim of a hull on both sides, from its floor up.
fn rims(plan: &Plan<'_>, form: ThingForm, outline: &[[f64; 2]], heights_m: [f64; 2], thick_m: f64) -> Vec<SceneBox> {
    let middle = 0.5 * plan.size_m.y;
    // Rims lean out by a little, as sides of one flat part do.
    let lean_m = 0.01 * plan.size_m.y;
    let strip = |pair: &[[f64; 2]]| {
        let [[x0, w0], [x1, w1]] = [pair[0], pair[1]].map(|[x, half]| [x * plan.size_m.x, half * plan.size_m.y]);
        [-1.0, 1.0].map(|side| {
            let face = |out_m: f64| {
                let at = |w: f64| middle + side * (w + out_m);
                let strip = [[x0, at(w0 - thick_m)], [x1, at(w1 - thick_m)], [x0, at(w0)], [x1, at(w1)]];
                let [a, b, c, d] = strip.map(DVec2::from);
                if side < 0.0 { [c, d, a, b] } else { [a, b, c, d] }
            };
            plan.prism(form, [face(0.0), face(lean_m)], heights_m)
        })
    };
    outline.windows(2).flat_map(strip).collect()
}

/// A box whose upper face is drawn in: by so much at the stern, at the bow and on both sides.
fn house(plan: &Plan<'_>, low: [f64; 3], high: [f64; 3], [aft_m, fore_m, aside_m]: [f64; 3]) -> SceneBox {
    let face = |[aft, fore, aside]: [f64; 3]| {
        let ([x0, x1], [y0, y1]) = ([low[0] + aft, high[0] - fore], [low[1] + aside, high[1] - aside]);
        [[x0, y0], [x1, y0], [x0, y1], [x1, y1]].map(DVec2::from)
    };
    plan.prism(ThingForm::Cabin, [face([0.0; 3]), face([aft_m, fore_m, aside_m])], [low[2], high[2]])
}

/// An open boat with boards and an engine, or one with a cabin and a mast.
fn small(plan: &Plan<'_>, seed: u32) -> Vec<SceneBox> {
    let [length, width, height] = plan.size_m.to_array();
    let middle = 0.5 * width;
    let rim_m = (0.35 * height + 0.25).clamp(0.5, 1.1);
    let floor_m = rim_m - DEEP_M;
    let mut parts = hull(plan, ThingForm::Hull, &BOAT[..=FOREDECK], [0.0, floor_m], 0.07 * width);
    parts.extend(hull(plan, ThingForm::Hull, &BOAT[FOREDECK..], [0.0, rim_m], 0.07 * width));
    parts.extend(rims(plan, ThingForm::Rim, &BOAT[..=FOREDECK], [floor_m, rim_m], RIM_M));
    let stern = BOAT[0][1] * width;
    parts.push(plan.shaped(ThingForm::Rim, [0.0, middle - stern, floor_m], [RIM_M, middle + stern, rim_m]));
    if height - rim_m < 0.75 || draw(seed, 721) < 0.2 {
        for x in [0.22, 0.42] {
            let board = [[x * length, RIM_M, rim_m - 0.12], [x * length + 0.3, width - RIM_M, rim_m - 0.07]];
            parts.push(plan.part(ObstacleKind::Bench, board[0], board[1]));
        }
        let top_m = (rim_m + 0.35).min(height);
        parts.push(plan.part(ObstacleKind::Pole, [0.0, middle - 0.2, rim_m - 0.25], [0.32, middle + 0.2, top_m]));
        let shield = [[0.57 * length, 0.2 * width, rim_m], [0.60 * length, 0.8 * width, (rim_m + 0.45).min(height)]];
        parts.push(plan.shaped(ThingForm::Glass, shield[0], shield[1]));
        return parts;
    }
    let top_m = rim_m + 0.86 * (height - rim_m);
    let [aft, fore] = if draw(seed, 722) < 0.5 { [0.30, 0.66] } else { [0.14, 0.60] };
    let low = [aft * length, 0.15 * width, floor_m];
    let high = [fore * length, 0.85 * width, top_m - 0.08];
    parts.push(house(plan, low, high, [0.04 * length, 0.1 * length, 0.05 * width]));
    let roof =
        [[low[0], low[1] + 0.03 * width, top_m - 0.08], [high[0] - 0.08 * length, high[1] - 0.03 * width, top_m]];
    parts.push(plan.shaped(ThingForm::Rim, roof[0], roof[1]));
    let mast = 0.45 * (low[0] + high[0]);
    parts.push(plan.part(ObstacleKind::Pole, [mast, middle - 0.03, top_m], [mast + 0.06, middle + 0.03, height]));
    parts
}

/// A ship with its house at the stern, hatches or containers in bays, and cranes between them.
fn ship(plan: &Plan<'_>, seed: u32) -> Vec<SceneBox> {
    let [length, width, height] = plan.size_m.to_array();
    let middle = 0.5 * width;
    let (deck_m, house_m) = (DECK * height, HOUSE * height);
    let mut parts = hull(plan, ThingForm::Ship, &SHIP, [0.0, deck_m], 0.06 * width);
    let fore = [[0.875, 0.40], SHIP[3], SHIP[4]];
    parts.extend(hull(plan, ThingForm::Ship, &fore, [deck_m, deck_m + 0.12 * height], 0.01 * width));
    parts.extend(rims(plan, ThingForm::Ship, &SHIP[1..3], [deck_m, deck_m + 0.9], 0.12));
    parts.push(house(
        plan,
        [0.03 * length, 0.08 * width, deck_m],
        [0.15 * length, 0.92 * width, house_m],
        [0.0, 0.6, 0.0],
    ));
    let bridge = [[0.06 * length, 0.01 * width, house_m], [0.13 * length, 0.99 * width, height - 0.35]];
    parts.push(house(plan, bridge[0], bridge[1], [0.2, 0.5, 0.1]));
    let roof = [[0.055 * length, 0.01 * width, height - 0.35], [0.13 * length, 0.99 * width, height - 0.22]];
    parts.push(plan.shaped(ThingForm::White, roof[0], roof[1]));
    parts.push(plan.shaped(
        ThingForm::Paint,
        [0.033 * length, middle - 1.1, house_m],
        [0.055 * length, middle + 1.1, height],
    ));
    parts.push(plan.part(
        ObstacleKind::Pole,
        [0.1 * length, middle - 0.1, height - 0.22],
        [0.1 * length + 0.2, middle + 0.1, height],
    ));
    let (from_m, to_m) = (0.17 * length, 0.86 * length);
    let bays = ((to_m - from_m) / BAY_M).floor().max(1.0);
    let each_m = (to_m - from_m) / bays;
    for bay in 0..bays as u32 {
        let start_m = from_m + each_m * f64::from(bay);
        parts.extend(cargo(plan, hash(seed, 730 + bay), [start_m, start_m + each_m - 0.9], deck_m));
        if bay % 2 == 1 {
            parts.extend(crane(plan, start_m - 0.9, deck_m, draw(seed, 740 + bay) < 0.5));
        }
    }
    parts
}

/// A bay of a ship: hatches, and containers on them or none.
fn cargo(plan: &Plan<'_>, seed: u32, [from_m, to_m]: [f64; 2], deck_m: f64) -> Vec<SceneBox> {
    let [_, width, height] = plan.size_m.to_array();
    let top_m = deck_m + HATCH_M;
    let mut parts = vec![plan.shaped(ThingForm::Sheet, [from_m, 0.1 * width, deck_m], [to_m, 0.9 * width, top_m])];
    let rows = (0.8 * width / (WIDE_M + 0.06)).floor();
    let tiers = ((height - top_m) / HIGH_M).floor();
    if draw(seed, 0) < 0.3 {
        return parts;
    }
    let side_m = 0.5 * (width - rows * (WIDE_M + 0.06));
    for row in 0..rows as u32 {
        let near_m = side_m + f64::from(row) * (WIDE_M + 0.06);
        let high = (tiers * f64::from(draw(seed, 10 + row)) + 0.85).min(tiers) as u32;
        for tier in 0..high {
            let low_m = top_m + f64::from(tier) * HIGH_M;
            let low = [from_m, near_m, low_m];
            parts.extend(place(plan, hash(seed, 100 + 16 * row + tier), low, [to_m, near_m + WIDE_M, low_m + HIGH_M]));
        }
    }
    parts
}

/// A post beside the hatches with an arm that lies along the ship.
fn crane(plan: &Plan<'_>, at_m: f64, deck_m: f64, is_far: bool) -> Vec<SceneBox> {
    let [_, width, height] = plan.size_m.to_array();
    let side_m = if is_far { 0.93 * width } else { 0.07 * width };
    let post = plan.shaped(ThingForm::Paint, [at_m, side_m - 0.55, deck_m], [at_m + 0.8, side_m + 0.55, height - 0.1]);
    let arm = [[at_m - 9.0, side_m - 0.22, height - 0.5], [at_m, side_m + 0.22, height - 0.1]];
    vec![post, plan.shaped(ThingForm::Paint, arm[0], arm[1])]
}
