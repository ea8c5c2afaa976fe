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
