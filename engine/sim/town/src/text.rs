//! The file's text: decoding of the bytes, and lines and columns of byte positions.

use crate::error::{MapError, TextPlace};
use core::ops::Range;
use std::borrow::Cow;

/// Largest file that is read, bytes.
const LARGEST_FILE: usize = 512 << 20;

/// The text of a map file without its byte-order mark. Latin-1 is decoded when the XML declaration says so.
pub fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, MapError> {
    if bytes.len() > LARGEST_FILE {
        let message = format!("the file has {} bytes; at most {LARGEST_FILE} are read", bytes.len());
        return Err(MapError::new(message).hint("cut the map into smaller pieces"));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(MapError::new("the file is UTF-16 text; it must be UTF-8").hint("save it as UTF-8"));
    }
    let bytes = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
    match core::str::from_utf8(bytes) {
        Ok(text) => Ok(Cow::Borrowed(text)),
        Err(_) if declares_latin1(bytes) => Ok(Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect())),
        Err(error) => {
            let good = error.valid_up_to();
            let text = core::str::from_utf8(&bytes[..good]).unwrap_or_default();
            let place = LineStarts::new(text).place(good..good + 1, String::new());
            let message = format!("byte 0x{:02x} is not UTF-8 text", bytes[good]);
            Err(MapError::new(message)
                .at(place)
                .hint("save the file as UTF-8; a file that is no text is of a format that is not read here"))
        }
    }
}

fn declares_latin1(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_ascii_lowercase();
    let declaration = head.split("?>").next().unwrap_or_default();
    ["iso-8859-1", "latin1", "windows-1252"].iter().any(|name| declaration.contains(name))
}

/// A refusal of the JSON parser at its place in the text.
pub fn refused_json(error: &serde_json::Error, text: &str) -> MapError {
    let lines = LineStarts::new(text);
    let at = lines.byte_at(error.line() as u32, error.column() as u32);
    // The parser's own text ends with the position, which the place says better.
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(before, _)| before);
    let message = in_plain_words(message);
    let hint = if error.is_eof() {
        "the file seems to be cut off: fetch or export it again"
    } else {
        "the book's pages on maps describe the format"
    };
    MapError::new(message).at(lines.place(at..(at + 1).min(text.len()).max(at), String::new())).hint(hint)
}

/// A parser's words without the names of types of numbers.
fn in_plain_words(message: &str) -> String {
    let plain = [
        ("expected u64", "expected a whole number from 0 on"),
        ("expected u32", "expected a whole number from 0 on"),
        ("expected usize", "expected a whole number from 0 on"),
        ("expected f64", "expected a number"),
    ];
    plain.iter().fold(message.to_owned(), |text, (jargon, words)| text.replace(jargon, words))
}

/// Starts of the lines, so that a position becomes a line and a column in little time.
pub struct LineStarts<'t> {
    text: &'t str,
    starts: Vec<usize>,
}

impl<'t> LineStarts<'t> {
    /// Reader of a text.
    pub fn new(text: &'t str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1);
        Self { text, starts: core::iter::once(0).chain(ends).collect() }
    }

    /// The place of some bytes; `element` names the element there.
    pub fn place(&self, byte_span: Range<usize>, element: String) -> TextPlace {
        let line = self.starts.partition_point(|start| *start <= byte_span.start).max(1);
        let before = self.text.get(self.starts[line - 1]..byte_span.start).unwrap_or_default();
        let column = before.chars().count() as u32 + 1;
        TextPlace { line: line as u32, column, byte_span, element }
    }

    /// The byte at a line and column (characters), both from 1; held to the text.
    pub fn byte_at(&self, line: u32, column: u32) -> usize {
        let start = self.starts.get(line.max(1) as usize - 1).copied().unwrap_or(self.text.len());
        let rest = self.text.get(start..).unwrap_or_default();
        start + rest.char_indices().nth(column.max(1) as usize - 1).map_or(rest.len(), |(at, _)| at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_lines_and_characters_from_one() {
        let lines = LineStarts::new("ab\n\u{fc}x\n\nend");
        for (at, expected) in [(0, (1, 1)), (2, (1, 3)), (3, (2, 1)), (5, (2, 2)), (7, (3, 1)), (11, (4, 4))] {
            let place = lines.place(at..at, String::new());
            assert_eq!((place.line, place.column), expected, "byte {at}");
        }
    }

    #[test]
    fn byte_order_marks_go_and_latin1_needs_a_declaration() {
        assert_eq!(decoded(b"\xef\xbb\xbf<a/>").unwrap(), "<a/>");
        assert_eq!(
            decoded(b"<?xml encoding='ISO-8859-1'?><a n='\xfc'/>").unwrap(),
            "<?xml encoding='ISO-8859-1'?><a n='\u{fc}'/>"
        );
        let error = decoded(b"<a>\n \xfc</a>").unwrap_err();
        let place = error.place.unwrap();
        assert_eq!((place.line, place.column), (2, 2));
    }
}
