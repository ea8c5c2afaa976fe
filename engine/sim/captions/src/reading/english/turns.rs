//! Turns, straight ways and compass directions in English clauses.

use super::idioms::is_of_the_drone;
use super::negation::denied;
use super::numbers::number_word;
use super::tokens::Token;
use super::words::TURN_STEMS;
use crate::compass::Compass;
use crate::turns::TurnKind;

pub(super) fn turn_word(word: &str) -> Option<TurnKind> {
    let is_of = |side: &str| {
        word.strip_prefix(side)
            .is_some_and(|rest| ["hand", "ward", "turn", "hook"].iter().any(|it| rest.starts_with(it)))
    };
    match word {
        _ if is_of("left") => Some(TurnKind::Left),
        _ if is_of("right") => Some(TurnKind::Right),
        "left" | "leftward" | "leftwards" | "lefts" | "lefthand" => Some(TurnKind::Left),
        "right" | "rightward" | "rightwards" | "rights" | "righthand" => Some(TurnKind::Right),
        "around" | "uturn" | "uturns" => Some(TurnKind::Around),
        _ => None,
    }
}

/// Whether a word speaks of leaving a straight line.
pub(super) fn is_turning(word: &str) -> bool {
    TURN_STEMS.iter().any(|stem| word.starts_with(stem))
        && !["turned", "cornered", "turnstile", "turnstiles", "turnpike"].contains(&word)
        || ["uturn", "uturns", "aboutturn"].contains(&word)
}

/// `turns tail`, `doubles back`, `head back the other way`
pub(super) fn turns_back(at: usize, words: &[&str]) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    let next = words.get(at + 1).copied().unwrap_or_default();
    let is_of = |stems: &[&str]| stems.iter().any(|stem| before.starts_with(stem));
    match words[at] {
        "round" | "tail" => is_of(&["turn", "spin", "wheel", "swing", "swivel"]),
        "back"
            if is_of(&[
                "turn", "doubl", "head", "go", "goes", "went", "came", "walk", "com", "track", "trek", "start", "set",
                "circl", "loop",
            ]) =>
        {
            let is_way = || words[at..].iter().any(|it| ["way", "came", "themselves"].contains(it));
            let is_origin = next == "to" && words.get(at + 2) == Some(&"where");
            is_origin || !["to", "left", "right", "from", "of", "at"].contains(&next) && (next != "the" || is_way())
        }
        "heel" | "heels" => {
            let turns =
                |word: &&str| ["turn", "spin", "wheel", "swivel", "pivot"].iter().any(|it| word.starts_with(it));
            words[at.saturating_sub(3)..at].iter().any(turns)
        }
        "way" => before == "other" && !words[..at].contains(&"back"),
        _ => false,
    }
}

/// How often the turn before these tokens is made: `twice`, `three times`, or once.
pub(super) fn repetitions(after: &[Token]) -> usize {
    match after {
        [Token::Word(word), ..] if word == "twice" => 2,
        [Token::Word(turn), Token::Word(word), ..] if turn.starts_with("turn") && word == "twice" => 2,
        [Token::Word(number), Token::Word(times), ..] if times == "times" => {
            number_word(number).map_or(1, |number| number as usize)
        }
        [Token::Number(number), Token::Word(times), ..] if times == "times" => *number as usize,
        _ => 1,
    }
}

/// `holds the same heading`, `straight on`: a direction that does not change.
pub(super) fn keeps_direction(words: &[&str]) -> bool {
    let same =
        ["same", "one", "single", "constant", "fixed", "unchanged", "unchanging", "consistent", "steady", "unaltered"];
    let way = ["direction", "heading", "course", "bearing", "line"];
    let is_same = || words.iter().any(|it| same.contains(it));
    !is_of_the_drone(words) && words.iter().any(|it| way.contains(it)) && is_same()
        || denied(words, |word| matches!(word, "direction" | "course" | "heading"))
            && words
                .iter()
                .any(|it| ["change", "changes", "changing", "alter", "alters", "altering", "switch"].contains(it))
}

pub(super) fn compass_word(word: &str) -> Option<Compass> {
    let stem = ["wards", "ward", "bound", "facing", "erly", "ern"]
        .iter()
        .find_map(|ending| word.strip_suffix(ending))
        .unwrap_or(word);
    Some(match stem {
        "east" => Compass::East,
        "southeast" => Compass::Southeast,
        "south" => Compass::South,
        "southwest" => Compass::Southwest,
        "west" => Compass::West,
        "northwest" => Compass::Northwest,
        "north" => Compass::North,
        "northeast" => Compass::Northeast,
        _ => return None,
    })
}
