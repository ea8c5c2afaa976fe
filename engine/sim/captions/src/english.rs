//! English wordings of the facts.

use crate::english_frames::{CALLS, FROM, INSTRUCTIONS, KEEPS, LOOKS, WITH};
use crate::facts::{Facts, FirstTurn, Wear};
use crate::precision::{
    DISTANCE_STEP_M, PITCH_STEP_DEG, Pace, SPEED_STEP_MPS, STOP_STEP_S, duration_step_s, pace, way_step_m,
};
use crate::turns::Turn;
use crate::wording::{one_of, rounded, without};
use cosfly_claims::TurnKind;
use cosfly_random::RandomStream;

/// More turns than this are counted instead of listed.
const LISTED_TURNS: usize = 4;

/// One or two sentences for the pilot: whom to follow, how far away, at which angle.
pub(crate) fn instruction(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let standing = if facts.walks { "" } else { " who stands still" };
    let who = format!("{}{standing}", who(facts.wear.as_ref(), words));
    // Nobody says of who stands where they go.
    let walking: &[&str] = &["lead", "goes", "after", "all the way", "Go with"];
    let frames = without(INSTRUCTIONS, Some(walking).filter(|_| !facts.walks));
    let mut text = frames[template % frames.len()].to_owned();
    for (key, list) in [("c", CALLS), ("k", KEEPS), ("f", FROM), ("l", LOOKS), ("w", WITH)] {
        let chosen = one_of(words, list);
        text = text.replace(&format!("[{key}]"), chosen);
        text = text.replace(&format!("[{}]", key.to_uppercase()), &capitalised(chosen));
    }
    fill(&text, facts).replace("{who}", &who)
}

/// `text` with distance and angle.
fn fill(text: &str, facts: &Facts) -> String {
    let side = if facts.pitch_down_deg < 0.0 { "up" } else { "down" };
    text.replace("{d}", &rounded(facts.distance_m, DISTANCE_STEP_M))
        .replace("{p}", &rounded(facts.pitch_down_deg.abs(), PITCH_STEP_DEG))
        .replace("{v}", side)
}

/// Several sentences: route, stops, length, and how the drone flies.
pub(crate) fn description(facts: &Facts, template: usize, words: &mut RandomStream) -> String {
    let drone = drone(facts, words);
    let target = who(facts.wear.as_ref(), words);
    let subject = capitalised(one_of(words, &["the {who}", "the {who}", "this {who}"])).replace("{who}", &target);
    if !facts.walks {
        let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
        let stands = one_of(
            words,
            &[
                "stands still for about {} seconds.",
                "stays motionless for about {} seconds.",
                "remains stationary for about {} seconds.",
            ],
        );
        let walk = format!("{subject} {}", stands.replace("{}", &duration));
        return if template.is_multiple_of(2) { format!("{walk} {drone}") } else { format!("{drone} {walk}") };
    }
    let (route, stops, length) =
        (format!("{subject} {}", route(facts, words)), stops(facts, words), length(facts, words));
    // The walker is named before `they`.
    match template % 4 {
        0 => format!("{route} {stops} {length} {drone}"),
        1 => format!("{drone} {route} {stops} {length}"),
        2 => format!("{route} {length} {stops} {drone}"),
        _ => format!("{drone} {route} {length} {stops}"),
    }
}

/// The text with a capital first letter.
fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}

/// The target with clothes: `pedestrian in a red top and blue trousers`.
pub(crate) fn who(wear: Option<&Wear>, words: &mut RandomStream) -> String {
    let who = one_of(words, &["pedestrian", "person"]);
    let Some(wear) = wear else { return who.to_owned() };
    let (top, trousers) = (wear.top.name(), wear.trousers.name());
    let article = article(top);
    let backpack = if wear.backpack { one_of(words, &[" with a backpack", " and carrying a backpack"]) } else { "" };
    let pattern = one_of(
        words,
        &[
            "in # {} top and % trousers",
            "wearing # {} top and % trousers",
            "dressed in # {} top and % trousers",
            "in % trousers and # {} top",
            "wearing % trousers and # {} top",
            "who wears # {} top and % trousers",
            "who is wearing # {} top and % trousers",
            "dressed in % trousers and # {} top",
        ],
    );
    let backpack =
        if pattern.starts_with("who wears") { backpack.replace("carrying", "carries") } else { backpack.to_owned() };
    format!("{who} {}{backpack}", pattern.replace('#', article).replace("{}", top).replace('%', trousers))
}

/// Indefinite article before a word.
pub(crate) fn article(word: &str) -> &'static str {
    if word.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}

