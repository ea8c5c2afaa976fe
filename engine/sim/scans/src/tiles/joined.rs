//! [`Joined`]: one glTF file that is made of many.

use crate::gltf::document::{MAGIC, check_required, chunks, embedded};
use crate::gltf::materials::PICTURES;
use cosfly_frames::DVec3;
use cosfly_town::MapError;
use glam::DMat4;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Most bytes of the text of one file and of all.
const MOST_TEXT: usize = 16 << 20;
const MOST_TEXTS: usize = 256 << 20;
/// Most bytes of a GLB file, which states its length in 32 bits; a part is kept for its text.
const MOST_BYTES: usize = u32::MAX as usize - MOST_TEXTS;
/// Lists of a glTF file that are joined.
const LISTS: [&str; 8] = ["nodes", "meshes", "accessors", "bufferViews", "materials", "textures", "images", "samplers"];
/// Parts of accessors, shapes and materials that hold no number of another thing.
const OF_ACCESSOR: [&str; 7] = ["byteOffset", "componentType", "count", "max", "min", "normalized", "type"];
const OF_NODE: [&str; 5] = ["name", "matrix", "translation", "rotation", "scale"];
const OF_MATERIAL: [&str; 5] = ["name", "alphaMode", "alphaCutoff", "doubleSided", "emissiveFactor"];
const OF_SAMPLER: [&str; 4] = ["magFilter", "minFilter", "wrapS", "wrapT"];
/// Modes of shapes below this one are points and lines.
const FIRST_OF_TRIANGLES: u64 = 4;
/// Extensions of what is carried over, where a file has them.
const GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";
const TRANSFORM: &str = "KHR_texture_transform";
const DRACO: &str = "KHR_draco_mesh_compression";
const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
const OF_STREAM: [&str; 5] = ["byteLength", "byteStride", "count", "mode", "filter"];

/// A file as it grows.
#[derive(Default)]
pub(super) struct Joined {
    lists: [Vec<Value>; LISTS.len()],
    data: Vec<u8>,
    /// Bytes that all packed views hold; each is a part of a second buffer, which is not in the file.
    unpacked: u64,
    roots: Vec<usize>,
    text_bytes: usize,
    /// Whom its files name as their owners.
    copyrights: BTreeSet<String>,
    /// Extensions that some of its files use, and those without which it cannot be read.
    used: BTreeSet<&'static str>,
    required: BTreeSet<&'static str>,
}

/// One file that is added: its text, and where its numbers begin in the whole.
struct Part<'a> {
    document: &'a Value,
    first: [usize; LISTS.len()],
    /// Places of its buffers in the data, and their lengths.
    buffers: Vec<[usize; 2]>,
}

