//! Promises of the README, held against the recipes and folders that ship.

use crate::support::{cosfly, repository_root};

fn text(path: &str) -> String {
    std::fs::read_to_string(repository_root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The README's words in one line, however its lines are broken.
fn readme() -> String {
    text("README.md").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_readme_counts_what_the_first_recipe_makes() {
    let recipe = text("recipes/carla_town.toml");
    let number = |stage: &str, key: &str| {
        let table = recipe.split(&format!("[stages.{stage}]\n")).nth(1)?.split("\n[").next()?;
        let value = table.lines().find_map(|line| line.strip_prefix(key)?.trim_start().strip_prefix('='))?;
        value.trim().parse::<u32>().ok()
    };
    assert_eq!((number("walkers", "count"), number("crowd", "people.count")), (Some(4), Some(300)));
    assert_eq!(number("crowd", "vehicles.count"), Some(60));
    assert_eq!(number("walkers", "frames"), Some(200));
    assert_eq!((number("frames", "width"), number("frames", "height")), (Some(1280), Some(720)));
    for promise in
        ["four targets among three hundred bystanders and sixty vehicles", "200 frames of 1280x720 per trajectory"]
    {
        assert!(readme().contains(promise), "README.md says `{promise}` no more: change this test, too");
        let started = text("book/src/guide/getting-started.md").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(started.contains(promise), "getting-started.md says `{promise}` no more");
    }
}

#[test]
fn the_readme_counts_the_plugins_and_names_files_that_exist() {
    let folders = std::fs::read_dir(repository_root().join("recipes/plugins")).expect("a folder");
    let examples = folders
        .filter(|entry| entry.as_ref().is_ok_and(|entry| entry.path().extension().is_some_and(|it| it == "wasm")));
    assert_eq!(examples.count(), 12);
    let readme = readme();
    assert!(readme.contains("twelve examples in `recipes/plugins`"));
    for named in readme.split(['`', ' ', '(', ')']).filter(|word| word.starts_with("recipes/") && !word.ends_with('/'))
    {
        assert!(repository_root().join(named).exists(), "README.md names `{named}`, which is not there");
    }
}

#[test]
fn getting_started_names_every_table_and_items_every_kind_of_stage() {
    let started = text("book/src/guide/getting-started.md");
    for table in text("book/src/reference/tables.md").lines().filter_map(|line| line.strip_prefix("## ")) {
        assert!(table == "files" || started.contains(table), "getting-started.md does not name table `{table}`");
    }
    let items = text("book/src/concepts/items.md");
    for kind in text("book/src/reference/recipe.md").lines().filter_map(|line| line.strip_prefix("## `")) {
        // Tables of other commands, such as `[tool.fly]`, are no kinds.
        if kind.starts_with('[') {
            continue;
        }
        let kind = kind.split([':', '`']).next().unwrap_or_default();
        assert!(items.contains(&format!("`{kind}`")), "items.md does not name the kind `{kind}`");
    }
}

#[test]
fn the_levels_of_the_occlusion_curriculum_run_as_its_recipe_says() {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let path = |name: &str| scratch.path().join(name).display().to_string();
    let recipe = text("recipes/occlusion.toml");
    let commands: Vec<&str> = recipe.lines().filter_map(|line| line.strip_prefix("#   cosfly ")).collect();
    let levels = commands.iter().filter(|command| command.starts_with("run ")).enumerate().map(|(level, command)| {
        let (out, store) = (path(&format!("level_{level}")), path("store"));
        let mut words: Vec<&str> = command.split_whitespace().collect();
        match words.iter().position(|word| *word == "--out") {
            Some(at) => words[at + 1] = &out,
            None => words.extend(["--out", &out]),
        }
        // Small pictures lose the same targets behind the same walls.
        for small in ["stages.frames.width=96", "stages.frames.height=54"] {
            words.extend(["--set", small]);
        }
        words.extend(["--store", &store, "--quiet"]);
        cosfly(&words).within(&repository_root()).run_ok()
    });
    assert_eq!(levels.count(), 3);
}
