//! Runs on other machines: commands for any engine, and HyperQueue played by a script. The real engine is in `.ci/run cluster`.

use crate::street::Street;
use crate::support::{Call, cosfly, tree_digests};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Plays `hq`: runs all commands of a job file when it is submitted, in the order of the file, and keeps their exit codes in a
/// folder. `FORGET` there makes the server forget its jobs once after each task; `KILL` ends every third command unrun, once.
const FAKE: &str = r#"#!/bin/sh
folder=@FOLDER@
shift 2
case "$1 $2" in
"server info") echo '{"version": "0.27.0"}' ;;
"worker list") echo '[{"id": 1}]' ;;
"job submit-file")
  count=$(($(cat $folder/count 2>/dev/null || echo 0) + 1))
  echo $count > $folder/count
  job=$folder/$count
  mkdir $job
  cp "$3" $job/file
  id= ; command=
  while IFS= read -r line; do
    case "$line" in
    "name = "*) echo "$line" | cut -d'"' -f2 > $job/name ;;
    "id = "*) id=${line#id = }; deps= ;;
    "command = "*) command=$(echo "$line" | sed 's/^command = \[//; s/\]$//; s/", "/" "/g') ;;
    "deps = "*) deps=$(echo "$line" | tr -d 'deps=[],') ;;
    "resources = "*)
      state=0
      for dep in $deps; do [ -e $job/$dep.0 ] || state=aborted; done
      if [ $state = 0 ] && [ -e $folder/KILL ] && [ $((id % 3)) = 0 ]; then state=137
      elif [ $state = 0 ]; then eval "$command" >>$folder/log 2>&1; state=$?; fi
      : > $job/$id.$state ;;
    esac
  done < "$3"
  rm -f $folder/KILL
  echo "{\"id\": $count}"
  if [ -e $folder/FORGET ]; then rm -r $job $folder/FORGET; fi ;;
"job list")
  echo '['
  comma=
  for job in $folder/[0-9]*; do
    [ -d $job ] || continue
    all=$(ls $job | grep -c '^[0-9]'); good=$(ls $job | grep -c '\.0$'); bad=$((all - good))
    echo "$comma{\"id\": ${job##*/}, \"name\": \"$(cat $job/name)\", \"task_count\": $all,
      \"task_stats\": {\"finished\": $good, \"failed\": $bad, \"aborted\": 0, \"canceled\": 0}}"
    comma=,
  done
  echo ']' ;;
"job task-ids") echo "{\"$3\": [$(ls $folder/$3 | sed -n 's/\.0$//p' | paste -sd,)]}" ;;
"task list")
  echo "{\"$3\": ["
  ls $folder/$3 | sed -n '/^[0-9]*\.[1-9]/{s/\([0-9]*\)\.\(.*\)/{"id": \1, "error": "Program terminated with exit code \2"}/;p}' | paste -sd,
  echo ']}' ;;
*) echo "not played: $*" >&2; exit 1 ;;
esac
"#;

/// The script in a folder of its own.
struct FakeHq {
    folder: tempfile::TempDir,
}

impl FakeHq {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let text = FAKE.replace("@FOLDER@", &folder.path().display().to_string());
        let path = folder.path().join("hq");
        std::fs::write(&path, text).expect("written");
        let made = Command::new("chmod").arg("+x").arg(&path).status().expect("chmod");
        assert!(made.success());
        Self { folder }
    }

    fn run(&self, street: &Street, out: &str, more: &[&str]) -> Call {
        let arguments = ["run", "recipe.toml", "--on", "hq", "--store", "shared store", "--out", out];
        let arguments: Vec<&str> = arguments.into_iter().chain(more.iter().copied()).collect();
        cosfly(&arguments).within(street.path()).with("COSFLY_HQ", &self.path().display().to_string())
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("hq")
    }

    fn trouble(&self, name: &str) {
        std::fs::write(self.folder.path().join(name), "").expect("written");
    }

    fn jobs(&self) -> String {
        std::fs::read_to_string(self.folder.path().join("count")).expect("jobs").trim().to_owned()
    }
}

fn local(street: &Street) -> Vec<(String, String)> {
    cosfly(&["run", "recipe.toml", "--out", "local", "--store", "store-local"]).within(street.path()).run_ok();
    tree_digests(&street.path().join("local"))
}

#[test]
fn on_hq_the_bytes_are_those_of_a_local_run_and_a_second_run_submits_nothing() {
    let (street, hq) = (Street::new(), FakeHq::new());
    let printed = hq.run(&street, "out", &[]).run_ok();
    assert!(printed.stderr.contains("frames  6/6 done"), "{}", printed.stderr);
    assert_eq!(tree_digests(&street.path().join("out")), local(&street));
    assert_eq!(hq.jobs(), "1");
    hq.run(&street, "out", &["--request", "frames:cpus=2,time=1h"]).run_ok();
    assert_eq!(hq.jobs(), "1", "everything was finished");
}

