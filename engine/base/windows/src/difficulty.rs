//! Difficulty of windows, from defined features.

use cosfly_frames::{DVec3, Pose, real};
use serde::Serialize;

/// Difficulty of predicting a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Difficulty {
    /// All features are below [`EASY_BELOW`].
    Easy,
    /// All other windows.
    Medium,
    /// A feature reaches [`HARD_FROM`]: a tight turn, a change of height, a fast drone or an occluded target.
    Hard,
}

/// Features of a window's difficulty, over all of its frames, of the expert.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct WindowFeatures {
    /// Sum of the turns of the target's walking direction, degrees.
    pub turn_deg: f64,
    /// Difference of the highest and lowest position of the expert, metres.
    pub height_change_m: f64,
    /// Share of frames in which the expert sees less than half of the target, 0..=1.
    pub occluded_share: f64,
    /// Mean speed of the expert, m/s.
    pub speed_mps: f64,
    /// Largest distance of the target from its first position, metres.
    pub target_way_m: f64,
}

/// Frames of a window; all lists have the same length.
#[derive(Clone, Copy, Debug)]
pub struct WindowFrames<'a> {
    /// Poses of the expert.
    pub expert: &'a [Pose],
    /// Positions of the target's feet, metres.
    pub feet: &'a [DVec3],
    /// Walking directions of the target, radians.
    pub heading_rad: &'a [f64],
    /// Share of the target that the expert sees, 0..=1.
    pub visible: &'a [f64],
    /// Time between frames, seconds.
    pub dt_s: f64,
}

/// Upper limits of an easy window, all of which must hold: degrees, metres, share of frames, m/s.
pub const EASY_BELOW: [f64; 4] = [30.0, 0.5, 0.05, 2.0];

/// Lower limits of a hard window, one of which suffices: degrees, metres, share of frames, m/s.
pub const HARD_FROM: [f64; 4] = [90.0, 2.5, 0.5, 4.0];

impl WindowFeatures {
    /// Features of a window.
    pub fn of(frames: &WindowFrames<'_>) -> Self {
        let turns = frames.heading_rad.windows(2).map(|pair| real::wrap_angle_rad(pair[1] - pair[0]).abs());
        let heights = frames.expert.iter().map(|pose| pose.position_in_world.z);
        let steps =
            frames.expert.windows(2).map(|pair| (pair[1].position_in_world - pair[0].position_in_world).length());
        let duration_s = frames.dt_s * frames.expert.len().saturating_sub(1) as f64;
        let hidden = frames.visible.iter().filter(|visible| **visible < 0.5).count();
        let first = frames.feet.first().copied().unwrap_or_default();
        Self {
            turn_deg: turns.sum::<f64>().to_degrees(),
            height_change_m: heights.clone().fold(f64::MIN, f64::max) - heights.fold(f64::MAX, f64::min),
            occluded_share: hidden as f64 / frames.visible.len().max(1) as f64,
            speed_mps: if duration_s > 0.0 { steps.sum::<f64>() / duration_s } else { 0.0 },
            target_way_m: frames.feet.iter().map(|feet| (*feet - first).length()).fold(0.0, f64::max),
        }
    }

    /// Hard from any of [`HARD_FROM`] on, easy below all of [`EASY_BELOW`], otherwise medium. The paper only names
    /// "tight turns and height changes"; features and limits are cosfly's.
    pub fn difficulty(&self) -> Difficulty {
        let values = [self.turn_deg, self.height_change_m, self.occluded_share, self.speed_mps];
        if values.iter().zip(HARD_FROM).any(|(value, from)| *value >= from) {
            Difficulty::Hard
        } else if values.iter().zip(EASY_BELOW).all(|(value, below)| *value < below) {
            Difficulty::Easy
        } else {
            Difficulty::Medium
        }
    }

    /// Whether the target stays within half a metre of its first position.
    pub fn target_is_static(&self) -> bool {
        self.target_way_m < 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn features(turn_rad: f64, climb_m: f64) -> WindowFeatures {
        let expert: Vec<Pose> = (0..10)
            .map(|k| {
                Pose::looking_at(DVec3::new(0.6 * f64::from(k), 0.0, 20.0 + climb_m * f64::from(k) / 9.0), DVec3::ZERO)
            })
            .collect();
        let feet: Vec<DVec3> = (0..10).map(|k| DVec3::new(0.6 * f64::from(k), 0.0, 0.0)).collect();
        let heading: Vec<f64> = (0..10).map(|k| 3.0 + turn_rad * f64::from(k) / 9.0).collect();
        WindowFeatures::of(&WindowFrames {
            expert: &expert,
            feet: &feet,
            heading_rad: &heading,
            visible: &[1.0; 10],
            dt_s: 0.5,
        })
    }

    #[test]
    fn turns_and_climbs_make_a_window_harder() {
        for (turn_rad, climb_m, expected) in [
            (0.1, 0.0, Difficulty::Easy),
            (1.0, 0.0, Difficulty::Medium),
            (2.0, 0.0, Difficulty::Hard),
            (0.0, 3.0, Difficulty::Hard),
        ] {
            let found = features(turn_rad, climb_m);
            assert_eq!(found.difficulty(), expected, "{found:?}");
            assert!(!found.target_is_static() && (found.turn_deg - turn_rad.to_degrees()).abs() < 1e-9);
        }
    }

    #[test]
    fn nothing_at_all_does_not_panic() {
        let none = WindowFrames { expert: &[], feet: &[], heading_rad: &[], visible: &[], dt_s: 0.5 };
        assert!(WindowFeatures::of(&none).target_is_static());
    }
}
