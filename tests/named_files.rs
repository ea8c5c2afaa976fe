//! Law of all arguments that name something to read: what is missing, of the other kind or unreadable is refused with one exit code, 4,
//! or 3 where it stands for the recipe itself.

use crate::street::Street;
use crate::support::cosfly;
use std::collections::BTreeSet;
use std::path::Path;

/// Lines with `@` in the place of one argument, and the exit code of a file that is not there.
const LINES: &[(&str, i32)] = &[
    ("ask-expert @ --batch", 3),
    ("carla-job @ --out new", 4),
    ("cluster slurm-script @", 3),
    ("dagger @ --policy follow --round a --out new", 3),
    ("dagger recipe.toml --policy follow --round a --out new --onto @", 4),
    ("dagger recipe.toml --policy ws://127.0.0.1:9 --round a --out new --api-key-file @", 4),
    ("dataset lint @", 4),
    ("dataset tag v1 @", 3),
    ("doctor @", 4),
    ("doctor out/street --mesh @", 4),
    ("doctor out/street --texts @", 4),
    ("eval @", 4),
    ("eval out/street @ --kind waypoints", 4),
    ("eval out/street @ --kind boxes", 4),
    ("eval out/street @ --kind masks", 4),
    ("eval out/street boxes.json --images @", 4),
    ("eval out/street empty --kind target --sequences @", 4),
    ("export @ --format coco --out new", 4),
    ("fly @ --policy follow", 3),
    ("fly recipe.toml --policy onnx:@", 4),
    ("fly recipe.toml --policy follow --commitment @", 4),
    ("fly recipe.toml --policy ws://127.0.0.1:9 --api-key-file @", 4),
    ("fly bags @ --out new", 4),
    ("fly bundle @", 4),
    ("fly bundle flown/follow --with-policy @", 4),
    ("fly commit @", 3),
    ("fly compare @ flown/follow", 4),
    ("fly compare flown/follow @", 4),
    ("fly verify @ recipe.toml", 4),
    ("fly verify bundle @", 3),
    ("fly verify bundle recipe.toml --run-policy --policy-file @", 4),
    ("graph @", 3),
    ("hunt @ --policy follow --vary tool.fly.latency_ms=0..1 --out new", 3),
    ("hunt recipe.toml --policy ws://127.0.0.1:9 --vary tool.fly.latency_ms=0..1 --out new --api-key-file @", 4),
    ("leaderboard empty --suite @", 3),
    ("map convert @ --out new.glb", 4),
    ("map inspect @", 4),
    ("map tiles @ --out new.glb", 4),
    ("plan @", 3),
    ("plugin check @", 4),
    ("preview @ --out new", 4),
    ("run @", 3),
    ("verify @", 4),
    ("verify out/street --regenerate 1 --recipe @", 3),
    ("verify out/street --mesh @", 4),
    ("view @ --export new.html", 4),
    ("why @ town", 3),
];

/// Lines whose `@` is a folder, of pictures, of trackers' files, of entries: an empty one is of the right kind. All end with 4.
const FOLDERS: &[&str] = &[
    "eval out/street @ --kind depth",
    "eval out/street @ --kind tracks",
    "eval out/street @ --kind target",
    "leaderboard @",
];

/// Options that name a file or folder to write, or to keep things in.
const WRITTEN: &[&str] = &["--out", "--store", "--plan", "--export", "--resume"];

