//! Messages about items that do not match.

use crate::toys::{WHOLE, complaint};

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
       = help: item `x` of `frames` reads item `x` of both: both must begin with the same items
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
       = help: items are named after the stages that they come through: give these chains stages of their
               own, or connect one of the two
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
    error[recipe-too-many-items]: `people` would have 2000000000 items; a stage may have at most 1000000
     --> a.toml:5:9
      |
    5 | [stages.people]
      |         ^^^^^^
      |
      = help: split the work into several recipes with other seeds
    "#);
}
