//! How hard flights are to predict, and which of them are too many for a share of hard ones.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::RenderedTrajectory;
use cosfly_windows::{Difficulty, WindowFeatures, WindowFrames, WindowShape};
use std::ops::Range;

/// Difficulty of an expert: the median of its windows of the usual shape, as in column `difficulty` of table `trajectories`.
pub fn difficulty(record: &RenderedTrajectory) -> Difficulty {
    let shape = WindowShape::default();
    let starts = shape.starts(record.len());
    let mut all: Vec<Difficulty> =
        starts.map(|start| features(record, start..start + shape.size()).difficulty()).collect();
    if all.is_empty() {
        return features(record, 0..record.len()).difficulty();
    }
    all.sort_unstable();
    all[all.len() / 2]
}

fn features(record: &RenderedTrajectory, frames: Range<usize>) -> WindowFeatures {
    let states = &record.trajectory.track.states[frames.clone()];
    let visible: Vec<f64> = record.views[frames.clone()].iter().map(|view| view.visible_by_rays).collect();
    let feet: Vec<_> = states.iter().map(|state| state.feet_in_world).collect();
    let heading_rad: Vec<f64> = states.iter().map(|state| state.heading_rad).collect();
    WindowFeatures::of(&WindowFrames {
        expert: &record.trajectory.poses_in_world[frames],
        feet: &feet,
        heading_rad: &heading_rad,
        visible: &visible,
        dt_s: record.dt_s(),
    })
}

/// Places of the flights that leave, of each sort those that were drawn first, so that a share of the others is hard.
///
/// # Errors
/// `inspect-hard`: all flights are of one sort.
pub fn too_many(is_hard: &[bool], share: f64) -> Result<Vec<usize>> {
    let of = |sort: bool| (0..is_hard.len()).filter(|at| is_hard[*at] == sort).collect::<Vec<usize>>();
    let (hard, others) = (of(true), of(false));
    let lacking = match (hard.is_empty(), others.is_empty()) {
        (true, false) if share > 0.0 => "no flight is hard",
        (false, true) if share < 1.0 => "every flight is hard",
        _ => {
            // As many as go with those of the other sort; all where none of the other sort is wanted.
            let kept = |here: usize, share: f64, there: usize| {
                if share >= 1.0 { here } else { here.min((there as f64 * share / (1.0 - share)).round() as usize) }
            };
            let [hard_kept, others_kept] =
                [kept(hard.len(), share, others.len()), kept(others.len(), 1.0 - share, hard.len())];
            return Ok([&hard[hard_kept..], &others[others_kept..]].concat());
        }
    };
    let message = format!("{lacking}; {} % are to be", 100.0 * share);
    Err(Diagnostic::new("inspect-hard", Fault::Recipe, message).hint(
        "set `restless_share` of stage `pedestrians` to about the same share, make more flights, or leave `hard_share` out",
    ))
}
