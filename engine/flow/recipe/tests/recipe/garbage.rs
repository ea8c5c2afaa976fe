//! No text and no override makes the reader panic, and its messages can be printed.

use crate::toys::WHOLE;
use cosfly_diagnose::render_all;
use proptest::prelude::*;

/// Fragments that pass more checks of the reader than random letters.
const PIECES: [&str; 44] = [
    "\n",
    " ",
    "=",
    "[",
    "]",
    "{",
    "}",
    ".",
    ",",
    "\"",
    "'",
    "#",
    "\"\"\"",
    "[[",
    "]]",
    "stages",
    "name",
    "seed",
    "use",
    "inputs",
    "town",
    "people",
    "frames",
    "map",
    "walkers",
    "render",
    "dataset",
    "count",
    "speed",
    "pause",
    "kind",
    "random",
    "3",
    "-1",
    "0.5",
    "nan",
    "1e999",
    "0x7fffffffffffffff",
    "true",
    "1979-05-27",
    "ä🦀",
    "\u{0}",
    "\r\n",
    "[stages.x]\nuse = \"expert\"\n",
];

fn check(text: &str, overrides: &[String]) {
    let path = std::path::Path::new("nowhere/garbage.toml");
    if let Err(problems) = cosfly_recipe::read(path, text, overrides, &crate::toys::registry()) {
        assert!(!problems.is_empty());
        let shown = render_all(problems.iter().map(|problem| &**problem), false);
        assert!(shown.starts_with("error["), "{shown}");
    }
}

fn pieces(most: usize) -> impl Strategy<Value = String> {
    prop::collection::vec(prop::sample::select(&PIECES[..]), 0..most).prop_map(|pieces| pieces.concat())
}

/// [`WHOLE`] with a few short ranges replaced by fragments.
fn mutilated() -> impl Strategy<Value = String> {
    let change = (any::<prop::sample::Index>(), 0..12_usize, prop::sample::select(&PIECES[..]));
    prop::collection::vec(change, 1..6).prop_map(|changes| {
        changes.into_iter().fold(WHOLE.to_owned(), |mut text, (from, letters, piece)| {
            let boundaries: Vec<usize> = text.char_indices().map(|(index, _)| index).chain([text.len()]).collect();
            let from = from.index(boundaries.len());
            text.replace_range(boundaries[from]..boundaries[(from + letters).min(boundaries.len() - 1)], piece);
            text
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutilated_recipes_are_refused_without_panic(text in mutilated()) {
        check(&text, &[]);
    }

    #[test]
    fn random_pieces_are_refused_without_panic(text in pieces(60)) {
        check(&text, &[]);
    }

    #[test]
    fn random_overrides_are_refused_without_panic(letters in 0..15_usize, more in pieces(8)) {
        let argument: String = "stages.people.".chars().take(letters).chain(more.chars()).collect();
        check(WHOLE, &[argument]);
    }
}

#[test]
fn hostile_sizes_are_refused_without_panic() {
    let deep_keys = format!("name = 1\n{}x = 1\n", "a.".repeat(100_000));
    let deep_header = format!("[{}x]\n", "a.".repeat(100_000));
    let deep_quoted = format!("{}x = 1\n", "\"a\".".repeat(100_000));
    let deep_inline = format!("x = {}1{}\n", "{a = ".repeat(100_000), "}".repeat(100_000));
    let deep_inline_keys = format!("x = {{ {}x = 1 }}\n", "a.".repeat(100_000));
    let deep_list = format!("x = {}", "[".repeat(100_000));
    let long_key = format!("{} = 1\n", "k".repeat(100_000));
    let huge = "x".repeat(5 << 20);
    for text in [&deep_keys, &deep_header, &deep_quoted, &deep_inline, &deep_inline_keys, &deep_list, &long_key, &huge]
    {
        check(text, &[]);
        check(WHOLE, &[text.to_string(), format!("stages.people.count={text}"), format!("{text}=1")]);
    }
    let many_tables: String = (0..3_000).map(|number| format!("[stages.s{number}]\nuse = \"expert\"\n")).collect();
    check(&format!("name = \"t\"\n{many_tables}"), &[]);
}
