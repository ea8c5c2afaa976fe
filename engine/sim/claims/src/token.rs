//! Texts as numbers, concepts and marks.

use crate::language::Language;
use crate::lexicon::{Concept, Lexicon, is_chinese};

/// A part of a text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token {
    /// A number, with whether it is in digits.
    Number(f64, bool),
    /// A phrase that the lexicon has.
    Known(Concept, String),
    /// A word that it has not.
    Word,
    /// End of a clause.
    Comma,
    /// End of a sentence.
    Stop,
}

impl Token {
    /// The concept of a phrase.
    pub(crate) fn concept(&self) -> Option<Concept> {
        match self {
            Self::Known(concept, _) => Some(*concept),
            _ => None,
        }
    }
}

/// The tokens of a text.
pub(crate) fn tokens(text: &str, language: Language) -> Vec<Token> {
    let (words, lexicon) = (words(text), Lexicon::of(language));
    let mut found = vec![];
    let mut at = 0;
    while at < words.len() {
        let (token, length) = token(&words[at..], lexicon);
        found.push(token);
        at += length;
    }
    in_numbers(&found)
}

fn token(words: &[String], lexicon: &Lexicon) -> (Token, usize) {
    match words[0].as_str() {
        "." => (Token::Stop, 1),
        "," => (Token::Comma, 1),
        // A sign before a number, which no quantity of a text has.
        number if number.starts_with('-') => (Token::Number(f64::NAN, true), 1),
        number if number.starts_with(|c: char| c.is_ascii_digit()) => {
            (Token::Number(number.parse().unwrap_or(f64::NAN), true), 1)
        }
        _ => match lexicon.find(words) {
            Some((concept, length)) => (Token::Known(concept, words[..length].join(" ")), length),
            None => (Token::Word, 1),
        },
    }
}

/// Words in lower case, single Chinese characters, numbers in digits; `,` and `.` for ends of clauses and sentences.
fn words(text: &str) -> Vec<String> {
    let chars: Vec<char> = text.to_lowercase().chars().collect();
    let next_is = |at: usize, is_such: fn(char) -> bool| chars.get(at + 1).is_some_and(|c| is_such(*c));
    let is_digit = |c: char| c.is_ascii_digit();
    let mut words: Vec<String> = vec![];
    let mut at = 0;
    while at < chars.len() {
        let c = chars[at];
        let rest = &chars[at..];
        let is_in_number = |(i, c): &(usize, &char)| c.is_ascii_digit() || **c == '.' && next_is(at + i, is_digit);
        let is_in_word = |(i, c): &(usize, &char)| {
            c.is_alphabetic() && !is_chinese(**c) || ['/', '\''].contains(c) && next_is(at + i, char::is_alphabetic)
        };
        let is_sign = "-\u{2212}".contains(c) && next_is(at, is_digit) && (at == 0 || chars[at - 1] == ' ');
        let length = match c {
            c if is_digit(c) => rest.iter().enumerate().take_while(is_in_number).count(),
            c if is_chinese(c) || c == '°' => 1,
            c if c.is_alphabetic() || c == '/' => rest.iter().enumerate().take_while(is_in_word).count().max(1),
            _ if is_sign => 2,
            _ => 0,
        };
        match c {
            '.' | '!' | '。' | '！' | '\n' => words.push(".".to_owned()),
            ',' | ';' | ':' | '?' | '(' | ')' | '，' | '；' | '：' | '？' | '（' | '）' | '、' => {
                words.push(",".to_owned())
            }
            _ if length > 0 => words.push(rest[..length].iter().collect()),
            _ => {}
        }
        at += length.max(1);
    }
    words
}

/// Tokens in which runs of number words are numbers: `one hundred and five`, `二十五`, `一点二`.
fn in_numbers(tokens: &[Token]) -> Vec<Token> {
    let value = |at: usize| match tokens.get(at).and_then(Token::concept) {
        Some(Concept::Number(value)) => Some(value),
        _ => None,
    };
    let mut found = vec![];
    let mut at = 0;
    while at < tokens.len() {
        let Some(first) = value(at) else {
            found.push(tokens[at].clone());
            at += 1;
            continue;
        };
        let (mut total, mut last) = (0, first);
        if [10, 100].contains(&first) {
            (total, last) = (first, 0);
        }
        at += 1;
        loop {
            let skipped = usize::from(total >= 100 && tokens.get(at).and_then(Token::concept) == Some(Concept::And));
            match value(at + skipped) {
                Some(scale) if [10, 100].contains(&scale) => (total, last) = (total + scale * last.max(1), 0),
                Some(more) => last += more,
                None => break,
            }
            at += skipped + 1;
        }
        let mut number = (total + last) as f64;
        if tokens.get(at).and_then(Token::concept) == Some(Concept::Point) && value(at + 1).is_some() {
            let digits: Vec<usize> = (at + 1..).map_while(value).collect();
            at += 1 + digits.len();
            number += digits.iter().rev().fold(0.0, |sum, digit| (sum + *digit as f64) / 10.0);
        }
        found.push(Token::Number(number, false));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_words_are_numbers() {
        for (text, language, expected) in [
            ("one hundred and twenty-five", Language::En, 125.0),
            ("ninety", Language::En, 90.0),
            ("one point two", Language::En, 1.2),
            ("12.5", Language::En, 12.5),
            ("一百二十五", Language::Zh, 125.0),
            ("十二", Language::Zh, 12.0),
            ("一百零五", Language::Zh, 105.0),
            ("一点二", Language::Zh, 1.2),
        ] {
            let found = tokens(text, language);
            assert!(
                matches!(found[..], [Token::Number(value, _)] if (value - expected).abs() < 1e-9),
                "{text}: {found:?}"
            );
        }
    }

    #[test]
    fn marks_end_clauses_and_sentences_and_points_of_numbers_do_not() {
        let found = tokens("1.5 m, no.", Language::En);
        let known = |concept, words: &str| Token::Known(concept, words.to_owned());
        let expected = [
            Token::Number(1.5, true),
            known(Concept::Metres, "m"),
            Token::Comma,
            known(Concept::Not, "no"),
            Token::Stop,
        ];
        assert_eq!(found, expected);
        assert_eq!(tokens("1.4米/秒", Language::Zh)[1..], [known(Concept::Speed, "米 / 秒")]);
    }
}
