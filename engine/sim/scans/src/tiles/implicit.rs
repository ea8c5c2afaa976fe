//! Tiles that a rule states (`implicitTiling`): a quadtree or octree, and for each of its subtrees which tiles are there.

use super::paths::folder_of;
use super::volume::Volume;
use crate::bytes::Bytes;
use cosfly_diagnose::counted;
use cosfly_frames::real;
use cosfly_town::MapError;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::rc::Rc;

/// Most levels of a tree, whose coordinates are numbers of 32 bits.
const MOST_LEVELS: u32 = 32;
/// Most tiles below the deepest level of a subtree.
const MOST_BELOW: u64 = 1 << 20;
/// Most contents of a tile.
const MOST_CONTENTS: usize = 16;
/// The first bytes of a binary subtree, and the length of its head.
const MAGIC: &[u8] = b"subt";
const HEAD: u64 = 24;
const HINT: &str = "ask the tool that made the tileset for explicit tiles";

/// The rule, as a tile states it; `maximumLevel` is the word of 3D Tiles 1.0.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Rule {
    subdivision_scheme: String,
    subtree_levels: u32,
    available_levels: Option<u32>,
    maximum_level: u32,
    subtrees: Template,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Template {
    uri: String,
}

/// A tree of tiles.
#[derive(Debug)]
pub(super) struct Tree {
    is_octree: bool,
    subtree_levels: u32,
    levels: u32,
    /// Templates of the addresses of subtrees and of contents.
    subtrees: String,
    contents: Vec<String>,
    volume: Volume,
}

/// A tile of a tree.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    tree: Rc<Tree>,
    /// The subtree that it is in.
    subtree: Rc<Subtree>,
    level: u32,
    at: [u32; 3],
    /// Addresses of its contents that are there.
    pub contents: Vec<String>,
}

/// Which tiles, contents and further subtrees are there.
#[derive(Debug, Default)]
pub(super) struct Subtree {
    tiles: Bits,
    contents: Vec<Bits>,
    below: Bits,
    /// Whether its tiles have properties of their own.
    pub has_properties: bool,
}

#[derive(Debug)]
enum Bits {
    All(bool),
    Own(Vec<u8>),
}

impl Default for Bits {
    fn default() -> Self {
        Self::All(false)
    }
}

impl Bits {
    fn has(&self, at: u64) -> bool {
        match self {
            Self::All(is_there) => *is_there,
            Self::Own(bytes) => bytes.get((at / 8) as usize).is_some_and(|byte| byte >> (at % 8) & 1 == 1),
        }
    }
}

impl Tree {
    /// The tree that begins with a tile of these bounds and templates of contents.
    ///
    /// # Errors
    /// Rules without a meaning, too many levels, bounds that no rule divides.
    pub fn new(rule: &Rule, volume: Volume, contents: Vec<String>) -> Result<Self, MapError> {
        let is_octree = match rule.subdivision_scheme.as_str() {
            "QUADTREE" => false,
            "OCTREE" => true,
            other => {
                let shown: String = other.chars().take(60).collect();
                return Err(MapError::new(format!("`subdivisionScheme` is `{shown}`")).hint("`QUADTREE` or `OCTREE`"));
            }
        };
        let levels = rule.available_levels.unwrap_or(rule.maximum_level.saturating_add(1));
        let per_level: u32 = if is_octree { 3 } else { 2 };
        let is_few = per_level.saturating_mul(rule.subtree_levels) <= MOST_BELOW.ilog2();
        if !(1..=MOST_LEVELS).contains(&levels) || rule.subtree_levels == 0 || !is_few {
            let message = format!(
                "the tree has {levels}, its subtrees {}; at most {MOST_LEVELS} are read, {} in a subtree",
                rule.subtree_levels,
                MOST_BELOW.ilog2() / per_level,
                levels = counted(levels, "level")
            );
            return Err(MapError::new(message).hint(HINT));
        }
        if volume.region.is_none() && volume.oriented.is_none() {
            let error = MapError::new("tiles that a rule states have neither a region nor a box as bounds");
            return Err(error.hint(HINT));
        }
        if rule.subtrees.uri.is_empty() {
            return Err(MapError::new("`implicitTiling` names no `subtrees`").hint(HINT));
        }
        if contents.len() > MOST_CONTENTS {
            let message = format!("tiles have {} contents each; at most {MOST_CONTENTS} are read", contents.len());
            return Err(MapError::new(message).hint(HINT));
        }
        let subtrees = rule.subtrees.uri.clone();
        Ok(Self { is_octree, subtree_levels: rule.subtree_levels, levels, subtrees, contents, volume })
    }

