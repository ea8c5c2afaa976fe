//! [`Elements`]: nodes, ways and relations of a file, whatever its container.

use super::tags::Tags;
use cosfly_town::MapError;

/// Most nodes, ways, relations and references between them in one file; a city of millions has fewer.
const MOST_PARTS: usize = 40_000_000;
/// Units of a coordinate in one degree.
pub const UNITS_PER_DEGREE: f64 = 1e7;

/// Everything that a file states.
#[derive(Debug, Default)]
pub struct Elements {
    /// Area that the file was cut to.
    pub bounds: Option<Bounds>,
    /// Nodes, sorted by id.
    pub nodes: Vec<Node>,
    /// Tags of those nodes that have any, sorted by id.
    pub node_tags: Vec<(i64, Tags)>,
    /// Ways, sorted by id.
    pub ways: Vec<Way>,
    /// Relations, sorted by id.
    pub relations: Vec<Relation>,
    /// Nodes without a usable place.
    pub without_place: usize,
    parts: usize,
}

/// A point, in ten-millionths of a degree as the map's own database has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// Number of the node.
    pub id: i64,
    /// Longitude.
    pub lon: i32,
    /// Latitude.
    pub lat: i32,
}

/// An area in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// South-west corner: longitude, latitude.
    pub low: [f64; 2],
    /// North-east corner: longitude, latitude.
    pub high: [f64; 2],
}

/// A line, or the rim of an area.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Number of the way.
    pub id: i64,
    /// Its known tags.
    pub tags: Tags,
    /// Its nodes in order; first and last are equal where it is closed.
    pub nodes: Vec<i64>,
}

/// A group of elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Relation {
    /// Number of the relation.
    pub id: i64,
    /// Its known tags.
    pub tags: Tags,
    /// Its members in order.
    pub members: Vec<Member>,
}

/// A member of a relation; nodes are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// Whether it is a way, not a relation.
    pub is_way: bool,
    /// Number of the element.
    pub id: i64,
    /// What it is in the relation.
    pub role: Role,
}

/// Roles of members that are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Outer rim of an area, or none stated.
    Outer,
    /// Rim of a hole.
    Inner,
    /// Outline of a building of parts.
    Outline,
    /// Part of a building.
    Part,
    /// Any other.
    Other,
}

impl Role {
    /// The role called `name`.
    pub fn of(name: &str) -> Self {
        match name {
            "outer" | "" => Self::Outer,
            "inner" => Self::Inner,
            "outline" => Self::Outline,
            "part" => Self::Part,
            _ => Self::Other,
        }
    }
}

impl Elements {
    /// Takes a node whose place is given in nanodegrees.
    pub fn add_node(&mut self, id: i64, [lon, lat]: [i64; 2], tags: Tags) -> Result<(), MapError> {
        self.count(1)?;
        let is_place = lon.unsigned_abs() <= 180_000_000_000 && lat.unsigned_abs() <= 90_000_000_000;
        if !is_place {
            self.without_place += 1;
            return Ok(());
        }
        let unit = |nano: i64| (nano + 50).div_euclid(100) as i32;
        self.nodes.push(Node { id, lon: unit(lon), lat: unit(lat) });
        if !tags.is_empty() {
            self.node_tags.push((id, tags));
        }
        Ok(())
    }

    /// Takes a way.
    pub fn add_way(&mut self, way: Way) -> Result<(), MapError> {
        self.count(1 + way.nodes.len())?;
        self.ways.push(way);
        Ok(())
    }

    /// Takes a relation.
    pub fn add_relation(&mut self, relation: Relation) -> Result<(), MapError> {
        self.count(1 + relation.members.len())?;
        self.relations.push(relation);
        Ok(())
    }

    fn count(&mut self, more: usize) -> Result<(), MapError> {
        self.parts += more;
        if self.parts <= MOST_PARTS {
            return Ok(());
        }
        Err(MapError::new(format!("the file has more than {MOST_PARTS} nodes, ways, members and references"))
            .hint("cut the area that you need out of it: `osmium extract --bbox WEST,SOUTH,EAST,NORTH`"))
    }

    /// Sorts by id, so that the order of the file does not matter; of several elements with one id the first stays.
    pub fn sort(&mut self) {
        sort_by_id(&mut self.nodes, |node| node.id);
        sort_by_id(&mut self.node_tags, |(id, _)| *id);
        sort_by_id(&mut self.ways, |way| way.id);
        sort_by_id(&mut self.relations, |relation| relation.id);
    }

    /// The node with a number.
    pub fn node(&self, id: i64) -> Option<&Node> {
        self.nodes.binary_search_by_key(&id, |node| node.id).ok().map(|place| &self.nodes[place])
    }

    /// The place of the way with a number.
    pub fn way_place(&self, id: i64) -> Option<usize> {
        self.ways.binary_search_by_key(&id, |way| way.id).ok()
    }

    /// Tags of a node.
    pub fn tags_of_node(&self, id: i64) -> Option<&Tags> {
        self.node_tags.binary_search_by_key(&id, |(id, _)| *id).ok().map(|place| &self.node_tags[place].1)
    }
}

fn sort_by_id<T>(elements: &mut Vec<T>, id: impl Fn(&T) -> i64) {
    elements.sort_by_key(&id);
    elements.dedup_by(|later, first| id(later) == id(first));
}

impl Way {
    /// Whether the way ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.nodes.len() >= 4 && self.nodes.first() == self.nodes.last()
    }
}
