//! Messages of errors: one snapshot per error, through the real binary.

use crate::street::{RECIPE, Street, map};
use crate::support::cosfly;
use std::path::Path;

/// Runs `arguments` in the street's folder and compares exit code and messages with the snapshot `name`. Redaction: the
/// scratch folder's path becomes `<folder>`.
fn check_refusal(name: &str, street: &Street, arguments: &[&str]) {
    let printed = cosfly(arguments).within(street.path()).run();
    let text = format!("exit code {}\n{}", printed.code.map_or("none".into(), |code| code.to_string()), printed.stderr);
    let text = text.replace(&street.path().display().to_string(), "<folder>");
    insta::assert_snapshot!(name, text);
    assert!(!street.dataset().exists(), "a refused run leaves no dataset behind");
}

fn check_recipe(name: &str, from: &str, to: &str) {
    assert!(RECIPE.contains(from), "`{from}` is in the recipe");
    check_refusal(name, &Street::with(&RECIPE.replacen(from, to, 1), &map()), &["run", "recipe.toml"]);
}

fn check_map(name: &str, from: &str, to: &str) {
    assert!(map().contains(from), "`{from}` is in the map");
    check_refusal(name, &Street::with(RECIPE, &map().replacen(from, to, 1)), &["run", "recipe.toml", "--quiet"]);
}

#[test]
fn recipe_mistakes_point_at_the_place_and_name_the_way_out() {
    check_recipe("unknown_key", "count = 3", "cuont = 3");
    check_recipe("unknown_kind", "use = \"plan\"", "use = \"plann\"");
    check_recipe("former_kind", "use = \"plan\"", "use = \"muco\"");
    check_recipe("former_input", "walks = \"walkers\"", "paths = \"walkers\"");
    check_recipe("former_key", "frames = 12", "steps = 12");
    check_recipe("wrong_type", "frames = 12", "frames = \"many\"");
    check_recipe("out_of_range", "width = 96", "width = 0");
    check_recipe("missing_input", "inputs.town = \"town\"\ncount", "count");
    check_recipe("unknown_stage", "walks = \"walkers\"", "walks = \"walker\"");
    check_recipe("wrong_artifact", "walks = \"walkers\"", "walks = \"town\"");
    check_recipe("missing_file", "street.xodr", "streets.xodr");
    check_recipe("toml_syntax", "seed = 3", "seed = = 3");
    check_recipe("cycle", "trajectories = \"expert\"", "trajectories = \"perturbed\"");
    check_recipe("unknown_weather", "width = 96", "weathers = [\"ClearNun\"]\nwidth = 96");
    check_recipe("not_a_number", "seed = 3", "seed = nan");
    check_recipe("town_name", "source", "name = \"Zürich\"\nsource");
    check_recipe("map_foreign_option", "source", "options = { terrain_margin_m = 20 }\nsource");
    check_recipe("map_option_of_several", "source", "options = { voxel_m = 1 }\nsource");
    check_recipe("map_former_option", "source", "road_marks = false\nsource");
}

#[test]
fn command_line_mistakes_are_explained() {
    let street = Street::new();
    check_refusal("set_unknown_stage", &street, &["run", "recipe.toml", "--set", "stages.exprt.weights.visibility=5"]);
    check_refusal("set_without_value", &street, &["run", "recipe.toml", "--set", "seed"]);
    check_refusal("no_such_recipe", &street, &["run", "recipes.toml"]);
    check_refusal("why_unknown_item", &street, &["why", "recipe.toml", "expert/p99999"]);
}

#[test]
fn broken_maps_name_line_column_and_element() {
    let whole = map();
    let truncated = Street::with(RECIPE, &whole[..whole.find("<objects>").expect("objects") + 40]);
    check_refusal("map_truncated", &truncated, &["run", "recipe.toml", "--quiet"]);
    check_map("map_broken_xml", "</planView>", "</planview>");
    check_map("map_not_a_number", "hdg=\"0.0\" length=\"120.0\"", "hdg=\"nan\" length=\"120.0\"");
    check_map("map_absurd_number", "a=\"3.5\"", "a=\"3.5e30\"");
    check_map("map_missing_attribute", "s=\"0.0\" x=\"0.0\"", "x=\"0.0\"");
    check_refusal("map_of_no_known_format", &Street::with(RECIPE, "hello"), &["run", "recipe.toml", "--quiet"]);
    check_refusal("map_without_roads", &Street::with(RECIPE, "<OpenDRIVE/>"), &["run", "recipe.toml", "--quiet"]);
}

