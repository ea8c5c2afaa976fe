//! The facts of a flight in words, for a language model.

use crate::config::Style;
use crate::description::turn_name;
use crate::facts::Facts;
use crate::instruction::side;
use crate::messages::{Messages, messages_of};
use crate::precision::{DISTANCE_STEP_M, PITCH_STEP_DEG, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, way_step_m};
use crate::wording::rounded;
use cosfly_claims::Language;

/// The facts in words, one a line.
pub fn facts_in_words(facts: &Facts, language: Language, style: Style) -> String {
    let messages = messages_of(language, facts.runs());
    let mut lines = always(facts, messages);
    if style == Style::Description {
        if facts.walks {
            lines.extend(of_the_walk(facts, messages));
        }
        let duration = messages.seconds(&rounded(facts.duration_s, duration_step_s(facts.duration_s)));
        lines.push(messages.filled("fact-duration", &[("t", &duration)]));
        let height = rounded(facts.altitude_m, DISTANCE_STEP_M);
        lines.extend((facts.altitude_m >= 0.5).then(|| messages.filled("fact-height", &[("h", &height)])));
    }
    lines.iter().map(|line| format!("- {line}")).collect::<Vec<_>>().join("\n")
}

/// Clothes, motion, distance and angle.
fn always(facts: &Facts, messages: &Messages) -> Vec<String> {
    let clothes = facts.wear.as_ref().map(|wear| {
        let ([top, a_top], [trousers, _]) = (messages.colours(wear.top), messages.colours(wear.trousers));
        let id = if wear.backpack { "fact-wears[backpack]" } else { "fact-wears" };
        messages.filled(id, &[("top", top), ("a-top", a_top), ("trousers", trousers)])
    });
    let distance = rounded(facts.distance_m, DISTANCE_STEP_M);
    let pitch = rounded(facts.pitch_down_deg.abs(), PITCH_STEP_DEG);
    vec![
        clothes.unwrap_or_else(|| messages.text("fact-unknown-clothes").to_owned()),
        messages.text(if facts.walks { "fact-walks" } else { "fact-stands" }).to_owned(),
        messages.filled("fact-distance", &[("d", &distance)]),
        messages.filled(&format!("fact-angle[{}]", side(facts)), &[("p", &pitch)]),
    ]
}

/// Turns, stops, length and speed.
fn of_the_walk(facts: &Facts, messages: &Messages) -> [String; 3] {
    let turns = facts.turns.iter().map(|turn| messages.text(&format!("turn[{}]", turn_name(turn.kind))));
    let turns = turns.collect::<Vec<_>>().join(messages.text("fact-turns-gap"));
    let turns_id = match facts.turns.len() {
        _ if !facts.doubtful_turns.is_empty() => "fact-doubtful-turns",
        0 if facts.bends => "fact-bends",
        0 => "fact-no-turns",
        _ => "fact-turns",
    };
    let stops_id = if facts.stops.is_empty() { "fact-no-stops" } else { "fact-stops" };
    let standing = messages.seconds(&rounded(facts.standing_s(), STOP_STEP_S));
    let way = rounded(facts.way_m, way_step_m(facts.way_m));
    let speed = rounded(facts.walking_speed_mps, SPEED_STEP_MPS);
    [
        messages.filled(turns_id, &[("count", &facts.turns.len().to_string()), ("turns", &turns)]),
        messages.filled(stops_id, &[("count", &facts.stops.len().to_string()), ("s", &standing)]),
        messages.filled("fact-way", &[("w", &way), ("v", &speed)]),
    ]
}
