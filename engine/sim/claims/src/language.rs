//! Languages of captions.

use serde::{Deserialize, Serialize};

/// Language of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Language {
    /// Chinese, simplified characters.
    Zh,
    /// English.
    En,
}

/// Script of a language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Script {
    /// Chinese characters; each is a word.
    Han,
    /// Latin letters; blanks part words.
    Latin,
}

/// Properties of a language that all rooms need.
struct LanguageRow {
    code: &'static str,
    name: &'static str,
    script: Script,
    words: &'static str,
}

impl Language {
    /// All languages.
    pub const ALL: &[Self] = &[
        // In the order of the variants.
        Self::Zh,
        Self::En,
    ];

    fn row(self) -> LanguageRow {
        let row = |code, name, script, words| LanguageRow { code, name, script, words };
        match self {
            Self::Zh => row("zh", "Chinese", Script::Han, include_str!("../words/chinese.txt")),
            Self::En => row("en", "English", Script::Latin, include_str!("../words/english.txt")),
        }
    }

    /// The ISO 639-1 code.
    pub fn code(self) -> &'static str {
        self.row().code
    }

    /// The language of an ISO 639-1 code.
    pub fn of_code(code: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|language| language.code() == code)
    }

    /// The name in English.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The script.
    pub fn script(self) -> Script {
        self.row().script
    }

    /// The file of words from which claims are read.
    pub(crate) fn words(self) -> &'static str {
        self.row().words
    }
}
