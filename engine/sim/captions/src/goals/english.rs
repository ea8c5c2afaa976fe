//! English wordings of goals.

use super::claim::{Claim, Hider, Passed, Said, Subject};
use super::english_frames::{FLIGHTS, KEEPS, OF_CLOTHES, OF_DISTANCE, OF_MOVES, STEPS};
use super::plan::Wording;
use crate::english::{article, who};
use crate::facts::Wear;
use crate::sight::{LandmarkKind, OnSide};
use crate::wording::one_of;
use cosfly_claims::TurnKind;
use cosfly_domain::{Colour, ObstacleKind};
use cosfly_random::RandomStream;

/// The wordings of the language.
pub(super) const WORDING: Wording = Wording {
    flights: FLIGHTS,
    steps: STEPS,
    keeps: KEEPS,
    predicate,
    anchored,
    together,
    joined,
    finished,
    target,
    dialogue,
};

/// What they do; `{be}` and `{not}` wait for the form of the verb.
fn predicate(said: &Said, words: &mut RandomStream) -> String {
    match &said.claim {
        Claim::Turns(kind) => one_of(words, turns(*kind)).to_owned(),
        Claim::TurnsInAll(count) => {
            one_of(words, &["turn {} times", "make {} turns", "change direction {} times", "turn off {} times in all"])
                .replace("{}", &count.to_string())
        }
        Claim::NoTurn => one_of(
            words,
            &[
                "walk on without a sharp turn",
                "walk on without turning off",
                "carry on without a sharp turn",
                "keep going and never turn off",
                "keep to their route without a sharp turn",
                "keep to their route without turning off",
            ],
        )
        .to_owned(),
        Claim::Stops(seconds) => in_seconds(
            one_of(
                words,
                &[
                    "stop for about {s}",
                    "pause for about {s}",
                    "stand still for about {s}",
                    "wait on the spot for about {s}",
                    "come to a halt for about {s}",
                    "halt for about {s}",
                    "stop and stand there for about {s}",
                    "stop where they are for about {s}",
                ],
            ),
            *seconds,
        ),
        Claim::Stands => one_of(
            words,
            &[
                "stand still the whole time",
                "never move from the spot",
                "stay put all the time",
                "stand where they are",
            ],
        )
        .to_owned(),
        around => surroundings(around, words),
    }
}

/// A crossing that they use.
const CROSSES: &[&str] = &[
    "cross the street at a zebra crossing",
    "cross the road at a pedestrian crossing",
    "go to the other side of the street at a zebra crossing",
    "walk over a pedestrian crossing to the other side",
];

/// What is around them, and hides them.
fn surroundings(claim: &Claim, words: &mut RandomStream) -> String {
    match claim {
        Claim::Passes(passed) => {
            let patterns: &[&str] = if passed.after_crossing {
                &[
                    "walk past {t} on the {side} after the crossing",
                    "pass {t} on their {side} after the crossing",
                    "go past {t} on the {side} once they are over the crossing",
                ]
            } else {
                &[
                    "walk past {t} on the {side}",
                    "pass {t} on their {side}",
                    "go past {t} on the {side}",
                    "walk by {t} on their {side}",
                ]
            };
            let pattern = one_of(words, patterns);
            pattern.replace("{t}", &things(passed)).replace("{side}", side(passed.side))
        }
        Claim::Crosses => one_of(words, CROSSES).to_owned(),
        Claim::Lost { behind, seconds, found } => lost(*behind, *seconds, *found, words),
        Claim::PartlyHidden(hider) => {
            let pattern = one_of(
                words,
                &["{be} partly hidden by {}", "{be} half covered by {}", "{be} only partly visible behind {}"],
            );
            pattern.replace("{}", hider_words(*hider))
        }
        Claim::WalksWith(count) => {
            let pattern = one_of(
                words,
                &["walk beside {}", "walk along with {}", "walk side by side with {}", "walk together with {}"],
            );
            let others = ["", "someone else", "two others", "three others", "four others", "five others", "six others"];
            pattern.replace("{}", others.get(*count).copied().unwrap_or("several others"))
        }
        Claim::Meets(top) => {
            let pattern = one_of(
                words,
                &[
                    "meet someone in {} top coming the other way",
                    "pass someone in {} top who comes towards them",
                    "come face to face with someone in {} top and walk past them",
                    "walk past someone in {} top coming the opposite way",
                ],
            );
            pattern.replace("{}", &a_colour(*top))
        }
        Claim::Overtakes(top) => {
            let pattern = one_of(
                words,
                &[
                    "overtake someone in {} top",
                    "catch up with someone in {} top and walk past them",
                    "get ahead of someone in {} top who is going the same way",
                ],
            );
            pattern.replace("{}", &a_colour(*top))
        }
        Claim::MeetsVehicle(kind) => {
            let pattern = one_of(words, &["meet {} coming the other way", "pass {} that comes towards them"]);
            pattern.replace("{}", hider_words(Hider::Body(*kind)))
        }
        Claim::OvertakenBy(kind) => {
            let pattern = one_of(words, &["{be} overtaken by {}", "{be} passed by {} from behind"]);
            pattern.replace("{}", hider_words(Hider::Body(*kind)))
        }
        _ => String::new(),
    }
}

