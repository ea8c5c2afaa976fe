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
