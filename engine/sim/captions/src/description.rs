//! Descriptions of a flight: route, stops, length, and how the drone flies.

use crate::facts::{Facts, FirstTurn};
use crate::instruction::{side, with_numbers};
use crate::messages::{Speaker, capital, fill};
use crate::precision::{DISTANCE_STEP_M, Pace, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, pace, way_step_m};
use crate::turns::Turn;
use crate::who::who;
use crate::wording::{one_of, rounded};
use cosfly_claims::TurnKind;

/// More turns than this are counted instead of listed.
const LISTED_TURNS: usize = 4;

/// Several sentences.
pub(crate) fn description(facts: &Facts, template: usize, speaker: &mut Speaker<'_>) -> String {
    let messages = speaker.messages;
    let gap = messages.text("sentence-gap");
    let drone = drone(facts, speaker);
    let target = who(facts.wear.as_ref(), speaker);
    let subject = fill(&capital(speaker.one("flight-subject")), &[("who", &target)]);
    if !facts.walks {
        let duration = speaker.messages.seconds(&rounded(facts.duration_s, duration_step_s(facts.duration_s)));
        let walk = speaker.say("flight-stands", &[("subject", &subject), ("t", &duration)]);
        return if template.is_multiple_of(2) { [walk, drone].join(gap) } else { [drone, walk].join(gap) };
    }
    let route = messages.filled("flight-walks", &[("subject", &subject), ("route", &route(facts, speaker))]);
    let (stops, length) = (stops(facts, speaker), length(facts, speaker));
    // The walker is named before `they`; without a subject what follows the drone would be read as the drone's.
    match template % 4 {
        0 => [route, stops, length, drone].join(gap),
        1 => [drone, route, stops, length].join(gap),
        2 => [route, length, stops, drone].join(gap),
        _ => [drone, route, length, stops].join(gap),
    }
}

/// The way: what a picture can show of it, without directions of the compass.
fn route(facts: &Facts, speaker: &mut Speaker<'_>) -> String {
    if !facts.doubtful_turns.is_empty() {
        return speaker.one("route-unclear").to_owned();
    }
    let ending = speaker.one("route-ending");
    match facts.turns.len() {
        0 if !facts.bends => speaker.one("route-straight").to_owned(),
        0 => speaker.one("route-bends").to_owned(),
        listed if listed <= LISTED_TURNS => {
            let id = match facts.first_turn() {
                Some(FirstTurn::Soon) => "route-turns[soon]",
                Some(FirstTurn::Late) => "route-turns[late]",
                None => "route-turns",
            };
            let turns = listed_turns(facts, speaker);
            speaker.say(id, &[("t", &turns), ("e", ending)])
        }
        count => {
            let counts = counted_turns(facts, speaker);
            speaker.say("route-counted", &[("count", &count.to_string()), ("turns", &counts), ("e", ending)])
        }
    }
}

/// `3 left, 2 right`.
fn counted_turns(facts: &Facts, speaker: &Speaker<'_>) -> String {
    let counts = [TurnKind::Left, TurnKind::Right, TurnKind::Around].map(|kind| (facts.turns_of(kind), kind));
    let counts = counts.iter().filter(|(count, _)| *count > 0).map(|(count, kind)| {
        let turn = turn(*kind, speaker);
        speaker.messages.filled("route-count", &[("count", &count.to_string()), ("turn", turn)])
    });
    counts.collect::<Vec<_>>().join(speaker.messages.text("route-counts-gap"))
}

/// `right twice, then left`.
fn listed_turns(facts: &Facts, speaker: &Speaker<'_>) -> String {
    let run = |turns: &[Turn]| {
        let count = turns.len();
        let values = [("turn", turn(turns[0].kind, speaker)), ("times", &speaker.messages.times(count))];
        speaker.messages.filled(&format!("route-run[{count}]"), &values)
    };
    let runs = facts.turns.chunk_by(|a, b| a.kind == b.kind).map(run);
    runs.collect::<Vec<_>>().join(speaker.messages.text("route-runs-gap"))
}

fn turn<'a>(kind: TurnKind, speaker: &Speaker<'a>) -> &'a str {
    speaker.messages.text(&format!("turn[{}]", turn_name(kind)))
}

/// Selector of a turn.
pub(crate) fn turn_name(kind: TurnKind) -> &'static str {
    match kind {
        TurnKind::Left => "left",
        TurnKind::Right => "right",
        TurnKind::Around => "around",
    }
}

fn stops(facts: &Facts, speaker: &mut Speaker<'_>) -> String {
    let count = facts.stops.len();
    let seconds = speaker.messages.seconds(&rounded(facts.standing_s(), STOP_STEP_S));
    // Who stands at the start or at the end stops on no way.
    let forbidden = Some("stops-on-the-way").filter(|_| count > 0 && !facts.stops_on_the_way());
    let patterns = speaker.without(&format!("stops[{count}]"), forbidden);
    let (numeral, times) = (speaker.messages.numeral(count), speaker.messages.times(count));
    fill(one_of(speaker.words, &patterns), &[("s", &seconds), ("n", &numeral), ("times", &times)])
}

fn length(facts: &Facts, speaker: &mut Speaker<'_>) -> String {
    let way = rounded(facts.way_m, way_step_m(facts.way_m));
    let duration = speaker.messages.seconds(&rounded(facts.duration_s, duration_step_s(facts.duration_s)));
    let speed = rounded(facts.walking_speed_mps, SPEED_STEP_MPS);
    let id = match pace(facts) {
        Pace::Whole => "length[whole]",
        Pace::WhileWalking => "length[while-walking]",
        Pace::Unsaid => "length[unsaid]",
    };
    speaker.say(id, &[("w", &way), ("t", &duration), ("s", &speed)])
}

/// How the drone flies. One that is not above its target has no height worth a word.
fn drone(facts: &Facts, speaker: &mut Speaker<'_>) -> String {
    let id = if facts.altitude_m >= 0.5 { "drone" } else { "drone-level" };
    let has_look = speaker.messages.text(id).contains("{look}");
    let look = if has_look { speaker.one(&format!("flight-look[{}]", side(facts))) } else { "" };
    let pattern = fill(speaker.one(id), &[("look", look)]);
    let height = rounded(facts.altitude_m, DISTANCE_STEP_M);
    with_numbers(&pattern, facts, speaker.messages, &[("h", &height)])
}
