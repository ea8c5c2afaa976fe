//! A sentence, and what stands near a place in it.

use crate::lexicon::Concept;
use crate::token::Token;
use std::ops::Range;

/// Words over which a negation reaches.
const NEGATION_REACH: usize = 9;

/// The tokens of a sentence.
#[derive(Clone, Copy)]
pub(crate) struct Sentence<'a>(pub(crate) &'a [Token]);

impl Sentence<'_> {
    /// The concept at a place; `None` for numbers, marks, unknown words and places outside.
    pub(crate) fn concept(self, at: usize) -> Option<Concept> {
        self.0.get(at).and_then(Token::concept)
    }

    /// Places of the clause that a place is in.
    pub(crate) fn clause(self, at: usize) -> Range<usize> {
        let is_mark = |token: &Token| *token == Token::Comma;
        let start = self.0[..at].iter().rposition(is_mark).map_or(0, |mark| mark + 1);
        let end = self.0[at..].iter().position(is_mark).map_or(self.0.len(), |mark| at + mark);
        start..end
    }

    fn is_number(self, at: usize) -> bool {
        matches!(self.0[at], Token::Number(..))
    }

    /// The first of some concepts behind a place, within some words, before the next number and the end of the clause.
    pub(crate) fn behind(self, at: usize, reach: usize, is_such: &dyn Fn(Concept) -> bool) -> Option<usize> {
        let end = self.clause(at).end.min(at + 1 + reach);
        let open = (at + 1..end).take_while(|place| !self.is_number(*place));
        open.into_iter().find(|place| self.concept(*place).is_some_and(is_such))
    }

    /// The nearest of some concepts before a place, behind the number before and the start of the clause.
    pub(crate) fn before(self, at: usize, is_such: &dyn Fn(Concept) -> bool) -> Option<usize> {
        let mut open = (self.clause(at).start..at).rev().take_while(|place| !self.is_number(*place));
        open.find(|place| self.concept(*place).is_some_and(is_such))
    }

    /// The nearest of some concepts before a place, in the whole sentence.
    pub(crate) fn long_before(self, at: usize, is_such: &dyn Fn(Concept) -> bool) -> Option<usize> {
        (0..at).rev().find(|place| self.concept(*place).is_some_and(is_such))
    }

    /// Whether a negation reaches a place; a word between two statements and a backpack, which has its own, end its reach.
    pub(crate) fn is_denied(self, at: usize) -> bool {
        let start = self.clause(at).start.max(at.saturating_sub(NEGATION_REACH));
        let words = (start..at).rev().map(|place| self.concept(place));
        words
            .take_while(|concept| !matches!(concept, Some(Concept::And | Concept::Backpack)))
            .any(|concept| concept == Some(Concept::Not))
    }

    /// Whether some concept is in the sentence.
    pub(crate) fn has(self, is_such: impl Fn(Concept) -> bool) -> bool {
        self.0.iter().filter_map(Token::concept).any(is_such)
    }
}
