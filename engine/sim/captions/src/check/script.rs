//! The script of a text against its language.

use super::slot::{Slot, SlotMismatch};
use cosfly_claims::{Language, Script};

/// Latin words in Chinese texts: symbols of units, and the letter of a shirt.
const SYMBOLS: [&str; 4] = ["m", "s", "m/s", "T"];

/// The disagreement of a text that is not in the script of its language.
pub(super) fn script_mismatch(text: &str, language: Language) -> Option<SlotMismatch> {
    let words = text.split(|c: char| !c.is_ascii_alphabetic() && c != '/').filter(|word| !SYMBOLS.contains(word));
    let latin = match language.script() {
        Script::Han => words.flat_map(str::chars).filter(char::is_ascii_alphabetic).count(),
        Script::Latin => text.chars().filter(char::is_ascii_alphabetic).count(),
    };
    let han = text.chars().filter(|c| ('\u{4e00}'..='\u{9fff}').contains(c)).count();
    let foreign = text.chars().filter(|c| c.is_alphabetic() && !c.is_ascii()).count();
    let (holds, expected) = match language.script() {
        Script::Han => (han > 0 && latin == 0 && foreign == han, "Chinese characters alone"),
        Script::Latin => (latin > 0 && foreign == 0, "Latin letters alone"),
    };
    let found = || format!("{han} Chinese and {latin} Latin letters");
    (!holds).then(|| SlotMismatch { slot: Slot::Language, found: found(), expected: expected.to_owned() })
}
