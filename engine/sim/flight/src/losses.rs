//! Losses of the target that are ordered in a share of the flights: every flight is planned with its loss once, and the orders
//! go to flights that succeeded, so that the shares are filled.

use cosfly_domain::{Around, Body, Followed, PlanOutcome, Trajectory};
use cosfly_figures::{BodyShape, outfit_of};
use cosfly_film::hidden::hidden;
use cosfly_frames::DVec3;
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_planner::config::OcclusionConfig;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Somebody within this distance of the target, where it is seen again, is beside it, metres.
const BESIDE_M: f64 = 15.0;
/// Cosine of the largest angle at the camera between the target and somebody who is in the picture with it: 26 degrees, within
/// all usual fields of view.
const IN_PICTURE_COS: f64 = 0.9;
/// Frames from the one in which the target is seen again in which the other one is seen as well: pixels may show the target a
/// frame sooner or later than rays.
const FRAMES_BESIDE: usize = 3;

/// Outcome of ordering a loss.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trial {
    /// Whether the target is lost for as long as ordered, by its points and by its whole figure.
    pub is_lost: bool,
    /// Whether somebody in the target's clothes is beside it where it is seen again.
    pub beside_look_alike: bool,
}

impl Trial {
    /// Trial of a flight planned with the loss among the boxes of a town.
    pub fn of(
        outcome: &PlanOutcome,
        ordered: &OcclusionConfig,
        boxes: &BoxBvh,
        around: &Around,
        followed: Option<&Followed>,
    ) -> Self {
        let PlanOutcome::Planned(flight) = outcome else { return Self { is_lost: false, beside_look_alike: false } };
        let dt_s = flight.track.dt_s;
        let is_ordered = |loss: &Range<usize>| {
            let length_s = loss.len() as f64 * dt_s;
            length_s >= ordered.min_s - 1e-9 && length_s <= ordered.max_s + 1e-9
        };
        let ordered_among = |lost: &[bool]| losses(lost).iter().filter(|loss| is_ordered(loss)).count();
        let by_points: Vec<bool> = flight.visibility.iter().map(|visibility| *visibility == 0.0).collect();
        let by_figure = hidden(flight, boxes, around, followed);
        let least_s = f64::from(ordered.count) * ordered.min_s;
        let is_lost = [&by_points, &by_figure].iter().all(|lost| ordered_among(lost) >= ordered.count as usize)
            && flight.certificate.occlusion_reached_s >= least_s - 1e-9;
        let seen_again = seen_again(&by_points);
        let beside_look_alike = followed.zip(seen_again).is_some_and(|(followed, frame)| {
            let looks = |seed| outfit_of(BodyShape::default(), seed);
            let bodies = around.bodies().map(|(_, body)| body);
            let mut alike = bodies.filter(|body| {
                body.plan.kind == followed.plan.kind && looks(&body.plan.looks).is_like(&looks(&followed.plan.looks))
            });
            alike.any(|body| is_seen_beside(body, flight, frame, boxes))
        });
        Self { is_lost, beside_look_alike }
    }

    /// Trial of several drones behind one walk: all of them lose the target.
    pub fn of_all(trials: impl Iterator<Item = Self>) -> Self {
        let both = |one: Self, other: Self| Self {
            is_lost: one.is_lost && other.is_lost,
            beside_look_alike: one.beside_look_alike && other.beside_look_alike,
        };
        trials.reduce(both).unwrap_or(Self { is_lost: false, beside_look_alike: false })
    }
}

/// Frames of each loss: of each longest stretch in which the target is lost.
fn losses(lost: &[bool]) -> Vec<Range<usize>> {
    let frames: Vec<usize> = (0..lost.len()).collect();
    let stretches = frames.chunk_by(|a, b| lost[*a] == lost[*b]).filter(|stretch| lost[stretch[0]]);
    stretches.map(|stretch| stretch[0]..stretch[stretch.len() - 1] + 1).collect()
}

/// Frame after the first of the longest losses; `None` where it is the end.
fn seen_again(lost: &[bool]) -> Option<usize> {
    let longest =
        losses(lost).into_iter().reduce(|longest, next| if next.len() > longest.len() { next } else { longest })?;
    Some(longest.end).filter(|frame| *frame < lost.len())
}

/// Whether somebody is near the target and in the picture with it, with nothing of the town before the middle of the body, in
/// `frame` and some frames after it.
fn is_seen_beside(body: &Body, flight: &Trajectory, frame: usize, boxes: &BoxBvh) -> bool {
    let last = (frame + FRAMES_BESIDE).min(flight.poses_in_world.len());
    (frame..last).all(|frame| {
        let Some(state) = body.state(frame as u32) else { return false };
        let eye = flight.poses_in_world[frame].position_in_world;
        let feet = flight.track.states[frame].feet_in_world;
        let middle = state.feet_in_world + DVec3::Z * (0.5 * body.plan.size_m.z);
        let [to_body, to_target] = [middle - eye, feet - eye];
        (state.feet_in_world - feet).length() <= BESIDE_M
            && to_body.dot(to_target) >= IN_PICTURE_COS * to_body.length() * to_target.length()
            && !boxes.blocked(eye, middle)
    })
}

/// Number of flights that a share of `count` asks for: up to one more than the share.
fn wanted(share: f64, count: usize) -> usize {
    (share * count as f64 - 1e-9).ceil() as usize
}

