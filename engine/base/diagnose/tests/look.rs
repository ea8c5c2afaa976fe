//! The printed form of every kind of diagnostic.

use cosfly_diagnose::{Diagnostic, Fault, Label, render, render_all};

const RECIPE: &str = "name = \"x\"\n\n[stages.town]\nuse = \"map\"\nmargin_m = -0.2\nother = 3\n";

fn label(path: &str, text: &str, needle: &str, note: &str) -> Label {
    let start = text.find(needle).unwrap();
    Label { path: path.into(), text: text.into(), span: start..start + needle.len(), note: note.into() }
}

fn at(span: std::ops::Range<usize>, text: &str) -> Box<Diagnostic> {
    let label = Label { path: "a.toml".into(), text: text.into(), span, note: "here".into() };
    Diagnostic::new("code", Fault::Input, "something is wrong").at(label)
}

#[test]
fn one_place_shows_path_line_column_and_caret() {
    let diagnostic =
        Diagnostic::new("recipe-out-of-range", Fault::Recipe, "`margin_m` is `-0.2`; it must be at least `0`")
            .at(label("recipes/a.toml", RECIPE, "-0.2", ""))
            .hint("`margin_m`: clearance to every obstacle (default `0.5`)");
    insta::assert_snapshot!(render(&diagnostic, false), @r#"
    error[recipe-out-of-range]: `margin_m` is `-0.2`; it must be at least `0`
     --> recipes/a.toml:5:12
      |
    5 | margin_m = -0.2
      |            ^^^^
      |
      = help: `margin_m`: clearance to every obstacle (default `0.5`)
    "#);
}

#[test]
fn without_a_file_there_is_no_gutter_and_long_hints_wrap() {
    let error = std::io::Error::from(std::io::ErrorKind::StorageFull);
    let diagnostic = Diagnostic::io("write `store/objects/ab`", &error).because("the disk is mounted at `/data`");
    insta::assert_snapshot!(render(&diagnostic, false), @r#"
    error[disk-full]: could not write `store/objects/ab`
     = because: no storage space
     = because: the disk is mounted at `/data`
     = help: free some space, or choose another disk for what is written, then run the same command
             again (finished items of a run are kept)
    "#);
}

#[test]
fn places_of_others_have_a_way_out() {
    let error = std::io::Error::from(std::io::ErrorKind::PermissionDenied);
    insta::assert_snapshot!(render(&Diagnostic::io("write `out/a`", &error), false), @r#"
    error[machine-io]: could not write `out/a`
     = because: permission denied
     = help: change its permissions, or name another place (`--out`, `--store`)
    "#);
}

#[test]
fn a_bare_message_is_one_line() {
    insta::assert_snapshot!(render(&Diagnostic::new("code", Fault::Bug, "that was not to be"), false), @r#"error[code]: that was not to be"#);
}

#[test]
fn places_in_one_file_share_an_excerpt_and_other_files_follow() {
    let diagnostic = Diagnostic::new("recipe-cycle", Fault::Recipe, "stages wait for each other in a circle")
        .at(label("a.toml", RECIPE, "town", "`a` reads it"))
        .at(label("a.toml", RECIPE, "other", "`b` reads it"))
        .at(label("--set", "stages.a.b=3", "3", "`c` reads it"))
        .because("a stage runs after its inputs");
    insta::assert_snapshot!(render(&diagnostic, false), @r#"
    error[recipe-cycle]: stages wait for each other in a circle
     --> a.toml:3:9
      |
    3 | [stages.town]
      |         ^^^^ `a` reads it
    ...
    6 | other = 3
      | ----- `b` reads it
      |
     ::: --set:1:12
      |
    1 | stages.a.b=3
      |            - `c` reads it
      |
      = because: a stage runs after its inputs
    "#);
}

#[test]
fn a_very_long_line_is_cut_around_the_label() {
    let text = format!("<?xml?>\n<OpenDRIVE>{}<road id=\"bad\"/>{}", "<x/>".repeat(5000), "<y/>".repeat(1000));
    let diagnostic = Diagnostic::new("xml", Fault::Input, "bad road").at(label("town.xodr", &text, "\"bad\"", "here"));
    insta::assert_snapshot!(render(&diagnostic, false), @r#"
    error[xml]: bad road
     --> town.xodr:2:20021
      |
    2 | ...x/><x/><x/><x/><x/><x/><x/><x/><road id="bad"/><y/><y/><y/><y/><y/><y/><y/><y/><y/><y/><y/...
      |                                            ^^^^^ here
    "#);
}

#[test]
fn a_label_over_many_lines_marks_its_first() {
    insta::assert_snapshot!(render(&at(0..RECIPE.len(), RECIPE), false), @r#"
    error[code]: something is wrong
     --> a.toml:1:1
      |
    1 | name = "x"
      | ^^^^^^^^^^ here
    "#);
}

#[test]
fn the_end_of_a_file_is_shown_at_its_last_line() {
    insta::assert_snapshot!(render(&at(RECIPE.len()..RECIPE.len(), RECIPE), false), @r#"
    error[code]: something is wrong
     --> a.toml:6:10
      |
    6 | other = 3
      |          ^ here
    "#);
}

#[test]
fn an_empty_file_still_has_a_place() {
    insta::assert_snapshot!(render(&at(0..0, ""), false), @r#"
    error[code]: something is wrong
     --> a.toml:1:1
      |
    1 |
      | ^ here
    "#);
}

#[test]
fn control_characters_of_a_file_do_not_reach_the_terminal() {
    insta::assert_snapshot!(render(&at(2..3, "käse = 1\ttab\u{7}\u{1b}[31m"), false), @r#"
    error[code]: something is wrong
     --> a.toml:1:2
      |
    1 | käse = 1    tab␇␛[31m
      |  ^ here
    "#);
}

#[test]
fn several_diagnostics_are_counted() {
    let all = [at(0..4, RECIPE), at(12..15, RECIPE)];
    insta::assert_snapshot!(render_all(all.iter().map(|one| &**one), false), @r#"
    error[code]: something is wrong
     --> a.toml:1:1
      |
    1 | name = "x"
      | ^^^^ here

    error[code]: something is wrong
     --> a.toml:3:1
      |
    3 | [stages.town]
      | ^^^ here

    2 errors
    "#);
}

#[test]
fn a_flood_is_cut_after_twenty() {
    let one = Diagnostic::new("code", Fault::Input, "again");
    let text = render_all(std::iter::repeat_n(&*one, 45), false);
    assert_eq!(text.matches("again").count(), 20);
    assert!(text.ends_with("45 errors; the first 20 are shown"));
}

#[test]
fn colour_adds_no_characters() {
    let diagnostic = at(0..4, RECIPE).because("why").hint("what to do");
    let coloured = render(&diagnostic, true);
    let mut plain = String::new();
    let mut pieces = coloured.split('\u{1b}');
    plain.push_str(pieces.next().unwrap_or_default());
    pieces.for_each(|piece| plain.push_str(piece.split_once('m').map_or("", |(_, rest)| rest)));
    assert_eq!(plain, render(&diagnostic, false));
}

#[test]
fn no_label_makes_the_printer_panic() {
    let texts = ["", "a", "\n", "\r\n\r\n", "ä\u{301}€\n\tß", RECIPE, "\u{feff}x", "🦀🦀\n🦀"];
    for text in texts {
        for start in 0..text.len() + 3 {
            for end in [0, start, start + 1, start + 2, text.len(), usize::MAX] {
                let shown = render(&at(start..end, text), false);
                assert!(shown.contains("a.toml:"), "{shown}");
            }
        }
    }
}