#[test]
fn commands_that_are_killed_and_jobs_that_are_forgotten_are_submitted_again() {
    let (street, hq) = (Street::new(), FakeHq::new());
    hq.trouble("KILL");
    hq.trouble("FORGET");
    hq.run(&street, "out", &[]).run_ok();
    assert_eq!(tree_digests(&street.path().join("out")), local(&street));
    assert_eq!(hq.jobs(), "2");
    let (street, hq) = (Street::new(), FakeHq::new());
    hq.trouble("KILL");
    hq.run(&street, "out", &["--request", "*:batch=2"]).run_ok();
    assert_eq!(tree_digests(&street.path().join("out")), local(&street));
}

#[test]
fn a_failure_on_another_machine_is_told_as_a_local_one() {
    let (street, hq) = (Street::new(), FakeHq::new());
    std::fs::write(street.path().join("street.xodr"), "<OpenDRIVE><road").expect("written");
    let there = hq.run(&street, "out", &[]).run();
    let here = cosfly(&["run", "recipe.toml", "--store", "store-local"]).within(street.path()).run();
    let code = |text: &str| text.split_once("error[").map(|(_, rest)| rest.split(']').next().unwrap_or("").to_owned());
    assert_eq!((there.code, code(&there.stderr)), (here.code, code(&here.stderr)), "{}{}", there.stderr, here.stderr);
    assert_eq!(there.stderr.matches("error[").count(), 1, "told once: {}", there.stderr);
    // What was mended is tried again.
    let good = Street::new();
    std::fs::copy(good.path().join("street.xodr"), street.path().join("street.xodr")).expect("copied");
    hq.run(&street, "out", &[]).run_ok();
}

#[test]
fn a_command_that_never_gives_a_result_fails_with_the_words_of_the_engine() {
    let (street, hq) = (Street::new(), FakeHq::new());
    let printed = hq.run(&street, "out", &["--leaf", "sh -c exit_5 no-such-cosfly"]).run();
    assert_eq!(printed.code, Some(5));
    assert!(printed.stderr.contains("cluster-task-lost"), "{}", printed.stderr);
    assert!(printed.stderr.contains("exit code 127"), "{}", printed.stderr);
}

#[test]
fn without_hyperqueue_the_message_says_what_to_install() {
    let street = Street::new();
    let call =
        |hq: &str| cosfly(&["run", "recipe.toml", "--on", "hq"]).within(street.path()).with("COSFLY_HQ", hq).run();
    let printed = call("/nowhere/hq");
    assert_eq!(printed.code, Some(5));
    assert!(
        printed.stderr.contains("cluster-hq-missing") && printed.stderr.contains("COSFLY_HQ"),
        "{}",
        printed.stderr
    );
    let printed = call("false");
    assert!(
        printed.stderr.contains("cluster-hq-refused") && printed.stderr.contains("server start"),
        "{}",
        printed.stderr
    );
    let printed = call("echo");
    assert!(printed.stderr.contains("cluster-hq-answer"), "{}", printed.stderr);
}

#[test]
fn emitted_commands_run_in_their_order_leave_the_dataset_alone_to_do() {
    let street = Street::new();
    let arguments = ["run", "recipe.toml", "--on", "emit", "--store", "emitted", "--request", "captions:batch=4"];
    let printed = cosfly(&arguments).within(street.path()).run_ok();
    let mut done = vec![];
    for line in printed.stdout.lines() {
        let leaf: Value = serde_json::from_str(line).expect("JSON");
        assert!(leaf["deps"].as_array().expect("a list").iter().all(|dep| done.contains(dep)), "{line}");
        let words: Vec<&str> = leaf["command"].as_array().expect("a list").iter().filter_map(Value::as_str).collect();
        let ended = Command::new(words[0]).args(&words[1..]).current_dir(Path::new("/")).output().expect("started");
        assert!(ended.status.success(), "{line}: {}", String::from_utf8_lossy(&ended.stderr));
        done.push(leaf["id"].clone());
    }
    let arguments = ["run", "recipe.toml", "--out", "out", "--store", "emitted", "--json"];
    let summary: Value = serde_json::from_str(&cosfly(&arguments).within(street.path()).run_ok().stdout).expect("JSON");
    for stage in summary["stages"].as_array().expect("stages") {
        assert_eq!(stage["ran"], u64::from(stage["stage"] == "dataset"), "{stage}");
    }
    assert_eq!(tree_digests(&street.path().join("out")), local(&street));
    let again = cosfly(&["run", "recipe.toml", "--on", "emit", "--store", "emitted"]).within(street.path()).run_ok();
    assert_eq!(again.stdout, "");
}