/// Who loses the target, by the trials of all flights: as many as are wanted and can, in turn, and among them as many as are wanted
/// and can who are beside a look-alike.
pub fn assigned(trials: &[Trial], share: f64, share_beside: f64) -> Vec<bool> {
    let mut given = 0;
    let in_turn = trials.iter().enumerate().map(|(place, trial)| {
        let goes = trial.is_lost && given < wanted(share, place + 1);
        given += usize::from(goes);
        goes
    });
    let mut goes: Vec<bool> = in_turn.collect();
    // Where those at the end cannot, others do.
    let wanted_in_all = wanted(share, trials.len());
    let others = (0..trials.len()).rev().filter(|place| trials[*place].is_lost && !goes[*place]);
    let others: Vec<usize> = others.take(wanted_in_all - given).collect();
    others.into_iter().for_each(|place| goes[place] = true);
    // Who is beside a look-alike takes the order of the last one who is not.
    let is_beside = |place: &usize| trials[*place].is_lost && trials[*place].beside_look_alike;
    let beside = goes.iter().enumerate().filter(|(place, goes)| **goes && is_beside(place)).count();
    let missing = wanted(share_beside, wanted_in_all).saturating_sub(beside);
    let to = (0..goes.len()).filter(|place| !goes[*place] && is_beside(place));
    let from = (0..goes.len()).rev().filter(|place| goes[*place] && !is_beside(place));
    let swaps: Vec<(usize, usize)> = to.zip(from).take(missing).collect();
    swaps.into_iter().for_each(|(to, from)| goes.swap(to, from));
    goes
}

/// Note, and warnings where a share is not filled.
pub fn said(config: &OcclusionConfig, trials: &[Trial], assigned: &[bool]) -> (String, Vec<String>) {
    let count = |is: &dyn Fn(&Trial) -> bool| trials.iter().zip(assigned).filter(|it| *it.1 && is(it.0)).count();
    let (lost, beside) = (count(&|_| true), count(&|trial| trial.beside_look_alike));
    let wanted_in_all = wanted(config.share, trials.len());
    let wanted_beside = wanted(config.beside_look_alike, wanted_in_all);
    let can = |is: &dyn Fn(&Trial) -> bool| trials.iter().filter(|trial| trial.is_lost && is(trial)).count();
    let mut warnings = vec![];
    if lost < wanted_in_all {
        let (can, all) = (can(&|_| true), trials.len());
        warnings.push(format!(
            "`occlusion.share` asks for {wanted_in_all} flights that lose their target; {lost} do: {can} of {all} walks lead past something that hides them for {} s",
            config.min_s
        ));
    }
    if beside < wanted_beside {
        let can = can(&|trial| trial.beside_look_alike);
        warnings.push(format!(
            "`occlusion.beside_look_alike` asks for {wanted_beside} losses that end beside a look-alike; {beside} do: somebody in the same clothes is near and in the picture at the end of {can}; ask for more with `look_alikes.shares` of stage `traffic`"
        ));
    }
    let percent = |share: f64| format!("{}", (1_000.0 * share).round() / 10.0);
    let [share, share_beside] = [config.share, config.beside_look_alike].map(percent);
    let notes = format!(
        "in {lost} of {} flights ({share} % ordered), {beside} of them beside a look-alike ({share_beside} % ordered)",
        trials.len()
    );
    (notes, warnings)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trials() -> Vec<Trial> {
        let trial = |number: u32| Trial { is_lost: !number.is_multiple_of(3), beside_look_alike: number % 7 == 1 };
        (0..400).map(trial).collect()
    }

    #[test]
    fn shares_are_filled_as_far_as_flights_can_and_no_further() {
        let count = |trials: &[Trial], is: &dyn Fn(usize) -> bool| (0..trials.len()).filter(|place| is(*place)).count();
        for flights in 0..120 {
            for (share, share_beside) in [(0.2, 0.1), (0.2, 0.0), (0.2, 0.9), (0.7, 0.3), (1.0, 1.0), (0.0, 1.0)] {
                let trials = &trials()[400 - flights..];
                let goes = assigned(trials, share, share_beside);
                assert!(trials.iter().zip(&goes).all(|(trial, goes)| trial.is_lost || !goes));
                let can = count(trials, &|place| trials[place].is_lost);
                let wanted = (share * flights as f64 - 1e-9).ceil() as usize;
                let lost = count(trials, &|place| goes[place]);
                assert_eq!(lost, wanted.min(can), "{flights} flights, share {share}");
                let beside = |place: usize| trials[place].is_lost && trials[place].beside_look_alike;
                let wanted_beside = (share_beside * wanted as f64 - 1e-9).ceil() as usize;
                let reached = count(trials, &|place| goes[place] && beside(place));
                assert!(reached >= wanted_beside.min(count(trials, &beside)).min(lost), "{flights} {share_beside}");
            }
        }
    }

    #[test]
    fn more_flights_change_no_order_where_none_needs_a_look_alike_beside_it() {
        let trials = trials();
        let all = assigned(&trials, 0.2, 0.0);
        for flights in (5..400).step_by(5) {
            assert_eq!(assigned(&trials[..flights], 0.2, 0.0), all[..flights]);
        }
    }
}
