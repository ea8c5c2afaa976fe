//! English wordings of what a picture shows.

use super::beside::{Beside, NearLandmark, OnSide};
use super::facts::{Across, Place, Side, Sight};
use super::landmarks::LandmarkKind;
use super::relation::{Relation, relation};
use crate::english::{article, who};
use crate::part::Part;
use crate::wording::one_of;
use cosfly_random::RandomStream;

/// `Follow the person in a red top and blue trousers, ahead of two others, walking away from the camera.`
pub(super) fn instruction(sight: &Sight, words: &mut RandomStream) -> String {
    let who = who(sight.wear.as_ref(), words);
    let follow = one_of(words, &["Follow", "Track", "Keep following", "Keep up with"]);
    let Some(seen) = &sight.seen else {
        return format!("{follow} the {who}, who cannot be seen at the moment.");
    };
    let relation = relation(seen).map(|it| relation_words(&it, words));
    let mut parts: Vec<String> =
        relation.into_iter().chain(seen.across.map(|it| across_words(it).to_owned())).collect();
    if words.chance(0.5) {
        parts.reverse();
    }
    let walks = matches!(seen.across, Some(Across::Away | Across::Towards | Across::ToTheLeft | Across::ToTheRight));
    parts.extend(seen.landmarks.first().map(|it| landmark_words(it, walks)));
    parts.insert(0, format!("{follow} the {who}"));
    format!("{}.", parts.join(", "))
}

fn across_words(across: Across) -> &'static str {
    match across {
        Across::Away => "walking away from the camera",
        Across::Towards => "walking towards the camera",
        Across::ToTheLeft => "walking to the left",
        Across::ToTheRight => "walking to the right",
        Across::Stands => "standing still",
    }
}

fn relation_words(relation: &Relation, words: &mut RandomStream) -> String {
    match *relation {
        Relation::One(place, top) => {
            let someone = one_of(words, &["someone", "a person"]);
            format!("{} {someone} in {} {} top", place_words(place), article(top.name()), top.name())
        }
        Relation::Several(place, count) => format!("{} {} others", place_words(place), numeral(count)),
        Relation::Alone => one_of(words, &["the only person in view", "the only person in the picture"]).to_owned(),
        Relation::Outermost(Side::Leftmost, count) => format!("the leftmost of the {} people in view", numeral(count)),
        Relation::Outermost(Side::Rightmost, count) => {
            format!("the rightmost of the {} people in view", numeral(count))
        }
        Relation::Nearest => "the person nearest to the camera".to_owned(),
        Relation::In(Part::Left) => "on the left of the picture".to_owned(),
        Relation::In(Part::Middle) => "in the middle of the picture".to_owned(),
        Relation::In(Part::Right) => "on the right of the picture".to_owned(),
    }
}

/// `passing a tree on the left`; `walks`: whether the text says already that the target walks.
fn landmark_words(landmark: &NearLandmark, walks: bool) -> String {
    let thing = match landmark.kind {
        LandmarkKind::TrafficLight => "a traffic light",
        LandmarkKind::Lamp => "a street lamp",
        LandmarkKind::TrafficSign => "a traffic sign",
        LandmarkKind::Tree => "a tree",
        LandmarkKind::Car => "a parked car",
        LandmarkKind::Building => "a building",
    };
    let side = match landmark.side {
        Some(OnSide::Left) => " on the left",
        Some(OnSide::Right) => " on the right",
        None => "",
    };
    let relation = match landmark.beside {
        Beside::Passes if walks => "passing",
        Beside::Passes => "walking past",
        Beside::Approaches => "approaching",
        Beside::NextTo => "next to",
        Beside::InFront => "in front of",
    };
    format!("{relation} {thing}{side}")
}

fn place_words(place: Place) -> &'static str {
    match place {
        Place::Ahead => "just ahead of",
        Place::Behind => "just behind",
        Place::Beside => "side by side with",
    }
}

fn numeral(count: usize) -> String {
    let numerals = ["no", "one", "two", "three", "four", "five", "six"];
    numerals.get(count).map_or_else(|| count.to_string(), |numeral| (*numeral).to_owned())
}
