//! Messages about lists, maps and rules between parameters.

use crate::toys::complaint_about_people;

#[test]
fn a_mistake_inside_a_map() {
    let text = complaint_about_people(r#"shares = { old = 0.2, young = "rest" }"#);
    insta::assert_snapshot!(text, @r#"
    error[recipe-wrong-type]: `shares.young` is the string `"rest"`; it must be a number
     --> a.toml:8:31
      |
    8 | shares = { old = 0.2, young = "rest" }
      |                               ^^^^^^
    "#);
}

#[test]
fn a_list_of_the_wrong_length() {
    let text = complaint_about_people(r#"colour = [1, 2]"#);
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
    let text = complaint_about_people(r#"colour = [1, 2, 256]"#);
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
    let text = complaint_about_people(r#"visits = [{ min_mps = 1 }, { min_mps = -1 }]"#);
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
    let text = complaint_about_people(r#"visits = [{}, {}, {}, {}]"#);
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
    let text = complaint_about_people(r#"speed = { min_mps = 3, max_mps = 2 }"#);
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