#[test]
fn all_arguments_that_name_a_file_refuse_a_bad_one_alike() {
    let street = Street::new();
    let place = |name: &str| street.path().join(name);
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    cosfly(&["fly", "recipe.toml", "--policy", "follow", "--out", "flown", "--clips", "0"])
        .within(street.path())
        .run_ok();
    cosfly(&["fly", "bundle", "flown/follow", "--out", "bundle"]).within(street.path()).run_ok();
    std::fs::write(place("boxes.json"), r#"[{"image_id": 1, "category_id": 1, "bbox": [0, 0, 1, 1], "score": 1}]"#)
        .expect("writable");
    std::fs::create_dir(place("empty")).expect("writable");
    let folders = FOLDERS.iter().map(|line| (*line, 4));
    for (line, code) in LINES.iter().copied().chain(folders) {
        refuses_all(street.path(), line, code);
    }
}

fn refuses_all(folder: &Path, line: &str, code: i32) {
    let name = "bad";
    let bad = folder.join(name);
    let mut states: Vec<&str> = vec!["missing", "of the other kind"];
    // What nobody may read, the administrator included.
    if cfg!(unix) {
        states.push("unreadable");
    }
    for state in states {
        match state {
            "of the other kind" if FOLDERS.contains(&line) => std::fs::write(&bad, "text").expect("writable"),
            "of the other kind" => std::fs::create_dir(&bad).expect("writable"),
            #[cfg(unix)]
            "unreadable" => std::os::unix::fs::symlink(name, &bad).expect("writable"),
            _ => {}
        }
        let words: Vec<String> = line.split(' ').map(|word| word.replace('@', "bad")).collect();
        let printed = cosfly(&words).within(folder).run();
        assert_eq!(printed.code, Some(code), "{line}, {state}: {}", printed.stderr);
        assert!(printed.stderr.contains(name), "{line}, {state}: {}", printed.stderr);
        let _ = std::fs::remove_file(&bad).or_else(|_| std::fs::remove_dir(&bad));
        assert!(!folder.join("new").exists() && !folder.join("bad-evaluation").exists(), "{line}, {state}");
    }
}

#[test]
fn no_argument_that_names_a_file_is_forgotten() {
    let known: BTreeSet<(String, String)> =
        LINES.iter().map(|(line, _)| *line).chain(FOLDERS.iter().copied()).map(key).collect();
    let mut open = vec![vec![]];
    while let Some(path) = open.pop() {
        let help = cosfly(&[&path[..], &["--help".to_owned()]].concat()).run_ok().stdout;
        let (mut commands, usage) =
            (vec![], help.lines().find(|line| line.starts_with("Usage: ")).expect("a usage").to_owned());
        let section = help.split("\nCommands:\n").nth(1).and_then(|text| text.split("\n\n").next()).unwrap_or_default();
        for line in section.lines() {
            let name = line.split_whitespace().next().unwrap_or_default();
            if line.starts_with("  ") && !line.starts_with("   ") && name != "help" {
                commands.push(name.to_owned());
            }
        }
        open.extend(commands.into_iter().map(|name| [&path[..], &[name]].concat()));
        let of_values = ["<FILE>", "<DIR>", "<RECIPE>", "<DATASET>", "<EXPORT>", "<RESULT>"];
        for line in help.lines().map(str::trim_start).filter(|line| line.starts_with("--")) {
            let mut words = line.split_whitespace();
            let (option, value) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
            if of_values.contains(&value) && !WRITTEN.contains(&option) {
                let wanted = (path.join(" "), option.to_owned());
                assert!(known.contains(&wanted), "no line of this test tries {wanted:?}");
            }
        }
        let has_file =
            ["<FILE>", "<RECIPE>", "<DATASET>", "<RESULT>", "<TILESET>", "<FOLDER>", "<DATASET|RESULT|RECIPE>"];
        let positional = usage.split_whitespace().skip_while(|word| word.starts_with("--") || !word.starts_with('<'));
        if !path.is_empty() && positional.clone().any(|word| has_file.contains(&word)) && usage.ends_with('>') {
            let wanted = (path.join(" "), String::new());
            assert!(known.contains(&wanted), "no line of this test tries the arguments of {wanted:?}");
        }
    }
}

/// Command of a line, and the option that its `@` is of; no option for an argument with a place.
fn key(line: &str) -> (String, String) {
    let words: Vec<&str> = line.split(' ').collect();
    let at = words.iter().position(|word| word.contains('@')).expect("an @");
    let groups = ["cluster", "dataset", "fly", "map", "plugin"];
    let second =
        words[1..2].iter().filter(|word| word.chars().all(|letter| letter.is_ascii_lowercase() || letter == '-'));
    let command = match groups.contains(&words[0]) {
        true => [&words[..1], &second.copied().collect::<Vec<_>>()].concat().join(" "),
        false => words[0].to_owned(),
    };
    (command, words[at - 1].strip_prefix("--").map_or_else(String::new, |name| format!("--{name}")))
}
