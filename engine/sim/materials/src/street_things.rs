//! Shelters at stops, things to play on, goals and fountains, told by their measures.

use crate::ground_kinds::GroundKinds;
use crate::parts::SceneBox;
use crate::plan::Plan;
use crate::thing_form::ThingForm;
use cosfly_domain::ObstacleKind;
use cosfly_frames::DVec2;

/// Least and greatest length, depth and height of a shelter, metres.
const SHELTER_M: [[f64; 3]; 2] = [[3.4, 1.2, 2.3], [6.5, 2.3, 2.9]];
/// Measures of a swing, a climbing frame, a slide, a statue and a basin, metres: those of generated towns.
const SWING_M: [f64; 3] = [3.6, 0.5, 2.3];
const FRAME_M: [f64; 3] = [2.4, 2.4, 2.6];
const SLIDE_M: [f64; 3] = [3.0, 0.8, 1.6];
const STATUE_M: [f64; 3] = [2.8, 2.8, 2.6];
const BASIN_M: [f64; 3] = [3.2, 3.2, 1.1];
/// Depth and height of goals, and their least and greatest width, metres.
const GOAL_M: [f64; 2] = [1.0, 2.0];
const GOAL_WIDE_M: [f64; 2] = [1.3, 8.0];
const CLOSE_M: f64 = 0.03;
/// Distances from a shelter at which its street is looked for, metres.
const TO_STREET_M: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 4.5];
/// Thickness of posts and of panes, metres.
const POST_M: f64 = 0.1;
const PANE_M: f64 = 0.05;

/// The parts of a thing that its measures tell.
pub(crate) fn street_thing(b: &SceneBox, ground: &GroundKinds) -> Option<Vec<SceneBox>> {
    let plan = &Plan::of(b);
    if plan.is_within(SHELTER_M) {
        // A shelter opens to the street.
        let is_street = |share: f64| {
            let middle_m = 0.5 * plan.size_m.x;
            TO_STREET_M.iter().position(|away_m| ground.is_road(plan.in_plan(middle_m, share, *away_m))).unwrap_or(9)
        };
        let is_turned = is_street(1.0) < is_street(-1.0);
        Some(shelter(&Plan::of(b).turned(is_turned)))
    } else if plan.is_of(SWING_M) {
        Some(swing(plan))
    } else if plan.is_of(FRAME_M) {
        Some(climbing_frame(plan))
    } else if plan.is_of(SLIDE_M) {
        Some(slide(plan))
    } else if plan.is_of(STATUE_M) {
        Some(statue(plan))
    } else if plan.is_of(BASIN_M) {
        Some(basin(plan))
    } else if is_goal(plan) {
        Some(goal(plan))
    } else {
        None
    }
}

fn is_goal(plan: &Plan<'_>) -> bool {
    let is_deep = |side_m: f64| (side_m - GOAL_M[0]).abs() < CLOSE_M;
    let is_wide = |side_m: f64| (GOAL_WIDE_M[0]..GOAL_WIDE_M[1]).contains(&side_m);
    let [length, depth, height] = plan.size_m.to_array();
    (height - GOAL_M[1]).abs() < CLOSE_M && is_deep(depth) && is_wide(length)
}

/// Upright posts on a rectangle.
fn posts(plan: &Plan<'_>, form: ThingForm, [low, high]: [[f64; 2]; 2], top_m: f64, thick_m: f64) -> Vec<SceneBox> {
    let places = [
        [low[0], low[1]],
        [high[0] - thick_m, low[1]],
        [low[0], high[1] - thick_m],
        [high[0] - thick_m, high[1] - thick_m],
    ];
    places.map(|[x, y]| plan.shaped(form, [x, y, 0.0], [x + thick_m, y + thick_m, top_m])).to_vec()
}

