//! What is said about a recipe whose text, names, graph, items or files are wrong.

mod toys;

use toys::complaint;

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
      = help: the dataset and its folder are called by it

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
      = help: a recipe has `name`, `seed`, `stages`

    error[recipe-unknown-key]: `town2` is not a key of recipes
     --> a.toml:6:2
      |
    6 | [town2]
      |  ^^^^^
      |
      = help: did you mean `[stages.town2]`?
      = help: a recipe has `name`, `seed`, `stages`

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
    error[recipe-missing-key]: stage `town` does not say what it uses
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
    error[recipe-name]: a stage is called `my-town`; names begin with `a-z` and go on with at most 99 of
                        `a-z`, `0-9` and `_`
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
fn an_unknown_kind_names_the_nearest() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "mapp"
source = "town.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-kind]: there is no stage kind `mapp`
     --> a.toml:3:7
      |
    3 | use = "mapp"
      |       ^^^^^^
      |
      = help: did you mean `map`?
      = help: there are `dataset`, `expert`, `map`, `render`, `walkers`
    "#);
}

#[test]
fn plugins_come_later() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "wasm:my_map.wasm"
source = "town.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-kind]: there is no stage kind `wasm:my_map.wasm`
     --> a.toml:3:7
      |
    3 | use = "wasm:my_map.wasm"
      |       ^^^^^^^^^^^^^^^^^^
      |
      = help: this version of cosfly runs no plugins yet: `use = "wasm:..."` comes with a later one
      = help: its own kinds are `dataset`, `expert`, `map`, `render`, `walkers`
    "#);
}

#[test]
fn an_unknown_stage_names_the_nearest() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = "twon"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-stage]: `people` reads `twon`, but the recipe has no such stage
     --> a.toml:7:15
      |
    7 | inputs.town = "twon"
      |               ^^^^^^
      |
      = help: did you mean `town`?
      = help: other stages of the recipe: `town`
    "#);
}

#[test]
fn an_unknown_port_names_the_nearest() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.twon = "town"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-port]: `twon` is not an input of `walkers`
     --> a.toml:7:8
      |
    7 | inputs.twon = "town"
      |        ^^^^
      |
      = help: did you mean `town`?
      = help: `walkers` has `town`
    "#);
}

#[test]
fn a_missing_input_says_what_to_write() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-missing-input]: `people` needs `inputs.town` (The town, `town/1`)
     --> a.toml:5:9
      |
    5 | [stages.people]
      |         ^^^^^^
      |
      = help: write `inputs.town = "town"` in `[stages.people]`
      = help: stage kinds that make `town/1`: `map`
    "#);
}

#[test]
fn a_missing_input_that_nothing_makes() {
    let text = complaint(
        r#"name = "t"
[stages.people]
use = "walkers"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-missing-input]: `people` needs `inputs.town` (The town, `town/1`)
     --> a.toml:2:9
      |
    2 | [stages.people]
      |         ^^^^^^
      |
      = help: stage kinds that make `town/1`: `map`
    "#);
}

#[test]
fn an_input_connected_twice() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = ["town", "town"]
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-input-twice]: `town` is connected twice to `inputs.town` of `people`
     --> a.toml:7:24
      |
    7 | inputs.town = ["town", "town"]
      |                        ^^^^^^
      |
      = help: name it once
    "#);
}

#[test]
fn two_stages_on_a_port_for_one() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = ["town", "other"]
[stages.other]
use = "map"
source = "town.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-input-twice]: `inputs.town` of `people` takes one stage; `other` is one more
     --> a.toml:7:24
      |
    7 | inputs.town = ["town", "other"]
      |                        ^^^^^^^
      |
      = help: connect one of them
    "#);
}

#[test]
fn an_empty_list_of_stages() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = "town"
[stages.frames]
use = "render"
inputs.trajectories = []
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-missing-input]: `inputs.trajectories` of `frames` names no stage
      --> a.toml:10:8
       |
    10 | inputs.trajectories = []
       |        ^^^^^^^^^^^^
       |
       = help: stage kinds that make `trajectory/1`: `expert`
    "#);
}

