//! `leaderboard`: what each entry proves, hostile entries, the same page for any jobs and order; tiers of benchmarks.

use crate::fuzzing::damaged;
use crate::street::Street;
use crate::support::{Printed, cosfly, repository_root};
use cosfly_fly::bundle::Bundle;
use cosfly_frames::Seed;
use serde_json::Value;
use std::path::Path;

/// A street with a folder `board`, and bundles of two policies in it.
fn board() -> (Street, Bundle) {
    let street = Street::new();
    let policies = ["--policy", "follow", "--policy", "expert", "--policy", "hold"];
    let fly = ["fly", "recipe.toml", "--out", "out", "--clips", "0", "--logs", "none", "--quiet"];
    cosfly(&[&fly[..], &policies].concat()).within(street.path()).run_ok();
    std::fs::create_dir(street.path().join("board")).expect("a folder");
    for policy in ["follow", "expert", "hold"] {
        let (result, file) = (format!("out/{policy}"), format!("board/{policy}.jsonl.zst"));
        cosfly(&["fly", "bundle", &result, "--out", &file]).within(street.path()).run_ok();
    }
    let bundle = Bundle::read(&street.path().join("board/follow.jsonl.zst")).expect("a bundle");
    (street, bundle)
}

fn leaderboard(folder: &Path, more: &[&str]) -> Printed {
    cosfly(&[&["leaderboard", "board", "--suite", "recipe.toml"], more].concat()).within(folder).run()
}

fn table(folder: &Path) -> Value {
    serde_json::from_str(&leaderboard(folder, &["--json"]).stdout).expect("JSON")
}

fn files(of: &Value) -> Vec<&str> {
    of.as_array().expect("a list").iter().map(|it| it["file"].as_str().expect("a name")).collect()
}

