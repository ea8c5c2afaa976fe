//! Plan documents: canonical JSON whose digest is the key of a task before it runs, and the action key afterwards.
//!
//! A *definition* (`cosfly.stage/1`) is what all items of a stage share. A *plan* (`cosfly.plan/1`) names the
//! definition, the item and, by their plan digests, the tasks it reads. A *gather* (`cosfly.gather/1`) lists what
//! arrives at a port that takes all items, once for all tasks that read it. The *action key* is taken over
//! everything a stage can see while it runs, with inputs as contents; it is never stored as a document.

use crate::sources::HashedSource;
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::{Artifact, Fan, InputGroup, Stage};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

pub(crate) const DEFINITION_SCHEMA: &str = "cosfly.stage/1";
pub(crate) const PLAN_SCHEMA: &str = "cosfly.plan/1";
const GATHER_SCHEMA: &str = "cosfly.gather/1";
const ACTION_SCHEMA: &str = "cosfly.action/1";

/// What all items of a stage share.
#[derive(Clone, Debug)]
pub(crate) struct Definition {
    pub(crate) digest: Digest,
    pub(crate) json: String,
    /// The part of the action key that all its items share.
    action_prefix: Digest,
}

/// One thing that arrives at a port.
pub(crate) struct PlannedInput<'a> {
    /// Its id at the port.
    pub(crate) id: &'a str,
    pub(crate) stage: &'a str,
    pub(crate) item: &'a str,
    pub(crate) plan: Digest,
}

/// A port in the plan documents of a stage.
#[derive(Clone, Debug)]
pub(crate) enum PortDocument {
    /// The same text for all items: a broadcast, or the name of a gather document.
    Shared { port: &'static str, text: String, gather: Option<(Digest, String)> },
    /// One input per item; the connection's index.
    Each { port: &'static str, connection: usize },
}

impl PortDocument {
    pub(crate) fn port(&self) -> &'static str {
        match self {
            Self::Shared { port, .. } | Self::Each { port, .. } => port,
        }
    }
}

impl Definition {
    /// The definition of `stage`, called `name` in a recipe with seed `seed`.
    pub(crate) fn new(name: &str, seed: u64, stage: &dyn Stage, sources: &[HashedSource]) -> Self {
        let properties = stage.properties();
        let sources: BTreeMap<&str, Digest> = sources.iter().map(|s| (s.parameter.as_str(), s.digest)).collect();
        let shared = json!({
            "artifact": properties.artifact,
            "kind": properties.kind,
            "parameters": properties.parameters,
            "sources": sources,
            "version": properties.version,
        });
        let mut definition = shared.clone();
        definition["schema"] = DEFINITION_SCHEMA.into();
        definition["seed"] = seed.into();
        definition["stage"] = name.into();
        let json = canonical_json(&definition);
        let mut action = shared;
        action["schema"] = ACTION_SCHEMA.into();
        Self {
            digest: Digest::of(json.as_bytes()),
            json,
            action_prefix: Digest::of(canonical_json(&action).as_bytes()),
        }
    }

    /// The action key of one item: everything its stage can see, and nothing else.
    pub(crate) fn action_key(
        &self,
        stage: &str,
        item: &str,
        seed: &[u8; 32],
        ports: &BTreeMap<String, InputGroup>,
    ) -> Digest {
        let mut text = format!("{{\"definition\":\"{}\",\"item\":{},\"ports\":{{", self.action_prefix, quoted(item));
        for (index, (port, group)) in ports.iter().enumerate() {
            let _ = write!(text, "{}{}:[", comma(index), quoted(port));
            group.artifacts.iter().enumerate().for_each(|(index, artifact)| push_artifact(&mut text, index, artifact));
            text.push(']');
        }
        let _ = write!(text, "}},\"seed\":\"{}\",\"stage\":{}}}", Digest(*seed), quoted(stage));
        Digest::of(text.as_bytes())
    }
}

fn push_artifact(text: &mut String, index: usize, artifact: &Artifact) {
    let _ = write!(text, "{}{{\"blobs\":{{", comma(index));
    for (index, (name, blob)) in artifact.blobs.iter().enumerate() {
        let _ = write!(text, "{}{}:\"{}\"", comma(index), quoted(name), blob.digest);
    }
    let _ = write!(text, "}},\"item\":{},\"stage\":{}}}", quoted(&artifact.item), quoted(&artifact.stage));
}

/// The port of a stage in the plan documents of all its items; `inputs` gives what arrives.
pub(crate) fn port_document<'a>(
    port: &'static str,
    fan: Fan,
    connection: usize,
    inputs: impl Iterator<Item = PlannedInput<'a>>,
) -> PortDocument {
    match fan {
        Fan::Each => PortDocument::Each { port, connection },
        Fan::Broadcast => PortDocument::Shared { port, text: list_text(inputs), gather: None },
        Fan::Gather => {
            let json = format!("{{\"inputs\":{},\"schema\":\"{GATHER_SCHEMA}\"}}", list_text(inputs));
            let digest = Digest::of(json.as_bytes());
            let text = format!("{{\"gather\":\"{digest}\"}}");
            PortDocument::Shared { port, text, gather: Some((digest, json)) }
        }
    }
}

