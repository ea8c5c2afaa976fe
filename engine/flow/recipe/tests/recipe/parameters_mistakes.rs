//! Messages about parameters that a stage's kind does not allow.

use crate::toys::{complaint, complaint_about_people};

#[test]
fn an_unknown_key_names_the_nearest() {
    let text = complaint_about_people(r#"margin = 0.3"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-key]: `margin` is not a parameter of `walkers`
     --> a.toml:8:1
      |
    8 | margin = 0.3
      | ^^^^^^
      |
      = help: did you mean `margin_m`?
      = help: parameters of `walkers`: `colour`, `count`, `crossing`, `crowd`, `curious`, `margin_m`,
              `pause`, `shares`, `speed`, `version`, `visits`
    "#);
}

#[test]
fn an_unknown_nested_key() {
    let text = complaint_about_people(r#"speed.max = 3"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-key]: `max` is not a parameter of `speed` of `walkers`
     --> a.toml:8:7
      |
    8 | speed.max = 3
      |       ^^^
      |
      = help: did you mean `max_mps`?
      = help: parameters of `speed` of `walkers`: `max_mps`, `min_mps`
    "#);
}

#[test]
fn an_input_written_as_a_parameter() {
    let text = complaint_about_people(
        r#"[stages.more]
use = "walkers"
inputs.town = "town"
town = "town""#,
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-key]: `town` is not a parameter of `walkers`
      --> a.toml:11:1
       |
    11 | town = "town"
       | ^^^^
       |
       = help: `town` is an input: write `inputs.town = ...` in `[stages.more]`
       = help: parameters of `walkers`: `colour`, `count`, `crossing`, `crowd`, `curious`, `margin_m`,
               `pause`, `shares`, `speed`, `version`, `visits`
    "#);
}

#[test]
fn a_stage_without_parameters() {
    let text = complaint_about_people(
        r#"[stages.follow]
use = "expert"
inputs = { town = "town", target = "people" }
fast = true"#,
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-key]: `fast` is not a parameter of `expert`
      --> a.toml:11:1
       |
    11 | fast = true
       | ^^^^
       |
       = help: `expert` has no parameters
    "#);
}

#[test]
fn a_missing_parameter() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-missing-key]: `stages.town` has no `source`
     --> a.toml:2:9
      |
    2 | [stages.town]
      |         ^^^^
      |
      = help: `source`: The town's file
    "#);
}