#[test]
fn entries_are_ranked_within_what_was_verified_and_others_are_listed_with_the_reason() {
    let (street, bundle) = board();
    let at = |name: &str| street.path().join("board").join(name);
    let honest = leaderboard(street.path(), &[]);
    assert_eq!(honest.code, Some(0), "{}{}", honest.stdout, honest.stderr);
    assert!(honest.stdout.contains("3 flown again by this call"), "{}", honest.stdout);
    let page = || std::fs::read(at("index.html")).expect("a page");
    let first = page();
    let text = String::from_utf8(first.clone()).expect("text");
    let clips = text.matches("calcMode").count();
    assert!(clips == 6 && text.len() < 90_000 && !text.contains("<script"), "two moving dots an entry: {clips}");
    assert!(leaderboard(street.path(), &["--jobs", "1"]).stdout.contains("0 flown again by this call"));
    assert_eq!(page(), first, "the same page from kept outcomes");
    // Another store: everything is flown again, on another number of threads.
    let afresh = leaderboard(street.path(), &["--jobs", "1", "--store", "other", "--out", "new/folder/page.html"]);
    assert!(afresh.stdout.contains("3 flown again by this call"), "{}", afresh.stdout);
    let other = std::fs::read(street.path().join("new/folder/page.html")).expect("a page");
    assert_eq!(other, first, "the same page for any number of threads");
    let make = |name: &str, change: &dyn Fn(&mut Bundle)| {
        let mut other = bundle.clone();
        change(&mut other);
        std::fs::write(at(&format!("{name}.jsonl.zst")), other.bytes().expect("bytes")).expect("written");
    };
    make("edited", &|it| {
        it.episodes[0].row.score.tracked_steps += 1;
        it.card.cosfly = "0.0.1".to_owned();
    });
    make("elsewhere", &|it| it.card.suite.name = "elsewhere".to_owned());
    make("other", &|it| it.card.suite.hash = "0".repeat(64));
    make("longer", &|it| {
        let mut more = it.episodes[0].clone();
        more.row.episode = "one more".to_owned();
        it.episodes.push(more);
        it.card.suite.episodes += 1;
    });
    make("mixed", &|it| {
        let other = it.card.environment.clone();
        it.card.environments.insert("street".to_owned(), other);
    });
    make("talkative", &|it| it.episodes[0].row.policy_failure = Some("x".repeat(1000)));
    make("wordy", &|it| it.card.suite.name = "x".repeat(2000));
    make("loud", &|it| it.card.policy.name = "x".repeat(1 << 17));
    make("unheard", &|it| it.card.policy.sensors = vec!["sonar".to_owned()]);
    #[cfg(unix)]
    std::os::unix::fs::symlink(at("follow.jsonl.zst"), at("linked.jsonl.zst")).expect("a link");
    make("colours", &|_| ());
    std::fs::write(at("colours.toml"), "sees = \"rgb\"\n").expect("written");
    make("misspelt", &|_| ());
    std::fs::write(at("misspelt.toml"), "license = \"MIT\"\n").expect("written");
    std::fs::write(at("alone.toml"), "licence = \"MIT\"\n").expect("written");
    std::fs::write(at("damaged.jsonl.zst"), b"no bundle").expect("written");
    std::fs::create_dir(at("folder.jsonl.zst")).expect("a folder");
    let board = table(street.path());
    let suite = &board["suites"][0];
    let mut ranked = files(&suite["ranked"]);
    ranked.sort_unstable();
    assert_eq!((ranked, files(&suite["knows_world"])), (vec!["follow", "hold"], vec!["expert"]), "{board:#}");
    assert_eq!(suite["ranked"][0]["rank"], 1);
    assert!(suite["ranked"][1]["behind_first"]["difference"].as_f64().is_some_and(|behind| behind <= 0.0), "{board:#}");
    assert_eq!((files(&suite["claimed"]), &suite["claimed"][0]["rank"]), (vec!["edited"], &Value::Null));
    for (file, words) in [
        ("alone", "there is no `alone.jsonl.zst`"),
        ("colours", "sees `rgb`, which it was not sent"),
        ("damaged", "no whole bundle"),
        ("elsewhere", "it is of the suite `elsewhere`; here are `street`"),
        ("folder", "no file"),
        #[cfg(unix)]
        ("linked", "is a link"),
        ("loud", "its first line has"),
        ("mixed", "are not as cosfly writes them"),
        ("talkative", "a text of more than 300 bytes"),
        ("unheard", "there is no sensor `sonar`"),
        ("wordy", "..."),
        ("longer", "has 4 episodes, the suite `street` has 3"),
        ("misspelt", "did you mean `licence`?"),
        ("other", "it is of another suite"),
    ] {
        let refused = board["refused"].as_array().expect("a list").iter().find(|it| it["file"] == file);
        let reason = refused.and_then(|it| it["reason"].as_str()).unwrap_or_else(|| panic!("{file}: {board:#}"));
        assert!(reason.contains(words) && reason.len() < 400, "{file}: {reason}");
    }
    let printed = leaderboard(street.path(), &[]);
    assert_eq!(printed.code, Some(1), "{}{}", printed.stdout, printed.stderr);
    // Whoever looks for the cause sees which version flew the entry.
    assert_eq!(suite["claimed"][0]["cosfly"], "0.0.1");
    assert!(printed.stdout.contains("(flown by cosfly 0.0.1)"), "{}", printed.stdout);
    assert!(page().windows(24).any(|it| it == b"flown by cosfly 0.0.1</p"), "the page names the version");
}

#[test]
fn copies_of_an_entry_share_its_rank_and_say_so() {
    let (street, bundle) = board();
    for name in ["a copy", "one more"] {
        let mut copy = bundle.clone();
        copy.card.policy.name = name.to_owned();
        copy.card.policy.kind = "socket".to_owned();
        copy.card.policy.baseline = None;
        let path = street.path().join(format!("board/{name}.jsonl.zst"));
        std::fs::write(path, copy.bytes().expect("bytes")).expect("written");
    }
    let board = table(street.path());
    let ranked = &board["suites"][0]["ranked"];
    let mut ranks: Vec<(&str, u64, &str)> = (ranked.as_array().expect("a list").iter())
        .map(|it| (it["file"].as_str(), it["rank"].as_u64(), it["flies_as"]["file"].as_str().unwrap_or_default()))
        .map(|(file, rank, alike)| (file.expect("a name"), rank.expect("a rank"), alike))
        .collect();
    ranks.sort_unstable();
    let copies = [("a copy", 1, "follow"), ("follow", 1, "a copy"), ("hold", 1, ""), ("one more", 1, "a copy")];
    assert_eq!(ranks, copies, "{board:#}");
    let told = leaderboard(street.path(), &[]).stdout;
    assert!(told.contains("flies 3 of 3 episodes exactly as the entry `follow`"), "{told}");
}

