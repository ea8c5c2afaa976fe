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

    /// These texts of somebody who runs: words of walking become those of running.
    pub fn of_runner(&self) -> Self {
        let pairs: Vec<(&str, &str)> = self.all("running-words").iter().filter_map(|it| it.split_once(" > ")).collect();
        let run = |text: &String| pairs.iter().fold(text.clone(), |text, (from, to)| with_word(&text, from, to));
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

/// A text with one word for another, where it is no part of a longer word.
fn with_word(text: &str, from: &str, to: &str) -> String {
    let is_letter = |it: Option<char>| it.is_some_and(|it| it.is_ascii_alphabetic());
    let (mut out, mut done) = (String::with_capacity(text.len()), 0);
    for (at, _) in text.match_indices(from) {
        let [before, behind] = [text[..at].chars().next_back(), text[at + from.len()..].chars().next()];
        if !is_letter(before) && !is_letter(behind) {
            out += &text[done..at];
            out += to;
            done = at + from.len();
        }
    }
    out + &text[done..]
}
