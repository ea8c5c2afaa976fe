//! [`Document`]: the parts of a glTF file that shapes need. Every index and every range is checked where it is used.

use super::materials::{Material, Sampler, Texture, TextureWrap};
use super::views::{Accessor, Instances, Packed, View};
use crate::bytes::Bytes;
use crate::mesh::options::IN_A_PLAN;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use cosfly_diagnose::counted;
use cosfly_frames::DVec3;
use cosfly_town::MapError;
use glam::{DMat4, DQuat};
use serde::Deserialize;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// First bytes of a binary file.
pub const MAGIC: &[u8] = b"glTF";
/// Marks of its two chunks.
const TEXT_CHUNK: u32 = 0x4E4F_534A;
const DATA_CHUNK: u32 = 0x004E_4942;
/// Extensions that are read, or change nothing about shapes and base colours; those of materials are, too.
const READ: [&str; 15] = [
    "CESIUM_RTC",
    "CESIUM_primitive_outline",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_structural_metadata",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
];

/// Most bytes of all that packed views and shapes hold, drawn or not: those of any file, those for each byte of a file, and those of no file.
/// A few bytes may say that they are millions, and many shapes may be one.
const SMALL_BYTES: u64 = 16 << 20;
const BYTES_PER_BYTE: u64 = 64;
const MOST_BYTES: u64 = 1 << 30;

/// A file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct Document {
    scene: Option<usize>,
    scenes: Vec<Scene>,
    nodes: Vec<Node>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffer_views: Vec<View>,
    buffers: Vec<Buffer>,
    materials: Vec<Material>,
    textures: Vec<Texture>,
    samplers: Vec<Sampler>,
    images: Vec<Image>,
    extensions_required: Vec<String>,
    extensions: DocumentExtensions,
    /// Error of a tileset; no glTF file has one.
    geometric_error: Option<f64>,
    /// Bytes of the buffers.
    #[serde(skip)]
    pub(super) data: Vec<Vec<u8>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct DocumentExtensions {
    #[serde(rename = "CESIUM_RTC")]
    centre: Option<Centre>,
}

/// A place on the Earth from which all corners count.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Centre {
    center: [f64; 3],
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Scene {
    nodes: Vec<usize>,
}

/// A place in the scene.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct Node {
    /// Its name.
    pub name: Option<String>,
    /// Number of its mesh.
    pub mesh: Option<usize>,
    /// Numbers of the nodes below it.
    pub children: Vec<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
    skin: Option<usize>,
    weights: Vec<f64>,
    pub(super) extensions: NodeExtensions,
}