#[test]
fn an_experts_actions_are_no_entry_of_another_name() {
    let (street, _) = board();
    let path = street.path().join("board/expert.jsonl.zst");
    let mut expert = Bundle::read(&path).expect("a bundle");
    expert.card.policy.name = "mine".to_owned();
    expert.card.policy.kind = "socket".to_owned();
    expert.card.policy.baseline = None;
    std::fs::write(&path, expert.bytes().expect("bytes")).expect("written");
    let board = table(street.path());
    let world = &board["suites"][0]["knows_world"];
    assert_eq!(files(world), ["expert"], "{board:#}");
    assert!(
        world[0]["sees"].as_str().is_some_and(|sees| sees.contains("are the expert's to less than 1 m")),
        "{board:#}"
    );
}

#[test]
fn a_file_mixed_of_a_policy_and_the_expert_is_no_entry_of_another_name() {
    let (street, _) = board();
    let read = |name: &str| Bundle::read(&street.path().join(format!("board/{name}.jsonl.zst"))).expect("a bundle");
    let (expert, mut mixed) = (read("expert"), read("hold"));
    mixed.card.policy.name = "mine".to_owned();
    mixed.card.policy.baseline = None;
    mixed.episodes[1] = expert.episodes[1].clone();
    std::fs::write(street.path().join("board/mixed.jsonl.zst"), mixed.bytes().expect("bytes")).expect("written");
    std::fs::write(street.path().join("board/follow.toml"), "seconds = 0.5\ncore_seconds = 12").expect("written");
    let board = table(street.path());
    let suite = &board["suites"][0];
    let mixed = suite["knows_world"].as_array().expect("a list").iter().find(|it| it["file"] == "mixed");
    let sees = mixed.map(|it| &it["sees"]);
    assert_eq!(sees, Some(&"world: 1 of its flights is the expert's to less than 0.1 m".into()), "{board:#}");
    let follow = suite["ranked"].as_array().expect("a list").iter().find(|it| it["file"] == "follow");
    let times = follow.map(|it| [&it["seconds_an_episode"], &it["core_seconds_an_episode"]]);
    assert_eq!(times, Some([&0.5.into(), &12.0.into()]), "{board:#}");
    leaderboard(street.path(), &[]);
    let page = std::fs::read_to_string(street.path().join("board/index.html")).expect("a page");
    assert!(page.contains("<td>0.500</td><td>12</td>") && page.contains("core-s an episode"));
}

#[test]
fn a_varied_expert_is_no_entry_of_another_name_and_sensors_are_flown_again() {
    let (street, _) = board();
    let fly = ["fly", "recipe.toml", "--out", "more", "--clips", "0", "--logs", "none", "--quiet"];
    let policies = [
        &["--policy", "expert:gain=0.5", "--name", "mine"][..],
        // Options for other policies of the same command: a baseline gets no pictures and answers each step.
        &["--policy", "follow", "--name", "high", "--obs", "laser_altimeter,depth", "--every", "3"],
    ];
    for policy in policies {
        cosfly(&[&fly[..], policy].concat()).within(street.path()).run_ok();
        let (result, file) = (format!("more/{}", policy[3]), format!("board/{}.jsonl.zst", policy[3]));
        cosfly(&["fly", "bundle", &result, "--out", &file]).within(street.path()).run_ok();
        cosfly(&["fly", "verify", &file, "recipe.toml", "--run-policy"]).within(street.path()).run_ok();
    }
    let mut slow = Bundle::read(&street.path().join("board/high.jsonl.zst")).expect("a bundle");
    slow.card.policy.every = 3;
    std::fs::write(street.path().join("slow.jsonl.zst"), slow.bytes().expect("bytes")).expect("written");
    let refused =
        cosfly(&["fly", "verify", "slow.jsonl.zst", "recipe.toml", "--run-policy"]).within(street.path()).run();
    assert!(refused.stderr.contains("says other things of its policy"), "{}", refused.stderr);
    std::fs::write(street.path().join("board/high.toml"), "sees = \"laser_altimeter\"").expect("written");
    let board = table(street.path());
    let suite = &board["suites"][0];
    assert!(files(&suite["knows_world"]).contains(&"mine"), "{board:#}");
    let high = suite["ranked"].as_array().expect("a list").iter().find(|it| it["file"] == "high");
    assert_eq!(high.map(|it| &it["sees"]), Some(&"laser_altimeter".into()), "{board:#}");
    // The name of another baseline does not pass for this one.
    let other = [&fly[..], &["--policy", "follow", "--name", "mine"]].concat();
    let refused = cosfly(&other).within(street.path()).run();
    assert!(refused.code != Some(0) && refused.stderr.contains("policy.baseline"), "{}", refused.stderr);
}

