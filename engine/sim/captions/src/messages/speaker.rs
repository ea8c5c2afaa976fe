//! [`Speaker`]: messages of one language, drawn and filled.

use super::slots::fill;
use super::table::Messages;
use cosfly_domain::Colour;
use cosfly_random::RandomStream;

/// Chooses between the wordings of messages.
pub(crate) struct Speaker<'a> {
    pub messages: &'a Messages,
    pub words: &'a mut RandomStream,
}

impl<'a> Speaker<'a> {
    /// One wording of a message, with its slots. A message with one wording draws nothing.
    pub fn one(&mut self, id: &str) -> &'a str {
        match self.messages.all(id) {
            [] => "",
            [one] => one,
            all => &all[self.words.index(all.len())],
        }
    }

    /// One wording of a message, drawn even where there is no choice; nothing is drawn for a message without wordings.
    pub fn drawn(&mut self, id: &str) -> &'a str {
        let all = self.messages.all(id);
        if all.is_empty() { "" } else { &all[self.words.index(all.len())] }
    }

    /// One wording of a message, filled.
    pub fn say(&mut self, id: &str, values: &[(&str, &str)]) -> String {
        fill(self.one(id), values)
    }

    /// Wordings of a message without those that have a word of another message; all where that one is `None`, or leaves none.
    pub fn without(&self, id: &str, forbidden: Option<&str>) -> Vec<&'a str> {
        let forbidden = forbidden.map_or(&[][..], |id| self.messages.all(id));
        let all = self.messages.all(id).iter().map(String::as_str);
        let free: Vec<&str> =
            all.clone().filter(|it| !forbidden.iter().any(|word| it.contains(word.as_str()))).collect();
        if free.is_empty() { all.collect() } else { free }
    }
}

impl Messages {
    /// A message with one wording, filled.
    pub fn filled(&self, id: &str, values: &[(&str, &str)]) -> String {
        fill(self.text(id), values)
    }

    /// A colour, and a colour with its article.
    pub fn colours(&self, colour: Colour) -> [&str; 2] {
        ["colour", "a-colour"].map(|id| self.text(&format!("{id}[{}]", colour.name())))
    }

    /// A number in words.
    pub fn numeral(&self, count: usize) -> String {
        self.counted("numerals", count)
    }

    /// The place in an order in words.
    pub fn ordinal(&self, count: usize) -> String {
        self.counted("ordinals", count)
    }

    fn counted(&self, id: &str, count: usize) -> String {
        let more = || self.filled(&format!("{id}-more"), &[("count", &count.to_string())]);
        self.all(id).get(count).cloned().unwrap_or_else(more)
    }

    /// `2 seconds`.
    pub fn seconds(&self, count: &str) -> String {
        self.filled(&format!("seconds[{count}]"), &[("count", count)])
    }

    /// `twice`.
    pub fn times(&self, count: usize) -> String {
        self.filled(&format!("times[{count}]"), &[("count", &count.to_string()), ("n", &self.numeral(count))])
    }
}
