//! Texts of the templates pass, and each with a number, direction, side or count changed fails.

use super::*;
use crate::caption::tests::flights;
use crate::facts::{Facts, TargetStop, Wear, facts, test_flights::flight};
use crate::turns::Turn;
use crate::{CaptionConfig, Compass, Language, Style, TurnKind, captions};
use cosfly_claims::Script;
use cosfly_domain::Colour;
use cosfly_random::{RandomStream, Seed};

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
    let sides = match language.script() {
        Script::Latin => vec![
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
        Script::Han => vec![
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
            let (from, to) = match language.script() {
                Script::Latin => (direction.english(), other.english()),
                Script::Han => (direction.chinese(), other.chinese()),
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

/// Facts of a made-up flight: any clothes, turns, stops and numbers.
fn made_up(random: &mut RandomStream) -> Facts {
    let kind = |random: &mut RandomStream| [TurnKind::Left, TurnKind::Right, TurnKind::Around][random.index(3)];
    let turns = |random: &mut RandomStream| (0..random.index(7) as u32).map(|it| (20 * it, kind(random))).collect();
    let turns: Vec<(u32, TurnKind)> = turns(random);
    let colour = |random: &mut RandomStream| Colour::ALL[random.index(Colour::ALL.len())];
    let wear = Wear { top: colour(random), trousers: colour(random), backpack: random.chance(0.5) };
    let walking_s = random.uniform(20.0, 200.0);
    let speed = random.uniform(0.6, 1.9);
    let stops: Vec<TargetStop> = (0..random.index(5) as u32)
        .map(|it| TargetStop { frame: 9 + 9 * it, duration_s: random.uniform(1.0, 7.0) })
        .collect();
    Facts {
        turns: turns.into_iter().map(|(frame, kind)| Turn { frame, angle_deg: 90.0, kind }).collect(),
        bends: true,
        dt_s: 0.5,
        duration_s: walking_s + stops.iter().map(|it| it.duration_s).sum::<f64>(),
        stops,
        way_m: speed * walking_s,
        walking_speed_mps: speed,
        distance_m: random.uniform(5.0, 60.0),
        pitch_down_deg: random.uniform(-20.0, 80.0),
        altitude_m: random.uniform(1.0, 50.0),
        wear: Some(wear),
        ..flights()[0].clone()
    }
}

/// The facts with one of them changed, and whether only descriptions state it.
fn changed(facts: &Facts) -> Vec<(Facts, bool)> {
    let other = |colour: Colour| Colour::ALL[(colour as usize + 5) % Colour::ALL.len()];
    let wear = facts.wear.expect("they wear something");
    let more_turns = [facts.turns.clone(), vec![Turn { frame: 900, angle_deg: 90.0, kind: TurnKind::Left }]].concat();
    let more_stops = [facts.stops.clone(), vec![TargetStop { frame: 300, duration_s: 1.0 }]].concat();
    let mut all = vec![
        (Facts { distance_m: facts.distance_m + 3.0, ..facts.clone() }, false),
        (Facts { pitch_down_deg: facts.pitch_down_deg - 3.0, ..facts.clone() }, false),
        (Facts { wear: Some(Wear { top: other(wear.top), ..wear }), ..facts.clone() }, false),
        (Facts { wear: Some(Wear { trousers: other(wear.trousers), ..wear }), ..facts.clone() }, false),
        (Facts { altitude_m: facts.altitude_m + 3.0, ..facts.clone() }, true),
        (Facts { way_m: facts.way_m + 20.0, ..facts.clone() }, true),
        (Facts { duration_s: facts.duration_s - 15.0, ..facts.clone() }, true),
        (Facts { turns: more_turns, ..facts.clone() }, true),
        (Facts { stops: more_stops, ..facts.clone() }, true),
    ];
    if wear.backpack {
        all.push((Facts { wear: Some(Wear { backpack: false, ..wear }), ..facts.clone() }, false));
    }
    let mirrored = |turn: &Turn| Turn {
        kind: if turn.kind == TurnKind::Left { TurnKind::Around } else { TurnKind::Left },
        ..*turn
    };
    if let Some(first) = facts.turns.first() {
        let turns = [vec![mirrored(first)], facts.turns[1..].to_vec()].concat();
        all.push((Facts { turns, ..facts.clone() }, true));
    }
    all
}

#[test]
fn texts_of_many_made_up_flights_are_true_of_them_and_of_no_others() {
    let config = CaptionConfig { variants_per_style: 6, ..CaptionConfig::default() };
    let random = &mut Seed::of_item(3, "captions", "made up").stream("facts");
    for item in 0..100 {
        let facts = made_up(random);
        let others = changed(&facts);
        for caption in captions(&facts, &config, Seed::of_item(3, "captions", &format!("{item}"))) {
            assert_eq!(check(&caption.text, caption.language, &facts), Ok(()), "{}", caption.text);
            let stated = others.iter().filter(|(_, described)| !described || caption.style == Style::Description);
            for (other, _) in stated {
                assert!(check(&caption.text, caption.language, other).is_err(), "{}\n{other:?}", caption.text);
            }
        }
    }
}