#[test]
fn hostile_names_are_text_on_the_page() {
    let (street, bundle) = board();
    let at = |name: &str| street.path().join("board").join(name);
    let mut other = bundle;
    let markup = "<script>alert(1)</script>\u{1b}[2J\u{202e}\"'&";
    other.card.policy.name = markup.to_owned();
    other.card.policy.version = Some(markup.repeat(100));
    std::fs::write(at("hostile.jsonl.zst"), other.bytes().expect("bytes")).expect("written");
    let notes =
        "about = '<img src=x onerror=alert(1)>'\nlicence = '</td>'\nlink = 'https://x/\"onmouseover=alert(1)'\n";
    std::fs::write(at("hostile.toml"), notes).expect("written");
    std::fs::write(at("<b>x.toml"), "about = 3").expect("written");
    let printed = leaderboard(street.path(), &[]);
    assert!(!printed.stdout.contains('\u{1b}') && printed.stdout.contains("<script>"), "{}", printed.stdout);
    let page = std::fs::read_to_string(at("index.html")).expect("a page");
    for markup in ["<script", "<img", "<b>x", "\u{1b}", "\u{202e}", "/\"on"] {
        assert!(!page.contains(markup), "{markup}: {page}");
    }
    assert!(page.contains("&lt;script&gt;") && page.len() < 100_000, "{page}");
}

#[test]
fn a_thousand_damaged_bundles_are_refused_or_flown_in_words() {
    let (street, bundle) = board();
    let whole = bundle.bytes().expect("bytes");
    let mut stream = Seed::of_item(1, "bundles", "damaged").stream("damage");
    for _ in 0..1000 {
        match Bundle::of_bytes(&damaged(&whole, &mut stream)) {
            Ok(read) => assert_eq!(read, bundle, "the digest holds"),
            Err(words) => assert!(!words.is_empty()),
        }
    }
    // Whoever edits the text can make its digest anew: what is still a bundle is flown.
    let text = zstd::decode_all(&whole[..]).expect("zstd");
    let text = String::from_utf8(text).expect("UTF-8");
    let kept = text.trim_end().rsplit_once('\n').expect("lines").0;
    let mut read = vec![];
    for _ in 0..1000 {
        match String::from_utf8(damaged(kept.as_bytes(), &mut stream)).map(|text| Bundle::of_text(&text)) {
            Ok(Ok(bundle)) => read.push(bundle),
            Ok(Err(words)) => assert!(!words.is_empty()),
            Err(_) => {}
        }
    }
    assert!(!read.is_empty(), "a digit of an action is another one");
    for (number, bundle) in read.iter().enumerate().take(20) {
        let file = street.path().join(format!("board/edited{number}.jsonl.zst"));
        std::fs::write(file, bundle.bytes().expect("bytes")).expect("written");
    }
    let printed = leaderboard(street.path(), &["--run-policies", "--json"]);
    assert!(matches!(printed.code, Some(0 | 1)), "{}", printed.stderr);
    let board: Value = serde_json::from_str(&printed.stdout).expect("JSON");
    let reasons =
        board["refused"].as_array().expect("a list").iter().map(|it| it["reason"].as_str().unwrap_or_default());
    assert!(reasons.clone().all(|reason| !reason.is_empty()), "{board:#}");
}

