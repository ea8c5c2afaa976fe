//! The slot check of a text: its claims against facts of the trajectory.

use super::claims::mismatches;
use super::clothes::clothes_mismatch;
use super::script::script_mismatch;
use super::slot::{Slot, SlotMismatch};
use crate::facts::{Facts, Wear};
use cosfly_claims::{Claim, Language, read};
use std::collections::BTreeSet;

/// Compares every number, direction, turn and stop that a text claims with the facts.
///
/// A text must name a distance and a pitch; whatever else it claims must be true to the step in [`crate::precision`]. Clothes
/// are judged where the facts know them. The first direction is where the walk sets out, a second one where it ends. Listed
/// turns must be all turns, in order; a doubtful one may stand among them or not. The text must be in the script of its language.
/// Words that the reader's lexicon lacks say nothing; a number that it cannot place is refused.
///
/// # Errors
/// All disagreements, in the order of the text; missing slots come last.
pub fn check(text: &str, language: Language, facts: &Facts) -> Result<(), Vec<SlotMismatch>> {
    let mut all: Vec<SlotMismatch> = script_mismatch(text, language).into_iter().collect();
    all.extend(mismatches(&read(text, language), facts));
    if all.is_empty() { Ok(()) } else { Err(all) }
}

/// Subjects that a text says something about, each once.
pub fn claimed(text: &str, language: Language) -> Vec<Slot> {
    let slots: BTreeSet<Slot> = read(text, language).iter().map(slot).collect();
    slots.into_iter().collect()
}

fn slot(claim: &Claim) -> Slot {
    match claim {
        Claim::Direction(_) => Slot::Direction,
        Claim::Distance(_) => Slot::Distance,
        Claim::Altitude(_) => Slot::Altitude,
        Claim::Pitch(_) => Slot::Pitch,
        Claim::Way(_) => Slot::Way,
        Claim::Duration(_) => Slot::Duration,
        Claim::Speed(_) => Slot::Speed,
        Claim::Stops(_) | Claim::SomeStops => Slot::Stops,
        Claim::Standing(_) => Slot::Standing,
        Claim::Turn(_) | Claim::Turns(_) | Claim::TurnsOf(..) | Claim::NoTurns | Claim::Straight => Slot::Turns,
        Claim::TurnsSoon | Claim::TurnsLate => Slot::Turns,
        Claim::Top(_) | Claim::Trousers(_) | Claim::Backpack(_) => Slot::Clothes,
        Claim::Stays | Claim::Walks | Claim::Runs => Slot::Walking,
        Claim::Unknown(_) => Slot::Number,
    }
}

/// Compares what a text claims of the target's clothes alone, with the clothes.
///
/// # Errors
/// The first disagreement.
pub fn check_clothes(text: &str, language: Language, wear: Wear) -> Result<(), SlotMismatch> {
    read(text, language).iter().find_map(|claim| clothes_mismatch(claim, &wear)).map_or(Ok(()), Err)
}
