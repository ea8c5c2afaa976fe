//! Questions to a language model that writes captions, and what is demanded of its texts.
//!
//! A question holds the typed facts and nothing else of a flight: no name of a town or a file reaches a model.

use crate::check::{Slot, SlotMismatch, check};
use crate::config::Style;
use crate::facts::Facts;
use cosfly_claims::{Language, Script, foreign_things};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Characters of the longest accepted text.
const MOST_CHARS: usize = 900;
/// Characters and words of markup, code and addresses, which no spoken text has.
const MARKUP: [&str; 16] = ["<", ">", "{", "}", "[", "]", "`", "|", "\\", "#", "@", "=", "_", "*", "://", "www."];
/// Two texts that share this share of their pairs of words are the same text.
const NEAR_DUPLICATE: f64 = 0.8;

/// A text that a model shall write.
#[derive(Clone, Copy, Debug)]
pub struct Lesson<'a> {
    /// Facts of the flight.
    pub facts: &'a Facts,
    /// Language of the text.
    pub language: Language,
    /// Kind of text.
    pub style: Style,
    /// Texts of the flight that exist already.
    pub others: &'a [String],
    /// The refused answer before, and why it was refused.
    pub refused: Option<(&'a str, &'a str)>,
}

/// The standing rules for a language.
pub fn rules(language: Language) -> String {
    match language.script() {
        Script::Latin => {
            let name = if language == Language::En { "British English" } else { language.name() };
            format!(
                "You write texts about the flight of a drone that follows one person. Write natural, idiomatic {name}, as \
                 a pilot would say it. State only what the facts state; copy numbers in digits, with metres as `m`, angles in degrees and \
                 times in seconds; never mention buildings, trees, vehicles, other people, weather, gender or age. Answer with one \
                 JSON object, {{\"text\": \"...\"}}, and nothing else."
            )
        }
        Script::Han => {
            "你为无人机跟踪行人的飞行撰写文字。请用地道、自然的简体中文，不要有翻译腔。只写事实里有的内容；数字照抄，一律用阿拉伯数字，\
             距离用“米”，角度用“度”，时间用“秒”；不得提到建筑、树木、车辆、其他人、天气、性别或年龄。\
             只回答一个JSON对象：{\"text\": \"...\"}，不要有别的内容。"
                .to_owned()
        }
    }
}

/// The task in words: kind of text, what it must hold, texts that exist, what was wrong before.
pub fn task(lesson: &Lesson<'_>) -> String {
    let is_instruction = lesson.style == Style::Instruction;
    let script = lesson.language.script();
    let mut text = match (script, is_instruction) {
        (Script::Latin, true) => {
            "Write one sentence that tells the pilot what to do: whom to follow (name the clothes), at which distance, at which \
             angle the camera looks down or up."
        }
        (Script::Latin, false) => {
            "Write three to five sentences: the way of the person with its turns in order and its stops, its length, time and \
             speed; then how the drone flies: distance and angle of the camera."
        }
        (Script::Han, true) => "写一句给飞手的指令：跟随谁（说明衣着）、保持多远距离、镜头俯视或仰视多少度。",
        (Script::Han, false) => {
            "写三到五句话：先写此人的路线（按顺序写转弯，写停留），路程、用时和步速；再写无人机怎么飞：距离和镜头角度。"
        }
    }
    .to_owned();
    if !lesson.others.is_empty() {
        text += match script {
            Script::Latin => "\nUse other words and another order than these texts:",
            Script::Han => "\n措辞和语序要与下列文字不同：",
        };
        for other in lesson.others {
            let _ = write!(text, "\n- {other}");
        }
    }
    if let Some((answer, why)) = lesson.refused {
        let answer: String = answer.chars().take(MOST_CHARS).collect();
        let _ = match script {
            Script::Latin => {
                write!(text, "\nYour answer was refused: {answer}\nWhat is wrong: {why}\nWrite it again, without that.")
            }
            Script::Han => write!(text, "\n你上次的回答未被接受：{answer}\n问题：{why}\n请改正后重写。"),
        };
    }
    text
}

