//! Advice about finished datasets, exports, scores and versions.

use super::{helps, refused};
use crate::street::{RECIPE, Street};

#[test]
fn a_dataset_is_scored_exported_and_made_again_as_the_refusals_say() {
    let street = Street::new();
    helps(&street, &["run", "recipe.toml", "--out", "out", "--quiet"]);
    let predictions = street.path().join("predictions.jsonl");
    std::fs::write(
        &predictions,
        "{\"trajectory_id\": \"x\", \"frame\": 0, \"waypoint_deltas\": [[0, 0, 0, 0, 0, 0]]}\n",
    )
    .expect("writable");
    let score = ["eval", "out", "predictions.jsonl"];
    let said = refused(&street, &score, "a row that fits is {");
    let row =
        said.split("a row that fits is ").nth(1).and_then(|rest| rest.split_inclusive('}').next()).expect("a row");
    std::fs::write(&predictions, format!("{row}\n")).expect("writable");
    refused(&street, &score, "`--missing-as-zero` counts them as standing still");
    helps(&street, &[&score[..], &["--missing-as-zero"]].concat());

    refused(&street, &["eval", "out", "--history", "20"], "a shorter `--history` or `--horizon` needs fewer frames");
    helps(&street, &["eval", "out", "--history", "2", "--horizon", "2"]);
    let export = ["export", "out", "--format", "vlm", "--out", "sets"];
    refused(
        &street,
        &[&export[..], &["--history", "20"]].concat(),
        "choose with `--input`, `--history` and `--horizon`; a stage `perturb` makes perturbed flights",
    );
    helps(&street, &[&export[..], &["--input", "expert", "--history", "2", "--horizon", "2"]].concat());

    let again = ["verify", "out", "--regenerate", "1"];
    refused(&street, &again, "`--recipe RECIPE`, with the same `--set`");
    helps(&street, &[&again[..], &["--recipe", "recipe.toml"]].concat());
    helps(&street, &["dataset", "tag", "v1.0.0", "recipe.toml"]);
    helps(&street, &again);
}

