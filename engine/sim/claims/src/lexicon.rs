//! Words of a language by their concepts, read from a file in `words/`.

use crate::compass::Compass;
use crate::language::Language;
use crate::turn::TurnKind;
use cosfly_domain::Colour;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Meaning of a phrase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Concept {
    /// A number in words, or a part of one: `twenty`, `hundred`, `百`.
    Number(usize),
    /// Point of a number in words.
    Point,
    /// Number of times: `twice`.
    Repeated(usize),
    Metres,
    Seconds,
    Minutes,
    Degrees,
    /// Unit metres per second.
    Speed,
    /// Before a number of metres, which is a speed then.
    EachSecond,
    /// Unit of counts: `times`, `次`.
    Times,
    /// Near a length: distance of the drone.
    Away,
    /// Before a length: distance of the drone.
    At,
    /// Near a length: height of the drone.
    Above,
    /// Near a length: way of the target.
    Way,
    /// Near a time: of the whole flight.
    Time,
    Down,
    Up,
    Level,
    Walks,
    Runs,
    Stands,
    Stop,
    Straight,
    /// A turn without its side.
    Turning,
    /// A turn with its side in one phrase.
    Turn(TurnKind),
    /// A side, which is a turn near a word of turning or in a list of turns.
    Side(TurnKind),
    Soon,
    Late,
    Not,
    /// A word between two statements, beyond which no negation reaches.
    And,
    Direction(Compass),
    Colour(Colour),
    Top,
    Trousers,
    Backpack,
    /// Something that no facts of a flight have.
    Thing,
    /// A phrase that says nothing.
    Other,
}

/// Phrases of a language by their first word, longer ones first. A word is a character in Chinese.
#[derive(Debug)]
pub(crate) struct Lexicon(BTreeMap<String, Vec<(Vec<String>, Concept)>>);

impl Lexicon {
    /// The lexicon of a language.
    pub(crate) fn of(language: Language) -> &'static Self {
        static ALL: [OnceLock<Lexicon>; Language::ALL.len()] = [const { OnceLock::new() }; Language::ALL.len()];
        let read = || Self::parse(language.words()).expect("the lexicon is well formed: a test reads it");
        ALL[language as usize].get_or_init(read)
    }

    /// Reads lines `concept: phrase, phrase`; empty lines and lines that begin with `#` say nothing.
    fn parse(text: &str) -> Result<Self, String> {
        let mut phrases: BTreeMap<String, Vec<(Vec<String>, Concept)>> = BTreeMap::new();
        for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
            let (name, list) = line.split_once(": ").ok_or_else(|| format!("no concept in `{line}`"))?;
            let concept = concept(name).ok_or_else(|| format!("unknown concept `{name}`"))?;
            for phrase in list.split(", ") {
                let words = words_of(phrase);
                let first = words.first().ok_or_else(|| format!("an empty phrase in `{line}`"))?;
                let same = phrases.entry(first.clone()).or_default();
                if same.iter().any(|(known, _)| *known == words) {
                    return Err(format!("`{phrase}` has two concepts"));
                }
                same.push((words, concept));
            }
        }
        phrases.values_mut().for_each(|same| same.sort_by_key(|(words, _)| std::cmp::Reverse(words.len())));
        Ok(Self(phrases))
    }

    /// The longest phrase at the start of some words: its concept and number of words.
    pub(crate) fn find(&self, words: &[String]) -> Option<(Concept, usize)> {
        let first = words.first()?;
        let listed = self.0.get(first).and_then(|same| same.iter().find(|(phrase, _)| words.starts_with(phrase)));
        let is_thing = || {
            let is_one = |word: &String| {
                self.0.get(word).is_some_and(|same| same.contains(&(vec![word.clone()], Concept::Thing)))
            };
            singulars(first).iter().any(is_one)
        };
        let listed = listed.map(|(phrase, concept)| (*concept, phrase.len()));
        listed.or_else(|| is_thing().then_some((Concept::Thing, 1)))
    }
}

/// Words that an English plural may be of.
fn singulars(word: &str) -> Vec<String> {
    let endings = [("s", ""), ("es", ""), ("ies", "y"), ("ves", "f"), ("men", "man")];
    let of = |(plural, singular): (&str, &str)| word.strip_suffix(plural).map(|stem| format!("{stem}{singular}"));
    endings.into_iter().filter_map(of).collect()
}

