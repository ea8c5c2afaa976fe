//! The instruction of a picture: whom to follow, by clothes, by the people around, by the way across the picture.

use super::beside::{Beside, NearLandmark};
use super::facts::{Across, PlaceAmong, Side, Sight};
use super::relation::{Relation, relation};
use crate::goals::{landmark_name, side_name};
use crate::messages::{Speaker, messages_of};
use crate::refer::{Phrase, text};
use crate::who::who;
use cosfly_claims::Language;
use cosfly_random::Seed;

/// One sentence for the pilot that holds in this picture. The wording is the seed's.
pub fn instruction(sight: &Sight, language: Language, seed: Seed) -> String {
    let words = &mut seed.child(language.code(), 0).stream("words");
    sentence(sight, &mut Speaker { messages: messages_of(language, sight.runs), words })
}

/// One sentence for the pilot about a body that a phrase singles out: `Follow the white car on the left of the picture.` The
/// wording is the seed's.
pub fn phrase_instruction(phrase: &Phrase, language: Language, seed: Seed) -> String {
    let words = &mut seed.child(language.code(), 0).stream("words");
    let speaker = &mut Speaker { messages: messages_of(language, false), words };
    let follow = speaker.one("sight-follow");
    speaker.messages.filled("sight-phrase", &[("follow", follow), ("phrase", &text(phrase, language))])
}

/// `Follow the person in a red top and blue trousers, ahead of two others, walking away from the camera.`
fn sentence(sight: &Sight, speaker: &mut Speaker<'_>) -> String {
    let messages = speaker.messages;
    let who = who(sight.wear.as_ref(), speaker);
    let follow = speaker.one("sight-follow");
    let filled = |id: &str, parts: &str| messages.filled(id, &[("follow", follow), ("who", &who), ("parts", parts)]);
    let Some(seen) = &sight.seen else { return filled("sight-unseen", "") };
    let relation = relation(seen).map(|it| relation_words(&it, speaker));
    let across = seen.across.map(|it| messages.text(&format!("sight-across[{}]", across_name(it))).to_owned());
    let mut parts: Vec<String> = relation.into_iter().chain(across).collect();
    if speaker.words.chance(0.5) {
        parts.reverse();
    }
    let walks = matches!(seen.across, Some(Across::Away | Across::Towards | Across::ToTheLeft | Across::ToTheRight));
    parts.extend(seen.landmarks.first().map(|it| landmark_words(it, walks, speaker)));
    let id = if parts.is_empty() { "sight[plain]" } else { "sight" };
    filled(id, &parts.join(messages.text("sight-gap")))
}

fn relation_words(relation: &Relation, speaker: &mut Speaker<'_>) -> String {
    let messages = speaker.messages;
    match *relation {
        Relation::One(place, top) => {
            let [top, a_top] = messages.colours(top);
            speaker.say(&format!("sight-one[{}]", place_name(place)), &[("top", top), ("a-top", a_top)])
        }
        Relation::Several(place, count) => {
            let id = format!("sight-several[{}]", place_name(place));
            messages.filled(&id, &[("n", &messages.numeral(count))])
        }
        Relation::Alone => speaker.one("sight-alone").to_owned(),
        Relation::Outermost(side, count) => {
            let side = if side == Side::Leftmost { "left" } else { "right" };
            messages.filled(&format!("sight-outermost[{side}]"), &[("n", &messages.numeral(count))])
        }
        Relation::Nearest => messages.text("sight-nearest").to_owned(),
        Relation::In(part) => messages.text(&format!("sight-in[{}]", part.name())).to_owned(),
    }
}

/// `passing a tree on the left`; `walks`: whether the text says already that the target walks.
fn landmark_words(landmark: &NearLandmark, walks: bool, speaker: &Speaker<'_>) -> String {
    let messages = speaker.messages;
    let thing = messages.text(&format!("sight-thing[{}]", landmark_name(landmark.kind)));
    let side = landmark.side.map_or("", |it| messages.text(&format!("sight-side[{}]", side_name(it))));
    let id = match landmark.beside {
        Beside::Passes if walks => "sight-passes[walks]",
        Beside::Passes => "sight-passes",
        Beside::Approaches => "sight-approaches",
        Beside::NextTo => "sight-next-to",
        Beside::InFront => "sight-in-front",
    };
    messages.filled(id, &[("thing", thing), ("side", side)])
}

fn across_name(across: Across) -> &'static str {
    match across {
        Across::Away => "away",
        Across::Towards => "towards",
        Across::ToTheLeft => "to-the-left",
        Across::ToTheRight => "to-the-right",
        Across::Stands => "stands",
    }
}

fn place_name(place: PlaceAmong) -> &'static str {
    match place {
        PlaceAmong::Ahead => "ahead",
        PlaceAmong::Behind => "behind",
        PlaceAmong::Beside => "beside",
    }
}
