//! Texts, sentence by sentence: tokens become claims.

use crate::claim::Claim;
use crate::clothes;
use crate::language::Language;
use crate::lexicon::Concept;
use crate::quantities::{measure, unit};
use crate::sentence::Sentence;
use crate::token::{Token, tokens};
use crate::turns::{listed, repetition, turn, turns};

/// Everything that the text claims, in order.
pub fn read(text: &str, language: Language) -> Vec<Claim> {
    let tokens = tokens(text, language);
    let mut claims: Vec<Claim> = tokens.split(|it| *it == Token::Stop).flat_map(|it| sentence(Sentence(it))).collect();
    // A level camera has no angle but 0.
    let is_level = tokens.iter().any(|it| it.concept() == Some(Concept::Level));
    let has_angle = claims.iter().any(|it| matches!(it, Claim::Pitch(_)));
    claims.extend((is_level && !has_angle).then_some(Claim::Pitch(0.0)));
    claims
}

/// Phrases of a text that name things no facts of a flight have: landmarks, vehicles, other people, weather; in order.
pub fn foreign_things(text: &str, language: Language) -> Vec<String> {
    let thing = |token: Token| match token {
        Token::Known(Concept::Thing, phrase) => Some(phrase),
        _ => None,
    };
    tokens(text, language).into_iter().filter_map(thing).collect()
}

fn sentence(sentence: Sentence<'_>) -> Vec<Claim> {
    let mut claims = vec![];
    let mut at = 0;
    while at < sentence.0.len() {
        at = match &sentence.0[at] {
            Token::Number(value, in_digits) => number(sentence, at, *value, *in_digits, &mut claims),
            Token::Known(concept, _) => phrase(sentence, at, *concept, &mut claims),
            _ => at + 1,
        };
    }
    whole(sentence, listed(claims))
}

/// A number; gives the place behind it and what belongs to it.
fn number(sentence: Sentence<'_>, at: usize, value: f64, in_digits: bool, claims: &mut Vec<Claim>) -> usize {
    if let Some(claim) = measure(sentence, at, value) {
        claims.push(claim);
        return at + 1;
    }
    let count = (value.fract() == 0.0 && value < 1e6).then_some(value as usize);
    let found = unit(sentence, at).map(|(place, concept)| (place, concept, turn(sentence, place, claims)));
    match (found, count) {
        (Some((_, Concept::Seconds, _)), _) => at + 1,
        (Some((place, Concept::Times, _)), Some(count)) => repetition(sentence, (at, place + 1), count, claims),
        (Some((place, Concept::Stop, _)), Some(count)) => {
            claims.push(Claim::Stops(if sentence.is_denied(place) { 0 } else { count }));
            place + 1
        }
        (Some((place, Concept::Turning, _)), Some(count)) if !sentence.is_denied(place) => {
            // `two turns to the left`, `2 turns, left and right`
            claims.push(Claim::Turns(count));
            place + 1
        }
        (Some((place, _, Some(kind))), Some(count)) if !sentence.is_denied(place) => {
            claims.extend(turns(kind, count, claims));
            place + 1
        }
        _ if in_digits => {
            claims.push(labelled(sentence, at, count).unwrap_or_else(|| Claim::Unknown(value.to_string())));
            at + 1
        }
        _ => at + 1,
    }
}

/// `Stops: 2`: a number without a unit counts what stands before it.
fn labelled(sentence: Sentence<'_>, at: usize, count: Option<usize>) -> Option<Claim> {
    let before = (0..at).rev().find(|place| !matches!(sentence.0[*place], Token::Comma))?;
    match sentence.concept(before)? {
        Concept::Stop => count.map(Claim::Stops),
        Concept::Turning => count.map(Claim::Turns),
        _ => None,
    }
}

/// A phrase; gives the place behind it and what belongs to it.
fn phrase(sentence: Sentence<'_>, at: usize, concept: Concept, claims: &mut Vec<Claim>) -> usize {
    let is_denied = sentence.is_denied(at);
    match concept {
        Concept::Repeated(count) => return repetition(sentence, (at, at + 1), count, claims),
        Concept::Direction(direction) => claims.push(Claim::Direction(direction)),
        Concept::Colour(colour) => claims.extend(clothes::colour(sentence, at, colour)),
        Concept::Backpack => claims.push(Claim::Backpack(!is_denied)),
        Concept::Turning if is_denied => claims.push(Claim::NoTurns),
        Concept::Stop if is_denied => claims.push(Claim::Stops(0)),
        Concept::Stands => claims.push(Claim::Stays),
        Concept::Walks if !is_denied => claims.push(Claim::Walks),
        Concept::Runs if !is_denied => claims.push(Claim::Runs),
        Concept::Straight => claims.push(Claim::Straight),
        Concept::Turn(_) | Concept::Side(_) => match turn(sentence, at, claims) {
            Some(_) if is_denied => claims.push(Claim::NoTurns),
            Some(kind) => claims.push(Claim::Turn(kind)),
            None => {}
        },
        _ => {}
    }
    at + 1
}