    fn per_level(&self) -> u32 {
        if self.is_octree { 3 } else { 2 }
    }

    /// Number of tiles above a level.
    fn above(&self, level: u32) -> u64 {
        let per_level = self.per_level();
        ((1 << (per_level * level)) - 1) / ((1 << per_level) - 1)
    }

    /// The address of a tile by a template.
    fn uri(&self, template: &str, level: u32, at: [u32; 3]) -> String {
        let own = [("{level}", level), ("{x}", at[0]), ("{y}", at[1]), ("{z}", at[2])];
        own.into_iter().fold(template.to_owned(), |uri, (name, number)| uri.replace(name, &number.to_string()))
    }

    /// The bounds of a tile, worked out from those of the whole tree.
    fn volume(&self, level: u32, at: [u32; 3]) -> Volume {
        let cells = (1_u64 << level) as f64;
        let axes = if self.is_octree { 3 } else { 2 };
        let mut volume = Volume::default();
        if let Some(whole) = self.volume.oriented {
            let mut own = whole;
            for axis in 0..axes {
                for k in 0..3 {
                    let half = whole[3 + 3 * axis + k];
                    own[k] += half * ((2.0 * f64::from(at[axis]) + 1.0) / cells - 1.0);
                    own[3 + 3 * axis + k] = half / cells;
                }
            }
            volume.oriented = Some(own);
        }
        if let Some([west, south, east, north, low, high]) = self.volume.region {
            let east = if east < west { east + real::TAU } else { east };
            let ends = [[west, east], [south, north], [low, high]];
            let [lon, lat, height] = [0, 1, 2].map(|axis| {
                let [from, to] = ends[axis];
                let size = (to - from) / cells;
                let first = from + size * f64::from(at[axis]);
                if axis < axes { [first, first + size] } else { ends[axis] }
            });
            volume.region = Some([lon[0], lat[0], lon[1], lat[1], height[0], height[1]]);
        }
        volume
    }
}

impl Cell {
    /// The first tile of a tree, where it is there; `read` opens the file of an address.
    ///
    /// # Errors
    /// Subtrees that cannot be read.
    pub fn root(tree: Tree, read: &mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>) -> Result<Option<Self>, MapError> {
        let tree = Rc::new(tree);
        let subtree = Rc::new(Subtree::read(&tree, &tree.uri(&tree.subtrees, 0, [0; 3]), read)?);
        Ok(Self { tree, subtree, level: 0, at: [0; 3], contents: vec![] }.there())
    }

    /// Whether tiles of its subtree have properties of their own.
    pub fn has_properties(&self) -> bool {
        self.subtree.has_properties
    }

    /// Its bounds.
    pub fn volume(&self) -> Volume {
        self.tree.volume(self.level, self.at)
    }

    /// Itself with its contents, where the subtree has it.
    fn there(mut self) -> Option<Self> {
        let (tree, subtree) = (&self.tree, &self.subtree);
        let level = self.level % tree.subtree_levels;
        let number = tree.above(level) + self.number(level);
        let own = tree.contents.iter().zip(&subtree.contents).filter(|(_, bits)| bits.has(number));
        let contents = own.map(|(template, _)| tree.uri(template, self.level, self.at)).collect();
        let is_there = subtree.tiles.has(number);
        self.contents = contents;
        is_there.then_some(self)
    }

    /// The tiles below it.
    ///
    /// # Errors
    /// Subtrees that cannot be read.
    pub fn children(&self, read: &mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>) -> Result<Vec<Self>, MapError> {
        let (tree, level) = (&self.tree, self.level + 1);
        let mut cells = vec![];
        for child in (0..1 << tree.per_level()).take_while(|_| level < tree.levels) {
            let at = [0, 1, 2].map(|axis| 2 * self.at[axis] + (child >> axis & 1));
            let mut cell = Self { level, at, ..self.clone() };
            if level.is_multiple_of(tree.subtree_levels) {
                if !self.subtree.below.has(cell.number(tree.subtree_levels)) {
                    continue;
                }
                cell.subtree = Rc::new(Subtree::read(tree, &tree.uri(&tree.subtrees, level, at), read)?);
            }
            cells.extend(cell.there());
        }
        Ok(cells)
    }

