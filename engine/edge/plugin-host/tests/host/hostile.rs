//! Plugins that do what they must not: each is stopped within its limit, with a message that says which.

use crate::fixtures::{TermText, costs_of, flight, load};
use cosfly_plugin_host::{Host, Kind, MAX_FILE_BYTES, PluginError, PluginLimits};

fn refusal(text: &TermText) -> PluginError {
    text.costs(&flight(6)).expect_err("the plugin is hostile")
}

/// Check of the module as it is, and as a component, where it can be made one.
fn check(text: TermText, function: Option<&str>, words: &str) {
    let of_component = text.component().map(|bytes| {
        let costs = load(&bytes).and_then(|plugin| costs_of(&plugin, &flight(6)));
        costs.expect_err("the plugin is hostile")
    });
    for error in [refusal(&text)].into_iter().chain(of_component) {
        assert_eq!(error.function, function, "{error}");
        assert!(error.message.contains(words), "{error}");
        assert_eq!(error.plugin, "square.wasm");
    }
}

fn first(function: usize, what: &'static str) -> TermText {
    let mut first = [""; 4];
    first[function] = what;
    TermText { first, ..TermText::default() }
}

#[test]
fn endless_loops_meet_the_deadline_in_every_function() {
    for (function, name) in ["describe", "configure", "begin", "evaluate"].into_iter().enumerate() {
        check(first(function, "(loop $l (br $l))"), Some(name), "did not finish within 200 ms");
    }
    let start = TermText { fields: "(func $go (loop $l (br $l))) (start $go)".into(), ..TermText::default() };
    check(start, Some("start"), "did not finish within 200 ms");
}

#[test]
fn memory_ends_at_its_limit() {
    let grow = "(if (i32.eq (memory.grow (i32.const 65000)) (i32.const -1)) (then unreachable))";
    check(first(3, grow), Some("evaluate"), "MiB of memory; its limit is 16 MiB");
    check(TermText { pages: 60_000, ..TermText::default() }, Some("start"), "of memory; its limit is 16 MiB");
}

#[test]
fn endless_recursion_and_traps_are_named() {
    check(first(3, "(drop (call $recurse (i32.const 0)))"), Some("evaluate"), "endless recursion");
    check(first(3, "unreachable"), Some("evaluate"), "unreachable");
    check(first(2, "(drop (i32.div_u (i32.const 1) (i32.const 0)))"), Some("begin"), "divide by zero");
    check(first(3, "(drop (f64.load (i32.const -8)))"), Some("evaluate"), "outside its memory");
}

#[test]
fn words_of_plugins_do_not_control_the_terminal() {
    let text = TermText { name: "\\1b[2J\\07red", ..TermText::default() };
    for bytes in [Some(text.bytes()), text.component()].into_iter().flatten() {
        let error = load(&bytes).err().expect("the name is refused");
        assert!(error.message.contains("\u{241b}[2J\u{2407}red"), "{error:?}");
        assert!(!error.message.chars().any(char::is_control), "{error:?}");
    }
}

#[test]
fn wrong_answers_are_named_with_their_place() {
    for (more, words) in [(-1, "5 costs for 6 waypoints"), (1, "7 costs for 6 waypoints")] {
        check(TermText { more, ..TermText::default() }, Some("evaluate"), words);
    }
    for (cost, words) in [
        ("(f64.const nan)", "cost 0 is NaN at waypoint [-3, 2, 20]"),
        ("(f64.const inf)", "cost 0 is inf"),
        ("(f64.const -inf)", "cost 0 is -inf"),
        ("(f64.load (local.get $p))", "cost 0 is -3"),
    ] {
        check(TermText { cost, ..TermText::default() }, Some("evaluate"), words);
    }
    check(TermText { more: 100_000_000, ..TermText::default() }, Some("evaluate"), "");
    check(TermText { name: "No Name", ..TermText::default() }, Some("describe"), "its name is `No Name`");
    check(TermText { schema: "{", ..TermText::default() }, Some("describe"), "is not JSON");
}

