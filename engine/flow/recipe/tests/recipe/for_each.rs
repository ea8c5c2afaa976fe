//! Stages that are written once and made for every value of a list.

use crate::toys::{check, complaint};
use cosfly_recipe::Recipe;

const TOWNS: &str = r#"name = "towns"
[for_each]
town = [
  { name = "A", source = "town.xodr", walks = 2 },
  { name = "B", source = "town.xodr", walks = 3 },
]
pace = [0.5, 1]

[stages.town]
use = "map"
for_each = "town"
source = "{town.source}"

[stages.people]
use = "walkers"
for_each = "town"
inputs.town = "town"
count = "{town.walks}"

[stages.fast]
use = "walkers"
for_each = ["town", "pace"]
inputs.town = "town"
speed.min_mps = "{pace}"

[stages.expert]
use = "expert"
for_each = "town"
inputs = { town = "town", target = "people" }

[stages.runner]
use = "expert"
for_each = ["pace", "town"]
inputs = { town = "town", target = "fast" }

[stages.frames]
use = "render"
inputs.trajectories = ["expert", "runner"]
"#;

const BY_HAND: &str = r#"name = "towns"
[stages.town_a]
use = "map"
source = "town.xodr"
[stages.town_b]
use = "map"
source = "town.xodr"

[stages.people_a]
use = "walkers"
inputs.town = "town_a"
count = 2
[stages.people_b]
use = "walkers"
inputs.town = "town_b"
count = 3

[stages.fast_a_0_5]
use = "walkers"
inputs.town = "town_a"
speed.min_mps = 0.5
[stages.fast_a_1]
use = "walkers"
inputs.town = "town_a"
speed.min_mps = 1
[stages.fast_b_0_5]
use = "walkers"
inputs.town = "town_b"
speed.min_mps = 0.5
[stages.fast_b_1]
use = "walkers"
inputs.town = "town_b"
speed.min_mps = 1

[stages.expert_a]
use = "expert"
inputs = { town = "town_a", target = "people_a" }
[stages.expert_b]
use = "expert"
inputs = { town = "town_b", target = "people_b" }

[stages.runner_0_5_a]
use = "expert"
inputs = { town = "town_a", target = "fast_a_0_5" }
[stages.runner_0_5_b]
use = "expert"
inputs = { town = "town_b", target = "fast_b_0_5" }
[stages.runner_1_a]
use = "expert"
inputs = { town = "town_a", target = "fast_a_1" }
[stages.runner_1_b]
use = "expert"
inputs = { town = "town_b", target = "fast_b_1" }

[stages.frames]
use = "render"
inputs.trajectories = ["expert_a", "expert_b", "runner_0_5_a", "runner_0_5_b", "runner_1_a", "runner_1_b"]
"#;

/// Stages with everything that a run depends on.
fn described(recipe: &Recipe) -> Vec<String> {
    let describe = |stage: &cosfly_recipe::RecipeStage| {
        let reads = stage.connections.iter().map(|it| format!("{} {:?}", it.port.name, it.arrivals));
        let reads: Vec<String> = reads.collect();
        let items: Vec<String> = stage.items.iter().map(ToString::to_string).collect();
        format!("{} {} {items:?} {reads:?} {}", stage.name, stage.kind, stage.parameters)
    };
    recipe.stages.iter().map(describe).collect()
}

fn read(text: &str, overrides: &[&str]) -> Recipe {
    check(text, overrides).unwrap_or_else(|_| panic!("{}", complaint(text, overrides)))
}

#[test]
fn stages_of_lists_are_those_that_one_would_write_by_hand() {
    let made = read(TOWNS, &[]);
    assert_eq!(described(&made), described(&read(BY_HAND, &[])));
    assert_eq!(made.stages.len(), 2 + 2 + 4 + 2 + 4 + 1);
}

