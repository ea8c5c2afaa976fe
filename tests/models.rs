//! Models of things through the real binary: drawn, checked, cached by what their files hold, refused where they are none.

use crate::street::{RECIPE, Street, map};
use crate::support::{cosfly, repository_root};

/// The street with trees, drawn by `lines` of its render stage.
fn street(lines: &str) -> Street {
    let changed = RECIPE
        .replacen("source = \"street.xodr\"\n", "source = \"street.xodr\"\nfill.trees = true\n", 1)
        .replacen("width = 96\n", &format!("width = 96\n{lines}\n"), 1);
    let street = Street::with(&changed, &map());
    let example = repository_root().join("engine/sim/models/src/example.glb");
    std::fs::copy(example, street.path().join("tree.glb")).expect("a model");
    street
}

#[test]
fn things_are_drawn_by_models_and_the_dataset_holds() {
    let street = street("models = [{ kind = \"tree\", source = \"tree.glb\", fit = \"within\", turn_deg = 30 }]");
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();

    // The same model elsewhere makes nothing anew; no model at all makes other pictures.
    std::fs::rename(street.path().join("tree.glb"), street.path().join("oak.glb")).expect("movable");
    let frames_made = |models: &str| {
        let set = format!("stages.frames.models={models}");
        let printed = cosfly(&["run", "recipe.toml", "--json", "--set", &set]).within(street.path()).run_ok();
        let summary: serde_json::Value = serde_json::from_str(&printed.stdout).expect("a JSON summary");
        let stages = summary["stages"].as_array().expect("stages").clone();
        stages.into_iter().find(|it| it["stage"] == "frames").expect("the stage")["ran"].as_u64().expect("a count")
    };
    assert_eq!(frames_made("[{ kind = \"tree\", source = \"oak.glb\", fit = \"within\", turn_deg = 30 }]"), 0);
    assert_eq!(frames_made("[]"), 6);
}

#[test]
fn files_that_are_no_models_are_refused_before_anything_runs() {
    for (lines, code, words) in [
        ("models = [{ kind = \"tree\", source = \"street.xodr\" }]", 4, vec!["no glTF file", "GLB", "recipe.toml:"]),
        ("models = [{ kind = \"tree\", source = \"none.glb\" }]", 4, vec!["none.glb", "recipe.toml:"]),
        ("models = [{ kind = \"house\", source = \"tree.glb\" }]", 3, vec!["house", "traffic_light", "recipe.toml:"]),
        ("models = [{ kind = \"tree\", source = \"tree.glb\", turn_deg = 400 }]", 3, vec!["400", "360"]),
    ] {
        let street = street(lines);
        let printed = cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run();
        assert_eq!(printed.code, Some(code), "{lines}: {}", printed.stderr);
        for word in words {
            assert!(printed.stderr.contains(word), "{word}: {}", printed.stderr);
        }
        assert!(!street.dataset().exists());
    }
}
