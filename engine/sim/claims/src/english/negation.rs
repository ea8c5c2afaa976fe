//! What an English negation denies.

use super::words::{LUGGAGE, NEGATIONS};

/// Whether a negation comes a few words before such a word.
pub(super) fn denied(words: &[&str], is_such: impl Fn(&str) -> bool) -> bool {
    (0..words.len()).filter(|at| is_such(words[*at])).any(|at| {
        // `never once does the walker stop`: what is denied ends the clause.
        let is_inverted =
            words[..at].iter().any(|it| ["does", "do", "did", "was", "were", "is", "has", "had", "will"].contains(it));
        let before = &words[at.saturating_sub(if is_inverted { 9 } else { 5 })..at];
        let negation = before.iter().rposition(|word| NEGATIONS.contains(word));
        negation.is_some_and(|from| !is_parted(&before[from..]))
    })
}

/// Whether a negation comes a few words before a place.
pub(super) fn is_denied_at(at: usize, words: &[&str]) -> bool {
    let before = &words[at.saturating_sub(6)..at];
    before.iter().rposition(|word| NEGATIONS.contains(word)).is_some_and(|from| !is_parted(&before[from..]))
}

/// Whether a denial ends before the word behind these words: `does not stop before it turns`.
pub(super) fn is_parted(between: &[&str]) -> bool {
    between.iter().any(|it| {
        [
            "before", "until", "till", "but", "then", "after", "when", "just", "and", "while", "with", "plus", "only",
            "else", "other", "further",
        ]
        .contains(it)
    }) || between.iter().any(|word| LUGGAGE.contains(word))
}
