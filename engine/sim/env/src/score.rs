//! [`EpisodeScore`]: the outcome of an episode so far, and its [`End`].

use serde::{Deserialize, Serialize};

/// Stretches without tracking that are shorter count as no loss, seconds.
const SHORTEST_LOSS_S: f64 = 0.45;
/// Time at the end in which a successful flight tracks its target, seconds.
const LAST_S: f64 = 1.0;

/// Why an episode ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// The target's track is over.
    Finished,
    /// The drone touched an obstacle, the ground or the target.
    Collision,
    /// The target was not tracked for too long.
    Lost,
}

/// The outcome of an episode so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EpisodeScore {
    /// Steps of the whole episode.
    pub planned_steps: u32,
    /// Steps flown.
    pub steps: u32,
    /// Steps in which the target was tracked.
    pub tracked_steps: u32,
    /// Why the episode ended.
    pub end: Option<End>,
    /// Losses: stretches of at least half a second without tracking.
    pub losses: u32,
    /// Losses after which the target was tracked again.
    pub reacquired: u32,
    /// Sum of the lengths of those, seconds.
    pub reacquired_s: f64,
    /// Length of the longest loss, seconds.
    pub longest_loss_s: f64,
    /// Sum over the steps of the share of the target that is seen, in the picture or not.
    pub visible_sum: f64,
    /// Sum over the steps of the distance from the target's feet, metres.
    pub distance_sum_m: f64,
    /// Steps with a distance inside the wanted band.
    pub in_band_steps: u32,
    /// Sum over the steps of the jerk, m/s^3.
    pub jerk_sum_mps3: f64,
    /// Sum of the weighted rewards.
    pub reward_sum: f64,
    /// Length of the present stretch without tracking, seconds.
    pub untracked_s: f64,
    /// Length of the present stretch with tracking, seconds.
    pub tracked_s: f64,
}

impl EpisodeScore {
    /// Counts a step of `step_s` seconds.
    pub(crate) fn count(&mut self, tracked: bool, step_s: f64) {
        self.steps += 1;
        if tracked {
            self.tracked_steps += 1;
            self.tracked_s += step_s;
            if self.untracked_s >= SHORTEST_LOSS_S {
                self.reacquired += 1;
                self.reacquired_s += self.untracked_s;
            }
            self.untracked_s = 0.0;
            return;
        }
        self.tracked_s = 0.0;
        let before_s = self.untracked_s;
        self.untracked_s += step_s;
        self.losses += u32::from(before_s < SHORTEST_LOSS_S && self.untracked_s >= SHORTEST_LOSS_S);
        if self.untracked_s >= SHORTEST_LOSS_S {
            self.longest_loss_s = self.longest_loss_s.max(self.untracked_s);
        }
    }

    /// Share of all planned steps in which the target was tracked: steps that an early end left out count as not tracked.
    pub fn tracking_rate(&self) -> f64 {
        f64::from(self.tracked_steps) / f64::from(self.planned_steps.max(1))
    }

    /// Whether the flight came to the end of the target's track and tracked the target in the last second.
    pub fn success(&self) -> bool {
        self.end == Some(End::Finished) && self.tracked_s >= LAST_S - 1e-9
    }

    /// Mean over the flown steps of the share of the target that is seen, in the picture or not.
    pub fn mean_visibility(&self) -> f64 {
        self.visible_sum / f64::from(self.steps.max(1))
    }

    /// Mean length of the losses after which the target was tracked again, seconds.
    pub fn time_to_reacquire_s(&self) -> Option<f64> {
        (self.reacquired > 0).then(|| self.reacquired_s / f64::from(self.reacquired))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn losses_are_counted_once_and_short_gaps_are_none() {
        let mut score = EpisodeScore { planned_steps: 40, ..EpisodeScore::default() };
        let tracked =
            |score: &mut EpisodeScore, steps: u32, tracked: bool| (0..steps).for_each(|_| score.count(tracked, 0.1));
        tracked(&mut score, 10, true);
        tracked(&mut score, 3, false);
        tracked(&mut score, 5, true);
        tracked(&mut score, 8, false);
        tracked(&mut score, 2, true);
        tracked(&mut score, 6, false);
        assert_eq!((score.losses, score.reacquired, score.tracked_steps, score.steps), (2, 1, 17, 34));
        assert!((score.time_to_reacquire_s().unwrap() - 0.8).abs() < 1e-9 && (score.longest_loss_s - 0.8).abs() < 1e-9);
        assert_eq!(score.tracking_rate(), 17.0 / 40.0);
        score.end = Some(End::Finished);
        assert!(!score.success());
        tracked(&mut score, 10, true);
        assert!(score.success());
    }
}
