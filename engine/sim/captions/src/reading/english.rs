//! Reads English texts: words and numbers, clause by clause.

use super::english_idioms::{is_travelled, number_follows, without_idioms};
use super::english_numbers::fold_numbers;
use super::english_words::{
    ALTITUDE_WORDS, DISTANCE_WORDS, DOWN_WORDS, DURATION_WORDS, GOES_ON, LUGGAGE, NEGATIONS, OTHER_COLOURS, STOP_WORDS,
    TOPS, TROUSERS, UP_WORDS, WALKED, WAY_WORDS,
};
use super::{Claim, count, sentences};
use crate::compass::Compass;
use crate::turns::TurnKind;
use cosfly_render::Colour;

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token {
    Word(String),
    Number(f64),
}

/// Everything that the text claims, in order.
pub fn read(text: &str) -> Vec<Claim> {
    let sentence = |sentence: &str| {
        let mut after_stop = false;
        let read = |clause: Vec<Token>| {
            let tokens = fold_numbers(clause);
            let claims = read_clause(&tokens, after_stop);
            after_stop = tokens.iter().any(|token| is_stop(word_of(token)));
            claims
        };
        clauses(sentence).into_iter().flat_map(read).collect::<Vec<_>>()
    };
    sentences(text).into_iter().flat_map(sentence).collect()
}

/// Lower-case tokens, parted at punctuation.
pub(crate) fn clauses(text: &str) -> Vec<Vec<Token>> {
    let chars: Vec<char> = text.to_lowercase().chars().collect();
    let mut clauses = vec![vec![]];
    let mut i = 0;
    while i < chars.len() {
        let start = i;
        let clause = clauses.last_mut().expect("there is always one clause");
        if chars[i].is_ascii_digit() {
            while i < chars.len() && (chars[i].is_ascii_digit() || decimal_point(&chars, i)) {
                i += 1;
            }
            let digits: String = chars[start..i].iter().collect();
            let negative = start > 0 && chars[start - 1] == '-' && (start < 2 || chars[start - 2] == ' ');
            let value: f64 = digits.parse().unwrap_or(f64::NAN);
            clause.push(Token::Number(if negative { -value } else { value }));
        } else if chars[i].is_alphabetic() {
            // A slash joins units (m/s), a hyphen compass words (north-east).
            while i < chars.len()
                && (chars[i].is_alphabetic() || (matches!(chars[i], '/' | '-') && letter(&chars, i + 1)))
            {
                i += 1;
            }
            let word: String = chars[start..i].iter().filter(|c| **c != '-').collect();
            clause.push(Token::Word(word));
        } else {
            match chars[i] {
                '°' => clause.push(Token::Word("degrees".into())),
                '%' => clause.push(Token::Word("percent".into())),
                // `Length: 130 m` is one statement.
                ':' if number_follows(&chars, i + 1) => {}
                // `coat: red`
                ':' if colour_follows(&chars, i + 1) => clause.push(Token::Word("is".into())),
                ',' | ';' | ':' | '.' | '!' | '?' | '(' | ')' | '\n' => clauses.push(vec![]),
                _ => {}
            }
            i += 1;
        }
    }
    clauses
}

fn colour_follows(chars: &[char], from: usize) -> bool {
    let word: String = chars[from..].iter().skip_while(|c| **c == ' ').take_while(|c| c.is_alphabetic()).collect();
    colour(&word).is_some()
}

fn decimal_point(chars: &[char], at: usize) -> bool {
    chars[at] == '.' && chars.get(at + 1).is_some_and(char::is_ascii_digit)
}

fn letter(chars: &[char], at: usize) -> bool {
    chars.get(at).is_some_and(|c| c.is_alphabetic())
}

