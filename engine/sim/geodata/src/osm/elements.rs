//! [`Elements`]: nodes, ways and relations of a file, whatever its container.

use super::tags::Tags;
use super::tally::Tally;
use cosfly_town::MapError;
use std::collections::BTreeMap;

/// Most nodes, ways, relations and references between them in one file; a city of millions has fewer.
const MOST_PARTS: usize = 40_000_000;
/// Most parts of a small file, and of each byte of it: packed files have one for each four bytes or so.
const MOST_PARTS_OF_ANY: usize = 2_000_000;
const MOST_PARTS_OF_A_BYTE: usize = 2;
/// Advice on files that are too large.
pub const CUT_OUT: &str =
    "cut the area that you need out of it: `osmium extract --bbox WEST,SOUTH,EAST,NORTH FILE -o NEW.osm.pbf`";
/// Units of a coordinate in one degree.
pub const UNITS_PER_DEGREE: f64 = 1e7;

/// Everything that a file states.
#[derive(Debug, Default)]
pub struct Elements {
    /// Areas that the file was cut to; several where it was fetched in pieces.
    pub bounds: Vec<Bounds>,
    /// Nodes, sorted by id.
    pub nodes: Vec<Node>,
    /// Tags of those nodes that have any, sorted by id.
    pub node_tags: Vec<(i64, Tags)>,
    /// For each of them, which of several nodes of one id it is of.
    tag_ranks: Vec<Rank>,
    /// Ways, sorted by id.
    pub ways: Vec<Way>,
    /// Relations, sorted by id.
    pub relations: Vec<Relation>,
    /// Nodes without a usable place.
    pub without_place: usize,
    /// Elements that are in the file again, with other content.
    pub repeated: Tally,
    /// Elements that are gone as of a version.
    gone: Vec<(Kind, i64, Rank)>,
    parts: usize,
    most_parts: usize,
    taken: u32,
}

/// Which of several elements of one kind and id counts: the highest version, of one version the first in the file. Larger
/// ranks go before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank(u64);

/// Kind of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A point.
    Node,
    /// A line or the rim of an area.
    Way,
    /// A group.
    Relation,
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
    rank: Rank,
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
    /// See [`Elements::rank`].
    pub rank: Rank,
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
    /// See [`Elements::rank`].
    pub rank: Rank,
}

