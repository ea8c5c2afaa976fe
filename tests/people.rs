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
fn each_kind_of_person_is_a_target_without_traffic_and_one_more_walker_makes_only_itself() {
    let kinds = "child = 0.1, elder = 0.15, runner = 0.15, sitter = 0.1, wheelchair = 0.2, push_chair = 0.15, dog_walker = 0.15";
    let changed = RECIPE.replacen("count = 3", &format!("count = 12\nkinds = {{ {kinds} }}"), 1).replacen(
        "\"perturbed\"] }\nwidth = 96\nheight = 54",
        "\"perturbed\"], others = \"walkers\" }\nwidth = 192\nheight = 108",
        1,
    );
    assert!(changed.contains("others"));
    let street = Street::with(&changed, &map());
    made(&street, &[]);
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    let kinds = |table: &str, kind: &str, number: &str| {
        rows(&dataset, table, kind, number).into_iter().map(|(kind, _)| kind).collect::<BTreeSet<_>>()
    };
    let targets = kinds("trajectories", "target_kind", "frames");
    assert!(targets.len() > 5 && targets.contains("wheelchair"), "{targets:?}");
    let seen = kinds("bodies", "kind", "instance");
    assert!(seen.len() > 3 && seen.is_subset(&targets), "{seen:?} beside {targets:?}");
    let more = made(&street, &["stages.walkers.count=13"]);
    assert_eq!((more["walkers"], more["expert"], more["perturbed"]), (1, 1, 1), "{more:?}");
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

/// A mask picture of the street, white west of x = 30: walks begin and have goals there, by both stages, and `map inspect` shows it.
#[test]
fn a_mask_picture_says_where_walks_begin_and_its_pixels_are_part_of_the_key() {
    let place = "min_m = [-60, -80], max_m = [180, 90] }]";
    let street = Street::with(RECIPE, &map());
    let mask = crate::support::repository_root().join("tests/towns/west.png");
    std::fs::copy(&mask, street.path().join("west.png")).expect("copied");
    let change = format!("stages.walkers.areas=[{{ picture = \"west.png\", {place}");
    made(&street, &["stages.walkers.count=12", &change]);
    let poses = crate::support::column(&street.dataset(), "frames", "target_x_m");
    let first: Vec<f64> = poses.chunks(12).map(|flight| flight[0].parse().expect("a number")).collect();
    assert!(first.len() >= 12 && first.iter().all(|x| *x < 31.0), "{first:?}");
    // A copy elsewhere makes nothing again; other pixels do.
    std::fs::copy(&mask, street.path().join("copy.png")).expect("copied");
    let copy = change.replace("west", "copy");
    assert_eq!(made(&street, &["stages.walkers.count=12", &copy]), BTreeMap::new());
    let crowd = RECIPE.replacen("[stages.walkers]\nuse = \"pedestrians\"", "[stages.walkers]\nuse = \"traffic\"", 1);
    let crowd = crowd.replacen("count = 3", "people.count = 12\nfollow.count = 3\nfollow.min_length_m = 0.0", 1);
    std::fs::write(street.path().join("crowd.toml"), crowd).expect("writable");
    let within = change.replace("walkers.areas", "walkers.people.areas");
    cosfly(&["run", "crowd.toml", "--set", &within]).within(street.path()).run_ok();
    let shown = |file: &str, table: &str| {
        cosfly(&["map", "inspect", "street.xodr", "--plan", file, "--area", table]).within(street.path())
    };
    let table = change.split_once('[').expect("a table").1.trim_end_matches(']').to_owned();
    let text = shown("plan.png", &table).run_ok().stdout;
    assert!(text.contains("areas: ") && text.contains("walks begin on"), "{text}");
    cosfly(&["map", "inspect", "street.xodr", "--plan", "bare.png"]).within(street.path()).run_ok();
    let read = |file: &str| std::fs::read(street.path().join(file)).expect("a plan");
    assert_ne!(read("plan.png"), read("bare.png"));
    let off = table.replace("-60, -80", "960, 920").replace("180, 90", "1200, 1090");
    let said = shown("off.png", &off).run();
    assert!(said.code != Some(0) && said.stderr.contains("lies beside the walkable ground"), "{}", said.stderr);
    let wide = table.replace("180, 90", "180, 180");
    let said = shown("wide.png", &wide).run().stderr;
    assert!(said.contains("pixels must be square") && said.contains("west.png"), "{said}");
}
