//! The script of a text against its language.

use super::slot::{Slot, SlotMismatch};
use cosfly_claims::Language;

/// The disagreement of a text that is not in the script of its language.
pub(crate) fn script_mismatch(text: &str, language: Language) -> Option<SlotMismatch> {
    // A letter in a Chinese word, and symbols of units.
    let text = &match language {
        Language::Zh => cosfly_claims::chinese::plain(&text.replace("T恤", "恤").replace(['U', 'V'], "")),
        Language::En => text.to_owned(),
    };
    let han = text.chars().filter(|c| ('\u{4e00}'..='\u{9fff}').contains(c)).count();
    let latin = text.chars().filter(char::is_ascii_alphabetic).count();
    let foreign = text.chars().filter(|c| c.is_alphabetic() && !c.is_ascii()).count();
    let (holds, expected) = match language {
        Language::Zh => (han > 0 && latin == 0 && foreign == han, "Chinese characters alone"),
        Language::En => (latin > 0 && foreign == 0, "Latin letters alone"),
    };
    let found = || format!("{han} Chinese and {latin} Latin letters");
    (!holds).then(|| SlotMismatch { slot: Slot::Language, found: found(), expected: expected.to_owned() })
}