impl Node {
    /// From the node's frame to that of the one above.
    pub fn matrix(&self) -> DMat4 {
        match &self.matrix {
            Some(numbers) => DMat4::from_cols_array(numbers),
            None => DMat4::from_scale_rotation_translation(
                self.scale.map_or(DVec3::ONE, DVec3::from_array),
                self.rotation.map_or(DQuat::IDENTITY, DQuat::from_array),
                self.translation.map_or(DVec3::ZERO, DVec3::from_array),
            ),
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub(super) instances: Option<Instances>,
}

/// Shapes that belong together.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct Mesh {
    /// Its name.
    pub name: Option<String>,
    /// Its shapes.
    pub primitives: Vec<Primitive>,
    weights: Vec<f64>,
}

/// One shape.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct Primitive {
    /// Numbers of accessors by what they hold.
    pub attributes: BTreeMap<String, usize>,
    /// Number of the accessor of corners.
    pub indices: Option<usize>,
    /// How corners make triangles.
    pub mode: Option<u32>,
    /// Number of the material.
    pub material: Option<usize>,
    pub(super) extensions: ShapeExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct ShapeExtensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    pub(super) draco: Option<Packed>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Image {
    uri: Option<String>,
    buffer_view: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Buffer {
    uri: Option<String>,
    byte_length: usize,
}

impl Document {
    /// Reads a file of either form.
    ///
    /// # Errors
    /// No glTF 2.0, data in other files, or less data than stated.
    pub fn read(bytes: &[u8]) -> Result<Self, MapError> {
        let (text, blob) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
        let text = text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text);
        let mut document: Self = serde_json::from_slice(text).map_err(|error| {
            let hint =
                if error.is_eof() { "the file seems to be cut off: export it again" } else { "glTF 2.0 is read" };
            MapError::new(format!("the glTF file cannot be read: {error}")).hint(hint)
        })?;
        // Pictures are read, or refused, where they are drawn.
        let required = document.extensions_required.iter().map(String::as_str);
        check_required(required.filter(|name| !name.contains("_texture_")))?;
        if document.geometric_error.is_some() {
            let error = MapError::new("the file is a tileset of 3D Tiles, no glTF file");
            return Err(error.hint("`cosfly map tiles tileset.json --out scan.glb` joins the tiles to one mesh"));
        }
        if let Some(Centre { center }) = &document.extensions.centre
            && center.iter().any(|number| *number != 0.0)
        {
            let error = MapError::new(format!("the corners count from `CESIUM_RTC`, {center:?}, which is not read"));
            return Err(error.hint(IN_A_PLAN));
        }
        let buffers = std::mem::take(&mut document.buffers);
        let data = buffers.into_iter().enumerate().map(|(index, buffer)| {
            if document.stands_for_packed(index) { Ok(vec![]) } else { buffer.bytes(index, blob) }
        });
        document.data = data.collect::<Result<_, _>>()?;
        let bytes = document.data.iter().map(|data| data.len() as u64).sum::<u64>();
        let mut left = MOST_BYTES.min(SMALL_BYTES + BYTES_PER_BYTE * bytes);
        document.unpack_views(&mut left)?;
        document.unpack(left)?;
        Ok(document)
    }

    /// Nodes that the scene begins with; all nodes that are below none where there is no scene.
    pub fn roots(&self) -> Vec<usize> {
        match self.scenes.get(self.scene.unwrap_or(0)) {
            Some(scene) => scene.nodes.clone(),
            None => {
                let mut is_below = vec![false; self.nodes.len()];
                for child in self.nodes.iter().flat_map(|node| &node.children) {
                    is_below.get_mut(*child).into_iter().for_each(|is_below| *is_below = true);
                }
                (0..self.nodes.len()).filter(|node| !is_below[*node]).collect()
            }
        }
    }

    /// Differences from what the file means, in words.
    pub fn remarks(&self) -> Vec<String> {
        let is_morphed = |node: &&Node| {
            let of_mesh = node.mesh.and_then(|mesh| self.meshes.get(mesh)).map_or(&[][..], |mesh| &mesh.weights);
            let weights = if node.weights.is_empty() { of_mesh } else { &node.weights };
            weights.iter().any(|weight| *weight != 0.0)
        };
        let bent = self.nodes.iter().filter(|node| node.skin.is_some() && node.mesh.is_some()).count();
        let morphed = self.nodes.iter().filter(is_morphed).count();
        let words = [(bent, "bend with a skeleton (`skin`)"), (morphed, "change their shape by `weights`")];
        let seen = words.into_iter().filter(|(count, _)| *count > 0);
        seen.map(|(count, what)| {
            format!("meshes of {count} nodes {what}, which is not read: export the scene as it stands")
        })
        .collect()
    }

    /// A node.
    ///
    /// # Errors
    /// There is none of that number.
    pub fn node(&self, index: usize) -> Result<&Node, MapError> {
        let refused = || MapError::new(format!("node {index} is named, but the file has {} nodes", self.nodes.len()));
        self.nodes.get(index).ok_or_else(refused)
    }

    /// A mesh.
    pub fn mesh(&self, index: usize) -> Option<&Mesh> {
        self.meshes.get(index)
    }

    /// A material.
    pub fn material(&self, index: usize) -> Option<&Material> {
        self.materials.get(index)
    }

    /// Number of the picture of a texture, and what is beyond its edges, across and down.
    ///
    /// # Errors
    /// Pictures that only an extension knows.
    pub fn picture_of(&self, texture: usize) -> Result<(usize, [TextureWrap; 2]), MapError> {
        let own = self.textures.get(texture);
        let Some((picture, own)) = own.and_then(|own| Some((own.picture()?, own))) else {
            let by = own.and_then(|own| own.extensions.keys().next());
            let by = by.map_or_else(
                || "names no picture".to_owned(),
                |by| format!("has its picture by `{by}` only, which is not read"),
            );
            let error = MapError::new(format!("texture {texture} {by}"));
            return Err(error.hint("export the mesh with PNG, JPEG, WebP or KTX2 pictures"));
        };
        let sampler = own.sampler.and_then(|sampler| self.samplers.get(sampler));
        Ok((picture, sampler.map_or([TextureWrap::Repeat; 2], Sampler::wraps)))
    }

    /// Bytes of a picture.
    ///
    /// # Errors
    /// There is none of that number, the picture lies in another file, or its bytes are missing.
    pub fn picture(&self, index: usize) -> Result<Cow<'_, [u8]>, MapError> {
        let found = self.images.get(index).map(|image| match &image.uri {
            None => {
                let view = image.buffer_view.and_then(|view| self.buffer_views.get(view));
                Ok(view.and_then(|view| self.viewed(view)).map(Cow::Borrowed))
            }
            Some(uri) => embedded(uri).map(|data| data.map(Cow::Owned)),
        });
        let missing = || {
            let message = format!("picture {index} is named, but the file does not hold all of its bytes");
            MapError::new(message).hint("the file seems to be cut off: export it again")
        };
        found.transpose()?.flatten().ok_or_else(missing)
    }
}