#[test]
fn a_pattern_makes_a_stage_for_each_file_with_fields_of_the_list() {
    let text = r#"name = "t"
[for_each]
town = { files = "*.xodr", walks = 4 }
[stages.map]
use = "map"
for_each = "town"
source = "{town.file}"
[stages.people]
use = "walkers"
for_each = "town"
inputs.town = "map"
count = "{town.walks}"
"#;
    let recipe = read(text, &[]);
    assert_eq!(recipe.position("people_town").map(|at| recipe.stages[at].items.len()), Some(4));
    let recipe = read(text, &["for_each.town.walks=7"]);
    assert_eq!(recipe.stages[1].items.len(), 7);
    // A pattern alone: the value is the path.
    let alone = text.replace("{ files = \"*.xodr\", walks = 4 }", "\"t*.xodr\"");
    let alone = alone.replace("{town.file}", "{town}").replace("\"{town.walks}\"", "2");
    assert_eq!(read(&alone, &[]).stages[0].parameters["source"], "town.xodr");
}

#[test]
fn overrides_reach_the_stage_as_it_is_written() {
    let recipe = read(TOWNS, &["stages.people.count=9"]);
    let count = |name: &str| recipe.stages[recipe.position(name).unwrap()].items.len();
    assert_eq!((count("people_a"), count("people_b")), (9, 9));
}

#[test]
fn overrides_reach_a_field_of_one_value_of_a_list() {
    let recipe = read(TOWNS, &["for_each.town.1.walks=5", "for_each.pace.0=0.75"]);
    let count = |name: &str| recipe.stages[recipe.position(name).unwrap()].items.len();
    assert_eq!((count("people_a"), count("people_b")), (2, 5));
    assert!(recipe.position("fast_a_0_75").is_some());
    let text = complaint(TOWNS, &["for_each.town.2.walks=5"]);
    assert!(text.starts_with("error[override-syntax]: `for_each.town` is a list; it has no `2`"), "{text}");
}

#[test]
fn a_mistake_in_a_stage_of_a_list_is_told_once() {
    let text = complaint(
        &TOWNS.replace("use = \"expert\"\nfor_each = \"town\"", "use = \"expret\"\nfor_each = \"town\""),
        &[],
    );
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-kind]: there is no stage kind `expret`
      --> a.toml:27:7
       |
    27 | use = "expret"
       |       ^^^^^^^^
       |
       = help: did you mean `expert`?
       = help: stage kinds: `blocks`, `dataset`, `expert`, `map`, `render`, `tracks`, `walkers`,
               `weathers`
    "#);
}

