//! `cosfly dataset tag, list, diff, checkout, lint` and `cosfly verify --regenerate` through the real binary.

use crate::street::Street;
use crate::support::{cosfly, tree_digests};

fn said(street: &Street, arguments: &[&str], code: i32) -> String {
    let printed = cosfly(arguments).within(street.path()).run();
    assert_eq!(printed.code, Some(code), "{arguments:?}\n{}{}", printed.stdout, printed.stderr);
    printed.stdout + &printed.stderr
}

#[test]
fn versions_are_named_compared_with_reasons_and_written_out_again() {
    let street = Street::new();
    let run = |set: &str| {
        said(&street, &["run", "recipe.toml", "--quiet", "--set", set], 0);
        set.to_owned()
    };
    let first = run("stages.walkers.count=2");
    let tagged = said(&street, &["dataset", "tag", "v1", "recipe.toml", "--set", &first], 0);
    assert!(tagged.starts_with("v1  ") && tagged.contains("4 flights"), "{tagged}");
    let before: Vec<_> = tree_digests(&street.dataset()).into_iter().filter(|it| !it.0.starts_with('.')).collect();

    let more = run("stages.walkers.count=3");
    let refused = said(&street, &["dataset", "tag", "v1", "recipe.toml", "--set", &more], 3);
    assert!(refused.contains("is the name of another version"), "{refused}");
    let unfinished = said(&street, &["dataset", "tag", "v0", "recipe.toml", "--set", "seed=99"], 3);
    assert!(unfinished.contains("is not finished"), "{unfinished}");
    let noted = said(&street, &["dataset", "tag", "v2", "recipe.toml", "--set", &more], 0);
    assert!(noted.contains("note: against `v1` this is a minor change"), "{noted}");
    let difference = said(&street, &["dataset", "diff", "v1", "v2"], 0);
    for line in ["4 flights the same", "2 flights added: expert-p00002, perturbed-p00002", "a minor change"] {
        assert!(difference.contains(line), "{difference}");
    }
    assert!(difference.contains("because walkers: `count` is 2 in `v1` and 3 in `v2`"), "{difference}");

    // What changed beside the number of walkers is no cause of an added flight.
    let larger = ["--set", "stages.walkers.count=3", "--set", "stages.dataset.version=1.1.0"];
    said(&street, &[&["run", "recipe.toml", "--quiet"][..], &larger].concat(), 0);
    let noted = said(&street, &[&["dataset", "tag", "v2b", "recipe.toml"][..], &larger].concat(), 0);
    assert!(!noted.contains("against `v1`"), "{noted}");
    let difference = said(&street, &["dataset", "diff", "v1", "v2b"], 0);
    let causes: Vec<&str> = difference.lines().filter(|line| line.starts_with("  because")).collect();
    assert_eq!(causes, ["  because walkers: `count` is 2 in `v1` and 3 in `v2b`"], "{difference}");
    assert!(difference.contains("`version` changed from"), "{difference}");

    // A value that the recipe leaves out is told as it is in force.
    let limit = "stages.expert.limits.pitch_rate_deg_s=7.5";
    let why = said(&street, &["why", "recipe.toml", "expert/p00000", "--set", limit], 0);
    assert!(why.contains("`limits.pitch_rate_deg_s` changed from `60.0` to `7.5`") && !why.contains("null"), "{why}");

    let changed = run("stages.perturbed.position_probability=0.9");
    said(&street, &["dataset", "tag", "v3", "recipe.toml", "--set", &changed], 0);
    let difference = said(&street, &["dataset", "diff", "v1", "v3"], 0);
    assert!(difference.contains("a major change") && difference.contains("because perturbed: `"), "{difference}");
    assert!(said(&street, &["dataset", "diff", "v1", "v4"], 3).contains("has no version `v4`"));
    assert_eq!(said(&street, &["dataset", "list"], 0).lines().count(), 4);

    said(&street, &["dataset", "checkout", "v1", "--out", "old"], 0);
    let after: Vec<_> =
        tree_digests(&street.path().join("old")).into_iter().filter(|it| !it.0.starts_with('.')).collect();
    assert!(before == after, "the version is not what was delivered");
    // The checked-out version is identified by its files: no recipe is required.
    let anew = said(&street, &["verify", "old", "--regenerate", "1"], 0);
    assert!(anew.contains("made 1 flight anew from recipe `street`: 1 the same, byte by byte"), "{anew}");
    let other = said(&street, &["verify", "old", "--regenerate", "2", "--recipe", "recipe.toml", "--set", "seed=5"], 1);
    assert!(other.contains("[verify-regenerate]"), "{other}");
    assert!(said(&street, &["dataset", "lint", "old"], 0).contains("no leak was found"));
}
