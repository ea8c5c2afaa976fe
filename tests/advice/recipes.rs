//! Advice about the text of a recipe.

use super::{PLAN, changed, followed, helps, proposed, refused};
use crate::street::{Street, map};

/// A recipe of towns from a list.
fn towns(list: &str, source: &str) -> Street {
    let recipe =
        format!("name = \"towns\"\n{list}\n[stages.town]\nuse = \"map\"\nfor_each = \"town\"\nsource = \"{source}\"\n");
    Street::with(&recipe, &map())
}

#[test]
fn lists_are_written_as_the_refusals_of_others_say() {
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
fn proposals_for_misspelt_names_are_right_in_their_place() {
    const NEAR: &str = "did you mean";
    proposed("count = 3", "cuont = 3", NEAR, "cuont");
    proposed("use = \"plan\"", "use = \"plann\"", NEAR, "plann");
    proposed("walks = \"walkers\"", "walks = \"walker\"", NEAR, "walker");
    proposed("walks = \"walkers\"", "wlaks = \"walkers\"", NEAR, "wlaks");
    proposed("source = \"street.xodr\"", "source = \"streets.xodr\"", NEAR, "streets.xodr");
    proposed("seed = 3", "sede = 3", NEAR, "sede");
    proposed("[stages.expert]", "[stage.expert]", NEAR, "stage");
    proposed("count = 3", "count = 3\nheight.min_n = 1.5", NEAR, "min_n");
    proposed("use = \"plan\"", "use = \"muco\"", "the kind is called", "muco");
    proposed("walks = \"walkers\"", "paths = \"walkers\"", "the input is called", "paths");
    proposed("frames = 12", "steps = 12", "write", "steps");
    proposed("frames = 12", "frames = \"12\"", "leave out the quotes:", "\"12\"");
    proposed("inputs.town = \"town\"\ncount = 3", "count = 3\n#", "write", "#");
}

#[test]
fn missing_and_repeated_lines_are_written_as_the_refusals_say() {
    followed("name = \"street\"\n", "", "a line such as `name = \"carla_town\"`", "name = \"carla_town\"\n");
    followed("use = \"map\"\n", "", "add a line such as `use = \"map\"`", "use = \"map\"\n");
    followed("source", "name = 7\nsource", "put it in quotes", "name = \"7\"\nsource");
    followed("walks = \"walkers\"", "walks = \"town\"", "write `inputs.walks = \"walkers\"` in", "walks = \"walkers\"");
    followed("inputs.town = \"town\"", "town = \"town\"", "write `inputs.town = ...` in", "inputs.town = \"town\"");
    followed(
        "inputs.trajectories = [\"expert\", \"perturbed\"]",
        "inputs.trajectories = [\"expert\", \"perturbed\", \"expert\"]",
        "name it once",
        "inputs.trajectories = [\"expert\", \"perturbed\"]",
    );
    followed(
        "inputs.town = \"town\"",
        "inputs = \"town\"",
        "write `inputs.PORT = \"STAGE\"`",
        "inputs.town = \"town\"",
    );
    followed(
        "trajectories = \"expert\"",
        "trajectories = \"perturbed\"",
        "connect it to another stage",
        "trajectories = \"expert\"",
    );
    followed(
        "width = 96",
        "weathers = [\"ClearNun\"]\nwidth = 96",
        "the presets are ClearNoon, CloudyNoon",
        "weathers = [\"CloudyNoon\"]\nwidth = 96",
    );
}

#[test]
fn changes_on_the_command_line_are_written_as_the_refusals_say() {
    let street = Street::new();
    let set = |change: &'static str| [PLAN[0], PLAN[1], "--set", change];
    refused(&street, &set("seed"), "write `--set stages.STAGE.PARAMETER=VALUE`");
    refused(&street, &set("stages.walkers=3"), "name one of its parameters: `--set stages.STAGE.PARAMETER=VALUE`");
    refused(&street, &set("stages.wlakers.count=3"), "did you mean `walkers`?");
    helps(&street, &set("stages.walkers.count=3"));
    let said = refused(&street, &["why", "recipe.toml", "expert/p99999"], "known: `p00000`");
    assert!(said.contains("`p00002`"), "{said}");
    helps(&street, &["run", "recipe.toml", "--quiet", "--stage", "expert"]);
    helps(&street, &["why", "recipe.toml", "expert/p00002"]);
    refused(&street, &["run", "recipe.toml", "--stage", "exprt"], "did you mean `expert`?");
    refused(&changed("inputs.town = \"town\"", "\"in puts\" = 3"), &set("stages.walkers.co/unt=3"), "joined by dots");
}
