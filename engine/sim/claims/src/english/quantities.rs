//! Numbers with a unit in English clauses.

use super::pauses::is_stop;
use super::tokens::{Token, word_of};
use super::turns::{is_turning, turn_word};
use super::units::is_unit;
use super::words::{
    DOWN_STEMS, DURATION_WORDS, LEVEL, NEGATIONS, STRONG_ALTITUDE, STRONG_DISTANCE, STRONG_WAY, TURN_NOUNS, UP_STEMS,
};
use crate::turn::TurnKind;
use crate::{Claim, count};

/// The claim of a number at a place, with the word after it, in its clause.
pub(super) fn quantity(value: f64, at: usize, words: &[&str], about_stops: bool) -> Option<Claim> {
    // `two short stops`, `3 different times`: the unit may stand behind an adjective or two.
    let units = (at + 1..words.len()).take(3).take_while(|it| !words[*it].is_empty());
    let is_known =
        |it: &usize| is_unit(words[*it]) || ["s", "sec", "secs", "deg", "km/h", "kmh", "kph"].contains(&words[*it]);
    let skipped = units.into_iter().find(is_known).map_or(0, |it| it - at - 1);
    let at = at + skipped;
    let unit = words.get(at + 1).copied().unwrap_or_default();
    let after = |offset: usize| words.get(at + offset).copied().unwrap_or_default();
    let is_metres = matches!(unit, "m" | "metre" | "metres" | "meter" | "meters");
    // `1 person`, `100 %`: numbers that say nothing of a flight.
    let says_nothing = value == 1.0 && !unit.is_empty() || unit == "percent";
    if unit == "m/s"
        || is_rate(unit)
        || (is_metres && ["per", "a", "each", "every"].contains(&after(2)) && after(3).starts_with("second"))
    {
        return Some(Claim::Speed(value));
    }
    Some(match unit {
        _ if is_metres && value < 0.0 => Claim::Unknown(format!("{value} {unit}")),
        _ if is_metres => length(value, at, words),
        "km/h" | "kmh" | "kph" => Claim::Speed((value / 0.36).round() / 10.0),
        "degree" | "degrees" | "deg" if value == 180.0 => Claim::Turn(TurnKind::Around),
        "degree" | "degrees" | "deg" => angle(value, aim(words, at)),
        "s" | "sec" | "secs" | "second" | "seconds" => {
            let walks = words.iter().any(|word| DURATION_WORDS.contains(word));
            let stops = words.iter().any(|word| is_stop(word));
            // Beside a stop a time may be that of the stop or of the whole.
            match (stops, walks) {
                (true, false) => Claim::Standing(value),
                (false, true) if !about_stops => Claim::Duration(value),
                _ => Claim::Seconds(value),
            }
        }
        "time" | "times" | "x" | "occasion" | "occasions" if about_stops && !is_of_turns(at, words) => {
            count(value, unit, Claim::Stops)
        }
        // Repetitions of a turn, which the turn's own claims contain.
        "time" | "times" if words.iter().any(|word| turn_word(word).is_some()) => return None,
        "time" | "times" | "x" | "occasion" | "occasions" if words.iter().any(|word| is_turning(word)) => {
            count(value, unit, Claim::Turns)
        }
        "time" | "times" | "x" | "occasion" | "occasions" => count(value, unit, Claim::Times),
        turns if TURN_NOUNS.contains(&turns) && !SIDES.contains(&after(2)) => count(value, unit, Claim::Turns),
        stop if is_stop(stop) => count(value, unit, Claim::Stops),
        side => match turn_word(side) {
            Some(kind) => count(value, unit, |count| Claim::TurnsOf(kind, count)),
            None => {
                // `number of stops equals 2`
                let before: Vec<&str> = words[..at - skipped].iter().rev().take(2).copied().collect();
                let is_equal = |word: &&str| word.starts_with("equal") || ["is", "are", "was", "were"].contains(word);
                if words[..at].iter().any(|word| CAMERA.contains(word)) && !is_unit(unit) {
                    return Some(angle(value, aim(words, at)));
                }
                let subject = before.iter().find(|word| !is_equal(word));
                if unit == "percent" || says_nothing && subject.is_none_or(|it| !is_stop(it)) {
                    return None;
                }
                unlabelled(value, unit, subject.copied().unwrap_or_default())
            }
        },
    })
}

/// Words of a camera, behind which a number without a unit is an angle.
const CAMERA: [&str; 6] = ["gimbal", "camera", "lens", "pitch", "tilt", "angle"];

/// An angle with the way that words near it name: up (0), down, or none.
fn angle(value: f64, aim: Option<usize>) -> Claim {
    match aim {
        Some(0) => Claim::Pitch(-value.abs()),
        Some(_) => Claim::Pitch(value.abs()),
        None => Claim::Tilt(value.abs()),
    }
}

/// `metres/second`, `mps`
fn is_rate(unit: &str) -> bool {
    unit == "mps" || ["m/", "metres/", "meters/", "metre/", "meter/"].iter().any(|it| unit.starts_with(it))
}

