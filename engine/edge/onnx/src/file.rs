//! The messages of ONNX: what of a file is read.

use crate::attributes::{self, Attribute};
use crate::numbers::tensor;
use crate::tensor::{Kind, MOST_AXES, MOST_NUMBERS, Tensor, count};
use crate::wire::{fields, push};
use std::collections::BTreeMap;

/// Largest file, bytes.
pub const MOST_BYTES: usize = 1 << 26;
/// Most nodes, constants, inputs, outputs, entries of metadata.
const MOST_PARTS: usize = 1 << 12;
/// Most inputs, outputs and settings of a node.
const MOST_OF_NODE: usize = 64;

/// An input or output of a network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Name.
    pub name: String,
    /// Kind of its numbers.
    pub kind: Kind,
    /// Sizes of its axes; sizes that the file leaves open, such as that of a batch, are 1.
    pub shape: Vec<usize>,
}

/// A node as it stands in a file.
#[derive(Debug)]
pub struct NodeProto {
    /// Name; may be empty.
    pub name: String,
    /// Name of the operator.
    pub operator: String,
    /// Names of inputs; empty where one is left out.
    pub inputs: Vec<String>,
    /// Names of outputs; empty where one is left out.
    pub outputs: Vec<String>,
    /// Settings.
    pub attributes: BTreeMap<String, Attribute>,
}

/// A file.
#[derive(Debug, Default)]
pub struct File {
    /// Version of the operators.
    pub opset: i64,
    /// Entries of `metadata_props`.
    pub metadata: BTreeMap<String, String>,
    /// Nodes.
    pub nodes: Vec<NodeProto>,
    /// Constants by their names.
    pub constants: Vec<(String, Tensor)>,
    /// Inputs.
    pub inputs: Vec<Port>,
    /// Outputs: names, kinds and shapes as stated.
    pub outputs: Vec<Port>,
}

/// Reads a message `ModelProto`.
pub fn read(bytes: &[u8]) -> Result<File, String> {
    if bytes.len() > MOST_BYTES {
        return Err(format!("it has {} bytes; it may have {MOST_BYTES}", bytes.len()));
    }
    let (mut file, mut graph) = (File::default(), None);
    let mut opsets = vec![];
    for field in fields(bytes) {
        match field? {
            (7, field) => graph = Some(field.bytes()?),
            (8, field) => push(&mut opsets, opset(field.bytes()?)?, MOST_OF_NODE)?,
            (14, field) => {
                let (key, value) = entry(field.bytes()?)?;
                if file.metadata.len() >= MOST_PARTS || file.metadata.insert(key.clone(), value).is_some() {
                    return Err(format!("its metadata has `{key}` twice, or more than {MOST_PARTS} entries"));
                }
            }
            (25, _) => {
                return Err("it has functions of its own, which are not read: export it with them inlined".to_owned());
            }
            _ => {}
        }
    }
    let standard = opsets.iter().find(|(domain, _)| is_standard(domain));
    file.opset = standard.map(|it| it.1).ok_or("it names no version of ONNX's operators: it is no ONNX file")?;
    read_graph(graph.ok_or("it has no graph")?, &mut file)?;
    Ok(file)
}

fn is_standard(domain: &str) -> bool {
    matches!(domain, "" | "ai.onnx")
}

fn opset(bytes: &[u8]) -> Result<(String, i64), String> {
    let mut opset = (String::new(), 1);
    for field in fields(bytes) {
        match field? {
            (1, field) => opset.0 = field.text()?.to_owned(),
            (2, field) => opset.1 = field.whole()?,
            _ => {}
        }
    }
    Ok(opset)
}

/// A message `StringStringEntryProto`.
fn entry(bytes: &[u8]) -> Result<(String, String), String> {
    let mut entry = (String::new(), String::new());
    for field in fields(bytes) {
        match field? {
            (1, field) => entry.0 = field.text()?.to_owned(),
            (2, field) => entry.1 = field.text()?.to_owned(),
            _ => {}
        }
    }
    Ok(entry)
}

