//! Plan documents: canonical JSON whose digest is the key of a task before it runs, and the action key afterwards.
//!
//! A *definition* (`cosfly.stage/1`) is shared by all items of a stage. A *plan* (`cosfly.plan/2`) names the definition,
//! the item and, by their plan digests, the tasks that are read. A *gather* (`cosfly.gather/2`) lists the items at a port
//! that takes all of them, once for all tasks that read it. The *action key* is taken over everything that a stage can
//! see while it runs, with inputs as contents; it is never stored as a document.

use crate::sources::HashedSource;
use cosfly_fingerprint::{Digest, DigestOfPieces, canonical_json};
use cosfly_stage::{Artifact, Fan, ItemId, ItemName, Ports, Stage, StageName};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::{Display, Write as _};

pub(crate) const DEFINITION_SCHEMA: &str = "cosfly.stage/1";
pub(crate) const PLAN_SCHEMA: &str = "cosfly.plan/2";
const GATHER_SCHEMA: &str = "cosfly.gather/2";
const ACTION_SCHEMA: &str = "cosfly.action/1";

/// Document that all items of a stage share.
#[derive(Clone, Debug)]
pub(crate) struct Definition {
    pub(crate) digest: Digest,
    pub(crate) json: String,
    /// Part of the action key that all items share.
    action_prefix: Digest,
}

/// An item at a port.
#[derive(Clone, Copy)]
pub(crate) struct PlannedInput<'a> {
    /// Name at the port.
    pub(crate) name: &'a ItemName,
    /// Stage that makes it.
    pub(crate) stage: &'a StageName,
    /// Name in that stage.
    pub(crate) item: &'a ItemName,
    /// Plan digest of its task.
    pub(crate) plan: Digest,
}

/// A port in the plan documents of a stage.
#[derive(Clone, Debug)]
pub(crate) enum PortDocument {
    /// Text for all items: a broadcast, or the digest of a gather document with the index of its connection.
    Shared { port: &'static str, text: String, gather: Option<(Digest, usize)> },
    /// Inputs of each item, of the connection with this index.
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
    /// Definition of `stage`, called `name` in a recipe with the seed `seed`.
    pub(crate) fn new(name: &StageName, seed: u64, stage: &dyn Stage, sources: &[HashedSource]) -> Self {
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
        definition["stage"] = name.as_str().into();
        let json = canonical_json(&definition);
        let mut action = shared;
        action["schema"] = ACTION_SCHEMA.into();
        Self {
            digest: Digest::of(json.as_bytes()),
            json,
            action_prefix: Digest::of(canonical_json(&action).as_bytes()),
        }
    }

    /// Action key of one item: over everything that its stage can see, and nothing else.
    pub(crate) fn action_key(&self, id: &ItemId, seed: &[u8; 32], ports: &Ports) -> Digest {
        // Hashed piece by piece: a port may have a hundred thousand artifacts.
        let mut pieces = DigestOfPieces::default();
        let mut text = format!("{{\"definition\":\"{}\",\"item\":", self.action_prefix);
        push_quoted(&mut text, &id.item);
        text.push_str(",\"ports\":{");
        for (index, (port, artifacts)) in ports.iter().enumerate() {
            text.push_str(comma(index));
            push_quoted(&mut text, port);
            text.push_str(":[");
            for (index, artifact) in artifacts.iter().enumerate() {
                push_artifact(&mut text, index, artifact);
                pieces.add(text.as_bytes());
                text.clear();
            }
            text.push(']');
        }
        let _ = write!(text, "}},\"seed\":\"{}\",\"stage\":", Digest(*seed));
        push_quoted(&mut text, &id.stage);
        text.push('}');
        pieces.add(text.as_bytes());
        pieces.digest()
    }
}

fn push_artifact(text: &mut String, index: usize, artifact: &Artifact) {
    let _ = write!(text, "{}{{\"blobs\":{{", comma(index));
    for (index, (name, blob)) in artifact.blobs.iter().enumerate() {
        text.push_str(comma(index));
        push_quoted(text, name);
        text.push_str(":\"");
        push_digest(text, &blob.digest);
        text.push('"');
    }
    text.push_str("},\"item\":");
    push_quoted(text, &artifact.name);
    text.push_str(",\"stage\":");
    push_quoted(text, &artifact.id.stage);
    text.push('}');
}

/// Port of a stage in the plan documents of all its items; `inputs` are the items at the port.
pub(crate) fn port_document<'a>(
    port: &'static str,
    fan: Fan,
    connection: usize,
    inputs: impl Iterator<Item = PlannedInput<'a>>,
) -> PortDocument {
    match fan {
        Fan::Each | Fan::Group => PortDocument::Each { port, connection },
        Fan::Broadcast => PortDocument::Shared { port, text: list_text(inputs), gather: None },
        Fan::Gather => {
            // The document itself is as long as its port has items: it is made again where it is published.
            let digest = Digest::of(gather_document(inputs).as_bytes());
            let text = format!("{{\"gather\":\"{digest}\"}}");
            PortDocument::Shared { port, text, gather: Some((digest, connection)) }
        }
    }
}

/// Document of the items at a port that takes all of them.
pub(crate) fn gather_document<'a>(inputs: impl Iterator<Item = PlannedInput<'a>>) -> String {
    let mut text = "{\"inputs\":".to_owned();
    push_list(&mut text, inputs);
    let _ = write!(text, ",\"schema\":\"{GATHER_SCHEMA}\"}}");
    text
}

