//! Checked recipes: stages, items, connections and parameters.

use crate::toys::{WHOLE, check};
use cosfly_recipe::{Recipe, RecipeStage};

fn checked(text: &str, overrides: &[&str]) -> Recipe {
    match check(text, overrides) {
        Ok(recipe) => recipe,
        Err(problems) => {
            panic!("{}", cosfly_diagnose::render_all(problems.iter().map(|problem| &**problem), false))
        }
    }
}

fn names(recipe: &Recipe) -> Vec<&str> {
    recipe.stages.iter().map(|stage| stage.name.as_str()).collect()
}

fn stage<'a>(recipe: &'a Recipe, name: &str) -> &'a RecipeStage {
    &recipe.stages[recipe.position(name).unwrap()]
}

/// Parameters of the stage after defaults.
fn settled(recipe: &Recipe, name: &str) -> serde_json::Value {
    stage(recipe, name).stage.properties().parameters.clone()
}

#[test]
fn stages_stand_after_their_inputs_and_otherwise_in_the_order_of_the_file() {
    let recipe = checked(WHOLE, &[]);
    assert_eq!(recipe.name, "whole");
    assert_eq!(recipe.seed, 7);
    assert_eq!(names(&recipe), ["town", "people", "expert", "second", "frames", "tables.logs", "tables"]);
    let pieces: Vec<&str> = WHOLE.split("\n\n").collect();
    let backwards: Vec<&str> = pieces[..1].iter().chain(pieces[1..].iter().rev()).copied().collect();
    let recipe = checked(&backwards.join("\n\n"), &[]);
    assert_eq!(names(&recipe), ["town", "people", "second", "expert", "frames", "tables.logs", "tables"]);
}

#[test]
fn every_stage_knows_its_items_and_what_each_one_reads() {
    let recipe = checked(WHOLE, &[]);
    let ids = |name: &str| stage(&recipe, name).items.iter().map(|id| id.to_string()).collect::<Vec<_>>();
    assert_eq!(ids("town"), ["all"]);
    assert_eq!(ids("people"), ["path00000", "path00001", "path00002"]);
    assert_eq!(ids("expert"), ids("people"));
    assert_eq!(
        ids("frames"),
        [
            "expert-path00000",
            "expert-path00001",
            "expert-path00002",
            "second-path00000",
            "second-path00001",
            "second-path00002"
        ]
    );
    let frames = stage(&recipe, "frames");
    let trajectories = frames.connection("trajectories").unwrap();
    let second = recipe.position("second").unwrap();
    let [arrival] = trajectories.arrivals_for(4) else { panic!("one arrival per item") };
    assert_eq!((&*arrival.name.to_string(), arrival.stage, arrival.item), ("second-path00001", second, 1));
    assert_eq!(frames.connection("town").unwrap().arrivals_for(4).len(), 1);
    assert!(frames.connection("also").is_none());
    assert_eq!(frames.reads(4).map(|arrival| arrival.stage).collect::<Vec<_>>(), [0, second]);
}

#[test]
fn parts_are_stages_of_their_own_and_siblings_are_connected() {
    let recipe = checked(WHOLE, &[]);
    let (logs, tables) = (stage(&recipe, "tables.logs"), stage(&recipe, "tables"));
    assert_eq!((logs.name.recipe_name(), logs.kind.as_str(), logs.items.len()), ("tables", "dataset", 6));
    assert_eq!(tables.items.len(), 1);
    assert_eq!(tables.connection("logs").unwrap().arrivals_for(0).len(), 6);
    assert_eq!(tables.connection("frames").unwrap().arrivals_for(0).len(), 6);
    assert_eq!(logs.items[0].to_string(), "expert-path00000");
}

#[test]
fn asking_for_more_items_renames_none() {
    let few = checked(WHOLE, &[]);
    let many = checked(WHOLE, &["stages.people.count=40"]);
    for name in ["people", "expert"] {
        let (few, many) = (stage(&few, name), stage(&many, name));
        assert_eq!(few.items[..], many.items[..few.items.len()]);
    }
}

#[test]
fn each_ports_meet_by_item_id_whatever_their_order() {
    let text = WHOLE.replace(
        "inputs.trajectories = [\"expert\", \"second\"]",
        "inputs.trajectories = [\"expert\", \"second\"]\ninputs.also = [\"second\", \"expert\"]",
    );
    let recipe = checked(&text, &[]);
    let frames = stage(&recipe, "frames");
    for (index, id) in frames.items.iter().enumerate() {
        for port in ["trajectories", "also"] {
            assert_eq!(frames.connection(port).unwrap().arrivals_for(index)[0].name, *id);
        }
    }
}

