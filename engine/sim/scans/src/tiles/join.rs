//! [`join`]: the walk over tiles, from coarse to fine.

use super::contents::shapes;
use super::earth::Geodetic;
use super::implicit::{Cell, Tree};
use super::joined::Joined;
use super::paths::{folder_of, within};
use super::tileset::{Tile, Tileset};
use super::volume::{Area, Frame, scale_of};
use crate::way_out::or_advice;
use cosfly_frames::DVec3;
use cosfly_town::MapError;
use glam::DMat4;
use serde_json::json;
use std::rc::Rc;

/// Deepest nesting of tiles and of tilesets, and most of both.
const DEEPEST: usize = 200;
const MOST_TILES: usize = 1_000_000;
const MOST_TILESETS: usize = 10_000;
const MOST_SUBTREES: usize = 100_000;
/// A middle that is farther from its origin is on the Earth, metres.
const ON_EARTH_M: f64 = 1e6;
/// The way out of a damaged file.
const WAY_OUT: &str = "the tileset seems to be damaged: fetch or export it again";

/// How fine and where.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TilesChoice {
    /// Tiles are refined while their shapes may be farther than this from the finest, metres; 0 is the finest level.
    pub geometric_error_m: f64,
    /// Rectangle that tiles must meet: west, south, east, north of the origin, metres.
    pub area_m: Option<[f64; 4]>,
    /// Origin: latitude and longitude, degrees, height above the ellipsoid, metres. None is the tileset's middle.
    pub origin: Option<[f64; 3]>,
}

/// Tiles in one file.
#[derive(Debug, PartialEq)]
pub struct JoinedTiles {
    /// The GLB file: y up, x to the east, metres.
    pub glb: Vec<u8>,
    /// The place of its origin: latitude and longitude, degrees, height, metres. None where the tileset does not say.
    pub origin: Option<[f64; 3]>,
    /// Files of shapes that are in it.
    pub tiles: usize,
    /// Files of tiles that were read.
    pub tilesets: usize,
    /// Largest geometric error of a tile that is in it, metres.
    pub geometric_error_m: f64,
    /// Parts that show points or lines alone and are left out.
    pub points: usize,
    /// Whether tiles state geometric errors of their own as properties, which are not read.
    pub has_own_errors: bool,
}

/// Joins the tiles of the file `name` in its folder; `read` opens a file of the folder by its path from there.
///
/// # Errors
/// Files that cannot be read, kinds of tiles that are not read, addresses that lead out of the folder, no shape at all.
pub fn join(
    name: &str,
    choice: &TilesChoice,
    read: &mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>,
) -> Result<JoinedTiles, MapError> {
    let (joined, tiles) = (
        Joined::default(),
        JoinedTiles {
            glb: vec![],
            origin: None,
            tiles: 0,
            tilesets: 0,
            geometric_error_m: 0.0,
            points: 0,
            has_own_errors: false,
        },
    );
    let mut walk = Walk { choice, read, joined, found: tiles, frame: None, area: None, tiles: 0, subtrees: 0 };
    or_advice(walk.all(name), WAY_OUT)?;
    let Walk { joined, mut found, frame, .. } = walk;
    if found.tiles == 0 {
        let error = MapError::new("no tile has shapes");
        return Err(error.hint("give a wider area, or none; it counts in metres from the origin"));
    }
    found.origin = frame.and_then(|frame| frame.origin).map(|origin| origin.degrees());
    let about = json!({ "source": name, "origin": found.origin, "geometric_error_m": found.geometric_error_m });
    found.glb = joined.into_glb(&about);
    Ok(found)
}

struct Walk<'a> {
    choice: &'a TilesChoice,
    read: &'a mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>,
    joined: Joined,
    found: JoinedTiles,
    /// Frame of the joined tiles, told by the first tile of all.
    frame: Option<Frame>,
    area: Option<Area>,
    tiles: usize,
    subtrees: usize,
}

