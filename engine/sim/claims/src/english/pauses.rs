//! Pauses, and standing all the time, in English clauses.

use super::idioms::is_of_the_drone;
use super::negation::{denied, is_parted};
use super::words::{DURATION_WORDS, MOTION, NEGATIONS, STOP_STEMS, STOP_WORDS, UNPAUSED};
use crate::Claim;
use crate::turn::TurnKind;

/// A pause, as verb or noun, and what keeps somebody from walking on.
pub(super) fn is_stop(word: &str) -> bool {
    (STOP_STEMS.iter().any(|stem| word.starts_with(stem)) && !["tarred", "stopwatch"].contains(&word))
        || STOP_WORDS.contains(&word)
}

/// No pauses, or some.
pub(super) fn pauses_denied(words: &[&str], about_stops: bool, after_stop: bool, claims: &mut Vec<Claim>) {
    // `keeps moving throughout`, `in one go`
    let has = |run: &[&str]| words.windows(run.len()).any(|it| it == run);
    let of_a_stop = about_stops || after_stop;
    let goes_on = UNPAUSED.iter().any(|it| words.contains(it))
        || [["one", "go"], ["without", "letup"], ["without", "cease"], ["all", "go"], ["single", "go"]]
            .iter()
            .any(|it| has(it) && !of_a_stop)
        || (words.windows(2).any(|it| {
            (it[0].starts_with("keep") || it[0] == "kept") && ["moving", "walking", "going"].contains(&it[1])
        }) && words.iter().any(|it| ["throughout", "whole", "entire", "always", "constantly", "all"].contains(it)));
    let is_broken_off = has(&["broken", "off"]) || has(&["broken", "up"]);
    let rests = |word: &str| is_stop(word) || word == "rest" || is_broken_off && word == "broken";
    // `the number of stops was zero`
    let stop = words.iter().position(|word| is_stop(word));
    let is_none = |word: &&str| ["zero", "none", "nil", "nought"].contains(word);
    let counts_none = stop.is_some_and(|stop| words[stop..].iter().take(4).any(is_none));
    if goes_on || counts_none || denied(words, rests) && !has(&["the", "rest"]) {
        claims.retain(|claim| !matches!(claim, Claim::Stops(_)));
        claims.push(Claim::Stops(0));
    } else if about_stops && !claims.iter().any(|claim| matches!(claim, Claim::Stops(_))) {
        claims.push(Claim::SomeStops);
    }
}

/// `does not move`, `without taking a step`, `goes nowhere`; a drone that shall not go nearer is none of that.
pub(super) fn denies_motion(words: &[&str]) -> bool {
    let is_of_place =
        || words.iter().any(|it| ["spot", "place", "anywhere", "position", "muscle", "foot"].contains(it));
    let of = |word: &str| match word {
        "leave" | "leaves" | "leaving" | "left" | "go" | "goes" | "going" | "shift" => is_of_place(),
        word => MOTION.contains(&word) || ["mov", "stir", "budg"].iter().any(|stem| word.starts_with(stem)),
    };
    let near = |at: usize| if words[at].starts_with("walk") { 2 } else { 5 };
    let is_denied = |at: &usize| {
        let before = &words[at.saturating_sub(near(*at))..*at];
        before.iter().rposition(|it| NEGATIONS.contains(it)).is_some_and(|from| !is_parted(&before[from..]))
    };
    let nowhere = words.contains(&"nowhere") && words.iter().any(|it| MOTION.contains(it));
    let is_spot = words.contains(&"spot");
    nowhere
        || (is_spot || !is_of_the_drone(words)) && (0..words.len()).filter(|at| of(words[*at])).any(|at| is_denied(&at))
}

/// `stayed put`; `stay put` is what the drone shall do.
pub(super) fn stays_put(words: &[&str]) -> bool {
    let puts = |it: &[&str]| it[1] == "put" && ["stays", "stayed", "staying", "remains", "remained"].contains(&it[0]);
    words.windows(2).any(puts) && !["drone", "you", "aircraft"].contains(&words[0]) && words.get(1) != Some(&"drone")
}

/// `the position remains unchanged`, `they hold their ground`
pub(super) fn keeps_place(words: &[&str]) -> bool {
    let has = |list: &[&str]| words.iter().any(|word| list.contains(word));
    if words.windows(3).any(|it| it[2] == "ground" && ["hold", "holds", "held"].contains(&it[0])) {
        return true;
    }
    has(&["position", "place", "location", "spot"])
        && has(&["unchanged", "same", "constant", "unaltered"])
        && !is_of_the_drone(words)
}

/// `one pause, about 3 seconds long`: a time in a clause of its own.
pub(super) fn is_time_alone(words: &[&str]) -> bool {
    let is_time = |word: &&str| word.starts_with("second");
    words.len() <= 5 && words.iter().any(is_time) && !words.iter().any(|word| DURATION_WORDS.contains(word))
}

/// `stands still twice`: two stops.
pub(super) fn stands_repeatedly(words: &[&str]) -> bool {
    let is_stand = |word: &&str| ["stand", "stands", "standing", "still", "stood"].contains(word);
    let is_count = |word: &&str| ["once", "twice", "thrice", "times", "occasion", "occasions"].contains(word);
    (0..words.len()).any(|at| is_stand(&words[at]) && words[at + 1..].iter().take(3).any(is_count))
}

/// `stops before turning left`, `turns left after a stop`.
pub(super) fn order_of_stop_and_turn(words: &[&str], turns: &[(usize, TurnKind)]) -> Option<Claim> {
    let stop = words.iter().position(|word| is_stop(word))?;
    let (turn, _) = *turns.iter().min_by_key(|(turn, _)| turn.abs_diff(stop))?;
    let between = &words[stop.min(turn)..stop.max(turn)];
    let stop_first = match () {
        () if between.contains(&"before") => stop < turn,
        () if between.contains(&"after") => stop > turn,
        () if between.contains(&"then") => stop < turn,
        () => return None,
    };
    Some(Claim::StopFirst(stop_first))
}
