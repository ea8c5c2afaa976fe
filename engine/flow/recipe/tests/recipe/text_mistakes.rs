//! Messages about invalid text, keys or names of a recipe.

use crate::toys::complaint;

#[test]
fn broken_toml_has_a_caret() {
    let text = complaint(
        r#"name = "t"
[stages.town
use = "map"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-syntax]: unclosed table, expected `]`
     --> a.toml:2:13
      |
    2 | [stages.town
      |             ^
    "#);
}

#[test]
fn a_key_given_twice_is_refused() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
source = "other.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-syntax]: `source` is given twice
     --> a.toml:5:1
      |
    4 | source = "town.xodr"
      | ------ first here
    5 | source = "other.xodr"
      | ^^^^^^
    "#);
}

#[test]
fn a_table_given_twice_is_refused() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.town]
use = "map"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-syntax]: `town` is given twice
     --> a.toml:5:9
      |
    2 | [stages.town]
      |         ---- first here
    ...
    5 | [stages.town]
      |         ^^^^
    "#);
}

#[test]
fn no_name_and_no_stages() {
    let text = complaint(
        r#"seed = 3
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-missing-key]: the recipe has no `name`
     --> a.toml:1:1
      |
    1 | seed = 3
      | ^
      |
      = help: begin it with a line such as `name = "carla_town"`

    error[recipe-no-stages]: the recipe has no stages
     --> a.toml:1:1
      |
    1 | seed = 3
      | ^
      |
      = help: write one table per stage, such as `[stages.town]` with `use = "map"`

    2 errors
    "#);
}

#[test]
fn an_empty_stages_table() {
    let text = complaint(
        r#"name = "t"
[stages]
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-no-stages]: the recipe has no stages
     --> a.toml:2:2
      |
    2 | [stages]
      |  ^^^^^^
      |
      = help: write one table per stage, such as `[stages.town]` with `use = "map"`
    "#);
}

#[test]
fn a_name_with_capitals_and_a_negative_seed() {
    let text = complaint(
        r#"name = "My Town"
seed = -1
[stages.town]
use = "map"
source = "town.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-name]: `name` is `My Town`; it must be 1 to 100 of `a-z`, `0-9`, `_` and `-`
     --> a.toml:1:8
      |
    1 | name = "My Town"
      |        ^^^^^^^^^
      |
      = help: the dataset and its folder have this name

    error[recipe-out-of-range]: `seed` is `-1`; it must be at least `0`
     --> a.toml:2:8
      |
    2 | seed = -1
      |        ^^

    2 errors
    "#);
}

#[test]
fn unknown_top_level_keys() {
    let text = complaint(
        r#"sede = 4
name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[town2]
use = "map"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-key]: `sede` is not a key of recipes
     --> a.toml:1:1
      |
    1 | sede = 4
      | ^^^^
      |
      = help: did you mean `seed`?
      = help: a recipe has `name`, `seed`, `intermediates`, `for_each`, `stages`, `tool`

    error[recipe-unknown-key]: `town2` is not a key of recipes
     --> a.toml:6:2
      |
    6 | [town2]
      |  ^^^^^
      |
      = help: did you mean `[stages.town2]`?
      = help: a recipe has `name`, `seed`, `intermediates`, `for_each`, `stages`, `tool`

    2 errors
    "#);
}

#[test]
fn a_stage_without_use() {
    let text = complaint(
        r#"name = "t"
[stages.town]
source = "town.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-missing-key]: stage `town` has no `use`
     --> a.toml:2:9
      |
    2 | [stages.town]
      |         ^^^^
      |
      = help: add a line such as `use = "map"`
    "#);
}

#[test]
fn a_stage_name_with_a_hyphen() {
    let text = complaint(
        r#"name = "t"
[stages.my-town]
use = "map"
source = "town.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-name]: a stage is named `my-town`; names are one of `a-z`, then at most 99 of `a-z`,
                        `0-9` and `_`
     --> a.toml:2:9
      |
    2 | [stages.my-town]
      |         ^^^^^^^
    "#);
}

#[test]
fn a_stage_that_is_not_a_table() {
    let text = complaint(
        r#"name = "t"
stages.town = "map"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `stages.town` is a string; it must be a table
     --> a.toml:2:15
      |
    2 | stages.town = "map"
      |               ^^^^^
    "#);
}

#[test]
fn use_and_inputs_of_the_wrong_type() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = 3
inputs = "town"
[stages.more]
use = "walkers"
inputs.town = 4
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `stages.people.use` is a whole number; it must be a string
     --> a.toml:6:7
      |
    6 | use = 3
      |       ^
      |
      = help: put it in quotes

    error[recipe-wrong-type]: `stages.people.inputs` is a string; it must be a table
     --> a.toml:7:10
      |
    7 | inputs = "town"
      |          ^^^^^^
      |
      = help: write `inputs.PORT = "STAGE"`

    error[recipe-wrong-type]: `stages.more.inputs.town` is a whole number; it must be the name of a
                              stage or a list of names
      --> a.toml:10:15
       |
    10 | inputs.town = 4
       |               ^

    3 errors
    "#);
}

#[test]
fn many_mistakes_at_once_in_the_order_of_the_text() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = 3
[stages.people]
use = "walkers"
inputs.town = "twon"
count = 0
[stages.frames]
use = "rendr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `source` is `3`, a whole number; it must be a string
     --> a.toml:4:10
      |
    4 | source = 3
      |          ^
      |
      = help: put it in quotes
      = help: `source`: The town's file

    error[recipe-unknown-stage]: `people` reads `twon`, but the recipe has no such stage
     --> a.toml:7:15
      |
    7 | inputs.town = "twon"
      |               ^^^^^^
      |
      = help: did you mean `town`?
      = help: other stages of the recipe: `town`, `frames`

    error[recipe-out-of-range]: `count` is `0`; it must be at least `1`
     --> a.toml:8:9
      |
    8 | count = 0
      |         ^
      |
      = help: `count`: Number of paths (default `4`)

    error[recipe-unknown-kind]: there is no stage kind `rendr`
      --> a.toml:10:7
       |
    10 | use = "rendr"
       |       ^^^^^^^
       |
       = help: did you mean `render`?
       = help: stage kinds: `blocks`, `dataset`, `expert`, `map`, `render`, `tracks`, `walkers`,
               `weathers`

    4 errors
    "#);
}
