//! JSON Schema of whole recipes, for editors.

use crate::outline::{FILE_KIND, INTERMEDIATES};
use cosfly_stage::{InputPort, Registry, StageKind, Takes};
use serde_json::{Map, Value, json};

/// Names of stages, as in `[stages.NAME]`.
const STAGE_NAME: &str = "^[a-z][a-z0-9_]*$";

/// Schema (draft 2020-12) of recipes over the kinds of `registry`: each stage is checked against the parameters and
/// inputs of the kind that its `use` names.
///
/// Precise errors come from `allOf` with one `if`/`then` per kind. The `anyOf` beside it accepts everything (its last
/// alternative is empty): editors such as Taplo take completions and hovers from it, because they do not evaluate
/// `if`/`then`.
pub fn schema(registry: &Registry) -> Value {
    let mut definitions = Map::new();
    let mut rules = vec![];
    let mut offers = vec![];
    let mut uses = vec![];
    for kind in registry.iter() {
        let name = kind.name();
        let reference = json!({ "$ref": format!("#/$defs/{name}") });
        let written = written_use(name);
        rules.push(json!({ "if": { "properties": { "use": written }, "required": ["use"] }, "then": reference }));
        offers.push(reference);
        uses.push(described(written, kind));
        add_definitions(kind, &mut definitions);
    }
    offers.push(json!({}));
    let mut tools = Map::new();
    for tool in registry.tools() {
        tools.insert(tool.name.to_owned(), without_meta(tool.schema.clone()));
    }
    definitions.insert("stage".to_owned(), stage(&uses, &rules, &offers));
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "cosfly recipe",
        "description": "A DAG of stages that turns a town into a dataset.",
        "type": "object",
        "properties": {
            "name": {
                "type": "string",
                "pattern": "^[a-z0-9_-]+$",
                "maxLength": 100,
                "description": "Name of the dataset and its folder: `a-z`, `0-9`, `_` and `-`.",
            },
            "seed": {
                "type": "integer",
                "minimum": 0,
                "maximum": i64::MAX,
                "default": 0,
                "description": "Root of all randomness; every stage and item draws from its own stream below it.",
            },
            "intermediates": {
                "enum": INTERMEDIATES,
                "default": INTERMEDIATES[0],
                "description": "Whether intermediate files in the store, such as packed pictures, are removed as soon as everything that reads them is finished.",
            },
            "for_each": {
                "type": "object",
                "description": "Lists of values that stages are made for: values written out, or a pattern of files relative to the recipe's folder.",
                "additionalProperties": {
                    "anyOf": [
                        { "type": "array", "minItems": 1 },
                        { "type": "string" },
                        { "type": "object", "properties": { "files": { "type": "string" } }, "required": ["files"] },
                    ],
                },
            },
            "tool": {
                "type": "object",
                "description": "Tables of other commands, which runs do not read: `[tool.fly]` for `cosfly fly`.",
                "properties": tools,
                "additionalProperties": { "type": "object" },
            },
            "stages": {
                "type": "object",
                "minProperties": 1,
                "description": "The stages by name; names are `a-z`, `0-9` and `_` and begin with a letter.",
                "patternProperties": { (STAGE_NAME): { "$ref": "#/$defs/stage" } },
                "additionalProperties": false,
            },
        },
        "required": ["name", "stages"],
        "additionalProperties": false,
        "$defs": definitions,
    })
}

/// A schema without what only a whole document has.
fn without_meta(mut schema: Value) -> Value {
    for key in ["$schema", "title", "x-gone"] {
        schema.as_object_mut().map(|table| table.remove(key));
    }
    schema
}

/// Schema of a stage: what `use` may be, the rule of each kind, and what editors may offer.
fn stage(uses: &[Value], rules: &[Value], offers: &[Value]) -> Value {
    json!({
        "type": "object",
        "description": "One step of the recipe: `use` names its kind, `inputs` its upstream stages; all other keys are its parameters.",
        "properties": {
            "use": { "description": "Kind of the stage.", "oneOf": uses },
            "for_each": {
                "description": "Lists of `[for_each]`: the stage is made for each of their values, `{LIST}` or `{LIST.FIELD}` in its parameters is the value.",
                "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" }, "uniqueItems": true }],
            },
        },
        "required": ["use"],
        // A parameter may be a placeholder, whatever its type.
        "if": { "not": { "required": ["for_each"] } },
        "then": { "allOf": rules },
        "anyOf": offers,
    })
}

