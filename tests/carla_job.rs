//! `cosfly carla-job` through the real binary: reproducible jobs, chosen flights, errors.

use crate::street::Street;
use crate::support::cosfly;
use serde_json::Value;

#[test]
fn a_job_holds_the_flights_that_were_asked_for() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let job = |name: &str, more: &[&str]| {
        let arguments = [&["carla-job", "out/street", "--out", name], more].concat();
        let printed = cosfly(&arguments).within(street.path()).run_ok();
        (printed.stdout, std::fs::read_to_string(street.path().join(name)).expect("a job"))
    };
    let (said, whole) = job("job.json", &[]);
    assert!(said.starts_with("job.json: 6 flights with 72 frames\n") && said.contains("replay.py"), "{said}");
    assert_eq!(job("again.json", &[]).1, whole);
    let (_, some) = job("some.json", &["--trajectory", "perturbed-p00001", "--trajectory", "expert-p00001"]);
    let some: Value = serde_json::from_str(&some).expect("JSON");
    let flights = some["flights"].as_array().expect("flights");
    let ids: Vec<_> = flights.iter().map(|flight| flight["trajectory_id"].as_str().unwrap_or_default()).collect();
    assert_eq!(ids, ["perturbed-p00001", "expert-p00001"]);
    assert_eq!(flights[0]["target"], flights[1]["target"], "twins follow the same walker");
    assert_eq!(flights[0]["weather"].as_object().map(serde_json::Map::len), Some(14));

    let unknown = ["carla-job", "out/street", "--out", "none.json", "--trajectory", "expert-p1"];
    let refused = cosfly(&unknown).within(street.path()).run();
    assert!(refused.code == Some(3) && refused.stderr.contains("`expert-p00001`"), "{}", refused.stderr);
    assert!(!street.path().join("none.json").exists());
}
