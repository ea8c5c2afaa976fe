//! Elements that the reader does not know, mistyped ones above all: each name is one warning, as its content is missing.

use super::attributes::Source;
use roxmltree::Node;
use std::collections::BTreeMap;

/// Elements that may stand anywhere, for other programs.
pub(super) const ANYWHERE: [&str; 3] = ["userData", "dataQuality", "include"];

/// Elements whose children are looked at, and the children that are read or say nothing of a town.
const KNOWN: &[(&str, &[&str])] = &[
    ("OpenDRIVE", &["header", "road", "controller", "junction", "junctionGroup", "station"]),
    ("header", &["geoReference", "offset", "license", "defaultRegulations"]),
    (
        "road",
        &[
            "link",
            "type",
            "planView",
            "elevationProfile",
            "lateralProfile",
            "lanes",
            "objects",
            "signals",
            "surface",
            "railroad",
        ],
    ),
    ("planView", &["geometry"]),
    ("elevationProfile", &["elevation"]),
    ("lateralProfile", &["superelevation", "crossfall", "shape"]),
    ("lanes", &["laneOffset", "laneSection"]),
    ("laneSection", &["left", "center", "right"]),
    ("left", &["lane"]),
    ("center", &["lane"]),
    ("right", &["lane"]),
    ("lane", &["link", "width", "border", "roadMark", "material", "visibility", "speed", "access", "height", "rule"]),
    ("objects", &["object", "objectReference", "tunnel", "bridge"]),
    (
        "object",
        &["repeat", "outline", "outlines", "material", "validity", "parkingSpace", "markings", "borders", "surface"],
    ),
    ("outlines", &["outline"]),
    ("outline", &["cornerRoad", "cornerLocal"]),
    ("signals", &["signal", "signalReference"]),
];

/// Warns of unknown elements below the root, and of other files that are not followed.
pub(super) fn warn<'d>(source: &Source<'d>, root: Node<'d, 'd>) {
    let mut unknown: BTreeMap<(&str, &str), (usize, Node)> = BTreeMap::new();
    let mut open = vec![root];
    while let Some(parent) = open.pop() {
        let parent_name = parent.tag_name().name();
        let Some((_, known)) = KNOWN.iter().find(|(name, _)| *name == parent_name) else { continue };
        for child in parent.children().filter(Node::is_element) {
            let name = child.tag_name().name();
            if name == "include" {
                let file: String = child.attribute("file").unwrap_or_default().chars().take(80).collect();
                source.warn(child, &format!("the file `{file}` is not followed: put its content in this place"));
            } else if known.contains(&name) {
                open.push(child);
            } else if !ANYWHERE.contains(&name) {
                let (count, first) = unknown.entry((parent_name, name)).or_insert((0, child));
                *count += 1;
                *first = if child.range().start < first.range().start { child } else { *first };
            }
        }
    }
    for ((parent, name), (count, first)) in unknown {
        let more = if count > 1 { format!(", as {} more are", count - 1) } else { String::new() };
        source.warn(first, &format!("`<{name}>` in `<{parent}>` is no element that is read; it is left out{more}"));
    }
}
