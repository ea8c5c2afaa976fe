//! Labels of plugins are stored beside the costs of a flight and told apart from them.

use cosfly_sample as sample;
use cosfly_schema::Role;
use cosfly_schema::flight_labels::{FlightLabel, add, costs, labels};

#[test]
fn labels_and_costs_are_kept_apart() {
    let mut flight = sample::flight(0, Role::Expert).record.trajectory;
    let before: Vec<String> = costs(&flight).map(|term| term.name.clone()).collect();
    let label = FlightLabel { name: "risk", plugin: "watch", version: "1.0/rc", per_frame: &[0.0, 1.0, 2.0, 3.0] };
    add(&mut flight, label).unwrap();
    assert_eq!(labels(&flight).collect::<Vec<_>>(), [label]);
    assert_eq!(costs(&flight).map(|term| term.name.clone()).collect::<Vec<_>>(), before);
    assert!(add(&mut flight, label).unwrap_err().contains("plugin `watch` already gave one"));
}
