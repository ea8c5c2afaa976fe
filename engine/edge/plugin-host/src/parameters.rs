//! Parameters of plugins: the schema that a plugin declares, and its defaults.

use cosfly_diagnose::nearest_name;
use serde_json::{Map, Value};

/// The schema in what `describe` gave; an empty text is that of no parameters. Keys that it does not list are refused unless
/// it says otherwise.
///
/// # Errors
/// Why the text is no schema of an object.
pub fn check_schema(text: &str) -> Result<Value, String> {
    if text.trim().is_empty() {
        return Ok(serde_json::json!({ "type": "object", "properties": {}, "additionalProperties": false }));
    }
    let mut schema: Value =
        serde_json::from_str(text).map_err(|error| format!("its `params-schema` is not JSON: {error}"))?;
    let is_object = schema.get("type").and_then(Value::as_str) == Some("object");
    let has_properties = schema.get("properties").is_none_or(Value::is_object);
    let (Some(table), true, true) = (schema.as_object_mut(), is_object, has_properties) else {
        return Err("its `params-schema` is not the schema of an object (`\"type\": \"object\"`)".to_owned());
    };
    table.entry("additionalProperties").or_insert(Value::Bool(false));
    Ok(schema)
}

/// Checks `given` as recipes check `params`: names, types, ranges and listed values, at every depth.
///
/// # Errors
/// Fault of the first wrong parameter, and what is allowed.
pub fn check_given(schema: &Value, given: &Map<String, Value>) -> Result<(), String> {
    check_table(schema, given, "")
}

fn check_table(schema: &Value, given: &Map<String, Value>, inside: &str) -> Result<(), String> {
    let empty = Map::new();
    let known = schema.get("properties").and_then(Value::as_object).unwrap_or(&empty);
    for (name, value) in given {
        let path = format!("{inside}{name}");
        if let Some(rule) = known.get(name) {
            check_value(rule, value, &path)?;
        } else if schema.get("additionalProperties") == Some(&Value::Bool(false)) {
            let names = || known.keys().map(String::as_str);
            let near = nearest_name(name, names()).map_or_else(String::new, |it| format!("did you mean `{it}`? "));
            let all = names().map(|it| format!("`{it}`")).collect::<Vec<_>>().join(", ");
            let all = if all.is_empty() { "there are none".to_owned() } else { format!("there are {all}") };
            return Err(format!("`{path}` is no parameter: {near}{all}"));
        }
    }
    Ok(())
}

fn check_value(rule: &Value, value: &Value, path: &str) -> Result<(), String> {
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(number) if number.is_f64() => "number",
        Value::Number(_) => "integer",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let is_other = |wanted: &&str| *wanted != kind && (*wanted, kind) != ("number", "integer");
    if let Some(wanted) = rule.get("type").and_then(Value::as_str).filter(is_other) {
        return Err(format!("`{path}` is `{value}`; it must be of the type {wanted}"));
    }
    if let Some(number) = value.as_f64() {
        let limit = |key: &str| rule.get(key).and_then(Value::as_f64);
        for (words, limit, is_kept) in [
            ("at least", limit("minimum"), limit("minimum").is_none_or(|limit| number >= limit)),
            ("at most", limit("maximum"), limit("maximum").is_none_or(|limit| number <= limit)),
            ("more than", limit("exclusiveMinimum"), limit("exclusiveMinimum").is_none_or(|limit| number > limit)),
            ("less than", limit("exclusiveMaximum"), limit("exclusiveMaximum").is_none_or(|limit| number < limit)),
        ] {
            if let Some(limit) = limit.filter(|_| !is_kept) {
                return Err(format!("`{path}` is `{value}`; it must be {words} {limit}"));
            }
        }
    }
    if let Some(allowed) = rule.get("enum").and_then(Value::as_array).filter(|all| !all.contains(value)) {
        let allowed = allowed.iter().map(|it| format!("`{it}`")).collect::<Vec<_>>().join(", ");
        return Err(format!("`{path}` is `{value}`; allowed are {allowed}"));
    }
    match value {
        Value::Object(table) => check_table(rule, table, &format!("{path}.")),
        Value::Array(items) => {
            let rule = rule.get("items").unwrap_or(&Value::Null);
            items.iter().enumerate().try_for_each(|(at, item)| check_value(rule, item, &format!("{path}.{at}")))
        }
        _ => Ok(()),
    }
}

/// `given` with the defaults of what is missing, as JSON text with sorted keys.
pub fn with_defaults(schema: &Value, given: &Map<String, Value>) -> String {
    Value::Object(filled(schema, given)).to_string()
}

fn filled(schema: &Value, given: &Map<String, Value>) -> Map<String, Value> {
    let mut all = given.clone();
    for (name, rule) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
        match (all.get_mut(name), rule.get("default")) {
            (Some(Value::Object(inner)), _) => *inner = filled(rule, inner),
            (None, Some(default)) => {
                all.insert(name.clone(), default.clone());
            }
            _ => {}
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_fill_what_is_missing_at_every_depth() {
        let schema = check_schema(
            r#"{"type":"object","properties":{"a":{"default":1},"b":{"type":"object","properties":{"c":{"default":2}}}}}"#,
        )
        .unwrap();
        let given = serde_json::json!({ "b": { "d": 3 } });
        assert_eq!(with_defaults(&schema, given.as_object().unwrap()), r#"{"a":1,"b":{"c":2,"d":3}}"#);
        assert_eq!(schema["additionalProperties"], false);
    }

    #[test]
    fn parameters_are_checked_as_in_recipes() {
        let schema = check_schema(
            r#"{"type":"object","properties":{"free_m":{"type":"number","minimum":0,"maximum":400},"on":{"type":"boolean"},
            "way":{"enum":["up","down"]},"zones":{"type":"array","items":{"type":"object","additionalProperties":false,
            "properties":{"count":{"type":"integer","exclusiveMinimum":0}}}}}}"#,
        )
        .unwrap();
        let checked = |given: Value| check_given(&schema, given.as_object().unwrap());
        let fitting = serde_json::json!({ "free_m": 3, "on": true, "way": "up", "zones": [{ "count": 1 }] });
        assert_eq!(checked(fitting), Ok(()));
        for (given, told) in [
            (serde_json::json!({ "fre_m": 3 }), "`fre_m` is no parameter: did you mean `free_m`?"),
            (serde_json::json!({ "free_m": 900 }), "`free_m` is `900`; it must be at most 400"),
            (serde_json::json!({ "free_m": "3" }), "it must be of the type number"),
            (serde_json::json!({ "way": "left" }), "allowed are `\"up\"`, `\"down\"`"),
            (serde_json::json!({ "zones": [{ "count": 0 }] }), "`zones.0.count` is `0`; it must be more than 0"),
            (serde_json::json!({ "zones": [{ "sum": 0 }] }), "`zones.0.sum` is no parameter: there are `count`"),
            (serde_json::json!({ "zones": [{ "count": 1.5 }] }), "of the type integer"),
        ] {
            let error = checked(given).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
    }

    #[test]
    fn what_is_no_schema_of_an_object_is_refused() {
        for text in ["{", "[]", "{\"type\":\"string\"}", "{\"type\":\"object\",\"properties\":3}"] {
            assert!(check_schema(text).is_err(), "{text}");
        }
        check_schema("").unwrap();
    }
}
