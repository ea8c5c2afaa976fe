//! [`Doubts`]: attributes that are not believed, with the first object and the first value.

use serde_json::Value;
use std::collections::BTreeMap;

/// Characters of a value and of a name that a warning shows.
const SHOWN: usize = 60;

/// An attribute that is not believed: the things that have it, its name, and what is wrong and done about it.
pub(super) type Question = [&'static str; 3];

/// Counts of attributes that are not believed.
#[derive(Debug, Default)]
pub(super) struct Doubts(BTreeMap<Question, Doubt>);

#[derive(Debug)]
struct Doubt {
    count: usize,
    value: String,
    object: String,
}

impl Doubts {
    /// Counts the object `id` for a value of an attribute; none is nothing to count.
    pub(super) fn note(&mut self, question: Question, value: Option<&Value>, id: &str) {
        let Some(value) = value else { return };
        let shown = |text: &str| text.chars().take(SHOWN).collect();
        let doubt = self.0.entry(question).or_insert_with(|| {
            let value = value.as_str().map_or_else(|| shown(&value.to_string()), shown);
            Doubt { count: 0, value, object: shown(id) }
        });
        doubt.count += 1;
    }

    /// A line for each attribute.
    pub(super) fn warnings(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|([of, name, rule], Doubt { count, value, object })| {
            format!("{count} {of} have a `{name}` that is {rule}; the first one is `{value}` of `{object}`")
        })
    }
}
