//! Intervals in which a flight does not see its target.

use crate::RenderedTrajectory;
use std::collections::BTreeMap;
use std::ops::Range;

/// Frames in a row without a visible pixel of the target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loss {
    /// The frames.
    pub frames: Range<usize>,
    /// Instance id of what hides most of the target in most of the frames; 0 where that is the ground, or where the target is
    /// outside of the image.
    pub cause_instance: u32,
    /// Number of the frames in which the target is outside of the image.
    pub frames_out_of_view: usize,
}

impl Loss {
    /// All losses of a flight, in order; none for a target without a body.
    pub fn all(record: &RenderedTrajectory) -> Vec<Self> {
        if record.target_kind().is_none() {
            return vec![];
        }
        let views = &record.views;
        let mut losses: Vec<Self> = vec![];
        for lost in
            (0..views.len()).collect::<Vec<_>>().chunk_by(|a, b| (views[*a].pixels == 0) == (views[*b].pixels == 0))
        {
            let frames = lost[0]..lost[lost.len() - 1] + 1;
            if views[frames.start].pixels == 0 {
                let cause_instance = cause(views[frames.clone()].iter().map(|view| view.occluder_instance));
                let frames_out_of_view = views[frames.clone()].iter().filter(|view| !view.in_view).count();
                losses.push(Self { frames, cause_instance, frames_out_of_view });
            }
        }
        losses
    }

    /// Whether the flight sees the target again.
    pub fn is_reacquired(&self, record: &RenderedTrajectory) -> bool {
        self.frames.end < record.len()
    }
}

/// The instance id that hides the target in most frames of a loss, of those that hide most of it in each; of equal counts the
/// smaller one.
pub fn cause(occluders: impl Iterator<Item = u32>) -> u32 {
    let mut counts = BTreeMap::<u32, usize>::new();
    occluders.for_each(|id| *counts.entry(id).or_default() += 1);
    counts.into_iter().reduce(|most, next| if next.1 > most.1 { next } else { most }).map_or(0, |most| most.0)
}