#[test]
fn an_artifact_that_does_not_fit() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = "town"
[stages.follow]
use = "expert"
inputs.town = "people"
inputs.target = "people"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-artifact-mismatch]: `inputs.town` of `follow` takes `town/1`, but `people` makes
                                     `track/1`
      --> a.toml:10:15
       |
    10 | inputs.town = "people"
       |               ^^^^^^^^
       |
       = help: write `inputs.town = "town"` in `[stages.follow]`
       = help: stage kinds that make `town/1`: `map`
    "#);
}

#[test]
fn a_cycle_names_all_its_stages() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.a]
use = "expert"
inputs = { town = "town", target = "c" }
[stages.b]
use = "expert"
inputs = { town = "town", target = "a" }
[stages.c]
use = "expert"
inputs = { town = "town", target = "b" }
[stages.after]
use = "render"
inputs.trajectories = ["c"]
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-cycle]: stages wait for each other in a circle: `a` reads `c`, `c` reads `b`, `b` reads
                         `a`
      --> a.toml:7:36
       |
     7 | inputs = { town = "town", target = "c" }
       |                                    ^^^ `a` reads it
    ...
    10 | inputs = { town = "town", target = "a" }
       |                                    --- `b` reads it
    ...
    13 | inputs = { town = "town", target = "b" }
       |                                    --- `c` reads it
       |
       = help: connect one of them to a stage outside the circle
    "#);
}

#[test]
fn a_stage_that_reads_itself() {
    let text = complaint(
        r#"name = "t"
[stages.a]
use = "render"
inputs.trajectories = "a"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-cycle]: stage `a` reads itself
     --> a.toml:4:23
      |
    4 | inputs.trajectories = "a"
      |                       ^^^ `a` reads it
      |
      = help: connect it to another stage
    "#);
}

#[test]
fn items_that_do_not_meet() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = "town"
[stages.fewer]
use = "walkers"
inputs.town = "town"
count = 2
[stages.one]
use = "expert"
inputs = { town = "town", target = "people" }
[stages.two]
use = "expert"
inputs = { town = "town", target = "fewer" }
[stages.frames]
use = "render"
inputs = { trajectories = "one", also = ["one", "two"] }
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-items-differ]: the items of `inputs.also` of `frames` are not those of
                                `inputs.trajectories`: it has `two-path00000`, `two-path00001` beyond
                                them
      --> a.toml:20:42
       |
    20 | inputs = { trajectories = "one", also = ["one", "two"] }
       |                           -----          ^^^^^
       |                           |
       |                           the items come from here
       |
       = help: item `x` of the stage reads item `x` of both: both must come from the same stages
    "#);
}

#[test]
fn too_many_items() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "town.xodr"
[stages.people]
use = "walkers"
inputs.town = "town"
count = 2_000_000_000
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-too-many-items]: `people` would have 2000000000 items; a stage may have 1000000
     --> a.toml:5:9
      |
    5 | [stages.people]
      |         ^^^^^^
      |
      = help: split the work into several recipes with other seeds
    "#);
}

#[test]
fn a_missing_file_names_the_nearest() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "twon.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[input-missing]: there is no file `twon.xodr`
     --> a.toml:4:10
      |
    4 | source = "twon.xodr"
      |          ^^^^^^^^^^^
      |
      = help: did you mean `town.xodr`?
      = help: paths in a recipe begin at the recipe's folder, here `FOLDER`
    "#);
}

#[test]
fn a_missing_folder() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "towns/town.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[input-missing]: there is no file `towns/town.xodr`
     --> a.toml:4:10
      |
    4 | source = "towns/town.xodr"
      |          ^^^^^^^^^^^^^^^^^
      |
      = help: there is no folder `towns`
      = help: paths in a recipe begin at the recipe's folder, here `FOLDER`
    "#);
}

#[test]
fn a_folder_instead_of_a_file() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "map"
source = "folder"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[input-missing]: `folder` is a folder; a file is wanted
     --> a.toml:4:10
      |
    4 | source = "folder"
      |          ^^^^^^^^
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
      = help: `count`: How many paths (default `4`)

    error[recipe-unknown-kind]: there is no stage kind `rendr`
      --> a.toml:10:7
       |
    10 | use = "rendr"
       |       ^^^^^^^
       |
       = help: did you mean `render`?
       = help: there are `dataset`, `expert`, `map`, `render`, `walkers`

    4 errors
    "#);
}
