//! Losses of the target that an expert orders who knows only the past: a plan with a loss is flown to the end of the loss as it was
//! made, for who does not see the target cannot plan anew.

use super::stretches::PlanOne;
use crate::config::muco::MucoConfig;
use crate::error::PlanError;
use crate::found::Found;
use crate::request::PlanRequest;
use cosfly_domain::Certificate;
use cosfly_frames::DVec3;
use std::ops::Range;

/// Losses that are still to come about, and those that were flown.
pub(super) struct Losses {
    /// With one loss to be planned, and with none.
    with_one: MucoConfig,
    without: MucoConfig,
    ordered: u32,
    /// Frames of the flight in which the target was to be lost.
    flown: Vec<Range<usize>>,
    /// Frames that a loss takes, at least and on average; those of the whole flight.
    least: usize,
    mean: usize,
    frames: usize,
    dt_s: f64,
}

impl Losses {
    /// The losses that `request` orders.
    pub fn of(request: &PlanRequest<'_>) -> Self {
        let (wanted, dt_s) = (&request.config.occlusion, request.track.dt_s);
        let config = |count: u32| {
            let mut config = request.config.clone();
            config.occlusion.count = count;
            config
        };
        let count = |time_s: f64| ((time_s / dt_s).ceil() as usize).max(1);
        let (least, mean) = (count(wanted.min_s), count(0.5 * (wanted.min_s + wanted.max_s)));
        let (ordered, frames) = (wanted.count, request.track.len());
        Self { with_one: config(1), without: config(0), ordered, flown: vec![], least, mean, frames, dt_s }
    }

    /// Plans `part` of the flight, whose first `known` frames of `done` are flown. With the flight, the number of frames beyond the
    /// known ones that are to be flown as planned, because the target is lost in them.
    pub fn plan(
        &mut self,
        part: &PlanRequest<'_>,
        head: &[DVec3],
        done: usize,
        plan_one: &PlanOne<'_>,
    ) -> Result<(Found, usize), PlanError> {
        if self.is_due(done) {
            let found = plan_one(&PlanRequest { config: &self.with_one, ..without_terms(part) }, head);
            if let Ok(found) = found
                && let Some(lost) = self.lost(&found.measured.visibility[head.len()..])
                && done + lost.end <= self.frames
            {
                self.flown.push(done + lost.start..done + lost.end);
                return Ok((found, lost.end));
            }
        }
        let found = plan_one(&PlanRequest { config: &self.without, ..without_terms(part) }, head)?;
        Ok((found, 0))
    }

    /// Whether a loss is to be sought now. Losses are sought one after the other, each once its share of the flight has begun.
    fn is_due(&self, done: usize) -> bool {
        let given = self.flown.len() as u32;
        let rest = self.flown.last().map_or(0, |last| last.end + self.mean);
        let from = (self.frames as f64 * f64::from(given) / f64::from(self.ordered.max(1))) as usize;
        given < self.ordered && done >= rest.max(from)
    }

    /// The first stretch of frames, at least as long as the shortest loss, in which nothing of the target is to be seen.
    fn lost(&self, seen: &[f64]) -> Option<Range<usize>> {
        let frames: Vec<usize> = (0..seen.len()).collect();
        let mut stretches = frames.chunk_by(|a, b| (seen[*a] == 0.0) == (seen[*b] == 0.0));
        // One that reaches the end of the plan may last longer than ordered.
        let long = |stretch: &&[usize]| {
            let end = stretch[stretch.len() - 1] + 1;
            seen[stretch[0]] == 0.0 && stretch.len() >= self.least && end < seen.len()
        };
        stretches.find(long).map(|stretch| stretch[0]..stretch[stretch.len() - 1] + 1)
    }

    /// Writes down what was ordered, and what came about in frames that see the target as `visibility` says.
    pub fn state(&self, certificate: &mut Certificate, visibility: &[f64]) {
        let lost = self.flown.iter().flat_map(|frames| &visibility[frames.clone()]).filter(|seen| **seen == 0.0);
        certificate.occlusion_ordered_s = f64::from(self.ordered) * self.mean as f64 * self.dt_s;
        certificate.occlusion_reached_s = lost.count() as f64 * self.dt_s;
    }
}

/// The request without its terms, which the solver holds already.
fn without_terms<'a>(request: &PlanRequest<'a>) -> PlanRequest<'a> {
    PlanRequest { extra_terms: Vec::new(), ..*request }
}
