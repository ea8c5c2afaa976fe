//! [`Reward`]: the reward of a step, by named and weighted terms.

use crate::settings::{EnvironmentSettings, RewardWeights};

/// The reward of a step, by terms; each is what its weight multiplies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reward {
    /// Share of the target that is seen in the picture, 0..=1.
    pub visibility: f64,
    /// Minus the angle between the target and the picture's middle, as a share of half the field of view; at least -1.
    pub framing: f64,
    /// Minus the distance outside the wanted band, as a share of the band's width; at least -1.
    pub distance: f64,
    /// Minus the square of the acceleration as a share of its limit.
    pub effort: f64,
    /// -1 in the step of a collision.
    pub collision: f64,
    /// -1 where the target is not tracked.
    pub loss: f64,
}

impl Reward {
    /// Names of the terms, as in recipes and tables.
    pub const NAMES: [&'static str; 6] = ["visibility", "framing", "distance", "effort", "collision", "loss"];

    /// Terms in the order of [`Self::NAMES`].
    pub fn terms(&self) -> [f64; 6] {
        [self.visibility, self.framing, self.distance, self.effort, self.collision, self.loss]
    }

    /// The reward of terms in the order of [`Self::NAMES`].
    pub fn of_terms([visibility, framing, distance, effort, collision, loss]: [f64; 6]) -> Self {
        Self { visibility, framing, distance, effort, collision, loss }
    }

    /// Sum of the weighted terms.
    pub fn sum(&self, weights: &RewardWeights) -> f64 {
        let RewardWeights { visibility, framing, distance, effort, collision, loss } = *weights;
        let weights = [visibility, framing, distance, effort, collision, loss];
        self.terms().into_iter().zip(weights).map(|(term, weight)| weight * term).sum()
    }

    /// Minus the distance outside the band.
    pub(crate) fn outside_band(distance_m: f64, settings: &EnvironmentSettings) -> f64 {
        let (near_m, far_m) = settings.band_m;
        let outside_m = (near_m - distance_m).max(distance_m - far_m).max(0.0);
        -(outside_m / (far_m - near_m).max(1e-9)).min(1.0)
    }
}