#[test]
fn a_town_without_pavements_is_refused_on_request_only() {
    let arguments = ["run", "recipe.toml", "--quiet"];
    let strict = RECIPE.replacen("source", "options = { assume_ground = false }\nsource", 1);
    for instead in ["shoulder", "none"] {
        let text = map().replace("type=\"sidewalk\"", &format!("type=\"{instead}\""));
        check_refusal("no_walkable_ground", &Street::with(&strict, &text), &arguments);
        cosfly(&arguments).within(Street::with(RECIPE, &text).path()).run_ok();
    }
}

#[test]
fn a_target_that_nobody_can_reach_is_rejected_in_words() {
    // The pedestrian walks faster than this drone may fly.
    let slow = ["stages.expert.limits.speed_mps=0.5", "stages.expert.limits.acceleration_mps2=0.1"];
    let arguments = ["run", "recipe.toml", "--quiet", "--jobs", "1", "--set", slow[0], "--set", slow[1]];
    check_refusal("target_unreachable", &Street::new(), &arguments);
}

#[test]
fn a_flight_planned_in_one_town_is_not_filmed_in_another() {
    let other =
        "[stages.other]\nuse = \"map\"\nsource = \"street.xodr\"\noptions.road_marks = false\n\n[stages.walkers]";
    let mixed = RECIPE.replacen("[stages.walkers]", other, 1).replacen(
        "inputs = { town = \"town\", trajectories = [",
        "inputs = { town = \"other\", trajectories = [",
        1,
    );
    check_refusal("towns_differ", &Street::with(&mixed, &map()), &["run", "recipe.toml", "--quiet", "--jobs", "1"]);
}

#[test]
fn a_store_of_a_newer_format_is_refused_by_name() {
    let street = Street::new();
    let store = street.path().join(".cosfly");
    std::fs::create_dir_all(&store).expect("writable");
    std::fs::write(store.join("format"), "cosfly-store 99\n").expect("writable");
    check_refusal("store_newer", &street, &["run", "recipe.toml"]);
}

#[test]
fn a_folder_that_is_not_ours_is_never_replaced() {
    let street = Street::new();
    let precious = street.path().join("mine");
    std::fs::create_dir_all(&precious).expect("writable");
    std::fs::write(precious.join("thesis.txt"), "months of work").expect("writable");
    check_refusal("foreign_out", &street, &["run", "recipe.toml", "--quiet", "--out", "mine"]);
    assert!(precious.join("thesis.txt").exists());
}

/// A small file system that fills up; `None` (after printing the reason) where mounting is not allowed.
fn small_disk(folder: &Path) -> Option<SmallDisk> {
    let path = folder.join("disk");
    std::fs::create_dir_all(&path).expect("writable");
    let mounted = std::process::Command::new("mount")
        .args(["-t", "tmpfs", "-o", "size=400k", "tmpfs"])
        .arg(&path)
        .stderr(std::process::Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    if !mounted {
        eprintln!("skipped: no right to mount a small file system here");
    }
    mounted.then_some(SmallDisk { path })
}

struct SmallDisk {
    path: std::path::PathBuf,
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = std::process::Command::new("umount").arg(&self.path).status();
    }
}

#[test]
fn a_full_disk_is_named_and_nothing_half_written_is_trusted() {
    let street = Street::new();
    let Some(disk) = small_disk(street.path()) else { return };
    let store = disk.path.join("store").display().to_string();
    let printed = cosfly(&["run", "recipe.toml", "--quiet", "--store", &store]).within(street.path()).run();
    assert_eq!(printed.code, Some(5), "{}", printed.stderr);
    assert!(
        printed.stderr.contains("disk-full") && printed.stderr.contains("finished items of a run are kept"),
        "{}",
        printed.stderr
    );
    assert!(!street.dataset().exists());
}