/// Schema for the value of `use` of a kind.
fn written_use(kind: &str) -> Value {
    if kind == FILE_KIND { json!({ "pattern": format!("^{FILE_KIND}:.") }) } else { json!({ "const": kind }) }
}

fn described(mut rule: Value, kind: &dyn StageKind) -> Value {
    rule["description"] = kind.doc().into();
    rule
}

/// Adds the kind's own schema with `use` and `inputs`, and its definitions as `KIND.DEFINITION`.
fn add_definitions(kind: &dyn StageKind, definitions: &mut Map<String, Value>) {
    let name = kind.name();
    let mut own = kind.schema();
    rename_references(&mut own, name);
    let Value::Object(mut own) = own else { return };
    // Keys that are gone are for the messages of a run; editors know none of them.
    for key in ["$schema", "title", "x-gone"] {
        own.remove(key);
    }
    for key in ["$defs", "definitions"] {
        if let Some(Value::Object(referred)) = own.remove(key) {
            definitions.extend(referred.into_iter().map(|(key, rule)| (format!("{name}.{key}"), rule)));
        }
    }
    let ports = kind.ports();
    let mut required = vec![json!("use")];
    if ports.iter().any(|port| !port.optional) {
        required.push(json!("inputs"));
    }
    if let Some(Value::Array(more)) = own.remove("required") {
        required.extend(more);
    }
    let properties = own.entry("properties").or_insert_with(|| json!({}));
    if let Value::Object(properties) = properties {
        properties.insert("use".to_owned(), described(written_use(name), kind));
        if name == FILE_KIND {
            properties.remove("file");
            required.retain(|key| key != "file");
        }
        if !ports.is_empty() {
            properties.insert("inputs".to_owned(), inputs(&ports));
        }
    }
    own.insert("required".to_owned(), required.into());
    own.insert("type".to_owned(), json!("object"));
    own.insert("description".to_owned(), json!(kind.doc()));
    own.insert("additionalProperties".to_owned(), json!(false));
    definitions.insert(name.to_owned(), own.into());
}

fn inputs(ports: &[InputPort]) -> Value {
    let properties: Map<String, Value> = ports
        .iter()
        .map(|port| {
            let description = format!("{} Takes `{}`.", port.doc, port.artifact);
            let one = json!({ "type": "string", "pattern": STAGE_NAME });
            let rule = if port.takes != Takes::One {
                let list = json!({ "type": "array", "items": one, "uniqueItems": true });
                json!({ "description": description, "anyOf": [one, list] })
            } else {
                json!({ "description": description, "type": "string", "pattern": STAGE_NAME })
            };
            (port.name.to_owned(), rule)
        })
        .collect();
    let required: Vec<&str> = ports.iter().filter(|port| !port.optional).map(|port| port.name).collect();
    json!({
        "type": "object",
        "description": "Upstream stages by port.",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// Renames `#/$defs/X` to `#/$defs/KIND.X`, and `#` to the kind itself.
fn rename_references(schema: &mut Value, kind: &str) {
    match schema {
        Value::Object(keywords) => {
            for (key, value) in keywords.iter_mut() {
                match value {
                    Value::String(reference) if key == "$ref" => {
                        let name =
                            reference.strip_prefix("#/$defs/").or_else(|| reference.strip_prefix("#/definitions/"));
                        *reference = match name {
                            Some(name) => format!("#/$defs/{kind}.{name}"),
                            None => format!("#/$defs/{kind}"),
                        };
                    }
                    _ => rename_references(value, kind),
                }
            }
        }
        Value::Array(parts) => parts.iter_mut().for_each(|part| rename_references(part, kind)),
        _ => {}
    }
}
