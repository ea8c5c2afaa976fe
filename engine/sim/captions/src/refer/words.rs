//! Referring phrases in words.

use super::phrase::Phrase;
use super::{chinese, english};
use cosfly_claims::Language;

/// A phrase in words, such as `the person in a red top, walking`.
pub fn text(phrase: &Phrase, language: Language) -> String {
    match language {
        Language::Zh => chinese::text(phrase),
        Language::En => english::text(phrase),
    }
}
