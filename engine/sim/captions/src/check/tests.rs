//! Texts of the templates pass, and each with a number, direction, side or count changed fails.

use super::*;
use crate::Language;
use crate::caption::tests::flights;
use crate::facts::{Facts, facts, test_flights::flight};
use crate::{CaptionConfig, Compass, captions};
use cosfly_random::Seed;

/// Places of the numbers in a text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let inside = |i: usize, b: u8| {
        b.is_ascii_digit() || (b == b'.' && text.as_bytes().get(i + 1).is_some_and(u8::is_ascii_digit))
    };
    let mut found: Vec<std::ops::Range<usize>> = vec![];
    for (i, b) in text.bytes().enumerate().filter(|(i, b)| inside(*i, *b)) {
        debug_assert!(b.is_ascii());
        match found.last_mut() {
            Some(last) if last.end == i => last.end += 1,
            _ => found.push(i..i + 1),
        }
    }
    found
}

/// The text with each occurrence of `word` replaced, one at a time. Longer words that contain it stay.
fn replaced(text: &str, word: &str, other: &str, part_of_word: impl Fn(char) -> bool) -> Vec<String> {
    text.match_indices(word)
        .filter(|(at, _)| {
            !text[..*at].chars().next_back().is_some_and(&part_of_word)
                && !text[at + word.len()..].chars().next().is_some_and(&part_of_word)
        })
        .map(|(at, _)| format!("{}{other}{}", &text[..at], &text[at + word.len()..]))
        .collect()
}

fn mutations(text: &str, language: Language) -> Vec<String> {
    let mut mutated = vec![];
    for place in numbers(text) {
        let digits = &text[place.clone()];
        let value: f64 = digits.parse().unwrap();
        let fraction = usize::from(digits.contains('.'));
        for change in [1.0, 10.0, -10.0, if fraction == 1 { 0.1 } else { 2.0 }] {
            let other = (value + change).abs();
            mutated.push(format!("{}{other:.fraction$}{}", &text[..place.start], &text[place.end..]));
        }
    }
    let sides = match language {
        Language::En => vec![
            ("left", "right"),
            ("right", "left"),
            ("turns around", "turns left"),
            ("then around", "then left"),
            ("no stops", "2 stops"),
            ("red", "blue"),
            ("black", "white"),
            ("without a", "with 1"),
            ("turns", "turns left, then"),
            ("soon turns", "only later turns"),
            ("before long turns", "only later turns"),
            ("only later turns", "soon turns"),
            ("good while turns", "while, soon turns"),
            ("walks straight on", "turns left"),
            ("follows a straight line", "turns around"),
        ],
        Language::Zh => vec![
            ("左转", "右转"),
            ("右转", "左转"),
            ("掉头", "左转"),
            ("没有停留", "停留2次"),
            ("红色", "蓝色"),
            ("黑色", "白色"),
            ("连续两次", "连续三次"),
            ("连续三次", "连续两次"),
            ("后不久", "后走了好一阵才"),
            ("好一阵才", "几步，没走多远就"),
            ("笔直前行", "掉头"),
        ],
    };
    let letter = |c: char| c.is_ascii_alphabetic() || "东南西北".contains(c);
    for direction in Compass::ALL {
        let place = Compass::ALL.iter().position(|one| *one == direction).unwrap();
        for turn in [1, 2, 4] {
            let other = Compass::ALL[(place + turn) % 8];
            let (from, to) = match language {
                Language::En => (direction.english(), other.english()),
                Language::Zh => (direction.chinese(), other.chinese()),
            };
            mutated.extend(replaced(text, from, to, letter));
        }
    }
    mutated.extend(sides.iter().flat_map(|(from, to)| replaced(text, from, to, letter)));
    mutated
}

#[test]
fn every_mutated_number_direction_side_and_count_fails() {
    let config = CaptionConfig { variants_per_style: 6, ..CaptionConfig::default() };
    let mut tried = 0;
    for (walk, facts) in flights().iter().enumerate() {
        for item in 0..4 {
            for caption in captions(facts, &config, Seed::of_item(2, "captions", &format!("{walk}-{item}"))) {
                for text in mutations(&caption.text, caption.language) {
                    assert!(check(&text, caption.language, facts).is_err(), "{}\n{text}\n{facts:?}", caption.text);
                    tried += 1;
                }
            }
        }
    }
    assert!(tried > 10_000, "{tried}");
}

#[test]
fn a_text_in_the_wrong_script_or_without_its_slots_fails() {
    let facts = &flights()[0];
    let slots = |text: &str, language| -> Vec<Slot> {
        check(text, language, facts).unwrap_err().iter().map(|mismatch| mismatch.slot).collect()
    };
    let english = "Follow the pedestrian walking east; keep about 28 m away and look down about 45 degrees.";
    assert_eq!(check(english, Language::En, facts), Ok(()));
    assert!(slots(english, Language::Zh).contains(&Slot::Language));
    let chinese = "跟随向东行走的行人，保持约28米距离，俯仰角约45度。";
    assert_eq!(check(chinese, Language::Zh, facts), Ok(()));
    assert!(slots(chinese, Language::En).contains(&Slot::Language));
    assert_eq!(slots("跟随向东行走的行人，保持约28 metres距离，俯仰角约45度。", Language::Zh)[0], Slot::Language);
    // Symbols of units are in any script.
    assert_eq!(check("跟随向东行走的行人，保持约28m距离，俯仰角约45°。", Language::Zh, facts), Ok(()));
    assert_eq!(slots("Follow the pedestrian.", Language::En), [Slot::Distance, Slot::Pitch]);
    assert_eq!(slots("", Language::En), [Slot::Language, Slot::Distance, Slot::Pitch]);
}

#[test]
fn a_mismatch_says_both_sides() {
    let facts = &flights()[0];
    let text = "Follow the pedestrian walking north; keep about 28 m away and look down about 45 degrees.";
    let mismatches = check(text, Language::En, facts).unwrap_err();
    assert_eq!(mismatches[0].to_string(), "direction: the text says `north`, the trajectory `east`");
}

#[test]
fn a_doubtful_turn_may_be_told_or_left_out_and_a_straight_way_must_be_one() {
    let known = facts(&flight(&[(Some(0.0), 40), (Some(135.0), 40)]));
    assert!(known.turns.is_empty() && !known.doubtful_turns.is_empty() && known.bends);
    let rest = "keep about 28 m away and look down about 45 degrees.";
    let holds = |way: &str| {
        let facts = Facts { distance_m: 28.3, pitch_down_deg: 45.0, ..known.clone() };
        check(&format!("The person {way}; {rest}"), Language::En, &facts).is_ok()
    };
    assert!(holds("turns right") && holds("turns around") && holds("makes no sharp turn") && holds("walks along"));
    assert!(!holds("turns left") && !holds("turns right, then left") && !holds("walks straight on"));
    let slow: Vec<(Option<f64>, usize)> = (0..60).map(|i| (Some(3.0 * f64::from(i)), 2)).collect();
    let known = facts(&flight(&slow));
    let holds = |way: &str| {
        let facts = Facts { distance_m: 28.3, pitch_down_deg: 45.0, ..known.clone() };
        check(&format!("The person {way}; {rest}"), Language::En, &facts).is_ok()
    };
    assert!(holds("makes no sharp turn"));
    assert!(!holds("turns around") && !holds("turns right") && !holds("heads straight on throughout"));
}