/// Claims that hang on the whole sentence.
fn whole(sentence: Sentence<'_>, mut claims: Vec<Claim>) -> Vec<Claim> {
    let has_stop = sentence.has(|it| it == Concept::Stop);
    let has_turn = claims.iter().any(|it| matches!(it, Claim::Turn(_)));
    // Who stands at a stop does not stay all the time.
    claims.retain(|it| *it != Claim::Stays || !has_stop);
    let is_counted = claims.iter().any(|it| matches!(it, Claim::Stops(1..)));
    claims.retain(|it| *it != Claim::Stops(0) || !is_counted);
    let is_told = claims.iter().any(|it| matches!(it, Claim::Stops(_) | Claim::Standing(_)));
    claims.extend((has_stop && !is_told).then_some(Claim::SomeStops));
    for (concept, claim) in [(Concept::Soon, Claim::TurnsSoon), (Concept::Late, Claim::TurnsLate)] {
        claims.extend((has_turn && sentence.has(|it| it == concept)).then_some(claim));
    }
    claims
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Compass, TurnKind};
    use cosfly_domain::Colour;

    fn check(language: Language, text: &str, expected: &[Claim]) {
        assert_eq!(read(text, language), expected, "{text}");
    }

    #[test]
    fn english_sentences_are_read() {
        let check = |text, expected: &[Claim]| check(Language::En, text, expected);
        check("Follow at 25 metres, 45° down.", &[Claim::Distance(25.0), Claim::Pitch(45.0)]);
        check("Tilt the camera up by twenty-five degrees.", &[Claim::Pitch(-25.0)]);
        check("Fly 20 m above the target and 28 m away.", &[Claim::Altitude(20.0), Claim::Distance(28.0)]);
        check("It pauses twice, never turns.", &[Claim::Stops(2), Claim::NoTurns]);
        check("No stops; two turns", &[Claim::Stops(0), Claim::Turns(2)]);
        check("They stop three times for 8 seconds.", &[Claim::Stops(3), Claim::Standing(8.0)]);
        check("They stop", &[Claim::SomeStops]);
        check("They cover 130 m in 1 minute and 40 seconds.", &[Claim::Way(130.0), Claim::Duration(100.0)]);
        check("Go south-east at 1.4 m/s.", &[Claim::Direction(Compass::Southeast), Claim::Speed(1.4)]);
        check("turns right twice, then left", &[right(), right(), left()]);
        check(
            "makes 3 turns (2 left, 1 around)",
            &[Claim::Turns(3), Claim::TurnsOf(TurnKind::Left, 2), Claim::TurnsOf(TurnKind::Around, 1)],
        );
        check("soon turns left around 28 m away", &[left(), Claim::Distance(28.0), Claim::TurnsSoon]);
        check(
            "in a red shirt and blue trousers, without a backpack",
            &[Claim::Top(Colour::Red), Claim::Trousers(Colour::Blue), Claim::Backpack(false)],
        );
        check("7 bananas", &[Claim::Unknown("7".into())]);
        check("stands still for 60 seconds", &[Claim::Stays, Claim::Duration(60.0)]);
    }

    #[test]
    fn chinese_sentences_are_read() {
        let check = |text, expected: &[Claim]| check(Language::Zh, text, expected);
        check("保持约25米距离，俯角约45度。", &[Claim::Distance(25.0), Claim::Pitch(45.0)]);
        check("仰角约5度", &[Claim::Pitch(-5.0)]);
        check("途中停了两次，共约8秒，没有转弯。", &[Claim::Stops(2), Claim::Standing(8.0), Claim::NoTurns]);
        check("一路不停", &[Claim::Stops(0)]);
        check(
            "走了一百三十米，用时100秒，每秒约1.3米",
            &[Claim::Way(130.0), Claim::Duration(100.0), Claim::Speed(1.3)],
        );
        check("出发后连续两次右转，再左转", &[right(), right(), left()]);
        check(
            "转弯3次（左转2次、掉头1次）",
            &[Claim::Turns(3), Claim::TurnsOf(TurnKind::Left, 2), Claim::TurnsOf(TurnKind::Around, 1)],
        );
        check(
            "穿红色上衣、蓝色裤子、背着背包",
            &[Claim::Top(Colour::Red), Claim::Trousers(Colour::Blue), Claim::Backpack(true)],
        );
        check("上衣是红色，裤子是黑色", &[Claim::Top(Colour::Red), Claim::Trousers(Colour::Black)]);
        check("在目标上方20米", &[Claim::Altitude(20.0)]);
        check("向东北行走", &[Claim::Direction(Compass::Northeast), Claim::Walks]);
    }

    #[test]
    fn things_that_no_facts_have_are_named() {
        assert_eq!(foreign_things("They pass two buildings and a bus stop.", Language::En), ["buildings", "bus"]);
        assert_eq!(foreign_things("跟着骑车的女子经过公园。", Language::Zh), ["骑 车", "女", "公 园"]);
        assert!(foreign_things("The person walks along; keep the camera steady.", Language::En).is_empty());
        assert!(foreign_things("无人机镜头下压45度，马上跟上目标。", Language::Zh).is_empty());
    }

    fn left() -> Claim {
        Claim::Turn(TurnKind::Left)
    }

    fn right() -> Claim {
        Claim::Turn(TurnKind::Right)
    }
}
