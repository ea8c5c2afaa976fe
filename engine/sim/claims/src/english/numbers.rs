//! English numbers in words, and times in minutes, folded into plain numbers.

use super::tokens::{Token, word_of};
use super::units::is_unit;

/// Runs of numerals before a unit as one number, and minutes in seconds.
pub fn fold_numbers(tokens: Vec<Token>) -> Vec<Token> {
    let tokens: Vec<Token> = half_turns(tokens.into_iter().flat_map(parted).collect());
    let mut folded: Vec<Token> = vec![];
    let mut i = 0;
    while i < tokens.len() {
        let run = numeral_run(&tokens[i..]).map(|run| with_decimals(run, &tokens[i..]));
        let unit = tokens.get(i + run.map_or(0, |run| run.1)).map_or("", word_of);
        match run {
            Some((value, length)) if length > 0 && (is_unit(unit) || ["minute", "minutes"].contains(&unit)) => {
                folded.push(Token::Number(value));
                i += length;
            }
            _ => {
                folded.push(tokens[i].clone());
                i += 1;
            }
        }
    }
    let mut at = 0;
    while at + 1 < folded.len() {
        if let (Token::Number(minutes), Token::Word(unit)) = (&folded[at], &folded[at + 1])
            && matches!(unit.as_str(), "minute" | "minutes" | "min")
        {
            let skip = usize::from(folded.get(at + 2).is_some_and(|it| word_of(it) == "and"));
            let rest = match (folded.get(at + 2 + skip), folded.get(at + 3 + skip)) {
                (Some(Token::Number(seconds)), Some(Token::Word(unit))) if unit.starts_with('s') => Some(*seconds),
                _ => None,
            };
            let end = at + 2 + rest.map_or(0, |_| skip + 2);
            let seconds = [Token::Number(60.0 * minutes + rest.unwrap_or(0.0)), Token::Word("seconds".to_owned())];
            folded.splice(at..end, seconds);
        }
        at += 1;
    }
    folded
}

/// `a 180`, `two 180s`: turns around. A number with a unit of its own is none.
fn half_turns(mut tokens: Vec<Token>) -> Vec<Token> {
    for at in 1..tokens.len() {
        let before = word_of(&tokens[at - 1]).to_owned();
        let is_one = ["a", "an", "another", "one", "did", "do", "does", "doing", "the"].contains(&before.as_str());
        let is_count = !is_one && number_word(&before).is_some() || matches!(tokens[at - 1], Token::Number(_));
        let next = tokens.get(at + 1).map_or("", word_of).to_owned();
        if tokens[at] == Token::Number(180.0) && (is_one && (!is_unit(&next) && next != "s") || is_count && next == "s")
        {
            tokens[at] = Token::Word("uturn".to_owned());
            if next == "s" {
                tokens[at + 1] = Token::Word(String::new());
            }
        }
    }
    tokens.retain(|token| *token != Token::Word(String::new()));
    tokens
}

/// `one point two`: the number with what stands behind its point, and its tokens.
fn with_decimals((value, length): (f64, usize), tokens: &[Token]) -> (f64, usize) {
    if length == 0 || tokens.get(length).map(word_of) != Some("point") {
        return (value, length);
    }
    let digits = tokens[length + 1..].iter().map_while(|token| number_word(word_of(token)).filter(|it| *it < 10.0));
    let (fraction, scale, count) =
        digits.fold((0.0, 1.0, 0), |(sum, scale, count), digit| (10.0 * sum + digit, 10.0 * scale, count + 1));
    if count == 0 { (value, length) } else { (value + fraction / scale, length + 1 + count) }
}

/// `fifty-three-degree`, read as one word, as numeral and unit.
fn parted(token: Token) -> Vec<Token> {
    let Token::Word(word) = &token else { return vec![token] };
    for unit in ["degree", "metre", "meter", "second", "minute"] {
        if let Some(number) = word.strip_suffix(unit).filter(|number| numeral(number).is_some()) {
            return [number, unit].map(|part| Token::Word(part.to_owned())).into();
        }
    }
    vec![token]
}

/// A number in words at the start, such as `one hundred and twenty five`, and the number of its tokens.
fn numeral_run(tokens: &[Token]) -> Option<(f64, usize)> {
    let (mut value, mut length, mut seen) = (0.0, 0, false);
    for token in tokens {
        let Token::Word(word) = token else { break };
        match numeral(word) {
            Some(100.0) => value = 100.0 * if seen { value } else { 1.0 },
            Some(number) => value += number,
            // `a hundred`, `a hundred and five`
            None if word == "a" && !seen && tokens.get(1).is_some_and(|it| word_of(it) == "hundred") => {}
            // `a couple of turns`, `a pair of stops`
            None if ["couple", "pair", "brace"].contains(&word.as_str())
                && !seen
                && tokens.get(length + 1).is_some_and(|it| word_of(it) == "of") =>
            {
                return Some((2.0, length + 2));
            }
            None if word == "a"
                && !seen
                && tokens.get(1).is_some_and(|it| ["couple", "pair", "brace"].contains(&word_of(it))) => {}
            None if word == "and"
                && seen
                && tokens.get(length + 1).is_some_and(|it| numeral(word_of(it)).is_some()) => {}
            None => break,
        }
        seen |= numeral(word).is_some();
        length += 1;
    }
    seen.then_some((value, length))
}

/// A numeral below a hundred, with hyphens taken out, or a hundred.
fn numeral(word: &str) -> Option<f64> {
    let teens = ["eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen"];
    let tens = ["twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"];
    let ten = |rest: &str| {
        tens.iter().position(|it| rest.starts_with(it)).map(|at| (20.0 + 10.0 * at as f64, tens[at].len()))
    };
    let below = number_word(word).or_else(|| teens.iter().position(|it| *it == word).map(|at| 11.0 + at as f64));
    below.or_else(|| (word == "hundred").then_some(100.0)).or_else(|| {
        let (value, length) = ten(word)?;
        let rest = &word[length..];
        if rest.is_empty() { Some(value) } else { number_word(rest).map(|unit| value + unit) }
    })
}

/// The value of a single word for a number, such as `twelve`.
pub fn number_word(word: &str) -> Option<f64> {
    let words = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];
    words.iter().position(|known| *known == word).map(|value| value as f64)
}

/// Whether a word is a number, or a number with its unit, such as `twenty-metre`.
pub(crate) fn is_numeral(word: &str) -> bool {
    let tokens = fold_numbers(vec![Token::Word(word.to_owned()), Token::Word("metres".to_owned())]);
    matches!(tokens.first(), Some(Token::Number(_))) || tokens.len() > 2
}