#[test]
fn places_and_names_of_finished_data_are_given_as_the_refusals_say() {
    let street = Street::new();
    refused(&street, &["verify", "out/street"], "give the folder that `cosfly run --out` wrote");
    let export = ["export", "out/street", "--out", "data", "--format"];
    let with = |more: &[&'static str]| [&export[..], more].concat();
    refused(&street, &with(&["mot"]), "give the folder that `cosfly run` delivered");
    helps(&street, &["run", "recipe.toml", "--quiet"]);
    helps(&street, &["verify", "out/street"]);
    refused(&street, &with(&["mto"]), "possible values: clouds, coco, grounding, imagefolder, lasot, lerobot, mot,");
    refused(&street, &with(&["mot", "--shard-mb", "5"]), "`--shard-mb` is an option of `webdataset`");
    helps(&street, &with(&["mot"]));
    refused(&street, &with(&["mot"]), "give another one with `--out`, or remove this one");
    helps(&street, &["export", "out/street", "--out", "more", "--format", "webdataset", "--shard-mb", "5"]);

    let said =
        refused(&street, &["preview", "out/street", "--trajectory", "expert-p0001"], "did you mean `expert-p0000");
    let near = said.split("did you mean `").nth(1).and_then(|rest| rest.split('`').next()).expect("a name");
    let preview = ["preview", "out/street", "--trajectory", near, "--out", "pictures", "--frames"];
    let said = refused(&street, &[&preview[..], &["40"]].concat(), "frames go from 0 to 11; all of them are `0..12`");
    assert!(said.contains("0..12"), "{said}");
    helps(&street, &[&preview[..], &["0..12:6"]].concat());

    refused(&street, &["verify", "out/street", "--regenerate", "1"], "`--recipe RECIPE`");
    let tag = |name: &'static str| ["dataset", "tag", name, "recipe.toml"];
    refused(&street, &tag("v 1"), "such as `v1.0.0`");
    helps(&street, &tag("v1.0.0"));
    refused(&street, &["dataset", "diff", "v1.0.1", "v1.0.0"], "did you mean `v1.0.0`?");
    let changed = [&tag("v1.0.0")[..], &["--set", "stages.walkers.count=2"]].concat();
    refused(&street, &changed, "run the recipe first, with the same `--set`");
    helps(&street, &["run", "recipe.toml", "--quiet", "--out", "two", "--set", "stages.walkers.count=2"]);
    refused(&street, &changed, "choose another name: a version never changes");
    helps(&street, &[&tag("v2.0.0")[..], &["--set", "stages.walkers.count=2"]].concat());
    helps(&street, &["dataset", "diff", "v1.0.0", "v2.0.0"]);
}

#[test]
fn folders_and_stores_are_chosen_as_the_refusals_say() {
    let street = Street::new();
    std::fs::create_dir_all(street.path().join("mine")).expect("writable");
    std::fs::write(street.path().join("mine/thesis.txt"), "months of work").expect("writable");
    let run = ["run", "recipe.toml", "--quiet", "--stage", "walkers"];
    let with = |more: &[&'static str]| [&run[..], more].concat();
    refused(&street, &with(&["--store", "mine"]), "choose an empty or a new folder with `--store`");
    helps(&street, &with(&["--store", "new"]));
    let whole = ["run", "recipe.toml", "--quiet", "--set", "stages.walkers.count=1"];
    refused(&street, &[&whole[..], &["--out", "mine"]].concat(), "choose another folder with `--out`");
    refused(&street, &[&whole[..], &["--out", "a", "--store", "a/b"]].concat(), "choose two folders side by side");
    helps(&street, &[&whole[..], &["--out", "a", "--store", "b"]].concat());
    std::fs::write(street.path().join("new/format"), "cosfly-store 99\n").expect("writable");
    refused(&street, &with(&["--store", "new"]), "or choose another folder with `--store`");
    helps(&street, &with(&["--store", "newer"]));
}

#[test]
fn policies_and_suites_are_given_as_the_refusals_say() {
    let street = Street::new();
    let fly =
        |more: &[&'static str]| [&["fly", "recipe.toml", "--quiet", "--clips", "0", "--logs", "none"], more].concat();
    refused(&street, &fly(&["--policy", "folow"]), "did you mean `follow`?");
    refused(&street, &fly(&["--policy", "https://127.0.0.1:1"]), "ws://");
    refused(&street, &fly(&["--policy", "hold", "--wind-mps", "3"]), "`--drone pelican` or `--drone crazyflie`");
    helps(&street, &fly(&["--policy", "hold", "--wind-mps", "3", "--drone", "pelican", "--out", "windy"]));
    refused(&street, &fly(&["--policy", "hold", "--policy", "hold"]), "leave one out, or fly each by a command");
    helps(&street, &fly(&["--policy", "hold", "--name", "first"]));
    helps(&street, &fly(&["--policy", "hold", "--name", "second"]));
    let first = ["fly", "compare", "out/fly/street/first"];
    refused(&street, &[&first[..], &["windy/hold"]].concat(), "on the same suite with the same settings");
    helps(&street, &[&first[..], &["out/fly/street/second"]].concat());
    let inspecting = "inputs.town = \"town\"\nobjective = \"inspect\"";
    let text = RECIPE.replacen("inputs = { town = \"town\", walks = \"walkers\" }", inspecting, 1);
    std::fs::write(street.path().join("inspecting.toml"), text).expect("writable");
    refused(&street, &["fly", "inspecting.toml", "--policy", "hold"], "`use = \"plan\"` and `objective = \"track\"`");
    refused(
        &street,
        &fly(&["--policy", "hold", "--name", "first", "--drone", "pelican"]),
        "another `--name` to the policy",
    );
}
