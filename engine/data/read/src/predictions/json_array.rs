//! The elements of a JSON array, one at a time: a fault in one of them is a fault of that row, not of the file.

use std::ops::Range;

/// Words that Python's `json` writes for numbers that JSON cannot hold.
const BARE_WORDS: [&[u8]; 2] = [b"NaN", b"Infinity"];

/// Fault of an array as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArrayFault {
    /// Byte where it is wrong.
    pub at: usize,
    /// Fault, as the end of a sentence.
    pub what: String,
}

/// Calls `take` with the number (from 1) and the bytes of every element of the array that `text` begins with.
///
/// # Errors
/// The array has no end, or something follows it: rows may be lost.
pub fn each_element(text: &[u8], take: &mut dyn FnMut(u64, Range<usize>)) -> Result<(), ArrayFault> {
    let open = text.iter().position(|byte| *byte == b'[').map_or(0, |at| at + 1);
    let (mut start, mut number, mut depth) = (open, 1, 0_u64);
    let mut strings = Strings::default();
    for (at, byte) in text.iter().enumerate().skip(open) {
        if strings.holds(*byte) {
            continue;
        }
        match byte {
            b'[' | b'{' => depth += 1,
            b']' if depth == 0 => {
                let is_empty = number == 1 && text[start..at].trim_ascii().is_empty();
                if !is_empty {
                    take(number, start..at);
                }
                let rest = text[at + 1..].iter().position(|byte| !byte.is_ascii_whitespace());
                return match rest {
                    Some(more) => Err(ArrayFault { at: at + 1 + more, what: "something follows the array".to_owned() }),
                    None => Ok(()),
                };
            }
            b']' | b'}' => depth = depth.saturating_sub(1),
            b',' if depth == 0 => {
                take(number, start..at);
                (start, number) = (at + 1, number + 1);
            }
            _ => {}
        }
    }
    Err(ArrayFault { at: start, what: format!("the file ends within row {number}, which begins here") })
}

/// Place and name of the first number of an element that JSON cannot hold: `NaN`, `Infinity` outside of strings.
pub fn bare_word(element: &[u8]) -> Option<(usize, String)> {
    let mut strings = Strings::default();
    let (mut string, mut key) = (0..0, None);
    for (at, byte) in element.iter().enumerate() {
        let was_inside = strings.is_inside;
        let is_text = strings.holds(*byte);
        match (was_inside, strings.is_inside) {
            (false, true) => string.start = at + 1,
            (true, false) => string.end = at,
            _ => {}
        }
        if is_text {
            continue;
        }
        if *byte == b':' {
            key = element.get(string.clone()).map(|name| String::from_utf8_lossy(name).into_owned());
        }
        if BARE_WORDS.iter().any(|word| element[at..].starts_with(word)) {
            return Some((at, key.map_or_else(|| "a number".to_owned(), |key| format!("`{key}`"))));
        }
    }
    None
}

/// Whether a reader is inside of a string.
#[derive(Default)]
struct Strings {
    is_inside: bool,
    is_escaped: bool,
}

impl Strings {
    /// Whether the next byte belongs to a string, its quotes included.
    fn holds(&mut self, byte: u8) -> bool {
        let was_inside = self.is_inside;
        match byte {
            _ if self.is_escaped => self.is_escaped = false,
            b'\\' if self.is_inside => self.is_escaped = true,
            b'"' => self.is_inside = !self.is_inside,
            _ => {}
        }
        was_inside || self.is_inside
    }
}

/// Lines and columns of ascending places of a text.
#[derive(Default)]
pub struct Places {
    read: usize,
    lines: usize,
    line_start: usize,
}

impl Places {
    /// Line and column, from 1, of a byte that is not before the one asked for last.
    pub fn of(&mut self, text: &[u8], at: usize) -> (usize, usize) {
        let at = at.clamp(self.read, text.len());
        for (place, _) in text[self.read..at].iter().enumerate().filter(|(_, byte)| **byte == b'\n') {
            (self.lines, self.line_start) = (self.lines + 1, self.read + place + 1);
        }
        self.read = at;
        (self.lines + 1, at - self.line_start + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elements(text: &str) -> (Vec<String>, Result<(), ArrayFault>) {
        let mut found = vec![];
        let end = each_element(text.as_bytes(), &mut |_, range| found.push(text[range].trim().to_owned()));
        (found, end)
    }

    #[test]
    fn elements_end_at_their_own_commas_only() {
        let (found, end) = elements(" [ {\"a\": [1, 2], \"b\": \"],\\\"[\"} , 3,\n[4, {}] ]\n");
        assert_eq!((found.len(), end), (3, Ok(())), "{found:?}");
        assert_eq!(found[2], "[4, {}]");
        assert_eq!(elements("[]"), (vec![], Ok(())));
        assert_eq!(elements("[1,,2]").0, ["1", "", "2"]);
    }

    #[test]
    fn arrays_of_which_rows_may_be_lost_are_faults() {
        let (found, end) = elements("[{\"a\": 1}, {\"a\": 2");
        assert_eq!((found.len(), end.unwrap_err().at), (1, 10));
        assert_eq!(elements("[1][2]").1.unwrap_err().at, 3);
    }

    #[test]
    fn numbers_that_json_cannot_hold_are_found_with_their_names() {
        let found = bare_word(b"{\"a\": \"NaN\", \"score\": NaN}");
        assert_eq!(found, Some((22, "`score`".to_owned())));
        assert_eq!(bare_word(b"{\"bbox\": [1, -Infinity]}"), Some((14, "`bbox`".to_owned())));
        assert_eq!(bare_word(b"{\"a\": 1}"), None);
        let mut places = Places::default();
        assert_eq!(
            (places.of(b"a\nbc\n", 0), places.of(b"a\nbc\n", 3), places.of(b"a\nbc\n", 5)),
            ((1, 1), (2, 2), (3, 1))
        );
    }
}
