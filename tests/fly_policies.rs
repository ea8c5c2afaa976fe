//! `fly` and `dagger` with policies that cannot be had, that fail, that end, that tell secrets: what is an episode, and what is not.
//!
//! The policies are scripts of the shell in the place of Python, so that the tests need no package.
#![cfg(unix)]

use crate::street::Street;
use crate::support::{Call, Printed, cosfly};
use cosfly_domain::channels;
use serde_json::Value;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;

/// Tells its metadata, an empty map.
const READY: &str = "printf 'b\\001\\000\\000\\000\\200'";
/// Reads an observation.
const ASKED: &str = "n=$(head -c 4 | od -An -tu4); n=$((n)); [ $n -gt 0 ] || exit 0; head -c $n >/dev/null";
/// Answers with five zeros.
const HOLD: &str = "printf 'b\\017\\000\\000\\000\\201\\247actions\\225\\000\\000\\000\\000\\000'";
/// Answers with one zero.
const WRONG: &str = "printf 'b\\013\\000\\000\\000\\201\\247actions\\221\\000'";
/// Answers with a text.
const TEXT: &str = "printf 't\\004\\000\\000\\000oh!!'";

/// Puts a script in the place of Python.
fn script(street: &Street, text: &str) {
    let path = street.path().join("policy.sh");
    std::fs::write(&path, format!("#!/bin/sh\n{text}\n")).expect("written");
    std::fs::set_permissions(&path, PermissionsExt::from_mode(0o755)).expect("set");
}

/// Runs to the end. The messages are one line: where they are broken is no matter of these tests.
fn run(call: Call) -> Printed {
    let mut printed = call.run();
    printed.stderr = printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
    printed
}

fn fly_into(street: &Street, out: &str, more: &[&str]) -> Printed {
    let policy = ["--policy", "python:mine:act", "--python", "./policy.sh", "--name", "mine"];
    let all = [&["fly", "recipe.toml", "--out", out, "--clips", "0", "--logs", "none"], &policy[..], more].concat();
    run(cosfly(&all).within(street.path()).with("COSFLY_API_KEY", "pass-1234-word"))
}