#[test]
fn below_the_minimum() {
    let text = complaint_about_people(r#"margin_m = -0.2"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `margin_m` is `-0.2`; it must be at least `0`
     --> a.toml:8:12
      |
    8 | margin_m = -0.2
      |            ^^^^
      |
      = help: `margin_m`: Distance kept from obstacles (default `0.5`)
    "#);
}

#[test]
fn not_above_an_exclusive_minimum() {
    let text = complaint_about_people(r#"speed = { min_mps = 0 }"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `speed.min_mps` is `0`; it must be greater than `0`
     --> a.toml:8:21
      |
    8 | speed = { min_mps = 0 }
      |                     ^
      |
      = help: `speed.min_mps`: Slowest speed (default `0.5`)
    "#);
}

#[test]
fn above_the_maximum() {
    let text = complaint_about_people(
        r#"[stages.people.speed]
max_mps = 11"#,
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `speed.max_mps` is `11`; it must be at most `10`
     --> a.toml:9:11
      |
    9 | max_mps = 11
      |           ^^
      |
      = help: `speed.max_mps`: Fastest speed (default `2`)
    "#);
}

#[test]
fn a_string_where_a_number_is_wanted() {
    let text = complaint_about_people(r#"margin_m = "0.5""#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `margin_m` is the string `"0.5"`; it must be a number
     --> a.toml:8:12
      |
    8 | margin_m = "0.5"
      |            ^^^^^
      |
      = help: leave out the quotes: `0.5`
      = help: `margin_m`: Distance kept from obstacles (default `0.5`)
    "#);
}

#[test]
fn a_fraction_where_a_whole_number_is_wanted() {
    let text = complaint_about_people(r#"count = 2.5"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `count` is `2.5`; it must be a whole number
     --> a.toml:8:9
      |
    8 | count = 2.5
      |         ^^^
      |
      = help: `count`: Number of paths (default `4`)
    "#);
}

#[test]
fn a_number_where_a_table_is_wanted() {
    let text = complaint_about_people(r#"speed = 2"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `speed` is `2`, a whole number; it must be a table
     --> a.toml:8:9
      |
    8 | speed = 2
      |         ^
      |
      = help: `speed`: Walking speed
    "#);
}

#[test]
fn a_boolean_in_quotes() {
    let text = complaint_about_people(r#"curious = "true""#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `curious` is the string `"true"`; it must be `true` or `false`
     --> a.toml:8:11
      |
    8 | curious = "true"
      |           ^^^^^^
      |
      = help: leave out the quotes: `true`
      = help: `curious`: True for people who look around (default `false`)
    "#);
}

#[test]
fn a_number_where_a_string_is_wanted() {
    let text = complaint_about_people(r#"crowd = 5"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `crowd` is `5`, a whole number; it must be a string
     --> a.toml:8:9
      |
    8 | crowd = 5
      |         ^
      |
      = help: put it in quotes
      = help: `crowd`: Name of the crowd (default `"people"`)
    "#);
}

#[test]
fn an_empty_string() {
    let text = complaint_about_people(r#"crowd = """#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `crowd` is empty; it must not be
     --> a.toml:8:9
      |
    8 | crowd = ""
      |         ^^
      |
      = help: `crowd`: Name of the crowd (default `"people"`)
    "#);
}

#[test]
fn a_string_that_does_not_match() {
    let text = complaint_about_people(r#"version = "one""#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `version` is `"one"`; it must match `^[0-9]+\.[0-9]+$`
     --> a.toml:8:11
      |
    8 | version = "one"
      |           ^^^^^
      |
      = help: `version`: Version of the crowd, such as `1.0` (default `"1.0"`)
    "#);
}

#[test]
fn not_one_of_the_allowed_values() {
    let text = complaint_about_people(r#"crossing = "zebra""#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-not-allowed]: `crossing` is `zebra`; it must be one of `free`, `zebra_only`
     --> a.toml:8:12
      |
    8 | crossing = "zebra"
      |            ^^^^^^^
      |
      = help: did you mean `zebra_only`?
      = help: `crossing`: Places where streets are crossed (default `"free"`)
    "#);
}

#[test]
fn an_unknown_alternative() {
    let text = complaint_about_people(r#"pause = { kind = "randon", chance = 0.1 }"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-not-allowed]: `pause.kind` is `randon`; it must be one of `none`, `random`
     --> a.toml:8:18
      |
    8 | pause = { kind = "randon", chance = 0.1 }
      |                  ^^^^^^^^
      |
      = help: did you mean `random`?
    "#);
}

#[test]
fn an_alternative_without_its_tag() {
    let text = complaint_about_people(r#"pause = { chance = 0.1 }"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-missing-key]: `pause` has no `kind`
     --> a.toml:8:9
      |
    8 | pause = { chance = 0.1 }
      |         ^^^^^^^^^^^^^^^^
      |
      = help: `kind` is one of `none`, `random`
    "#);
}

#[test]
fn a_mistake_inside_an_alternative() {
    let text = complaint_about_people(r#"pause = { kind = "random", chance = 1.5 }"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `pause.chance` is `1.5`; it must be at least `0` and at most `1`
     --> a.toml:8:37
      |
    8 | pause = { kind = "random", chance = 1.5 }
      |                                     ^^^
      |
      = help: `pause.chance`: Chance of a stop per second
    "#);
}
