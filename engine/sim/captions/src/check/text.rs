//! The slot check of a text: its claims against facts of the trajectory.

use super::claims::mismatches;
use super::clothes::clothes_mismatch;
use super::labels::relabelled;
use super::script::script_mismatch;
use super::slot::{Slot, SlotMismatch};
use crate::facts::{Facts, Wear};
use cosfly_claims::Language;
use cosfly_claims::{Claim, chinese, english, time_of_first_turn, without_marks};

/// Compares every number, direction, turn and stop that a text claims with the facts.
///
/// A text must name a distance and a pitch; whatever else it claims must be true to the step in [`crate::precision`]. Clothes
/// are judged where the facts know them. The first direction is where the walk sets out, a second one where it ends. Listed
/// turns must be all turns, in order; a doubtful one may stand among them or not. The text must be in the script of its language.
///
/// # Errors
/// All disagreements, in the order of the text; missing slots come last.
pub fn check(text: &str, language: Language, facts: &Facts) -> Result<(), Vec<SlotMismatch>> {
    let claims = relabelled(listed_turns(claims_of(text, language)), facts);
    let mut all: Vec<SlotMismatch> = script_mismatch(text, language).into_iter().collect();
    all.extend(mismatches(&claims, facts));
    if all.is_empty() { Ok(()) } else { Err(all) }
}

/// Subjects that a text says something about, each once.
pub fn claimed(text: &str, language: Language) -> Vec<Slot> {
    let slot = |claim: Claim| match claim {
        Claim::Direction(_) => Slot::Direction,
        Claim::Distance(_) | Claim::Metres(_) => Slot::Distance,
        Claim::Altitude(_) => Slot::Altitude,
        Claim::Pitch(_) | Claim::Tilt(_) => Slot::Pitch,
        Claim::Way(_) => Slot::Way,
        Claim::Duration(_) | Claim::Seconds(_) => Slot::Duration,
        Claim::Speed(_) => Slot::Speed,
        Claim::Stops(_) | Claim::SomeStops | Claim::Times(_) => Slot::Stops,
        Claim::Standing(_) => Slot::Standing,
        Claim::Turn(_)
        | Claim::PerhapsTurn(_)
        | Claim::Turns(_)
        | Claim::TurnsOf(..)
        | Claim::NoTurns
        | Claim::Straight
        | Claim::TurnsSoon
        | Claim::TurnsLate
        | Claim::StopFirst(_) => Slot::Turns,
        Claim::Top(_)
        | Claim::Trousers(_)
        | Claim::Backpack
        | Claim::NoBackpack
        | Claim::Wears(_)
        | Claim::Shade { .. } => Slot::Clothes,
        Claim::Stays | Claim::Walks | Claim::StandsFor(_) => Slot::Walking,
        Claim::Unknown(_) => Slot::Number,
    };
    claims_of(text, language).into_iter().map(slot).collect::<std::collections::BTreeSet<_>>().into_iter().collect()
}

/// Compares what a text claims of the target's clothes alone, with the clothes.
///
/// # Errors
/// The first disagreement.
pub fn check_clothes(text: &str, language: Language, wear: Wear) -> Result<(), SlotMismatch> {
    claims_of(text, language).iter().find_map(|claim| clothes_mismatch(claim, &wear)).map_or(Ok(()), Err)
}

fn claims_of(text: &str, language: Language) -> Vec<Claim> {
    let text = without_marks(text);
    let mut claims = match language {
        Language::Zh => chinese::read(&text),
        Language::En => english::read(&text),
    };
    claims.extend(time_of_first_turn(&text, language));
    claims
}

/// Counts of turns to a side as a list, where the text lists others: `two left turns, then a right one`.
fn listed_turns(claims: Vec<Claim>) -> Vec<Claim> {
    if !claims.iter().any(|claim| matches!(claim, Claim::Turn(_))) {
        return claims;
    }
    let listed = |claim: Claim| match claim {
        Claim::TurnsOf(kind, count) if count <= 100 => vec![Claim::Turn(kind); count],
        other => vec![other],
    };
    claims.into_iter().flat_map(listed).collect()
}
