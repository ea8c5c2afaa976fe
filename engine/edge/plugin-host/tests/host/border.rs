//! The border under fire: damaged bytes and wild answers must end in an error, never in a panic of the host.

use crate::fixtures::{TermText, costs_of, flight};
use cosfly_frames::Seed;
use cosfly_plugin_host::{Host, Kind, PluginLimits};

#[test]
fn damaged_modules_are_refused_or_run_within_their_limits() {
    let good = TermText::default().bytes();
    let mut stream = Seed::of_item(5, "plugins", "damaged").stream("bytes");
    let limits = PluginLimits { call_ms: 50, memory_mib: 8, ..PluginLimits::default() };
    let host = Host::new(None);
    let (mut loaded, mut ran) = (0, 0);
    for _ in 0..400 {
        let mut bytes = good.clone();
        for _ in 0..=stream.index(3) {
            let at = stream.index(bytes.len());
            bytes[at] = stream.index(256) as u8;
        }
        if let Ok(plugin) = host.load_bytes(&bytes, "damaged.wasm", Some(Kind::CostTerm), limits) {
            loaded += 1;
            ran += i32::from(costs_of(&plugin, &flight(4)).is_ok());
        }
    }
    assert!(loaded > 10 && ran > 5, "{loaded} {ran}");
}

#[test]
fn wild_pointers_and_lengths_in_answers_are_errors() {
    // The answer's own pointer, and the numbers in it.
    for wild in ["(return (i32.const -4))", "(return (i32.const 131072))", "(return (i32.const 3))"] {
        let mut first = [""; 4];
        first[3] = wild;
        TermText { first, ..TermText::default() }.costs(&flight(3)).unwrap_err();
    }
    for more in [i32::MAX, i32::MIN, 1 << 28, 1 << 20] {
        TermText { more, ..TermText::default() }.costs(&flight(3)).unwrap_err();
    }
    let tag = "(i32.store (i32.const 128) (i32.const 7)) (return (i32.const 128))";
    let mut first = [""; 4];
    first[3] = tag;
    TermText { first, ..TermText::default() }.costs(&flight(3)).unwrap_err();
}

#[test]
fn damaged_components_are_refused_or_run_within_their_limits() {
    let good = TermText::default().component().unwrap();
    let mut stream = Seed::of_item(6, "plugins", "damaged").stream("bytes");
    let limits = PluginLimits { call_ms: 50, memory_mib: 8, ..PluginLimits::default() };
    let host = Host::new(None);
    let mut refused = 0;
    for _ in 0..200 {
        let mut bytes = good.clone();
        for _ in 0..=stream.index(3) {
            let at = stream.index(bytes.len());
            bytes[at] = stream.index(256) as u8;
        }
        let loaded = host.load_bytes(&bytes, "damaged.wasm", Some(Kind::CostTerm), limits);
        refused += i32::from(loaded.and_then(|plugin| costs_of(&plugin, &flight(4))).is_err());
    }
    assert!(refused > 20, "{refused}");
}

#[test]
fn random_answers_end_in_errors_or_in_costs_that_keep_the_rules() {
    let mut stream = Seed::of_item(7, "plugins", "answers").stream("words");
    let mut kept = 0;
    for _ in 0..150 {
        // Five words of an answer: tag, and addresses and lengths of costs and gradients; often near what is right.
        let mut word = |near: &[u32]| match stream.index(3) {
            0 => near[stream.index(near.len())],
            1 => stream.index(200_000) as u32,
            _ => (stream.index(1 << 16) as u32) << 16 | stream.index(1 << 16) as u32,
        };
        let words = [word(&[0, 0, 0, 1, 2]), word(&[1024, 8192, 8]), word(&[3]), word(&[0, 8]), word(&[0, 9])];
        let stores = words
            .iter()
            .enumerate()
            .map(|(k, word)| format!("(i32.store (i32.const {}) (i32.const {}))", 128 + 4 * k, word.cast_signed()));
        let first: &'static str = (stores.collect::<String>() + "(return (i32.const 128))").leak();
        let text = TermText { first: ["", "", "", first], ..TermText::default() };
        if let Ok(costs) = text.costs(&flight(3)) {
            kept += 1;
            assert!(costs.len() == 3 && costs.iter().all(|cost| *cost >= 0.0 && cost.is_finite()), "{costs:?}");
        }
    }
    assert!(kept > 0);
}
