//! Plugins through the real binary: every recipe with one, caching after a change, errors, failures, commands.

use crate::support::{column, cosfly, repository_root};
use arrow_stream::Values;
use std::path::{Path, PathBuf};

#[path = "../plugins/sdk/src/arrow_stream.rs"]
mod arrow_stream;
#[path = "../plugins/sdk/src/flatbuffers.rs"]
mod flatbuffers;
#[path = "../engine/edge/plugin-host/tests/host/stage_text.rs"]
mod stage_text;

use stage_text::StageText;

/// A folder with the town, the plugins and a recipe.
struct Yard {
    folder: tempfile::TempDir,
}

const RECIPE: &str = r#"name = "yard"
seed = 7

[stages.town]
use = "map"
source = "street.xodr"

[stages.walkers]
use = "pedestrians"
inputs.town = "town"
count = 2
frames = 12

[stages.expert]
use = "plan"
inputs = { town = "town", walks = "walkers" }

[[stages.expert.terms]]
use = "wasm:no_fly_zone.wasm"
weight = 5.0
params.margin_m = 4.0
params.zones = [{ corners = [[0, 0], [9, 0], [9, 9]], low_m = 0, high_m = 20 }]

[stages.kept]
use = "wasm:keep_good.wasm"
inputs = { town = "town", trajectories = "expert" }
params.rules = [{ column = "cost_no_fly_zone", of = "max", at_most = 1e6 }]

[stages.frames]
use = "render"
inputs = { town = "town", trajectories = ["kept"] }
width = 96
height = 54

[stages.dataset]
use = "dataset"
inputs = { town = "town", frames = "frames" }
name = "yard"
title = "A yard"
"#;

impl Yard {
    fn with(recipe: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("street.xodr"), crate::street::map()).expect("writable");
        std::fs::write(folder.path().join("recipe.toml"), recipe).expect("writable");
        for plugin in ["no_fly_zone", "keep_good", "orbit", "tum"] {
            let file = format!("{plugin}.wasm");
            std::fs::copy(plugins().join(&file), folder.path().join(file)).expect("the plugin is there");
        }
        Self { folder }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Exit code and standard error of a command.
    fn refusal(&self, arguments: &[&str]) -> (Option<i32>, String) {
        let printed = cosfly(arguments).within(self.path()).run();
        // Long lines are wrapped.
        (printed.code, printed.stderr.split_whitespace().collect::<Vec<_>>().join(" "))
    }

    /// Numbers of items made per stage.
    fn made(&self) -> Vec<(String, u64)> {
        let printed = cosfly(&["run", "recipe.toml", "--json"]).within(self.path()).run_ok();
        let summary: serde_json::Value = serde_json::from_str(&printed.stdout).expect("a JSON summary");
        let stages = summary["stages"].as_array().expect("stages").iter();
        let ran = stages
            .map(|stage| (stage["stage"].as_str().expect("name").to_owned(), stage["ran"].as_u64().expect("count")));
        ran.filter(|(_, ran)| *ran > 0).collect()
    }
}

/// Ids of all kept flights.
const EXAMPLES: [&str; 12] = [
    "no_fly_zone",
    "privacy",
    "sun_glare",
    "wind",
    "keep_good",
    "seconds_to_loss",
    "tum",
    "viewpoint",
    "losses",
    "patrol",
    "inspection",
    "orbit",
];

fn plugins() -> PathBuf {
    repository_root().join("recipes/plugins")
}

#[test]
fn every_recipe_with_a_plugin_makes_a_sound_dataset() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    for name in ["no_fly_zone", "privacy", "sun_glare", "wind", "judged", "extras", "patrol", "inspection", "orbit"] {
        let recipe = format!("recipes/{name}.toml");
        cosfly(&["run", &recipe, "--quiet", "--store", &at("store"), "--out", &at(name)]).run_ok();
        cosfly(&["verify", &at(name)]).run_ok();
    }
}

