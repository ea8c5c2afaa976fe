//! Long walks through the real binary: one hard place costs no whole flight.

use crate::support::{cosfly, repository_root};

const RECIPE: &str = r#"name = "long"
seed = 42

[stages.town]
use = "map"
source = "DOWNTOWN"

[stages.walkers]
use = "pedestrians"
inputs.town = "town"
count = 5
frames = 1000

[stages.expert]
use = "plan"
inputs = { town = "town", walks = "walkers" }
"#;

/// Two of the five are rejected where every effort must succeed along the whole flight.
#[test]
fn walks_of_a_thousand_steps_are_rejected_no_more_often_than_short_ones() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let town = repository_root().join("recipes/towns/downtown.xodr");
    let recipe = RECIPE.replace("DOWNTOWN", town.to_str().expect("UTF-8"));
    std::fs::write(folder.path().join("recipe.toml"), recipe).expect("writable");
    let printed = cosfly(&["run", "recipe.toml", "--json", "--quiet"]).within(folder.path()).run_ok();
    let summary: serde_json::Value = serde_json::from_str(&printed.stdout).expect("a JSON summary");
    assert_eq!(summary["rejected"], serde_json::json!([]));
}
