//! Advice of refusals: each piece is carried out here as it stands, and helps.

use crate::street::{RECIPE, Street, map};
use crate::support::cosfly;

/// Runs a call that is refused with some advice; gives its messages in one line, however their lines are broken.
fn refused(street: &Street, arguments: &[&str], advice: &str) -> String {
    let printed = cosfly(arguments).within(street.path()).run();
    let said = format!("{} {}", printed.stdout, printed.stderr);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(printed.code != Some(0) && said.contains(advice), "`{advice}` in {said}");
    said
}

fn helps(street: &Street, arguments: &[&str]) -> String {
    cosfly(arguments).within(street.path()).run_ok().stdout
}

/// A recipe of towns from a list.
fn towns(list: &str, source: &str) -> Street {
    let recipe =
        format!("name = \"towns\"\n{list}\n[stages.town]\nuse = \"map\"\nfor_each = \"town\"\nsource = \"{source}\"\n");
    Street::with(&recipe, &map())
}

#[test]
fn lists_are_written_as_the_refusals_of_others_say() {
    const PLAN: [&str; 2] = ["plan", "recipe.toml"];
    refused(&towns("", "{town}"), &PLAN, "write the list: `[for_each]` with `town = [\"FIRST\", \"SECOND\"]`");
    helps(&towns("[for_each]\ntown = [\"street.xodr\"]", "{town}"), &PLAN);

    let wrong = towns("[for_each]\ntown = 3", "{town}");
    let said = refused(&wrong, &PLAN, "write `town = [1, 2, 3]`, `town = \"towns/*.xodr\"` or");
    assert!(said.contains("`town = { files = \"towns/*.xodr\", walks = 50 }`"), "{said}");
    helps(&towns("[for_each]\ntown = \"*.xodr\"", "{town}"), &PLAN);
    helps(
        &towns("[for_each]\ntown = { files = \"*.xodr\", year = 50 }", "{town.file}\"\nname = \"of{town.year}"),
        &PLAN,
    );

    let bare = towns("[for_each]\ntown = [\"street.xodr\"]", "{town.file}");
    refused(&bare, &PLAN, "write the value as a table: `{ name = \"street\", file = ... }`");
    helps(&towns("[for_each]\ntown = [{ name = \"street\", file = \"street.xodr\" }]", "{town.file}"), &PLAN);

    let unused = towns("[for_each]\ntown = [\"street.xodr\"]\npace = [1, 2]", "{town}");
    refused(&unused, &PLAN, "write `for_each = \"pace\"` in a stage, or remove the list");
}

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
        "choose with `--input`, `--history` and `--horizon`",
    );
    helps(&street, &[&export[..], &["--input", "expert", "--history", "2", "--horizon", "2"]].concat());

    let again = ["verify", "out", "--regenerate", "1"];
    refused(&street, &again, "`--recipe RECIPE`, with the same `--set`");
    helps(&street, &[&again[..], &["--recipe", "recipe.toml"]].concat());
    helps(&street, &["dataset", "tag", "v1.0.0", "recipe.toml"]);
    helps(&street, &again);
}

#[test]
fn clothes_and_companions_agree_once_the_advice_is_followed() {
    let street = Street::new();
    let dressed = ["run", "recipe.toml", "--quiet", "--set", "stages.frames.target_stands_out=1.0"];
    refused(&street, &dressed, "set `clothes = false` in the `caption` stage, or `target_stands_out = 0`");
    helps(&street, &[&dressed[..], &["--set", "stages.captions.clothes=false"]].concat());

    let friends =
        "[stages.friends]\nuse = \"pedestrians\"\ninputs.town = \"town\"\ncount = 3\nframes = 14\n\n[stages.expert]";
    let with_friends = RECIPE.replacen("[stages.expert]", friends, 1).replacen(
        "walks = \"walkers\" }",
        "walks = \"walkers\", others = \"friends\" }\ntargets.companions = 1",
        1,
    );
    let street = Street::with(&with_friends, &map());
    let run = ["run", "recipe.toml", "--quiet", "--stage", "expert"];
    refused(&street, &run, "connect `inputs.others` to walkers with the same `frames` and `dt_s`");
    helps(&street, &[&run[..], &["--set", "stages.friends.frames=12"]].concat());
}
