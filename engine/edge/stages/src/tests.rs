//! Parameters that no recipe, guide or other test sets: each is accepted and changes its stage.

use crate::registry;
use serde_json::{Value, json};

/// Kind, path of the parameter, a value that is not the default.
const RARE: &[(&str, &str, &str)] = &[
    ("caption", "variants_per_style", "3"),
    ("dataset", "citation", r#""A citation""#),
    ("dataset", "date_published", r#""2026-02-03""#),
    ("dataset", "frames_per_file", "5000"),
    ("dataset", "license/responsible_use", r#""For nothing but this test.""#),
    ("dataset", "responsible_ai", r#"{"dataCollection":"made"}"#),
    ("map", "fill/lamp_spacing_m", "40.0"),
    ("map", "fill/max_setback_m", "6.0"),
    ("map", "fill/min_setback_m", "2.0"),
    ("map", "options/road_marks", "false"),
    ("map", "options/sample_step_m", "20.0"),
    ("map", "options/signals", "false"),
    ("map", "options/unmarked_crossings", "false"),
    ("map", "simplify/crop_radius_m", "300.0"),
    ("map", "simplify/max_empty_share", "0.2"),
    ("map", "simplify/prune", "false"),
    ("map", "simplify/tolerance_m", "0.7"),
    ("plan", "descent/max_move_m", "0.3"),
    ("plan", "descent/min_rate", "0.01"),
    ("plan", "paper/max_distance_share", "1.5"),
    ("plan", "paper/hidden_run_frames", "7"),
    ("plan", "paper/keyframe_frames", "4"),
    ("plan", "paper/keyframe_motion", "0.1"),
    ("plan", "paper/make_flyable", "false"),
    ("plan", "paper/min_distance_share", "0.8"),
    ("plan", "paper/projection_rounds", "7"),
    ("plan", "paper/ramp_frames", "9"),
    ("plan", "paper/search_visibility", "50.0"),
    ("plan", "paper/side_offset_m", "10.0"),
    ("plan", "search/absolute_motion", "1.5"),
    ("plan", "search/azimuths", "48"),
    ("plan", "search/filter_radius_m", "60.0"),
    ("plan", "search/keyframe_frames", "2"),
    ("plan", "search/relative_motion", "1.5"),
    ("plan", "view/safety_influence_m", "6.0"),
    ("pedestrians", "restless_share", "0.5"),
    ("pedestrians", "speed/deviation_mps", "0.2"),
    ("pedestrians", "speed/mean_mps", "1.2"),
    ("pedestrians", "speed/min_mps", "0.6"),
    ("perturb", "aim_offset/max_m", "4.0"),
    ("perturb", "drone_offset/max_m", "5.0"),
    ("perturb", "flyable/aim_deg", "4.0"),
    ("perturb", "flyable/aim_lag_s", "0.5"),
    ("perturb", "flyable/drift_s", "9.0"),
    ("perturb", "flyable/gust_every_s", "12.0"),
    ("perturb", "flyable/gust_mps2", "2.0"),
    ("perturb", "flyable/search_deg", "50.0"),
    ("perturb", "flyable/search_every_s", "20.0"),
    ("perturb", "flyable/search_s", "8.0"),
    ("perturb", "flyable/timing_s", "0.5"),
    ("perturb", "max_rotation_deg", "8.0"),
    ("render", "weather/dust_storm", "[0.0,10.0]"),
    ("render", "weather/fog_density", "[0.0,10.0]"),
    ("render", "weather/fog_distance", "[10.0,20.0]"),
    ("render", "weather/fog_falloff", "[0.1,0.2]"),
    ("render", "weather/mie_scattering_scale", "[0.01,0.02]"),
    ("render", "weather/precipitation_deposits", "[0.0,10.0]"),
    ("render", "weather/rayleigh_scattering_scale", "[0.01,0.02]"),
    ("render", "weather/scattering_intensity", "[0.5,1.0]"),
    ("render", "weather/sun_azimuth_angle", "[10.0,20.0]"),
    ("render", "weather/wetness", "[0.0,10.0]"),
    ("render", "weather/wind_intensity", "[0.0,10.0]"),
    ("traffic", "people/kinds/child", "0.2"),
    ("traffic", "people/kinds/dog_walker", "0.2"),
    ("traffic", "people/kinds/elder", "0.2"),
    ("traffic", "people/kinds/push_chair", "0.2"),
    ("traffic", "people/kinds/runner", "0.2"),
    ("traffic", "people/kinds/sitter", "0.2"),
    ("traffic", "people/kinds/wheelchair", "0.2"),
    ("traffic", "people/restless_share", "0.5"),
    ("traffic", "people/side/deviation_m", "0.2"),
    ("traffic", "people/side/drift_s", "5.0"),
    ("traffic", "people/speed/deviation_mps", "0.2"),
    ("traffic", "people/speed/mean_mps", "1.2"),
    ("traffic", "people/speed/min_mps", "0.6"),
    ("traffic", "people/stops/max_s", "60.0"),
    ("traffic", "people/step_deviation_mps", "0.2"),
    ("traffic", "vehicles/area_m", "[-50.0,-50.0,50.0,50.0]"),
    ("traffic", "vehicles/headway_s", "1.6"),
    ("traffic", "vehicles/mix/trucks", "0.1"),
    ("traffic", "vehicles/parked_share", "0.2"),
    ("traffic", "vehicles/speed_deviation_share", "0.1"),
    ("traffic", "vehicles/speed_share", "0.8"),
];

/// Kind, and a parameter that must not be left out.
const NEEDED: &[(&str, &str, &str)] = &[("map", "source", "street.xodr")];

/// A table with one value at a path.
fn table(path: &str, value: Value) -> Value {
    path.rsplit('/').fold(value, |inner, key| json!({ key: inner }))
}

/// Keys that the parts of a stage get from parameters.
fn keys_of(kind: &str, mut given: Value) -> Result<Vec<Value>, String> {
    for (_, name, value) in NEEDED.iter().filter(|it| it.0 == kind) {
        given[*name] = (*value).into();
    }
    let registry = registry();
    let built = registry.get(kind).expect("a kind").build(given).map_err(|error| format!("{error:?}"))?;
    Ok(built.iter().map(|part| part.stage.properties().parameters.clone()).collect())
}

#[test]
fn each_is_accepted_and_changes_the_key() {
    let mut faults = vec![];
    for (kind, path, value) in RARE {
        let value: Value = serde_json::from_str(value).expect("JSON");
        match keys_of(kind, table(path, value)) {
            Ok(keys) if keys == keys_of(kind, json!({})).expect("defaults") => {
                faults.push(format!("{kind}: `{path}` changes nothing"))
            }
            Ok(_) => {}
            Err(error) => faults.push(format!("{kind}: `{path}`: {error}")),
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn the_longest_inspection_is_accepted_and_changes_the_key() {
    let keys =
        |inspect: Value| keys_of("plan", json!({ "objective": "inspect", "inspect": inspect })).expect("accepted");
    assert_ne!(keys(json!({ "max_duration_s": 90.0 })), keys(json!({})));
}

#[test]
fn the_number_of_walks_per_file_sizes_items_and_is_in_no_key() {
    assert_eq!(keys_of("dataset", json!({ "walks_per_file": 50 })), keys_of("dataset", json!({})));
}

#[test]
fn the_pace_of_questions_is_accepted_and_in_no_key() {
    let teacher = |per_minute: u32| {
        let server = json!({ "address": "http://127.0.0.1:1/v1", "per_minute": per_minute });
        keys_of("caption", json!({ "teacher": { "model": "any", "server": server } })).expect("a teacher")
    };
    assert_eq!(teacher(7), teacher(0));
}
