//! The promise of `cosfly_track_1`: nothing changes a byte of an episode within the version.

use crate::support::{cosfly, repository_root};

/// Hash of the tier `mini`.
const SUITE: &str = "5ca6a5b1c3be1f71870790089e248d0e1c9cde4b7264750add4e7bcfdb623aba";
/// Digest of the rows of `follow` in it.
const ROWS: &str = "47f37fcf173226f279f74bfdecf1ba843ba986493c91118eaf346b41a9ca5790";

#[test]
fn no_byte_of_an_episode_of_the_benchmark_has_changed() {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let at = |name: &str| scratch.path().join(name).display().to_string();
    let benchmark = repository_root().join("recipes/benchmarks/track_1.toml").display().to_string();
    let fly = ["fly", &benchmark, "--tier", "mini", "--policy", "follow", "--clips", "0", "--logs", "none", "--quiet"];
    cosfly(&[&fly[..], &["--store", &at("store"), "--out", &at("out")]].concat()).run_ok();
    let read = |name: &str| std::fs::read_to_string(at(name)).expect("a file of the result");
    let card: serde_json::Value = serde_json::from_str(&read("out/follow/card.json")).expect("JSON");
    let rows = read("out/follow/episodes.jsonl");
    assert_eq!(rows.lines().count(), 52, "episodes of the tier");
    assert_eq!(
        (card["suite"]["hash"].as_str(), &*cosfly_fingerprint::Digest::of(rows.as_bytes()).to_string()),
        (Some(SUITE), ROWS),
        "episodes of cosfly_track_1 have changed: its results cannot be compared any more. Once released, leave them as they are, or \
         make another version of the benchmark beside this one"
    );
}
