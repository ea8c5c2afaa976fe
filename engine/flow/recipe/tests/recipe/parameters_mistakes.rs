//! What is said about a stage's parameters that its kind does not allow.

use crate::toys::complaint;

/// The lines before those that a test adds.
const START: &str = r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = "town"
"#;

fn check_complaint(more: &str) -> String {
    complaint(&format!("{START}{more}"), &[])
}

#[test]
fn an_unknown_key_names_the_nearest() {
    let text = check_complaint(r#"margin = 0.3"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-key]: `margin` is not a parameter of `walkers`
     --> a.toml:8:1
      |
    8 | margin = 0.3
      | ^^^^^^
      |
      = help: did you mean `margin_m`?
      = help: `walkers` knows `colour`, `count`, `crossing`, `crowd`, `curious`, `margin_m`, `pause`,
              `shares`, `speed`, `version`, `visits`
    "#);
}

#[test]
fn an_unknown_nested_key() {
    let text = check_complaint(r#"speed.max = 3"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-key]: `max` is not a parameter of `speed` of `walkers`
     --> a.toml:8:7
      |
    8 | speed.max = 3
      |       ^^^
      |
      = help: did you mean `max_mps`?
      = help: `speed` of `walkers` knows `max_mps`, `min_mps`
    "#);
}

#[test]
fn an_input_written_as_a_parameter() {
    let text = check_complaint(
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
       = help: `walkers` knows `colour`, `count`, `crossing`, `crowd`, `curious`, `margin_m`, `pause`,
               `shares`, `speed`, `version`, `visits`
    "#);
}

#[test]
fn a_stage_without_parameters() {
    let text = check_complaint(
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
    let text = check_complaint(r#"margin_m = -0.2"#);
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
    let text = check_complaint(r#"speed = { min_mps = 0 }"#);
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
    let text = check_complaint(
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
    let text = check_complaint(r#"margin_m = "0.5""#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `margin_m` is the string `"0.5"`; it must be a number
     --> a.toml:8:12
      |
    8 | margin_m = "0.5"
      |            ^^^^^
      |
      = help: leave the quotes away: `0.5`
      = help: `margin_m`: Distance kept from obstacles (default `0.5`)
    "#);
}

#[test]
fn a_fraction_where_a_whole_number_is_wanted() {
    let text = check_complaint(r#"count = 2.5"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `count` is `2.5`; it must be a whole number
     --> a.toml:8:9
      |
    8 | count = 2.5
      |         ^^^
      |
      = help: `count`: How many paths (default `4`)
    "#);
}

#[test]
fn a_number_where_a_table_is_wanted() {
    let text = check_complaint(r#"speed = 2"#);
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
    let text = check_complaint(r#"curious = "true""#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `curious` is the string `"true"`; it must be `true` or `false`
     --> a.toml:8:11
      |
    8 | curious = "true"
      |           ^^^^^^
      |
      = help: leave the quotes away: `true`
      = help: `curious`: Whether they look around (default `false`)
    "#);
}

#[test]
fn a_number_where_a_string_is_wanted() {
    let text = check_complaint(r#"crowd = 5"#);
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
    let text = check_complaint(r#"crowd = """#);
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
    let text = check_complaint(r#"version = "one""#);
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
fn a_mistake_inside_a_map() {
    let text = check_complaint(r#"shares = { old = 0.2, young = "rest" }"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `shares.young` is the string `"rest"`; it must be a number
     --> a.toml:8:31
      |
    8 | shares = { old = 0.2, young = "rest" }
      |                               ^^^^^^
    "#);
}

#[test]
fn not_one_of_the_allowed_values() {
    let text = check_complaint(r#"crossing = "zebra""#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-not-allowed]: `crossing` is `zebra`; it must be one of `free`, `zebra_only`
     --> a.toml:8:12
      |
    8 | crossing = "zebra"
      |            ^^^^^^^
      |
      = help: did you mean `zebra_only`?
      = help: `crossing`: How streets are crossed (default `"free"`)
    "#);
}

#[test]
fn an_unknown_alternative() {
    let text = check_complaint(r#"pause = { kind = "randon", chance = 0.1 }"#);
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
    let text = check_complaint(r#"pause = { chance = 0.1 }"#);
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
    let text = check_complaint(r#"pause = { kind = "random", chance = 1.5 }"#);
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

#[test]
fn a_list_of_the_wrong_length() {
    let text = check_complaint(r#"colour = [1, 2]"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `colour` has 2 entries; it must have exactly 3
     --> a.toml:8:10
      |
    8 | colour = [1, 2]
      |          ^^^^^^
      |
      = help: `colour`: A colour as red, green, blue
    "#);
}

#[test]
fn an_entry_beyond_its_type() {
    let text = check_complaint(r#"colour = [1, 2, 256]"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `colour.2` is `256`; it must be at least `0` and at most `255`
     --> a.toml:8:17
      |
    8 | colour = [1, 2, 256]
      |                 ^^^
    "#);
}

#[test]
fn a_mistake_inside_a_list_of_tables() {
    let text = check_complaint(r#"visits = [{ min_mps = 1 }, { min_mps = -1 }]"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `visits.1.min_mps` is `-1`; it must be greater than `0`
     --> a.toml:8:40
      |
    8 | visits = [{ min_mps = 1 }, { min_mps = -1 }]
      |                                        ^^
      |
      = help: `visits.1.min_mps`: Slowest speed (default `0.5`)
    "#);
}

#[test]
fn too_many_entries() {
    let text = check_complaint(r#"visits = [{}, {}, {}, {}]"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `visits` has 4 entries; it must have at most 3
     --> a.toml:8:10
      |
    8 | visits = [{}, {}, {}, {}]
      |          ^^^^^^^^^^^^^^^^
      |
      = help: `visits`: Waypoints that every path visits (default `[]`)
    "#);
}

#[test]
fn a_rule_between_parameters() {
    let text = check_complaint(r#"speed = { min_mps = 3, max_mps = 2 }"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-parameter]: `speed.min_mps` is `3`, above `speed.max_mps`, which is `2`
     --> a.toml:8:21
      |
    8 | speed = { min_mps = 3, max_mps = 2 }
      |                     ^
      |
      = help: lower it or raise `speed.max_mps`
    "#);
}

#[test]
fn numbers_must_be_finite() {
    let text = check_complaint(
        r#"margin_m = nan
speed.max_mps = inf"#,
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-not-finite]: `stages.people.margin_m` is `nan`; numbers must be finite
     --> a.toml:8:12
      |
    8 | margin_m = nan
      |            ^^^

    error[recipe-not-finite]: `stages.people.speed.max_mps` is `inf`; numbers must be finite
     --> a.toml:9:17
      |
    9 | speed.max_mps = inf
      |                 ^^^

    2 errors
    "#);
}

#[test]
fn a_number_of_more_than_64_bits() {
    let text = check_complaint(r#"count = 99999999999999999999"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `stages.people.count` is `99999999999999999999`; whole numbers have 64
                                bits and a sign
     --> a.toml:8:9
      |
    8 | count = 99999999999999999999
      |         ^^^^^^^^^^^^^^^^^^^^
    "#);
}

#[test]
fn a_date() {
    let text = check_complaint(r#"crowd = 2026-01-01"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `stages.people.crowd` is a date; recipes have no dates
     --> a.toml:8:9
      |
    8 | crowd = 2026-01-01
      |         ^^^^^^^^^^
      |
      = help: put it in quotes
    "#);
}

#[test]
fn tables_nested_too_deep() {
    let text = check_complaint(&format!("crowd = {}{}\n", "[ ".repeat(40), "]".repeat(40)));
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `crowd` is a list; it must be a string
     --> a.toml:8:9
      |
    8 | ... = [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ ]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]
      |       ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
      |
      = help: `crowd`: Name of the crowd (default `"people"`)

    error[recipe-too-deep]: tables and lists are nested more than 32 deep
     --> a.toml:8:69
      |
    8 | ...[ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ [ ]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]
      |                                  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^

    2 errors
    "#);
}