/// The plan document of one item. `ports` are sorted by name; `each` gives what arrives at a connection.
pub(crate) fn plan_document<'a>(
    definition: &Digest,
    item: &str,
    ports: &[PortDocument],
    each: impl Fn(usize) -> Option<PlannedInput<'a>>,
) -> String {
    let mut text = format!("{{\"definition\":\"{definition}\",\"inputs\":{{");
    for (index, port) in ports.iter().enumerate() {
        let _ = write!(text, "{}{}:", comma(index), quoted(port.port()));
        match port {
            PortDocument::Shared { text: shared, .. } => text.push_str(shared),
            PortDocument::Each { connection, .. } => text.push_str(&list_text(each(*connection).into_iter())),
        }
    }
    let _ = write!(text, "}},\"item\":{},\"schema\":\"{PLAN_SCHEMA}\"}}", quoted(item));
    text
}

fn list_text<'a>(inputs: impl Iterator<Item = PlannedInput<'a>>) -> String {
    let mut text = String::from("[");
    for (index, input) in inputs.enumerate() {
        let _ = write!(
            text,
            "{}{{\"as\":{},\"item\":{},\"plan\":\"{}\",\"stage\":{}}}",
            comma(index),
            quoted(input.id),
            quoted(input.item),
            input.plan,
            quoted(input.stage)
        );
    }
    text.push(']');
    text
}

fn comma(index: usize) -> &'static str {
    if index == 0 { "" } else { "," }
}

/// A JSON string. Names are almost always plain, and there are many of them.
fn quoted(text: &str) -> String {
    if text.bytes().all(|byte| (b' '..0x7f).contains(&byte) && byte != b'"' && byte != b'\\') {
        let mut plain = String::with_capacity(text.len() + 2);
        plain.push('"');
        plain.push_str(text);
        plain.push('"');
        plain
    } else {
        Value::from(text).to_string()
    }
}

/// One input in a stored document.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Deserialize)]
pub(crate) struct StoredInput {
    #[serde(rename = "as")]
    pub(crate) id: String,
    pub(crate) stage: String,
    pub(crate) item: String,
    pub(crate) plan: Digest,
}

/// A stored plan document, gather documents read along.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StoredPlan {
    pub(crate) definition: Digest,
    pub(crate) item: String,
    pub(crate) inputs: BTreeMap<String, Vec<StoredInput>>,
}

impl StoredPlan {
    /// Reads it with `document`, which gives the document of a digest.
    pub(crate) fn read(plan: &Digest, document: impl Fn(&Digest) -> Option<Value>) -> Option<Self> {
        let mut value = document(plan)?;
        if value["schema"] != PLAN_SCHEMA {
            return None;
        }
        let mut inputs = BTreeMap::new();
        for (port, list) in value["inputs"].as_object_mut()? {
            let list = match list.get("gather") {
                Some(gather) => document(&gather.as_str()?.parse().ok()?)?["inputs"].take(),
                None => list.take(),
            };
            inputs.insert(port.clone(), serde_json::from_value(list).ok()?);
        }
        Some(Self {
            definition: value["definition"].as_str()?.parse().ok()?,
            item: value["item"].as_str()?.to_owned(),
            inputs,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plan_documents_are_canonical_json_and_read_back() {
        let upstream = Digest::of(b"upstream");
        let input = |id| PlannedInput { id, stage: "walkers", item: "p\"0\n", plan: upstream };
        let ports = [
            port_document("all", Fan::Gather, 0, [input("a"), input("b")].into_iter()),
            port_document("path", Fan::Each, 1, std::iter::empty()),
            port_document("town", Fan::Broadcast, 2, [input("c")].into_iter()),
        ];
        let definition = Digest::of(b"definition");
        let text = plan_document(&definition, "é\\", &ports, |_| Some(input("d")));
        let value: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(canonical_json(&value), text);
        let PortDocument::Shared { gather: Some((gather, json)), .. } = &ports[0] else { panic!("no gather") };
        let documents = BTreeMap::from([(Digest::of(b"it"), text), (*gather, json.clone())]);
        let stored = StoredPlan::read(&Digest::of(b"it"), |digest| serde_json::from_str(documents.get(digest)?).ok());
        let stored = stored.unwrap();
        assert_eq!((stored.definition, stored.item.as_str()), (definition, "é\\"));
        assert_eq!(stored.inputs["all"].len(), 2);
        assert_eq!(stored.inputs["path"][0].item, "p\"0\n");
        assert_eq!(stored.inputs["town"][0].plan, upstream);
    }
}
