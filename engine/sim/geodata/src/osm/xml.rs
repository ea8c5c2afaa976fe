//! Elements from OSM XML (`.osm`, `.osm.gz`), read as a stream.

use super::elements::{Bounds, Elements, Kind, Member, Rank, Relation, Role, Way};
use super::tags::Tags;
use super::unpacked::Unpacked;
use cosfly_town::MapError;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

/// The elements of a file.
///
/// # Errors
/// Text that is no XML, is cut off, unpacks to far more than such files do, or has an element without its number.
pub fn read(bytes: &[u8]) -> Result<Elements, MapError> {
    let mut xml = Reader::from_reader(Unpacked::new(bytes));
    let mut buffer = Vec::new();
    let mut reading = Reading { elements: Elements::of_file(bytes.len()), open: None, is_complete: false, lanelets: 0 };
    let mut depth = 0_usize;
    loop {
        buffer.clear();
        let at = xml.buffer_position();
        let event = xml
            .read_event_into(&mut buffer)
            .map_err(|error| broken(format!("the file is not readable as OSM XML: {error}"), at))?;
        match &event {
            Event::Start(tag) => {
                reading.open(tag, depth).map_err(|error| located(error, at))?;
                depth += 1;
            }
            Event::Empty(tag) => {
                reading.open(tag, depth).map_err(|error| located(error, at))?;
                if depth <= 1 {
                    reading.close()?;
                }
                reading.is_complete |= depth == 0;
            }
            Event::End(_) => {
                depth = depth.saturating_sub(1);
                if depth == 1 {
                    reading.close()?;
                }
                reading.is_complete |= depth == 0;
            }
            Event::Eof if reading.is_complete => return reading.finished(),
            Event::Eof => {
                return Err(broken("the file ends before `</osm>`".to_owned(), at));
            }
            Event::GeneralRef(_) | Event::DocType(_) | Event::CData(_) | Event::Text(_) | Event::Comment(_) => {}
            Event::Decl(_) | Event::PI(_) => {}
        }
        xml.get_mut().end_piece();
    }
}

fn broken(message: String, at: u64) -> MapError {
    located(MapError::new(message), at)
}

/// Error with a place, a byte of the text, and the usual advice where it has none of its own.
fn located(mut error: MapError, at: u64) -> MapError {
    error.message = format!("{} (byte {at} of the text)", error.message);
    if error.hints.is_empty() {
        error.hint("if the file is cut off or damaged, fetch or export it again")
    } else {
        error
    }
}

/// The file so far.
struct Reading {
    elements: Elements,
    open: Option<Open>,
    is_complete: bool,
    /// Relations of Lanelet2, which has the same container.
    lanelets: usize,
}

/// The element that is open.
enum Open {
    Node { id: i64, place: [i64; 2], tags: Tags, rank: Rank },
    Way(Way),
    Relation(Relation),
}

impl Reading {
    /// A start tag inside `depth` others.
    fn open(&mut self, tag: &BytesStart<'_>, depth: usize) -> Result<(), MapError> {
        match (depth, tag.name().as_ref()) {
            (0, b"osm") if !self.is_complete => Ok(()),
            (0, b"osm") => Err(MapError::new("a second `<osm>` follows the first one")
                .hint("`osmium merge FILE FILE -o NEW.osm.pbf` makes one file of several")),
            (0, _) => Err(MapError::new("the outermost element is not one `<osm>`")),
            (1, b"bounds") => self.bounds(tag),
            (1, b"bound") => self.bound(tag),
            (1, name @ (b"node" | b"way" | b"relation")) => self.element(tag, name),
            (2, b"tag") => self.tag(tag),
            (2, b"nd") => {
                if let Some(Open::Way(way)) = &mut self.open {
                    let node = number(tag, "ref")?;
                    way.nodes
                        .push(node.ok_or_else(|| MapError::new(format!("a `<nd>` of way {} has no `ref`", way.id)))?);
                }
                Ok(())
            }
            (2, b"member") => self.member(tag),
            _ => Ok(()),
        }
    }

    fn bounds(&mut self, tag: &BytesStart<'_>) -> Result<(), MapError> {
        let degrees = |name| Ok::<_, MapError>(attribute(tag, name)?.and_then(|text| text.trim().parse::<f64>().ok()));
        let [west, south, east, north] =
            [degrees("minlon")?, degrees("minlat")?, degrees("maxlon")?, degrees("maxlat")?]
                .map(|side| side.unwrap_or(f64::NAN));
        self.elements.bounds.push(Bounds { low: [west, south], high: [east, north] });
        Ok(())
    }

    /// Bound in the words of osmosis: `box="south,west,north,east"`, degrees.
    fn bound(&mut self, tag: &BytesStart<'_>) -> Result<(), MapError> {
        let text = attribute(tag, "box")?.unwrap_or_default();
        let sides: Vec<f64> = text.split(',').filter_map(|side| side.trim().parse().ok()).collect();
        if let [south, west, north, east] = sides[..] {
            self.elements.bounds.push(Bounds { low: [west, south], high: [east, north] });
        }
        Ok(())
    }

