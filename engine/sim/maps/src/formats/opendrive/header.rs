//! `<header>` into the model: name, projection, and the offset of all coordinates.

use super::attributes::{ANGLE, COORDINATE, OFFSET, Source};
use cosfly_frames::DVec3;
use cosfly_geodata::reference::unusual_words;
use cosfly_town::error::MapError;
use cosfly_town::remarks::speaks_of_a_place;
use roxmltree::Node;

/// Statements of the header about the whole file.
#[derive(Debug, Default)]
pub(super) struct Header {
    pub(super) name: Option<String>,
    pub(super) geo_reference: Option<String>,
    /// Added to coordinates that are turned already, metres.
    pub(super) offset_m: DVec3,
    /// Turn of all coordinates about the origin, counter-clockwise.
    pub(super) turn_rad: f64,
    /// Our own `userData`: land without a surface is lawn, also between houses.
    pub(super) has_lawn: bool,
}

/// Reads the header; a file may have none.
///
/// # Errors
/// Two headers, two of its elements, and numbers that are none.
pub(super) fn read<'d>(source: &Source<'d>, root: Node<'d, 'd>) -> Result<Header, MapError> {
    let Some(node) = source.only_child(root, "header")? else { return Ok(Header::default()) };
    let mut header = Header { name: node.attribute("name").and_then(text), ..Header::default() };
    if let Some(reference) = source.only_child(node, "geoReference")? {
        header.geo_reference = text(&all_text(reference));
        if let Some(words) = header.geo_reference.as_deref().and_then(unusual_words) {
            source.warn(
                reference,
                &format!("`{words}` is not read: coordinates are metres, x to the east and y to the north"),
            );
        }
    }
    if let Some(offset) = source.only_child(node, "offset")? {
        let number = |name, limits| Ok::<_, MapError>(source.optional_number(offset, name, limits)?.unwrap_or(0.0));
        header.offset_m = DVec3::new(number("x", COORDINATE)?, number("y", COORDINATE)?, number("z", OFFSET)?);
        header.turn_rad = number("hdg", ANGLE)?;
    }
    for data in node.children().filter(|child| child.tag_name().name() == "userData") {
        match (data.attribute("code"), data.attribute("value")) {
            (Some("open_ground"), Some("lawn")) => header.has_lawn = true,
            (Some("open_ground"), _) => source.warn(data, "`open_ground` must be `lawn`; courts may become bare"),
            _ => warn_of_places(source, data),
        }
    }
    Ok(header)
}

fn text(value: &str) -> Option<String> {
    (!value.trim().is_empty()).then(|| value.trim().to_owned())
}

/// Text of an element, whatever lies between its pieces.
fn all_text(node: Node) -> String {
    node.children().filter(Node::is_text).filter_map(|piece| piece.text()).collect()
}

/// Data of other programs are not read: says so where they seem to hold an offset or a projection.
fn warn_of_places<'d>(source: &Source<'d>, data: Node<'d, 'd>) {
    for node in data.descendants().filter(Node::is_element) {
        let attributes = node.attributes().map(|one| format!("{}={}", one.name(), one.value()));
        let said =
            [node.tag_name().name().to_owned(), attributes.collect::<Vec<_>>().join(" "), all_text(node)].join(" ");
        if speaks_of_a_place(&said) {
            let shown: String = said.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(80).collect();
            source.warn(
                node,
                &format!("`{shown}` is not applied: places are those of `<offset>` and `<geoReference>` alone"),
            );
        }
    }
}