    /// Its number in Z-order among the tiles of its level that are below the root of a subtree, so many levels higher.
    fn number(&self, levels: u32) -> u64 {
        let axes = self.tree.per_level();
        let bit = |level: u32, axis: u32| u64::from(self.at[axis as usize] >> level & 1) << (axes * level + axis);
        (0..levels).flat_map(|level| (0..axes).map(move |axis| bit(level, axis))).sum()
    }
}

/// A subtree as its file states it. Words of 3D Tiles 1.0 are known, too.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct SubtreeText {
    buffers: Vec<SubtreeBuffer>,
    buffer_views: Vec<SubtreeView>,
    tile_availability: Option<Availability>,
    content_availability: Contents,
    child_subtree_availability: Option<Availability>,
    tile_metadata: Option<serde::de::IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Contents {
    Several(Vec<Availability>),
    One(Availability),
}

impl Default for Contents {
    fn default() -> Self {
        Self::Several(vec![])
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Availability {
    constant: Option<u8>,
    #[serde(alias = "bufferView")]
    bitstream: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct SubtreeBuffer {
    uri: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct SubtreeView {
    buffer: usize,
    byte_offset: usize,
    byte_length: usize,
}

impl Subtree {
    fn read(tree: &Tree, uri: &str, read: &mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>) -> Result<Self, MapError> {
        let in_file = |error: MapError| MapError { message: format!("subtree `{uri}`: {}", error.message), ..error };
        let bytes = read(uri).map_err(in_file)?;
        let folder = folder_of(uri);
        Self::parsed(tree, &bytes, &mut |beside| read(&format!("{folder}{beside}"))).map_err(in_file)
    }

    fn parsed(
        tree: &Tree,
        bytes: &[u8],
        read: &mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>,
    ) -> Result<Self, MapError> {
        let (text, blob) = if bytes.starts_with(MAGIC) { halves(bytes)? } else { (bytes, &[][..]) };
        let text: SubtreeText = serde_json::from_slice(text)
            .map_err(|error| MapError::new(format!("its text cannot be read: {error}")).hint(HINT))?;
        let mut files: BTreeMap<usize, Vec<u8>> = BTreeMap::new();
        let mut bits = |own: Option<&Availability>, count: u64| {
            let missing = || MapError::new("it does not say which tiles are there").hint(HINT);
            let own = own.ok_or_else(missing)?;
            let Some(view) = own.bitstream else { return Ok(Bits::All(own.constant.ok_or_else(missing)? == 1)) };
            let cut = || MapError::new("it is cut off: bits that it names lie beyond its end").hint(HINT);
            let view = text.buffer_views.get(view).ok_or_else(cut)?;
            let buffer = match text.buffers.get(view.buffer).ok_or_else(cut)?.uri.as_deref() {
                None => blob,
                Some(uri) => match files.entry(view.buffer) {
                    Entry::Occupied(known) => known.into_mut(),
                    Entry::Vacant(place) => place.insert(read(uri)?),
                },
            };
            let own = buffer.get(view.byte_offset..).and_then(|rest| rest.get(..view.byte_length));
            let own = own.filter(|own| own.len() as u64 >= count.div_ceil(8)).ok_or_else(cut)?;
            Ok(Bits::Own(own[..count.div_ceil(8) as usize].to_vec()))
        };
        let count = tree.above(tree.subtree_levels);
        let contents = match &text.content_availability {
            Contents::Several(all) => all.iter().collect(),
            Contents::One(one) => vec![one],
        };
        Ok(Self {
            tiles: bits(text.tile_availability.as_ref(), count)?,
            below: bits(text.child_subtree_availability.as_ref(), 1 << (tree.per_level() * tree.subtree_levels))?,
            contents: (0..tree.contents.len())
                .map(|at| bits(contents.get(at).copied(), count))
                .collect::<Result<_, _>>()?,
            has_properties: text.tile_metadata.is_some(),
        })
    }
}

/// Text and data of a binary subtree.
fn halves(file: &[u8]) -> Result<(&[u8], &[u8]), MapError> {
    let bytes = Bytes(file);
    let version = bytes.u32(4, "the version")?;
    if version != 1 {
        return Err(MapError::new(format!("its version is {version}; 1 is read")).hint(HINT));
    }
    let (text, data) = (bytes.u64(8, "the length of its text")?, bytes.u64(16, "the length of its bits")?);
    let text_bytes = bytes.slice(HEAD, text, "the end of its text")?;
    Ok((text_bytes, bytes.slice(HEAD.saturating_add(text), data, "the end of its bits")?))
}

#[cfg(test)]
mod tests {
    use super::super::join::{JoinedTiles, TilesChoice, join};
    use super::*;
    use crate::gltf::GlTf;
    use cosfly_town::MapFormat;
    use serde_json::{Value, json};

    /// A tileset of a box of 80 m that states its tiles by a rule; `files` are its subtrees. Gives the files that are opened, too.
    fn joined(
        rule: Value,
        choice: &TilesChoice,
        files: &[(&str, Vec<u8>)],
    ) -> (Result<JoinedTiles, MapError>, Vec<String>) {
        let root = json!({
            "boundingVolume": { "box": [0, 0, 0, 40, 0, 0, 0, 40, 0, 0, 0, 40] }, "geometricError": 8, "refine": "REPLACE",
            "content": { "uri": "c/{level}.{x}.{y}.{z}.glb" }, "implicitTiling": rule,
        });
        let tileset = json!({ "asset": { "version": "1.1" }, "geometricError": 8, "root": root }).to_string();
        let mut opened = vec![];
        let joined = join("tileset.json", choice, &mut |path| {
            opened.push(path.to_owned());
            let own = files.iter().find(|(name, _)| *name == path).map(|(_, bytes)| bytes.clone());
            Ok(own.unwrap_or_else(
                || if path == "tileset.json" { tileset.clone().into() } else { GlTf::EXAMPLE.to_vec() },
            ))
        });
        (joined, opened)
    }

    fn rule(scheme: &str, levels: u32, of_subtree: u32) -> Value {
        let subtrees = json!({ "uri": "s/{level}.{x}.{y}.{z}" });
        json!({ "subdivisionScheme": scheme, "availableLevels": levels, "subtreeLevels": of_subtree, "subtrees": subtrees })
    }

    /// A subtree as text, with its bits in a file beside it.
    fn text(tiles: &Value, contents: &Value, below: &Value) -> Vec<u8> {
        let view = |at: usize| json!({ "buffer": 0, "byteOffset": 8 * at, "byteLength": 8 });
        json!({
            "buffers": [{ "uri": "bits.bin", "byteLength": 24 }], "bufferViews": [view(0), view(1), view(2)],
            "tileAvailability": tiles, "contentAvailability": [contents], "childSubtreeAvailability": below,
        })
        .to_string()
        .into()
    }

    #[test]
    fn tiles_of_a_quadtree_are_those_that_its_bits_name() {
        let (all, none) = (json!({ "constant": 1 }), json!({ "constant": 0 }));
        let bits = |at: usize| json!({ "bitstream": at });
        // In the first subtree, two levels: root and the tile at x = 1, y = 0; below it the subtree at 2, x = 3, y = 1.
        let mut beside = vec![0; 24];
        (beside[0], beside[8], beside[16]) = (0b0_0101, 0b0_0100, 1 << 7);
        let files = [
            ("s/0.0.0.0", text(&bits(0), &bits(1), &bits(2))),
            ("s/bits.bin", beside),
            ("s/2.3.1.0", text(&all, &all, &none)),
        ];
        let (fine, opened) = joined(rule("QUADTREE", 4, 2), &TilesChoice::default(), &files);
        let fine = fine.expect("a mesh");
        assert_eq!((fine.tiles, fine.geometric_error_m), (4, 1.0));
        let shown: Vec<&String> = opened.iter().filter(|path| path.starts_with("c/")).collect();
        assert_eq!(shown, ["c/3.6.2.0.glb", "c/3.7.2.0.glb", "c/3.6.3.0.glb", "c/3.7.3.0.glb"]);
        let coarse = TilesChoice { geometric_error_m: 4.0, ..TilesChoice::default() };
        let (coarse, opened) = joined(rule("QUADTREE", 4, 2), &coarse, &files);
        assert_eq!((coarse.expect("a mesh").tiles, opened.last().map(String::as_str)), (1, Some("c/1.1.0.0.glb")));
        // The finest tiles are 10 m wide: one row of them begins at x = 30.
        let area = TilesChoice { area_m: Some([31.0, -40.0, 40.0, 40.0]), ..TilesChoice::default() };
        assert_eq!(joined(rule("QUADTREE", 4, 2), &area, &files).0.expect("a mesh").tiles, 2);
    }

    #[test]
    fn octrees_are_read_from_binary_subtrees_and_bounds_are_divided() {
        let text = json!({
            "buffers": [{ "byteLength": 2 }], "bufferViews": [{ "buffer": 0, "byteLength": 2 }],
            "tileAvailability": { "bitstream": 0 }, "contentAvailability": { "bufferView": 0 }, "childSubtreeAvailability": { "constant": 0 },
        });
        let text = text.to_string();
        let head = [MAGIC, &1_u32.to_le_bytes(), &(text.len() as u64).to_le_bytes(), &2_u64.to_le_bytes()].concat();
        // Root, and the last of its eight.
        let file = [&head, text.as_bytes(), &[0b0000_0001, 0b1]].concat();
        let (octree, opened) = joined(rule("OCTREE", 2, 2), &TilesChoice::default(), &[("s/0.0.0.0", file.clone())]);
        assert_eq!((octree.expect("a mesh").tiles, opened.last().map(String::as_str)), (1, Some("c/1.1.1.1.glb")));
        for length in 0..file.len() {
            let (cut, _) =
                joined(rule("OCTREE", 2, 2), &TilesChoice::default(), &[("s/0.0.0.0", file[..length].to_vec())]);
            let error = cut.expect_err("cut");
            assert!(error.message.contains("subtree `s/0.0.0.0`") && !error.hints.is_empty(), "{length}: {error:?}");
        }
        let region = Some([3.0, 0.1, -3.0, 0.3, 0.0, 8.0]);
        let volume = Volume {
            region,
            oriented: Some([1.0, 0.0, 0.0, 4.0, 4.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 8.0]),
            sphere: None,
        };
        let rule: Rule = serde_json::from_value(rule("QUADTREE", 3, 1)).expect("a rule");
        let divided = Tree::new(&rule, volume, vec![]).expect("a tree").volume(1, [1, 0, 0]);
        assert_eq!(divided.oriented, Some([3.0, 1.0, 0.0, 2.0, 2.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 8.0]));
        let [west, _, east, north, low, high] = divided.region.expect("a region");
        assert!((west - real::PI).abs() < 1e-9 && (east - real::TAU + 3.0).abs() < 1e-9 && (north - 0.2).abs() < 1e-9);
        assert_eq!([low, high], [0.0, 8.0]);
    }

    #[test]
    fn rules_without_end_or_meaning_are_refused() {
        let all = json!({ "constant": 1 });
        let endless = [("s/0.0.0.0", text(&all, &all, &all))];
        for (rule, words) in [
            (rule("TERNARY", 2, 1), "TERNARY"),
            (rule("QUADTREE", 33, 1), "33 levels"),
            (rule("OCTREE", 9, 7), "subtrees 7"),
            (rule("OCTREE", 9, u32::MAX), "at most"),
            (rule("QUADTREE", 2, 0), "subtrees 0"),
            (json!({ "subdivisionScheme": "QUADTREE", "availableLevels": 2, "subtreeLevels": 1 }), "no `subtrees`"),
        ] {
            let error = joined(rule, &TilesChoice::default(), &endless).0.expect_err(words);
            assert!(error.message.contains(words) && !error.hints.is_empty(), "{words}: {error:?}");
        }
        // One file that is every subtree, without end.
        let mut endless = rule("QUADTREE", 32, 1);
        endless["subtrees"]["uri"] = "s/all?{level}".into();
        let choice = TilesChoice { geometric_error_m: 0.0, ..TilesChoice::default() };
        let file = text(&all, &json!({ "constant": 0 }), &all);
        let error = joined(endless, &choice, &[("s/all", file)]).0.expect_err("endless");
        assert!(error.message.contains("subtrees"), "{error:?}");
        for uri in ["../{level}", "https://example.org/{level}"] {
            let mut away = rule("QUADTREE", 2, 1);
            away["subtrees"]["uri"] = uri.into();
            let error = joined(away, &choice, &[]).0.expect_err(uri);
            assert!(error.message.contains("leads out") || error.message.contains("an address"), "{error:?}");
        }
    }
}