#[test]
fn on_a_full_disk_no_command_leaves_anything_and_none_advises_what_it_lacks() {
    let street = Street::new();
    let Some(disk) = small_disk(street.path()) else { return };
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let fly = ["fly", "recipe.toml", "--policy", "follow", "--out", "flown", "--clips", "0"];
    cosfly(&fly).within(street.path()).run_ok();
    let ballast = std::fs::File::create(disk.path.join("ballast")).expect("writable");
    let full = std::io::copy(&mut std::io::repeat(0), &mut &ballast).expect_err("it has an end");
    assert_eq!(full.kind(), std::io::ErrorKind::StorageFull);
    for line in [
        "preview out/street --out disk/new",
        "preview out/street --out disk/new/in/new",
        "eval out/street --out disk/new",
        "export out/street --format coco --out disk/new",
        "export out/street --format coco --out disk/new/in/new",
        "view out/street --export disk/new.html",
        "doctor out/street --out disk/new.json",
        "carla-job out/street --out disk/new.jsonl",
        "map convert street.xodr --out disk/new.glb",
        "map inspect street.xodr --plan disk/new.png",
        "fly bags flown/follow --out disk/new",
        "fly bundle flown/follow --out disk/new.jsonl.zst",
        "run recipe.toml --quiet --out disk/new",
        "fly recipe.toml --policy follow --out disk/new",
        "init disk/new",
        "plugin new --kind cost-term disk/new",
    ] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let printed = cosfly(&words).within(street.path()).run();
        assert_eq!(printed.code, Some(5), "{line}: {}", printed.stderr);
        assert!(printed.stderr.contains("[disk-full]"), "{line}: {}", printed.stderr);
        let entries =
            std::fs::read_dir(&disk.path).expect("a folder").map(|entry| entry.expect("readable").file_name());
        let names: Vec<String> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
        assert_eq!(names, ["ballast"], "{line}");
        let help = cosfly(&[&words[..1], &["--help"]].concat()).run_ok().stdout;
        let options = printed.stderr.split('`').filter(|word| word.starts_with("--"));
        options.for_each(|option| assert!(help.contains(option), "{line}: {option}"));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn what_standard_error_cannot_take_changes_no_exit_code() {
    assert_eq!(cosfly(&["doctor", "/nowhere"]).run_untold(), Some(4));
    assert_eq!(cosfly(&["run", "/nowhere.toml"]).run_untold(), Some(3));
    let street = Street::new();
    assert_eq!(cosfly(&["run", "recipe.toml"]).within(street.path()).run_untold(), Some(0));
}

#[test]
fn commands_that_are_told_can_be_pasted() {
    let folder = tempfile::tempdir().expect("a folder");
    let printed = cosfly(&["init", "my street", "--template", "small"]).within(folder.path()).run_ok();
    assert!(printed.stdout.contains("cosfly run 'my street'\n"), "{}", printed.stdout);
    let page = std::fs::read_to_string(folder.path().join("my street/README.md")).expect("a page");
    assert!(page.starts_with("# my street\n") && page.contains("cosfly plan 'my street' "), "{page}");
}

/// Commands that make a recipe of their arguments: problems point to what was written, not to lines that nobody wrote.
#[test]
fn problems_of_arguments_point_to_the_arguments() {
    let street = Street::new();
    let refused = |arguments: &[&str]| cosfly(arguments).within(street.path()).run().stderr;
    for command in [&["map", "inspect", "streets.xodr"][..], &["map", "convert", "streets.xodr", "--out", "a.glb"]] {
        let told = refused(command);
        assert!(
            told.contains("there is no file `streets.xodr`") && told.contains("did you mean `street.xodr`?"),
            "{told}"
        );
        assert!(told.contains("relative to the current folder") && !told.contains("-->"), "{told}");
    }
    let given = ["map", "inspect", "street.xodr"];
    let told = refused(&[&given[..], &["--set", "simplify_m=1", "--set", "trim=3"]].concat());
    assert!(told.contains("--> --set:1:1\n") && told.contains("1 | trim=3\n"), "{told}");
    let table = "{ picture = 'mask.png', min_m = [0, 0], max_m = [9, 9] }";
    let told = refused(&[&given[..], &["--area", "{ weight = 0.5, foo = 3 }"]].concat());
    assert!(told.contains("--> --area:1:17\n") && told.contains("1 | { weight = 0.5, foo = 3 }\n"), "{told}");
    let told =
        refused(&[&given[..], &["--area", "{ polygon_m = [[0, 0], [9, 0], [9, 9]] }", "--area", table]].concat());
    assert!(told.contains("there is no file `mask.png`") && told.contains("--> --area:1:13\n"), "{told}");
}

/// Files that others open by their ending.
#[test]
fn files_whose_ending_names_another_format_are_refused() {
    let street = Street::new();
    for line in [
        "leaderboard entries --out page.pdf",
        "map convert street.xodr --out town.obj",
        "map inspect street.xodr --plan plan.jpg",
        "map inspect street.xodr --plan plan",
        "map tiles tileset.json --out town.gltf",
        "view out/street --export page.png",
    ] {
        let printed = cosfly(&line.split(' ').collect::<Vec<_>>()).within(street.path()).run();
        assert_eq!(printed.code, Some(2), "{line}: {}", printed.stderr);
        assert!(printed.stderr.contains("the file must end in ."), "{line}: {}", printed.stderr);
    }
    cosfly(&["map", "inspect", "street.xodr", "--plan", "PLAN.PNG"]).within(street.path()).run_ok();
}
