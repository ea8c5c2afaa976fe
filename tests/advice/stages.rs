//! Advice of stages at work.

use super::{changed, helps, refused};
use crate::street::{RECIPE, Street, map};

/// The recipe with a second town of the same file behind it.
fn with_other_town(name: &str) -> String {
    let other = format!(
        "[stages.other]\nuse = \"map\"\nsource = \"street.xodr\"\noptions = {{ road_marks = false }}\n{name}\n[stages.walkers]"
    );
    RECIPE.replacen("[stages.walkers]", &other, 1)
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

#[test]
fn towns_of_pictures_and_tables_agree_once_the_advice_is_followed() {
    let run = ["run", "recipe.toml", "--quiet", "--set", "stages.walkers.count=1"];
    let filmed = "inputs = { town = \"town\", trajectories = [";
    let elsewhere = with_other_town("").replacen(filmed, "inputs = { town = \"other\", trajectories = [", 1);
    let advice = "connect `inputs.town` and `inputs.trajectories` so that both begin at the same `map` stage";
    refused(&Street::with(&elsewhere, &map()), &run, advice);
    helps(&Street::with(&with_other_town(""), &map()), &run);

    let published = |towns: &str, name: &str| {
        let recipe = with_other_town(name);
        let inputs = "inputs = { town = \"town\", frames = \"frames\"";
        assert!(recipe.contains(inputs), "{recipe}");
        Street::with(&recipe.replacen(inputs, &format!("inputs = {{ town = {towns}, frames = \"frames\""), 1), &map())
    };
    refused(&published("[\"town\", \"other\"]", "name = \"second\"\n"), &run, "or leave `other` out");
    refused(&published("\"other\"", "name = \"second\"\n"), &run, "of every town that `inputs.frames` shows");
    helps(&published("\"town\"", ""), &run);
}

#[test]
fn a_town_without_pavements_is_walked_as_the_refusal_says() {
    let bare = map().replace("type=\"sidewalk\"", "type=\"none\"");
    let strict = RECIPE.replacen("source", "options = { assume_ground = false }\nsource", 1);
    let run = ["run", "recipe.toml", "--quiet", "--stage", "walkers"];
    refused(&Street::with(&strict, &bare), &run, "leave out `options.assume_ground = false`");
    helps(&Street::with(RECIPE, &bare), &run);
}

#[test]
fn sensors_and_bounds_are_set_as_the_refusals_say() {
    let bounds =
        |text: &str| changed("source = \"street.xodr\"", &format!("source = \"street.xodr\"\nbounds_m = {text}"));
    let run = ["run", "recipe.toml", "--quiet", "--stage", "town"];
    let said = refused(&bounds("[5000, 5000, 5100, 5100]"), &run, "the whole town is `bounds_m = [");
    let whole =
        said.split("the whole town is `bounds_m = ").nth(1).and_then(|rest| rest.split('`').next()).expect("bounds");
    helps(&bounds(whole), &run);
}
