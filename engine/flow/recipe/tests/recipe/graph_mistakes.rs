//! What is said about stages that do not fit together: kinds, connections, cycles, items.

use crate::toys::{WHOLE, complaint};

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
      = help: there are `blocks`, `dataset`, `expert`, `map`, `render`, `tracks`, `walkers`
    "#);
}

#[test]
fn a_cosfly_without_plugins_says_so() {
    let text = complaint(
        r#"name = "t"
[stages.town]
use = "wasm:my_map.wasm"
source = "town.xodr"
"#,
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-kind]: there is no stage kind `wasm`
     --> a.toml:3:7
      |
    3 | use = "wasm:my_map.wasm"
      |       ^^^^^^^^^^^^^^^^^^
      |
      = help: this cosfly was built without plugins; its feature `plugins` adds them
      = help: its own kinds are `blocks`, `dataset`, `expert`, `map`, `render`, `tracks`, `walkers`
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
      = help: stage kinds that make `town/1`: `blocks`, `map`
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
      = help: stage kinds that make `town/1`: `blocks`, `map`
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
       = help: stage kinds that make `town/1`: `blocks`, `map`
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
    error[recipe-items-differ]: `inputs.trajectories` and `inputs.also` of `frames` have different
                                items: `two-path00000`, `two-path00001` only at `also`
      --> a.toml:20:42
       |
    20 | inputs = { trajectories = "one", also = ["one", "two"] }
       |                           -----          ^^^^^
       |                           |
       |                           `frames` has the items of this one
       |
       = help: item `x` of `frames` reads item `x` of both: both must go back to the same items
    "#);
}

#[test]
fn two_stages_with_items_of_one_id_are_not_gathered_together() {
    let text = WHOLE.replace(
        "[stages.tables]",
        "[stages.again]\nuse = \"render\"\ninputs.trajectories = [\"expert\", \"second\"]\n\n[stages.tables]",
    );
    let text = text.replace("inputs.frames = \"frames\"", "inputs.frames = [\"frames\", \"again\"]");
    insta::assert_snapshot!(complaint(&text, &[]), @r#"
    error[recipe-items-same]: `inputs.frames` of `tables.logs` gets an item `expert-path00000` from
                              `frames` and from `again`
      --> a.toml:32:18
       |
    32 | inputs.frames = ["frames", "again"]
       |                  ^^^^^^^^
       |
       = help: items are called after the stages that they come through: give these chains stages of
               their own, or connect one of the two
    "#);
}

#[test]
fn a_single_item_is_wanted_where_many_are_made() {
    let text = WHOLE.replace("use = \"map\"\nsource = \"town.xodr\"", "use = \"blocks\"");
    insta::assert_snapshot!(complaint(&text, &[]), @r#"
    error[recipe-items-differ]: `inputs.town` of `people` takes a single item, but `town` makes 2
     --> a.toml:9:15
      |
    9 | inputs.town = "town"
      |               ^^^^^^
      |
      = help: every item of `people` reads the same one: connect a stage that makes one
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
