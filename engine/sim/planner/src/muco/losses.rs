//! Losing the target on purpose: when, for how long, and how much of it came about.

use super::viterbi::Viterbi;
use crate::config::occlusion::OcclusionConfig;

/// The ordered losses.
#[derive(Clone, Debug, Default)]
pub struct LossPlan {
    /// Per frame, whether the target is to be lost; empty when it never is.
    pub lost: Vec<bool>,
    /// Sum of the ordered times, seconds.
    pub ordered_s: f64,
}

/// Chooses the layers in which the target is lost most cheaply, one stretch after the other, and leaves the search
/// with these orders. `frames` are the frames of the layers, `dt_s` the time from frame to frame.
pub fn order(search: &mut Viterbi<'_>, wanted: &OcclusionConfig, frames: &[usize], dt_s: f64) -> LossPlan {
    let count = frames.last().map_or(0, |last| last + 1);
    if wanted.count == 0 || frames.len() < 2 {
        return LossPlan::default();
    }
    let layer_s = dt_s * (frames[1] - frames[0]) as f64;
    let length = ((0.5 * (wanted.min_s + wanted.max_s) / layer_s).round() as usize).max(1);
    let mut plan = LossPlan { lost: vec![false; count], ordered_s: 0.0 };
    for _ in 0..wanted.count {
        plan.ordered_s += length as f64 * layer_s;
        let Some(first) = cheapest_stretch(search, length) else { continue };
        (first..first + length).for_each(|layer| search.lose(layer, true));
        let last = frames.get(first + length).copied().unwrap_or(count);
        plan.lost[frames[first]..last].fill(true);
    }
    plan
}

/// The first layer of the stretch whose loss costs least over the whole flight; stretches stay apart by their length.
fn cheapest_stretch(search: &mut Viterbi<'_>, length: usize) -> Option<usize> {
    let layers = search.layers();
    let mut best: Option<(f64, usize)> = None;
    for first in (length..layers.saturating_sub(2 * length)).step_by(length.div_ceil(2)) {
        if (first - length..first + 2 * length).any(|layer| search.is_lost(layer)) {
            continue;
        }
        (first..first + length).for_each(|layer| search.lose(layer, true));
        if search.solve(0).is_ok() {
            let cost = search.lowest_cost();
            best = if best.is_none_or(|(lowest, _)| cost < lowest) { Some((cost, first)) } else { best };
        }
        (first..first + length).for_each(|layer| search.lose(layer, false));
    }
    best.map(|(_, first)| first)
}

/// For how long the target was lost where that was ordered: frames that see no body point, seconds.
pub fn reached_s(plan: &LossPlan, visibility: &[f64], dt_s: f64) -> f64 {
    plan.lost.iter().zip(visibility).filter(|(lost, seen)| **lost && **seen == 0.0).count() as f64 * dt_s
}
