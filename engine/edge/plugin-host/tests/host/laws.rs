//! Plugins that break the laws of cost terms without failing: each is found out.

use crate::fixtures::TermText;
use cosfly_plugin_host::laws::{LawFinding, check_cost_term};

const COUNTER: &str = "(global $calls (mut i32) (i32.const 0))";

/// The laws that it breaks.
fn broken(text: &TermText) -> Vec<&'static str> {
    let findings = check_cost_term(&text.load().unwrap(), "{}").unwrap();
    findings.into_iter().filter(|finding| !finding.holds).map(|LawFinding { law, .. }| law).collect()
}

fn counting(first: [&'static str; 4], cost: &'static str) -> TermText {
    TermText { fields: COUNTER.to_owned(), first, cost, ..TermText::default() }
}

#[test]
fn a_lawful_term_is_found_lawful() {
    assert!(broken(&TermText::default()).is_empty());
}

#[test]
fn what_is_carried_from_call_to_call_is_found() {
    let count = "(global.set $calls (i32.add (global.get $calls) (i32.const 1)))";
    let carried = "(f64.convert_i32_u (global.get $calls))";
    assert_eq!(broken(&counting(["", "", "", count], carried))[0], "pure");
    // Only after many calls, when the orders were compared already.
    let late = "(f64.convert_i32_u (i32.div_u (global.get $calls) (i32.const 9)))";
    assert_eq!(broken(&counting(["", "", "", count], late))[0], "pure");
    // Only from one track to the next.
    assert_eq!(broken(&counting(["", "", count, ""], carried))[0], "pure");
}

#[test]
fn what_is_read_of_neighbours_without_saying_so_is_found() {
    let next = "(f64.abs (f64.load offset=24 (local.get $p)))";
    assert!(broken(&TermText { cost: next, ..TermText::default() }).contains(&"support"));
}
