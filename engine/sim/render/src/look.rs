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

impl PictureLook {
    /// Both looks, by name.
    pub const ALL: [(&'static str, Self); 2] = [("simple", Self::Simple), ("full", Self::Full)];

    /// The look of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find_map(|(known, look)| (known == name).then_some(look))
    }

    /// The name of the look.
    pub fn name(self) -> &'static str {
        match self {
            Self::Simple => "simple",
            Self::Full => "full",
        }
    }
}
