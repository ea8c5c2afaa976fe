//! Things in English texts, by their words and by their place in a clause.

use super::english_words::{ADJECTIVES, BARE_PLACES, DETERMINERS, FUNCTION_WORDS, HARMLESS, PERSONS, PLACES, THINGS};
use crate::LUGGAGE;
use crate::english::clothes::{colour, is_garment};
use crate::english::is_of_a_walk;
use crate::english::numbers::is_numeral;
use crate::english::tokens::{Token, clauses};
use crate::english::units::is_unit;
use std::collections::BTreeSet;
use std::sync::LazyLock;

type Words = LazyLock<BTreeSet<&'static str>>;

static KNOWN_THINGS: Words = LazyLock::new(|| THINGS.split_whitespace().chain(PERSONS.split_whitespace()).collect());
/// Words for things of any kind, from a dictionary that sorts words by meaning.
static DICTIONARY: Words = LazyLock::new(|| {
    let lines = include_str!("wordnet_things.txt").lines().filter(|line| !line.starts_with('#'));
    lines.flat_map(str::split_whitespace).collect()
});
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
    if is_address(&words) {
        return vec![];
    }
    let is_named = |at: &usize| {
        (is_thing(words[*at]) && !is_verb(&words, *at) && !is_saying(&words, *at) && !is_likened(&words, *at))
            || is_aid(&words, *at)
    };
    // `officers are to follow`: who is told what to do is no part of the flight.
    let is_told = matches!(words[..], [_, "are" | "is", "to", ..] | [_, "shall" | "must" | "should", ..]);
    // `the glass inclined 40 degrees`: what is aimed is the camera, by whatever name.
    let is_aimed = words.iter().any(|word| ["degrees", "degree"].contains(word));
    let mut found: Vec<String> =
        (usize::from(is_told)..words.len()).filter(is_named).map(|at| words[at].to_owned()).collect();
    found.extend((1..words.len()).filter_map(|at| {
        let is_camera = is_aimed && ["the", "our", "your", "its"].contains(&words[at - 1]);
        unknown_thing(&words, at).filter(|word| !(is_camera && words[at] == word))
    }));
    found.dedup();
    found
}

/// `ladies and gentlemen`, `dear friend`: who is spoken to is no part of the flight.
fn is_address(words: &[&str]) -> bool {
    let is_called = |word: &str| in_singular(word, |it| PERSONS.split_whitespace().any(|person| person == it));
    let is_of_address =
        |word: &&str| is_called(word) || ["and", "dear", "my", "hello", "hi", "hey", "ok"].contains(word);
    !words.is_empty() && words.len() <= 4 && words.iter().all(is_of_address)
}

/// A word for a thing in the phrase that begins at a place, where the words before say that the thing is there. A word that the
/// dictionary lacks is none: what nobody knows contradicts nothing.
fn unknown_thing(words: &[&str], at: usize) -> Option<String> {
    if !is_introduced(words, at) || DETERMINERS.contains(&words[at]) || is_likened(words, at) || is_saying(words, at) {
        return None;
    }
    let is_end = |word: &str| word.is_empty() || (KNOWN_FUNCTION_WORDS.contains(word) && word != "of");
    let phrase = words[at..].iter().take(PHRASE).take_while(|word| !is_end(word));
    let phrase: Vec<&str> = phrase.copied().collect();
    // What stands before a garment or luggage says more of it: `corduroy trousers`.
    let is_clothed = phrase.iter().any(|word| is_garment(word) || in_singular(word, |it| LUGGAGE.contains(&it)));
    let mut things = phrase.iter().filter(|word| is_in_dictionary(word));
    things.next().filter(|_| !is_clothed).map(|word| (*word).to_owned())
}