#[test]
fn labels_stand_in_columns_of_their_own_with_the_plugin_that_gave_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let (store, out) = (folder.path().join("store"), folder.path().join("out"));
    let at = |path: &Path| path.display().to_string();
    cosfly(&["run", "recipes/judged.toml", "--quiet", "--store", &at(&store), "--out", &at(&out)]).run_ok();
    assert_eq!(column(&out, "trajectories", "label_names")[0], "[\"seconds_to_loss\"]");
    assert_eq!(column(&out, "trajectories", "label_plugins")[0], "[\"seconds_to_loss 0.1.0\"]");
    assert!(!column(&out, "trajectories", "term_names")[0].contains("loss"));
    let labels = column(&out, "frames", "labels");
    let seconds = |cell: &String| cell.trim_matches(['[', ']']).parse::<f64>().expect("one number");
    assert!(labels.iter().map(seconds).all(|seconds| (0.0..=8.0).contains(&seconds)), "{labels:?}");
}

#[test]
fn a_plugin_changed_by_one_byte_reruns_only_what_uses_it() {
    let yard = Yard::with(RECIPE);
    assert!(yard.made().contains(&("expert".to_owned(), 2)));
    assert!(yard.made().is_empty());
    // A custom section: the same functions, other bytes.
    let file = yard.path().join("no_fly_zone.wasm");
    let mut bytes = std::fs::read(&file).expect("readable");
    bytes.extend([0, 4, 1, b'n', b'e', b'w']);
    std::fs::write(&file, bytes).expect("writable");
    assert_eq!(yard.made(), [("expert".to_owned(), 2)], "what is made of equal flights is not made again");
    let why = cosfly(&["plan", "recipe.toml"]).within(yard.path()).run_ok().stdout;
    assert!(!why.contains("walkers  2 to run"), "{why}");
}

#[test]
fn parameters_are_held_against_what_the_plugin_declares_before_anything_runs() {
    for (from, to, words) in [
        (
            "margin_m = 4.0",
            "margin_m = 400.0",
            "`terms.0.params.margin_m` is `400.0`; it must be at least `0` and at most `100`",
        ),
        ("margin_m = 4.0", "margn_m = 4.0", "did you mean `margin_m`?"),
        ("margin_m = 4.0", "margin_m = \"4\"", "leave out the quotes"),
        ("low_m = 0", "low_m = true", "it must be a number"),
        ("of = \"max\"", "off = \"max\"", "`off` is not a parameter"),
    ] {
        let yard = Yard::with(&RECIPE.replacen(from, to, 1));
        let (code, text) = yard.refusal(&["plan", "recipe.toml"]);
        assert_eq!(code, Some(3), "{text}");
        assert!(text.contains(words) && text.contains("recipe.toml:"), "{to}: {text}");
    }
}

#[test]
fn files_that_are_not_the_wanted_plugin_are_refused_at_their_place() {
    for (from, to, words) in [
        ("wasm:no_fly_zone", "wasm:keep_good", "it is a stage; a cost term is wanted here"),
        ("wasm:no_fly_zone", "wasm:no_fly_zon", "did you mean `no_fly_zone.wasm`?"),
        ("wasm:no_fly_zone.wasm", "wasm:recipe.toml", "it is not a WebAssembly file"),
        (
            "weight = 5.0",
            "sha256 = \"0000000000000000000000000000000000000000000000000000000000000000\"",
            "its SHA-256 is",
        ),
        ("weight = 5.0", "limits.memory_mib = 1", "its limit is 1 MiB"),
    ] {
        let (code, text) = Yard::with(&RECIPE.replacen(from, to, 1)).refusal(&["plan", "recipe.toml"]);
        assert!(matches!(code, Some(3 | 4)), "{text}");
        assert!(text.contains(words) && text.contains("recipe.toml:"), "{to}: {text}");
    }
    let objective = RECIPE.replacen("[[stages.expert.terms]]", "[stages.expert.plugin]", 1).replace("weight = 5.0", "");
    let (code, text) = Yard::with(&objective).refusal(&["plan", "recipe.toml"]);
    assert_eq!(code, Some(3), "{text}");
}

