//! Names of items, read back from plan documents for a task that runs apart from its recipe.
//!
//! Documents hold names as text. How a name came about is seen from the items that a task reads: an item keeps the name
//! of one of them, or is a variant of it, or begins in its own stage.

use crate::document::StoredInput;
use cosfly_fingerprint::Digest;
use cosfly_stage::{ItemName, StageName};
use cosfly_store::Store;
use serde_json::Value;
use std::collections::BTreeMap;

/// Reads names of items; the name of each task is found out once.
pub(crate) struct NameReader<'s> {
    store: &'s Store,
    known: BTreeMap<Digest, ItemName>,
}

impl<'s> NameReader<'s> {
    pub(crate) fn new(store: &'s Store) -> Self {
        Self { store, known: BTreeMap::new() }
    }

    /// Name of the item of a task; `None` where a document behind it is missing or damaged.
    pub(crate) fn of_task(&mut self, plan: &Digest) -> Option<ItemName> {
        let mut waiting = vec![*plan];
        while let Some(task) = waiting.last().copied() {
            if self.known.contains_key(&task) {
                waiting.pop();
                continue;
            }
            let (text, inputs) = self.document(&task)?;
            let unknown: Vec<Digest> =
                inputs.iter().map(|input| input.plan).filter(|plan| !self.known.contains_key(plan)).collect();
            if unknown.is_empty() {
                let names: Option<Vec<ItemName>> = inputs.iter().map(|input| self.at_port(input)).collect();
                self.known.insert(task, named_like(&text, &names?));
            }
            waiting.extend(unknown);
        }
        self.known.get(plan).cloned()
    }

    /// Name of an item at the port where `input` arrives.
    pub(crate) fn at_port(&mut self, input: &StoredInput) -> Option<ItemName> {
        let own = self.of_task(&input.plan)?;
        Some(if input.name == input.item { own } else { own.of_stage(&StageName::read(&input.stage)) })
    }

    /// Text of the item's name, and the inputs that it does not gather: one at each port.
    fn document(&self, plan: &Digest) -> Option<(String, Vec<StoredInput>)> {
        let mut document = self.store.document(plan)?;
        let mut inputs = Vec::new();
        for list in document["inputs"].as_object_mut()?.values_mut().filter(|list| list.is_array()) {
            inputs.extend(serde_json::from_value::<Vec<StoredInput>>(list.take()).ok()?);
        }
        match document["item"].take() {
            Value::String(text) => Some((text, inputs)),
            _ => None,
        }
    }
}

/// The name with the text `text` of an item that reads items called `inputs`.
fn named_like(text: &str, inputs: &[ItemName]) -> ItemName {
    if let Some(same) = inputs.iter().find(|name| name.to_string() == text) {
        return same.clone();
    }
    let variant = inputs.iter().find_map(|name| {
        let variant = text.strip_prefix(&format!("{name}-"))?;
        Some(name.with_variant(variant))
    });
    variant.unwrap_or_else(|| ItemName::own(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_that_of_an_input_or_a_variant_of_it_or_its_own() {
        let town = ItemName::only();
        let expert = ItemName::numbered("p", 3).of_stage(&StageName::new("expert", ""));
        let inputs = [town, expert.clone()];
        assert_eq!(named_like("expert-p00003", &inputs), expert);
        assert_eq!(named_like("expert-p00003-WetNoon", &inputs), expert.with_variant("WetNoon"));
        assert_eq!(named_like("p00003", &inputs), ItemName::numbered("p", 3));
    }
}
