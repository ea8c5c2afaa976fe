//! `cosfly preview` through the real binary: pictures and error messages.

use crate::street::Street;
use crate::support::{Printed, cosfly, tree_digests};
use std::path::Path;

fn preview(street: &Street, arguments: &[&str]) -> Printed {
    cosfly(&[&["preview"], arguments].concat()).within(street.path()).run()
}

fn names(folder: &Path) -> Vec<String> {
    tree_digests(folder).into_iter().map(|(name, _)| name).collect()
}

#[test]
fn a_dataset_has_pictures_of_its_flights_that_are_the_same_twice() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let before = tree_digests(&street.dataset());
    let first = preview(&street, &["out/street"]);
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    insta::assert_snapshot!("preview", without_sizes(&first.stdout));
    let made = tree_digests(&street.path().join("out/street-preview"));
    assert!(tree_digests(&street.dataset()) == before, "the dataset itself is not touched");
    preview(&street, &["out/street", "--out", "again"]);
    assert!(tree_digests(&street.path().join("again")) == made);
    let other =
        preview(&street, &["out/street", "--trajectory", "perturbed-p00001", "--frames", "0,3..9:3", "--out", "few"]);
    assert!(other.stdout.contains("contact sheet of 3 frames"), "{}{}", other.stdout, other.stderr);
    let expected = ["clip.gif", "plan.png", "sheet.png"].map(|name| format!("perturbed-p00001-{name}"));
    assert_eq!(names(&street.path().join("few")), [&expected[..], &["preview.json".to_owned()]].concat());
    assert!(!other.stderr.contains("another dataset"), "{}", other.stderr);
    let source = street.path().join("few/preview.json");
    std::fs::write(&source, "{ \"dataset\": \"0123456789abcdef\" }").expect("writable");
    let said = preview(&street, &["out/street", "--out", "few"]).stderr;
    assert!(said.contains("earlier pictures in `few` are of another dataset, 0123456789ab"), "{said}");
    let said = preview(&street, &["out/street", "--out", "few"]).stderr;
    assert!(!said.contains("another dataset"), "{said}");
    for (name, arguments) in [
        ("preview_unknown", &["out/street", "--trajectory", "expert-p0002"][..]),
        ("preview_beyond_the_end", &["out/street", "--frames", "0..40:10"]),
        ("preview_of_a_recipe", &["recipe.toml"]),
        ("preview_of_nothing", &["nowhere"]),
        ("preview_not_a_frame", &["out/street", "--frames", "first"]),
    ] {
        let printed = preview(&street, arguments);
        let code = printed.code.unwrap_or(-1);
        insta::assert_snapshot!(name, format!("exit code {code}\n{}", printed.stderr));
    }
}

/// Redaction: file sizes in brackets at the ends of lines.
fn without_sizes(text: &str) -> String {
    let lines = text.lines().map(|line| match line.rsplit_once(" (") {
        Some((before, size)) if size.ends_with("B)") => format!("{before} (<size>)\n"),
        _ => format!("{line}\n"),
    });
    lines.collect()
}

#[test]
fn a_damaged_log_is_refused_and_leaves_no_picture() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let copy = street.path().join("copy");
    for (name, _) in tree_digests(&street.dataset()) {
        let path = copy.join(&name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
        let bytes = std::fs::read(street.dataset().join(&name)).expect("readable");
        let kept = if name.ends_with(".mcap") { bytes.len() / 3 } else { bytes.len() };
        std::fs::write(path, &bytes[..kept]).expect("writable");
    }
    let printed = preview(&street, &["copy", "--out", "none"]);
    assert_eq!(printed.code, Some(4), "{}", printed.stderr);
    assert!(printed.stderr.contains("cosfly verify") && !street.path().join("none").exists(), "{}", printed.stderr);
}

#[test]
fn the_help_has_examples() {
    insta::assert_snapshot!("help_preview", cosfly(&["preview", "--help"]).run_ok().stdout);
}
