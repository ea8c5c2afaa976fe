//! Towns as GLB files: a node for each thing, with pictures of its faces.

use crate::atlas::Atlas;
use crate::bake::BakedTown;
use crate::patch::Patch;
use crate::words::name;
use cosfly_frames::DVec3;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Numbers of glTF: 32-bit reals and corners, lists of triangles.
const REAL: u32 = 5126;
const CORNER: u32 = 5125;

impl BakedTown {
    /// The town as a GLB file in the frame of its map, y up. Things have names that readers of meshes know.
    ///
    /// # Errors
    /// Pictures that cannot be encoded.
    pub fn to_glb(&self, source: &str) -> Result<Vec<u8>, png::EncodingError> {
        let atlas = Atlas::new(&self.patches);
        let mut things: BTreeMap<(u8, u32), BTreeMap<usize, Vec<usize>>> = BTreeMap::new();
        for (at, patch) in self.patches.iter().enumerate() {
            let pages = things.entry((patch.label, patch.instance)).or_default();
            pages.entry(atlas.places[at].0).or_default().push(at);
        }
        let mut file = File::default();
        let (mut nodes, mut meshes) = (vec![], vec![]);
        for ((label, instance), pages) in &things {
            let shape = |(page, members): (&usize, &Vec<usize>)| self.shape(&mut file, &atlas, *page, members);
            let shapes: Vec<Value> = pages.iter().map(shape).collect();
            nodes.push(json!({ "name": name(*label, *instance), "mesh": meshes.len() }));
            meshes.push(json!({ "primitives": shapes }));
        }
        let pages = atlas.pages(&self.patches)?;
        let images: Vec<Value> =
            pages.iter().map(|page| json!({ "bufferView": file.view(page), "mimeType": "image/png" })).collect();
        let numbers = 0..images.len();
        let textures: Vec<Value> = numbers.clone().map(|page| json!({ "source": page })).collect();
        let material = |page| {
            let colours = json!({ "baseColorTexture": { "index": page }, "metallicFactor": 0.0 });
            let unlit = json!({ "KHR_materials_unlit": {} });
            json!({ "pbrMetallicRoughness": colours, "doubleSided": true, "extensions": unlit })
        };
        let materials: Vec<Value> = numbers.map(material).collect();
        let document = json!({
            "asset": { "version": "2.0", "generator": "cosfly", "extras": { "source": source } },
            "extensionsUsed": ["KHR_materials_unlit"],
            "scene": 0, "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }], "nodes": nodes, "meshes": meshes,
            "materials": materials, "textures": textures, "images": images, "accessors": file.accessors,
            "bufferViews": file.views, "buffers": [{ "byteLength": file.data.len() }],
        });
        Ok(chunks(&document.to_string(), file.data))
    }

    /// The triangles of some patches with pictures on one page.
    fn shape(&self, file: &mut File, atlas: &Atlas, page: usize, members: &[usize]) -> Value {
        let size = atlas.size(page).map(|side| side as f64);
        let (mut points, mut places, mut corners) = (vec![], vec![], vec![]);
        for at in members {
            let (patch, left_top): (&Patch, _) = (&self.patches[*at], atlas.places[*at].1);
            let first = points.len() as u32;
            corners.extend((2..patch.corners_in_world.len() as u32).flat_map(|k| [first, first + k - 1, first + k]));
            for corner in &patch.corners_in_world {
                let DVec3 { x, y, z } = *corner + self.origin_m;
                points.push([x as f32, z as f32, y as f32]);
                let own = patch.in_picture(*corner);
                places.push([0, 1].map(|k| ((left_top[k] as f64 + own[k]) / size[k]) as f32));
            }
        }
        let end = |from: f32, pick: fn(f32, f32) -> f32| {
            [0, 1, 2].map(|k| points.iter().fold(from, |end, point| pick(end, point[k])))
        };
        let ends = json!({ "min": end(f32::INFINITY, f32::min), "max": end(f32::NEG_INFINITY, f32::max) });
        let bytes = |numbers: &[f32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
        let position = file.accessor(&bytes(points.as_flattened()), (REAL, "VEC3", points.len()), ends);
        let texture = file.accessor(&bytes(places.as_flattened()), (REAL, "VEC2", places.len()), json!({}));
        let of_corners: Vec<u8> = corners.iter().flat_map(|corner| corner.to_le_bytes()).collect();
        let indices = file.accessor(&of_corners, (CORNER, "SCALAR", corners.len()), json!({}));
        json!({
            "attributes": { "POSITION": position, "TEXCOORD_0": texture }, "indices": indices, "material": page,
        })
    }
}

/// Data of a file, and what is said of them.
#[derive(Default)]
struct File {
    data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl File {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.data.len(), "byteLength": bytes.len() }));
        self.data.extend(bytes);
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], (component, kind, count): (u32, &str, usize), mut more: Value) -> usize {
        more["bufferView"] = self.view(bytes).into();
        more["componentType"] = component.into();
        more["type"] = kind.into();
        more["count"] = count.into();
        self.accessors.push(more);
        self.accessors.len() - 1
    }
}

/// The two chunks of a binary file.
fn chunks(text: &str, data: Vec<u8>) -> Vec<u8> {
    let text = format!("{text}{}", &"   "[..text.len().next_multiple_of(4) - text.len()]);
    let mut bytes = b"glTF\x02\x00\x00\x00".to_vec();
    let length = |of: usize| (of as u32).to_le_bytes();
    bytes.extend(length(12 + 8 + text.len() + 8 + data.len()));
    bytes.extend(length(text.len()));
    bytes.extend(b"JSON");
    bytes.extend(text.as_bytes());
    bytes.extend(length(data.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(data);
    bytes
}