/// Properties that the tiles of a file share.
struct OfFile {
    path: String,
    is_z_up: bool,
    has_own_errors: bool,
}

/// Place that is still to be visited: a file of tiles, or a tile.
enum Open {
    Tileset(String),
    Tile(Box<Tile>, Rc<OfFile>),
}

/// A place in the walk: what is visited there, the way from its frame to that of the scene and whether it is added to what is above, its depth.
type Step = (Open, Option<(DMat4, bool)>, usize);

impl Walk<'_> {
    fn all(&mut self, name: &str) -> Result<(), MapError> {
        let mut steps: Vec<Step> = vec![(Open::Tileset(name.to_owned()), None, 0)];
        while let Some((open, above, depth)) = steps.pop() {
            let below = match open {
                Open::Tileset(path) => vec![self.tileset(path, above, depth)?],
                Open::Tile(tile, file) => self.tile(*tile, &file, above.unwrap_or_default(), depth)?,
            };
            steps.extend(below.into_iter().rev());
        }
        Ok(())
    }

    /// The first tile of a file.
    fn tileset(&mut self, path: String, above: Option<(DMat4, bool)>, depth: usize) -> Result<Step, MapError> {
        self.found.tilesets += 1;
        if self.found.tilesets > MOST_TILESETS {
            return Err(MapError::new(format!("there are more than {MOST_TILESETS} tilesets")).hint("give an area"));
        }
        let in_file = |error| in_file(&path, error);
        let tileset = (self.read)(&path).and_then(|bytes| Tileset::read(&bytes)).map_err(in_file)?;
        let is_z_up = tileset.is_z_up().map_err(in_file)?;
        let has_own_errors = tileset.has_own_errors();
        let above = above.map_or_else(|| Ok((self.place(&tileset.root)?, false)), Ok)?;
        let file = Rc::new(OfFile { path, is_z_up, has_own_errors });
        Ok((Open::Tile(Box::new(tileset.root), file), Some(above), depth))
    }

    /// Puts the frame of the scene where the first tile is; gives the way from its file's frame.
    fn place(&mut self, root: &Tile) -> Result<DMat4, MapError> {
        let root_from_tile = matrix_of(root);
        let middle = root.bounding_volume.middle().map(|middle| root_from_tile.transform_point3(middle));
        let on_earth = middle.filter(|middle| middle.length() > ON_EARTH_M).map(Geodetic::of_point);
        let found = root.bounding_volume.place().or(on_earth);
        let origin = match (self.choice.origin, found) {
            (Some(_), None) => {
                let error = MapError::new("an origin is given, but the tileset does not say where on the Earth it is");
                return Err(error.hint("leave the origin out: the tileset's own is kept"));
            }
            (Some(given), Some(_)) => Some(Geodetic::of_degrees(given)),
            (None, found) => found,
        };
        let from_root = origin.map_or(DMat4::IDENTITY, |origin| origin.earth_from_here().inverse());
        if !from_root.is_finite() {
            return Err(MapError::new("the bounds of the first tile are no place"));
        }
        let frame = Frame { origin };
        self.area = self.choice.area_m.map(|sides| Area::new(sides, &frame));
        self.frame = Some(frame);
        Ok(from_root)
    }

    /// Visits a tile; gives what is to be visited below it.
    fn tile(
        &mut self,
        tile: Tile,
        file: &Rc<OfFile>,
        (above, is_added_above): (DMat4, bool),
        depth: usize,
    ) -> Result<Vec<Step>, MapError> {
        let tree = tile.tree().map_err(|error| in_file(&file.path, error))?;
        let first = tree.map(|tree| self.first_of(tree, &tile, file)).transpose()?;
        let Some(mut tile) = first.unwrap_or(Some(tile)) else { return Ok(vec![]) };
        self.tiles += 1;
        if depth > DEEPEST || self.tiles > MOST_TILES {
            let message = format!("tiles are nested deeper than {DEEPEST}, or there are more than {MOST_TILES}");
            return Err(MapError::new(message).hint("give an area or a larger `--error-m`"));
        }
        let scene_from_tile = above * matrix_of(&tile);
        let in_area = |area: &Area, frame| area.meets(&tile.bounding_volume, &scene_from_tile, frame);
        if self.area.as_ref().zip(self.frame.as_ref()).is_some_and(|(area, frame)| !in_area(area, frame)) {
            return Ok(vec![]);
        }
        let is_added = match tile.refine.as_deref() {
            None => is_added_above,
            Some("ADD" | "add") => true,
            Some("REPLACE" | "replace") => false,
            Some(other) => {
                return Err(MapError::new(format!("`refine` is `{other}`")).hint("`ADD` or `REPLACE`"));
            }
        };
        let (mut further, mut own) = (vec![], vec![]);
        for uri in tile.uris()? {
            let path = within(folder_of(&file.path), uri)?;
            let is_tileset = path.len() > 5 && path[path.len() - 5..].eq_ignore_ascii_case(".json");
            if is_tileset { further.push(path) } else { own.push(path) }
        }
        let error_m = tile.geometric_error * scale_of(&scene_from_tile);
        let is_coarse = error_m > self.choice.geometric_error_m || own.is_empty();
        if let Some(cell) = tile.cell.as_ref().filter(|_| is_coarse) {
            let cells = cell.children(&mut self.subtrees_of(file))?.into_iter();
            tile.children = cells.map(|cell| Tile::of_cell(cell, 0.5 * tile.geometric_error, None)).collect();
        }
        let is_refined = is_coarse && !(tile.children.is_empty() && further.is_empty());
        if is_added || !is_refined {
            for path in &own {
                self.content(path, &scene_from_tile, file.is_z_up)?;
                self.found.geometric_error_m = self.found.geometric_error_m.max(error_m);
            }
        }
        let children = tile.children.into_iter().map(|child| Open::Tile(Box::new(child), Rc::clone(file)));
        let below = further.into_iter().map(Open::Tileset).chain(children).filter(|_| is_refined);
        Ok(below.map(|open| (open, Some((scene_from_tile, is_added)), depth + 1)).collect())
    }

    /// The first tile of a tree that a rule states, in the place of the tile that states it.
    fn first_of(&mut self, tree: Tree, root: &Tile, file: &OfFile) -> Result<Option<Tile>, MapError> {
        let cell = Cell::root(tree, &mut self.subtrees_of(file))?;
        self.found.has_own_errors |= file.has_own_errors && cell.as_ref().is_some_and(Cell::has_properties);
        Ok(cell.map(|cell| Tile::of_cell(cell, root.geometric_error, Some(root))))
    }

    /// Opens subtrees of a file's tiles.
    fn subtrees_of<'b>(&'b mut self, file: &'b OfFile) -> impl FnMut(&str) -> Result<Vec<u8>, MapError> + 'b {
        |uri| {
            self.subtrees += 1;
            if self.subtrees > MOST_SUBTREES {
                return Err(MapError::new(format!("there are more than {MOST_SUBTREES} subtrees")).hint("give an area"));
            }
            (self.read)(&within(folder_of(&file.path), uri)?)
        }
    }

    /// Adds a file of shapes.
    fn content(&mut self, path: &str, scene_from_tile: &DMat4, is_z_up: bool) -> Result<(), MapError> {
        let in_file = |error| in_file(path, error);
        let bytes = (self.read)(path).map_err(in_file)?;
        let (all, points) = shapes(&bytes).map_err(in_file)?;
        self.found.points += points;
        let mut is_in = false;
        let read = &mut *self.read;
        for part in all {
            // Shapes stand up first; the centre from which they count is one of the tile.
            let upright = if is_z_up { DMat4::IDENTITY } else { Z_UP_FROM_Y_UP };
            let place = |center: DVec3| {
                let moved = DMat4::from_translation(part.center + center);
                Z_UP_FROM_Y_UP.transpose() * *scene_from_tile * moved * upright
            };
            let mut beside = |uri: &str| read(&within(folder_of(path), uri)?);
            let is_added = self.joined.add(part.file, &place, &mut beside).map_err(in_file)?;
            self.found.points += usize::from(!is_added);
            is_in |= is_added;
        }
        self.found.tiles += usize::from(is_in);
        Ok(())
    }
}

