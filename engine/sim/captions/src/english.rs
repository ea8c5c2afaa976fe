//! English wordings of the facts.

use crate::facts::{Facts, Wear};
use crate::precision::{DISTANCE_STEP_M, PITCH_STEP_DEG, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, way_step_m};
use crate::turns::{Turn, TurnKind};
use crate::wording::{one_of, rounded};
use cosfly_random::RandomStream;

/// More turns than this are counted instead of listed.
const LISTED_TURNS: usize = 4;

/// One sentence for the pilot: whom to follow, how far away, at which angle.
pub(crate) fn instruction(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let standing = if facts.walks { "" } else { " who stands still" };
    let who = format!("{}{standing}", who(facts.wear.as_ref(), words));
    let distance = rounded(facts.distance_m, DISTANCE_STEP_M);
    let (at, by) = (view(facts, "at"), view(facts, "by"));
    match template {
        0 => format!("Follow the {who}; keep about {distance} m away and look {at}."),
        1 => format!("Track the {who} from a distance of about {distance} m, with the camera tilted {by}."),
        2 => format!("Stay about {distance} m from the {who}, and keep the camera pitched {by}."),
        3 => format!("Keep the {who} in view from about {distance} m away, camera pointing {at}."),
        4 => format!("Your target is the {who}: hold a distance of about {distance} m and look {at}."),
        _ => format!("Looking {at}, escort the {who} at a distance of about {distance} m."),
    }
}

/// Several sentences: route, stops, length, and how the drone flies.
pub(crate) fn description(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let drone = drone(facts, template % 3);
    let target = who(facts.wear.as_ref(), words);
    let walk = if facts.walks {
        format!("The {target} {} {} {}", route(facts), stops(facts, words), length(facts, words))
    } else {
        let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
        format!("The {target} stands still for about {duration} seconds.")
    };
    if template < 3 { format!("{walk} {drone}") } else { format!("{drone} {walk}") }
}

/// The target with clothes: `pedestrian in a red top and blue trousers`.
pub(crate) fn who(wear: Option<&Wear>, words: &mut RandomStream) -> String {
    let who = one_of(words, &["pedestrian", "person"]);
    let Some(wear) = wear else { return who.to_owned() };
    let (top, trousers) = (wear.top.name(), wear.trousers.name());
    let article = article(top);
    let backpack = if wear.backpack { " with a backpack" } else { "" };
    let pattern = one_of(words, &["in # {} top and {} trousers", "wearing # {} top and {} trousers"]);
    format!("{who}{backpack} {}", pattern.replace('#', article).replacen("{}", top, 1).replacen("{}", trousers, 1))
}

/// Indefinite article before a word.
pub(crate) fn article(word: &str) -> &'static str {
    if word.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}

/// `down at about 45 degrees`.
fn view(facts: &Facts, preposition: &str) -> String {
    let side = if facts.pitch_down_deg < 0.0 { "up" } else { "down" };
    format!("{side} {preposition} about {} degrees", rounded(facts.pitch_down_deg.abs(), PITCH_STEP_DEG))
}

/// The way: what a picture can show of it, without directions of the compass.
fn route(facts: &Facts) -> String {
    match facts.turns.len() {
        0 if facts.start_direction == facts.end_direction => "walks straight on.".to_owned(),
        0 => "walks on without a sharp turn.".to_owned(),
        listed if listed <= LISTED_TURNS => format!("sets off, turns {}, and walks on.", listed_turns(facts)),
        count => {
            let counts: Vec<String> = [TurnKind::Left, TurnKind::Right, TurnKind::Around]
                .iter()
                .map(|&kind| (facts.turns_of(kind), side(kind)))
                .filter(|(count, _)| *count > 0)
                .map(|(count, side)| format!("{count} {side}"))
                .collect();
            format!("sets off, makes {count} turns ({}) and walks on.", counts.join(", "))
        }
    }
}

/// `right twice, then left`.
fn listed_turns(facts: &Facts) -> String {
    let runs = facts.turns.chunk_by(|a, b| a.kind == b.kind);
    let run = |turns: &[Turn]| match turns.len() {
        1 => side(turns[0].kind).to_owned(),
        count => format!("{} {}", side(turns[0].kind), times(count)),
    };
    runs.map(run).collect::<Vec<_>>().join(", then ")
}

fn side(kind: TurnKind) -> &'static str {
    match kind {
        TurnKind::Left => "left",
        TurnKind::Right => "right",
        TurnKind::Around => "around",
    }
}

fn stops(facts: &Facts, words: &mut RandomStream) -> String {
    let standing = rounded(facts.standing_s(), STOP_STEP_S);
    match facts.stops.len() {
        0 => one_of(words, &["There are no stops on the way.", "The walk goes on without stopping."]).into(),
        1 => {
            one_of(words, &["They pause once for about {} seconds.", "On the way they stop once for about {} seconds."])
                .replace("{}", &standing)
        }
        count => {
            one_of(words, &["They stop # for about {} seconds in all.", "They pause # for about {} seconds together."])
                .replace('#', &times(count))
                .replace("{}", &standing)
        }
    }
}

fn times(count: usize) -> String {
    if count == 2 { "twice".into() } else { format!("{count} times") }
}

fn length(facts: &Facts, words: &mut RandomStream) -> String {
    let way = rounded(facts.way_m, way_step_m(facts.way_m));
    let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
    let speed = rounded(facts.walking_speed_mps, SPEED_STEP_MPS);
    match words.index(2) {
        0 => format!("The walk covers about {way} m in about {duration} seconds, at about {speed} m/s."),
        _ => format!(
            "The route is about {way} m long, takes about {duration} seconds and is walked at about {speed} m/s."
        ),
    }
}

fn drone(facts: &Facts, template: usize) -> String {
    let distance = rounded(facts.distance_m, DISTANCE_STEP_M);
    let view = view(facts, "at");
    // A drone that is not above its target has no height worth a word.
    let height = (facts.altitude_m >= 0.5).then(|| rounded(facts.altitude_m, DISTANCE_STEP_M));
    let height = |pattern: &str| height.as_ref().map_or(String::new(), |height| pattern.replace("{}", height));
    match template {
        0 => {
            let height = height(", flies about {} m higher than the target");
            format!("The drone keeps about {distance} m away{height} and looks {view}.")
        }
        1 => {
            let height = height(" about {} m above the target,");
            format!("From about {distance} m away,{height} the camera looks {view}.")
        }
        _ => {
            let height = height(" a height of about {} m above the target,");
            format!("The drone holds a distance of about {distance} m,{height} and points its camera {view}.")
        }
    }
}
