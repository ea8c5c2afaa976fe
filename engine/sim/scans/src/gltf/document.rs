//! [`Document`]: the parts of a glTF file that shapes need. Every index and every range is checked where it is used.

use crate::bytes::Bytes;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
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
/// Kinds of numbers.
const REAL: u32 = 5126;

/// A file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct Document {
    scene: Option<usize>,
    scenes: Vec<Scene>,
    nodes: Vec<Node>,
    meshes: Vec<Mesh>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<View>,
    buffers: Vec<Buffer>,
    materials: Vec<Material>,
    textures: Vec<Texture>,
    images: Vec<Image>,
    /// Bytes of the buffers.
    #[serde(skip)]
    data: Vec<Vec<u8>>,
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

/// Shapes that belong together.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct Mesh {
    /// Its name.
    pub name: Option<String>,
    /// Its shapes.
    pub primitives: Vec<Primitive>,
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
}

/// Looks of a shape.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct Material {
    /// Colours of metallic-roughness shading, the only ones that are read.
    pub pbr_metallic_roughness: Colours,
}

/// Base colour of a material.
#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct Colours {
    /// Factor of the base colour: linear red, green, blue, and alpha.
    pub base_color_factor: [f32; 4],
    /// Picture of the base colour.
    pub base_color_texture: Option<TextureUse>,
}

impl Default for Colours {
    fn default() -> Self {
        Self { base_color_factor: [1.0; 4], base_color_texture: None }
    }
}

/// A texture as a material has it.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct TextureUse {
    /// Number of the texture.
    pub index: usize,
    /// Number of the set of texture coordinates.
    pub tex_coord: usize,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Texture {
    source: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Image {
    uri: Option<String>,
    buffer_view: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    byte_offset: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    kind: String,
    sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct View {
    buffer: usize,
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
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
        let buffers = std::mem::take(&mut document.buffers);
        let data = buffers.into_iter().enumerate().map(|(index, buffer)| buffer.bytes(index, blob));
        document.data = data.collect::<Result<_, _>>()?;
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

    fn viewed(&self, view: &View) -> Option<&[u8]> {
        self.data.get(view.buffer)?.get(view.byte_offset..)?.get(..view.byte_length)
    }

    /// Bytes of each element of an accessor; none where it is sparse or reaches beyond its data.
    fn elements(&self, accessor: &Accessor, bytes: usize) -> Option<impl Iterator<Item = &[u8]>> {
        let view = self.buffer_views.get(accessor.buffer_view.filter(|_| accessor.sparse.is_none())?)?;
        let data = self.viewed(view)?.get(accessor.byte_offset..)?;
        let stride = view.byte_stride.unwrap_or(bytes).max(bytes);
        let end = accessor.count.checked_sub(1)?.checked_mul(stride)?.checked_add(bytes)?;
        (end <= data.len()).then(|| (0..accessor.count).map(move |at| &data[at * stride..][..bytes]))
    }

    /// Points of an accessor.
    pub fn positions(&self, accessor: usize) -> Option<Vec<DVec3>> {
        let accessor = self.accessors.get(accessor)?;
        if accessor.component_type != REAL || accessor.kind != "VEC3" {
            return None;
        }
        let number = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]).into();
        let points = self.elements(accessor, 12)?;
        Some(points.map(|own| DVec3::new(number(own), number(&own[4..]), number(&own[8..]))).collect())
    }

    /// Texture coordinates of an accessor: from the left and from the top, 0 to 1 over the picture.
    pub fn texture_coordinates(&self, accessor: usize) -> Option<Vec<[f32; 2]>> {
        let accessor = self.accessors.get(accessor)?;
        if accessor.kind != "VEC2" {
            return None;
        }
        let short = |bytes: &[u8]| f32::from(u16::from_le_bytes([bytes[0], bytes[1]])) / 65535.0;
        let real = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        Some(match accessor.component_type {
            5121 => self.elements(accessor, 2)?.map(|own| [0, 1].map(|k| f32::from(own[k]) / 255.0)).collect(),
            5123 => self.elements(accessor, 4)?.map(|own| [0, 2].map(|k| short(&own[k..]))).collect(),
            REAL => self.elements(accessor, 8)?.map(|own| [0, 4].map(|k| real(&own[k..]))).collect(),
            _ => return None,
        })
    }

    /// A material.
    pub fn material(&self, index: usize) -> Option<&Material> {
        self.materials.get(index)
    }

    /// Number of the picture of a texture.
    pub fn picture_of(&self, texture: usize) -> Option<usize> {
        self.textures.get(texture)?.source
    }

    /// Bytes of a picture, PNG or JPEG.
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

    /// Numbers of corners of an accessor.
    pub fn indices(&self, accessor: usize) -> Option<Vec<u32>> {
        let accessor = self.accessors.get(accessor)?;
        let bytes = match accessor.component_type {
            5121 => 1,
            5123 => 2,
            5125 => 4,
            _ => return None,
        };
        let number = |own: &[u8]| own.iter().rev().fold(0, |number, byte| number << 8 | u32::from(*byte));
        Some(self.elements(accessor, bytes)?.map(number).collect())
    }
}

impl Buffer {
    fn bytes(self, index: usize, blob: Option<&[u8]>) -> Result<Vec<u8>, MapError> {
        let data = match self.uri {
            None => blob.map(<[u8]>::to_vec),
            Some(uri) => embedded(&uri)?,
        };
        data.filter(|data| data.len() >= self.byte_length).ok_or_else(|| {
            let error = MapError::new(format!(
                "buffer {index} has less data than the {} bytes that it states",
                self.byte_length
            ));
            error.hint("the file seems to be cut off: export it again")
        })
    }
}

/// Data that an address holds; none where they are damaged.
fn embedded(uri: &str) -> Result<Option<Vec<u8>>, MapError> {
    let Some((_, data)) = uri.strip_prefix("data:").and_then(|rest| rest.split_once(";base64,")) else {
        let shown: String = uri.chars().take(60).collect();
        let error = MapError::new(format!("the file keeps its data in another one, `{shown}`"));
        return Err(error.hint("export one file: GLB, or glTF with embedded data"));
    };
    Ok(STANDARD.decode(data).ok())
}

/// Text and data of a binary file.
fn chunks(file: &[u8]) -> Result<(&[u8], Option<&[u8]>), MapError> {
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
