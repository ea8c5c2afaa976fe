//! Builds the parts of a stage from its kind and parameters.

use crate::document::{Node, Place, Problems, Texts, Value, list};
use crate::outline::{FILE_KIND, StageOutline};
use crate::parameters::{Subject, allowed_values, check_parameters, resolve};
use cosfly_diagnose::{Diagnostic, ParameterError, nearest_name};
use cosfly_stage::{InputPort, PortSource, Registry, Stage, StageKind};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Built parts of one recipe stage.
pub(crate) struct BuiltStage {
    /// Parts in dependency order, the stage itself last.
    pub(crate) parts: Vec<BuiltPart>,
    /// Table of the stage, for places.
    pub(crate) parameters: Node,
}

/// One built part.
pub(crate) struct BuiltPart {
    pub(crate) suffix: &'static str,
    pub(crate) stage: Arc<dyn Stage>,
}

/// Kind of a recipe stage, and its built parts.
pub(crate) struct KnownStage {
    /// Ports that the recipe may connect.
    pub(crate) ports: Vec<InputPort>,
    /// Built parts; `None` when the parameters have errors.
    pub(crate) built: Option<BuiltStage>,
}

/// Builds stages; the schema of each kind is computed once.
pub(crate) struct Builder<'a> {
    registry: &'a Registry,
    texts: &'a Texts,
    schemas: BTreeMap<&'static str, serde_json::Value>,
}

impl BuiltStage {
    /// Kind of artifact that the stage makes.
    pub(crate) fn artifact(&self) -> Option<&'static str> {
        self.parts.last().map(|part| part.stage.properties().artifact)
    }
}

impl<'a> Builder<'a> {
    pub(crate) fn new(registry: &'a Registry, texts: &'a Texts) -> Self {
        Self { registry, texts, schemas: BTreeMap::new() }
    }

    /// Finds the kind, checks the parameters against its schema and builds it.
    pub(crate) fn build(&mut self, stage: &StageOutline, problems: &mut Problems) -> Option<KnownStage> {
        let (name, place) = stage.kind.as_ref()?;
        let Some(kind) = self.registry.get(name) else {
            problems.push(self.unknown_kind(name, place));
            return None;
        };
        let mut ports = kind.ports();
        let parameters = Node { place: stage.place.clone(), value: Value::Table(stage.parameters.clone()) };
        let schema = self.schemas.entry(kind.name()).or_insert_with(|| kind.schema());
        let port_names: Vec<&str> = ports.iter().map(|port| port.name).collect();
        let table = format!("stages.{}", stage.name);
        let subject =
            Subject { table: &table, stage: &stage.name, kind: name, place: &stage.place, ports: &port_names };
        let mut wrong = check_parameters(schema, &parameters, &subject, self.texts);
        let built = if wrong.is_empty() && !has_refused(&parameters) {
            match build_kind(kind, &parameters) {
                Ok(parts) => Some(BuiltStage { parts, parameters }),
                Err(error) => {
                    wrong.push(parameter_problem(&error, (&parameters, &stage.place), self.texts));
                    None
                }
            }
        } else {
            None
        };
        problems.append(&mut wrong);
        if let Some(built) = &built {
            ports = recipe_ports(built);
        }
        Some(KnownStage { ports, built })
    }

    fn unknown_kind(&self, name: &str, place: &Place) -> Box<Diagnostic> {
        let known = || self.registry.iter().map(StageKind::name);
        let problem = self.texts.problem("recipe-unknown-kind", place, format!("there is no stage kind `{name}`"));
        if name == FILE_KIND {
            return problem
                .hint("this cosfly was built without plugins; the feature `plugins` adds them")
                .hint(format!("built-in stage kinds: {}", list(known(), usize::MAX)));
        }
        let gone = self.registry.iter().flat_map(StageKind::gone).find(|(former, _)| *former == name);
        if let Some((_, now)) = gone {
            return problem.hint(format!("the kind is called `{now}` now"));
        }
        match nearest_name(name, known()) {
            Some(near) => problem.hint(format!("did you mean `{near}`?")),
            None => problem,
        }
        .hint(format!("stage kinds: {}", list(known(), usize::MAX)))
    }
}

