//! English texts, clause by clause: words and numbers become claims.

use super::clothes::{both_garments, clothes_claim};
use super::idioms::{is_of_a_view, is_of_the_drone, is_of_the_gap, without_idioms};
use super::negation::{denied, is_denied_at};
use super::numbers::{fold_numbers, number_word};
use super::pauses::{
    denies_motion, is_stop, is_time_alone, keeps_place, order_of_stop_and_turn, pauses_denied, stands_repeatedly,
    stays_put,
};
use super::quantities::{aim, is_level, quantity};
use super::tokens::{Token, clauses, word_of};
use super::turns::{
    compass_word, counts_no_turns, is_side, is_turning, keeps_direction, repetitions, turn_word, turns_back,
};
use super::units::is_unit;
use super::words::{GOES_ON, LUGGAGE, MOTION, NEGATIONS, STANDS, UNTURNED, WALKS};
use crate::turn::TurnKind;
use crate::{Claim, count, sentences, stands_for, with_level_view};

/// Everything that the text claims, in order.
pub fn read(text: &str) -> Vec<Claim> {
    let sentence = |sentence: &str| {
        let mut after_stop = false;
        let parts = clauses(sentence);
        // `Right, here is the shot`: a word of its own that begins a sentence is no side.
        let begins = |clause: &[Token]| matches!(clause, [Token::Word(word)] if word == "right");
        let is_call = parts.first().is_some_and(|it| begins(it))
            && parts
                .get(1)
                .and_then(|it| it.first())
                .is_some_and(|it| !["then", "left", "right", "and", "next"].contains(&word_of(it)));
        let mut subject = vec![];
        let read = |clause: Vec<Token>| {
            let tokens = fold_numbers(clause);
            if goes_on_denying(&tokens, &subject) {
                return vec![];
            }
            if let Some(claim) = answer(&tokens, &subject) {
                return vec![claim];
            }
            let claims = read_clause(&tokens, after_stop, &subject);
            let words: Vec<&str> = tokens.iter().map(word_of).collect();
            after_stop = words.iter().any(|word| is_stop(word)) || stands_repeatedly(&words);
            subject = tokens;
            claims
        };
        let is_denied = parts.iter().flatten().any(|token| NEGATIONS.contains(&word_of(token)));
        let mut claims: Vec<Claim> = parts.into_iter().skip(usize::from(is_call)).flat_map(read).collect();
        // A word of pausing in a sentence with a negation may be what is denied.
        let is_told = claims.iter().any(|claim| matches!(claim, Claim::Stops(_)));
        // `backpack: no`
        let no_luggage = claims.contains(&Claim::NoBackpack);
        claims.retain(|claim| !(no_luggage && *claim == Claim::Backpack));
        claims.retain(|claim| !((is_denied || is_told) && *claim == Claim::SomeStops));
        claims
    };
    // `stops: 2 | camera level`: notes are sentences.
    let text = &text.replace(['|'], ".\n").replace("//", ".\n");
    with_level_view(sentences(text).into_iter().flat_map(sentence).collect(), is_level(&clauses(text)))
}

/// `Stops? None.`, `turns: 0`: a clause that is nothing but a number or a denial answers the clause before.
fn answer(tokens: &[Token], subject: &[Token]) -> Option<Claim> {
    let is_none = |token: &Token| NONE.contains(&word_of(token));
    let number = match tokens {
        [Token::Number(value)] => *value,
        [first, ..] if tokens.iter().all(is_none) && NEGATIONS.contains(&word_of(first)) => 0.0,
        [Token::Word(word)] => number_word(word)?,
        _ => return None,
    };
    let asks = |is_such: &dyn Fn(&str) -> bool| subject.iter().any(|token| is_such(word_of(token)));
    match () {
        () if asks(&is_stop) => Some(count(number, "stops", Claim::Stops)),
        () if asks(&|word| is_turning(word) || ["left", "right", "direction"].contains(&word)) => {
            Some(count(number, "turns", Claim::Turns))
        }
        () if number == 0.0 && asks(&|word| ["motion", "movement"].contains(&word)) => Some(Claim::Stays),
        () if number == 0.0 && word_of(&tokens[0]) != "nothing" && asks(&|word| LUGGAGE.contains(&word)) => {
            Some(Claim::NoBackpack)
        }
        () => None,
    }
}

