//! Numbers with units: which quantity of a flight each one is, by the words near it.

use crate::claim::Claim;
use crate::lexicon::Concept;
use crate::sentence::Sentence;
use crate::token::Token;

/// Words behind a number that tell what it is, before those in front of it are asked.
const REACH: usize = 3;
/// Words between a number and its unit: `two short stops`.
const UNIT_REACH: usize = 2;

/// The place and concept of a number's unit.
pub(crate) fn unit(sentence: Sentence<'_>, at: usize) -> Option<(usize, Concept)> {
    let is_open = |place: &usize| {
        matches!(sentence.0.get(*place), Some(Token::Word)) || sentence.concept(*place) == Some(Concept::Other)
    };
    let place = at + 1 + (at + 1..).take(UNIT_REACH).take_while(is_open).count();
    sentence.concept(place).map(|concept| (place, concept))
}

/// The claim of a number with a unit of measure; `None` for other units.
pub(crate) fn measure(sentence: Sentence<'_>, at: usize, value: f64) -> Option<Claim> {
    let (place, unit) = unit(sentence, at)?;
    Some(match unit {
        _ if value.is_nan() => Claim::Unknown("a number with a sign".to_owned()),
        Concept::Metres if is_speed(sentence, at) => Claim::Speed(value),
        Concept::Metres => length(sentence, at, place, value),
        Concept::Speed => Claim::Speed(value),
        Concept::Degrees => Claim::Pitch(value * aim(sentence, place, at)),
        Concept::Seconds if is_rest_of_minutes(sentence, at) => return None,
        Concept::Seconds => time(sentence, at, place, value),
        Concept::Minutes => time(sentence, at, place, 60.0 * value + seconds_behind(sentence, place)),
        _ => return None,
    })
}

/// `每秒1.4米`
fn is_speed(sentence: Sentence<'_>, at: usize) -> bool {
    sentence.before(at, &|it| it == Concept::EachSecond).is_some()
}

fn length(sentence: Sentence<'_>, at: usize, unit: usize, value: f64) -> Claim {
    let is_cue = |it| matches!(it, Concept::Away | Concept::Above | Concept::Way | Concept::Walks | Concept::Runs);
    let clause = sentence.clause(at);
    let near =
        sentence.behind(unit, REACH, &is_cue).or_else(|| sentence.before(at, &|it| is_cue(it) || it == Concept::At));
    let near = near.or_else(|| sentence.behind(unit, clause.len(), &is_cue));
    let is_of_walk = |it| matches!(it, Concept::Seconds | Concept::Speed);
    match near.and_then(|place| sentence.concept(place)) {
        Some(Concept::Above) => Claim::Altitude(value),
        Some(Concept::Way | Concept::Walks | Concept::Runs) => Claim::Way(value),
        // `130 m in 100 seconds`
        None if clause.into_iter().any(|place| sentence.concept(place).is_some_and(is_of_walk)) => Claim::Way(value),
        _ => Claim::Distance(value),
    }
}

/// A time is that of the stops where a stop is nearer than the walk.
fn time(sentence: Sentence<'_>, at: usize, unit: usize, value: f64) -> Claim {
    let is_near = |it| matches!(it, Concept::Stop | Concept::Time);
    let is_cue = |it| {
        is_near(it)
            || matches!(it, Concept::Way | Concept::Walks | Concept::Runs | Concept::Speed | Concept::EachSecond)
    };
    let near = sentence.behind(unit, REACH, &is_near).or_else(|| sentence.long_before(at, &is_cue));
    match near {
        Some(place) if sentence.concept(place) == Some(Concept::Stop) && !sentence.is_denied(place) => {
            Claim::Standing(value)
        }
        _ => Claim::Duration(value),
    }
}

/// Seconds behind minutes: `1 minute and 40 seconds`.
fn seconds_behind(sentence: Sentence<'_>, minutes: usize) -> f64 {
    let next = minutes + 1 + usize::from(sentence.concept(minutes + 1) == Some(Concept::And));
    match (sentence.0.get(next), sentence.concept(next + 1)) {
        (Some(Token::Number(value, _)), Some(Concept::Seconds)) => *value,
        _ => 0.0,
    }
}

fn is_rest_of_minutes(sentence: Sentence<'_>, at: usize) -> bool {
    let minutes =
        |back: usize| at.checked_sub(back).and_then(|place| sentence.concept(place)) == Some(Concept::Minutes);
    minutes(1) || minutes(2) && sentence.concept(at - 1) == Some(Concept::And)
}

/// 1 where the nearest words say that the camera looks down, or none does; -1 where it looks up.
fn aim(sentence: Sentence<'_>, unit: usize, at: usize) -> f64 {
    let is_cue = |it| matches!(it, Concept::Up | Concept::Down);
    let near = sentence.behind(unit, sentence.0.len(), &is_cue).or_else(|| sentence.before(at, &is_cue));
    let near = near.or_else(|| sentence.long_before(at, &is_cue));
    if near.and_then(|place| sentence.concept(place)) == Some(Concept::Up) { -1.0 } else { 1.0 }
}
