//! `glTF`: meshes of glTF 2.0, as text with embedded data (`.gltf`) or binary (`.glb`), by the names of nodes.

pub mod document;

use crate::mesh::{MeshOptions, PartBuilder, town_of};
use cosfly_frames::DVec3;
use cosfly_town::{MapError, MapFormat, Town};
use document::{Document, Primitive};
use glam::DMat4;

/// Deepest nesting of nodes.
const DEEPEST: usize = 200;
/// Most nodes that are visited.
const MOST_NODES: usize = 1_000_000;

/// The format `glTF`.
#[derive(Clone, Copy, Debug)]
pub struct GlTf;

impl MapFormat for GlTf {
    type Options = MeshOptions;

    const NAME: &'static str = "glTF";

    const EXAMPLE: &'static [u8] = include_bytes!("../mesh/example.glb");

    fn recognises(head: &[u8]) -> bool {
        let text = String::from_utf8_lossy(head);
        let is_json = text.trim_start_matches('\u{feff}').trim_start().starts_with('{');
        // Keys of glTF may come in any order: some of its own must be near.
        let has = |keys: &[&str]| keys.iter().any(|key| text.contains(key));
        head.starts_with(document::MAGIC)
            || is_json
                && has(&["\"bufferViews\"", "\"accessors\"", "\"meshes\"", "\"scenes\""])
                && has(&["\"asset\"", "\"nodes\""])
    }

    fn read(bytes: &[u8], options: &MeshOptions) -> Result<(Town, Vec<String>), MapError> {
        let document = Document::read(bytes)?;
        let mut reader = Reader { options, document: &document, parts: PartBuilder::default(), nodes: 0, skipped: 0 };
        for node in document.roots() {
            reader.add(node, DMat4::IDENTITY, "", 0)?;
        }
        let mut warnings = reader.parts.warnings();
        if reader.skipped > 0 {
            warnings.push(format!(
                "{} meshes were left out: points or lines, compressed or sparse data, or data beyond the end of the file",
                reader.skipped
            ));
        }
        town_of(reader.parts.parts, options, warnings)
    }
}

struct Reader<'a> {
    options: &'a MeshOptions,
    document: &'a Document,
    parts: PartBuilder,
    nodes: usize,
    skipped: usize,
}

impl Reader<'_> {
    /// Adds the meshes of a node and of those below it. A node without a name has that of its mesh or of the one above.
    fn add(&mut self, index: usize, parent: DMat4, name_above: &str, depth: usize) -> Result<(), MapError> {
        self.nodes += 1;
        if depth > DEEPEST || self.nodes > MOST_NODES {
            let message = format!("node {index} is nested deeper than {DEEPEST}, or there are more than {MOST_NODES}");
            return Err(MapError::new(message).hint("nodes must form a tree"));
        }
        let node = self.document.node(index)?;
        let matrix = parent * node.matrix();
        let mesh = node.mesh.and_then(|mesh| self.document.mesh(mesh));
        let names = [node.name.as_deref(), mesh.and_then(|mesh| mesh.name.as_deref())];
        let name = names.into_iter().flatten().find(|name| !name.is_empty()).unwrap_or(name_above);
        for primitive in mesh.iter().flat_map(|mesh| &mesh.primitives) {
            match self.triangles(primitive) {
                Some((positions, triangles)) => {
                    let in_map = |point| self.options.in_map(matrix.transform_point3(point));
                    self.parts.add(name, positions.into_iter().map(in_map).collect(), triangles.into_iter())?;
                }
                None => self.skipped += 1,
            }
        }
        node.children.iter().try_for_each(|child| self.add(*child, matrix, name, depth + 1))
    }

    /// Corners and triangles, where their data are plain and there.
    fn triangles(&self, primitive: &Primitive) -> Option<(Vec<DVec3>, Vec<[u32; 3]>)> {
        let positions = self.document.positions(*primitive.attributes.get("POSITION")?)?;
        let corners = match primitive.indices {
            Some(accessor) => self.document.indices(accessor)?,
            None => (0..u32::try_from(positions.len()).ok()?).collect(),
        };
        Some((positions, in_threes(primitive.mode, &corners)?))
    }
}

/// Triangles of a list, strip or fan of corners; none for points and lines.
fn in_threes(mode: Option<u32>, corners: &[u32]) -> Option<Vec<[u32; 3]>> {
    Some(match mode.unwrap_or(4) {
        4 => corners.chunks_exact(3).map(|corner| [corner[0], corner[1], corner[2]]).collect(),
        5 => corners.windows(3).map(|corner| [corner[0], corner[1], corner[2]]).collect(),
        6 => corners.get(1..)?.windows(2).map(|pair| [corners[0], pair[0], pair[1]]).collect(),
        _ => return None,
    })
}