/// `right or around` behind `they do not turn left`.
fn goes_on_denying(tokens: &[Token], before: &[Token]) -> bool {
    let before: Vec<&str> = before.iter().map(word_of).collect();
    let is_side = |token: &Token| ["left", "right", "around", "or", "nor"].contains(&word_of(token));
    tokens.len() < 4
        && tokens.iter().all(is_side)
        && tokens.iter().any(|token| ["or", "nor"].contains(&word_of(token)))
        && denied(&before, is_turning)
}

/// Words of an answer that there is none: `not a single one`.
const NONE: [&str; 21] = [
    "nope",
    "nah",
    "no",
    "none",
    "nil",
    "neither",
    "never",
    "nought",
    "zero",
    "not",
    "one",
    "a",
    "single",
    "at",
    "all",
    "any",
    "ever",
    "whatsoever",
    "nothing",
    "were",
    "made",
];

fn read_clause(tokens: &[Token], after_stop: bool, before: &[Token]) -> Vec<Claim> {
    let words = seen_from(without_idioms(tokens.iter().map(word_of).collect()));
    let drone_lingers =
        words.iter().any(|it| ["aircraft", "drone", "craft", "quadcopter", "uav", "copter", "you"].contains(it))
            && !words.iter().any(|it| it.starts_with("second") || ["times", "once", "twice"].contains(it));
    let about_stops = !drone_lingers && words.iter().any(|word| is_stop(word)) || stands_repeatedly(&words);
    // `They pause once, for about 3 seconds`: the time belongs to the stop.
    let sums = || {
        words.iter().any(|word| ["altogether", "together", "total", "all", "told", "standing", "sum"].contains(word))
    };
    let goes_on = after_stop
        && !about_stops
        && (words.first().is_some_and(|word| GOES_ON.contains(word)) || sums() || is_time_alone(&words));
    let mut claims = vec![];
    let mut turns: Vec<(usize, TurnKind)> = vec![];
    for (i, token) in tokens.iter().enumerate() {
        let next = words.get(i + 1).copied().unwrap_or_default();
        match token {
            Token::Number(value) => claims.extend(quantity(*value, i, &words, about_stops || after_stop)),
            Token::Word(word) => {
                let is_equal = i > 0 && words[i - 1].starts_with("equal");
                if let Some(value) = number_word(word).filter(|_| is_unit(next) || is_equal) {
                    claims.extend(quantity(value, i, &words, about_stops || after_stop));
                    continue;
                }
                let counted = i > 0 && matches!(&tokens[i - 1], Token::Number(_));
                let claim = clothes_claim(i, &words).or_else(|| word_claim(i, &words, counted, about_stops));
                let is_near = |(place, kind): &(usize, TurnKind)| {
                    let between = &words[*place..i];
                    *kind == TurnKind::Around
                        && !between.iter().any(|it| ["then", "next", "finally", "later"].contains(it))
                };
                let is_again = claim == Some(Claim::Turn(TurnKind::Around)) && turns.last().is_some_and(is_near);
                let is_denied = matches!(claim, Some(Claim::Turn(_))) && is_denied_at(i, &words);
                if is_denied {
                    claims.push(Claim::NoTurns);
                } else if is_again {
                    // A turn around in two words is one.
                    claims.push(Claim::PerhapsTurn(TurnKind::Around));
                } else if let Some(Claim::Turn(kind)) = claim {
                    let times = repetitions(&tokens[i + 1..]);
                    turns.push((i, kind));
                    claims.extend(core::iter::repeat_n(Claim::Turn(kind), times));
                } else {
                    claims.extend(claim);
                }
            }
        }
    }
    both_garments(&words, &mut claims);
    if goes_on {
        claims.retain(|claim| *claim != Claim::Stays);
    } else if !about_stops && (denies_motion(&words) || keeps_place(&words)) {
        claims.push(Claim::Stays);
    }
    if !goes_on && !about_stops && stays_put(&words) {
        claims.push(Claim::Stays);
    }
    if walks(&words) {
        claims.push(Claim::Walks);
    }
    // `turns left after turning right` says the later turn first.
    if let [(first, one), (second, other)] = turns[..]
        && (words[first..second].windows(2).any(|it| it[0] == "after" && !["that", "which", "this"].contains(&it[1]))
            || words[first..second].windows(2).any(|it| it[0].starts_with("preced") && it[1] == "by"))
    {
        let listed = |claim: &Claim| matches!(claim, Claim::Turn(_));
        let places: Vec<usize> = (0..claims.len()).filter(|at| listed(&claims[*at])).collect();
        if let [a, b] = places[..] {
            (claims[a], claims[b]) = (Claim::Turn(other), Claim::Turn(one));
        }
    }
    claims.extend(order_of_stop_and_turn(&words, &turns));
    pauses_denied(&words, about_stops, after_stop, &mut claims);
    let lists = claims.iter().any(|claim| matches!(claim, Claim::Turn(_) | Claim::Turns(1..) | Claim::TurnsOf(..)));
    claims.retain(|claim| !(lists && *claim == Claim::NoTurns));
    if !is_of_the_gap(&words)
        && (counts_no_turns(&words) || denied(&words, is_turning) || words.iter().any(|word| UNTURNED.contains(word)))
    {
        claims.retain(|claim| !matches!(claim, Claim::Turn(_) | Claim::Turns(_) | Claim::TurnsOf(..)));
        claims.push(Claim::NoTurns);
    } else if keeps_direction(&words) || words.windows(2).any(|it| it == ["dead", "ahead"]) {
        claims.push(Claim::Straight);
    }
    aimed_before(&mut claims, before);
    stands_for(claims)
}

