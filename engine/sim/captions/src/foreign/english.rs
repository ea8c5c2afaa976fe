//! Things in English texts, by their words and by their place in a clause.

use super::english_words::{
    ABSTRACT_ENDINGS, ADJECTIVE_ENDINGS, ADJECTIVES, BARE_PLACES, DETERMINERS, FUNCTION_WORDS, HARMLESS, PERSONS,
    THINGS,
};
use crate::reading::english::{Token, clauses, colour, is_garment, is_numeral};
use std::collections::BTreeSet;
use std::sync::LazyLock;

type Words = LazyLock<BTreeSet<&'static str>>;

static KNOWN_THINGS: Words = LazyLock::new(|| THINGS.split_whitespace().chain(PERSONS.split_whitespace()).collect());
static KNOWN_HARMLESS: Words = LazyLock::new(|| HARMLESS.split_whitespace().collect());
static KNOWN_ADJECTIVES: Words = LazyLock::new(|| ADJECTIVES.split_whitespace().collect());
static KNOWN_FUNCTION_WORDS: Words = LazyLock::new(|| FUNCTION_WORDS.split_whitespace().collect());

/// Words that name a thing, and the first word of each phrase in the place of a thing that is no word of a walk.
pub fn foreign_things(text: &str) -> Vec<String> {
    clauses(text).iter().flat_map(|clause| in_clause(clause)).collect()
}

fn in_clause<'c>(clause: &'c [Token]) -> Vec<String> {
    // A number is no word, in digits or in words.
    let word = |token: &'c Token| match token {
        Token::Word(word) if !is_numeral(word) => word.as_str(),
        _ => "",
    };
    let words: Vec<&str> = clause.iter().map(word).collect();
    let is_named = |at: &usize| (is_thing(words[*at]) && !is_saying(&words, *at)) || is_aid(&words, *at);
    let mut found: Vec<String> = (0..words.len()).filter(is_named).map(|at| words[at].to_owned()).collect();
    found.extend((1..words.len()).filter_map(|at| unknown_thing(&words, at)));
    found.dedup();
    found
}

/// The head of a phrase that begins at a place, where it is in the place of a thing and no word of a walk.
fn unknown_thing(words: &[&str], at: usize) -> Option<String> {
    let before = words[at - 1];
    let is_determined = DETERMINERS.contains(&before);
    let is_placed = BARE_PLACES.contains(&before);
    if !(is_determined || is_placed) || DETERMINERS.contains(&words[at]) {
        return None;
    }
    let is_open = |word: &&&str| !is_adjective(word) || is_thing(word);
    let head = words[at..].iter().find(is_open)?;
    let is_known = head.is_empty()
        || colour(head).is_some()
        || is_harmless(head)
        || KNOWN_FUNCTION_WORDS.contains(head)
        || is_thing(head)
        || has_ending(head, &ABSTRACT_ENDINGS)
        // `in following`, `by turning`: what is done, not where.
        || (!is_determined && head.ends_with("ing"));
    (!is_known).then(|| (*head).to_owned())
}

/// `a walking stick`, `the park`: things of words that are none in other places.
fn is_aid(words: &[&str], at: usize) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    let is_place = ["the", "a", "through", "in", "by", "city", "parks", "nearby"].contains(&before);
    before == "walking" && ["frame", "stick", "aid"].contains(&words[at])
        || words[at] == "park" && is_place
        || words[at] == "couple" && words.get(at + 1) != Some(&"of")
}

/// `hold station`: words that name a thing in other places only.
fn is_saying(words: &[&str], at: usize) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    words[at] == "station" && ["hold", "holds", "holding", "keep", "on"].contains(&before)
}

fn is_thing(word: &str) -> bool {
    in_singular(word, |it| KNOWN_THINGS.contains(it)) && !is_garment(word)
}

fn is_harmless(word: &str) -> bool {
    in_singular(word, |it| KNOWN_HARMLESS.contains(it)) || is_garment(word)
}

fn is_adjective(word: &str) -> bool {
    !is_harmless(word) && (KNOWN_ADJECTIVES.contains(word) || has_ending(word, &ADJECTIVE_ENDINGS))
}

fn has_ending(word: &str, endings: &[&str]) -> bool {
    word.len() > 4 && endings.iter().any(|ending| word.ends_with(ending))
}

/// Whether a word or its singular is such a word.
fn in_singular(word: &str, is_such: impl Fn(&str) -> bool) -> bool {
    let singular = |ending: &str, instead: &str| {
        word.strip_suffix(ending).is_some_and(|stem| stem.len() > 1 && is_such(&format!("{stem}{instead}")))
    };
    is_such(word) || singular("s", "") || singular("es", "") || singular("ies", "y") || singular("ves", "f")
}