#[test]
fn comments_order_layout_and_written_defaults_change_no_parameter() {
    let plain = checked(WHOLE, &[]);
    let other = WHOLE.replace(
        "[stages.people]\nuse = \"walkers\"\ninputs.town = \"town\"\ncount = 3\n",
        "# people\n[stages.people] # walk\nmargin_m = 0.50\ncount = 0x3\nspeed = { max_mps = 2, min_mps = 5e-1 }\n\
         inputs = { town = [ \"town\" ] }\nuse = 'walkers'\n",
    );
    assert_ne!(other, WHOLE);
    let crlf = checked(&other.replace('\n', "\r\n"), &[]);
    let bom = checked(&format!("\u{feff}{WHOLE}"), &[]);
    let other = checked(&other, &[]);
    for recipe in [&other, &crlf, &bom] {
        assert_eq!(settled(recipe, "people"), settled(&plain, "people"));
        assert_eq!(names(recipe), names(&plain));
    }
    let moved = WHOLE.replace("count = 3\n", "").replace("use = \"walkers\"", "count = 3\nuse = \"walkers\"");
    assert_eq!(stage(&checked(&moved, &[]), "people").parameters, stage(&plain, "people").parameters);
}

#[test]
fn overrides_replace_values_and_the_last_one_wins() {
    let recipe = checked(
        WHOLE,
        &[
            "seed=8",
            "name=other",
            "stages.people.count=9",
            "stages.people.count = 2",
            "stages.people.speed.max_mps=3",
            "stages.people.crowd=2026-05-01",
            "stages.people.crowd=two words",
            "stages.people.colour=[1, 2, 3]",
            "stages.people.colour.1=7",
            "stages.frames.inputs.trajectories=expert",
        ],
    );
    assert_eq!((recipe.name.as_str(), recipe.seed), ("other", 8));
    let people = settled(&recipe, "people");
    assert_eq!(people["count"], 2);
    assert_eq!(people["speed"]["max_mps"], 3.0);
    assert_eq!(people["crowd"], "two words");
    assert_eq!(people["colour"], serde_json::json!([1, 7, 3]));
    assert_eq!(stage(&recipe, "frames").items.len(), 2);
    assert_eq!(&*recipe.text, WHOLE);
}

#[test]
fn an_override_mends_a_broken_value() {
    let text = WHOLE.replace("count = 3", "count = 0");
    assert!(check(&text, &[]).is_err());
    assert_eq!(stage(&checked(&text, &["stages.people.count=5"]), "people").items.len(), 5);
}

#[test]
fn source_files_are_found_beside_the_recipe() {
    let recipe = checked(WHOLE, &[]);
    let [source] = &stage(&recipe, "town").sources[..] else { panic!("the town has one source") };
    assert_eq!(source.parameter, "source");
    assert_eq!(source.path, recipe.path.with_file_name("town.xodr"));
}

#[test]
fn a_variant_reads_the_item_that_it_is_a_variant_of() {
    let text = WHOLE.replace(
        "use = \"render\"\ninputs.town = \"town\"\n",
        "use = \"weathers\"\ninputs.also = [\"second\", \"expert\"]\n",
    );
    let recipe = checked(&text, &[]);
    let (frames, logs) = (stage(&recipe, "frames"), stage(&recipe, "tables.logs"));
    assert_eq!(frames.items.len(), 12);
    assert_eq!(frames.items[1].to_string(), "expert-path00000-Night");
    for (index, item) in frames.items.iter().enumerate() {
        for port in ["trajectories", "also"] {
            let read = &frames.connection(port).unwrap().arrivals_for(index)[0];
            assert_eq!(Some(&read.name), item.without_variant().as_ref());
            assert_eq!(recipe.stages[read.stage].items[read.item].of_stage(&recipe.stages[read.stage].name), read.name);
        }
    }
    assert_eq!(logs.items, frames.items);
}

#[test]
fn a_recipe_file_is_read_and_a_missing_one_names_the_nearest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("carla_town.toml");
    std::fs::write(&path, WHOLE).unwrap();
    std::fs::write(folder.path().join("town.xodr"), "").unwrap();
    assert_eq!(cosfly_recipe::load(&path, &[], &crate::toys::registry()).unwrap().path, path);
    let wrong = cosfly_recipe::load(&folder.path().join("carla_twon.toml"), &[], &crate::toys::registry()).unwrap_err();
    assert_eq!(wrong[0].code, "recipe-missing");
    assert!(wrong[0].hints[0].contains("carla_town.toml"), "{:?}", wrong[0].hints);
    std::fs::write(&path, b"name = \"\xff\"").unwrap();
    let wrong = cosfly_recipe::load(&path, &[], &crate::toys::registry()).unwrap_err();
    assert_eq!(wrong[0].code, "recipe-syntax");
    assert_eq!(
        cosfly_recipe::load(folder.path(), &[], &crate::toys::registry()).unwrap_err()[0].code,
        "recipe-unreadable"
    );
}

#[test]
fn thousands_of_items_are_known_before_anything_runs() {
    let overrides = ["stages.people.count=1000"];
    let recipe = checked(WHOLE, &overrides);
    assert_eq!(recipe.stages.iter().map(|stage| stage.items.len()).sum::<usize>(), 7002);
}
