//! The Dockerfile, held without a daemon: what it copies is there, what it runs is a shell's, its compiler is that of the workspace.
//! `.ci/run container` carries it out.

use crate::support::repository_root;
use std::process::Command;

fn text(path: &str) -> String {
    std::fs::read_to_string(repository_root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Instructions with their arguments.
fn instructions() -> Vec<(String, String)> {
    let lines = text("Dockerfile");
    let lines = lines.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| line.split_once(' ').map(|(a, b)| (a.to_owned(), b.to_owned())).expect("an argument")).collect()
}

fn arguments(instruction: &str) -> Vec<String> {
    instructions().into_iter().filter(|(name, _)| name == instruction).map(|(_, arguments)| arguments).collect()
}

#[test]
fn what_the_container_copies_is_there_and_what_it_runs_is_a_shells() {
    for copy in arguments("COPY") {
        let parts: Vec<&str> = copy.split(' ').collect();
        match parts[..] {
            ["--from=build", source, _] => assert_eq!(source, "/cosfly/target/release/cosfly"),
            [source, _] => assert!(repository_root().join(source).exists(), "the Dockerfile copies `{source}`"),
            _ => panic!("`COPY {copy}`: one source, one place"),
        }
    }
    for run in arguments("RUN") {
        let checked = Command::new("sh").args(["-n", "-c", &run]).status().expect("a shell");
        assert!(checked.success(), "`RUN {run}` is no command");
    }
    assert!(arguments("RUN").contains(&"cargo build --release".to_owned()));
    assert!(text("README.md").contains("cargo run --release"), "people and containers build the same");
    for ignored in ["target", ".git", "**/*.secret.toml"] {
        assert!(text(".dockerignore").lines().any(|line| line == ignored), "{ignored}");
    }
}

#[test]
fn the_containers_compiler_is_that_of_the_workspace() {
    let manifest = text("Cargo.toml");
    let version = manifest.lines().find_map(|line| line.strip_prefix("rust-version = ")).expect("a version");
    let first = arguments("FROM").remove(0);
    assert!(first.starts_with(&format!("rust:{}-", version.trim_matches('"'))), "{first}");
    let stages: Vec<String> =
        arguments("FROM").iter().filter_map(|it| Some(it.split_once(" AS ")?.1.to_owned())).collect();
    let container: serde_json::Value = serde_json::from_str(&text(".devcontainer/devcontainer.json")).expect("JSON");
    let target = container["build"]["target"].as_str().expect("a stage");
    assert!(stages.iter().any(|stage| stage == target), "{target}");
}
