//! [`Graph`]: nodes whose inputs and outputs are numbers of slots.

use crate::attributes::Attribute;
use crate::file::{File, NodeProto};
use crate::operators::{OPERATORS, Operator};
use crate::tensor::Tensor;
use std::collections::{BTreeMap, BTreeSet};

/// Versions of ONNX's operators that are read.
const OPSETS: std::ops::RangeInclusive<i64> = 13..=24;

/// A node.
#[derive(Debug)]
pub struct Node {
    /// Its name, or its output's, with its operator: for errors.
    pub place: String,
    /// Its operator.
    pub operator: &'static Operator,
    /// Slots of its inputs.
    pub inputs: Vec<Option<usize>>,
    /// Slots of its outputs.
    pub outputs: Vec<Option<usize>>,
    /// Settings.
    pub attributes: BTreeMap<String, Attribute>,
    /// Slots that no later node reads.
    pub over: Vec<usize>,
}

/// Nodes in their order, with slots for all tensors.
#[derive(Debug)]
pub struct Graph {
    /// Nodes.
    pub nodes: Vec<Node>,
    /// Tensors of the file, by slot; none in slots that a run fills.
    pub constants: Vec<Option<Tensor>>,
    /// Slots of inputs.
    pub inputs: Vec<usize>,
    /// Slots of outputs.
    pub outputs: Vec<usize>,
}

/// Slots by the names of their tensors.
struct Slots {
    by_name: BTreeMap<String, usize>,
    constants: Vec<Option<Tensor>>,
}

impl Slots {
    fn add(&mut self, name: &str, constant: Option<Tensor>) -> Result<usize, String> {
        if self.by_name.insert(name.to_owned(), self.constants.len()).is_some() {
            return Err(format!("the name `{name}` stands for two tensors"));
        }
        self.constants.push(constant);
        Ok(self.constants.len() - 1)
    }
}

impl Graph {
    /// The graph of a file. Inputs that have constants are constants, and are taken from the file's list of inputs.
    pub fn of(file: &mut File) -> Result<Self, String> {
        if !OPSETS.contains(&file.opset) {
            let (first, last) = (OPSETS.start(), OPSETS.end());
            return Err(format!("its operators are those of opset {}; {first} to {last} are read", file.opset));
        }
        let mut slots = Slots { by_name: BTreeMap::new(), constants: vec![] };
        for (name, tensor) in std::mem::take(&mut file.constants) {
            slots.add(&name, Some(tensor))?;
        }
        file.inputs.retain(|input| !slots.by_name.contains_key(&input.name));
        let inputs = file.inputs.iter().map(|input| slots.add(&input.name, None)).collect::<Result<Vec<usize>, _>>()?;
        let nodes = std::mem::take(&mut file.nodes);
        let mut nodes = nodes.into_iter().map(|node| of_node(node, &mut slots)).collect::<Result<Vec<Node>, _>>()?;
        let mut names = BTreeSet::new();
        if !file.outputs.iter().all(|output| names.insert(&output.name)) {
            return Err("two of its outputs have one name".to_owned());
        }
        let outputs = file.outputs.iter().map(|output| slots.by_name.get(&output.name).copied().ok_or(&output.name));
        let outputs =
            outputs.collect::<Result<Vec<usize>, _>>().map_err(|name| format!("no node makes the output `{name}`"))?;
        let mut is_read: Vec<bool> = (0..slots.constants.len()).map(|slot| outputs.contains(&slot)).collect();
        for node in nodes.iter_mut().rev() {
            for slot in node.inputs.iter().chain(&node.outputs).flatten() {
                if !std::mem::replace(&mut is_read[*slot], true) && slots.constants[*slot].is_none() {
                    node.over.push(*slot);
                }
            }
        }
        Ok(Self { nodes, constants: slots.constants, inputs, outputs })
    }
}

fn of_node(node: NodeProto, slots: &mut Slots) -> Result<Node, String> {
    let NodeProto { name, operator, inputs, outputs, attributes } = node;
    let name = if name.is_empty() { outputs.first().cloned().unwrap_or_default() } else { name };
    let place = format!("`{name}` ({operator})");
    let Some(operator) = OPERATORS.iter().find(|it| it.name == operator) else {
        let known: Vec<&str> = OPERATORS.iter().map(|it| it.name).collect();
        return Err(format!("the node {place} has an operator that is not read; allowed are {}", known.join(", ")));
    };
    if let Some(unknown) = attributes.keys().find(|name| !operator.attributes.contains(&name.as_str())) {
        let known = operator.attributes.join(", ");
        return Err(format!("the node {place} has the setting `{unknown}`, which is not read; allowed are: {known}"));
    }
    let slot = |name: &String| match name.is_empty() {
        true => Ok(None),
        false => {
            let slot = slots.by_name.get(name).copied();
            slot.map(Some).ok_or_else(|| format!("the node {place} takes `{name}`, which nothing before it makes"))
        }
    };
    let inputs = inputs.iter().map(slot).collect::<Result<Vec<_>, _>>()?;
    let outputs = outputs.iter().map(|name| if name.is_empty() { Ok(None) } else { slots.add(name, None).map(Some) });
    let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
    Ok(Node { place, operator, inputs, outputs, attributes, over: vec![] })
}
