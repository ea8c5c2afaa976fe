//! Messages about invalid `--set` arguments.

use crate::toys::{PEOPLE, complaint};

fn check_complaint(argument: &str) -> String {
    complaint(PEOPLE, &[argument])
}

#[test]
fn an_unknown_stage_names_the_nearest() {
    let text = check_complaint("stages.peeple.count=3");
    insta::assert_snapshot!(text, @r#"
    error[override-unknown-stage]: the recipe has no stage `peeple`
     --> --set:1:8
      |
    1 | stages.peeple.count=3
      |        ^^^^^^
      |
      = help: did you mean `people`?
      = help: stages of the recipe: `people`, `town`
    "#);
}

#[test]
fn an_unknown_parameter_names_the_nearest() {
    let text = check_complaint("stages.people.cuont=3");
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-key]: `cuont` is not a parameter of `walkers`
     --> --set:1:15
      |
    1 | stages.people.cuont=3
      |               ^^^^^
      |
      = help: did you mean `count`?
      = help: parameters of `walkers`: `colour`, `count`, `crossing`, `crowd`, `curious`, `margin_m`,
              `pause`, `shares`, `speed`, `version`, `visits`
    "#);
}

#[test]
fn a_value_out_of_range() {
    let text = check_complaint("stages.people.speed.max_mps=12");
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `speed.max_mps` is `12`; it must be at most `10`
     --> --set:1:29
      |
    1 | stages.people.speed.max_mps=12
      |                             ^^
      |
      = help: `speed.max_mps`: Fastest speed (default `2`)
    "#);
}

#[test]
fn a_word_where_a_number_is_wanted() {
    let text = check_complaint("stages.people.count=many");
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `count` is the string `many`; it must be a whole number
     --> --set:1:21
      |
    1 | stages.people.count=many
      |                     ^^^^
      |
      = help: `count`: Number of paths (default `4`)
    "#);
}

#[test]
fn no_equals_sign() {
    let text = check_complaint("stages.people.count");
    insta::assert_snapshot!(text, @r#"
    error[override-syntax]: `stages.people.count` has no `=`
     --> --set:1:1
      |
    1 | stages.people.count
      | ^^^^^^^^^^^^^^^^^^^
      |
      = help: write `--set stages.STAGE.PARAMETER=VALUE`
    "#);
}

#[test]
fn no_value() {
    let text = check_complaint("stages.people.count=");
    insta::assert_snapshot!(text, @r#"
    error[override-syntax]: there is no value after `=`
     --> --set:1:1
      |
    1 | stages.people.count=
      | ^^^^^^^^^^^^^^^^^^^^
      |
      = help: an empty text is written `""`
    "#);
}

#[test]
fn a_broken_list() {
    let text = check_complaint("stages.people.colour=[1, 2");
    insta::assert_snapshot!(text, @r#"
    error[override-syntax]: `[1, 2` is not a TOML value
     --> --set:1:22
      |
    1 | stages.people.colour=[1, 2
      |                      ^^^^^
      |
      = because: unclosed array, expected `]`
    "#);
}

#[test]
fn an_empty_key() {
    let text = check_complaint("stages..count=3");
    insta::assert_snapshot!(text, @r#"
    error[override-syntax]: a key is empty
     --> --set:1:8
      |
    1 | stages..count=3
      |        ^
      |
      = help: keys are letters, digits, `_` and `-`, joined by dots
    "#);
}

#[test]
fn a_whole_stage() {
    let text = check_complaint("stages.people=3");
    insta::assert_snapshot!(text, @r#"
    error[override-syntax]: a whole stage cannot be replaced by `--set`
     --> --set:1:8
      |
    1 | stages.people=3
      |        ^^^^^^
      |
      = help: name one of its parameters: `--set stages.STAGE.PARAMETER=VALUE`
    "#);
}

#[test]
fn a_key_below_a_value() {
    let text = check_complaint("stages.people.inputs.town.x=3");
    insta::assert_snapshot!(text, @r#"
    error[override-syntax]: `stages.people.inputs.town` is a string; it has no `x`
     --> --set:1:27
      |
    1 | stages.people.inputs.town.x=3
      |                           ^
    "#);
}

#[test]
fn a_missing_file() {
    let text = check_complaint("stages.town.source=../nowhere/town.xodr");
    insta::assert_snapshot!(text, @r#"
    error[input-missing]: there is no file `../nowhere/town.xodr`
     --> --set:1:20
      |
    1 | stages.town.source=../nowhere/town.xodr
      |                    ^^^^^^^^^^^^^^^^^^^^
      |
      = help: there is no folder `../nowhere`
      = help: paths in a recipe are relative to the recipe's folder, here `FOLDER`
    "#);
}

#[test]
fn a_kind_that_is_not_there() {
    let text = check_complaint("stages.people.use=gps");
    insta::assert_snapshot!(text, @r#"
    error[recipe-unknown-kind]: there is no stage kind `gps`
     --> --set:1:19
      |
    1 | stages.people.use=gps
      |                   ^^^
      |
      = help: stage kinds: `blocks`, `dataset`, `expert`, `map`, `render`, `tracks`, `walkers`,
              `weathers`
    "#);
}

#[test]
fn a_number_that_is_not_finite() {
    let text = check_complaint("stages.people.margin_m=-inf");
    insta::assert_snapshot!(text, @r#"
    error[recipe-not-finite]: `stages.people.margin_m` is `-inf`; numbers must be finite
     --> --set:1:24
      |
    1 | stages.people.margin_m=-inf
      |                        ^^^^
    "#);
}
