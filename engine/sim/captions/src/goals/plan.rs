//! A goal before it has words, and in words.

use super::claim::{Claim, Said, Subject};
use crate::sight::OnSide;
use cosfly_claims::{Language, TurnKind};
use std::ops::Range;

/// Kind of goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Grain {
    /// One for the whole flight.
    Flight,
    /// One for a stretch.
    Step,
    /// Three lines, the last of which corrects the second.
    Dialogue,
    /// One that does not fit: one thing in it is not so.
    Negative,
}

impl Grain {
    /// All grains, in the order of the table.
    pub const ALL: [Self; 4] = [Self::Flight, Self::Step, Self::Dialogue, Self::Negative];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Step => "step",
            Self::Dialogue => "dialogue",
            Self::Negative => "negative",
        }
    }
}

/// A goal in one language.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Kind of goal.
    pub grain: Grain,
    /// Language of the lines.
    pub language: Language,
    /// Frames that the goal is about.
    pub frames: Range<usize>,
    /// Lines: the user's first, then by turns the pilot's and the user's.
    pub lines: Vec<String>,
    /// Claims of the user in the end; of a negative, one of the claims is false.
    pub said: Vec<Said>,
    /// Subject of the mistake of a negative, or of the corrected line of a dialogue.
    pub wrong: Option<Subject>,
}

/// Content of a goal, before it has words.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub grain: Grain,
    pub frames: Range<usize>,
    pub said: Vec<Said>,
    pub wrong: Option<Subject>,
    /// Claim that the pilot understands, for a dialogue.
    pub mistaken: Option<Claim>,
    /// Whether a dialogue is about one of two people.
    pub is_other_of_two: bool,
}

/// The other side.
pub(super) fn mirrored(kind: TurnKind) -> Option<TurnKind> {
    match kind {
        TurnKind::Left => Some(TurnKind::Right),
        TurnKind::Right => Some(TurnKind::Left),
        TurnKind::Around => None,
    }
}

/// The other side.
pub(super) fn other_side(side: OnSide) -> OnSide {
    match side {
        OnSide::Left => OnSide::Right,
        OnSide::Right => OnSide::Left,
    }
}
