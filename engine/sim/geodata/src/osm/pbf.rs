//! Elements from OSM PBF: blobs of protocol-buffer messages, each by itself compressed.
//!
//! The messages are the subset of the published `fileformat.proto` and `osmformat.proto` that is read here; prost decodes
//! them, skips what is not listed and never panics.

use super::elements::{Bounds, Elements, Kind, Member, Rank, Relation, Role, Way};
use super::tags::Tags;
use super::unpacked::most_unpacked;
use cosfly_diagnose::counted;
use cosfly_town::MapError;
use flate2::read::ZlibDecoder;
use prost::Message;
use prost::encoding::WireType;
use std::io::Read;

/// Limits of the format: header of a blob, blob after unpacking, bytes.
const LARGEST_HEADER: usize = 64 << 10;
const LARGEST_BLOB: usize = 32 << 20;
/// Most strings, groups, nodes, ways and relations that one block lists by themselves; usual ones have 8000 elements.
const MOST_ENTRIES: usize = 1_000_000;
/// Features of files that this reader knows.
const KNOWN_FEATURES: &[&str] = &["OsmSchema-V0.6", "DenseNodes", "HistoricalInformation"];

#[derive(Clone, PartialEq, Message)]
pub(super) struct BlobHeader {
    #[prost(string, tag = "1")]
    pub kind: String,
    #[prost(int32, tag = "3")]
    pub size: i32,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct Blob {
    #[prost(bytes = "vec", optional, tag = "1")]
    pub raw: Option<Vec<u8>>,
    #[prost(bytes = "vec", optional, tag = "3")]
    pub zlib: Option<Vec<u8>>,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct HeaderBlock {
    #[prost(message, optional, tag = "1")]
    pub bounds: Option<HeaderBounds>,
    #[prost(string, repeated, tag = "4")]
    pub required_features: Vec<String>,
}

/// Nanodegrees.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct HeaderBounds {
    #[prost(sint64, tag = "1")]
    pub left: i64,
    #[prost(sint64, tag = "2")]
    pub right: i64,
    #[prost(sint64, tag = "3")]
    pub top: i64,
    #[prost(sint64, tag = "4")]
    pub bottom: i64,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct PrimitiveBlock {
    #[prost(message, optional, tag = "1")]
    pub strings: Option<StringTable>,
    #[prost(message, repeated, tag = "2")]
    pub groups: Vec<PrimitiveGroup>,
    #[prost(int32, optional, tag = "17", default = "100")]
    pub granularity: Option<i32>,
    #[prost(int64, tag = "19")]
    pub lat_offset: i64,
    #[prost(int64, tag = "20")]
    pub lon_offset: i64,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct StringTable {
    #[prost(bytes = "vec", repeated, tag = "1")]
    pub strings: Vec<Vec<u8>>,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct PrimitiveGroup {
    #[prost(message, repeated, tag = "1")]
    pub nodes: Vec<PlainNode>,
    #[prost(message, optional, tag = "2")]
    pub dense: Option<DenseNodes>,
    #[prost(message, repeated, tag = "3")]
    pub ways: Vec<PackedWay>,
    #[prost(message, repeated, tag = "4")]
    pub relations: Vec<PackedRelation>,
}

/// History of a way or relation, or of a plain node, as far as it is read.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Info {
    #[prost(int32, optional, tag = "1")]
    pub version: Option<i32>,
    #[prost(bool, optional, tag = "6")]
    pub visible: Option<bool>,
}

/// Histories of dense nodes, one column per field.
#[derive(Clone, PartialEq, Message)]
pub(super) struct DenseInfo {
    #[prost(int32, repeated, tag = "1")]
    pub versions: Vec<i32>,
    #[prost(bool, repeated, tag = "6")]
    pub visibles: Vec<bool>,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct PlainNode {
    #[prost(sint64, tag = "1")]
    pub id: i64,
    #[prost(uint32, repeated, tag = "2")]
    pub keys: Vec<u32>,
    #[prost(uint32, repeated, tag = "3")]
    pub values: Vec<u32>,
    #[prost(message, optional, tag = "4")]
    pub info: Option<Info>,
    #[prost(sint64, tag = "8")]
    pub lat: i64,
    #[prost(sint64, tag = "9")]
    pub lon: i64,
}

/// Columns of differences.
#[derive(Clone, PartialEq, Message)]
pub(super) struct DenseNodes {
    #[prost(sint64, repeated, tag = "1")]
    pub ids: Vec<i64>,
    #[prost(message, optional, tag = "5")]
    pub info: Option<DenseInfo>,
    #[prost(sint64, repeated, tag = "8")]
    pub lats: Vec<i64>,
    #[prost(sint64, repeated, tag = "9")]
    pub lons: Vec<i64>,
    /// Key, value, ..., 0 for each node.
    #[prost(int32, repeated, tag = "10")]
    pub keys_and_values: Vec<i32>,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct PackedWay {
    #[prost(int64, tag = "1")]
    pub id: i64,
    #[prost(uint32, repeated, tag = "2")]
    pub keys: Vec<u32>,
    #[prost(uint32, repeated, tag = "3")]
    pub values: Vec<u32>,
    #[prost(message, optional, tag = "4")]
    pub info: Option<Info>,
    /// Differences.
    #[prost(sint64, repeated, tag = "8")]
    pub nodes: Vec<i64>,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct PackedRelation {
    #[prost(int64, tag = "1")]
    pub id: i64,
    #[prost(uint32, repeated, tag = "2")]
    pub keys: Vec<u32>,
    #[prost(uint32, repeated, tag = "3")]
    pub values: Vec<u32>,
    #[prost(message, optional, tag = "4")]
    pub info: Option<Info>,
    #[prost(int32, repeated, tag = "8")]
    pub roles: Vec<i32>,
    /// Differences.
    #[prost(sint64, repeated, tag = "9")]
    pub members: Vec<i64>,
    /// 0 node, 1 way, 2 relation.
    #[prost(int32, repeated, tag = "10")]
    pub kinds: Vec<i32>,
}

/// Whether a file begins as a PBF file does: a short header that names an `OSMHeader`.
pub fn recognises(head: &[u8]) -> bool {
    matches!(head, [0, 0, 0, size, 0x0a, 9, rest @ ..] if *size >= 11 && rest.starts_with(b"OSMHeader"))
}

/// The elements of a file.
///
/// # Errors
/// A file that is cut inside a blob or breaks the format's limits, and features or compressions that are not read.
pub fn read(bytes: &[u8]) -> Result<Elements, MapError> {
    let mut elements = Elements::of_file(bytes.len());
    let mut rest = bytes;
    let mut left = most_unpacked(bytes.len());
    while !rest.is_empty() {
        let at = bytes.len() - rest.len();
        let broken = |message: String| {
            MapError::new(format!("the blob at byte {at} {message}"))
                .hint("the file seems to be cut off or damaged: fetch or export it again")
        };
        let size = take(&mut rest, 4).ok_or_else(|| broken("has no header".to_owned()))?;
        let size = size.iter().fold(0_usize, |size, byte| size << 8 | usize::from(*byte));
        if size > LARGEST_HEADER {
            return Err(broken(format!("has a header of {size} bytes; at most {LARGEST_HEADER} are allowed")));
        }
        let header = take(&mut rest, size).ok_or_else(|| broken("is cut off".to_owned()))?;
        let header = BlobHeader::decode(header).map_err(|error| broken(format!("has no readable header: {error}")))?;
        let size = usize::try_from(header.size).unwrap_or(usize::MAX);
        let blob = take(&mut rest, size)
            .ok_or_else(|| broken(format!("has {size}, but the file ends", size = counted(size, "byte"))))?;
        // The format asks to skip what is unknown.
        if !["OSMHeader", "OSMData"].contains(&header.kind.as_str()) {
            continue;
        }
        let blob = Blob::decode(blob).map_err(|error| broken(format!("is not readable: {error}")))?;
        let content = content(blob).map_err(broken)?;
        let most = || format!("is too much: the file unpacks to more than {} MiB", most_unpacked(bytes.len()) >> 20);
        left = left.checked_sub(content.len() as u64).ok_or_else(|| broken(most()))?;
        match header.kind.as_str() {
            "OSMHeader" => {
                let block =
                    HeaderBlock::decode(&*content).map_err(|error| broken(format!("is not readable: {error}")))?;
                elements.take_header(&block)?;
            }
            _ => {
                if !has_few_entries(&content) {
                    return Err(broken(format!("lists more than {MOST_ENTRIES} strings and elements")));
                }
                let block =
                    PrimitiveBlock::decode(&*content).map_err(|error| broken(format!("is not readable: {error}")))?;
                elements.take_block(&block)?;
            }
        }
    }
    Ok(elements)
}

fn take<'b>(rest: &mut &'b [u8], count: usize) -> Option<&'b [u8]> {
    let (taken, left) = rest.split_at_checked(count)?;
    *rest = left;
    Some(taken)
}

fn content(blob: Blob) -> Result<Vec<u8>, String> {
    let content = match blob {
        Blob { raw: Some(raw), .. } => raw,
        Blob { zlib: Some(packed), .. } => {
            let mut content = Vec::new();
            let mut stream = ZlibDecoder::new(&*packed).take(LARGEST_BLOB as u64 + 1);
            stream.read_to_end(&mut content).map_err(|error| format!("is not readable: {error}"))?;
            content
        }
        Blob { .. } => {
            return Err("is compressed in a way that is not read; only zlib is (`osmium cat` rewrites it)".into());
        }
    };
    if content.len() > LARGEST_BLOB {
        return Err(format!("unpacks to more than the {LARGEST_BLOB} bytes that the format allows"));
    }
    Ok(content)
}

impl Elements {
    fn take_header(&mut self, block: &HeaderBlock) -> Result<(), MapError> {
        if let Some(unknown) = block.required_features.iter().find(|name| !KNOWN_FEATURES.contains(&name.as_str())) {
            let shown: String = unknown.chars().take(40).collect();
            let message = format!("the file needs the feature `{shown}`; known ones: {}", KNOWN_FEATURES.join(", "));
            return Err(MapError::new(message).hint("`osmium cat FILE -o NEW.osm.pbf` writes it in the usual form"));
        }
        let degrees = |nano: i64| nano as f64 * 1e-9;
        self.bounds.extend(block.bounds.map(|bounds| Bounds {
            low: [degrees(bounds.left), degrees(bounds.bottom)],
            high: [degrees(bounds.right), degrees(bounds.top)],
        }));
        Ok(())
    }

    fn take_block(&mut self, block: &PrimitiveBlock) -> Result<(), MapError> {
        let strings: Vec<&str> = block
            .strings
            .iter()
            .flat_map(|table| &table.strings)
            .map(|bytes| core::str::from_utf8(bytes).unwrap_or_default())
            .collect();
        let text = |index: usize| strings.get(index).copied().unwrap_or_default();
        let tags = |keys: &[u32], values: &[u32]| {
            let mut tags = Tags::default();
            keys.iter().zip(values).for_each(|(key, value)| tags.add(text(*key as usize), text(*value as usize)));
            tags
        };
        let step = i64::from(block.granularity());
        let nano = |offset: i64, value: i64| offset.saturating_add(value.saturating_mul(step));
        let place = |lon: i64, lat: i64| [nano(block.lon_offset, lon), nano(block.lat_offset, lat)];
        for group in &block.groups {
            for node in &group.nodes {
                let Some(rank) = self.rank_of(Kind::Node, node.id, node.info)? else { continue };
                self.add_node(node.id, place(node.lon, node.lat), tags(&node.keys, &node.values), rank)?;
            }
            if let Some(dense) = &group.dense {
                let columns = sums(&dense.ids).zip(sums(&dense.lons).zip(sums(&dense.lats)));
                let mut tagged = dense.keys_and_values.as_slice();
                for (number, (id, (lon, lat))) in columns.enumerate() {
                    let tags = next_tags(&mut tagged, &text);
                    let info = dense.info.as_ref().map(|info| Info {
                        version: info.versions.get(number).copied(),
                        visible: info.visibles.get(number).copied(),
                    });
                    let Some(rank) = self.rank_of(Kind::Node, id, info)? else { continue };
                    self.add_node(id, place(lon, lat), tags, rank)?;
                }
            }
            for way in &group.ways {
                let Some(rank) = self.rank_of(Kind::Way, way.id, way.info)? else { continue };
                let nodes = sums(&way.nodes).collect();
                self.add_way(Way { id: way.id, tags: tags(&way.keys, &way.values), nodes, rank })?;
            }
            for relation in &group.relations {
                let Some(rank) = self.rank_of(Kind::Relation, relation.id, relation.info)? else { continue };
                let members = sums(&relation.members).zip(&relation.kinds).zip(&relation.roles);
                let members = members.filter(|((_, kind), _)| [1, 2].contains(*kind)).map(|((id, kind), role)| {
                    Member { is_way: *kind == 1, id, role: Role::of(text(usize::try_from(*role).unwrap_or(0))) }
                });
                let members = members.collect();
                let tags = tags(&relation.keys, &relation.values);
                self.add_relation(Relation { id: relation.id, tags, members, rank })?;
            }
        }
        Ok(())
    }

    /// The rank of an element; `None` for a version that is gone, of which note is taken.
    fn rank_of(&mut self, kind: Kind, id: i64, info: Option<Info>) -> Result<Option<Rank>, MapError> {
        let version = info.and_then(|info| info.version).and_then(|version| u32::try_from(version).ok());
        let rank = self.rank(version.unwrap_or(0));
        if info.and_then(|info| info.visible) == Some(false) {
            self.add_gone(kind, id, rank)?;
            return Ok(None);
        }
        Ok(Some(rank))
    }
}

/// Whether a block lists no more than [`MOST_ENTRIES`] strings, groups and elements: empty ones take two bytes of the file and
/// a hundred of memory. A block that is not readable counts as one with few; decoding it tells what is wrong.
fn has_few_entries(block: &[u8]) -> bool {
    let mut count = 0;
    let mut stack = vec![(block, 0)];
    while let Some((mut message, depth)) = stack.pop() {
        while let Some((field, content)) = next_field(&mut message) {
            count += 1;
            if count > MOST_ENTRIES {
                return false;
            }
            // 1 the strings, 2 a group.
            if depth == 0 && [1, 2].contains(&field) {
                stack.push((content, 1));
            }
        }
    }
    true
}

/// The next field of a message with its content, empty for numbers; `None` at its end or where it is broken.
fn next_field<'b>(message: &mut &'b [u8]) -> Option<(u32, &'b [u8])> {
    let (field, kind) = prost::encoding::decode_key(message).ok()?;
    let size = match kind {
        WireType::Varint => {
            prost::encoding::decode_varint(message).ok()?;
            0
        }
        WireType::SixtyFourBit => 8,
        WireType::ThirtyTwoBit => 4,
        WireType::LengthDelimited => usize::try_from(prost::encoding::decode_varint(message).ok()?).ok()?,
        WireType::StartGroup | WireType::EndGroup => return None,
    };
    take(message, size).map(|content| (field, content))
}

/// Tags of the next node of a dense group.
fn next_tags<'s>(tagged: &mut &[i32], text: &impl Fn(usize) -> &'s str) -> Tags {
    let mut tags = Tags::default();
    while let [key, rest @ ..] = *tagged {
        *tagged = rest;
        let [value, rest @ ..] = *tagged else { break };
        if *key == 0 {
            break;
        }
        *tagged = rest;
        tags.add(text(usize::try_from(*key).unwrap_or(0)), text(usize::try_from(*value).unwrap_or(0)));
    }
    tags
}

/// Numbers from their differences.
fn sums(differences: &[i64]) -> impl Iterator<Item = i64> {
    differences.iter().scan(0_i64, |sum, difference| {
        *sum = sum.wrapping_add(*difference);
        Some(*sum)
    })
}
