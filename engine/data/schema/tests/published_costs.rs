//! Published costs of a flight: those of its terms, and the coverage of an inspection.

use cosfly_sample as sample;
use cosfly_schema::Role;
use cosfly_schema::published_costs::costs;

#[test]
fn the_coverage_is_the_last_cost_and_has_no_weight() {
    let mut flight = sample::flight(0, Role::Expert).record.trajectory;
    let before: Vec<String> = costs(&flight).map(|cost| cost.name.to_owned()).collect();
    assert_eq!(before, ["distance"]);
    flight.coverage = vec![0.25, 0.0, 0.5, 0.0];
    let last = costs(&flight).last().expect("a cost");
    assert_eq!((last.name, last.weight, last.sum, last.per_frame), ("coverage", 0.0, 0.75, &flight.coverage[..]));
}
