//! [`Tileset`]: a tree of tiles, as a file `tileset.json` states it.

use cosfly_town::MapError;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Most bytes of a file that states tiles.
const MOST_BYTES: usize = 64 << 20;
/// Extensions that change nothing about shapes, or are what is read anyway.
const READ: [&str; 2] = ["3DTILES_content_gltf", "3DTILES_metadata"];

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Tileset {
    asset: Asset,
    pub root: Tile,
    #[serde(default)]
    extensions_required: Vec<String>,
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
    implicit_tiling: Option<Value>,
    extensions: BTreeMap<String, Value>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Content {
    uri: Option<String>,
    url: Option<String>,
}

/// Bounds of a tile: one of these.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Volume {
    /// West, south, east, north, radians; lowest and highest, metres above the ellipsoid. Never moved by transforms.
    pub region: Option<[f64; 6]>,
    /// Middle and three half axes.
    #[serde(rename = "box")]
    pub oriented: Option<[f64; 12]>,
    /// Middle and radius.
    pub sphere: Option<[f64; 4]>,
}

impl Tileset {
    /// Reads a file.
    ///
    /// # Errors
    /// Other versions, extensions that are not read, damaged files.
    pub fn read(bytes: &[u8]) -> Result<Self, MapError> {
        if bytes.len() > MOST_BYTES {
            let error = MapError::new(format!("the file has {} bytes; at most {MOST_BYTES} are read", bytes.len()));
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
    /// Addresses of its shapes and of tilesets that go on below it.
    ///
    /// # Errors
    /// Tiles that are nowhere written down.
    pub fn uris(&self) -> Result<Vec<&str>, MapError> {
        if self.implicit_tiling.is_some() || self.extensions.contains_key("3DTILES_implicit_tiling") {
            let error = MapError::new("the tileset states its tiles by a rule (`implicitTiling`), which is not read");
            return Err(error.hint("ask the tool that made it for explicit tiles"));
        }
        let all = self.content.iter().chain(&self.contents);
        Ok(all.filter_map(|content| content.uri.as_deref().or(content.url.as_deref())).collect())
    }
}
