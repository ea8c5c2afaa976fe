//! The XML of a file: parsed with bounds, or refused at its place.

use super::attributes::Source;
use super::xml_bounds;
use cosfly_town::error::MapError;
use cosfly_town::text::{LineStarts, decoded};
use roxmltree::{Document, ParsingOptions};

/// Most XML nodes of one file.
const MOST_NODES: u32 = 30_000_000;

/// Parses the XML and hands it on; collects the warnings.
pub(super) fn with_source<T>(
    bytes: &[u8],
    work: impl FnOnce(&Source<'_>, &LineStarts<'_>) -> Result<T, MapError>,
) -> Result<(T, Vec<String>), MapError> {
    let text = decoded(bytes)?;
    let lines = LineStarts::new(&text);
    xml_bounds::check(&text, &lines)?;
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&text, options).map_err(|error| broken_xml(&error, &text, &lines))?;
    let source = Source::new(&document, &lines);
    let done = work(&source, &lines)?;
    Ok((done, source.into_warnings()))
}

fn broken_xml(error: &roxmltree::Error, text: &str, lines: &LineStarts<'_>) -> MapError {
    // For a file that just stops the parser has no position.
    let stops = matches!(error, roxmltree::Error::UnclosedRootNode | roxmltree::Error::UnexpectedEndOfStream);
    let position = error.pos();
    let at = if stops { text.trim_end().len().saturating_sub(1) } else { lines.byte_at(position.row, position.col) };
    // The parser's own text ends with the position, which the place says better.
    let reason = error.to_string();
    let reason = reason.rsplit_once(" at ").map_or(reason.as_str(), |(before, _)| before);
    let truncated = stops || at + 1 >= text.trim_end().len();
    let hint = if truncated {
        "the file seems to be cut off: fetch or export it again"
    } else {
        "repair the XML at this place, or export the map again"
    };
    let place = lines.place(at..at + 1, String::new());
    MapError::new(format!("broken XML: {reason}")).at(place).hint(hint)
}
