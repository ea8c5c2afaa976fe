//! English texts as words and numbers, parted at punctuation.

use super::clothes::{colour, is_garment};
use super::idioms::number_follows;

/// A word or a number of a text.
#[derive(Clone, Debug, PartialEq)]
pub enum Token {
    /// Lower-case letters.
    Word(String),
    /// A number in digits, or of number words.
    Number(f64),
}

/// Lower-case tokens, parted at punctuation.
pub fn clauses(text: &str) -> Vec<Vec<Token>> {
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
            let negative =
                start > 0 && matches!(chars[start - 1], '-' | '\u{2212}') && (start < 2 || chars[start - 2] == ' ');
            let value: f64 = digits.parse().unwrap_or(f64::NAN);
            clause.push(Token::Number(if negative { -value } else { value }));
        } else if chars[i].is_alphabetic() {
            // A slash joins units (m/s), a hyphen compass words (north-east).
            while i < chars.len()
                && (chars[i].is_alphabetic() || (matches!(chars[i], '/' | '-') && letter(&chars, i + 1)))
            {
                i += 1;
            }
            let joined: String = chars[start..i].iter().collect();
            if is_joined(&joined) {
                clause.extend(joined.split('-').map(|part| Token::Word(part.to_owned())));
                continue;
            }
            let word = joined.replace('-', "");
            // `left/right/left`
            match word.contains('/') && !is_rate(&word) {
                true => clause.extend(word.split('/').map(|part| Token::Word(part.to_owned()))),
                false => clause.push(Token::Word(word)),
            }
        } else {
            match chars[i] {
                '°' => clause.push(Token::Word("degrees".into())),
                '%' => clause.push(Token::Word("percent".into())),
                // `Length: 130 m` is one statement.
                ':' if number_follows(&chars, i + 1) => {}
                // `coat: red`
                ':' if colour_follows(&chars, i + 1) => clause.push(Token::Word("is".into())),
                // `-20 (down)`
                '(' if is_aside(&chars[i + 1..]) => {}
                ',' | ';' | ':' | '.' | '!' | '?' | '(' | ')' | '\n' | '>' | '→' => clauses.push(vec![]),
                // `left - right`
                '-' | '–' | '/' if is_apart(&chars, i) => clauses.push(vec![]),
                _ => {}
            }
            i += 1;
        }
    }
    clauses
}

/// `the green-top-black-bottoms person`, `L-R`: words that stand for themselves.
fn is_joined(word: &str) -> bool {
    let parts: Vec<&str> = word.split('-').collect();
    parts.len() > 2 && parts.iter().any(|part| colour(part).is_some()) && parts.iter().any(|part| is_garment(part))
        || parts.len() > 1 && parts.iter().all(|part| ["l", "r", "u", "left", "right", "around"].contains(part))
}

/// A sign with spaces on both sides, which parts items.
fn is_apart(chars: &[char], at: usize) -> bool {
    at > 0 && chars[at - 1] == ' ' && chars.get(at + 1) == Some(&' ')
}

/// `m/s`
fn is_rate(word: &str) -> bool {
    ["m/", "km/", "metres/", "meters/", "metre/", "meter/"].iter().any(|unit| word.starts_with(unit))
}

/// A word in brackets that says which way a camera looks.
fn is_aside(chars: &[char]) -> bool {
    let inside: String = chars.iter().take_while(|c| **c != ')').collect();
    inside.len() < 24
        && inside.split(' ').any(|word| ["up", "down", "upward", "downward", "upwards", "downwards"].contains(&word))
}

pub(super) fn colour_follows(chars: &[char], from: usize) -> bool {
    let word: String = chars[from..].iter().skip_while(|c| **c == ' ').take_while(|c| c.is_alphabetic()).collect();
    colour(&word).is_some()
}

pub(super) fn decimal_point(chars: &[char], at: usize) -> bool {
    chars[at] == '.' && chars.get(at + 1).is_some_and(char::is_ascii_digit)
}

pub(super) fn letter(chars: &[char], at: usize) -> bool {
    chars.get(at).is_some_and(|c| c.is_alphabetic())
}

/// Numbers have no word.
pub(super) fn word_of(token: &Token) -> &str {
    match token {
        Token::Word(word) => word,
        Token::Number(_) => "",
    }
}
