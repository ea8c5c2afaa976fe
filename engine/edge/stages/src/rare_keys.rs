//! Parameters that no recipe, guide or other test sets: each is accepted and changes the stage.

use crate::registry;
use serde_json::{Value, json};

/// Kind, path of the parameter and a value that is not the default.
const RARE: &[(&str, &str, f64)] = &[
    ("map", "fill/lamp_spacing_m", 40.0),
    ("map", "fill/max_setback_m", 6.0),
    ("map", "fill/min_setback_m", 2.0),
    ("muco", "inspect/max_duration_s", 90.0),
    ("muco", "paper/farthest_share", 1.5),
    ("muco", "paper/ramp_frames", 9.0),
    ("perturb", "drone_offset/max_m", 5.0),
    ("perturb", "flyable/aim_deg", 4.0),
    ("perturb", "flyable/aim_lag_s", 0.5),
    ("perturb", "flyable/drift_s", 9.0),
    ("perturb", "flyable/gust_every_s", 12.0),
    ("perturb", "flyable/gust_mps2", 2.0),
    ("perturb", "flyable/search_deg", 50.0),
    ("perturb", "flyable/search_every_s", 20.0),
    ("traffic", "people/side/deviation_m", 0.2),
    ("traffic", "people/side/drift_s", 5.0),
    ("traffic", "people/unevenness_mps", 0.2),
    ("traffic", "vehicles/speed_deviation", 0.1),
    ("traffic", "vehicles/speed_share", 0.8),
];

/// A table with one value at a path.
fn table(path: &str, value: Value) -> Value {
    path.rsplit('/').fold(value, |inner, key| json!({ key: inner }))
}

/// The parameters that are part of the key of a stage's main part.
fn key_of(kind: &str, mut given: Value) -> Value {
    if kind == "map" {
        given["source"] = "street.xodr".into();
    }
    let registry = registry();
    let parts = registry.get(kind).expect("a kind").build(given).unwrap_or_else(|error| panic!("{kind}: {error:?}"));
    parts.last().expect("a stage").stage.properties().parameters.clone()
}

#[test]
fn each_is_accepted_and_changes_the_key() {
    for (kind, path, value) in RARE {
        let whole = value.fract() == 0.0 && path.ends_with("_frames");
        let value = if whole { json!(*value as u64) } else { json!(value) };
        let key = key_of(kind, table(path, value.clone()));
        assert_ne!(key, key_of(kind, json!({})), "{kind}: `{path}` changes nothing");
        assert_eq!(key.pointer(&format!("/{path}")), Some(&value), "{kind}: `{path}`");
    }
    assert_ne!(key_of("map", json!({ "road_marks": false })), key_of("map", json!({})));
}

#[test]
fn the_pace_of_questions_is_accepted_and_in_no_key() {
    let teacher = |per_minute: u32| json!({ "teacher": { "model": "any", "server": { "address": "http://127.0.0.1:1/v1", "per_minute": per_minute } } });
    assert_eq!(key_of("caption", teacher(7)), key_of("caption", teacher(0)));
}