impl Joined {
    /// Adds a file, unless it shows points or lines alone; says whether it did. `place` gives the way from its frame to that of the
    /// whole, by the place from which its corners count; `read` opens a file that this one names.
    ///
    /// # Errors
    /// Other versions, packed shapes and pictures, damaged files, more than a file can hold.
    pub fn add(
        &mut self,
        file: &[u8],
        place: &dyn Fn(DVec3) -> DMat4,
        read: &mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>,
    ) -> Result<bool, MapError> {
        let (text, blob) = if file.starts_with(MAGIC) { chunks(file)? } else { (file, None) };
        let text = text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text);
        self.text_bytes += text.len();
        if text.len() > MOST_TEXT || self.text_bytes > MOST_TEXTS {
            let message =
                format!("the texts of the tiles are longer than {MOST_TEXT} bytes each or {MOST_TEXTS} together");
            return Err(MapError::new(message).hint("give a larger `--error-m`, or an area"));
        }
        let document: Value = serde_json::from_slice(text)
            .map_err(|error| MapError::new(format!("its glTF text cannot be read: {error}")))?;
        check(&document)?;
        if is_of_points(&document) {
            return Ok(false);
        }
        self.copyrights.extend(document["asset"]["copyright"].as_str().map(str::to_owned));
        let mut part = Part { document: &document, first: self.lists.each_ref().map(Vec::len), buffers: vec![] };
        for (index, buffer) in list(&document, "buffers").iter().enumerate() {
            let own;
            let bytes = match buffer["uri"].as_str() {
                None => blob.filter(|_| index == 0).unwrap_or_default(),
                Some(uri) => {
                    own = opened(uri, read)?;
                    &own[..]
                }
            };
            part.buffers.push([self.keep(bytes)?, bytes.len()]);
        }
        for node in list(&document, "nodes") {
            self.lists[0].push(part.node(node)?);
        }
        for mesh in list(&document, "meshes") {
            self.lists[1].push(part.mesh(mesh)?);
        }
        for accessor in list(&document, "accessors") {
            self.lists[2].push(part.accessor(accessor)?);
        }
        for view in list(&document, "bufferViews") {
            let own = self.view(&part, view)?;
            self.lists[3].push(own);
        }
        for material in list(&document, "materials") {
            self.lists[4].push(part.material(material)?);
        }
        for texture in list(&document, "textures") {
            let own = self.texture(&part, texture)?;
            self.lists[5].push(own);
        }
        self.images(&part, read)?;
        self.lists[7].extend(list(&document, "samplers").iter().map(|sampler| kept(sampler, &OF_SAMPLER)));
        let used = list(&document, "extensionsUsed").iter().filter_map(Value::as_str);
        self.used
            .extend([GLOSSINESS, TRANSFORM, DRACO].into_iter().filter(|name| used.clone().any(|own| own == *name)));
        let roots = part.roots()?;
        let matrix = place(center_of(&document));
        if !matrix.is_finite() {
            return Err(MapError::new("its place is no number"));
        }
        self.roots.push(self.lists[0].len());
        self.lists[0].push(json!({ "matrix": matrix.to_cols_array(), "children": roots }));
        Ok(true)
    }

    /// A view, packed or not.
    fn view(&mut self, part: &Part, view: &Value) -> Result<Value, MapError> {
        let packed = MESHOPT.into_iter().find(|name| view["extensions"][name].is_object());
        self.required.extend(packed);
        match packed {
            Some(name) => part.packed_view(view, name, &mut self.unpacked),
            None => part.view(view),
        }
    }

    /// A texture with its picture: the plain one where it has two.
    fn texture(&mut self, part: &Part, texture: &Value) -> Result<Value, MapError> {
        let mut own = json!({});
        put(&mut own, "sampler", part.number(&texture["sampler"], 7)?);
        let plain = part.number(&texture["source"], 6)?;
        put(&mut own, "source", plain);
        let packed = PICTURES.into_iter().find(|name| texture["extensions"][name].is_object());
        if let Some(name) = packed.filter(|_| plain.is_none()) {
            let source = part.number(&texture["extensions"][name]["source"], 6)?;
            own["extensions"] = json!({ name: { "source": source } });
            self.required.insert(name);
        }
        Ok(own)
    }

    /// Adds the pictures of a file; those beside it become views.
    fn images(&mut self, part: &Part, read: &mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>) -> Result<(), MapError> {
        let mut views = vec![];
        for image in list(part.document, "images") {
            let image = match image["uri"].as_str() {
                Some(uri) => {
                    let bytes = opened(uri, read)?;
                    let at = self.keep(&bytes)?;
                    views.push(json!({ "buffer": 0, "byteOffset": at, "byteLength": bytes.len() }));
                    json!({ "bufferView": self.lists[3].len() + views.len() - 1 })
                }
                None => json!({ "bufferView": part.number(&image["bufferView"], 3)? }),
            };
            self.lists[6].push(image);
        }
        self.lists[3].extend(views);
        Ok(())
    }

    /// Puts bytes at the end of the data; gives their place.
    fn keep(&mut self, bytes: &[u8]) -> Result<usize, MapError> {
        let at = self.data.len();
        if at + bytes.len() > MOST_BYTES {
            let error = MapError::new(format!("the tiles together have more than {MOST_BYTES} bytes"));
            return Err(error.hint("give a larger `--error-m`, or an area"));
        }
        self.data.extend(bytes);
        self.data.resize(self.data.len().next_multiple_of(8), 0);
        Ok(at)
    }

    /// The file, with the owners that its parts name and with what is known about where it is from.
    pub fn into_glb(mut self, about: &Value) -> Vec<u8> {
        self.required.insert("KHR_mesh_quantization");
        self.required.extend(self.used.contains(DRACO).then_some(DRACO));
        self.used.insert("EXT_mesh_gpu_instancing");
        self.used.extend(&self.required);
        let mut buffers = vec![json!({ "byteLength": self.data.len() })];
        buffers.extend((self.unpacked > 0).then(|| json!({ "byteLength": self.unpacked })));
        let mut asset = json!({ "version": "2.0", "generator": "cosfly", "extras": about });
        if !self.copyrights.is_empty() {
            asset["copyright"] = Vec::from_iter(std::mem::take(&mut self.copyrights)).join("; ").into();
        }
        let mut document = json!({
            "asset": asset, "scene": 0, "scenes": [{ "nodes": self.roots }],
            "extensionsUsed": self.used, "extensionsRequired": self.required, "buffers": buffers,
        });
        for (name, list) in LISTS.into_iter().zip(std::mem::take(&mut self.lists)).filter(|(_, list)| !list.is_empty())
        {
            document[name] = list.into();
        }
        let mut text = document.to_string();
        text.push_str(&"   "[..text.len().next_multiple_of(4) - text.len()]);
        let number = |of: usize| (of as u32).to_le_bytes();
        let mut file = Vec::with_capacity(28 + text.len() + self.data.len());
        file.extend([MAGIC, &number(2), &number(28 + text.len() + self.data.len())].concat());
        file.extend([&number(text.len())[..], b"JSON", text.as_bytes()].concat());
        file.extend([&number(self.data.len())[..], b"BIN\0"].concat());
        file.append(&mut self.data);
        file
    }
}