fn read_clause(tokens: &[Token], after_stop: bool) -> Vec<Claim> {
    let words = without_idioms(tokens.iter().map(word_of).collect());
    let about_stops = words.iter().any(|word| is_stop(word)) || stands_repeatedly(&words);
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
            Token::Number(value) => claims.extend(quantity(*value, i, &words, about_stops || goes_on)),
            Token::Word(word) => {
                if let Some(value) = number_word(word).filter(|_| is_unit(next)) {
                    claims.extend(quantity(value, i, &words, about_stops || goes_on));
                    continue;
                }
                let counted = i > 0 && matches!(&tokens[i - 1], Token::Number(_));
                let claim = clothes_claim(i, &words).or_else(|| word_claim(i, &words, counted, about_stops));
                if let Some(Claim::Turn(kind)) = claim {
                    let times = repetitions(&tokens[i + 1..]);
                    turns.push((i, kind));
                    claims.extend(core::iter::repeat_n(Claim::Turn(kind), times));
                } else {
                    claims.extend(claim);
                }
            }
        }
    }
    if goes_on {
        claims.retain(|claim| *claim != Claim::Stays);
    } else if !about_stops
        && denied(&words, |word| {
            matches!(word, "move" | "moves" | "moving" | "moved" | "movement" | "budge" | "going" | "walk")
        })
    {
        claims.push(Claim::Stays);
    }
    // `turns left after turning right` says the later turn first.
    if let [(first, one), (second, other)] = turns[..]
        && words[first..second].contains(&"after")
    {
        let listed = |claim: &Claim| matches!(claim, Claim::Turn(_));
        let places: Vec<usize> = (0..claims.len()).filter(|at| listed(&claims[*at])).collect();
        if let [a, b] = places[..] {
            (claims[a], claims[b]) = (Claim::Turn(other), Claim::Turn(one));
        }
    }
    claims.extend(order_of_stop_and_turn(&words, &turns));
    if ["nonstop", "uninterrupted", "unbroken", "ceaselessly", "incessantly"].iter().any(|it| words.contains(it))
        || denied(&words, is_stop)
    {
        claims.retain(|claim| !matches!(claim, Claim::Stops(_)));
        claims.push(Claim::Stops(0));
    } else if about_stops && !claims.iter().any(|claim| matches!(claim, Claim::Stops(_))) {
        claims.push(Claim::SomeStops);
    }
    if denied(&words, |word| word.starts_with("turn") || matches!(word, "bends" | "corners")) {
        claims.retain(|claim| !matches!(claim, Claim::Turn(_)));
        claims.push(Claim::NoTurns);
    }
    claims
}

/// `one pause, about 3 seconds long`: a time in a clause of its own.
fn is_time_alone(words: &[&str]) -> bool {
    let is_time = |word: &&str| word.starts_with("second");
    words.len() <= 5 && words.iter().any(is_time) && !words.iter().any(|word| DURATION_WORDS.contains(word))
}

/// `stands still twice`: two stops.
fn stands_repeatedly(words: &[&str]) -> bool {
    let is_stand = |word: &&str| ["stand", "stands", "standing", "still", "stood"].contains(word);
    let is_count = |word: &&str| ["once", "twice", "thrice", "times"].contains(word);
    (0..words.len()).any(|at| is_stand(&words[at]) && words[at + 1..].iter().take(3).any(is_count))
}

/// Whether a negation comes a few words before such a word.
fn denied(words: &[&str], is_such: impl Fn(&str) -> bool) -> bool {
    (0..words.len()).filter(|at| is_such(words[*at])).any(|at| {
        let before = &words[at.saturating_sub(4)..at];
        let negation = before.iter().rposition(|word| NEGATIONS.contains(word));
        negation.is_some_and(|from| !before[from..].iter().any(|word| LUGGAGE.contains(word)))
    })
}

/// Numbers have no word.
pub fn word_of(token: &Token) -> &str {
    match token {
        Token::Word(word) => word,
        Token::Number(_) => "",
    }
}