/// A member of a relation; nodes are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// Whether it is a way, not a relation.
    pub is_way: bool,
    /// Number of the element.
    pub id: i64,
    /// Role that it has in the relation.
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
    /// No elements yet, of a file of `bytes` bytes, which limit how many may come.
    pub fn of_file(bytes: usize) -> Self {
        let most_parts = (MOST_PARTS_OF_ANY + MOST_PARTS_OF_A_BYTE * bytes).min(MOST_PARTS);
        Self { most_parts, ..Self::default() }
    }

    /// The rank of the next element of the file; versions that are not stated are 0.
    pub fn rank(&mut self, version: u32) -> Rank {
        self.taken = self.taken.saturating_add(1);
        Rank(u64::from(version) << 32 | u64::from(u32::MAX - self.taken))
    }

    /// Takes a node whose place is given in nanodegrees.
    pub fn add_node(&mut self, id: i64, [lon, lat]: [i64; 2], tags: Tags, rank: Rank) -> Result<(), MapError> {
        self.count(1)?;
        let is_place = lon.unsigned_abs() <= 180_000_000_000 && lat.unsigned_abs() <= 90_000_000_000;
        if !is_place {
            self.without_place += 1;
            return Ok(());
        }
        let unit = |nano: i64| (nano + 50).div_euclid(100) as i32;
        self.nodes.push(Node { id, lon: unit(lon), lat: unit(lat), rank });
        if !tags.is_empty() {
            self.node_tags.push((id, tags));
            self.tag_ranks.push(rank);
        }
        Ok(())
    }

    /// Takes note that an element is gone: deleted as of its version.
    pub fn add_gone(&mut self, kind: Kind, id: i64, rank: Rank) -> Result<(), MapError> {
        self.count(1)?;
        self.gone.push((kind, id, rank));
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
        if self.parts <= self.most_parts {
            return Ok(());
        }
        let most = self.most_parts;
        let why = if most < MOST_PARTS { ", more than a file of its size can have" } else { "" };
        Err(MapError::new(format!("the file has more than {most} nodes, ways, members and references{why}"))
            .hint(CUT_OUT))
    }

    /// Elements that state a key again with another value; the first value counts.
    pub fn of_repeated_tags(&self) -> Tally {
        let mut tally = Tally::default();
        let mut check = |tags: &Tags, name: core::fmt::Arguments<'_>| {
            if tags.has_repeated {
                tally.add(name);
            }
        };
        self.node_tags.iter().for_each(|(id, tags)| check(tags, format_args!("node {id}")));
        self.ways.iter().for_each(|way| check(&way.tags, format_args!("way {}", way.id)));
        self.relations.iter().for_each(|it| check(&it.tags, format_args!("relation {}", it.id)));
        tally
    }

    /// Sorts by id, so that the order of the file does not matter. Of several elements with one id the one of the highest
    /// version stays, of one version the first; none where a later version is gone.
    pub fn sort(&mut self) {
        let gone = core::mem::take(&mut self.gone);
        let gone_as_of = |kind: Kind| -> BTreeMap<i64, Rank> {
            let mut of_kind: Vec<(i64, Rank)> =
                gone.iter().filter(|(own, ..)| *own == kind).map(|(_, id, rank)| (*id, *rank)).collect();
            of_kind.sort_unstable();
            of_kind.into_iter().collect() // the last of several has the highest rank
        };
        let mut settle = Settle { repeated: &mut self.repeated };
        let mut tags: Vec<(Rank, &Tags)> =
            self.tag_ranks.iter().copied().zip(self.node_tags.iter().map(|(_, tags)| tags)).collect();
        tags.sort_unstable_by_key(|(rank, _)| *rank);
        let tags_of = |node: &Node| tags.binary_search_by_key(&node.rank, |(rank, _)| *rank).ok().map(|at| tags[at].1);
        let same_node = |a: &Node, b: &Node| (a.lon, a.lat) == (b.lon, b.lat) && tags_of(a) == tags_of(b);
        settle.one_of_each(&mut self.nodes, &gone_as_of(Kind::Node), |node| (node.id, node.rank), same_node, "node");
        let same_way = |a: &Way, b: &Way| (&a.nodes, &a.tags) == (&b.nodes, &b.tags);
        settle.one_of_each(&mut self.ways, &gone_as_of(Kind::Way), |way| (way.id, way.rank), same_way, "way");
        let same_relation = |a: &Relation, b: &Relation| (&a.members, &a.tags) == (&b.members, &b.tags);
        let gone_relations = gone_as_of(Kind::Relation);
        settle.one_of_each(&mut self.relations, &gone_relations, |it| (it.id, it.rank), same_relation, "relation");
        // Tags go with the node that stays.
        let ranks = core::mem::take(&mut self.tag_ranks);
        let mut tagged: Vec<((i64, Tags), Rank)> =
            core::mem::take(&mut self.node_tags).into_iter().zip(ranks).collect();
        tagged.retain(|((id, _), rank)| self.node(*id).is_some_and(|node| node.rank == *rank));
        tagged.sort_by_key(|((id, _), _)| *id);
        self.node_tags = tagged.into_iter().map(|(tags, _)| tags).collect();
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

/// Settles which of several elements of one id counts.
struct Settle<'t> {
    repeated: &'t mut Tally,
}

impl Settle<'_> {
    fn one_of_each<T>(
        &mut self,
        elements: &mut Vec<T>,
        gone: &BTreeMap<i64, Rank>,
        key: impl Fn(&T) -> (i64, Rank),
        is_same: impl Fn(&T, &T) -> bool,
        name: &str,
    ) {
        // The highest rank of each id comes first.
        elements.sort_by(|a, b| {
            let ((a, own), (b, other)) = (key(a), key(b));
            a.cmp(&b).then(other.cmp(&own))
        });
        elements.dedup_by(|later, first| {
            let is_again = key(later).0 == key(first).0;
            if is_again && !is_same(later, first) {
                self.repeated.add(format_args!("{name} {}", key(first).0));
            }
            is_again
        });
        elements.retain(|one| {
            let (id, rank) = key(one);
            gone.get(&id).is_none_or(|gone| *gone < rank)
        });
    }
}

impl Way {
    /// Whether the way ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.nodes.len() >= 4 && self.nodes.first() == self.nodes.last()
    }
}
