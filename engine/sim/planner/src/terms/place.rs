//! Weighted costs of a single place, for searches that price places before there is a path.

use super::Weights;
use super::altitude::band_cost;
use super::pitch::{pitch_below_horizon_deg, pitch_cost};
use super::tracking::distance_cost;
use crate::config::view::ViewConfig;
use cosfly_frames::DVec3;

/// Weights, and the wishes that they weigh.
pub struct PlaceCosts<'a> {
    /// The weights in force.
    pub weights: Weights,
    /// Wanted position of the drone.
    pub view: &'a ViewConfig,
}

impl PlaceCosts<'_> {
    /// Terms `tracking` and `pitch` of the vector from the target's feet to the drone, metres.
    pub fn sight(&self, sight: DVec3) -> f64 {
        self.weights.tracking * distance_cost(sight.length(), self.view.distance_m)
            + self.weights.pitch * pitch_cost(pitch_below_horizon_deg(sight), self.view.pitch_deg).0
    }

    /// Term `altitude` of the height above the target's feet and the smallest height above any ground, metres.
    pub fn altitude(&self, height_m: f64, lowest_height_m: f64) -> f64 {
        let view = self.view;
        self.weights.altitude * band_cost(height_m, lowest_height_m, view.min_altitude_m, view.preferred_altitude_m)
    }

    /// Term `safety` at a distance from the nearest obstacle, metres.
    pub fn safety(&self, distance_m: f64) -> f64 {
        let close_m = (self.view.safety_influence_m - distance_m).max(0.0);
        self.weights.safety * 0.5 * close_m * close_m
    }
}