#[test]
fn a_value_is_refused_at_its_place_in_the_list() {
    insta::assert_snapshot!(complaint(&TOWNS.replace("walks = 3", "walks = 0"), &[]), @r#"
    error[recipe-out-of-range]: `count` is `0`; it must be at least `1`
     --> a.toml:5:47
      |
    5 |   { name = "B", source = "town.xodr", walks = 0 },
      |                                               ^
      |
      = help: `count`: Number of paths (default `4`)
    "#);
}

#[test]
fn lists_that_are_not_there_or_not_used() {
    let text = TOWNS
        .replace("for_each = [\"town\", \"pace\"]", "for_each = \"twon\"")
        .replace("[\"pace\", \"town\"]", "\"town\"");
    insta::assert_snapshot!(complaint(&text, &[]), @r#"
    error[recipe-unused-list]: no stage is made for each `pace`
     --> a.toml:7:1
      |
    7 | pace = [0.5, 1]
      | ^^^^
      |
      = help: write `for_each = "pace"` in a stage, or remove the list

    error[recipe-unknown-list]: `[for_each]` has no list `twon`
      --> a.toml:22:12
       |
    22 | for_each = "twon"
       |            ^^^^^^
       |
       = help: did you mean `town`?

    2 errors
    "#);
    insta::assert_snapshot!(complaint("name = \"t\"\n[stages.town]\nuse = \"map\"\nfor_each = \"town\"\nsource = \"town.xodr\"\n", &[]), @r#"
    error[recipe-unknown-list]: `[for_each]` has no list `town`
     --> a.toml:4:12
      |
    4 | for_each = "town"
      |            ^^^^^^
      |
      = help: write the list: `[for_each]` with `town = ["FIRST", "SECOND"]`
    "#);
}

#[test]
fn values_without_a_name_twice_or_without_a_field() {
    insta::assert_snapshot!(complaint(&TOWNS.replace("name = \"B\"", "name = \"a\"").replace("pace = [0.5, 1]", "pace = [{ v = 1 }, 1]"), &[]), @r#"
    error[recipe-list-value]: two values of `for_each.town` are called `a`
     --> a.toml:5:3
      |
    5 |   { name = "a", source = "town.xodr", walks = 3 },
      |   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
      |
      = help: write them as tables with a `name` each: `{ name = "a", file = "..." }`

    error[recipe-list-value]: a value of `for_each.pace` has no name for its stages
     --> a.toml:7:9
      |
    7 | pace = [{ v = 1 }, 1]
      |         ^^^^^^^^^
      |
      = help: write it as a table with a name: `{ name = "a", source = "..." }`; names are `a-z`, `0-9`,
              `_`, at most 60

    2 errors
    "#);
    insta::assert_snapshot!(complaint(&TOWNS.replace(", walks = 3", ""), &[]), @r#"
    error[recipe-list-value]: `b` of the list `town` has no `walks`
      --> a.toml:5:3
       |
     5 |   { name = "B", source = "town.xodr" },
       |   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ...
    18 | count = "{town.walks}"
       |         -------------- `{town.walks}` is read here
       |
       = help: its fields are `name`, `source`
    "#);
    insta::assert_snapshot!(complaint(&TOWNS.replace("{town.walks}", "{town.wlaks}"), &[]), @r#"
    error[recipe-list-value]: `a` of the list `town` has no `wlaks`
      --> a.toml:4:3
       |
     4 |   { name = "A", source = "town.xodr", walks = 2 },
       |   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ...
    18 | count = "{town.wlaks}"
       |         -------------- `{town.wlaks}` is read here
       |
       = help: did you mean `walks`?

    error[recipe-list-value]: `b` of the list `town` has no `wlaks`
      --> a.toml:5:3
       |
     5 |   { name = "B", source = "town.xodr", walks = 3 },
       |   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ...
    18 | count = "{town.wlaks}"
       |         -------------- `{town.wlaks}` is read here
       |
       = help: did you mean `walks`?

    2 errors
    "#);
    insta::assert_snapshot!(complaint(&TOWNS.replace("{town.walks}", "{town}"), &[]), @r#"
    error[recipe-list-value]: `{town}` is a table
      --> a.toml:18:9
       |
    18 | count = "{town}"
       |         ^^^^^^^^
       |
       = help: write one of `{town.name}`, `{town.source}`, `{town.walks}`
    "#);
}

#[test]
fn placeholders_of_lists_that_the_stage_is_not_made_for() {
    let text = TOWNS.replace("for_each = \"town\"\nsource = \"{town.source}\"", "source = \"{town.source}\"");
    insta::assert_snapshot!(complaint(&text, &[]), @r#"
    error[recipe-unknown-list]: `{town.source}` is a value of the list `town`, but the stage is not made
                                for each of them
      --> a.toml:11:10
       |
    11 | source = "{town.source}"
       |          ^^^^^^^^^^^^^^^
       |
       = help: add `for_each = "town"` to the stage
    "#);
}

#[test]
fn wrong_types_and_patterns() {
    let of = |list: &str| {
        complaint(
            &format!(
                "name = \"t\"\n[for_each]\ntown = {list}\n[stages.town]\nuse = \"map\"\nfor_each = \"town\"\nsource = \"town.xodr\"\n"
            ),
            &[],
        )
    };
    insta::assert_snapshot!(of("3"), @r#"
    error[recipe-wrong-type]: `for_each.town` is a whole number; it must be a list, or a pattern of
                              files
     --> a.toml:3:8
      |
    3 | town = 3
      |        ^
      |
      = help: write `town = [1, 2, 3]`, `town = "towns/*.xodr"` or `town = { files = "towns/*.xodr",
              walks = 50 }`
    "#);
    insta::assert_snapshot!(of("[]"), @r#"
    error[recipe-empty-list]: `for_each.town` is empty
     --> a.toml:3:8
      |
    3 | town = []
      |        ^^
      |
      = help: a list has at least one value
    "#);
    insta::assert_snapshot!(of("\"maps/*.xodr\""), @r#"
    error[input-missing]: no file matches `maps/*.xodr`
     --> a.toml:3:8
      |
    3 | town = "maps/*.xodr"
      |        ^^^^^^^^^^^^^
      |
      = help: patterns are relative to the recipe's folder, here `FOLDER`; `*` is any part of a name,
              `**` any folders
    "#);
    insta::assert_snapshot!(of("\"a***\""), @r#"
    error[recipe-pattern]: `a***` is not a pattern of files
     --> a.toml:3:8
      |
    3 | town = "a***"
      |        ^^^^^^
      |
      = because: wildcards are either regular `*` or recursive `**`
    "#);
    insta::assert_snapshot!(of("[[1], 2]"), @r#"
    error[recipe-list-value]: a value of `for_each.town` has no name for its stages
     --> a.toml:3:9
      |
    3 | town = [[1], 2]
      |         ^^^
      |
      = help: write it as a table with a name: `{ name = "a", source = "..." }`; names are `a-z`, `0-9`,
              `_`, at most 60
    "#);
    insta::assert_snapshot!(complaint("name = \"t\"\nfor_each = 3\n[stages.town]\nuse = \"map\"\nsource = \"town.xodr\"\n", &[]), @r#"
    error[recipe-wrong-type]: `for_each` is a whole number; it must be a table of lists
     --> a.toml:2:12
      |
    2 | for_each = 3
      |            ^
      |
      = help: write `[for_each]` and lists such as `town = ["towns/a.xodr", "towns/b.xodr"]`; stages
              name the list
    "#);
    insta::assert_snapshot!(complaint(&TOWNS.replace("for_each = \"town\"\nsource", "for_each = 3\nsource"), &[]), @r#"
    error[recipe-wrong-type]: `stages.town.for_each` holds a whole number; it names lists
      --> a.toml:11:12
       |
    11 | for_each = 3
       |            ^
       |
       = help: write `for_each = "town"`, or `["town", "weather"]` for two lists
    "#);
}

#[test]
fn too_many_stages_and_names_that_are_taken() {
    let many = format!("[{}]", (0..101).map(|it| it.to_string()).collect::<Vec<_>>().join(", "));
    let text = format!(
        "name = \"t\"\n[for_each]\na = {many}\nb = {many}\n[stages.town]\nuse = \"blocks\"\nfor_each = [\"a\", \"b\"]\n"
    );
    insta::assert_snapshot!(complaint(&text, &[]).lines().next().unwrap(), @"error[recipe-too-many-stages]: the lists make 10201 stages; a recipe may have 10000");
    let taken = "name = \"t\"\n[for_each]\na = [1]\n[stages.town]\nuse = \"blocks\"\nfor_each = \"a\"\n[stages.town_1]\nuse = \"blocks\"\n";
    insta::assert_snapshot!(complaint(taken, &[]), @r#"
    error[recipe-name]: `town_1` and `town` both make a stage `town_1`
     --> a.toml:7:9
      |
    7 | [stages.town_1]
      |         ^^^^^^
      |
      = help: rename one of them
    "#);
}

#[test]
fn a_field_that_no_stage_reads_is_a_mistake() {
    let text = TOWNS.replace("walks = 3 }", "walks = 3, walk = 9, note = \"x\" }");
    let said = complaint(&text, &[]);
    assert!(
        said.contains("no stage reads `walk` of the list `town`") && said.contains("did you mean `walks`?"),
        "{said}"
    );
    assert!(said.contains("no stage reads `note`") && said.contains("`{town.note}`"), "{said}");
    // A field that all values have may be idle: here `--set` replaced what read it.
    let recipe = read(TOWNS, &["stages.people.count=4"]);
    assert_eq!(recipe.stages.len(), read(TOWNS, &[]).stages.len());
}
