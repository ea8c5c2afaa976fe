//! [`OnnxModel`]: a network that was read and checked.

use crate::call::{Call, Work};
use crate::file::{self, Port};
use crate::graph::Graph;
use crate::tensor::{Kind, Tensor};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Most numbers that a run holds at a time, where whole numbers count twice: they take twice the memory.
const MOST_HELD: usize = 1 << 23;

/// A network that was read and checked.
#[derive(Debug)]
pub struct OnnxModel {
    metadata: BTreeMap<String, String>,
    inputs: Vec<Port>,
    outputs: Vec<Port>,
    graph: Graph,
}

impl OnnxModel {
    /// Reads a file.
    ///
    /// # Errors
    /// The fault and its place, in words.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let mut file = file::read(bytes)?;
        let graph = Graph::of(&mut file)?;
        let numbers: usize = file.inputs.iter().map(held_by).sum();
        if numbers > MOST_HELD {
            return Err(format!("its inputs have {numbers} numbers; {MOST_HELD} are allowed"));
        }
        Ok(Self { metadata: file.metadata, inputs: file.inputs, outputs: file.outputs, graph })
    }

    /// Text of the file's metadata (`metadata_props`).
    pub fn metadata(&self, key: &str) -> Option<&str> {
        self.metadata.get(key).map(String::as_str)
    }

    /// Inputs, in their order.
    pub fn inputs(&self) -> &[Port] {
        &self.inputs
    }

    /// Outputs, in their order; kinds and shapes are as stated.
    pub fn outputs(&self) -> &[Port] {
        &self.outputs
    }

    /// Runs the network on tensors for its inputs, in their order, and gives its outputs.
    ///
    /// # Errors
    /// The node at which shapes or kinds do not fit, or the bound that is reached, in words.
    pub fn run(&self, inputs: Vec<Tensor>) -> Result<Vec<Tensor>, String> {
        for (tensor, port) in inputs.iter().zip(&self.inputs) {
            if tensor.shape != port.shape || tensor.values.kind() != port.kind {
                return Err(format!(
                    "the input `{}` gets the shape {:?}; it is {:?}",
                    port.name, tensor.shape, port.shape
                ));
            }
        }
        if inputs.len() != self.inputs.len() {
            return Err(format!("it has {} inputs and gets {}", self.inputs.len(), inputs.len()));
        }
        let graph = &self.graph;
        let mut slots: Vec<Option<Cow<'_, Tensor>>> =
            graph.constants.iter().map(|it| it.as_ref().map(Cow::Borrowed)).collect();
        let mut held: usize = inputs.iter().map(|input| input.values.held()).sum();
        for (slot, input) in graph.inputs.iter().zip(inputs) {
            slots[*slot] = Some(Cow::Owned(input));
        }
        let work = Work::new();
        for node in &graph.nodes {
            let at = |what: String| format!("the node {}: {what}", node.place);
            let made = {
                let inputs: Vec<Option<&Tensor>> =
                    node.inputs.iter().map(|slot| slot.and_then(|slot| slots[slot].as_deref())).collect();
                let (attributes, outputs) = (&node.attributes, node.outputs.len());
                let call = Call { inputs: &inputs, attributes, outputs, work: &work };
                (node.operator.run)(&call).map_err(at)?
            };
            if let Some(missing) = node.outputs.get(made.len()..).filter(|rest| rest.iter().any(Option::is_some)) {
                return Err(at(format!("its last {} outputs are not made", missing.len())));
            }
            for (slot, tensor) in node.outputs.iter().zip(made) {
                if let Some(slot) = slot {
                    held += tensor.values.held();
                    slots[*slot] = Some(Cow::Owned(tensor));
                }
            }
            if held > MOST_HELD {
                return Err(at(format!("{held} numbers are held at a time; {MOST_HELD} are allowed")));
            }
            for slot in &node.over {
                held -= slots[*slot].take().map_or(0, |tensor| tensor.values.held());
            }
        }
        let output = |slot: &usize| slots[*slot].take().map(Cow::into_owned);
        let outputs = graph.outputs.iter().map(output).collect::<Option<Vec<_>>>();
        outputs.ok_or_else(|| "an output is not made".to_owned())
    }
}

/// Numbers that an input holds, where whole numbers count twice.
fn held_by(port: &Port) -> usize {
    port.shape.iter().product::<usize>() * if port.kind == Kind::Whole { 2 } else { 1 }
}