/// A roof on posts, panes at the back and at the ends, a bench.
fn shelter(plan: &Plan<'_>) -> Vec<SceneBox> {
    let [length, depth, height] = plan.size_m.to_array();
    let eaves_m = height - 0.14;
    let (low, high) = ([0.15, 0.12], [length - 0.15, depth - 0.12]);
    let mut parts: Vec<SceneBox> = posts(plan, ThingForm::Plain, [low, high], eaves_m, POST_M)
        .into_iter()
        .map(|post| SceneBox { kind: ObstacleKind::Pole, ..post })
        .collect();
    parts.push(plan.shaped(ThingForm::Sheet, [0.0, 0.0, eaves_m], [length, depth, height]));
    let back_m = high[1] - 0.5 * (POST_M + PANE_M);
    let panes = 3u32;
    let each_m = (high[0] - low[0] - 2.0 * POST_M) / f64::from(panes);
    for pane in 0..panes {
        let from_m = low[0] + POST_M + f64::from(pane) * each_m;
        let pane = [[from_m + 0.02, back_m, 0.15], [from_m + each_m - 0.02, back_m + PANE_M, eaves_m - 0.1]];
        parts.push(plan.shaped(ThingForm::Glass, pane[0], pane[1]));
    }
    let from_m = low[1] + 0.4 * depth;
    for x in [low[0] + 0.02, high[0] - 0.02 - PANE_M] {
        parts.push(plan.shaped(ThingForm::Glass, [x, from_m, 0.15], [x + PANE_M, back_m, eaves_m - 0.1]));
    }
    let seat = [[low[0] + 0.6, back_m - 0.5, 0.42], [high[0] - 0.6, back_m - 0.1, 0.48]];
    parts.push(plan.part(ObstacleKind::Bench, seat[0], seat[1]));
    parts
}

/// Two seats on chains below a beam.
fn swing(plan: &Plan<'_>) -> Vec<SceneBox> {
    let [length, depth, height] = plan.size_m.to_array();
    let middle = 0.5 * depth;
    let mut parts =
        vec![plan.shaped(ThingForm::Paint, [0.0, middle - 0.05, height - 0.1], [length, middle + 0.05, height])];
    for x in [0.0, length - POST_M] {
        // Legs that meet below the beam.
        for [foot_m, top_m] in [[0.0, middle - POST_M], [depth - POST_M, middle]] {
            let face = |y: f64| [[x, y], [x + POST_M, y], [x, y + POST_M], [x + POST_M, y + POST_M]].map(DVec2::from);
            parts.push(plan.prism(ThingForm::Paint, [face(foot_m), face(top_m)], [0.0, height]));
        }
    }
    for x in [0.3, 0.7].map(|share| share * length) {
        parts.push(plan.part(ObstacleKind::Bench, [x - 0.25, middle - 0.1, 0.45], [x + 0.25, middle + 0.1, 0.5]));
        for side in [-0.24, 0.21] {
            let chain = [[x + side, middle - 0.015, 0.5], [x + side + 0.03, middle + 0.015, height - 0.1]];
            parts.push(plan.part(ObstacleKind::Pole, chain[0], chain[1]));
        }
    }
    parts
}

/// Posts with a floor, rails, a roof and a ladder.
fn climbing_frame(plan: &Plan<'_>) -> Vec<SceneBox> {
    let [length, depth, height] = plan.size_m.to_array();
    let eaves_m = height - 0.7;
    let ([x0, y0], [x1, y1]) = ([0.3, 0.3], [length - 0.3, depth - 0.3]);
    let mut parts = posts(plan, ThingForm::Paint, [[x0, y0], [x1, y1]], eaves_m, 0.12);
    parts.push(plan.part(ObstacleKind::Bench, [x0, y0, 1.0], [x1, y1, 1.08]));
    for y in [y0, y1 - 0.06] {
        parts.push(plan.part(ObstacleKind::Bench, [x0 + 0.12, y, 1.25], [x1 - 0.12, y + 0.06, 1.65]));
    }
    for step in 0..4 {
        let z = 0.2 + 0.22 * f64::from(step);
        parts.push(plan.part(ObstacleKind::Pole, [x0 - 0.28, y0 + 0.3, z], [x0 - 0.22, y1 - 0.3, z + 0.05]));
    }
    for y in [y0 + 0.25, y1 - 0.3] {
        parts.push(plan.shaped(ThingForm::Paint, [x0 - 0.3, y, 0.0], [x0 - 0.2, y + 0.06, 1.5]));
    }
    let face = |in_m: f64| {
        let [low, high] = [DVec2::splat(in_m), DVec2::new(length - in_m, depth - in_m)];
        [low, DVec2::new(high.x, low.y), DVec2::new(low.x, high.y), high]
    };
    let roof = plan.prism(ThingForm::Paint, [face(0.0), face(0.5 * length.min(depth) - 0.06)], [eaves_m, height]);
    parts.push(SceneBox { seed: roof.seed.wrapping_add(1), ..roof });
    parts
}