/// `the view is angled up, 36 degrees`: where the clause of an angle does not say which way, the clause before may.
fn aimed_before(claims: &mut [Claim], before: &[Token]) {
    let words: Vec<&str> = before.iter().map(word_of).collect();
    for claim in claims {
        if let (Claim::Tilt(value), Some(way)) = (&*claim, aim(&words, words.len())) {
            *claim = Claim::Pitch(if way == 0 { -value } else { *value });
        }
    }
}

/// Whether a word speaks of pauses, turns or motion.
pub(crate) fn is_of_a_walk(word: &str) -> bool {
    is_stop(word) || is_turning(word) || MOTION.contains(&word)
}

/// A camera that looks from above looks down.
fn seen_from(mut words: Vec<&str>) -> Vec<&str> {
    for at in 1..words.len() {
        match (words[at - 1], words[at]) {
            ("from", "above" | "overhead") => words[at] = "downward",
            ("from", "below" | "beneath") => words[at] = "upward",
            _ => {}
        }
    }
    words
}

fn word_claim(at: usize, words: &[&str], counted: bool, about_stops: bool) -> Option<Claim> {
    let (word, next) = (words[at], words.get(at + 1).copied().unwrap_or_default());
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    // `turning neither left nor right`
    if matches!(word, "left" | "right" | "lefts" | "rights")
        && (["neither", "nor", "not", "no"].contains(&before) || at > 1 && before == "or" && words.contains(&"neither"))
    {
        return Some(Claim::NoTurns);
    }
    let turn = turn_word(word).filter(|_| !counted && is_side(at, words) && !is_either(at, words)).map(Claim::Turn);
    let back = turns_back(at, words);
    turn.or_else(|| back.then_some(Claim::Turn(TurnKind::Around)))
        .or_else(|| compass_word(word).map(Claim::Direction))
        .or(match word {
            "straight" if !STRAIGHT_AT.contains(&next) && !words.contains(&"measured") && !is_of_a_view(words) => {
                Some(Claim::Straight)
            }
            "still" if !["walks", "walking", "keeps", "keep", "moving"].contains(&next) && !about_stops => {
                Some(Claim::Stays)
            }
            "stand" if is_of_the_drone(words) => None,
            "stand" | "stands" | "standing" | "stood"
                if !["out", "off", "back", "by"].contains(&next) && !about_stops =>
            {
                Some(Claim::Stays)
            }
            standing if STANDS.contains(&standing) && !about_stops => Some(Claim::Stays),
            "stays" | "stay" | "remains" | "remain" | "staying" | "remaining" | "keeps" | "stayed" | "remained"
            | "glued" | "fixed" | "stuck" | "pinned" | "nailed" | "frozen"
                if !is_of_the_drone(words)
                    && (["put", "where"].contains(&next)
                        || words.get(at + 2) == Some(&"where")
                        || (["in", "on", "at", "to"].contains(&next)
                            && ["place", "spot", "position", "rooted"].iter().any(|it| words.contains(it)))) =>
            {
                Some(Claim::Stays)
            }
            "once" if about_stops => Some(Claim::Stops(1)),
            "single" if is_stop(next) => Some(Claim::Stops(1)),
            "once" if is_turning(before) => Some(Claim::Turns(1)),
            "twice" if is_turning(before) => Some(Claim::Turns(2)),
            "thrice" if is_turning(before) => Some(Claim::Turns(3)),
            "twice" if about_stops && turn_word(before).is_none() => Some(Claim::Stops(2)),
            "thrice" if about_stops => Some(Claim::Stops(3)),
            _ => None,
        })
}

