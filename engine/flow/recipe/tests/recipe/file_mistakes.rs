//! Messages about files that a recipe names.

use crate::toys::complaint;

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
      = help: paths in a recipe are relative to the recipe's folder, here `FOLDER`
    "#);
}

#[test]
fn a_file_that_is_not_named() {
    let text = complaint("name = \"t\"\n[stages.people]\nuse = \"tracks\"\n", &[]);
    insta::assert_snapshot!(text, @r#"
    error[recipe-missing-key]: `file` does not name a file
     --> a.toml:2:9
      |
    2 | [stages.people]
      |         ^^^^^^
      |
      = help: write `file = "..."`; paths are relative to the recipe's folder
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
      = help: paths in a recipe are relative to the recipe's folder, here `FOLDER`
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
    error[input-missing]: `folder` is a folder, not a file
     --> a.toml:4:10
      |
    4 | source = "folder"
      |          ^^^^^^^^
    "#);
}
