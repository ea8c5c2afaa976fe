//! Numbers and names out of XML attributes; each refusal says its line, column, element and rule.

use super::polynomial::{Cubic, CubicProfile};
use core::cell::{Cell, RefCell};
use cosfly_town::error::{MapError, TextPlace};
use cosfly_town::text::LineStarts;
use roxmltree::{Document, Node};

/// Range of a number in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    low: f64,
    high: f64,
    unit: &'static str,
}

/// A coordinate of the plan view.
pub(super) const COORDINATE: Limits = Limits { low: -1e8, high: 1e8, unit: " m" };
/// A length of a road or of a piece of its reference line.
pub(super) const LENGTH: Limits = Limits { low: 0.0, high: 1e6, unit: " m" };
/// A position along a road; exporters write tiny negative ones.
pub(super) const STATION: Limits = Limits { low: -1e-3, high: 1e6, unit: " m" };
/// A distance to the side of, or above, the road.
pub(super) const OFFSET: Limits = Limits { low: -1e5, high: 1e5, unit: " m" };
/// A width of a lane, or a size of an object.
pub(super) const SIZE: Limits = Limits { low: 0.0, high: 1e3, unit: " m" };
/// A size of an object that exporters also write as -1 for "unknown".
pub(super) const LOOSE_SIZE: Limits = Limits { low: -1e3, high: 1e4, unit: " m" };
/// An angle in radians.
pub(super) const ANGLE: Limits = Limits { low: -1e4, high: 1e4, unit: " rad" };
/// A curvature.
pub(super) const CURVATURE: Limits = Limits { low: -1e3, high: 1e3, unit: " 1/m" };
/// A coefficient of a cubic.
pub(super) const COEFFICIENT: Limits = Limits { low: -1e8, high: 1e8, unit: "" };

impl Limits {
    /// Limits of this size with either sign: polynomials dip below zero where a lane ends.
    pub(super) const fn into_signed(self) -> Self {
        Self { low: -self.high, ..self }
    }
}

const WARNINGS_WITH_PLACES: usize = 100;
/// Most lanes over all lane sections of a file.
const MOST_LANES: usize = 1_000_000;

/// The document that is read, and the warnings about it.
pub(super) struct Source<'d> {
    pub(super) document: &'d Document<'d>,
    lines: &'d LineStarts<'d>,
    warnings: RefCell<Vec<String>>,
    left_out: Cell<usize>,
    lanes: Cell<usize>,
}

impl<'d> Source<'d> {
    pub(super) fn new(document: &'d Document<'d>, lines: &'d LineStarts<'d>) -> Self {
        Self { document, lines, warnings: RefCell::default(), left_out: Cell::new(0), lanes: Cell::new(0) }
    }

    /// Counts lanes of a lane section; refuses more than any map has.
    pub(super) fn count_lanes(&self, section: Node, lanes: usize) -> Result<(), MapError> {
        self.lanes.set(self.lanes.get() + lanes);
        if self.lanes.get() > MOST_LANES {
            return Err(
                self.refuse(section, format!("the map has more than {MOST_LANES} lanes over all lane sections"))
            );
        }
        Ok(())
    }

    /// Notes something the reader coped with. Only the first hundred are kept, then they are counted.
    pub(super) fn warn(&self, node: Node, message: &str) {
        if self.warnings.borrow().len() < WARNINGS_WITH_PLACES {
            let place = self.place(node, node.range());
            let text = format!("line {}, {}: {message}", place.line, place.element);
            self.warnings.borrow_mut().push(text);
        } else {
            self.left_out.set(self.left_out.get() + 1);
        }
    }

    /// All warnings so far.
    pub(super) fn into_warnings(self) -> Vec<String> {
        let mut warnings = self.warnings.into_inner();
        if self.left_out.get() > 0 {
            warnings.push(format!("and {} more warnings of these kinds", self.left_out.get()));
        }
        warnings
    }

    fn place(&self, node: Node, byte_span: core::ops::Range<usize>) -> TextPlace {
        self.lines.place(byte_span, described(node))
    }

    /// The start tag of an element; the whole element may be half the file.
    pub(super) fn start_tag(&self, node: Node) -> core::ops::Range<usize> {
        let range = node.range();
        let end = self.document.input_text()[range.clone()].find('>');
        range.start..end.map_or(range.end, |end| range.start + end + 1)
    }

    /// A refusal at an element.
    pub(super) fn refuse(&self, node: Node, message: impl Into<String>) -> MapError {
        MapError::new(message).at(self.place(node, self.start_tag(node)))
    }

