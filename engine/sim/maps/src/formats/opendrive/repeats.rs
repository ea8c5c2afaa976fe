//! Things of a road that are there again, in the same place and size: each kind is one warning.

use super::attributes::{Source, children};
use roxmltree::Node;
use std::collections::BTreeMap;

/// Lists of things, and the things in them.
const THINGS: [[&str; 2]; 2] = [["objects", "object"], ["signals", "signal"]];

/// Warns of objects and signals that equal an earlier one of their road, whatever their `id`.
pub(super) fn warn<'d>(source: &Source<'d>, root: Node<'d, 'd>) {
    for [list, name] in THINGS {
        let mut first: Option<(Node, Node)> = None;
        let mut count = 0;
        for road in children(root, "road") {
            let mut known: BTreeMap<Key<'d>, Node> = BTreeMap::new();
            for thing in children(road, list).flat_map(|list| children(list, name)) {
                let earlier = *known.entry(key(source, thing)).or_insert(thing);
                if earlier != thing {
                    count += 1;
                    first.get_or_insert((thing, earlier));
                }
            }
        }
        if let Some((thing, earlier)) = first {
            let more = if count > 1 { format!(", as {} more are", count - 1) } else { String::new() };
            let line = source.line(earlier);
            source.warn(thing, &format!("the `<{name}>` of line {line} is there again; both are read{more}"));
        }
    }
}

/// Attributes of a thing without its `id`, and the text of its content.
type Key<'d> = (Vec<(&'d str, &'d str)>, &'d str);

fn key<'d>(source: &Source<'d>, thing: Node<'d, 'd>) -> Key<'d> {
    let attributes = thing.attributes().filter(|one| one.name() != "id");
    let mut attributes: Vec<(&str, &str)> = attributes.map(|one| (one.name(), one.value())).collect();
    attributes.sort_unstable();
    let content = source.start_tag(thing).end..thing.range().end;
    let content = if thing.has_children() { &source.document.input_text()[content] } else { "" };
    (attributes, content)
}
