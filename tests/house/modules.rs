//! The modules of a crate, what each defines and uses, and the file in which a path of names ends.

use super::tokens::{Token, end_of_group, tokens_of_file};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A module that has a file of its own.
pub struct Module {
    /// The file of the module.
    pub file: PathBuf,
    /// Its tokens, without those of tests.
    pub tokens: Vec<Token>,
    parent: usize,
    children: BTreeMap<String, usize>,
    items: BTreeSet<String>,
    uses: Vec<Use>,
}

/// One name that a `use` brings in.
struct Use {
    /// The name here; `*` for all names of a module.
    name: String,
    path: Vec<String>,
}

/// Where a path ends.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// At a module.
    Module(usize),
    /// At an item of a module.
    Item(usize),
}

/// All modules of one crate; the first is its root.
pub struct Crate {
    pub modules: Vec<Module>,
}

impl Crate {
    /// Reads a crate from its root file.
    pub fn read(root: &Path) -> Self {
        let mut all = Self { modules: vec![] };
        all.add(root.to_owned(), root.parent().expect("a folder"), 0);
        all
    }

    fn add(&mut self, file: PathBuf, folder: &Path, parent: usize) -> usize {
        let tokens = tokens_of_file(&file);
        let (items, names_of_children) = items_of(&tokens);
        let (uses, own) = (uses_of(&tokens), self.modules.len());
        self.modules.push(Module { file, tokens, parent, children: BTreeMap::new(), items, uses });
        for name in names_of_children {
            let file = folder.join(format!("{name}.rs"));
            let file = if file.exists() { file } else { folder.join(&name).join("mod.rs") };
            if file.exists() {
                let child = self.add(file, &folder.join(&name), own);
                self.modules[own].children.insert(name, child);
            }
        }
        own
    }

    /// The root, and the modules that others reach through `pub mod`; not those that documentation hides.
    pub fn public_modules(&self) -> BTreeSet<usize> {
        let (mut found, mut left) = (BTreeSet::from([0]), vec![0]);
        while let Some(module) = left.pop() {
            let tokens = &self.modules[module].tokens;
            let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
            for at in (0..tokens.len()).filter(|at| text(*at) == "pub" && text(*at + 1) == "mod") {
                let is_hidden = at >= 4 && text(at - 1) == "]" && text(at - 3) == "hidden";
                if let Some(child) = self.modules[module].children.get(text(at + 2)).filter(|_| !is_hidden) {
                    found.insert(*child);
                    left.push(*child);
                }
            }
        }
        found
    }

    /// For each module, the modules in other files that its text names.
    pub fn edges(&self) -> Vec<BTreeSet<usize>> {
        (0..self.modules.len()).map(|module| self.edges_of(module)).collect()
    }

    fn edges_of(&self, from: usize) -> BTreeSet<usize> {
        let module = &self.modules[from];
        let used = module.uses.iter().filter(|used| used.name != "*").map(|used| used.path.clone());
        let paths = used.chain(paths_of(&module.tokens));
        let ends = paths.filter_map(|path| match self.resolve(from, &path, 0) {
            Some(Place::Item(end)) if end != from => Some(end),
            _ => None,
        });
        ends.collect()
    }

    /// The place where a path that is read in a module ends.
    fn resolve(&self, from: usize, path: &[String], depth: usize) -> Option<Place> {
        let (mut at, mut is_first) = (from, true);
        for name in path {
            let place = match name.as_str() {
                "crate" if is_first => Place::Module(0),
                "self" => Place::Module(at),
                "super" => Place::Module(self.modules[at].parent),
                name => self.member(at, name, depth)?,
            };
            match place {
                Place::Module(module) => at = module,
                Place::Item(_) => return Some(place),
            }
            is_first = false;
        }
        Some(Place::Module(at))
    }

    fn member(&self, module: usize, name: &str, depth: usize) -> Option<Place> {
        let of = &self.modules[module];
        if let Some(child) = of.children.get(name) {
            return Some(Place::Module(*child));
        }
        if of.items.contains(name) {
            return Some(Place::Item(module));
        }
        if depth > 8 {
            return None;
        }
        let named =
            of.uses.iter().filter(|used| used.name == name && used.path.first().is_none_or(|first| first != name));
        let named = named.filter_map(|used| self.resolve(module, &used.path, depth + 1)).next();
        named.or_else(|| {
            let all = of.uses.iter().filter(|used| used.name == "*");
            all.filter_map(|used| match self.resolve(module, &used.path, depth + 1)? {
                Place::Module(other) if other != module => self.member(other, name, depth + 1),
                _ => None,
            })
            .next()
        })
    }
}

/// Names of the items at the top of a file, and of the modules that have files of their own.
fn items_of(tokens: &[Token]) -> (BTreeSet<String>, Vec<String>) {
    let (mut items, mut children, mut at) = (BTreeSet::new(), vec![], 0);
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    while at < tokens.len() {
        match text(at) {
            "{" | "(" | "[" => {
                at = end_of_group(tokens, at);
                continue;
            }
            "mod" if text(at + 2) == ";" => children.push(text(at + 1).to_owned()),
            "macro_rules" => _ = items.insert(text(at + 2).to_owned()),
            "fn" | "struct" | "enum" | "union" | "trait" | "type" | "const" | "static" | "mod" => {
                items.insert(text(at + 1).to_owned());
            }
            _ => {}
        }
        at += 1;
    }
    (items, children)
}

/// What all `use` lines of a file bring in.
fn uses_of(tokens: &[Token]) -> Vec<Use> {
    let mut found = vec![];
    for (at, token) in tokens.iter().enumerate() {
        if token.text == "use" {
            add_uses(tokens, at + 1, &[], &mut found);
        }
    }
    found
}

/// Adds the names of a tree of a `use`, and returns the token after it.
fn add_uses(tokens: &[Token], start: usize, before: &[String], found: &mut Vec<Use>) -> usize {
    let (mut at, mut path) = (start, before.to_vec());
    while let Some(token) = tokens.get(at) {
        match token.text.as_str() {
            "::" => at += 1,
            "{" => {
                let end = end_of_group(tokens, at);
                at += 1;
                while at < end - 1 {
                    at = add_uses(tokens, at, &path, found);
                    at += usize::from(tokens[at].text == ",");
                }
                return end;
            }
            "*" => {
                found.push(Use { name: "*".to_owned(), path });
                return at + 1;
            }
            "as" => {
                found.push(Use { name: tokens[at + 1].text.clone(), path });
                return at + 2;
            }
            _ if token.is_word() => {
                path.push(token.text.clone());
                at += 1;
            }
            _ => break,
        }
    }
    let name = path.iter().rev().find(|name| *name != "self").cloned().unwrap_or_default();
    found.push(Use { name, path });
    at
}

/// All paths of a text, `a::b::c` or one name.
fn paths_of(tokens: &[Token]) -> Vec<Vec<String>> {
    let (mut found, mut at) = (vec![], 0);
    while at < tokens.len() {
        let is_part = at > 0 && [".", "::"].contains(&tokens[at - 1].text.as_str());
        if tokens[at].text == "use" {
            at = add_uses(tokens, at + 1, &[], &mut vec![]);
        } else if tokens[at].is_word() && !is_part {
            let mut path = vec![tokens[at].text.clone()];
            while tokens.get(at + 1).is_some_and(|next| next.text == "::")
                && tokens.get(at + 2).is_some_and(Token::is_word)
            {
                path.push(tokens[at + 2].text.clone());
                at += 2;
            }
            found.push(path);
            at += 1;
        } else {
            at += 1;
        }
    }
    found
}