    /// A number that must be there.
    pub(super) fn number(&self, node: Node, name: &str, limits: Limits) -> Result<f64, MapError> {
        self.optional_number(node, name, limits)?
            .ok_or_else(|| self.refuse(node, format!("`{}` has no `{name}`", node.tag_name().name())))
    }

    /// A number that may be missing.
    pub(super) fn optional_number(&self, node: Node, name: &str, limits: Limits) -> Result<Option<f64>, MapError> {
        let Some(attribute) = node.attribute_node(name) else {
            return Ok(None);
        };
        let rule = match attribute.value().trim().parse::<f64>() {
            Err(_) => "it must be a number".to_owned(),
            Ok(value) if !value.is_finite() => "it must be a finite number".to_owned(),
            Ok(value) if value < limits.low || value > limits.high => {
                format!("it must lie between {} and {}{}", limits.low, limits.high, limits.unit)
            }
            Ok(value) => return Ok(Some(value)),
        };
        let shown: String = attribute.value().chars().take(40).collect();
        let message = format!("`{name}` is `{shown}`; {rule}");
        Err(MapError::new(message).at(self.place(node, attribute.range_value())))
    }

    /// The four coefficients `a`, `b`, `c`, `d` with a suffix; missing ones are 0.
    pub(super) fn coefficients(&self, node: Node, suffix: &str) -> Result<[f64; 4], MapError> {
        let mut out = [0.0; 4];
        for (value, letter) in out.iter_mut().zip(["a", "b", "c", "d"]) {
            *value = self.optional_number(node, &format!("{letter}{suffix}"), COEFFICIENT)?.unwrap_or(0.0);
        }
        Ok(out)
    }

    /// The element child with this name, where there is one.
    ///
    /// # Errors
    /// A second one: none of the two may win in silence.
    pub(super) fn only_child(&self, node: Node<'d, 'd>, name: &'static str) -> Result<Option<Node<'d, 'd>>, MapError> {
        let mut found = children(node, name);
        let first = found.next();
        if let (Some(first), Some(second)) = (first, found.next()) {
            let line = self.line(first);
            let message = format!("a second `<{name}>` in `<{}>`; it may have one", node.tag_name().name());
            return Err(self.refuse(second, message).hint(format!("remove this one, or the first one in line {line}")));
        }
        Ok(first)
    }

    /// The profile of records; a second record at the same place that says something else is a warning.
    pub(super) fn profile(&self, mut records: Vec<(Node, Cubic)>) -> CubicProfile {
        records.sort_by(|a, b| a.1.start_s_m.total_cmp(&b.1.start_s_m));
        for pair in records.windows(2).filter(|pair| pair[0].1.start_s_m == pair[1].1.start_s_m) {
            if pair[0].1 != pair[1].1 {
                let name = pair[1].0.tag_name().name();
                self.warn(pair[1].0, &format!("a second `<{name}>` at the same place; this one counts"));
            }
        }
        CubicProfile::new(records.into_iter().map(|(_, cubic)| cubic).collect())
    }

    /// Line of an element, from 1.
    pub(super) fn line(&self, node: Node) -> u32 {
        self.place(node, node.range()).line
    }

    /// A text attribute that must be there.
    pub(super) fn text(&self, node: Node<'d, 'd>, name: &str) -> Result<&'d str, MapError> {
        node.attribute(name).ok_or_else(|| self.refuse(node, format!("`{}` has no `{name}`", node.tag_name().name())))
    }
}

/// ``<width> of lane `-1` of road `12` ``, from the element up to its road.
fn described(node: Node) -> String {
    let mut text = format!("<{}>", node.tag_name().name());
    for ancestor in node.ancestors().filter(Node::is_element) {
        let name = ancestor.tag_name().name();
        if let (true, Some(id)) =
            (matches!(name, "lane" | "road" | "object" | "signal" | "junction"), ancestor.attribute("id"))
        {
            let id: String = id.chars().take(40).collect();
            if ancestor == node {
                text.push_str(&format!(" `{id}`"));
            } else {
                text.push_str(&format!(" of {name} `{id}`"));
            }
        }
        if name == "road" {
            break;
        }
    }
    text
}

/// The element children with this name.
pub(super) fn children<'d>(node: Node<'d, 'd>, name: &'static str) -> impl Iterator<Item = Node<'d, 'd>> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

/// The first element child with this name.
pub(super) fn child<'d>(node: Node<'d, 'd>, name: &'static str) -> Option<Node<'d, 'd>> {
    children(node, name).next()
}