    fn element(&mut self, tag: &BytesStart<'_>, name: &[u8]) -> Result<(), MapError> {
        let kind = String::from_utf8_lossy(name).into_owned();
        let id = number(tag, "id")?.ok_or_else(|| MapError::new(format!("a `<{kind}>` has no `id`")))?;
        let version: u32 = attribute(tag, "version")?.and_then(|text| text.trim().parse().ok()).unwrap_or(0);
        // Editors mark what will be deleted: the next version is gone.
        let is_to_go = attribute(tag, "action")?.as_deref() == Some("delete");
        let rank = self.elements.rank(version.saturating_add(u32::from(is_to_go)));
        let tags = Tags::default();
        if is_to_go || attribute(tag, "visible")?.as_deref() == Some("false") {
            let kind = match name {
                b"node" => Kind::Node,
                b"way" => Kind::Way,
                _ => Kind::Relation,
            };
            self.open = None;
            return self.elements.add_gone(kind, id, rank);
        }
        self.open = Some(match name {
            b"node" => Open::Node { id, place: [degrees(tag, "lon")?, degrees(tag, "lat")?], tags, rank },
            b"way" => Open::Way(Way { id, tags, nodes: Vec::new(), rank }),
            _ => Open::Relation(Relation { id, tags, members: Vec::new(), rank }),
        });
        Ok(())
    }

    fn tag(&mut self, tag: &BytesStart<'_>) -> Result<(), MapError> {
        let tags = match &mut self.open {
            Some(Open::Node { tags, .. }) => tags,
            Some(Open::Way(way)) => &mut way.tags,
            Some(Open::Relation(relation)) => &mut relation.tags,
            None => return Ok(()),
        };
        if let (Some(key), Some(value)) = (attribute(tag, "k")?, attribute(tag, "v")?) {
            tags.add(&key, &value);
            self.lanelets += usize::from(key == "type" && value == "lanelet");
        }
        Ok(())
    }

    fn finished(self) -> Result<Elements, MapError> {
        if self.lanelets > 0 && !self.elements.ways.iter().any(|way| way.tags.has("highway")) {
            let message =
                format!("the file is a Lanelet2 map of {} lanelets, no extract of OpenStreetMap", self.lanelets);
            return Err(MapError::new(message).hint(
                "take the OpenDRIVE file that the map was made of, or an extract of OpenStreetMap of the same place",
            ));
        }
        Ok(self.elements)
    }

    fn member(&mut self, tag: &BytesStart<'_>) -> Result<(), MapError> {
        let Some(Open::Relation(relation)) = &mut self.open else { return Ok(()) };
        let kind = attribute(tag, "type")?.unwrap_or_default();
        let role = Role::of(&attribute(tag, "role")?.unwrap_or_default());
        if let (Some(id), "way" | "relation") = (number(tag, "ref")?, &*kind) {
            relation.members.push(Member { is_way: kind == "way", id, role });
        }
        Ok(())
    }

    fn close(&mut self) -> Result<(), MapError> {
        match self.open.take() {
            Some(Open::Node { id, place, tags, rank }) => self.elements.add_node(id, place, tags, rank),
            Some(Open::Way(way)) => self.elements.add_way(way),
            Some(Open::Relation(relation)) => self.elements.add_relation(relation),
            None => Ok(()),
        }
    }
}

fn attribute(tag: &BytesStart<'_>, name: &str) -> Result<Option<String>, MapError> {
    let unreadable = |problem: String| MapError::new(format!("attribute `{name}` is not readable: {problem}"));
    let found = tag.try_get_attribute(name).map_err(|error| unreadable(error.to_string()))?;
    let Some(found) = found else { return Ok(None) };
    let value = found.normalized_value(XmlVersion::Implicit1_0).map_err(|error| unreadable(error.to_string()))?;
    Ok(Some(value.into_owned()))
}

/// A whole number of an attribute.
fn number(tag: &BytesStart<'_>, name: &str) -> Result<Option<i64>, MapError> {
    let Some(text) = attribute(tag, name)? else { return Ok(None) };
    let shown: String = text.chars().take(40).collect();
    let rule = || MapError::new(format!("`{name}` is `{shown}`; it must be a whole number"));
    text.trim().parse().map(Some).map_err(|_| rule())
}

/// Degrees of an attribute in nanodegrees; absurd where there is none, so that the node counts as one without a place.
fn degrees(tag: &BytesStart<'_>, name: &str) -> Result<i64, MapError> {
    let value: Option<f64> = attribute(tag, name)?.and_then(|text| text.trim().parse().ok());
    let nano = value.map(|degrees| (degrees * 1e7).round() * 100.0).filter(|nano| nano.abs() < 1e12);
    Ok(nano.map_or(i64::MAX, |nano| nano as i64))
}