/// `left or right?` says of no side that it is turned to.
fn is_either(at: usize, words: &[&str]) -> bool {
    let is_side = |place: usize| words.get(place).is_some_and(|word| ["left", "right"].contains(word));
    is_side(at)
        && (words.get(at + 1) == Some(&"or") && is_side(at + 2) || at > 1 && words[at - 1] == "or" && is_side(at - 2))
}

/// Whether a clause says beyond doubt that the target walks.
fn walks(words: &[&str]) -> bool {
    words.iter().any(|word| WALKS.contains(word))
        && !is_of_the_drone(words)
        && !words.iter().any(|word| NEGATIONS.contains(word))
}

/// Words behind which `straight` is no way of walking.
const STRAIGHT_AT: [&str; 14] =
    ["down", "at", "above", "up", "away", "behind", "after", "back", "from", "into", "to", "answer", "legs", "face"];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compass::Compass;
    use cosfly_domain::Colour;

    #[test]
    fn sentences_in_other_words_are_read() {
        for (text, expected) in [
            (
                "Please pursue the northbound walker, 25 metres behind and 45° down.",
                vec![Claim::Direction(Compass::North), Claim::Distance(25.0), Claim::Pitch(45.0)],
            ),
            ("It pauses twice, never turns.", vec![Claim::Stops(2), Claim::NoTurns]),
            ("No stops; two turns", vec![Claim::Stops(0), Claim::Turns(2)]),
            ("They stop three times", vec![Claim::Stops(3)]),
            ("They stop", vec![Claim::SomeStops]),
            ("Go south-east at 1.4 m/s.", vec![Claim::Direction(Compass::Southeast), Claim::Speed(1.4)]),
            ("turns left, then right", vec![Claim::Turn(TurnKind::Left), Claim::Turn(TurnKind::Right)]),
            (
                "turns right twice, then left",
                [vec![Claim::Turn(TurnKind::Right); 2], vec![Claim::Turn(TurnKind::Left)]].concat(),
            ),
            ("turns left three times", vec![Claim::Turn(TurnKind::Left); 3]),
            (
                "a person with a backpack in a red shirt and blue trousers",
                vec![Claim::Backpack, Claim::Top(Colour::Red), Claim::Trousers(Colour::Blue)],
            ),
            ("7 bananas", vec![Claim::Unknown("7 bananas".into())]),
            ("2.5 turns -3 m", vec![Claim::Unknown("2.5 turns".into()), Claim::Unknown("-3 m".into())]),
        ] {
            assert_eq!(read(text), expected, "{text}");
        }
    }
}
