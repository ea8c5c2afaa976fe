//! Choices of an evaluation.

use cosfly_metrics::baselines::Anchor;
use cosfly_metrics::{DeltaFrame, DeltaOrigin, bootstrap};
use cosfly_windows::WindowShape;
use serde::Serialize;

/// Flights that models see.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum InputRole {
    /// Perturbed flights; the truth is their expert's.
    Perturbed,
    /// Experts' flights; the truth is their own.
    Expert,
}

/// Choices; all of them are written into the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Settings {
    /// Lengths and stride of windows, frames.
    pub window: WindowShape,
    /// Axes of the increments.
    pub delta_frame: DeltaFrame,
    /// Pose that each increment starts from.
    pub delta_origin: DeltaOrigin,
    /// Pose that the first increment starts from.
    pub anchor: Anchor,
    /// Flights that models see.
    pub input: InputRole,
    /// The splits to score; empty: those of the predicted flights, without predictions val and test.
    pub splits: Vec<String>,
    /// The cameras to score, of datasets with several; empty: those of the predicted flights, without predictions all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cameras: Vec<String>,
    /// Windows without a prediction are scored as if all increments were zero.
    pub missing_as_zero: bool,
    /// Resamples behind an interval.
    pub resamples: usize,
    /// Seed of the resamples.
    pub seed: u64,
}

impl Settings {
    /// Whether the films of a camera are scored.
    pub fn takes(&self, camera: Option<&str>) -> bool {
        self.cameras.is_empty() || camera.is_some_and(|camera| self.cameras.iter().any(|it| it == camera))
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            window: WindowShape::default(),
            delta_frame: DeltaFrame::World,
            delta_origin: DeltaOrigin::Previous,
            anchor: Anchor::Input,
            input: InputRole::Perturbed,
            splits: vec![],
            cameras: vec![],
            missing_as_zero: false,
            resamples: bootstrap::RESAMPLES,
            seed: 1,
        }
    }
}
