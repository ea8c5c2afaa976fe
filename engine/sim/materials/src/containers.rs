//! Containers of freight: a box of their measures is a stack of them.

use crate::parts::SceneBox;
use crate::pattern::{draw, hash};
use crate::plan::Plan;
use crate::thing_form::ThingForm;

/// Lengths of long and short containers, their width and their height, metres.
const LONG_M: f64 = 12.2;
const SHORT_M: f64 = 6.06;
pub(crate) const WIDE_M: f64 = 2.44;
pub(crate) const HIGH_M: f64 = 2.6;
/// Measures may differ by this much, metres, for each container of a stack in height.
const OFF_M: f64 = 0.15;
/// Most containers on top of each other.
const MOST_HIGH: f64 = 8.0;
/// Share of the long places that two short ones fill.
const SHORT_SHARE: f32 = 0.22;
/// Containers of a stack stand back by up to this much at either end, metres.
const BACK_M: f64 = 0.09;

/// The containers of a box that has the measures of a stack of them. `seed` draws their shapes, and with the seed of the
/// looks their paints.
pub(crate) fn stack(plan: &Plan<'_>, seed: u32) -> Option<Vec<SceneBox>> {
    let size_m = plan.size_m;
    let high = (size_m.z / HIGH_M).round();
    let is_stack = [LONG_M, SHORT_M].iter().any(|length_m| (size_m.x - length_m).abs() < OFF_M)
        && (size_m.y - WIDE_M).abs() < OFF_M
        && (1.0..=MOST_HIGH).contains(&high)
        && (size_m.z - high * HIGH_M).abs() < OFF_M * high;
    is_stack.then(|| {
        let each_m = size_m.z / high;
        (0..high as u32)
            .flat_map(|tier| {
                let from_m = f64::from(tier) * each_m;
                place(plan, hash(seed, 700 + tier), [0.0, 0.0, from_m], [size_m.x, size_m.y, from_m + each_m])
            })
            .collect()
    })
}

/// A long container, or two short ones, between two corners.
pub(crate) fn place(plan: &Plan<'_>, seed: u32, low: [f64; 3], high: [f64; 3]) -> Vec<SceneBox> {
    let is_split = high[0] - low[0] > 2.0 * SHORT_M - OFF_M && draw(seed, 0) < SHORT_SHARE;
    let middle_m = 0.5 * (low[0] + high[0]);
    let ends =
        if is_split { vec![[low[0], middle_m - 0.03], [middle_m + 0.03, high[0]]] } else { vec![[low[0], high[0]]] };
    (0u32..)
        .zip(ends)
        .map(|(number, [from_m, to_m])| {
            let seed = hash(seed, number + 1);
            let [start, end] = [1, 2].map(|index| BACK_M * f64::from(draw(seed, index)));
            let one =
                plan.shaped(ThingForm::Container, [from_m + start, low[1], low[2]], [to_m - end, high[1], high[2]]);
            SceneBox { seed: hash(seed, one.seed), ..one }
        })
        .collect()
}