#[test]
fn a_leaderboard_needs_a_folder_and_suites() {
    let street = Street::new();
    let refused = |code: i32, arguments: &[&str], words: &str| {
        let printed = cosfly(&[&["leaderboard"], arguments].concat()).within(street.path()).run();
        assert_eq!(printed.code, Some(code), "{arguments:?}: {}", printed.stderr);
        assert!(printed.stderr.contains(words), "{arguments:?}: {}", printed.stderr);
    };
    refused(4, &["nowhere", "--suite", "recipe.toml"], "`nowhere` does not exist");
    std::fs::create_dir(street.path().join("none")).expect("a folder");
    let empty =
        cosfly(&["leaderboard", "none", "--suite", "recipe.toml", "--out", "page.html"]).within(street.path()).run_ok();
    assert!(empty.stdout.starts_with("no entry is here"), "{}", empty.stdout);
    refused(3, &["."], "there is no folder `recipes/benchmarks` here");
}

#[test]
fn a_tier_flies_verifies_and_ranks_as_a_suite_does() {
    let street = Street::new();
    let at = |name: &str| street.path().join(name);
    let recipe = std::fs::read_to_string(at("recipe.toml")).expect("a recipe");
    let second = recipe.replace("name = \"street\"", "name = \"gusty\"").replace("seed = 3", "seed = 4");
    let second = format!("{second}\n[tool.fly]\ndrone = \"pelican\"\nwind_mps = 2\n");
    std::fs::write(at("gusty.toml"), second).expect("written");
    let benchmark = "name = \"two\"\nsuites = [\"recipe.toml\", \"gusty.toml\"]\n[tiers]\nmini = 1\nfull = 9\n";
    std::fs::write(at("two.toml"), benchmark).expect("written");
    let fly = |more: &[&str]| {
        let all = [&["fly", "two.toml", "--policy", "follow", "--clips", "1", "--quiet"], more].concat();
        cosfly(&all).within(street.path()).run()
    };
    for (tier, episodes) in [("mini", 2), ("full", 6)] {
        let printed = fly(&["--tier", tier]);
        assert_eq!(printed.code, Some(0), "{}", printed.stderr);
        let folder = format!("out/fly/two-{tier}/follow");
        let rows = std::fs::read_to_string(at(&format!("{folder}/episodes.jsonl"))).expect("rows");
        assert_eq!(rows.lines().count(), episodes, "{rows}");
        assert!(rows.contains("\"episode\":\"gusty-") && rows.contains("\"strain\""), "{rows}");
        cosfly(&["fly", "bundle", &folder, "--out", &format!("{tier}.jsonl.zst")]).within(street.path()).run_ok();
        let verified = cosfly(&["fly", "verify", &format!("{tier}.jsonl.zst"), "two.toml"]).within(street.path()).run();
        assert_eq!(verified.code, Some(0), "{}{}", verified.stdout, verified.stderr);
    }
    let printed = cosfly(&["leaderboard", ".", "--suite", "two.toml", "--json"]).within(street.path()).run();
    let board: Value = serde_json::from_str(&printed.stdout).expect("JSON");
    let names: Vec<&str> =
        board["suites"].as_array().expect("suites").iter().filter_map(|it| it["suite"].as_str()).collect();
    assert_eq!(names, ["two-full", "two-mini"], "{board:#}");
    // An episode is the same in a tier and in its suite.
    cosfly(&["fly", "recipe.toml", "--policy", "follow", "--clips", "0", "--quiet"]).within(street.path()).run_ok();
    let rows = |path: &str| std::fs::read_to_string(at(path)).expect("rows");
    let (alone, tier) = (rows("out/fly/street/follow/episodes.jsonl"), rows("out/fly/two-full/follow/episodes.jsonl"));
    let score = |line: &str| line.split_once("\"certified_visibility\"").map(|it| it.1.to_owned());
    assert!(alone.lines().map(score).eq(tier.lines().take(3).map(score)), "{alone}{tier}");
    for (arguments, words) in [
        (&[][..], "a tier is missing"),
        (&["--tier", "maxi"], "has no tier `maxi`"),
        (&["--tier", "mini", "--set", "seed=4"], "`--set` changes recipes"),
        (&["--tier", "mini", "--wind-mps", "3"], "wind does not move a point mass"),
    ] {
        let printed = fly(arguments);
        assert!(printed.code == Some(3) && printed.stderr.contains(words), "{arguments:?}: {}", printed.stderr);
    }
    let printed = cosfly(&["fly", "recipe.toml", "--tier", "mini", "--policy", "hold"]).within(street.path()).run();
    assert!(printed.code == Some(3) && printed.stderr.contains("is no benchmark"), "{}", printed.stderr);
    assert!(repository_root().join("recipes/benchmarks/track_1.toml").exists());
}