fn read_graph(bytes: &[u8], file: &mut File) -> Result<(), String> {
    for field in fields(bytes) {
        match field? {
            (1, field) => push(&mut file.nodes, node(field.bytes()?)?, MOST_PARTS)?,
            (5, field) => {
                let read = tensor(field.bytes()?);
                push(&mut file.constants, read.map_err(|what| format!("a constant: {what}"))?, MOST_PARTS)?;
            }
            (11, field) => push(&mut file.inputs, port(field.bytes()?)?, MOST_PARTS)?,
            (12, field) => push(&mut file.outputs, port(field.bytes()?)?, MOST_PARTS)?,
            (15, _) => return Err("it has sparse constants, which are not read".to_owned()),
            _ => {}
        }
    }
    Ok(())
}

fn node(bytes: &[u8]) -> Result<NodeProto, String> {
    let (mut name, mut operator) = (String::new(), String::new());
    let (mut inputs, mut outputs, mut domain) = (vec![], vec![], String::new());
    let mut settings = vec![];
    for field in fields(bytes) {
        match field? {
            (1, field) => push(&mut inputs, field.text()?.to_owned(), MOST_OF_NODE)?,
            (2, field) => push(&mut outputs, field.text()?.to_owned(), MOST_OF_NODE)?,
            (3, field) => name = field.text()?.to_owned(),
            (4, field) => operator = field.text()?.to_owned(),
            (5, field) => push(&mut settings, field.bytes()?, MOST_OF_NODE)?,
            (7, field) => domain = field.text()?.to_owned(),
            _ => {}
        }
    }
    if !is_standard(&domain) {
        return Err(format!(
            "the node `{name}` has the operator `{operator}` of `{domain}`; those of ONNX itself are read"
        ));
    }
    let read = |bytes: &[u8]| attributes::read(bytes).map_err(|what| format!("the node `{name}` ({operator}): {what}"));
    let attributes = settings.into_iter().map(read).collect::<Result<_, _>>()?;
    Ok(NodeProto { name, operator, inputs, outputs, attributes })
}

/// A message `ValueInfoProto`.
fn port(bytes: &[u8]) -> Result<Port, String> {
    let (mut name, mut of_tensor) = (String::new(), None);
    for field in fields(bytes) {
        match field? {
            (1, field) => name = field.text()?.to_owned(),
            // Its type, which is that of a tensor.
            (2, field) => {
                for field in fields(field.bytes()?) {
                    if let (1, field) = field? {
                        of_tensor = Some(field.bytes()?);
                    }
                }
            }
            _ => {}
        }
    }
    let of_tensor = of_tensor.ok_or_else(|| format!("`{name}` is no tensor"))?;
    let (mut element, mut shape) = (0, vec![]);
    for field in fields(of_tensor) {
        match field? {
            (1, field) => element = field.whole()?,
            (2, field) => {
                for field in fields(field.bytes()?) {
                    if let (1, field) = field? {
                        push(&mut shape, axis(field.bytes()?)?, MOST_AXES).map_err(|_| too_many_axes(&name))?;
                    }
                }
            }
            _ => {}
        }
    }
    let kind = Kind::of(element).map_err(|what| format!("`{name}`: {what}"))?;
    match count(&shape) {
        Some(_) => Ok(Port { name, kind, shape }),
        None => Err(format!("`{name}` has the shape {shape:?}; a tensor may have {MOST_NUMBERS} numbers")),
    }
}

fn too_many_axes(name: &str) -> String {
    format!("`{name}` has more than {MOST_AXES} axes")
}

/// Size of an axis; 1 where it is left open.
fn axis(bytes: &[u8]) -> Result<usize, String> {
    let mut size = 1;
    for field in fields(bytes) {
        if let (1, field) = field? {
            size = field.whole()?;
        }
    }
    let fits = usize::try_from(size).ok().filter(|size| (1..=MOST_NUMBERS).contains(size));
    fits.ok_or_else(|| format!("an axis has the size {size}; it must be 1 to {MOST_NUMBERS}"))
}