#[test]
fn a_failing_plugin_is_named_with_function_and_item_and_the_rest_goes_on() {
    let yard = Yard::with(&RECIPE.replace("cost_no_fly_zone", "cost_colour"));
    let (code, text) = yard.refusal(&["run", "recipe.toml", "--quiet"]);
    assert_eq!(code, Some(4), "{text}");
    assert!(text.contains("plugin `keep_good.wasm` failed in `configure` for `kept/p00000`"), "{text}");
    assert!(
        text.contains("it reads `cost_colour`; flights have no such column; their columns are `frame`, `time_s`"),
        "{text}"
    );
    std::fs::write(yard.path().join("recipe.toml"), RECIPE).expect("writable");
    assert!(!yard.made().iter().any(|(stage, _)| stage == "expert"), "the experts were finished");
}

#[test]
fn what_a_stage_reads_and_makes_is_held_against_what_there_is_before_anything_runs() {
    for (from, to, words) in [
        (
            "cost_no_fly_zone",
            "visibilty",
            "it reads `visibilty`; flights have no such column; their columns are `frame`, `time_s`",
        ),
        ("cost_no_fly_zone", "visibilty", "did you mean `visibility`?"),
        ("cost_no_fly_zone", "frame", "it reads `frame` as real; it is integer"),
        ("cost_no_fly_zone", "box_left", "which only rendered flights have"),
        ("wasm:keep_good.wasm", "wasm:tum.wasm", "it is an exporter of files, and makes no flights"),
    ] {
        let mut recipe = RECIPE.replacen(from, to, 1);
        if to.contains("tum") {
            recipe =
                recipe.replace("params.rules = [{ column = \"cost_no_fly_zone\", of = \"max\", at_most = 1e6 }]", "");
        }
        let yard = Yard::with(&recipe);
        let (code, text) = yard.refusal(&["plan", "recipe.toml"]);
        assert_eq!(code, Some(4), "{text}");
        assert!(text.contains(words) && text.contains("recipe.toml:"), "{to}: {text}");
        assert!(text.contains("failed in `configure`"), "{text}");
    }
}

/// The yard's recipe with an exporter.
fn with_extras(file: &str) -> String {
    let stage = format!(
        "[stages.more]\nuse = \"wasm:{file}\"\nmakes = \"extras\"\ninputs = {{ town = \"town\", frames = \"frames\" }}\n\n[stages.dataset]"
    );
    let recipe = RECIPE.replace("[stages.dataset]", &stage);
    recipe.replace("frames = \"frames\" }\nname", "frames = \"frames\", extras = [\"more\"] }\nname")
}

#[test]
fn an_exporter_adds_files_that_the_dataset_knows_and_a_changed_one_renders_nothing_anew() {
    let yard = Yard::with(&with_extras("tum.wasm"));
    assert!(yard.made().contains(&("more".to_owned(), 2)));
    let out = yard.path().join("out/yard");
    let text = std::fs::read_to_string(out.join("extras/tum/street/000/kept-p00000/camera.txt")).expect("a file");
    assert_eq!(text.lines().count(), 13, "{text}");
    assert!(std::fs::read_to_string(out.join("README.md")).expect("a card").contains("### tum"));
    cosfly(&["verify", "out/yard"]).within(yard.path()).run_ok();
    // A file that the exporter did not write is found.
    let damaged = out.join("extras/tum/street/000/kept-p00000/camera.txt");
    // Not through the hard link into the store.
    std::fs::remove_file(&damaged).and_then(|()| std::fs::write(&damaged, "damaged")).expect("writable");
    let (code, _) = yard.refusal(&["verify", "out/yard"]);
    assert_ne!(code, Some(0));
    let file = yard.path().join("tum.wasm");
    let mut bytes = std::fs::read(&file).expect("readable");
    bytes.extend([0, 4, 1, b'n', b'e', b'w']);
    std::fs::write(file, bytes).expect("writable");
    assert_eq!(yard.made(), [("more".to_owned(), 2)]);
}