/// An error at the key of a stage that it is about.
pub(crate) fn parameter_problem(
    error: &ParameterError,
    (parameters, stage): (&Node, &Place),
    texts: &Texts,
) -> Box<Diagnostic> {
    let node = parameters.deepest(error.path.iter().map(String::as_str));
    let place = if std::ptr::eq(node, parameters) { stage } else { &node.place };
    let problem = texts.problem("recipe-parameter", place, &error.message);
    match &error.hint {
        Some(hint) => problem.hint(hint),
        None => problem,
    }
}

fn build_kind(kind: &dyn StageKind, parameters: &Node) -> Result<Vec<BuiltPart>, ParameterError> {
    let parts = kind.build(parameters.json())?;
    if parts.is_empty() {
        let message = format!("internal error: `{}` built no stage", kind.name());
        return Err(ParameterError { path: vec![], message, hint: None });
    }
    Ok(parts.into_iter().map(|part| BuiltPart { suffix: part.suffix, stage: part.stage.into() }).collect())
}

/// Ports that the recipe connects, over all parts; parts with a port of the same name share its connection. A port is
/// required where a part requires it that cannot be left out.
fn recipe_ports(built: &BuiltStage) -> Vec<InputPort> {
    let mut ports: Vec<InputPort> = vec![];
    for part in &built.parts {
        let is_needed = is_needed(part.suffix, &built.parts);
        for port in part.stage.properties().inputs.iter().filter(|port| port.source == PortSource::Recipe) {
            let optional = port.optional || !is_needed;
            match ports.iter_mut().find(|known| known.name == port.name) {
                Some(known) => known.optional &= optional,
                None => ports.push(InputPort { optional, ..port.clone() }),
            }
        }
    }
    ports
}

/// Whether a part is the stage itself or required by a port; other parts are omitted where one of their own required
/// ports is not connected.
fn is_needed(suffix: &'static str, parts: &[BuiltPart]) -> bool {
    let mut ports = parts.iter().flat_map(|part| &part.stage.properties().inputs);
    suffix.is_empty() || ports.any(|port| !port.optional && port.source == PortSource::Sibling(suffix))
}

fn has_refused(node: &Node) -> bool {
    match &node.value {
        Value::Refused => true,
        Value::Array(items) => items.iter().any(has_refused),
        Value::Table(table) => table.values().any(|entry| has_refused(&entry.node)),
        _ => false,
    }
}

/// Kinds whose stages make `artifact` with their default parameters (required ones get placeholder values); for hints.
pub(crate) fn kinds_that_make(registry: &Registry, artifact: &str) -> Vec<&'static str> {
    registry
        .iter()
        .filter(|kind| {
            let parts = kind.build(smallest_parameters(&kind.schema()));
            parts.is_ok_and(|parts| parts.last().is_some_and(|part| part.stage.properties().artifact == artifact))
        })
        .map(StageKind::name)
        .collect()
}

/// Placeholder values for all required parameters.
fn smallest_parameters(schema: &serde_json::Value) -> serde_json::Value {
    let required = schema.get("required").and_then(serde_json::Value::as_array).into_iter().flatten();
    let parameters: serde_json::Map<_, _> = required
        .filter_map(serde_json::Value::as_str)
        .map(|key| {
            let rule = resolve(schema, &schema["properties"][key]);
            let value = match rule.get("type").and_then(serde_json::Value::as_str) {
                _ if !allowed_values(schema, rule).is_empty() => allowed_values(schema, rule)[0].0.clone(),
                Some("integer" | "number") => rule.get("minimum").cloned().unwrap_or_else(|| 1.into()),
                Some("boolean") => false.into(),
                Some("array") => serde_json::json!([]),
                Some("object") => serde_json::json!({}),
                _ => "x".into(),
            };
            (key.to_owned(), value)
        })
        .collect();
    parameters.into()
}
