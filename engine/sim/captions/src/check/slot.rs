//! Subjects of claims, and disagreements about them.

use std::fmt;

/// Subject of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Slot {
    Language,
    Direction,
    Distance,
    Altitude,
    Pitch,
    Way,
    Duration,
    Speed,
    Stops,
    Standing,
    Turns,
    Walking,
    Clothes,
    Number,
    Things,
    Wording,
}

impl Slot {
    /// The name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Language => "language",
            Self::Direction => "direction",
            Self::Distance => "distance",
            Self::Altitude => "altitude",
            Self::Pitch => "pitch",
            Self::Way => "way",
            Self::Duration => "duration",
            Self::Speed => "speed",
            Self::Stops => "stops",
            Self::Standing => "time of standing",
            Self::Turns => "turns",
            Self::Walking => "walking",
            Self::Clothes => "clothes",
            Self::Number => "number",
            Self::Things => "things",
            Self::Wording => "wording",
        }
    }
}

/// One disagreement between a text and the facts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SlotMismatch {
    /// Subject of the claim.
    pub slot: Slot,
    /// Claim of the text.
    pub found: String,
    /// Fact of the trajectory.
    pub expected: String,
}

impl fmt::Display for SlotMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: the text says `{}`, the trajectory `{}`", self.slot.name(), self.found, self.expected)
    }
}
