//! Bounds on the XML of a file, checked before it is parsed: the parser's work grows with the square of an element's
//! attributes and of the depth of elements that declare namespaces.

use cosfly_town::error::MapError;
use cosfly_town::text::LineStarts;

/// Deepest nesting of elements; OpenDRIVE itself has about ten levels.
const DEEPEST: usize = 100;
/// Most attributes of one element; OpenDRIVE itself has about twenty.
const MOST_ATTRIBUTES: usize = 1000;

/// Refuses elements that are nested too deeply or have too many attributes. Text that is not XML may pass: the parser
/// refuses it.
pub(super) fn check(text: &str, lines: &LineStarts<'_>) -> Result<(), MapError> {
    let refuse = |at: usize, rule: String| Err(MapError::new(rule).at(lines.place(at..at + 1, String::new())));
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(start) = text[at..].find('<').map(|found| at + found) {
        let rest = &text[start..];
        if let Some(end) = end_of_aside(rest) {
            at = start + end;
            continue;
        }
        let tag = Tag::read(rest);
        if tag.attributes > MOST_ATTRIBUTES {
            return refuse(start, format!("an element has more than {MOST_ATTRIBUTES} attributes"));
        }
        match (rest.starts_with("</"), tag.is_empty_element) {
            (true, _) => depth = depth.saturating_sub(1),
            (false, true) => {}
            (false, false) => depth += 1,
        }
        if depth > DEEPEST {
            return refuse(start, format!("elements are nested more than {DEEPEST} deep"));
        }
        at = start + tag.bytes;
    }
    Ok(())
}

/// End of a comment, character data, processing instruction or declaration that `text` begins with.
fn end_of_aside(text: &str) -> Option<usize> {
    let (_, end) = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>"), ("<!", ">")]
        .into_iter()
        .find(|(begin, _)| text.starts_with(begin))?;
    Some(text.find(end).map_or(text.len(), |found| found + end.len()))
}

/// A start or end tag.
struct Tag {
    bytes: usize,
    attributes: usize,
    /// Ends in `/>`.
    is_empty_element: bool,
}

impl Tag {
    /// The tag that `text` begins with, up to its end or the end of `text`.
    fn read(text: &str) -> Self {
        let (mut attributes, mut quote) = (0, None);
        for (at, byte) in text.bytes().enumerate() {
            match (quote, byte) {
                (Some(open), _) if open == byte => quote = None,
                (Some(_), _) => {}
                (None, b'"' | b'\'') => {
                    quote = Some(byte);
                    attributes += 1;
                }
                (None, b'>') => {
                    let is_empty_element = text.as_bytes()[at - 1] == b'/';
                    return Self { bytes: at + 1, attributes, is_empty_element };
                }
                _ => {}
            }
        }
        Self { bytes: text.len(), attributes, is_empty_element: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_text(text: &str) -> Result<(), String> {
        check(text, &LineStarts::new(text)).map_err(|error| error.message)
    }

    #[test]
    fn nesting_and_attributes_are_bounded_and_nothing_else_counts() {
        let nested = |depth: usize| format!("{}{}", "<a b='>'>".repeat(depth), "</a>".repeat(depth));
        let attributes = |count: usize| {
            let all: String = (0..count).map(|i| format!(" a{i}=\"/>\"")).collect();
            format!("<a{all}/>")
        };
        assert_eq!(check_text(&nested(DEEPEST)), Ok(()));
        assert!(check_text(&nested(DEEPEST + 1)).is_err_and(|rule| rule.contains("nested")));
        assert_eq!(check_text(&attributes(MOST_ATTRIBUTES)), Ok(()));
        assert!(check_text(&attributes(MOST_ATTRIBUTES + 1)).is_err_and(|rule| rule.contains("attributes")));
        let aside = format!("<!-- {0} --><![CDATA[ {0} ]]><?a {0} ?><b/>", "<a><a>".repeat(DEEPEST));
        assert_eq!(check_text(&aside), Ok(()));
        assert_eq!(check_text(&"<a/>".repeat(1000)), Ok(()));
        for unfinished in ["<", "<a b='", "<!--", "</", "<![CDATA["] {
            assert_eq!(check_text(unfinished), Ok(()));
        }
    }
}