#[test]
fn after_a_trap_nothing_more_is_called_and_the_next_instance_is_fresh() {
    let fields = "(global $calls (mut i32) (i32.const 0))".to_owned();
    let count = "(global.set $calls (i32.add (global.get $calls) (i32.const 1)))
                 (if (i32.ge_u (global.get $calls) (i32.const 2)) (then unreachable))";
    let text = TermText { fields, ..first(3, count) };
    let plugin = text.load().unwrap();
    for _ in 0..3 {
        assert_eq!(costs_of(&plugin, &flight(2)).unwrap(), [9.0, 4.0]);
    }
}

#[test]
fn other_interfaces_and_missing_functions_are_refused_by_name() {
    for version in ["0.2.0", "0.0.9", "1.0.0"] {
        let error = refusal(&TermText { version, ..TermText::default() });
        assert!(error.message.contains(version) && error.message.contains("0.1.0"), "{error}");
    }
    check(TermText { missing: &["begin"], ..TermText::default() }, None, "begin");
    let all: &[&str] = &["describe", "configure", "begin", "evaluate"];
    check(TermText { missing: all, ..TermText::default() }, None, "exports nothing of `cosfly:plugin/");
    let plugin = TermText::default().bytes();
    let error =
        Host::new(None).load_bytes(&plugin, "x.wasm", Some(Kind::Stage), PluginLimits::default()).err().unwrap();
    assert!(error.message.contains("it is a cost term; a stage is wanted"), "{error}");
}

#[test]
fn imports_that_are_not_offered_are_refused_by_name() {
    let fields = r#"(import "env" "clock" (func $clock (result f64)))"#.to_owned();
    check(TermText { fields, ..TermText::default() }, None, "env");
    let fields =
        r#"(import "wasi_snapshot_preview1" "clock_time_get" (func (param i32 i64 i32) (result i32)))"#.to_owned();
    check(TermText { fields, ..TermText::default() }, None, "wasi_snapshot_preview1");
    let component = wat::parse_str(
        r#"(component (import "cosfly:plugin/clock@0.1.0" (instance (export "now" (func (result f64))))))"#,
    );
    let error = Host::new(None).load_bytes(&component.unwrap(), "x.wasm", None, PluginLimits::default()).err().unwrap();
    assert!(error.message.contains("exports nothing") || error.message.contains("clock"), "{error}");
}

#[test]
fn exact_budgets_end_at_the_same_place_every_time() {
    let bytes = TermText::default().bytes();
    let tried = |fuel: u64| {
        let limits = PluginLimits { fuel, ..PluginLimits::default() };
        let plugin = Host::new(None).load_bytes(&bytes, "square.wasm", None, limits)?;
        costs_of(&plugin, &flight(100))
    };
    let error = tried(500).unwrap_err();
    assert!(error.message.contains("more than 500 instructions"), "{error}");
    tried(20_000).unwrap();
}

#[test]
fn files_that_are_no_plugins_are_refused_quickly() {
    let folder = tempfile::tempdir().unwrap();
    let host = Host::new(None);
    let refused = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        host.load(&path, name, None, PluginLimits::default()).err().unwrap().message
    };
    assert!(refused("text.wasm", b"name = \"x\"").contains("not a WebAssembly file"));
    assert!(refused("empty.wasm", b"").contains("not a WebAssembly file"));
    assert!(refused("code.cwasm", b"\x7fELF....").contains("compiled machine code"));
    assert!(refused("cut.wasm", &TermText::default().bytes()[..300]).contains("not valid WebAssembly"));
    let large = folder.path().join("large.wasm");
    std::fs::File::create(&large).unwrap().set_len(500 << 20).unwrap();
    let error = host.load(&large, "large.wasm", None, PluginLimits::default()).err().unwrap();
    assert!(error.message.contains(&format!("500 MiB; at most {}", MAX_FILE_BYTES >> 20)), "{error}");
    let absent = host.load(&folder.path().join("absent.wasm"), "absent.wasm", None, PluginLimits::default());
    assert!(absent.err().unwrap().message.contains("cannot be read"));
}