/// The same with messages in one line.
fn words(printed: Printed) -> Printed {
    Printed { stderr: printed.stderr.split_whitespace().collect::<Vec<_>>().join(" "), ..printed }
}

#[test]
fn a_held_out_suite_is_held_against_its_commitment() {
    let street = Street::new();
    let printed = cosfly(&["fly", "commit", "recipe.toml"]).within(street.path()).run_ok().stdout;
    let name = printed.split(".secret.toml").next().expect("a name").to_owned();
    let at = |name: &str| street.path().join(name);
    let (secret, published) = (format!("{name}.secret.toml"), format!("{name}.commitment"));
    assert!(name.starts_with("street_") && at(&secret).exists(), "{printed}");
    assert_eq!(std::fs::read_to_string(at(".gitignore")).expect("ignored"), "*.secret.toml\n");
    let fly = |recipe: &str, commitment: &str| {
        let fly = ["fly", recipe, "--commitment", commitment, "--policy", "hold", "--clips", "0", "--quiet"];
        words(cosfly(&fly).within(street.path()).run())
    };
    let revealed = fly(&secret, &published);
    assert_eq!(revealed.code, Some(0), "{}", revealed.stderr);
    let text = std::fs::read_to_string(at(&secret)).expect("a secret");
    let seed = text.lines().find(|line| line.starts_with("seed")).expect("a seed");
    std::fs::write(at("other.toml"), text.replace(seed, "seed = 5")).expect("written");
    let other = fly("other.toml", &published);
    assert!(other.code == Some(4) && other.stderr.contains("the commitment is"), "{}", other.stderr);
    for none in ["", "0123", &"g".repeat(64)] {
        std::fs::write(at("none.commitment"), none).expect("written");
        let none = fly(&secret, "none.commitment");
        assert!(none.code == Some(4) && none.stderr.contains("is no commitment"), "{}", none.stderr);
    }
    // Somebody commits to a seed of their choice.
    let chosen = std::fs::read(at("other.toml")).expect("a recipe");
    let chosen = fly("other.toml", &cosfly_fingerprint::Digest::of(&chosen).to_string());
    assert!(chosen.code == Some(4) && chosen.stderr.contains("do not follow from its nonce"), "{}", chosen.stderr);
    // The file is the same, its episodes are others.
    let set =
        [&["fly", &secret, "--commitment", &published, "--policy", "hold", "--set", "stages.walkers.count=2"][..]]
            .concat();
    let fewer = words(cosfly(&set).within(street.path()).run());
    assert!(fewer.code == Some(4) && fewer.stderr.contains("its episodes are others"), "{}", fewer.stderr);
    let again = cosfly(&["fly", "commit", &secret]).within(street.path()).run();
    assert!(again.code == Some(3) && again.stderr.contains("is a held-out suite already"), "{}", again.stderr);
}

#[test]
fn the_held_out_suite_that_ships_is_what_was_committed_to() {
    let folder = repository_root().join("recipes/held_out");
    let files = std::fs::read_dir(&folder).expect("a folder").map(|file| file.expect("a file").path());
    let recipe = files.into_iter().find(|path| path.extension().is_some_and(|it| it == "toml")).expect("a recipe");
    let commitment = recipe.with_extension("commitment");
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let [recipe, commitment] = [recipe, commitment].map(|path| path.display().to_string());
    let fly = ["fly", &recipe, "--commitment", &commitment, "--policy", "hold", "--clips", "0", "--quiet"];
    // Where episodes changed on purpose before the first release: `cosfly fly commit recipes/suites/street.toml` makes another one.
    cosfly(&fly).within(scratch.path()).run_ok();
}