fn in_file(path: &str, error: MapError) -> MapError {
    MapError { message: format!("`{path}`: {}", error.message), ..error }
}

/// Turns x ahead, y up, z to the viewer into x ahead, y away from the viewer, z up.
const Z_UP_FROM_Y_UP: DMat4 =
    DMat4::from_cols_array(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);

fn matrix_of(tile: &Tile) -> DMat4 {
    tile.transform.map_or(DMat4::IDENTITY, |numbers| DMat4::from_cols_array(&numbers))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gltf::document::chunks;
    use crate::mesh::MeshOptions;
    use cosfly_town::MapFormat;
    use serde_json::Value;

    /// Joins a tileset whose every other file is `content`.
    fn joined(root: &Value, content: &[u8]) -> Result<JoinedTiles, MapError> {
        let tileset = json!({ "asset": { "version": "1.1" }, "geometricError": 1, "root": root }).to_string();
        join("tileset.json", &TilesChoice::default(), &mut |path| {
            Ok(if path.ends_with(".json") { tileset.clone().into_bytes() } else { content.to_vec() })
        })
    }

    #[track_caller]
    fn check_refused(root: &Value, content: &[u8], words: &str) {
        let error = joined(root, content).expect_err(words);
        assert!(error.message.contains(words) && !error.hints.is_empty(), "{error:?}");
    }

    fn tile(uri: &str) -> Value {
        json!({ "geometricError": 0, "content": { "uri": uri } })
    }

    #[test]
    fn what_is_not_read_is_refused_by_name() {
        let text = |more: &str| format!("{{\"asset\":{{\"version\":\"2.0\"}}{more}}}").into_bytes();
        let one = tile("0.glb");
        check_refused(&tile("../0.glb"), b"", "leads out");
        check_refused(&tile("https://example.org/0.glb"), b"", "an address");
        check_refused(&json!({ "extensions": { "3DTILES_multiple_contents": {} } }), b"", "3DTILES_multiple_contents");
        check_refused(&json!({ "refine": "NEVER" }), b"", "NEVER");
        check_refused(&json!({}), b"", "no tile has shapes");
        check_refused(&one, b"i3dm", "i3dm");
        check_refused(&one, b"\x1f\x8b\x08\x00", "gzip");
        check_refused(&one, b"b3dm\x01\0\0\0\x1c\0\0\0\x08\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", "`0.glb`: its 28 bytes");
        check_refused(&one, b"glTF\x01\0\0\0", "glTF 1");
        for (name, hint) in [("ACME_compression", "cp"), ("EXT_texture_avif", "PNG")] {
            let error = joined(&one, &text(&format!(",\"extensionsRequired\":[\"{name}\"]"))).expect_err(name);
            assert!(error.message.contains(name) && error.hints[0].contains(hint), "{error:?}");
        }
        check_refused(&one, &text(",\"nodes\":[{\"mesh\":4}]"), "number 4 of its 0 `meshes`");
        check_refused(&one, &text(",\"bufferViews\":[{\"byteLength\":9}]"), "beyond its end");
        for (stream, words) in
            [("\"count\":2,\"byteStride\":4,\"byteLength\":9", "beyond its end"), ("\"count\":-1", "no size")]
        {
            let view = format!(",\"bufferViews\":[{{\"extensions\":{{\"EXT_meshopt_compression\":{{{stream}}}}}}}]");
            check_refused(&one, &text(&view), words);
        }
        check_refused(&one, &text(",\"buffers\":[{\"uri\":\"../../secret\"}]"), "leads out");
    }

    #[test]
    fn tiles_of_points_alone_are_left_out() {
        let points =
            json!({ "asset": { "version": "2.0" }, "meshes": [{ "primitives": [{ "mode": 0, "attributes": {} }] }] });
        check_refused(&tile("0.gltf"), points.to_string().as_bytes(), "no tile has shapes");
        let both = json!({ "geometricError": 0, "contents": [{ "uri": "0.glb" }, { "uri": "points.gltf" }] });
        let tileset = json!({ "asset": { "version": "1.1" }, "geometricError": 1, "root": both }).to_string();
        let files = |path: &str| match path {
            "tileset.json" => tileset.clone().into_bytes(),
            "0.glb" => crate::gltf::GlTf::EXAMPLE.to_vec(),
            _ => points.to_string().into_bytes(),
        };
        let joined = join("tileset.json", &TilesChoice::default(), &mut |path| Ok(files(path))).expect("a mesh");
        assert_eq!((joined.tiles, joined.points), (1, 1));
    }

    #[test]
    fn tilesets_that_name_themselves_end() {
        check_refused(&tile("tileset.json"), b"", "nested deeper");
        let twice = json!({ "contents": [{ "uri": "tileset.json" }, { "uri": "tileset.json" }] });
        check_refused(&twice, b"", "nested deeper");
    }

    #[test]
    fn the_file_names_its_source_and_the_owners_of_its_tiles() {
        let asset = |glb: &[u8]| {
            let document: Value = serde_json::from_slice(chunks(glb).expect("a file").0).expect("JSON");
            document["asset"].clone()
        };
        let owned = |owner: &str| {
            let (text, blob) = chunks(crate::gltf::GlTf::EXAMPLE).expect("a file");
            let mut document: Value = serde_json::from_slice(text).expect("JSON");
            document["asset"]["copyright"] = owner.into();
            let mut text = document.to_string();
            text.push_str(&"   "[..text.len().next_multiple_of(4) - text.len()]);
            let blob = blob.expect("a blob");
            let number = |of: usize| (of as u32).to_le_bytes();
            let head = [&b"glTF\x02\0\0\0"[..], &number(28 + text.len() + blob.len()), &number(text.len()), b"JSON"];
            [&head.concat(), text.as_bytes(), &number(blob.len()), b"BIN\0", blob].concat()
        };
        let both = json!({ "geometricError": 0, "contents": [{ "uri": "b.glb" }, { "uri": "a.glb" }] });
        let tileset = json!({ "asset": { "version": "1.1" }, "geometricError": 1, "root": both }).to_string();
        let joined = join("town.json", &TilesChoice::default(), &mut |path| {
            Ok(if path == "town.json" { tileset.clone().into_bytes() } else { owned(&format!("owner of {path}")) })
        });
        let found = asset(&joined.expect("a mesh").glb);
        assert_eq!(found["extras"], json!({ "source": "town.json", "origin": null, "geometric_error_m": 0.0 }));
        assert_eq!(found["copyright"], "owner of a.glb; owner of b.glb");
    }

    #[test]
    fn refinement_that_adds_keeps_the_coarse_tile() {
        let glb = crate::gltf::GlTf::EXAMPLE;
        let both = |refine: &str| json!({ "geometricError": 5, "refine": refine, "content": { "uri": "0.glb" }, "children": [tile("1.glb")] });
        let [added, replaced] = ["ADD", "REPLACE"].map(|refine| joined(&both(refine), glb).expect("a mesh"));
        assert_eq!((added.tiles, replaced.tiles, added.geometric_error_m), (2, 1, 5.0));
        let (town, _) = crate::gltf::GlTf::read(&replaced.glb, &MeshOptions::default()).expect("a town");
        let (own, _) = crate::gltf::GlTf::read(glb, &MeshOptions::default()).expect("a town");
        assert_eq!(town.obstacles, own.obstacles);
    }
}
