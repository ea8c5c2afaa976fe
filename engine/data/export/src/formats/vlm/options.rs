//! Options of `vlm`.

use crate::shared_options::{IncrementOptions, InstructionOptions};
use cosfly_windows::WindowShape;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of `vlm`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Options {
    #[serde(flatten)]
    pub(super) instructions: InstructionOptions,
    #[serde(flatten)]
    pub(super) increments: IncrementOptions,
    /// Flights that models see
    pub(super) input: Input,
    /// Sets of lines to write
    pub(super) sets: Sets,
    /// Number of frames that a model sees
    #[schemars(range(min = 1, max = 1_000_000))]
    pub(super) history: usize,
    /// Number of waypoints that a model predicts
    #[schemars(range(min = 1, max = 1_000_000))]
    pub(super) horizon: usize,
    /// Distance from one window to the next, frames
    #[schemars(range(min = 1, max = 1_000_000))]
    pub(super) stride: usize,
    /// Scale of boxes in texts
    pub(super) box_scale: BoxScale,
    /// Largest width of pictures, pixels; wider ones are made smaller
    #[schemars(range(min = 28, max = 65_535), title = "PIXELS")]
    pub(super) width_px: u32,
}

/// Width of pictures of which five and their texts fit into 2,048 tokens: 16 x 9 patches of 28 x 28 pixels at 16:9.
const WIDTH: u32 = 448;

impl Default for Options {
    fn default() -> Self {
        let WindowShape { history, horizon, stride } = WindowShape::default();
        Self {
            instructions: InstructionOptions::default(),
            increments: IncrementOptions::default(),
            input: Input::default(),
            sets: Sets::default(),
            history,
            horizon,
            stride,
            box_scale: BoxScale::default(),
            width_px: WIDTH,
        }
    }
}

impl Options {
    /// Shape of the windows.
    pub fn window(&self) -> WindowShape {
        WindowShape { history: self.history, horizon: self.horizon, stride: self.stride }
    }
}

/// Flights that models see.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Input {
    /// Perturbed flights: models learn the way back
    #[default]
    Perturbed,
    /// Experts' flights
    Expert,
    /// Both
    Mixed,
}

/// Sets of lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sets {
    /// Windows with waypoints
    #[default]
    Windows,
    /// Also: nested shares of the windows, windows without some inputs, texts to learn, pairs of accepted and refused texts
    Students,
}

impl Input {
    /// Whether models see a flight.
    pub fn shows(self, is_perturbed: bool) -> bool {
        match self {
            Self::Perturbed => is_perturbed,
            Self::Expert => !is_perturbed,
            Self::Mixed => true,
        }
    }

    /// The word of the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::Perturbed => "perturbed",
            Self::Expert => "expert",
            Self::Mixed => "mixed",
        }
    }
}

/// Scale of boxes in texts; families of models differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoxScale {
    /// Pixels of the pictures
    #[default]
    Pixels,
    /// Thousandths of width and height
    Thousandths,
}
