//! Colours of garments.

use crate::claim::Claim;
use crate::lexicon::Concept;
use crate::sentence::Sentence;
use cosfly_domain::Colour;

/// Words between a colour and its garment: `a red long-sleeved cotton shirt`.
const REACH: usize = 3;

/// The claim of a colour at a place: of the garment behind it, or of the one that it is said of. Another colour ends the search.
pub(crate) fn colour(sentence: Sentence<'_>, at: usize, colour: Colour) -> Option<Claim> {
    let clause = sentence.clause(at);
    let garment = |place: usize| match sentence.concept(place) {
        Some(Concept::Top) => Some(Claim::Top(colour)),
        Some(Concept::Trousers) => Some(Claim::Trousers(colour)),
        _ => None,
    };
    let is_open = |place: &usize| !matches!(sentence.concept(*place), Some(Concept::Colour(_) | Concept::And));
    let behind = (at + 1..clause.end).take(REACH + 1).take_while(is_open).find_map(garment);
    behind.or_else(|| (clause.start..at).rev().take_while(is_open).find_map(garment))
}
