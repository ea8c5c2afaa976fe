//! Looks of the colours of pictures.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Look of the colours of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PictureLook {
    /// Sun and shadows, light of the sky between houses, textures, wetness, puddles and rain, lamps, smooth edges.
    Full,
    /// Plain colours and windows, light of the sun and the open sky, haze; no shadows, textures or smooth edges.
    Simple,
}
