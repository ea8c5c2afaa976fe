//! `cosfly doctor` through the real binary: sound data, damaged data, other folders.

use crate::street::Street;
use crate::support::cosfly;

#[test]
fn sound_data_and_damaged_data_are_told_apart() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let examined = |more: &[&str]| {
        let arguments = [&["doctor", "out/street", "--imperfect", "100"], more].concat();
        cosfly(&arguments).within(street.path()).run()
    };
    let printed = examined(&["--quota", "0:2-4"]);
    assert_eq!(printed.code, Some(0), "{}{}", printed.stdout, printed.stderr);
    assert!(printed.stdout.contains("6 episodes with 72 frames") && printed.stdout.contains("quota met"));
    assert_eq!(examined(&["--quota", "100:90-99"]).code, Some(1), "a quota that is not met");
    let log = street.dataset().join("mcap/street/000/perturbed-p00001.mcap");
    let mut bytes = std::fs::read(&log).expect("the log");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    std::fs::remove_file(&log).and_then(|()| std::fs::write(&log, bytes)).expect("writable");
    let printed = examined(&["--json", "verdict.json"]);
    assert_eq!(printed.code, Some(1));
    assert!(printed.stdout.contains("damage: mcap/street/000/perturbed-p00001.mcap"), "{}", printed.stdout);
    let verdict = std::fs::read(street.path().join("verdict.json")).expect("a verdict");
    let verdict: serde_json::Value = serde_json::from_slice(&verdict).expect("JSON");
    assert_eq!(verdict["flags"][0]["name"], "log-damaged");
}

#[test]
fn a_folder_of_no_known_layout_and_a_strange_quota_are_refused() {
    let street = Street::new();
    let printed = cosfly(&["doctor", "."]).within(street.path()).run();
    assert_eq!(printed.code, Some(4));
    insta::assert_snapshot!("doctor_unknown", printed.stderr);
    assert_eq!(cosfly(&["doctor", ".", "--quota", "20:4-2"]).within(street.path()).run().code, Some(2));
    insta::assert_snapshot!("help_doctor", cosfly(&["doctor", "--help"]).run_ok().stdout);
}
