//! The `README.md` of an export, and the licence that goes with it.

use crate::folder::OutFolder;
use crate::source::Source;
use cosfly_diagnose::Result;
use std::fmt::Write;

/// What the card of an export says.
#[derive(Clone, Debug, Default)]
pub struct Card {
    /// Name of the format.
    pub format: &'static str,
    /// More lines of the front matter, such as `configs`.
    pub front_matter: String,
    /// How to load it, what is where, what every number means. Markdown.
    pub body: String,
}

impl Card {
    /// Writes `README.md`, and `LICENSE` as the dataset has it.
    pub fn write(&self, source: &Source<'_>, out: &OutFolder) -> Result<()> {
        let folder = source.dataset.folder();
        let original = std::fs::read_to_string(folder.join("README.md")).unwrap_or_default();
        let name = source.name();
        let mut text = String::from("---\n");
        for line in kept_lines(&original) {
            let _ = writeln!(text, "{line}");
        }
        let _ = write!(text, "{}---\n\n# {name} in the format {}\n\n", self.front_matter, self.format);
        let flights: Vec<_> = source.flights().collect();
        let frames: usize = flights.iter().map(|flight| flight.frames).sum();
        let _ = writeln!(
            text,
            "Written by `cosfly export` {} from {} flights with {frames} frames of the dataset `{name}`.\n",
            env!("CARGO_PKG_VERSION"),
            flights.len()
        );
        text.push_str(&self.body);
        out.put("README.md", text.as_bytes())?;
        match std::fs::read(folder.join("LICENSE")) {
            Ok(license) => out.put("LICENSE", &license),
            Err(_) => Ok(()),
        }
    }
}

/// Licence and language of a card's front matter.
fn kept_lines(card: &str) -> impl Iterator<Item = &str> {
    let front = card.strip_prefix("---\n").and_then(|rest| rest.split_once("\n---")).map_or("", |(front, _)| front);
    let mut is_kept = false;
    front.lines().filter(move |line| {
        if !line.starts_with(['-', ' ']) {
            is_kept = ["license", "language:", "pretty_name:"].iter().any(|key| line.starts_with(key));
        }
        is_kept
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn licence_and_language_stay_and_configs_go() {
        let card = "---\nlicense: other\nlicense_link: LICENSE\nlanguage:\n- en\n- zh\nconfigs:\n- config_name: a\n---\n# x\n- y";
        assert_eq!(
            kept_lines(card).collect::<Vec<_>>(),
            ["license: other", "license_link: LICENSE", "language:", "- en", "- zh"]
        );
        assert_eq!(kept_lines("# no front matter").count(), 0);
    }
}