/// A chute from a small tower with a ladder.
fn slide(plan: &Plan<'_>) -> Vec<SceneBox> {
    let [length, depth, height] = plan.size_m.to_array();
    let (floor_m, tower_m) = (height - 0.65, 0.7);
    let mut parts = posts(plan, ThingForm::Plain, [[0.0, 0.0], [tower_m, depth]], height, 0.07);
    parts.iter_mut().for_each(|post| post.kind = ObstacleKind::Pole);
    parts.push(plan.part(ObstacleKind::Bench, [0.0, 0.07, floor_m - 0.06], [tower_m, depth - 0.07, floor_m]));
    for step in 1..4 {
        let z = 0.22 * f64::from(step);
        parts.push(plan.part(ObstacleKind::Pole, [0.0, 0.07, z], [0.06, depth - 0.07, z + 0.05]));
    }
    // The chute and its rims are slabs that lean: their lower and upper faces lie beside each other.
    let slab = |[y0, y1]: [f64; 2], thick_m: f64, lift_m: f64| {
        let face = |x: f64| [[x, y0], [x + thick_m, y0], [x, y1], [x + thick_m, y1]].map(DVec2::from);
        let (foot, top) = (length - thick_m, tower_m - 0.1);
        plan.prism(ThingForm::Paint, [face(foot), face(top)], [0.05 + lift_m, floor_m + lift_m])
    };
    parts.push(slab([0.1, depth - 0.1], 0.16, 0.0));
    parts.push(slab([0.04, 0.1], 0.4, 0.1));
    parts.push(slab([depth - 0.1, depth - 0.04], 0.4, 0.1));
    parts
}

/// A figure on a pedestal with steps.
fn statue(plan: &Plan<'_>) -> Vec<SceneBox> {
    let [length, depth, height] = plan.size_m.to_array();
    let middle = DVec2::new(0.5 * length, 0.5 * depth);
    let block = |half_m: [f64; 2], heights_m: [f64; 2]| {
        let [low, high] = [middle - DVec2::from(half_m), middle + DVec2::from(half_m)];
        plan.part(ObstacleKind::Wall, [low.x, low.y, heights_m[0]], [high.x, high.y, heights_m[1]])
    };
    let metal =
        |half_m: [f64; 2], heights_m: [f64; 2]| SceneBox { kind: ObstacleKind::Pole, ..block(half_m, heights_m) };
    let figure = height - 1.15;
    let at = |share: f64| 1.15 + share * figure;
    vec![
        block([0.5 * length, 0.5 * depth], [0.0, 0.15]),
        block([0.4 * length, 0.4 * depth], [0.15, 0.3]),
        block([0.45, 0.45], [0.3, 1.05]),
        block([0.52, 0.52], [1.05, 1.15]),
        metal([0.13, 0.19], [at(0.0), at(0.5)]),
        metal([0.15, 0.26], [at(0.5), at(0.82)]),
        metal([0.09, 0.09], [at(0.85), height]),
    ]
}

/// A basin of stone with water and a column.
fn basin(plan: &Plan<'_>) -> Vec<SceneBox> {
    let [length, depth, height] = plan.size_m.to_array();
    let (rim_m, top_m, wide_m) = (0.28, 0.6 * height, 0.9);
    let wall =
        |low: [f64; 2], high: [f64; 2]| plan.part(ObstacleKind::Wall, [low[0], low[1], 0.0], [high[0], high[1], top_m]);
    let middle = DVec2::new(0.5 * length, 0.5 * depth);
    let column = |half_m: f64, heights_m: [f64; 2]| {
        let [low, high] = [middle - half_m, middle + half_m];
        plan.part(ObstacleKind::Wall, [low.x, low.y, heights_m[0]], [high.x, high.y, heights_m[1]])
    };
    vec![
        wall([0.0, 0.0], [length, rim_m]),
        wall([0.0, depth - rim_m], [length, depth]),
        wall([0.0, rim_m], [rim_m, depth - rim_m]),
        wall([length - rim_m, rim_m], [length, depth - rim_m]),
        plan.shaped(ThingForm::Pool, [rim_m, rim_m, 0.0], [length - rim_m, depth - rim_m, 0.75 * top_m]),
        column(0.14, [0.75 * top_m, height - 0.12]),
        column(0.5 * wide_m, [height - 0.12, height]),
    ]
}

/// Posts and bars of a goal that is open on all sides.
fn goal(plan: &Plan<'_>) -> Vec<SceneBox> {
    let [length, depth, height] = plan.size_m.to_array();
    let mut parts = posts(plan, ThingForm::White, [[0.0, 0.0], [length, depth]], height, 0.09);
    for y in [0.0, depth - 0.09] {
        parts.push(plan.shaped(ThingForm::White, [0.09, y, height - 0.09], [length - 0.09, y + 0.09, height]));
    }
    for x in [0.0, length - 0.09] {
        parts.push(plan.shaped(ThingForm::White, [x, 0.09, height - 0.09], [x + 0.09, depth - 0.09, height]));
        parts.push(plan.shaped(ThingForm::White, [x, 0.09, 0.0], [x + 0.09, depth - 0.09, 0.09]));
    }
    parts
}