/// The way: what a picture can show of it, without directions of the compass.
fn route(facts: &Facts, words: &mut RandomStream) -> String {
    if !facts.doubtful_turns.is_empty() {
        return one_of(words, &["walks along.", "goes on foot.", "is out on foot."]).to_owned();
    }
    let ending = one_of(words, &["walks on", "goes on", "carries on", "keeps walking"]);
    match facts.turns.len() {
        0 if !facts.bends => one_of(
            words,
            &[
                "walks straight on.",
                "goes straight ahead all the way.",
                "keeps straight on.",
                "heads straight on throughout.",
                "follows a straight line.",
            ],
        )
        .to_owned(),
        0 => one_of(
            words,
            &[
                "walks on without a sharp turn.",
                "goes along with no sharp turn.",
                "makes no sharp turn.",
                "walks along and makes no sharp turn.",
            ],
        )
        .to_owned(),
        listed if listed <= LISTED_TURNS => {
            let patterns: &[&str] = match facts.first_turn() {
                Some(FirstTurn::Soon) => &[
                    "sets off, soon turns {t}, and {e}.",
                    "starts walking, soon turns {t}, and then {e}.",
                    "before long turns {t} and {e}.",
                    "moves off, before long turns {t}, and {e}.",
                ],
                Some(FirstTurn::Late) => &[
                    "sets off, only later turns {t}, and {e}.",
                    "starts walking, only later turns {t}, and then {e}.",
                    "walks for a good while, then turns {t}, and {e}.",
                    "moves off, after a good while turns {t}, and {e}.",
                ],
                None => &[
                    "sets off, turns {t}, and {e}.",
                    "starts walking, turns {t}, and then {e}.",
                    "turns {t} and {e}.",
                    "moves off, turns {t}, and {e}.",
                ],
            };
            one_of(words, patterns).replace("{t}", &listed_turns(facts)).replace("{e}", ending)
        }
        count => {
            let counts: Vec<String> = [TurnKind::Left, TurnKind::Right, TurnKind::Around]
                .iter()
                .map(|&kind| (facts.turns_of(kind), side(kind)))
                .filter(|(count, _)| *count > 0)
                .map(|(count, side)| format!("{count} {side}"))
                .collect();
            let opening = one_of(words, &["sets off, makes", "walks along, makes", "takes", "moves off and makes"]);
            format!("{opening} {count} turns ({}) and {ending}.", counts.join(", "))
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

fn in_seconds(number: &str) -> String {
    format!("{number} {}", if number == "1" { "second" } else { "seconds" })
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
    // Who stands at the start or at the end stops on no way.
    let on_the_way: Option<&[&str]> = (!facts.stops_on_the_way()).then_some(&["way", "walk"]);
    match facts.stops.len() {
        0 => one_of(
            words,
            &[
                "There are no stops on the way.",
                "The walk goes on without stopping.",
                "They never stop.",
                "They do not pause anywhere.",
                "Not a single stop is made.",
                "They keep moving without a pause.",
                "They walk without a pause.",
                "They walk without a break.",
                "They don't stop once.",
                "There isn't a single pause.",
                "It is a walk without a stop.",
                "They make no stops at all.",
                "At no point do they stop.",
            ],
        )
        .into(),
        1 => one_of(
            words,
            &without(
                &[
                    "They pause once for about {} seconds.",
                    "On the way they stop once for about {} seconds.",
                    "There is one stop of about {} seconds.",
                    "There is one pause, about {} seconds long.",
                    "They halt once and wait about {} seconds.",
                    "A single stop lasts about {} seconds.",
                    "They stop just once, for about {} seconds.",
                    "One stop of about {} seconds breaks up the walk.",
                    "They come to a halt once, for about {} seconds.",
                    "There is a single pause of about {} seconds.",
                    "Once they stop and wait for about {} seconds.",
                ],
                on_the_way,
            ),
        )
        .replace("{} seconds", &in_seconds(&standing)),
        count => one_of(
            words,
            &without(
                &[
                    "They stop # for about {} seconds in all.",
                    "They pause # for about {} seconds together.",
                    "They halt # and stand about {} seconds altogether.",
                    "They come to a stop #, for about {} seconds all told.",
                    "They stop #, about {} seconds in all.",
                    "They stop and wait #, for about {} seconds altogether.",
                    "They stop # on the way, about {} seconds in total.",
                    "They pause #, which adds up to about {} seconds.",
                ],
                on_the_way,
            ),
        )
        .replace('#', &times(count))
        .replace("{} seconds", &in_seconds(&standing)),
    }
}

fn times(count: usize) -> String {
    if count == 2 { "twice".into() } else { format!("{count} times") }
}

fn length(facts: &Facts, words: &mut RandomStream) -> String {
    let way = rounded(facts.way_m, way_step_m(facts.way_m));
    let duration = rounded(facts.duration_s, duration_step_s(facts.duration_s));
    let speed = rounded(facts.walking_speed_mps, SPEED_STEP_MPS);
    let patterns: &[&str] = match pace(facts) {
        Pace::Whole => &[
            "The walk covers about {w} m in about {t} seconds, at about {s} m/s.",
            "The route is about {w} m long and takes about {t} seconds; the pace is about {s} m/s.",
            "They walk about {w} m in about {t} seconds, at about {s} m/s.",
            "In about {t} seconds they cover about {w} m, at about {s} m/s.",
            "At about {s} m/s, the route of about {w} m takes about {t} seconds.",
            "The path measures about {w} m; at about {s} m/s it takes about {t} seconds.",
            "Walking at about {s} m/s, they cover about {w} m in about {t} seconds.",
            "It takes about {t} seconds to walk about {w} m, at a pace of about {s} m/s.",
            "The whole walk of about {w} m takes about {t} seconds, at about {s} m/s.",
            "It is a walk of about {w} m; it takes about {t} seconds at about {s} m/s.",
            "In about {t} seconds they cover about {w} m, at a pace of about {s} m/s.",
            "At a pace of about {s} m/s they walk about {w} m in about {t} seconds.",
            "Their route of about {w} m takes them about {t} seconds, at about {s} m/s.",
            "They need about {t} seconds for the route of about {w} m and walk at about {s} m/s.",
        ],
        Pace::WhileWalking => &[
            "They cover about {w} m in about {t} seconds; while walking, they go at about {s} m/s.",
            "The route of about {w} m takes about {t} seconds; while walking, the pace is about {s} m/s.",
            "In about {t} seconds they cover about {w} m; while they walk, their pace is about {s} m/s.",
            "The walk of about {w} m takes about {t} seconds, at about {s} m/s while walking.",
            "It takes them about {t} seconds to cover about {w} m; their pace while walking is about {s} m/s.",
            "The route is about {w} m long and takes about {t} seconds; while they walk, they do about {s} m/s.",
        ],
        Pace::Unsaid => &[
            "The walk covers about {w} m in about {t} seconds.",
            "They cover about {w} m in about {t} seconds.",
            "In about {t} seconds they cover about {w} m.",
            "The route is about {w} m long and takes about {t} seconds.",
            "The whole walk of about {w} m takes about {t} seconds.",
            "It is a walk of about {w} m; it takes about {t} seconds.",
        ],
    };
    let pattern = one_of(words, patterns);
    pattern.replace("{w}", &way).replace("{t}", &duration).replace("{s}", &speed)
}

/// How the drone flies. One that is not above its target has no height worth a word.
fn drone(facts: &Facts, words: &mut RandomStream) -> String {
    let height = (facts.altitude_m >= 0.5).then(|| rounded(facts.altitude_m, DISTANCE_STEP_M));
    let Some(height) = height else {
        let pattern = one_of(
            words,
            &[
                "The drone keeps about {d} m away and looks {v} at about {p} degrees.",
                "From about {d} m away, the camera looks {v} at about {p} degrees.",
            ],
        );
        return fill(pattern, facts);
    };
    let pattern = one_of(
        words,
        &[
            "The drone keeps about {d} m away, flies about {h} m higher than the target and looks {v} at about {p} degrees.",
            "From about {d} m away, about {h} m above the target, the camera looks {v} at about {p} degrees.",
            "The drone holds a distance of about {d} m, a height of about {h} m above the target, and points its camera {v} at about {p} degrees.",
            "About {h} m above the target, the drone stays about {d} m away with its camera tilted {v} by about {p} degrees.",
            "The aircraft follows at a distance of about {d} m, its lens angled {v} at about {p} degrees, about {h} m above the target.",
            "We film from about {d} m away and about {h} m above the target, with the camera turned {v} by about {p} degrees.",
            "The camera, about {h} m higher than the target and about {d} m away, is pitched {v} by about {p} degrees.",
            "The drone flies about {h} m above the target and about {d} m away, with the lens angled {v} at about {p} degrees.",
            "Flying about {h} m above the target, the drone keeps about {d} m away and looks {v} at about {p} degrees.",
            "The drone stays about {d} m away and about {h} m above the target; its camera looks {v} at about {p} degrees.",
            "With its camera tilted {v} by about {p} degrees, the drone follows from about {d} m away, about {h} m higher than the target.",
            "We look {v} at about {p} degrees from about {d} m away, about {h} m above the target.",
            "The pictures are taken from about {d} m away and about {h} m above the target, with the camera angled {v} at about {p} degrees.",
        ],
    );
    fill(pattern, facts).replace("{h}", &height)
}
