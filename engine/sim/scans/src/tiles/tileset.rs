//! [`Tileset`]: a tree of tiles, as a file `tileset.json` states it.

use super::implicit::{Cell, Rule, Tree};
use super::volume::Volume;
use cosfly_diagnose::counted;
use cosfly_town::MapError;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Most bytes of a file that states tiles.
const MOST_BYTES: usize = 64 << 20;
/// Extensions that change nothing about shapes, or are what is read anyway.
const READ: [&str; 3] = ["3DTILES_content_gltf", "3DTILES_implicit_tiling", "3DTILES_metadata"];
/// The extension of 1.0 that states tiles by a rule.
const IMPLICIT: &str = "3DTILES_implicit_tiling";

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Tileset {
    asset: Asset,
    pub root: Tile,
    #[serde(default)]
    extensions_required: Vec<String>,
    /// Meanings of the properties of tiles.
    #[serde(default)]
    schema: Value,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: String,
    gltf_up_axis: Option<String>,
}

/// A tile and those below it.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Tile {
    pub bounding_volume: Volume,
    /// How far its shapes are from the finest, metres of its own frame.
    pub geometric_error: f64,
    /// `ADD` or `REPLACE`; none is that of the tile above.
    pub refine: Option<String>,
    content: Option<Content>,
    contents: Vec<Content>,
    pub children: Vec<Self>,
    /// To the frame of the tile above, column by column.
    pub transform: Option<[f64; 16]>,
    implicit_tiling: Option<Rule>,
    extensions: BTreeMap<String, Value>,
    /// Its place in a tree of tiles that a rule states.
    #[serde(skip)]
    pub cell: Option<Cell>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Content {
    uri: Option<String>,
    url: Option<String>,
}

impl Content {
    fn uri(&self) -> Option<&str> {
        self.uri.as_deref().or(self.url.as_deref())
    }
}

impl Tileset {
    /// Reads a file.
    ///
    /// # Errors
    /// Other versions, extensions that are not read, damaged files.
    pub fn read(bytes: &[u8]) -> Result<Self, MapError> {
        if bytes.len() > MOST_BYTES {
            let error =
                MapError::new(format!("the file has {}; at most {MOST_BYTES} are read", counted(bytes.len(), "byte")));
            return Err(error.hint("split the tileset into external ones"));
        }
        let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
        let tileset: Self = serde_json::from_slice(text).map_err(|error| {
            let hint = "3D Tiles 1.0 and 1.1 are read: a file with `asset`, `geometricError` and `root`";
            MapError::new(format!("the tileset cannot be read: {error}")).hint(hint)
        })?;
        if !["1.0", "1.1"].contains(&tileset.asset.version.as_str()) {
            let message = format!("the tileset has version `{}`", tileset.asset.version);
            return Err(MapError::new(message).hint("3D Tiles 1.0 and 1.1 are read: `npx 3d-tiles-tools upgrade`"));
        }
        if let Some(name) = tileset.extensions_required.iter().find(|name| !READ.contains(&name.as_str())) {
            let error = MapError::new(format!("the tileset requires the extension `{name}`, which is not read"));
            return Err(error.hint("export it as 3D Tiles 1.1 without extensions"));
        }
        Ok(tileset)
    }

    /// Whether tiles state how coarse they are by a property.
    pub fn has_own_errors(&self) -> bool {
        self.schema.to_string().contains("TILE_GEOMETRIC_ERROR")
    }

    /// Whether shapes have z up instead of y.
    ///
    /// # Errors
    /// Another axis.
    pub fn is_z_up(&self) -> Result<bool, MapError> {
        match self.asset.gltf_up_axis.as_deref() {
            None | Some("Y" | "y") => Ok(false),
            Some("Z" | "z") => Ok(true),
            Some(other) => Err(MapError::new(format!("`gltfUpAxis` is `{other}`")).hint("`Y` or `Z`")),
        }
    }
}

impl Tile {
    /// The tile of a cell, in the place of the tile that states the tree where it is the first one.
    pub fn of_cell(cell: Cell, geometric_error: f64, root: Option<&Self>) -> Self {
        let content = |uri: &String| Content { uri: Some(uri.clone()), url: None };
        Self {
            bounding_volume: cell.volume(),
            geometric_error,
            refine: root.and_then(|root| root.refine.clone()),
            contents: cell.contents.iter().map(content).collect(),
            transform: root.and_then(|root| root.transform),
            cell: Some(cell),
            ..Self::default()
        }
    }

    /// Addresses of its shapes and of tilesets that go on below it.
    ///
    /// # Errors
    /// Contents that only an extension knows.
    pub fn uris(&self) -> Result<Vec<&str>, MapError> {
        let several = "3DTILES_multiple_contents";
        if self.extensions.contains_key(several) {
            let error = MapError::new(format!("a tile has its contents by `{several}`, which is not read"));
            return Err(error.hint("`npx 3d-tiles-tools upgrade` makes 3D Tiles 1.1 of the tileset"));
        }
        Ok(self.content.iter().chain(&self.contents).filter_map(Content::uri).collect())
    }

    /// The tree of tiles that begins here.
    ///
    /// # Errors
    /// Those of [`Tree::new`].
    pub fn tree(&self) -> Result<Option<Tree>, MapError> {
        let of_extension = self.extensions.get(IMPLICIT).map(Rule::deserialize);
        let of_extension = of_extension.transpose().map_err(|error| {
            MapError::new(format!("`{IMPLICIT}` cannot be read: {error}")).hint("export the tileset as 3D Tiles 1.1")
        })?;
        let Some(rule) = self.implicit_tiling.as_ref().or(of_extension.as_ref()) else { return Ok(None) };
        let contents = self.uris()?.into_iter().map(str::to_owned).collect();
        Tree::new(rule, self.bounding_volume.clone(), contents).map(Some)
    }
}
