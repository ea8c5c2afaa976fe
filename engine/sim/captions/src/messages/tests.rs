//! Laws of the tables: all languages have the same messages and slots, each message is used, and a new table speaks.

use super::{Messages, Speaker, messages_of};
use crate::caption::tests::flights;
use crate::description::description;
use crate::instruction::instruction;
use cosfly_claims::Language;
use cosfly_random::Seed;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Slots that say the same: a language takes the form that it needs.
const FORMS: &[(&str, &str)] = &[
    ("K", "k"),
    ("F", "f"),
    ("W", "w"),
    ("O", "o"),
    ("b", "p"),
    ("a-top", "top"),
    ("carries", "backpack"),
    ("count", "n"),
    ("times", "n"),
];

/// Slots that a language may leave out: forms of verbs, an angle's side, orders of a phrase, sides and clothes said elsewhere.
const OPTIONAL: &[&str] = &[
    "be", "not", "v", "look", "front", "back", "all", "side", "place", "C", "L", "w", "f", "c", "m", "n", "t", "r",
    "o", "p",
];

/// Messages about somebody who walks.
fn messages(language: Language) -> &'static Messages {
    messages_of(language, false)
}

fn slots(text: &str) -> BTreeSet<&str> {
    let names = text.split('{').skip(1).filter_map(|it| it.split_once('}')).map(|(name, _)| name);
    names.map(|name| FORMS.iter().find(|it| it.0 == name).map_or(name, |it| it.1)).collect()
}

/// Slots of each message, whatever its selector.
fn slots_of(messages: &Messages) -> BTreeMap<&str, BTreeSet<&str>> {
    let mut of: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (id, wordings) in messages.iter() {
        of.entry(stem(id)).or_default().extend(wordings.iter().flat_map(|it| slots(it)));
    }
    of
}

fn stem(id: &str) -> &str {
    id.split('[').next().unwrap_or(id)
}

#[test]
fn all_languages_have_the_same_messages_and_slots() {
    let english = slots_of(messages(Language::En));
    for language in Language::ALL.iter().copied() {
        let other = slots_of(messages(language));
        assert!(other.keys().eq(english.keys()), "{language:?}");
        for (id, slots) in &english {
            let different: Vec<_> =
                slots.symmetric_difference(&other[id]).filter(|slot| !OPTIONAL.contains(slot)).collect();
            assert!(different.is_empty() || other[id].is_empty(), "`{id}` of {language:?}: {different:?}");
        }
    }
}

#[test]
fn each_message_is_used() {
    let mut sources = String::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.extension() {
                None => folders.push(path),
                Some(kind) if kind == "rs" => sources += &fs::read_to_string(path).unwrap(),
                Some(_) => {}
            }
        }
    }
    // Built of parts by `predicate.rs`, `speaker.rs` and `compose.rs`.
    let is_built = |id: &str| ["claim-", "landmark-", "numerals-", "ordinals-"].iter().any(|it| id.starts_with(it));
    for (id, _) in messages(Language::En).iter().filter(|(id, _)| !is_built(id)) {
        let stem = stem(id);
        let is_used = ["\"", "[", "{"].iter().any(|end| sources.contains(&format!("\"{stem}{end}")));
        assert!(is_used, "`{stem}` is used nowhere");
    }
}

#[test]
fn a_toy_language_costs_one_table() {
    let mut file = String::new();
    for (id, wordings) in messages(Language::En).iter() {
        let slots: String = slots_in_order(wordings.first().map_or("", String::as_str));
        file += &format!("{id} = ba{slots}\n");
    }
    let toy = Messages::parse(&file);
    for (at, facts) in flights().iter().enumerate() {
        for template in 0..8 {
            let words = &mut Seed::of_item(at as u64, "toy", "words").stream("words");
            let speaker = &mut Speaker { messages: &toy, words };
            for text in [instruction(facts, template, speaker), description(facts, template, speaker)] {
                assert!(text.to_lowercase().starts_with("ba") && !text.contains(['{', '}']), "{text}");
            }
        }
    }
}

/// ` {d} {p}`.
fn slots_in_order(text: &str) -> String {
    text.split('{').skip(1).filter_map(|it| it.split_once('}')).map(|(name, _)| format!(" {{{name}}}")).collect()
}

#[test]
fn words_of_running_stand_once_and_whole() {
    let said = |text: &str, language| {
        let pairs = "running-words =\n".to_owned()
            + &messages(language).all("running-words").iter().map(|it| format!("    {it}\n")).collect::<String>();
        Messages::parse(&format!("{pairs}said = {text}\n")).of_runner().text("said").to_owned()
    };
    for (language, walks, runs) in [
        (Language::Zh, "行走速度约2米/秒", "跑步速度约2米/秒"),
        (Language::Zh, "行走时步速约2米/秒", "跑步时跑速约2米/秒"),
        (Language::Zh, "走斑马线过马路", "从斑马线跑过马路"),
        (Language::En, "Walking on, the walker walks", "Running on, the walker runs"),
    ] {
        assert_eq!(said(walks, language), runs);
    }
    for (id, wordings) in Language::ALL.iter().flat_map(|it| messages_of(*it, true).iter()) {
        assert!(!wordings.iter().any(|it| it.contains("跑跑")), "`{id}`: {wordings:?}");
    }
}
