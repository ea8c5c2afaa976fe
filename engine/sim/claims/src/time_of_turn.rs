//! When a text says that the first turn comes: soon after the start, or only after a good while.

use crate::{Claim, Language};

/// Phrases that say so of a turn, whatever else is in the text.
const ENGLISH_SOON: [&str; 9] = [
    "soon turn",
    "before long turn",
    "soon after setting",
    "soon after starting",
    "soon after the start",
    "shortly after setting",
    "shortly after starting",
    "shortly after the start",
    "right after setting",
];
const ENGLISH_LATE: [&str; 6] = [
    "only later turn",
    "good while, then turn",
    "after a good while turn",
    "long while, then turn",
    "late in the walk",
    "much later turn",
];
const CHINESE_SOON: [&str; 7] = ["身后不久", "发后不久", "步后不久", "出发不久", "起步不久", "动身不久", "没走多远"];
const CHINESE_LATE: [&str; 4] = ["好一阵才", "好一阵，再", "走了很久才", "快到终点"];

/// The claim of a text about the time of the first turn.
pub fn time_of_first_turn(text: &str, language: Language) -> Option<Claim> {
    let text = text.to_lowercase();
    let has = |phrases: &[&str]| phrases.iter().any(|phrase| text.contains(phrase));
    let (soon, late): (&[&str], &[&str]) = match language {
        Language::En => (&ENGLISH_SOON, &ENGLISH_LATE),
        Language::Zh => (&CHINESE_SOON, &CHINESE_LATE),
    };
    match () {
        () if has(soon) => Some(Claim::TurnsSoon),
        () if has(late) => Some(Claim::TurnsLate),
        () => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_turns_are_read_and_other_times_are_not() {
        for (text, language, expected) in [
            ("The walker sets off, soon turns left, and goes on.", Language::En, Some(Claim::TurnsSoon)),
            ("Soon after setting off they turn left.", Language::En, Some(Claim::TurnsSoon)),
            ("The walker sets off, only later turns left.", Language::En, Some(Claim::TurnsLate)),
            ("They turn left and later right, as soon as they can.", Language::En, None),
            ("动身后不久左转。", Language::Zh, Some(Claim::TurnsSoon)),
            ("走了好一阵才右转。", Language::Zh, Some(Claim::TurnsLate)),
            ("先左转，后来右转。", Language::Zh, None),
        ] {
            assert_eq!(time_of_first_turn(text, language), expected, "{text}");
        }
    }
}