/// Whether the words before a phrase bring something new: `a priest`, `past the pawn shop`, `carrying books`. What `the suspect`
/// and `our lens` name is known already: the target and the camera, by whatever name.
fn is_introduced(words: &[&str], at: usize) -> bool {
    let before = words[at - 1];
    // `7 bananas`: a number is no word.
    if BARE_PLACES.contains(&before) || before.is_empty() && !is_unit(words[at]) {
        return true;
    }
    let is_known = ["the", "their", "its", "your", "our", "my", "no", "any", "whose"].contains(&before);
    let of_place = || match words[..at - 1] {
        [.., place] if PLACES.contains(&place) => true,
        [.., one, other] => matches!((one, other), ("front", "of") | ("next" | "close", "to")),
        _ => false,
    };
    DETERMINERS.contains(&before) && (!is_known || of_place())
}

/// `stick to them like glue`, `as still as a statue`
fn is_likened(words: &[&str], at: usize) -> bool {
    let before = &words[at.saturating_sub(4)..at];
    before.contains(&"like") || matches!(before, [.., "as", "a" | "an" | "the"])
}

/// Words of a phrase in which a thing is looked for.
const PHRASE: usize = 4;

/// Whether the dictionary has a word as a thing, and it is no word of a walk, clothes or a camera.
fn is_in_dictionary(word: &str) -> bool {
    !is_harmless(word)
        && !is_of_a_walk(word)
        && colour(word).is_none()
        && !KNOWN_ADJECTIVES.contains(word)
        && (in_singular(word, |it| DICTIONARY.contains(it)) || is_person(word))
}

/// `postwoman`, `fishermen`
fn is_person(word: &str) -> bool {
    ["woman", "women", "man", "men"].iter().any(|end| word.strip_suffix(end).is_some_and(|stem| stem.len() > 2))
        && !word.ends_with("ment")
}

/// `train the camera on them`, `to bank left`: a verb by the words around it.
fn is_verb(words: &[&str], at: usize) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    let leads =
        ["", "to", "and", "then", "please", "you", "should", "must", "will", "can", "now", "kindly", "just", "they"];
    let objects = ["the", "your", "it", "them", "a", "an", "left", "right", "on", "their", "that", "this", "around"];
    // `covering 40 m`
    words[at].ends_with("ing") && words.get(at + 1) == Some(&"")
        || leads.contains(&before) && words.get(at + 1).is_some_and(|next| objects.contains(next))
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
    match words[at] {
        "station" => ["hold", "holds", "holding", "keep", "on"].contains(&before),
        "morning" | "afternoon" | "evening" | "day" => before == "good",
        // `tilted towards the clouds` says of the camera that it looks up.
        "cloud" | "clouds" | "star" | "stars" | "pavement" | "grass" => {
            words.iter().any(|word| word.starts_with("degree"))
                && words[at.saturating_sub(3)..at].iter().any(|it| ["to", "at", "toward", "towards"].contains(it))
        }
        "steps" => {
            before == "their" || words.iter().any(|it| ["take", "takes", "taken", "taking", "made"].contains(it))
        }
        // `that is a wrap`: the filming is over.
        "wrap" => words[at.saturating_sub(3)..at].iter().any(|it| it.starts_with("that")),
        // `our friend` is who is followed.
        "friend" | "friends" => ["our", "your", "my"].contains(&before),
        _ => false,
    }
}

fn is_thing(word: &str) -> bool {
    in_singular(word, |it| KNOWN_THINGS.contains(it)) && !is_garment(word)
}

fn is_harmless(word: &str) -> bool {
    in_singular(word, |it| KNOWN_HARMLESS.contains(it)) || is_garment(word)
}

/// Whether a word or its singular is such a word.
fn in_singular(word: &str, is_such: impl Fn(&str) -> bool) -> bool {
    let singular = |ending: &str, instead: &str| {
        word.strip_suffix(ending).is_some_and(|stem| stem.len() > 1 && is_such(&format!("{stem}{instead}")))
    };
    is_such(word) || singular("s", "") || singular("es", "") || singular("ies", "y") || singular("ves", "f")
}
