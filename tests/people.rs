//! Bystanders in the pictures, through the real binary: labelled and verified, and without influence on the planner.

use crate::street::{RECIPE, Street, map};
use crate::support::{cosfly, tree_digests};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The street with a crowd of eight, and all walkers in its pictures.
fn street() -> Street {
    let crowd =
        "[stages.crowd]\nuse = \"pedestrians\"\ninputs.town = \"town\"\ncount = 8\nframes = 8\n\n[stages.frames]";
    let changed = RECIPE.replacen("[stages.frames]", crowd, 1).replacen(
        "trajectories = [\"expert\", \"perturbed\"] }\nwidth",
        "trajectories = [\"expert\", \"perturbed\"], others = [\"walkers\", \"crowd\"] }\nwidth",
        1,
    );
    assert!(changed.contains("others"));
    Street::with(&changed, &map())
}

/// Numbers of items made per stage.
fn made(street: &Street, overrides: &[&str]) -> BTreeMap<String, u64> {
    let mut arguments = vec!["run", "recipe.toml", "--json"];
    overrides.iter().for_each(|change| arguments.extend_from_slice(&["--set", change]));
    let printed = cosfly(&arguments).within(street.path()).run_ok();
    let summary: serde_json::Value = serde_json::from_str(&printed.stdout).expect("a JSON summary");
    let stages = summary["stages"].as_array().expect("stages").iter();
    let ran = stages.map(|it| (it["stage"].as_str().expect("name").to_owned(), it["ran"].as_u64().expect("count")));
    ran.filter(|(_, ran)| *ran > 0).collect()
}

/// A text and an integer of every row of a table.
pub fn rows(dataset: &Path, table: &str, text: &str, number: &str) -> Vec<(String, i64)> {
    let mut rows = vec![];
    let folder = std::fs::read_dir(dataset.join("data").join(table)).expect("the table");
    for file in folder.map(|entry| entry.expect("readable").path()) {
        let reader = SerializedFileReader::new(std::fs::File::open(file).expect("readable")).expect("Parquet");
        let names: Vec<String> =
            reader.metadata().file_metadata().schema().get_fields().iter().map(|field| field.name().into()).collect();
        let place = |name: &str| names.iter().position(|it| it == name).expect("the column");
        let (text, number) = (place(text), place(number));
        rows.extend(reader.get_row_iter(None).expect("rows").map(|row| {
            let row = row.expect("a row");
            (row.get_string(text).expect("a text").clone(), row.get_long(number).expect("a number"))
        }));
    }
    rows
}

#[test]
fn a_crowd_is_in_pictures_and_tables_and_another_one_plans_nothing_anew() {
    let street = street();
    let first = made(&street, &[]);
    assert_eq!((first["crowd"], first["frames"], first["dataset.logs"]), (8, 6, 6));
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    let people = rows(&dataset, "bodies", "body_id", "instance");
    let ids: BTreeMap<&str, i64> = people.iter().map(|(walk, id)| (walk.as_str(), *id)).collect();
    assert!(ids.len() > 3 && people.iter().all(|(walk, id)| ids[walk.as_str()] == *id), "one id in all flights");
    assert_eq!(ids.values().collect::<BTreeSet<_>>().len(), ids.len());
    let objects = rows(&dataset, "objects", "town", "instance").into_iter().map(|(_, id)| id).max();
    assert!(ids.values().all(|id| Some(*id) > objects), "{ids:?} {objects:?}");
    let followed = rows(&dataset, "bodies", "trajectory_id", "instance");
    for (walk, id) in ids.iter().filter(|(walk, _)| walk.starts_with("walkers-")) {
        let item = walk.trim_start_matches("walkers-");
        assert!(!followed.iter().any(|(flight, seen)| flight.ends_with(item) && seen == id), "{walk} follows itself");
    }
    let more = made(&street, &["stages.crowd.count=9"]);
    assert!(["walkers", "expert", "perturbed", "captions"].iter().all(|stage| !more.contains_key(*stage)), "{more:?}");
    assert_eq!((more["crowd"], more["frames.nearby"]), (1, 6));
}

#[test]
fn drones_behind_one_walk_are_in_each_others_pictures_under_the_names_of_their_flights() {
    let behind = "walks = \"walkers\" }\n";
    let with_drones = RECIPE.replacen(behind, &format!("{behind}drones = {{ count = 2, separation_m = 4.0 }}\n"), 1);
    let street = Street::with(&with_drones, &map());
    let wide = ["stages.frames.width=320", "stages.frames.height=180", "stages.frames.fov_deg=120"];
    let first = made(&street, &wide);
    assert_eq!((first["expert.formation"], first["expert"], first["frames"]), (3, 6, 12));
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    let (mut kinds, mut names) = (BTreeSet::new(), BTreeMap::new());
    let people = rows(&dataset, "bodies", "kind", "instance");
    let named = rows(&dataset, "bodies", "body_id", "instance").into_iter();
    for (((kind, _), (body_id, id)), (flight, _)) in
        people.into_iter().zip(named).zip(rows(&dataset, "bodies", "trajectory_id", "instance"))
    {
        kinds.insert(kind);
        // The other drone of the same walk, never the own one or that of another walk.
        let own = flight.split_once('-').expect("a stage and an item").1;
        let other = body_id.split_once('-').expect("a stage and an item").1;
        assert!(own != other && own[..6] == other[..6], "{flight} shows {body_id}");
        assert_eq!(*names.entry(other[7..].to_owned()).or_insert(id), id, "one id in all flights");
    }
    assert_eq!((kinds, names.is_empty()), (BTreeSet::from(["drone".to_owned()]), false));
}

#[test]
fn a_crowd_has_the_same_bytes_on_one_thread_and_on_three() {
    let dataset = |jobs: &str| {
        let street = street();
        cosfly(&["run", "recipe.toml", "--quiet", "--jobs", jobs]).within(street.path()).run_ok();
        tree_digests(&street.dataset())
    };
    assert_eq!(dataset("1"), dataset("3"));
}

#[test]
fn people_of_another_town_are_refused() {
    let street = street();
    let path = street.path().join("recipe.toml");
    let recipe = std::fs::read_to_string(&path).expect("readable");
    let elsewhere =
        "[stages.elsewhere]\nuse = \"map\"\nsource = \"street.xodr\"\nfill = { trees = true }\n\n[stages.crowd]";
    let changed = recipe.replacen("[stages.crowd]", elsewhere, 1);
    let crowd = "[stages.crowd]\nuse = \"pedestrians\"\ninputs.town = ";
    let changed = changed.replacen(&format!("{crowd}\"town\""), &format!("{crowd}\"elsewhere\""), 1);
    std::fs::write(&path, changed).expect("writable");
    let printed = cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run();
    assert_eq!(printed.code, Some(3), "{}", printed.stderr);
    assert!(printed.stderr.contains("inputs.others"), "{}", printed.stderr);
}