/// The words of a phrase: runs of letters that are not Chinese, and single Chinese characters.
pub(crate) fn words_of(phrase: &str) -> Vec<String> {
    let mut words: Vec<String> = vec![];
    let mut is_open = false;
    for c in phrase.chars() {
        let goes_on = !is_chinese(c) && c != ' ';
        match words.last_mut() {
            Some(last) if is_open && goes_on => last.push(c),
            _ if c != ' ' => words.push(c.to_string()),
            _ => {}
        }
        is_open = goes_on;
    }
    words
}

/// Whether a character is a word of its own.
pub(crate) fn is_chinese(c: char) -> bool {
    ('\u{4e00}'..='\u{9fff}').contains(&c)
}

fn concept(name: &str) -> Option<Concept> {
    let (name, value) = name.split_once(' ').unwrap_or((name, ""));
    let side = || match value {
        "left" => Some(TurnKind::Left),
        "right" => Some(TurnKind::Right),
        "around" => Some(TurnKind::Around),
        _ => None,
    };
    Some(match name {
        "number" => Concept::Number(value.parse().ok()?),
        "times" if !value.is_empty() => Concept::Repeated(value.parse().ok()?),
        "turn" => Concept::Turn(side()?),
        "side" => Concept::Side(side()?),
        "direction" => Concept::Direction(Compass::ALL.into_iter().find(|it| it.english() == value)?),
        "colour" => Concept::Colour(Colour::ALL.into_iter().find(|it| it.name() == value)?),
        name => plain_concept(name)?,
    })
}

fn plain_concept(name: &str) -> Option<Concept> {
    const NAMES: [(&str, Concept); 31] = [
        ("point", Concept::Point),
        ("metres", Concept::Metres),
        ("seconds", Concept::Seconds),
        ("minutes", Concept::Minutes),
        ("degrees", Concept::Degrees),
        ("speed", Concept::Speed),
        ("each_second", Concept::EachSecond),
        ("times", Concept::Times),
        ("away", Concept::Away),
        ("at", Concept::At),
        ("above", Concept::Above),
        ("way", Concept::Way),
        ("time", Concept::Time),
        ("down", Concept::Down),
        ("up", Concept::Up),
        ("level", Concept::Level),
        ("walks", Concept::Walks),
        ("runs", Concept::Runs),
        ("stands", Concept::Stands),
        ("stop", Concept::Stop),
        ("straight", Concept::Straight),
        ("turning", Concept::Turning),
        ("soon", Concept::Soon),
        ("late", Concept::Late),
        ("not", Concept::Not),
        ("and", Concept::And),
        ("top", Concept::Top),
        ("trousers", Concept::Trousers),
        ("backpack", Concept::Backpack),
        ("thing", Concept::Thing),
        ("other", Concept::Other),
    ];
    NAMES.iter().find(|(known, _)| *known == name).map(|(_, concept)| *concept)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_are_well_formed_and_the_longest_phrase_counts() {
        for language in Language::ALL {
            assert!(Lexicon::of(*language).0.len() > 200);
        }
        let find = |language, text: &str| Lexicon::of(language).find(&words_of(text));
        assert_eq!(find(Language::En, "turns around here"), Some((Concept::Turn(TurnKind::Around), 2)));
        assert_eq!(find(Language::En, "turns left"), Some((Concept::Turning, 1)));
        assert_eq!(find(Language::En, "lorries"), Some((Concept::Thing, 1)));
        assert_eq!(find(Language::En, "pedestrian"), None);
        assert_eq!(find(Language::Zh, "左右两侧"), Some((Concept::Other, 2)));
        assert_eq!(find(Language::Zh, "左转弯"), Some((Concept::Turn(TurnKind::Left), 3)));
    }

    #[test]
    fn a_line_that_means_nothing_is_refused() {
        for (line, why) in [
            ("stop", "no concept in `stop`"),
            ("stopp: halt", "unknown concept `stopp`"),
            ("colour puce: puce", "unknown concept `colour puce`"),
            ("stop: , halt", "an empty phrase in `stop: , halt`"),
            ("stop: halt\nturning: halt", "`halt` has two concepts"),
        ] {
            assert_eq!(Lexicon::parse(line).unwrap_err(), why);
        }
    }
}
