//! [`FacesAndPlates`]: what became of faces and number plates in a scan.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Faces and number plates in a scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FacesAndPlates {
    /// No people or plates: an empty place, a model made by hand.
    None,
    /// Faces and plates were removed or made unreadable.
    Removed,
    /// Some can be told: those who are shown have agreed, or the files stay with you.
    Readable,
}

impl FacesAndPlates {
    /// Words for a dataset's card.
    pub fn words(self) -> &'static str {
        match self {
            Self::None => "there were none",
            Self::Removed => "removed",
            Self::Readable => "readable",
        }
    }
}
