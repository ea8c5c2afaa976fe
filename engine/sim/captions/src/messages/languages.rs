//! Languages with their tables of messages.

use super::table::Messages;
use crate::wording;
use cosfly_claims::Language;
use cosfly_random::RandomStream;
use std::sync::LazyLock;

/// Tables of people who walk and of those who run.
static TABLES: LazyLock<Vec<[Messages; 2]>> = LazyLock::new(|| {
    let tables = Language::ALL.iter().map(|language| Messages::parse(file(*language)));
    tables.map(|walking| [walking.of_runner(), walking]).collect()
});

/// File with the messages of a language.
fn file(language: Language) -> &'static str {
    match language {
        Language::En => include_str!("en.txt"),
        Language::Zh => include_str!("zh.txt"),
    }
}

/// Messages of a language about somebody who runs, or walks.
pub(crate) fn messages_of(language: Language, runs: bool) -> &'static Messages {
    &TABLES[language as usize][usize::from(!runs)]
}

/// A text with other words for some of its `about` before numbers.
pub(crate) fn approximately(text: &str, language: Language, words: &mut RandomStream) -> String {
    match language {
        Language::En => wording::approximately(text, words),
        Language::Zh => wording::approximately_in_chinese(text, words),
    }
}
