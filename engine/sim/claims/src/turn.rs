//! Sides of turns.

use serde::{Deserialize, Serialize};

/// Side of a turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TurnKind {
    /// To the walker's left.
    Left,
    /// To the walker's right.
    Right,
    /// Back where it came from, by more than 135 degrees.
    Around,
}
