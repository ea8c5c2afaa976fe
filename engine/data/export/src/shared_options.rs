//! Options that several formats have: part of their structs with `#[serde(flatten)]`, so that they are the same in all.

use cosfly_metrics::DeltaFrame;
use cosfly_schema::tables::{Column, DatasetItem, Windows};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pictures of some frames.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default)]
pub struct PictureOptions {
    /// Distance from one picture to the next, frames
    #[schemars(range(min = 1, max = 1_000_000))]
    pub every: usize,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self { every: 1 }
    }
}

/// Instructions.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default)]
pub struct InstructionOptions {
    /// Language of instructions
    pub language: InstructionLanguage,
}

/// Pictures of some frames, and instructions.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub struct PictureAndTextOptions {
    /// Pictures.
    #[serde(flatten)]
    pub pictures: PictureOptions,
    /// Instructions.
    #[serde(flatten)]
    pub instructions: InstructionOptions,
}

/// Language of instructions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InstructionLanguage {
    /// English
    #[default]
    En,
    /// Chinese
    Zh,
}

impl InstructionLanguage {
    /// Code of the language as captions have it.
    pub fn code(self) -> &'static str {
        match self {
            Self::En => "en",
            Self::Zh => "zh",
        }
    }

    /// An instruction that fits every target, be it a person or a vehicle, and one for a flight that follows nobody.
    pub fn plain_instruction(self, has_target: bool) -> &'static str {
        match (self, has_target) {
            (Self::En, true) => "Follow the target and keep it in view.",
            (Self::Zh, true) => "跟随目标，让它一直在画面里。",
            (Self::En, false) => "Fly the planned way.",
            (Self::Zh, false) => "按计划的路线飞行。",
        }
    }

    /// Column of table `windows` with the instructions in the language.
    pub fn of_windows(self) -> Column<DatasetItem, String> {
        match self {
            Self::En => Windows::instruction_en,
            Self::Zh => Windows::instruction_zh,
        }
    }
}

/// Increments from pose to pose.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default)]
pub struct IncrementOptions {
    /// Axes of increments
    pub frame: IncrementAxes,
}

/// Axes of increments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum IncrementAxes {
    /// The world: x east, y south, z up
    #[default]
    World,
    /// The body that moves: x ahead, y right, z up
    Body,
}

impl IncrementOptions {
    /// The axes as the metrics know them.
    pub fn delta_frame(&self) -> DeltaFrame {
        match self.frame {
            IncrementAxes::World => DeltaFrame::World,
            IncrementAxes::Body => DeltaFrame::Body,
        }
    }
}
