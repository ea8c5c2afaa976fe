//! Plugins that are stages: what they declare is held against the rules, and wild answers end in errors.

use crate::stage_text::StageText;
use cosfly_frames::Seed;
use cosfly_plugin_host::{Effect, Host, Kind, NoTown, Plugin, PluginError, PluginLimits, ValueKind, run_stage};
use std::sync::Arc;

fn load(text: &StageText) -> Result<Plugin, PluginError> {
    let limits = PluginLimits { call_ms: 200, memory_mib: 16, ..PluginLimits::default() };
    Host::new(None).load_bytes(&text.bytes(), "stage.wasm", Some(Kind::Stage), limits)
}

fn answer(text: &StageText) -> Result<Vec<u8>, PluginError> {
    let flight = |_: &_| Ok(b"a flight".to_vec());
    run_stage(&load(text)?, Arc::new(NoTown), "{}", flight).map(|(_, answered)| answered.answer)
}

fn check(text: &StageText, function: Option<&str>, words: &str) {
    let error = answer(text).expect_err("the plugin is hostile");
    assert_eq!((error.plugin.as_str(), error.function), ("stage.wasm", function), "{error}");
    assert!(error.message.contains(words), "{error}");
}

#[test]
fn a_stage_declares_what_it_reads_and_gives_and_answers_bytes() {
    let text = StageText {
        effect: 3,
        name: "losses",
        gives: vec![("first", 1), ("why", 3)],
        answer: b"an answer".to_vec(),
        ..StageText::default()
    };
    let mut declared = None;
    let flight = |seen: &cosfly_plugin_host::Declaration| {
        declared = Some(seen.clone());
        Ok(vec![1; 100_000])
    };
    let (_, answered) = run_stage(&load(&text).unwrap(), Arc::new(NoTown), "{}", flight).unwrap();
    let declared = declared.unwrap();
    assert_eq!(
        (answered.answer, declared.effect, declared.name),
        (b"an answer".to_vec(), Effect::Rows, "losses".into())
    );
    let kinds: Vec<_> = declared.gives.iter().map(|column| (column.name.as_str(), column.kind)).collect();
    assert_eq!(kinds, [("first", ValueKind::Integer), ("why", ValueKind::Text)]);
}

#[test]
fn declarations_that_are_none_are_refused_in_configure() {
    let text = StageText::default();
    check(&StageText { gives: vec![("risk", 9)], ..text.clone() }, Some("configure"), "");
    check(&StageText { effect: 9, ..text.clone() }, Some("configure"), "");
    check(&StageText { effect: 4, name: "../../x", ..text.clone() }, Some("configure"), "it names `../../x`");
    check(&StageText { effect: 3, name: "a", gives: vec![("risk", 4)], ..text.clone() }, Some("configure"), "as bytes");
    check(&StageText { given: Some(1 << 29), ..text.clone() }, Some("configure"), "");
    check(&StageText { given: Some(-1), ..text.clone() }, Some("configure"), "");
    check(&StageText { first: ["(loop $l (br $l))", ""], ..text }, Some("configure"), "within 200 ms");
}

#[test]
fn answers_that_are_larger_than_the_memory_are_refused_in_run() {
    let text = StageText::default();
    // 2 GiB and more, in a memory of 16 MiB.
    for answered in [i32::MAX, i32::MIN, -1, 17 << 20] {
        check(&StageText { answered: Some(answered), ..text.clone() }, Some("run"), "");
    }
    let grow = "(if (i32.eq (memory.grow (i32.const 65000)) (i32.const -1)) (then unreachable))";
    check(&StageText { first: ["", grow], ..text.clone() }, Some("run"), "its limit is 16 MiB");
    check(&StageText { first: ["", "(loop $l (br $l))"], ..text }, Some("run"), "within 200 ms");
}

#[test]
fn stages_of_before_they_declared_their_columns_are_refused_by_name() {
    let old = StageText { interface: "cosfly:plugin/transform@0.1.0", ..StageText::default() };
    check(&old, None, "transform");
    let newer = StageText { interface: "cosfly:plugin/tables@0.2.0", ..StageText::default() };
    check(&newer, None, "0.2.0");
}

#[test]
fn damaged_stages_are_refused_or_run_within_their_limits() {
    let good = StageText { answer: b"an answer".to_vec(), ..StageText::default() }.bytes();
    let mut stream = Seed::of_item(8, "plugins", "damaged").stream("bytes");
    let limits = PluginLimits { call_ms: 50, memory_mib: 8, ..PluginLimits::default() };
    let host = Host::new(None);
    let mut ran = 0;
    for _ in 0..200 {
        let mut bytes = good.clone();
        for _ in 0..=stream.index(3) {
            let at = stream.index(bytes.len());
            bytes[at] = stream.index(256) as u8;
        }
        if let Ok(plugin) = host.load_bytes(&bytes, "damaged.wasm", Some(Kind::Stage), limits) {
            ran += i32::from(run_stage(&plugin, Arc::new(NoTown), "{}", |_| Ok(vec![0; 64])).is_ok());
        }
    }
    assert!(ran > 5, "{ran}");
}