/// Whether a word of turning is nearer before a place than a word of pausing.
fn is_of_turns(at: usize, words: &[&str]) -> bool {
    let near = words[..at].iter().rev().find(|word| is_stop(word) || is_turning(word) || **word == "turned");
    near.is_some_and(|word| !is_stop(word))
}

/// `stops: 2`: a number without a unit counts what stands before it.
fn unlabelled(value: f64, next: &str, before: &str) -> Claim {
    match before {
        stop if is_stop(stop) => count(value, stop, Claim::Stops),
        turn if TURN_NOUNS.contains(&turn) => count(value, turn, Claim::Turns),
        _ => Claim::Unknown(format!("{value} {next}").trim_end().to_owned()),
    }
}

/// The claim of a length: of one place where a word beyond doubt is near and none of another place is in the clause.
pub(super) fn length(value: f64, at: usize, words: &[&str]) -> Claim {
    if value.fract() != 0.0 && words.contains(&"second") {
        return Claim::Speed(value);
    }
    // With a time or a pace beside it, a length may be the way, whatever else is near.
    if words.iter().any(|it| ["m/s", "seconds", "secs", "s"].contains(it))
        && !words.iter().any(|it| STRONG_WAY.contains(it))
    {
        return Claim::Metres(value);
    }
    let lists: [&[&str]; 3] = [&STRONG_ALTITUDE, &STRONG_WAY, &STRONG_DISTANCE];
    let near =
        |list: &&[&str]| (0..words.len()).filter(|it| list.contains(&words[*it])).map(|it| it.abs_diff(at)).min();
    let [altitude, way, distance] = [near(&lists[0]), near(&lists[1]), near(&lists[2])];
    let is_near = |cue: Option<usize>| cue.is_some_and(|far| far <= STRONG_REACH);
    match (altitude, way, distance) {
        (Some(_), None, None) if is_near(altitude) => Claim::Altitude(value),
        (None, Some(_), None) if is_near(way) => Claim::Way(value),
        (None, None, Some(_)) if is_near(distance) => Claim::Distance(value),
        _ => Claim::Metres(value),
    }
}

/// Whether the words nearest to an angle speak of looking up (0) or down (1); of both equally near, nobody knows.
pub(super) fn aim(words: &[&str], at: usize) -> Option<usize> {
    // `pitch minus 45 degrees`
    if words.iter().any(|word| CAMERA.contains(word)) && words.iter().any(|word| ["plus", "minus"].contains(word)) {
        return Some(usize::from(words.contains(&"minus")));
    }
    // `15 degrees over the horizon`
    let is_over = |run: &[&str]| run[0] == "over" && run[1..].iter().any(|word| word.starts_with("horizon"));
    if words.windows(3).any(is_over) {
        return Some(0);
    }
    nearest(words, at, &[&UP_STEMS, &DOWN_STEMS])
}

/// Whether a text says that the camera looks neither up nor down: `level`, `no tilt`, `tilt: none`.
pub(super) fn is_level(clauses: &[Vec<Token>]) -> bool {
    let has = |clause: &[Token], is_such: &dyn Fn(&str) -> bool| clause.iter().any(|token| is_such(word_of(token)));
    let is_tilt = |word: &str| {
        ["tilt", "pitch", "inclin", "upward", "downward"].iter().any(|stem| word.starts_with(stem))
            || ["up", "down", "angle"].contains(&word)
    };
    let is_denial = |word: &str| NEGATIONS.contains(&word);
    let is_said = |clause: &Vec<Token>| {
        has(clause, &|word| LEVEL.contains(&word))
            || has(clause, &is_tilt) && has(clause, &is_denial)
            || has(clause, &|word| CAMERA.contains(&word))
                && has(clause, &|word| {
                    ["straight", "zero", "zeroed", "neutral", "forward", "forwards", "ahead"].contains(&word)
                })
    };
    let is_answer =
        |pair: &[Vec<Token>]| has(&pair[0], &is_tilt) && pair[1].first().is_some_and(|it| is_denial(word_of(it)));
    clauses.iter().any(is_said) || clauses.windows(2).any(is_answer)
}

/// The list of beginnings that has the word nearest to place `at`, by its number; of equally near ones the word behind counts.
pub(super) fn nearest(words: &[&str], at: usize, lists: &[&[&str]]) -> Option<usize> {
    let places = (0..words.len()).filter(|place| *place != at);
    let of = |word: &str| {
        lists
            .iter()
            .position(|list| list.iter().any(|stem| word.starts_with(stem) || word.strip_prefix("look") == Some(stem)))
    };
    let found = places.filter_map(|place| Some((place.abs_diff(at), place < at, of(words[place])?)));
    found.min().map(|(_, _, list)| list)
}

/// Words between a length and a word that says beyond doubt what it is.
pub(super) const STRONG_REACH: usize = 7;

/// Words of sides, behind which `turn` counts none.
pub(super) const SIDES: [&str; 4] = ["left", "right", "around", "round"];
