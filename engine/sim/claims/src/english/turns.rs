//! Turns, straight ways and compass directions in English clauses.

use super::idioms::{is_of_the_drone, is_right_of_no_turn};
use super::negation::denied;
use super::numbers::number_word;
use super::tokens::Token;
use super::words::TURN_STEMS;
use crate::compass::Compass;
use crate::turn::TurnKind;

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
        "l" => Some(TurnKind::Left),
        "r" => Some(TurnKind::Right),
        "around" => Some(TurnKind::Around),
        "round" => None,
        _ if AROUND.iter().any(|stem| word.starts_with(stem)) => Some(TurnKind::Around),
        _ => None,
    }
}

/// Whether a word of a side at a place is a turn to it: `the right distance`, `left the spot` and `around 25 m` are none.
pub(super) fn is_side(at: usize, words: &[&str]) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    let next = words.get(at + 1).copied().unwrap_or_default();
    let is_told = || {
        ["is", "are", "was", "were", "be"].contains(&before)
            && (at == 1 || words[..at].iter().any(|word| is_of_turns(word)))
    };
    let follows = turn_word(before).is_some() || is_told();
    match words[at] {
        "left" => {
            let is_verb =
                ["the", "their", "its", "it", "level", "flat", "horizontal", "alone", "pointing"].contains(&next);
            !is_verb && (follows || !NEVER_LEFT.contains(&before))
        }
        "right" if ["round", "around"].contains(&next) => false,
        "right" => follows || ["a", "another"].contains(&before) || !is_right_of_no_turn(at, words),
        "around" | "round" => follows || is_turned_around(at, words),
        _ => true,
    }
}

/// `turns: none`, `the number of turns was zero`
pub(super) fn counts_no_turns(words: &[&str]) -> bool {
    let turn = words.iter().position(|word| is_turning(word));
    turn.is_some_and(|turn| words[turn..].iter().take(4).any(|it| ["zero", "none", "nil", "nought"].contains(it)))
}

fn is_of_turns(word: &str) -> bool {
    is_turning(word) || ["order", "sequence", "direction", "directions"].contains(&word)
}

/// Words behind which `left` is a verb.
const NEVER_LEFT: [&str; 19] = [
    "is", "are", "has", "be", "have", "had", "they", "them", "nothing", "was", "were", "never", "who", "been", "being",
    "gimbal", "camera", "lens", "person",
];

/// Whether `around` at a place is a turn and no amount or place.
fn is_turned_around(at: usize, words: &[&str]) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    let next = words.get(at + 1).copied();
    let is_amount = next == Some("") && !words.get(at + 2).is_some_and(|it| it.starts_with("time"));
    let turns = [
        "turns",
        "turn",
        "turning",
        "turned",
        "spun",
        "then",
        "",
        "wheels",
        "spins",
        "swings",
        "next",
        "later",
        "finally",
        "first",
        "by",
        "swing",
        "swung",
        "wheel",
        "spin",
        "right",
        "lastly",
        "afterwards",
        "again",
    ];
    let stays = [
        "all", "way", "stand", "stands", "standing", "stood", "hanging", "waiting", "hang", "hangs", "walk", "walks",
        "look", "looks", "is", "are",
    ];
    let ends =
        next.is_none() || ["and", "or", "then", "once", "twice", "again", "followed"].iter().any(|it| next == Some(it));
    !is_amount && (turns.contains(&before) || ends && !stays.contains(&before))
}

/// Beginnings of words for a turn around.
const AROUND: [&str; 13] = [
    "uturn",
    "aboutturn",
    "aboutface",
    "turnaround",
    "turnabout",
    "reversal",
    "revers",
    "backtrack",
    "retrac",
    "volteface",
    "oneeighty",
    "halfturn",
    "doubleback",
];

/// Whether a word speaks of leaving a straight line.
pub(super) fn is_turning(word: &str) -> bool {
    TURN_STEMS.iter().any(|stem| word.starts_with(stem))
        && !["cornered", "turnstile", "turnstiles", "turnpike"].contains(&word)
        || ["uturn", "uturns", "aboutturn"].contains(&word)
}

/// `turns tail`, `doubles back`, `head back the other way`
pub(super) fn turns_back(at: usize, words: &[&str]) -> bool {
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    let next = words.get(at + 1).copied().unwrap_or_default();
    let is_of = |stems: &[&str]| stems.iter().any(|stem| before.starts_with(stem));
    match words[at] {
        "round" if before == "right" => true,
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
        // `reversed direction twice`
        [Token::Word(object), rest @ ..] if ["direction", "course"].contains(&object.as_str()) => repetitions(rest),
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