/// `stops before turning left`, `turns left after a stop`.
fn order_of_stop_and_turn(words: &[&str], turns: &[(usize, TurnKind)]) -> Option<Claim> {
    let stop = words.iter().position(|word| is_stop(word))?;
    let (turn, _) = *turns.first()?;
    let between = &words[stop.min(turn)..stop.max(turn)];
    let stop_first = match () {
        () if between.contains(&"before") => stop < turn,
        () if between.contains(&"after") => stop > turn,
        () if between.contains(&"then") => stop < turn,
        () => return None,
    };
    Some(Claim::StopFirst(stop_first))
}

/// The list that has the word nearest to place `at`, by its number; of equally near ones the word behind counts.
fn nearest(words: &[&str], at: usize, lists: &[&[&str]]) -> Option<usize> {
    let places = (0..words.len()).filter(|place| *place != at);
    let of = |word: &str| lists.iter().position(|list| list.contains(&word));
    let found = places.filter_map(|place| Some((place.abs_diff(at), place < at, of(words[place])?)));
    found.min().map(|(_, _, list)| list)
}

/// A colour before a garment, and luggage.
pub(crate) fn garment_claim(word: &str, next: &str) -> Option<Claim> {
    if word == "backpack" {
        return Some(Claim::Backpack);
    }
    let colour = Colour::ALL.into_iter().find(|colour| colour.name() == word)?;
    match next {
        "top" | "shirt" | "jacket" | "coat" => Some(Claim::Top(colour)),
        "trousers" | "pants" | "jeans" => Some(Claim::Trousers(colour)),
        _ => None,
    }
}

