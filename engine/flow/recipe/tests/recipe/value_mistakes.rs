//! Messages about values that are invalid in any recipe.

use crate::toys::complaint_about_people;

#[test]
fn numbers_must_be_finite() {
    let text = complaint_about_people(
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
    let text = complaint_about_people(r#"count = 99999999999999999999"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-out-of-range]: `stages.people.count` is `99999999999999999999`; whole numbers must fit
                                into 64 bits with a sign
     --> a.toml:8:9
      |
    8 | count = 99999999999999999999
      |         ^^^^^^^^^^^^^^^^^^^^
    "#);
}

#[test]
fn a_date() {
    let text = complaint_about_people(r#"crowd = 2026-01-01"#);
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
    let text = complaint_about_people(&format!("crowd = {}{}\n", "[ ".repeat(40), "]".repeat(40)));
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