/// The things of a list of a file.
fn list<'a>(document: &'a Value, name: &str) -> &'a [Value] {
    document[name].as_array().map_or(&[], Vec::as_slice)
}

/// The place from which the corners of a file count.
fn center_of(document: &Value) -> DVec3 {
    let numbers = document["extensions"]["CESIUM_RTC"]["center"].as_array().map_or(&[][..], Vec::as_slice);
    let number = |k: usize| numbers.get(k).and_then(Value::as_f64).unwrap_or_default();
    DVec3::new(number(0), number(1), number(2))
}

/// Whether a file has shapes, and none of them has triangles.
fn is_of_points(document: &Value) -> bool {
    let mut shapes = list(document, "meshes").iter().flat_map(|mesh| list(mesh, "primitives")).peekable();
    shapes.peek().is_some() && shapes.all(|shape| shape["mode"].as_u64().is_some_and(|mode| mode < FIRST_OF_TRIANGLES))
}

/// Bytes that an address holds or names.
fn opened(uri: &str, read: &mut dyn FnMut(&str) -> Result<Vec<u8>, MapError>) -> Result<Vec<u8>, MapError> {
    if uri.starts_with("data:") {
        return embedded(uri)?.ok_or_else(|| MapError::new("its embedded data are damaged"));
    }
    read(uri)
}

/// Refuses other versions and what is packed.
fn check(document: &Value) -> Result<(), MapError> {
    let version = document["asset"]["version"].as_str().unwrap_or_default();
    if !version.starts_with("2.") {
        let error = MapError::new(format!("it is glTF `{version}`; glTF 2.0 is read"));
        return Err(error.hint("`npx 3d-tiles-tools upgrade -i tileset.json -o upgraded` makes glTF 2.0 of all tiles"));
    }
    check_required(list(document, "extensionsRequired").iter().filter_map(Value::as_str))
}

