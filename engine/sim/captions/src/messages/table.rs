//! [`Messages`]: the texts of one language by name.

use std::collections::BTreeMap;

/// Texts of one language: each message has one or several wordings with `{slots}`.
///
/// `name = text` is a message with one wording; `name =` and indented lines have several. `name[selector]` is the message for one
/// case, `name` the one for all other cases. Quotes keep spaces at the ends of a text. `#` begins a comment.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    wordings: BTreeMap<String, Vec<String>>,
}

impl Messages {
    /// The messages of a file.
    pub fn parse(file: &str) -> Self {
        let mut wordings: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let mut name = String::new();
        for line in file.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#')) {
            let wording = match line.strip_prefix("    ") {
                Some(wording) => wording,
                None => {
                    let (key, rest) = line.split_once('=').unwrap_or((line, ""));
                    name = key.trim().to_owned();
                    wordings.entry(name.clone()).or_default();
                    rest
                }
            };
            let wording = wording.trim();
            if let (false, Some(all)) = (wording.is_empty(), wordings.get_mut(&name)) {
                let quoted = wording.strip_prefix('"').and_then(|it| it.strip_suffix('"'));
                all.push(quoted.unwrap_or(wording).to_owned());
            }
        }
        Self { wordings }
    }

    /// Wordings of a message; of `name[selector]` those of `name` where the language makes no difference.
    pub fn all(&self, id: &str) -> &[String] {
        let stem = id.split('[').next().unwrap_or(id);
        self.wordings.get(id).or_else(|| self.wordings.get(stem)).map_or(&[], Vec::as_slice)
    }

    /// Texts of somebody who runs: words of walking become those of running.
    pub fn of_runner(&self) -> Self {
        let pairs: Vec<(&str, &str)> = self.all("running-words").iter().filter_map(|it| it.split_once(" > ")).collect();
        let run = |text: &String| with_words(text, &pairs);
        let wordings = self.wordings.iter().map(|(id, all)| (id.clone(), all.iter().map(run).collect()));
        Self { wordings: wordings.collect() }
    }

    /// The first wording of a message.
    pub fn text(&self, id: &str) -> &str {
        self.all(id).first().map_or("", String::as_str)
    }

    /// Names of all messages, with their wordings.
    #[cfg(test)]
    pub fn iter(&self) -> impl Iterator<Item = (&str, &[String])> {
        self.wordings.iter().map(|(id, all)| (id.as_str(), all.as_slice()))
    }
}

/// A text with other words for some of its own, where they are no part of a longer word. At each place the first pair that fits counts; what it puts there
/// is not changed again.
fn with_words(text: &str, pairs: &[(&str, &str)]) -> String {
    let is_letter = |it: Option<char>| it.is_some_and(|it| it.is_ascii_alphabetic());
    let (mut out, mut rest) = (String::with_capacity(text.len()), text);
    while let Some(next) = rest.chars().next() {
        let before = text[..text.len() - rest.len()].chars().next_back();
        let fits = |from: &str| {
            rest.strip_prefix(from).filter(|behind| !is_letter(before) && !is_letter(behind.chars().next()))
        };
        let found = pairs.iter().find_map(|&(from, to)| fits(from).map(|behind| (to, behind)));
        rest = match found {
            Some((to, behind)) => {
                out += to;
                behind
            }
            None => {
                out.push(next);
                &rest[next.len_utf8()..]
            }
        };
    }
    out
}