/// Whether a text of a model is believed: what it claims is true, it speaks of nothing that the facts do not know, and it is no
/// text that exists already.
///
/// # Errors
/// All contradictions.
pub fn believe(text: &str, language: Language, facts: &Facts, others: &[String]) -> Result<(), Vec<SlotMismatch>> {
    let wrong = |slot, found: String, expected: &str| SlotMismatch { slot, found, expected: expected.to_owned() };
    let mut mismatches = check(text, language, facts).err().unwrap_or_default();
    mismatches.extend(foreign_words(text, language));
    let chars = text.chars().count();
    if chars > MOST_CHARS || text.chars().any(char::is_control) {
        mismatches.push(wrong(Slot::Language, format!("{chars} characters"), "a few sentences on one line"));
    }
    if let Some(markup) = MARKUP.into_iter().find(|it| text.contains(it)) {
        mismatches.push(wrong(Slot::Language, format!("`{markup}`"), "plain sentences without markup"));
    }
    if let Some(other) = others.iter().find(|other| likeness(text, other, language) >= NEAR_DUPLICATE) {
        mismatches.push(wrong(Slot::Wording, text.to_owned(), &format!("other words than `{other}`")));
    }
    if mismatches.is_empty() { Ok(()) } else { Err(mismatches) }
}

/// A contradiction for each word of a text that names something no facts of a flight have: landmarks, vehicles, other people, weather.
pub fn foreign_words(text: &str, language: Language) -> Vec<SlotMismatch> {
    let expected = || "nothing of the kind".to_owned();
    let mismatch = |found| SlotMismatch { slot: Slot::Things, found, expected: expected() };
    foreign_things(text, language).into_iter().map(mismatch).collect()
}

/// Share of the pairs of neighbouring words (characters in Chinese) that two texts have in common, 0..=1.
pub fn likeness(one: &str, other: &str, language: Language) -> f64 {
    let pairs = |text: &str| -> BTreeSet<(String, String)> {
        let words = crate::diversity::words(text, language);
        words.windows(2).map(|pair| (pair[0].clone(), pair[1].clone())).collect()
    };
    let (one, other) = (pairs(one), pairs(other));
    let all = one.union(&other).count();
    if all == 0 { 1.0 } else { one.intersection(&other).count() as f64 / all as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caption::tests::flights;
    use crate::facts_in_words::facts_in_words;
    use crate::{CaptionConfig, captions};
    use cosfly_random::Seed;

    #[test]
    fn the_templates_own_texts_are_believed_and_twins_are_not() {
        for facts in flights() {
            for caption in captions(&facts, &CaptionConfig::default(), Seed::of_item(1, "captions", "a")) {
                assert_eq!(believe(&caption.text, caption.language, &facts, &[]), Ok(()), "{}", caption.text);
                let twin = believe(&caption.text, caption.language, &facts, std::slice::from_ref(&caption.text));
                assert_eq!(twin.unwrap_err()[0].slot, Slot::Wording);
            }
        }
    }

    #[test]
    fn a_text_with_markup_is_not_believed() {
        let facts = &flights()[0];
        let caption = &captions(facts, &CaptionConfig::default(), Seed::of_item(1, "captions", "a"))[0];
        for addition in ["<script>alert(1)</script>", "[x](http://a.b)", "`rm`", "{\"text\": 1}"] {
            let text = format!("{} {addition}", caption.text);
            let refused = believe(&text, caption.language, facts, &[]).unwrap_err();
            assert!(refused.iter().any(|it| it.slot == Slot::Language), "{text}");
        }
    }

    #[test]
    fn a_question_names_the_contradiction_and_the_texts_that_exist() {
        let facts = &flights()[0];
        for language in Language::ALL.iter().copied() {
            let lesson = Lesson {
                facts,
                language,
                style: Style::Description,
                others: &["other text".to_owned()],
                refused: Some(("bad text", "distance: 3")),
            };
            let text = task(&lesson);
            assert!(["other text", "bad text", "distance: 3"].iter().all(|it| text.contains(it)), "{text}");
            let facts = facts_in_words(facts, language, Style::Description);
            assert!(facts.contains("28") && facts.lines().count() >= 7, "{facts}");
        }
    }
}
