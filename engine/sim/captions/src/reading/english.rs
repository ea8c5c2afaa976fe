//! Reads English texts: words and numbers, clause by clause.

use super::{Claim, count};
use crate::compass::Compass;
use crate::turns::TurnKind;
use cosfly_render::Colour;

const ALTITUDE_WORDS: [&str; 6] = ["above", "high", "higher", "height", "altitude", "overhead"];
const WAY_WORDS: [&str; 7] = ["covers", "cover", "route", "path", "long", "length", "walked"];
const DISTANCE_WORDS: [&str; 6] = ["away", "distance", "from", "behind", "apart", "range"];
const NEGATIONS: [&str; 5] = ["no", "not", "never", "without", "nowhere"];

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token {
    Word(String),
    Number(f64),
}

/// Everything that the text claims, in order.
pub fn read(text: &str) -> Vec<Claim> {
    clauses(text).iter().flat_map(|clause| read_clause(clause)).collect()
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
                ',' | ';' | ':' | '.' | '!' | '?' | '(' | ')' | '\n' => clauses.push(vec![]),
                _ => {}
            }
            i += 1;
        }
    }
    clauses
}

fn decimal_point(chars: &[char], at: usize) -> bool {
    chars[at] == '.' && chars.get(at + 1).is_some_and(char::is_ascii_digit)
}

fn letter(chars: &[char], at: usize) -> bool {
    chars.get(at).is_some_and(|c| c.is_alphabetic())
}

fn read_clause(tokens: &[Token]) -> Vec<Claim> {
    let words: Vec<&str> = tokens
        .iter()
        .filter_map(|token| match token {
            Token::Word(word) => Some(word.as_str()),
            Token::Number(_) => None,
        })
        .collect();
    let about_stops = words.iter().any(|word| is_stop(word));
    let denied = words.iter().any(|word| NEGATIONS.contains(word));
    let mut claims = vec![];
    for (i, token) in tokens.iter().enumerate() {
        let next = match tokens.get(i + 1) {
            Some(Token::Word(word)) => word.as_str(),
            _ => "",
        };
        match token {
            Token::Number(value) => claims.extend(quantity(*value, next, &words, about_stops)),
            Token::Word(word) => {
                if let Some(value) = number_word(word).filter(|_| is_unit(next)) {
                    claims.extend(quantity(value, next, &words, about_stops));
                } else {
                    let counted = i > 0 && matches!(&tokens[i - 1], Token::Number(_));
                    let claim = garment_claim(word, next).or_else(|| word_claim(word, counted, about_stops));
                    let repeated = matches!(claim, Some(Claim::Turn(_))).then(|| repetitions(&tokens[i + 1..]));
                    claims.extend(core::iter::repeat_n(claim, repeated.unwrap_or(1)).flatten());
                }
            }
        }
    }
    if about_stops && denied {
        claims.push(Claim::Stops(0));
    } else if about_stops && !claims.iter().any(|claim| matches!(claim, Claim::Stops(_))) {
        claims.push(Claim::SomeStops);
    }
    if denied && words.iter().any(|word| word.starts_with("turn")) {
        claims.push(Claim::NoTurns);
    }
    claims
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
        [Token::Word(number), Token::Word(times), ..] if times == "times" => {
            number_word(number).map_or(1, |number| number as usize)
        }
        [Token::Number(number), Token::Word(times), ..] if times == "times" => *number as usize,
        _ => 1,
    }
}

/// The claim of a number with the word after it, in its clause.
fn quantity(value: f64, unit: &str, words: &[&str], about_stops: bool) -> Option<Claim> {
    let has = |known: &[&str]| words.iter().any(|word| known.contains(word));
    Some(match unit {
        "m/s" => Claim::Speed(value),
        "m" | "metre" | "metres" | "meter" | "meters" => match () {
            () if has(&ALTITUDE_WORDS) => Claim::Altitude(value),
            () if has(&WAY_WORDS) => Claim::Way(value),
            () if has(&DISTANCE_WORDS) => Claim::Distance(value),
            () => Claim::Unknown(format!("{value} {unit}")),
        },
        "degree" | "degrees" | "deg" => Claim::Pitch(if has(&["up", "upward", "upwards"]) { -value } else { value }),
        "s" | "sec" | "second" | "seconds" => {
            if about_stops {
                Claim::Standing(value)
            } else {
                Claim::Duration(value)
            }
        }
        "time" | "times" if about_stops => count(value, unit, Claim::Stops),
        // Repetitions of a turn, which the turn's own claims contain.
        "time" | "times" if words.iter().any(|word| turn_word(word).is_some()) => return None,
        "turn" | "turns" => count(value, unit, Claim::Turns),
        stop if is_stop(stop) => count(value, unit, Claim::Stops),
        side => match turn_word(side) {
            Some(kind) => count(value, unit, |count| Claim::TurnsOf(kind, count)),
            None => Claim::Unknown(format!("{value} {unit}").trim_end().to_owned()),
        },
    })
}

fn word_claim(word: &str, counted: bool, about_stops: bool) -> Option<Claim> {
    let turn = turn_word(word).filter(|_| !counted).map(Claim::Turn);
    turn.or_else(|| compass_word(word).map(Claim::Direction)).or(match word {
        "straight" => Some(Claim::NoTurns),
        "still" => Some(Claim::Stays),
        "once" if about_stops => Some(Claim::Stops(1)),
        "twice" if about_stops => Some(Claim::Stops(2)),
        _ => None,
    })
}

fn compass_word(word: &str) -> Option<Compass> {
    let stem = ["wards", "ward", "bound"].iter().find_map(|ending| word.strip_suffix(ending)).unwrap_or(word);
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
        "left" | "leftward" | "leftwards" => Some(TurnKind::Left),
        "right" | "rightward" | "rightwards" => Some(TurnKind::Right),
        "around" | "uturn" | "uturns" => Some(TurnKind::Around),
        _ => None,
    }
}

fn is_stop(word: &str) -> bool {
    ["stop", "pause", "halt"].iter().any(|stem| word.starts_with(stem)) || word == "pausing"
}

fn is_unit(word: &str) -> bool {
    let units = ["m", "metre", "metres", "meter", "meters", "degree", "degrees", "second", "seconds", "time", "times"];
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
