//! `glTF`: meshes of glTF 2.0, as text with embedded data (`.gltf`) or binary (`.glb`), by the names of nodes.

mod accessors;
pub mod document;
mod draco;
pub mod materials;
mod meshopt;
mod streams;
mod views;

use crate::mesh::{MeshOptions, PartBuilder, town_of};
use crate::way_out::or_advice;
use cosfly_domain::Town;
use cosfly_frames::DVec3;
use cosfly_town::{MapError, MapFormat};
use document::{Document, Primitive};
use glam::DMat4;

/// Deepest nesting of nodes.
const DEEPEST: usize = 200;
/// Most nodes that are visited.
const MOST_NODES: usize = 1_000_000;

/// The way out of a damaged file.
const WAY_OUT: &str = "the file seems to be damaged: export the scene again as GLB";

/// The format `glTF`.
#[derive(Clone, Copy, Debug)]
pub struct GlTf;

impl MapFormat for GlTf {
    type Options = MeshOptions;

    const NAME: &'static str = "glTF";

    const EXAMPLE: &'static [u8] = include_bytes!("mesh/example.glb");

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
        or_advice(town(bytes, options), WAY_OUT)
    }
}

fn town(bytes: &[u8], options: &MeshOptions) -> Result<(Town, Vec<String>), MapError> {
    let document = Document::read(bytes)?;
    let mut reader = Reader {
        options,
        document: &document,
        parts: PartBuilder::of_file(bytes.len()),
        skipped: 0,
        node: None,
        nodes: 0,
    };
    for_each_shape(&document, &mut |name, matrix, shape| reader.add(name, matrix, shape))?;
    let mut warnings = [reader.parts.warnings(), document.remarks()].concat();
    if reader.skipped > 0 {
        warnings.push(format!(
            "{} meshes were left out: points or lines, compressed data, or data beyond the end of the file",
            reader.skipped
        ));
    }
    town_of(reader.parts.parts, options, warnings)
}

struct Reader<'a> {
    options: &'a MeshOptions,
    document: &'a Document,
    parts: PartBuilder,
    skipped: usize,
    /// Name and place of the node whose shapes come now.
    node: Option<(String, DMat4)>,
    /// Number of nodes and of places of repeated ones so far.
    nodes: u32,
}

impl Reader<'_> {
    fn add(&mut self, name: &str, matrix: &DMat4, primitive: &Primitive) -> Result<(), MapError> {
        self.parts.count(self.document.elements_of_shape(primitive))?;
        match triangles(self.document, primitive) {
            Some((positions, triangles)) => {
                let node = (name.to_owned(), *matrix);
                if self.node.as_ref() != Some(&node) {
                    self.node = Some(node);
                    self.nodes += 1;
                }
                let in_map = |point| self.options.in_map(matrix.transform_point3(point));
                self.parts.add(name, self.nodes, positions.into_iter().map(in_map).collect(), triangles.into_iter());
            }
            None => self.skipped += 1,
        }
        Ok(())
    }
}

/// Visits the shapes of a file with their names and the way from their frames to the scene's. A node without a name has
/// that of its mesh or of the node above.
///
/// # Errors
/// Nodes that form no tree, or the visitor's.
pub fn for_each_shape(
    document: &Document,
    visit: &mut dyn FnMut(&str, &DMat4, &Primitive) -> Result<(), MapError>,
) -> Result<(), MapError> {
    let mut nodes = 0;
    document
        .roots()
        .into_iter()
        .try_for_each(|node| shapes_below(document, &mut nodes, (node, 0), DMat4::IDENTITY, "", visit))
}

fn shapes_below(
    document: &Document,
    nodes: &mut usize,
    (index, depth): (usize, usize),
    above: DMat4,
    name_above: &str,
    visit: &mut dyn FnMut(&str, &DMat4, &Primitive) -> Result<(), MapError>,
) -> Result<(), MapError> {
    *nodes += 1;
    if depth > DEEPEST || *nodes > MOST_NODES {
        let message = format!("node {index} is nested deeper than {DEEPEST}, or there are more than {MOST_NODES}");
        return Err(MapError::new(message).hint("nodes must form a tree"));
    }
    let node = document.node(index)?;
    let matrix = above * node.matrix();
    let mesh = node.mesh.and_then(|mesh| document.mesh(mesh));
    let names = [node.name.as_deref(), mesh.and_then(|mesh| mesh.name.as_deref())];
    let name = names.into_iter().flatten().find(|name| !name.is_empty()).unwrap_or(name_above);
    if let Some(mesh) = mesh {
        for place in document.places(node)? {
            let matrix = matrix * place;
            mesh.primitives.iter().try_for_each(|shape| visit(name, &matrix, shape))?;
        }
    }
    let mut below = node.children.iter();
    below.try_for_each(|child| shapes_below(document, nodes, (*child, depth + 1), matrix, name, visit))
}

/// Corners and triangles of a shape, where its data are plain and there.
pub fn triangles(document: &Document, shape: &Primitive) -> Option<(Vec<DVec3>, Vec<[u32; 3]>)> {
    in_threes(shape.mode, &[0; 3])?;
    let positions = document.positions(*shape.attributes.get("POSITION")?)?;
    let corners = match shape.indices {
        Some(accessor) => document.indices(accessor)?,
        None => (0..u32::try_from(positions.len()).ok()?).collect(),
    };
    Some((positions, in_threes(shape.mode, &corners)?))
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
