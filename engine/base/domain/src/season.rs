//! [`Season`] of leaves and lawns.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Season of leaves and lawns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Season {
    /// Green leaves.
    Summer,
    /// Leaves turn, trees of a town one after the other.
    Autumn,
    /// Trees are bare but for evergreen ones, lawns are pale.
    Winter,
}

impl Season {
    /// All seasons.
    #[rustfmt::skip] // an entry per line
    pub const ALL: &[Self] = &[
        Self::Summer,
        Self::Autumn,
        Self::Winter,
    ];

    /// The season of a name, if there is one.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|season| season.name() == name)
    }

    /// The name in recipes and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Summer => "summer",
            Self::Autumn => "autumn",
            Self::Winter => "winter",
        }
    }
}
