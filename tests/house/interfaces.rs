//! Public interfaces of the crates that others use without the program, held as texts.

use super::modules::Crate;
use super::tokens::{Token, end_of_group};
use crate::support::repository_root;
use std::collections::BTreeSet;

/// The crates, each with its shelf.
const FRONTS: [&str; 3] = ["sim/geometry", "sim/planner", "data/read"];

#[test]
fn public_interfaces_are_those_of_the_snapshots() {
    for front in FRONTS {
        let name = front.split_once('/').expect("a shelf and a room").1;
        let text = Interface::of(&repository_root().join("engine").join(front).join("src/lib.rs")).lines.into_iter();
        insta::assert_snapshot!(format!("interface_of_{name}"), text.collect::<Vec<_>>().join("\n"));
    }
}

/// The public items of a crate, a line each, sorted.
#[derive(Default)]
struct Interface {
    public: BTreeSet<String>,
    lines: BTreeSet<String>,
}

impl Interface {
    fn of(root: &std::path::Path) -> Self {
        let read = Crate::read(root);
        let mut own = Self::default();
        let open = read.public_modules();
        for module in &open {
            own.public.extend(names_of_uses(&read.modules[*module].tokens));
        }
        // Items of open modules are public by their place, others by their name.
        for (number, module) in read.modules.iter().enumerate() {
            own.add_items(&module.tokens, open.contains(&number));
        }
        for module in &read.modules {
            own.add_methods(&module.tokens);
        }
        own
    }

    fn add_items(&mut self, tokens: &[Token], is_open: bool) {
        for start in tops(tokens).filter(|at| tokens[*at].text == "pub" && tokens[*at + 1].text != "(") {
            let Some(at) = (start + 1..start + 4).find(|at| KINDS.contains(&text(tokens, *at))) else { continue };
            let name = text(tokens, at + 1).to_owned();
            if !(is_open || self.public.contains(&name)) {
                continue;
            }
            self.public.insert(name.clone());
            let end = end_of_head(tokens, at);
            self.lines.insert(joined(&tokens[start..end]));
            if text(tokens, end) == "{" {
                let inner = &tokens[end + 1..end_of_group(tokens, end) - 1];
                match text(tokens, at) {
                    "struct" => self.add_members(&name, ".", inner, |part| text(part, 0) == "pub"),
                    "enum" => self.add_members(&name, "::", inner, |_| true),
                    "trait" => self.add_functions(&name, inner, false),
                    _ => {}
                }
            }
        }
    }

    fn add_members(&mut self, name: &str, sign: &str, inner: &[Token], is_shown: fn(&[Token]) -> bool) {
        for part in parts(inner).into_iter().filter(|part| is_shown(part)) {
            let part = if text(part, 0) == "pub" { &part[1..] } else { part };
            self.lines.insert(format!("{name}{sign}{}", joined(part)));
        }
    }

    fn add_methods(&mut self, tokens: &[Token]) {
        for start in tops(tokens).filter(|at| tokens[*at].text == "impl") {
            let Some(open) = (start..tokens.len()).find(|at| tokens[*at].text == "{") else { continue };
            let head = &tokens[start..open];
            let of_trait = head.iter().any(|token| token.text == "for");
            let name = head.iter().skip(1).find(|token| self.public.contains(&token.text));
            if let (Some(name), false) = (name.map(|token| token.text.clone()), of_trait) {
                self.add_functions(&name, &tokens[open + 1..end_of_group(tokens, open) - 1], true);
            }
        }
    }

    /// Functions and constants of a trait or of a type; of a type the public ones.
    fn add_functions(&mut self, name: &str, inner: &[Token], is_type: bool) {
        for at in tops(inner).filter(|at| ["fn", "const"].contains(&text(inner, *at))) {
            let is_public = at > 0 && (0..3).any(|back| at > back && text(inner, at - 1 - back) == "pub");
            if text(inner, at + 1) != "fn" && (!is_type || is_public) {
                let end = end_of_head(inner, at);
                self.lines.insert(format!("{name}::{}", joined(&inner[at..end])));
            }
        }
    }
}

const KINDS: [&str; 7] = ["fn", "struct", "enum", "trait", "const", "type", "static"];

pub fn text(tokens: &[Token], at: usize) -> &str {
    tokens.get(at).map_or("", |token| token.text.as_str())
}

/// Places of the tokens outside of all brackets.
pub fn tops(tokens: &[Token]) -> impl Iterator<Item = usize> {
    let mut depth = 0_usize;
    let places = tokens.iter().enumerate().filter_map(move |(at, token)| {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ if depth == 0 => return Some(at),
            _ => {}
        }
        None
    });
    places.collect::<Vec<_>>().into_iter()
}

/// The end of an item's head: its body, its value or its `;`.
fn end_of_head(tokens: &[Token], start: usize) -> usize {
    let mut at = start;
    while at < tokens.len() && !["{", ";", "="].contains(&text(tokens, at)) {
        at = if ["(", "["].contains(&text(tokens, at)) { end_of_group(tokens, at) } else { at + 1 };
    }
    at
}

/// The parts between commas, without attributes; commas between angle brackets do not count.
fn parts(tokens: &[Token]) -> Vec<&[Token]> {
    let (mut found, mut start, mut at, mut angles) = (vec![], 0, 0, 0_usize);
    while at < tokens.len() {
        match text(tokens, at) {
            "#" => {
                at = end_of_group(tokens, at + 1);
                start = at;
                continue;
            }
            "(" | "[" | "{" => {
                at = end_of_group(tokens, at);
                continue;
            }
            "<" => angles += 1,
            ">" => angles = angles.saturating_sub(1),
            "," if angles == 0 => {
                found.push(&tokens[start..at]);
                start = at + 1;
            }
            _ => {}
        }
        at += 1;
    }
    found.push(&tokens[start..]);
    found.retain(|part| !part.is_empty());
    found
}

/// Names that the `pub use` of a file give to others.
pub fn names_of_uses(tokens: &[Token]) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for start in tops(tokens).filter(|at| text(tokens, *at) == "pub" && text(tokens, *at + 1) == "use") {
        let end = (start..tokens.len()).find(|at| text(tokens, *at) == ";").unwrap_or(tokens.len());
        let is_last = |at: &usize| tokens[*at].is_word() && [",", "}", ";"].contains(&text(tokens, *at + 1));
        names.extend((start..end).filter(is_last).map(|at| tokens[at].text.clone()));
    }
    names
}

/// Tokens as a line of source.
fn joined(tokens: &[Token]) -> String {
    let mut line = String::new();
    for (at, token) in tokens.iter().enumerate() {
        let before = if at == 0 { "" } else { text(tokens, at - 1) };
        let is_tight = ["(", "[", "&", "<", "::", ".", "'", "!"].contains(&before)
            || [")", "]", ",", ";", ":", "::", ".", ">", "?", "(", "<"].contains(&token.text.as_str())
            || line.is_empty();
        let is_tight = is_tight && !(token.text == "(" && [",", ":", "->"].contains(&before));
        if !is_tight {
            line.push(' ');
        }
        line.push_str(&token.text);
    }
    line.replace(",)", ")").replace("->(", "-> (")
}
