//! No text and no override makes the reader panic, and what it says can be printed.

use crate::toys::WHOLE;
use cosfly_diagnose::render_all;

/// A linear congruential generator: the same garbage on every machine.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % sides.max(1)
    }
}

/// Pieces that bring the reader further than random letters do.
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

#[test]
fn mutilated_recipes_are_refused_without_panic() {
    let mut dice = Dice(1);
    for _ in 0..3_000 {
        let mut text = WHOLE.to_owned();
        for _ in 0..=dice.roll(4) {
            let boundaries: Vec<usize> = text.char_indices().map(|(index, _)| index).chain([text.len()]).collect();
            let (a, b) = (dice.roll(boundaries.len()), dice.roll(boundaries.len()));
            let (from, to) = (boundaries[a.min(b)], boundaries[a.max(b).min(a.min(b) + 12)]);
            text.replace_range(from..to, PIECES[dice.roll(PIECES.len())]);
        }
        check(&text, &[]);
    }
}

#[test]
fn random_pieces_are_refused_without_panic() {
    let mut dice = Dice(2);
    for _ in 0..3_000 {
        let text: String = (0..dice.roll(60)).map(|_| PIECES[dice.roll(PIECES.len())]).collect();
        check(&text, &[]);
    }
}

#[test]
fn random_overrides_are_refused_without_panic() {
    let mut dice = Dice(3);
    for _ in 0..3_000 {
        let mut argument: String = "stages.people.".chars().take(dice.roll(15)).collect();
        argument.extend((0..dice.roll(8)).map(|_| PIECES[dice.roll(PIECES.len())]));
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