/// How often the turn before these tokens is made: `twice`, `three times`, or once.
fn repetitions(after: &[Token]) -> usize {
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

/// The claim of a number at a place, with the word after it, in its clause.
fn quantity(value: f64, at: usize, words: &[&str], about_stops: bool) -> Option<Claim> {
    let unit = words.get(at + 1).copied().unwrap_or_default();
    let after = |offset: usize| words.get(at + offset).copied().unwrap_or_default();
    let is_metres = matches!(unit, "m" | "metre" | "metres" | "meter" | "meters");
    if unit == "m/s"
        || (is_metres && ["per", "a", "each", "every"].contains(&after(2)) && after(3).starts_with("second"))
    {
        return Some(Claim::Speed(value));
    }
    Some(match unit {
        _ if is_metres => match nearest(words, at, &[&ALTITUDE_WORDS, &WAY_WORDS, &DISTANCE_WORDS]) {
            Some(0) => Claim::Altitude(value),
            Some(1) => Claim::Way(value),
            Some(_) if words.contains(&"distance") && WALKED.iter().any(|word| words.contains(word)) => {
                Claim::Way(value)
            }
            // With a time or a pace beside it, a length without a place is the way.
            None if is_travelled(words) => Claim::Way(value),
            _ if value < 0.0 => Claim::Unknown(format!("{value} {unit}")),
            _ => Claim::Distance(value),
        },
        "degree" | "degrees" | "deg" => {
            Claim::Pitch(if nearest(words, at, &[&UP_WORDS, &DOWN_WORDS]) == Some(0) { -value } else { value })
        }
        "s" | "sec" | "secs" | "second" | "seconds" => {
            let walks = || nearest(words, at, &[&STOP_WORDS, &DURATION_WORDS]) == Some(1);
            if about_stops && !walks() { Claim::Standing(value) } else { Claim::Duration(value) }
        }
        "time" | "times" | "occasions" if about_stops => count(value, unit, Claim::Stops),
        // Repetitions of a turn, which the turn's own claims contain.
        "time" | "times" if words.iter().any(|word| turn_word(word).is_some()) => return None,
        "time" | "times" if words.iter().any(|word| word.starts_with("turn")) => count(value, unit, Claim::Turns),
        "turn" | "turns" | "corners" | "bends" => count(value, unit, Claim::Turns),
        stop if is_stop(stop) => count(value, unit, Claim::Stops),
        side => match turn_word(side) {
            Some(kind) => count(value, unit, |count| Claim::TurnsOf(kind, count)),
            None => Claim::Unknown(format!("{value} {unit}").trim_end().to_owned()),
        },
    })
}

/// Clothes and luggage at a place of a clause.
fn clothes_claim(at: usize, words: &[&str]) -> Option<Claim> {
    let (word, next) = (words[at], words.get(at + 1).copied().unwrap_or_default());
    if LUGGAGE.contains(&word) {
        let before = &words[at.saturating_sub(4)..at];
        let denied = before.iter().any(|word| NEGATIONS.contains(word));
        return Some(if denied { Claim::NoBackpack } else { Claim::Backpack });
    }
    if OTHER_COLOURS.contains(&word) {
        return Some(Claim::Unknown(word.to_owned()));
    }
    for (ending, claim) in
        [("shirted", Claim::Top as fn(Colour) -> Claim), ("topped", Claim::Top), ("trousered", Claim::Trousers)]
    {
        if let Some(colour) = word.strip_suffix(ending).and_then(colour) {
            return Some(claim(colour));
        }
    }
    let found = colour(word)?;
    // `dressed in red and red`: both garments.
    if at >= 2 && words[at - 1] == "and" && words[at - 2] == word && garment(Some(&next)).is_none() {
        return Some(Claim::Trousers(found));
    }
    if next == "and" && words.get(at + 2) == Some(&word) && garment(words.get(at + 3)).is_none() {
        return Some(Claim::Top(found));
    }
    if next == "and" {
        // `a black and white top`, which no garment here is.
        if let Some(other) =
            words.get(at + 2).and_then(|word| colour(word)).filter(|_| garment(words.get(at + 3)).is_some())
        {
            return (other != found).then(|| Claim::Unknown(format!("{word} and {}", words[at + 2])));
        }
    }
    let of_pair = || words.get(at + 3).filter(|_| next == "pair" && words.get(at + 2) == Some(&"of"));
    if let Some(claim) = garment(Some(&next)).or_else(|| garment(of_pair())) {
        return Some(claim(found));
    }
    // `a top that is red`, `trousers in black`, `red on top`
    let before = words[at.saturating_sub(4)..at].iter().rev().find_map(|word| garment(Some(word)));
    let link = words[at.saturating_sub(2)..at]
        .iter()
        .any(|word| ["is", "are", "in", "of", "coloured", "colored"].contains(word));
    match before.filter(|_| link) {
        Some(claim) => Some(claim(found)),
        None => Some(Claim::Wears(found)),
    }
}

pub(crate) fn colour(word: &str) -> Option<Colour> {
    let word = if word == "gray" { "grey" } else { word };
    Colour::ALL.into_iter().find(|colour| colour.name() == word)
}

/// Whether a word is a number, or a number with its unit, such as `twenty-metre`.
pub(crate) fn is_numeral(word: &str) -> bool {
    let tokens = fold_numbers(vec![Token::Word(word.to_owned()), Token::Word("metres".to_owned())]);
    matches!(tokens.first(), Some(Token::Number(_))) || tokens.len() > 2
}

/// Whether a word names a top or trousers.
pub(crate) fn is_garment(word: &str) -> bool {
    garment(Some(&word)).is_some()
}

fn garment(word: Option<&&str>) -> Option<fn(Colour) -> Claim> {
    match word {
        Some(word) if TOPS.contains(word) => Some(Claim::Top),
        Some(word) if TROUSERS.contains(word) => Some(Claim::Trousers),
        _ => None,
    }
}

fn word_claim(at: usize, words: &[&str], counted: bool, about_stops: bool) -> Option<Claim> {
    let (word, next) = (words[at], words.get(at + 1).copied().unwrap_or_default());
    let before = at.checked_sub(1).map_or("", |before| words[before]);
    // `right behind`, `around 25 m` are no turns.
    let is_idiom = match word {
        "right" => {
            // `the right distance`, `right behind`
            let is_side =
                ["turn", "turning", "hand", "bend", "corner", "swing", "one", "", "then", "and"].contains(&next);
            (before == "the" && !is_side)
                || !["turns", "turn", "turning", "turned", "takes", "then", "next", "and", ""].contains(&before)
                    && ["behind", "above", "after", "away", "there", "on", "up", "over", "across", "beside"]
                        .contains(&next)
                || before == "all"
        }
        "around" | "round" => {
            let is_amount =
                words.get(at + 1) == Some(&"") && !words.get(at + 2).is_some_and(|it| it.starts_with("time"));
            is_amount || !["turns", "turn", "turning", "turned", "then", ""].contains(&before)
        }
        "left" => ["is", "are", "has", "be"].contains(&before),
        _ => false,
    };
    let turn = turn_word(word).filter(|_| !counted && !is_idiom).map(Claim::Turn);
    let back = (["back", "round"].contains(&next)
        && ["turns", "doubles", "turn", "turning", "doubling", "heads"].contains(&word))
        || matches!(word, "reverses" | "backtracks" | "aboutturn" | "aboutface");
    turn.or_else(|| back.then_some(Claim::Turn(TurnKind::Around)))
        .or_else(|| compass_word(word).map(Claim::Direction))
        .or(match word {
            "straight" if !["down", "at", "above", "up"].contains(&next) => Some(Claim::NoTurns),
            "still" if !["walks", "walking", "keeps", "keep", "moving"].contains(&next) && !about_stops => {
                Some(Claim::Stays)
            }
            "stand" | "stands" | "standing" if next != "out" && !about_stops => Some(Claim::Stays),
            "rooted" if !about_stops => Some(Claim::Stays),
            "motionless" | "stationary" | "immobile" if !about_stops => Some(Claim::Stays),
            "stays" | "stay" | "remains" | "remain"
                if ["put", "where"].contains(&next) || (next == "in" && words.contains(&"place")) =>
            {
                Some(Claim::Stays)
            }
            "once" if about_stops => Some(Claim::Stops(1)),
            "single" if is_stop(next) => Some(Claim::Stops(1)),
            "twice" if about_stops && turn_word(before).is_none() => Some(Claim::Stops(2)),
            "thrice" if about_stops => Some(Claim::Stops(3)),
            _ => None,
        })
}

fn compass_word(word: &str) -> Option<Compass> {
    let stem =
        ["wards", "ward", "bound", "erly", "ern"].iter().find_map(|ending| word.strip_suffix(ending)).unwrap_or(word);
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

fn turn_word(word: &str) -> Option<TurnKind> {
    match word {
        "left" | "leftward" | "leftwards" | "lefts" | "lefthand" => Some(TurnKind::Left),
        "right" | "rightward" | "rightwards" | "rights" | "righthand" => Some(TurnKind::Right),
        "around" | "uturn" | "uturns" => Some(TurnKind::Around),
        _ => None,
    }
}

/// A pause, as verb or noun, and what keeps somebody from walking on.
fn is_stop(word: &str) -> bool {
    ["stop", "paus", "halt", "linger", "interrupt", "tarr", "loiter", "dawdl", "dall"]
        .iter()
        .any(|stem| word.starts_with(stem))
        || STOP_WORDS.contains(&word)
}

pub fn is_unit(word: &str) -> bool {
    let units = [
        "m",
        "m/s",
        "metre",
        "metres",
        "meter",
        "meters",
        "degree",
        "degrees",
        "second",
        "seconds",
        "time",
        "times",
        "bends",
        "corners",
        "occasions",
    ];
    units.contains(&word) || word.starts_with("turn") || is_stop(word) || turn_word(word).is_some()
}

pub(crate) fn number_word(word: &str) -> Option<f64> {
    let words = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];
    words.iter().position(|known| *known == word).map(|value| value as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

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