#[test]
fn hostile_answers_are_refused_with_plugin_function_and_item_and_the_rest_goes_on() {
    let reals = |name: &str, values: &[f64]| (name.to_owned(), Values::Reals(values.to_vec()));
    let texts =
        |name: &str, values: &[&str]| (name.to_owned(), Values::Texts(values.iter().map(|it| (*it).into()).collect()));
    let bytes = |count: usize| ("content".to_owned(), Values::Bytes(vec![b"x".to_vec(); count]));
    let file = |paths: &[&str]| arrow_stream::write(&[texts("path", paths), bytes(paths.len())]);
    let rows = StageText { effect: 3, name: "more", gives: vec![("risk", 0)], ..StageText::default() };
    let note = StageText { effect: 2, ..rows.clone() };
    let files = StageText { effect: 4, gives: vec![("path", 3), ("content", 4)], ..rows.clone() };
    let good = arrow_stream::write(&[reals("risk", &[0.5])]);
    let yard = Yard::with(&with_extras("hostile.wasm"));
    let write = |text: &StageText| std::fs::write(yard.path().join("hostile.wasm"), text.bytes()).expect("writable");
    for (text, answer, words) in [
        (&files, file(&["../../x"]), "it returned a file `../../x`; paths are relative"),
        (&files, file(&["a", "a"]), "the file `a` twice"),
        (&files, file(&["a"; 1001]), "1001 rows; at most 1000 are allowed"),
        (&note, arrow_stream::write(&[reals("risk", &[0.5, 0.5])]), "2 rows; one is required"),
        (&note, arrow_stream::write(&[reals("cost", &[0.5])]), "column 0 is `cost`; it declares `risk` (real)"),
        (&note, arrow_stream::write(&[texts("risk", &["high"])]), "its column `risk` holds Utf8; it declares Float64"),
        (&note, arrow_stream::write(&[reals("risk", &[f64::NAN])]), "its column `risk` at row 0 is not a number"),
        (&rows, good[..good.len() - 40].to_vec(), "it returned no Arrow stream: it ends within message 1"),
        (&rows, b"no table".to_vec(), "it returned no Arrow stream: no message begins at byte 0"),
    ] {
        write(&StageText { answer, ..text.clone() });
        let (code, text) = yard.refusal(&["run", "recipe.toml", "--quiet"]);
        assert_eq!(code, Some(4), "{text}");
        assert!(text.contains("plugin `hostile.wasm` failed in `run` for `more/kept-p0000"), "{text}");
        assert!(text.contains(words), "{text}");
    }
    for (name, gives, words) in [
        ("frames", ("risk", 0), "it names its table `frames`, which is reserved for the dataset's own tables"),
        ("more", ("trajectory_id", 3), "it gives a column `trajectory_id`, which the dataset adds itself"),
    ] {
        write(&StageText { name, gives: vec![gives], ..rows.clone() });
        let (code, text) = yard.refusal(&["run", "recipe.toml", "--quiet"]);
        assert!(code == Some(4) && text.contains(words) && text.contains("recipe.toml:"), "{text}");
    }
    write(&StageText { answer: good, ..note });
    let made = yard.made();
    assert!(
        made.iter().all(|(stage, _)| stage == "more" || stage.starts_with("dataset")),
        "all else was finished: {made:?}"
    );
    assert_eq!(column(&yard.path().join("out/yard"), "more", "risk"), ["0.5", "0.5"]);
}

#[test]
fn a_filter_rejects_with_its_reason() {
    let yard = Yard::with(&RECIPE.replace("at_most = 1e6", "at_most = -1.0"));
    let printed = cosfly(&["run", "recipe.toml", "--json"]).within(yard.path()).run();
    assert!(printed.stdout.contains("max of `cost_no_fly_zone` is"), "{}{}", printed.stdout, printed.stderr);
}