impl Buffer {
    fn bytes(self, index: usize, blob: Option<&[u8]>) -> Result<Vec<u8>, MapError> {
        let data = match self.uri {
            // The data of a binary file are those of its first buffer.
            None => blob.filter(|_| index == 0).map(<[u8]>::to_vec),
            Some(uri) => embedded(&uri)?,
        };
        let Some(data) = data else {
            let error = MapError::new(format!(
                "buffer {index} has no data: of a binary file, the first one alone may name none"
            ));
            return Err(error.hint("export one file: GLB, or glTF with embedded data"));
        };
        Some(data).filter(|data| data.len() >= self.byte_length).ok_or_else(|| {
            let error = MapError::new(format!(
                "buffer {index} has less data than the {} that it states",
                counted(self.byte_length, "byte")
            ));
            error.hint("the file seems to be cut off: export it again")
        })
    }
}

/// Refuses what a file requires and nobody here reads.
pub(crate) fn check_required<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<(), MapError> {
    let is_read = |name: &&str| name.starts_with("KHR_materials_") || READ.contains(name);
    let Some(name) = names.into_iter().find(|name| !is_read(name)) else { return Ok(()) };
    let hint = match name {
        _ if name.contains("_texture_") => "export the file with PNG or JPEG pictures",
        _ if name.contains("compression") => {
            "`gltf-transform cp FILE plain.glb` unpacks shapes, or export the file without compression"
        }
        _ => "export the file without this extension",
    };
    Err(MapError::new(format!("the file requires the extension `{name}`, which is not read")).hint(hint))
}

/// Data that an address holds; none where they are damaged.
pub(crate) fn embedded(uri: &str) -> Result<Option<Vec<u8>>, MapError> {
    let Some((_, data)) = uri.strip_prefix("data:").and_then(|rest| rest.split_once(";base64,")) else {
        // A file names no other file that is opened, wherever it lies.
        let shown: String = uri.chars().take(60).collect();
        let error =
            MapError::new(format!("the file keeps its data in another one, `{shown}`, and no other file is opened"));
        return Err(error.hint("export one file: GLB, or glTF with embedded data"));
    };
    Ok(STANDARD.decode(data).ok())
}

/// Text and data of a binary file.
pub(crate) fn chunks(file: &[u8]) -> Result<(&[u8], Option<&[u8]>), MapError> {
    let bytes = Bytes(file);
    let version = bytes.u32(4, "the version")?;
    if version != 2 {
        return Err(MapError::new(format!("the file is glTF {version}; glTF 2.0 is read")));
    }
    let length = u64::from(bytes.u32(8, "the length of the file")?);
    bytes.slice(0, length, "the end that it states")?;
    let (mut text, mut data, mut at) = (None, None, 12);
    while at + 8 <= length {
        let size = u64::from(bytes.u32(at, "a chunk")?);
        let content = bytes.slice(at + 8, size, "the end of a chunk")?;
        match bytes.u32(at + 4, "a chunk")? {
            TEXT_CHUNK => text = text.or(Some(content)),
            DATA_CHUNK => data = data.or(Some(content)),
            _ => {}
        }
        at += 8 + size;
    }
    let text = text.ok_or_else(|| MapError::new("the file has no chunk of text").hint("export the file again"))?;
    Ok((text, data))
}