/// Plan document of one item. `ports` are sorted by name; `each` gives the item's inputs at a connection.
pub(crate) fn plan_document<'a, I: Iterator<Item = PlannedInput<'a>>>(
    definition: &Digest,
    item: &ItemName,
    ports: &[PortDocument],
    each: impl Fn(usize) -> I,
) -> String {
    let mut text = String::with_capacity(512);
    text.push_str("{\"definition\":\"");
    push_digest(&mut text, definition);
    text.push_str("\",\"inputs\":{");
    for (index, port) in ports.iter().enumerate() {
        text.push_str(comma(index));
        push_quoted(&mut text, &port.port());
        text.push(':');
        match port {
            PortDocument::Shared { text: shared, .. } => text.push_str(shared),
            PortDocument::Each { connection, .. } => push_list(&mut text, each(*connection)),
        }
    }
    text.push_str("},\"item\":");
    push_name(&mut text, item);
    let _ = write!(text, ",\"schema\":\"{PLAN_SCHEMA}\"}}");
    text
}

fn list_text<'a>(inputs: impl Iterator<Item = PlannedInput<'a>>) -> String {
    let mut text = String::new();
    push_list(&mut text, inputs);
    text
}

fn push_list<'a>(text: &mut String, inputs: impl Iterator<Item = PlannedInput<'a>>) {
    text.push('[');
    for (index, input) in inputs.enumerate() {
        let _ = write!(text, "{}{{\"as\":", comma(index));
        push_name(text, input.name);
        text.push_str(",\"item\":");
        push_name(text, input.item);
        text.push_str(",\"plan\":\"");
        push_digest(text, &input.plan);
        text.push_str("\",\"stage\":");
        push_quoted(text, input.stage);
        text.push('}');
    }
    text.push(']');
}

fn comma(index: usize) -> &'static str {
    if index == 0 { "" } else { "," }
}

/// Appends the hex digits of a digest: there are two or more for each item of a recipe.
fn push_digest(text: &mut String, digest: &Digest) {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    for byte in digest.0 {
        text.push(char::from(DIGITS[usize::from(byte >> 4)]));
        text.push(char::from(DIGITS[usize::from(byte & 15)]));
    }
}

/// Appends the structure of an item's name.
fn push_name(text: &mut String, name: &ItemName) {
    text.push_str(&serde_json::to_string(name).expect("a name is JSON"));
}

/// Appends a value as a JSON string. Names are almost always plain, and there are many of them.
fn push_quoted(text: &mut String, value: &(impl Display + ?Sized)) {
    text.push('"');
    let start = text.len();
    let _ = write!(text, "{value}");
    let is_plain = |byte| (b' '..0x7f).contains(&byte) && byte != b'"' && byte != b'\\';
    if text[start..].bytes().all(is_plain) {
        text.push('"');
    } else {
        let raw = text.split_off(start);
        text.pop();
        text.push_str(&Value::from(raw).to_string());
    }
}

/// One input in a stored document.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Deserialize)]
pub(crate) struct StoredInput {
    #[serde(rename = "as")]
    pub(crate) name: ItemName,
    pub(crate) stage: StageName,
    pub(crate) item: ItemName,
    pub(crate) plan: Digest,
}

/// A stored plan document, with its gather documents.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StoredPlan {
    pub(crate) definition: Digest,
    pub(crate) item: ItemName,
    pub(crate) inputs: BTreeMap<String, Vec<StoredInput>>,
}

impl StoredPlan {
    /// Reads the plan document of `plan`; `document` gives the document of a digest.
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
            item: serde_json::from_value(value["item"].take()).ok()?,
            inputs,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plan_documents_are_canonical_json_and_read_back() {
        let stage = StageName::new("walkers", "");
        let (item, names) = (ItemName::own("p\"0\n"), ["a", "b", "c", "d"].map(ItemName::own));
        let input =
            |at: usize| PlannedInput { name: &names[at], stage: &stage, item: &item, plan: Digest::of(b"upstream") };
        let ports = [
            port_document("all", Fan::Gather, 0, [input(0), input(1)].into_iter()),
            port_document("path", Fan::Each, 1, std::iter::empty()),
            port_document("town", Fan::Broadcast, 2, [input(2)].into_iter()),
        ];
        let definition = Digest::of(b"definition");
        let text = plan_document(&definition, &ItemName::own("é\\"), &ports, |_| std::iter::once(input(3)));
        let value: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(canonical_json(&value), text);
        let PortDocument::Shared { gather: Some((gather, 0)), .. } = &ports[0] else { panic!("no gather") };
        let json = gather_document([input(0), input(1)].into_iter());
        assert_eq!(*gather, Digest::of(json.as_bytes()));
        let documents = BTreeMap::from([(Digest::of(b"it"), text), (*gather, json)]);
        let stored = StoredPlan::read(&Digest::of(b"it"), |digest| serde_json::from_str(documents.get(digest)?).ok());
        let stored = stored.unwrap();
        assert_eq!((stored.definition, stored.item), (definition, ItemName::own("é\\")));
        assert_eq!(stored.inputs["all"].len(), 2);
        assert_eq!(stored.inputs["path"][0].item, item);
        assert_eq!(stored.inputs["town"][0].plan, Digest::of(b"upstream"));
    }
}