fn turns(kind: TurnKind) -> &'static [&'static str] {
    match kind {
        TurnKind::Left => &[
            "turn left",
            "take a left",
            "go left",
            "turn off to the left",
            "take a left turn",
            "swing left",
            "head off to the left",
        ],
        TurnKind::Right => &[
            "turn right",
            "take a right",
            "go right",
            "turn off to the right",
            "take a right turn",
            "swing right",
            "head off to the right",
        ],
        TurnKind::Around => &["turn round", "turn back", "double back", "make a U-turn", "go back the way they came"],
    }
}

/// A move right after a crossing or the last of some landmarks: `turn left after the second tree on the right`.
fn anchored(claim: &Claim, action: &str, words: &mut RandomStream) -> String {
    let Claim::Passes(passed) = claim else {
        let patterns = ["cross the street at a zebra crossing and {a} after it", "{a} after a zebra crossing"];
        return one_of(words, &patterns).replace("{a}", action);
    };
    let ordinals = ["", "first", "second", "third", "fourth", "fifth", "sixth"];
    let patterns: &[&str] = if passed.after_crossing {
        &[
            "{a} after the {n} {t} on the {side}, counted from the crossing",
            "go over the crossing and past the {n} {t} on the {side}, and then {a}",
            "{a} once they are past the {n} {t} on the {side} after the crossing",
        ]
    } else {
        &[
            "{a} after the {n} {t} on the {side}",
            "go past the {n} {t} on their {side} and then {a}",
            "{a} once they are past the {n} {t} on the {side}",
            "reach the {n} {t} on the {side}, pass it and {a}",
        ]
    };
    let pattern = one_of(words, patterns);
    let (one, _) = thing(passed.kind);
    let filled = pattern.replace("{a}", action).replace("{n}", ordinals.get(passed.count).copied().unwrap_or("last"));
    filled.replace("{t}", one).replace("{side}", side(passed.side))
}

fn lost(behind: Option<Hider>, seconds: u32, found: bool, words: &mut RandomStream) -> String {
    let patterns: &[&str] = match (behind, found) {
        (Some(_), true) => &[
            "disappear behind {h} for about {s}",
            "{be} out of sight behind {h} for about {s}",
            "vanish behind {h} and reappear about {s} later",
            "{be} completely hidden by {h} for about {s}",
            "go behind {h} and come out again after about {s}",
            "drop out of sight behind {h} for about {s}",
        ],
        (Some(_), false) => &[
            "disappear behind {h} and {not} come back into view",
            "go out of sight behind {h} for good",
            "end up behind {h}, out of sight to the end",
        ],
        (None, true) => &[
            "leave the picture for about {s}",
            "drop out of the frame for about {s}",
            "{be} out of the picture for about {s}",
            "walk out of shot and come back after about {s}",
        ],
        (None, false) => &[
            "leave the picture and {not} come back",
            "walk out of the frame for good",
            "end up outside of the picture",
        ],
    };
    let filled = one_of(words, patterns).replace("{h}", behind.map_or("", hider_words));
    in_seconds(&filled, seconds)
}