impl Part<'_> {
    /// The number in the whole file of a thing of a list; none where the file names none.
    fn number(&self, value: &Value, of_list: usize) -> Result<Option<usize>, MapError> {
        if value.is_null() {
            return Ok(None);
        }
        let count = list(self.document, LISTS[of_list]).len();
        let own = value.as_u64().and_then(|own| usize::try_from(own).ok()).filter(|own| *own < count);
        own.map(|own| Some(self.first[of_list] + own))
            .ok_or_else(|| MapError::new(format!("it names number {value} of its {count} `{}`", LISTS[of_list])))
    }

    fn numbers(&self, values: &Value, of_list: usize) -> Result<Vec<usize>, MapError> {
        let values = values.as_array().map_or(&[][..], Vec::as_slice);
        Ok(values
            .iter()
            .map(|it| self.number(it, of_list))
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .flatten()
            .collect())
    }

    /// Numbers of accessors by what they hold.
    fn attributes(&self, of_shape: &Value) -> Result<Map<String, Value>, MapError> {
        let mut attributes = Map::new();
        for (name, accessor) in of_shape.as_object().into_iter().flatten().filter(|(name, _)| !name.starts_with('_')) {
            attributes.insert(name.clone(), self.number(accessor, 2)?.into());
        }
        Ok(attributes)
    }

    fn node(&self, node: &Value) -> Result<Value, MapError> {
        let mut own = kept(node, &OF_NODE);
        put(&mut own, "mesh", self.number(&node["mesh"], 1)?);
        own["children"] = self.numbers(&node["children"], 0)?.into();
        let places = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        if places.is_object() {
            own["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": self.attributes(places)? } });
        }
        if own["children"] == json!([]) {
            own.as_object_mut().and_then(|own| own.remove("children"));
        }
        Ok(own)
    }

    fn mesh(&self, mesh: &Value) -> Result<Value, MapError> {
        let shape = |shape: &Value| {
            let mut own = kept(shape, &["mode"]);
            own["attributes"] = self.attributes(&shape["attributes"])?.into();
            put(&mut own, "indices", self.number(&shape["indices"], 2)?);
            put(&mut own, "material", self.number(&shape["material"], 4)?);
            let packed = &shape["extensions"][DRACO];
            if let Some(view) = self.number(&packed["bufferView"], 3)? {
                own["extensions"] = json!({ DRACO: { "bufferView": view, "attributes": packed["attributes"] } });
            }
            Ok(own)
        };
        let mut own = kept(mesh, &["name"]);
        own["primitives"] = list(mesh, "primitives").iter().map(shape).collect::<Result<Vec<_>, MapError>>()?.into();
        Ok(own)
    }

    fn accessor(&self, accessor: &Value) -> Result<Value, MapError> {
        let mut own = kept(accessor, &OF_ACCESSOR);
        put(&mut own, "bufferView", self.number(&accessor["bufferView"], 3)?);
        if accessor["sparse"].is_object() {
            let mut sparse = accessor["sparse"].clone();
            for side in ["indices", "values"] {
                let view = self.number(&sparse[side]["bufferView"], 3)?;
                sparse[side] = kept(&sparse[side], &["byteOffset", "componentType"]);
                put(&mut sparse[side], "bufferView", view);
            }
            own["sparse"] = sparse;
        }
        Ok(own)
    }

    /// A packed view: its stream is a view of the data, itself the next part of the second buffer.
    fn packed_view(&self, view: &Value, by: &str, unpacked: &mut u64) -> Result<Value, MapError> {
        let stream = &view["extensions"][by];
        let size = stream["count"].as_u64().and_then(|count| count.checked_mul(stream["byteStride"].as_u64()?));
        let end = size.and_then(|size| unpacked.checked_add(size.checked_next_multiple_of(8)?));
        let (Some(size), Some(end)) = (size, end) else {
            return Err(MapError::new("a packed view has no size"));
        };
        let mut own = kept(view, &["byteStride"]);
        own["buffer"] = 1.into();
        own["byteOffset"] = std::mem::replace(unpacked, end).into();
        own["byteLength"] = size.into();
        let mut stream_of_whole = kept(stream, &OF_STREAM);
        let place = self.view(stream)?;
        ["buffer", "byteOffset"].into_iter().for_each(|name| stream_of_whole[name] = place[name].clone());
        own["extensions"] = json!({ by: stream_of_whole });
        Ok(own)
    }

    /// A view of the data, which ends where its own buffer does.
    fn view(&self, view: &Value) -> Result<Value, MapError> {
        let number = |name: &str| view[name].as_u64().and_then(|it| usize::try_from(it).ok());
        let (offset, length) = (number("byteOffset").unwrap_or(0), number("byteLength").unwrap_or(0));
        let buffer = self.buffers.get(number("buffer").unwrap_or(0));
        let inside = buffer.filter(|[_, size]| offset.checked_add(length).is_some_and(|end| end <= *size));
        let Some([start, _]) = inside else {
            return Err(MapError::new("it is cut off: data that it names lie beyond its end"));
        };
        let mut own = kept(view, &["byteStride"]);
        own["buffer"] = 0.into();
        own["byteOffset"] = (start + offset).into();
        own["byteLength"] = length.into();
        Ok(own)
    }

    fn material(&self, material: &Value) -> Result<Value, MapError> {
        let mut own = kept(material, &OF_MATERIAL);
        let colours = &material["pbrMetallicRoughness"];
        let mut kept_colours = kept(colours, &["baseColorFactor", "metallicFactor", "roughnessFactor"]);
        self.texture_use(&mut kept_colours, "baseColorTexture", colours)?;
        let glossy = &material["extensions"][GLOSSINESS];
        if glossy.is_object() {
            let mut colours = kept(glossy, &["diffuseFactor"]);
            self.texture_use(&mut colours, "diffuseTexture", glossy)?;
            own["extensions"] = json!({ GLOSSINESS: colours });
        }
        if !(glossy.is_object() && colours.is_null()) {
            own["pbrMetallicRoughness"] = kept_colours;
        }
        self.texture_use(&mut own, "emissiveTexture", material)?;
        Ok(own)
    }

    /// Carries over a texture of a material.
    fn texture_use(&self, to: &mut Value, name: &str, from: &Value) -> Result<(), MapError> {
        let texture = &from[name];
        let Some(index) = self.number(&texture["index"], 5)? else { return Ok(()) };
        to[name] = kept(texture, &["texCoord"]);
        to[name]["index"] = index.into();
        let transform = &texture["extensions"][TRANSFORM];
        if transform.is_object() {
            to[name]["extensions"] = json!({ TRANSFORM: transform });
        }
        Ok(())
    }

    /// Nodes that its scene begins with.
    fn roots(&self) -> Result<Vec<usize>, MapError> {
        let scene = self.document["scene"].as_u64().unwrap_or(0);
        if let Some(scene) = list(self.document, "scenes").get(usize::try_from(scene).unwrap_or(usize::MAX)) {
            return self.numbers(&scene["nodes"], 0);
        }
        let nodes = list(self.document, "nodes");
        let mut is_below = vec![false; nodes.len()];
        for child in nodes.iter().flat_map(|node| list(node, "children")).filter_map(Value::as_u64) {
            is_below.get_mut(child as usize).into_iter().for_each(|is_below| *is_below = true);
        }
        Ok((0..nodes.len()).filter(|at| !is_below[*at]).map(|at| self.first[0] + at).collect())
    }
}

/// Some keys of a table.
fn kept(of: &Value, keys: &[&str]) -> Value {
    let own = keys.iter().filter_map(|key| Some(((*key).to_owned(), of.get(*key)?.clone())));
    Value::Object(own.collect())
}

fn put(own: &mut Value, key: &str, number: Option<usize>) {
    if let Some(number) = number {
        own[key] = number.into();
    }
}
