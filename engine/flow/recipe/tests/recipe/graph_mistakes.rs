//! Messages about stages that are not compatible: kinds, connections, cycles.

use crate::toys::complaint;

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
      = help: stage kinds: `blocks`, `dataset`, `expert`, `map`, `render`, `tracks`, `walkers`,
              `weathers`
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
      = help: this cosfly was built without plugins; the feature `plugins` adds them
      = help: built-in stage kinds: `blocks`, `dataset`, `expert`, `map`, `render`, `tracks`, `walkers`,
              `weathers`
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
      = help: inputs of `walkers`: `town`
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
    error[recipe-input-twice]: `inputs.town` of `people` takes one stage, and `other` is a second one
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
    error[recipe-missing-input]: `inputs.trajectories` of `frames` does not name a stage
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
    error[recipe-cycle]: stages read each other in a cycle: `a` reads `c`, `c` reads `b`, `b` reads `a`
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
       = help: connect one of them to a stage outside the cycle
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