fn in_seconds(pattern: &str, seconds: u32) -> String {
    pattern.replace("{s}", &if seconds == 1 { "1 second".to_owned() } else { format!("{seconds} seconds") })
}

/// Things that overlap in time, as a list.
fn together(parts: &[String], _words: &mut RandomStream) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [one, two] if !one.contains(" and ") => format!("{one} and {two}"),
        [most @ .., last] => format!("{}, and {last}", most.join(", ")),
    }
}

/// What they do, joined. `first` is left out: the base form has no place for it.
fn joined(parts: &[String], words: &mut RandomStream) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [one, two] => {
            let link = one_of(words, &[", then ", " and then ", ", and after that ", " and later ", ", and next "]);
            format!("{one}{link}{two}")
        }
        [one, two, rest @ ..] => {
            let links = [
                [", ", ", and finally "],
                [", then ", ", and then "],
                [", then ", ", and after that "],
                [", then ", ", and last of all "],
            ];
            let [second, last] = links[words.index(links.len())];
            format!("{one}{second}{two}{last}{}", rest.join(" and "))
        }
    }
}

/// A text with its predicates in their forms, capitals and full stops.
fn finished(template: &str, predicates: &str, keep: &str) -> String {
    let finite = predicates.replace("{be}", "are").replace("{not}", "do not");
    let base = predicates.replace("{be}", "be").replace("{not}", "not");
    let text =
        template.replace("[p]", &finite).replace("[b]", &base).replace("[k]", keep).replace("[K]", &capital(keep));
    capital(&text)
}

pub(super) fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}

/// The target, by its clothes.
fn target(wear: &Wear, words: &mut RandomStream) -> String {
    format!("the {}", who(Some(wear), words)).replace("on the back", "on their back")
}

fn a_colour(colour: Colour) -> String {
    format!("{} {}", article(colour.name()), colour.name())
}

fn things(passed: &Passed) -> String {
    let (one, several) = thing(passed.kind);
    let counts = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight"];
    match passed.count {
        1 => format!("{} {one}", article(one)),
        count => format!("{} {several}", counts.get(count).copied().unwrap_or("many")),
    }
}

fn thing(kind: LandmarkKind) -> (&'static str, &'static str) {
    match kind {
        LandmarkKind::TrafficLight => ("traffic light", "traffic lights"),
        LandmarkKind::Lamp => ("street lamp", "street lamps"),
        LandmarkKind::TrafficSign => ("traffic sign", "traffic signs"),
        LandmarkKind::Tree => ("tree", "trees"),
        LandmarkKind::Car => ("parked car", "parked cars"),
        LandmarkKind::Building => ("building", "buildings"),
    }
}

fn side(side: OnSide) -> &'static str {
    match side {
        OnSide::Left => "left",
        OnSide::Right => "right",
    }
}

fn hider_words(hider: Hider) -> &'static str {
    match hider {
        Hider::Object(ObstacleKind::Building) => "a building",
        Hider::Object(ObstacleKind::Wall) => "a wall",
        Hider::Object(ObstacleKind::Fence) => "a fence",
        Hider::Object(ObstacleKind::TreeTrunk | ObstacleKind::TreeCrown) => "a tree",
        Hider::Object(ObstacleKind::Bush) => "a bush",
        Hider::Object(ObstacleKind::Bridge) => "a bridge",
        Hider::Object(ObstacleKind::Car) => "a parked car",
        Hider::Object(_) => "something",
        Hider::Body(kind) => kind.row().words.one_in_english,
    }
}

/// Lines of dialogues about a subject.
fn dialogue(subject: Subject) -> &'static [[&'static str; 3]] {
    match subject {
        Subject::Clothes => OF_CLOTHES,
        Subject::Distance => OF_DISTANCE,
        _ => OF_MOVES,
    }
}
