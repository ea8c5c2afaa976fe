//! Rust source as tokens with line numbers, without comments, blanks and items that only tests have.

use std::path::Path;

/// A word, a number, a text, or one sign; `::`, `->` and `=>` are one sign.
#[derive(Clone, Debug)]
pub struct Token {
    /// The text of the token; of a literal text only its first sign.
    pub text: String,
    /// Its first line, counted from 1.
    pub line: usize,
    /// Its last line: literal texts may have several.
    pub last_line: usize,
    /// The whole of a literal text, as it stands in the file; else empty.
    pub literal: String,
}

impl Token {
    pub fn is_word(&self) -> bool {
        self.text.starts_with(|first: char| first.is_alphabetic() || first == '_')
    }
}

/// The tokens of a file, without items marked `#[cfg(test)]`.
pub fn tokens_of_file(file: &Path) -> Vec<Token> {
    let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    without_tests(&tokens(&text))
}

/// The literal texts of a file without those of tests, as the program has them.
pub fn texts_of_file(file: &Path) -> Vec<String> {
    tokens_of_file(file)
        .iter()
        .filter(|token| !token.literal.is_empty())
        .map(|token| unescaped(&token.literal))
        .collect()
}

/// What a literal text stands for: quotes and marks gone, escaped signs and broken lines put together.
fn unescaped(literal: &str) -> String {
    let start = literal.find('"').map_or(0, |quote| quote + 1);
    let inner = literal[start..].trim_end_matches('#').trim_end_matches('"');
    if literal[..start].contains('r') {
        return inner.to_owned();
    }
    let (mut text, mut rest) = (String::new(), inner);
    while let Some(at) = rest.find('\\') {
        text.push_str(&rest[..at]);
        let after = &rest[at + 1..];
        rest = match after.chars().next() {
            Some('\n') => after.trim_start(),
            Some(sign) => {
                text.push(if sign == 'n' { '\n' } else { sign });
                &after[sign.len_utf8()..]
            }
            None => "",
        };
    }
    text + rest
}

/// The tokens of a text.
fn tokens(text: &str) -> Vec<Token> {
    let bytes = text.as_bytes();
    let (mut at, mut line, mut found) = (0, 1, vec![]);
    while at < bytes.len() {
        let end = end_of_token(text, at);
        let piece = &text[at..end];
        let is_comment = piece.starts_with("//") || piece.starts_with("/*");
        let last_line = line + piece.matches('\n').count();
        if !is_comment && !piece.trim().is_empty() {
            let is_text = piece.ends_with(['"', '#']) && piece.len() > 1 || piece.starts_with('\'');
            let kept = if is_text { &piece[..1] } else { piece };
            let kept = if is_text && kept.starts_with(char::is_alphabetic) { "\"" } else { kept };
            let literal = if kept == "\"" { piece.to_owned() } else { String::new() };
            found.push(Token { text: kept.to_owned(), line, last_line, literal });
        }
        (at, line) = (end, last_line);
    }
    found
}

/// The end of the token, comment or blank that begins at a byte.
fn end_of_token(text: &str, at: usize) -> usize {
    let rest = &text[at..];
    let until = |pattern: &str, from: usize| rest[from..].find(pattern).map_or(rest.len(), |found| from + found);
    let first = rest.chars().next().expect("not at the end");
    let length = if rest.starts_with("//") {
        until("\n", 0)
    } else if rest.starts_with("/*") {
        (until("*/", 2) + 2).min(rest.len())
    } else if let Some(length) = length_of_text(rest) {
        length
    } else if first == '\'' {
        length_of_quote(rest)
    } else if first.is_alphanumeric() || first == '_' {
        rest.find(|next: char| !next.is_alphanumeric() && next != '_').unwrap_or(rest.len())
    } else if ["::", "->", "=>"].iter().any(|sign| rest.starts_with(sign)) {
        2
    } else {
        first.len_utf8()
    };
    at + length
}

/// The length of a literal text, plain, raw or of bytes, if one begins here.
fn length_of_text(rest: &str) -> Option<usize> {
    let begins = |prefix: &&str| {
        rest.strip_prefix(*prefix).is_some_and(|rest| match prefix.ends_with('r') {
            true => rest.trim_start_matches('#').starts_with('"'),
            false => rest.starts_with('"'),
        })
    };
    let prefix = ["br", "r", "b", "c", ""].into_iter().find(begins)?;
    let hashes = rest[prefix.len()..].bytes().take_while(|byte| *byte == b'#').count();
    let start = prefix.len() + hashes + 1;
    if prefix.ends_with('r') {
        let end = format!("\"{}", "#".repeat(hashes));
        return Some(rest[start..].find(&end).map_or(rest.len(), |found| start + found + end.len()));
    }
    let (bytes, mut at) = (rest.as_bytes(), start);
    while at < bytes.len() && bytes[at] != b'"' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    Some((at + 1).min(rest.len()))
}

/// The length of a character in quotes or of a lifetime.
fn length_of_quote(rest: &str) -> usize {
    let mut signs = rest.char_indices().skip(1);
    let (_, first) = signs.next().unwrap_or((0, ' '));
    if first == '\\' {
        return 3 + rest[3..].find('\'').unwrap_or(0);
    }
    match signs.next() {
        Some((at, '\'')) => at + 1,
        _ => rest[1..].find(|next: char| !next.is_alphanumeric() && next != '_').map_or(rest.len(), |found| 1 + found),
    }
}

/// The tokens without items that follow `#[cfg(test)]` or `#[cfg(all(test, ...))]`.
fn without_tests(tokens: &[Token]) -> Vec<Token> {
    let (mut at, mut kept) = (0, vec![]);
    while at < tokens.len() {
        if is_test_attribute(tokens, at) {
            at = end_of_item(tokens, at);
        } else {
            kept.push(tokens[at].clone());
            at += 1;
        }
    }
    kept
}

fn is_test_attribute(tokens: &[Token], at: usize) -> bool {
    let is = |offset: usize, text: &str| tokens.get(at + offset).is_some_and(|token| token.text == text);
    let is_cfg = is(0, "#") && is(1, "[") && is(2, "cfg") && is(3, "(");
    is_cfg && (is(4, "test") || is(4, "all") && is(6, "test"))
}

/// The token after an item with its attributes: after its `;` or its outermost braces.
fn end_of_item(tokens: &[Token], start: usize) -> usize {
    let mut at = start;
    while tokens.get(at).is_some_and(|token| token.text == "#") {
        at = end_of_group(tokens, at + 1);
    }
    while let Some(token) = tokens.get(at) {
        match token.text.as_str() {
            ";" => return at + 1,
            "{" => return end_of_group(tokens, at),
            "(" | "[" => at = end_of_group(tokens, at),
            _ => at += 1,
        }
    }
    at
}

/// The token after the bracket that closes the one at `start`.
pub fn end_of_group(tokens: &[Token], start: usize) -> usize {
    let mut depth = 0_usize;
    for (offset, token) in tokens[start..].iter().enumerate() {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return start + offset + 1;
        }
    }
    tokens.len()
}

/// The number of lines that have a token.
pub fn code_lines(tokens: &[Token]) -> usize {
    let (mut last, mut count) = (0, 0);
    for token in tokens {
        count += token.last_line + 1 - token.line.max(last + 1).min(token.last_line + 1);
        last = token.last_line.max(last);
    }
    count
}