#[test]
fn the_example_plugins_keep_the_laws_of_their_kinds() {
    for name in EXAMPLES {
        let file = plugins().join(format!("{name}.wasm")).display().to_string();
        let text = cosfly(&["plugin", "check", &file]).run_ok().stdout;
        assert!(text.contains("it keeps the laws of its kind"), "{text}");
    }
    // Parameters that no recipe could give are not tried.
    let wind = plugins().join("wind.wasm").display().to_string();
    for (params, words) in
        [("{\"sped_mps\": 9}", "did you mean `speed_mps`?"), ("{\"speed_mps\": -9}", "must be at least 0")]
    {
        let printed = cosfly(&["plugin", "check", &wind, "--params", params]).run();
        assert!(
            printed.code == Some(3) && printed.stderr.contains(words),
            "{params}: {}{}",
            printed.stdout,
            printed.stderr
        );
    }
    let in_c = repository_root().join("plugins/examples/in_c/steady_height.wasm").display().to_string();
    assert!(cosfly(&["plugin", "check", &in_c]).run_ok().stdout.contains("it keeps the laws of its kind"));
}

#[test]
fn a_new_plugin_is_a_project_with_all_that_it_needs() {
    let folder = tempfile::tempdir().expect("a folder");
    for kind in ["cost-term", "objective", "stage"] {
        let name = kind.replace('-', "_");
        cosfly(&["plugin", "new", "--kind", kind, &name]).within(folder.path()).run_ok();
        let source = std::fs::read_to_string(folder.path().join(&name).join("src/lib.rs")).expect("a source");
        assert!(source.contains(&format!("name: \"{name}\"")) && source.lines().count() < 80, "{source}");
        let sdk = folder.path().join(&name).join("sdk/src");
        let mut wanted = vec![];
        for entry in std::fs::read_dir(repository_root().join("plugins/sdk/src")).expect("the sdk") {
            wanted.push(entry.expect("an entry").file_name());
        }
        assert!(wanted.iter().all(|file| sdk.join(file).exists()), "{wanted:?}");
    }
    let again = cosfly(&["plugin", "new", "--kind", "stage", "stage"]).within(folder.path()).run();
    assert_eq!(again.code, Some(3), "{}", again.stderr);
}

#[test]
fn the_books_page_of_the_interface_is_the_interface() {
    let root = repository_root();
    let page = std::fs::read_to_string(root.join("book/src/reference/plugin-interface.md")).expect("a page");
    let mut rest = page.as_str();
    for name in ["types", "host", "cost-term", "objective", "stage"] {
        let text = std::fs::read_to_string(root.join(format!("plugins/wit/{name}.wit"))).expect("a part of it");
        let shown = format!("## `{name}.wit`\n\n```wit\n{text}```\n");
        let at = rest.find(&shown);
        rest = &rest[at.expect("as `plugins/build.sh` writes it") + shown.len()..];
    }
    assert!(rest.is_empty(), "run `plugins/build.sh`");
}

#[test]
fn the_plugins_that_are_kept_are_built_from_the_sources_beside_them() {
    let root = repository_root();
    let kept = std::fs::read_to_string(root.join("recipes/plugins/built_from.txt")).expect("the digest is kept");
    let script = "find sdk ../engine/lab/bench/twin/src ../engine/lab/bench/twin/Cargo.toml examples wit Cargo.toml Cargo.lock -type f | LC_ALL=C sort | xargs sha256sum | sha256sum | cut -d' ' -f1";
    let output = std::process::Command::new("bash").args(["-c", script]).current_dir(root.join("plugins")).output();
    let Ok(output) = output else { return eprintln!("skipped: there is no bash") };
    assert_eq!(String::from_utf8_lossy(&output.stdout), kept, "run `plugins/build.sh` and commit what it writes");
}