fn rows(street: &Street, out: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(street.path().join(out).join("mine/episodes.jsonl")).expect("rows");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

fn always(answer: &str) -> String {
    format!("{READY}\nwhile true; do {ASKED}; {answer}; done")
}

/// The script whose answers up to number `count` are good.
fn good_until(count: u32, then: &str) -> String {
    format!(
        "{READY}\ni=0\nwhile true; do {ASKED}; i=$((i+1)); if [ $i -gt {count} ]; then {then}; else {HOLD}; fi; done"
    )
}

#[test]
fn observations_have_every_channel_of_the_list_that_is_asked_for() {
    let street = Street::new();
    script(&street, &always(HOLD).replace(">/dev/null", ">seen.bin"));
    let names: Vec<&str> = channels::of_moments().map(|channel| channel.name).collect();
    let printed = fly_into(&street, "seen", &["--obs", &names.join(","), "--size-px", "16", "--jobs", "1"]);
    assert_eq!(printed.code, Some(0), "{}", printed.stderr);
    let seen = std::fs::read(street.path().join("seen.bin")).expect("the last observation");
    for name in &names {
        // A text of msgpack: its length, then its bytes.
        let key = [&[0xa0 | name.len() as u8][..], name.as_bytes()].concat();
        assert!(seen.windows(key.len()).any(|bytes| bytes == key), "{name}");
    }
    let card = std::fs::read_to_string(street.path().join("seen/mine/card.json")).expect("a card");
    assert!(names.iter().all(|name| card.contains(&format!("\"{name}\""))), "{card}");
    for absent in ["sound", "flow_forward"] {
        let refused = fly_into(&street, "other", &["--obs", absent]);
        assert_eq!(refused.code, Some(2), "{}", refused.stderr);
        assert!(names.iter().all(|name| refused.stderr.contains(name)), "{}", refused.stderr);
    }
}

#[test]
fn before_the_first_right_answer_nothing_is_an_episode_and_the_same_command_flies_later() {
    let street = Street::new();
    for (text, words) in [
        ("echo no such module mine >&2; exit 3".to_owned(), &["exit code 3", "no such module mine"][..]),
        ("printf 't\\004\\000\\000\\000oh!!'".to_owned(), &["cannot be loaded", "oh!!"]),
        (format!("{READY}; kill -9 $$"), &["by signal 9"]),
        (format!("{READY}; sleep 60"), &["no answer within 0.5 s", "--timeout-s"]),
        ("sleep 60".to_owned(), &["more than 0.5 s", "--wait-s"]),
        (always(WRONG), &["shape [1]; velocity is (5,) or (n, 5)"]),
        (always(TEXT), &["the policy failed: oh!!"]),
        ("cat /dev/urandom".to_owned(), &["cannot be loaded"]),
        ("yes".to_owned(), &["it answers before it is asked"]),
    ] {
        script(&street, &text);
        let printed = fly_into(&street, "out", &["--wait-s", "0.5", "--timeout-s", "0.5"]);
        assert_eq!(printed.code, Some(1), "{text}: {}{}", printed.stdout, printed.stderr);
        assert!(printed.stderr.contains("error[fly-policy-unready]"), "{text}: {}", printed.stderr);
        for words in words {
            assert!(printed.stderr.contains(words), "{text}: {}", printed.stderr);
        }
        assert!(!street.path().join("out").exists(), "{text}: nothing is kept");
        let dagger =
            ["dagger", "recipe.toml", "--policy", "python:mine:act", "--python", "./policy.sh", "--round", "a"];
        let more = ["--out", "labels", "--wait-s", "0.5", "--timeout-s", "0.5"];
        let printed = run(cosfly(&[&dagger[..], &more].concat()).within(street.path()));
        assert_eq!(printed.code, Some(1), "{text}: {}", printed.stderr);
        assert!(printed.stderr.contains("error[fly-policy-unready]"), "{text}: {}", printed.stderr);
        assert!(!street.path().join("labels").exists(), "{text}: nothing is kept");
    }
    script(&street, &always(HOLD));
    let printed = fly_into(&street, "out", &["--wait-s", "0.5", "--timeout-s", "0.5"]);
    assert_eq!(printed.code, Some(0), "{}", printed.stderr);
    assert!(rows(&street, "out").iter().all(|row| row.get("policy_failure").is_none()));
}

#[test]
fn after_the_first_right_answer_wrong_answers_are_scored_and_ends_are_not() {
    let street = Street::new();
    for (out, then, words) in
        [("wrong", WRONG, "shape [1]"), ("text", TEXT, "oh!!"), ("late", "sleep 60", "no answer within 0.5 s")]
    {
        script(&street, &good_until(3, then));
        let printed = fly_into(&street, out, &["--timeout-s", "0.5", "--jobs", "1"]);
        assert_eq!(printed.code, Some(0), "{then}: {}", printed.stderr);
        let reasons: Vec<String> = rows(&street, out).iter().map(|row| row["policy_failure"].to_string()).collect();
        assert!(reasons[0].contains("at step 3") && reasons.iter().all(|it| it.contains(words)), "{reasons:?}");
    }
    // Processes that end are started again a few times; then the run says how they ended.
    script(&street, &good_until(3, "echo out of memory >&2; exit 7"));
    let printed = fly_into(&street, "ends", &["--jobs", "1"]);
    assert_eq!(printed.code, Some(1), "{}", printed.stderr);
    for words in ["error[fly-policy-gone]", "exit code 7", "out of memory", "the same command flies the others"] {
        assert!(printed.stderr.contains(words), "{}", printed.stderr);
    }
    script(&street, &always(HOLD));
    assert_eq!(fly_into(&street, "ends", &["--jobs", "1"]).code, Some(0));
}

#[test]
fn rows_are_not_kept_where_the_evaluation_is_another_one_and_the_refusal_says_in_what() {
    let street = Street::new();
    script(&street, &always(HOLD));
    assert_eq!(fly_into(&street, "out", &["--timeout-s", "5"]).code, Some(0));
    for (more, words) in [
        (&["--timeout-s", "6"][..], "`policy.timeout_s` was 5.0 and is 6.0 now"),
        (&["--timeout-s", "5", "--every", "2"], "`policy.every` was 1 and is 2 now"),
        (&["--timeout-s", "5", "--step-ms", "200"], "`environment.step_s` was 0.1 and is 0.2 now"),
        (&["--timeout-s", "5", "--set", "stages.walkers.count=2"], "`suite.hash` was"),
    ] {
        let printed = fly_into(&street, "out", more);
        assert_eq!(printed.code, Some(3), "{}", printed.stderr);
        assert!(printed.stderr.contains(words), "{}", printed.stderr);
    }
    // The file of a module is part of the evaluation.
    let module = street.path().join("mine.py");
    let finds = format!("if [ \"$4\" = act ]; then\n{}\nelse printf %s '{}'; fi", always(HOLD), module.display());
    script(&street, &finds);
    for (text, code) in [("one", 0), ("one", 0), ("two", 3)] {
        std::fs::write(&module, text).expect("written");
        let printed = fly_into(&street, "module", &[]);
        assert_eq!(printed.code, Some(code), "{}", printed.stderr);
        assert_eq!(printed.stderr.contains("`policy.source` was"), code == 3, "{}", printed.stderr);
    }
}

#[test]
fn servers_that_are_no_policies_are_named_and_waited_for_only_where_it_helps() {
    let street = Street::new();
    for (answer, words) in [
        (Some(&b"HTTP/1.1 301 Moved\r\nLocation: http://elsewhere/\r\n\r\n"[..]), "redirects are not followed"),
        (Some(b"HTTP/1.1 401 Unauthorized\r\n\r\n"), "give its key with COSFLY_API_KEY or `--api-key-file`"),
        (Some(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n"), "404"),
        (Some(b"\x00\xff\xfenot HTTP at all\r\n\r\n"), "does not speak as a WebSocket"),
        (Some(b"HTTP/1.1 503 Service Unavailable\r\n\r\n"), "503"),
        (Some(b""), "waited 0.3 s"),
        (None, "says nothing within 0.2 s"),
    ] {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = format!("ws://{}", listener.local_addr().expect("an address"));
        std::thread::spawn(move || {
            let mut open = vec![];
            for stream in listener.incoming() {
                let mut stream = stream.expect("a connection");
                let Some(answer) = answer else {
                    open.push(stream);
                    continue;
                };
                let mut request = [0; 1000];
                let _ = stream.read(&mut request).and_then(|_| stream.write_all(answer));
            }
        });
        let fly = ["fly", "recipe.toml", "--policy", &address, "--out", "out", "--wait-s", "0.3", "--timeout-s", "0.2"];
        let printed = run(cosfly(&fly).within(street.path()));
        assert_eq!(printed.code, Some(1), "{words}: {}", printed.stderr);
        assert!(printed.stderr.contains(words) && printed.stderr.contains(&address), "{words}: {}", printed.stderr);
        assert!(!street.path().join("out").exists());
    }
}

#[test]
fn keys_are_in_no_error_no_row_and_no_page() {
    let street = Street::new();
    let key = "pass-1234-word";
    for address in ["ws://me:pass-1234-word@127.0.0.1:9", "ws://127.0.0.1:9/?api_key=pass-1234-word"] {
        let printed = run(cosfly(&["fly", "recipe.toml", "--policy", address]).within(street.path()));
        assert_eq!(printed.code, Some(3), "{}", printed.stderr);
        assert!(!printed.stderr.contains(key) && printed.stderr.contains("COSFLY_API_KEY"), "{}", printed.stderr);
    }
    // No option takes the key: other users read options in the list of processes.
    let printed = run(cosfly(&["fly", "recipe.toml", "--policy", "hold", "--api-key", key]).within(street.path()));
    assert_eq!(printed.code, Some(2), "{}", printed.stderr);
    assert!(!printed.stderr.contains(key) && printed.stderr.contains("--api-key-file"), "{}", printed.stderr);
    for (content, words) in
        [(Some("one\ntwo\n"), "is not a file with a key"), (Some(" \n"), "on one line"), (None, "key.txt")]
    {
        let file = street.path().join("key.txt");
        let _ = content.map_or_else(|| std::fs::remove_file(&file), |text| std::fs::write(&file, text));
        let asked = ["fly", "recipe.toml", "--policy", "hold", "--api-key-file", "key.txt"];
        let printed = run(cosfly(&asked).within(street.path()));
        assert!(printed.code != Some(0) && printed.stderr.contains(words), "{words}: {}", printed.stderr);
    }
    script(&street, "echo my key is $COSFLY_API_KEY >&2; exit 1");
    let printed = fly_into(&street, "out", &[]);
    assert!(printed.stderr.contains("the end of its standard error: my key is ***"), "{}", printed.stderr);
    assert!(!printed.stderr.contains(key), "{}", printed.stderr);
    // A policy that tells the key in its answer.
    let tells = "printf 't\\016\\000\\000\\000%s' $COSFLY_API_KEY";
    script(&street, &good_until(2, tells));
    let printed = fly_into(&street, "out", &["--jobs", "1"]);
    assert_eq!(printed.code, Some(0), "{}", printed.stderr);
    let mut folders = vec![street.path().join("out")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").path()) {
            if entry.is_dir() {
                folders.push(entry);
                continue;
            }
            let bytes = std::fs::read(&entry).expect("readable");
            assert!(!bytes.windows(key.len()).any(|part| part == key.as_bytes()), "{}", entry.display());
        }
    }
    assert!(rows(&street, "out")[0]["policy_failure"].as_str().is_some_and(|why| why.contains("***")));
}

#[test]
fn a_recipe_with_a_password_in_an_address_is_refused_without_showing_it() {
    let street = Street::new();
    let address = "stages.captions.teacher={model=\"m\",server={address=\"http://me:pass-1234-word@host/v1\"}}";
    let printed = run(cosfly(&["plan", "recipe.toml", "--set", "stages.captions.writer=teacher", "--set", address])
        .within(street.path()));
    assert!(printed.code != Some(0) && !printed.stderr.contains("pass-1234-word"), "{}", printed.stderr);
}
