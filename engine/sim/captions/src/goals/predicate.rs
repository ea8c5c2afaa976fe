//! Claims in words: what a target does. `{be}` and `{not}` wait for the form of the verb.

use super::claim::{Claim, Passed, Said, hider_name, landmark_name, side_name};
use crate::description::turn_name;
use crate::messages::{Speaker, fill};

/// One claim as an action of the target.
pub(super) fn predicate(said: &Said, speaker: &mut Speaker<'_>) -> String {
    let messages = speaker.messages;
    let hider = |hider| messages.text(&format!("hider[{}]", hider_name(hider)));
    match &said.claim {
        Claim::Wears(_) | Claim::Distance(_) => String::new(),
        Claim::Turns(kind) => speaker.one(&format!("claim-turns[{}]", turn_name(*kind))).to_owned(),
        Claim::TurnsInAll(count) => {
            let values = [("count", count.to_string()), ("n", messages.numeral(*count))];
            speaker.say("claim-turns-in-all", &values.each_ref().map(|(slot, value)| (*slot, value.as_str())))
        }
        Claim::NoTurn => speaker.one("claim-no-turn").to_owned(),
        Claim::Stops(seconds) => speaker.say("claim-stops", &[("s", &messages.seconds(&seconds.to_string()))]),
        Claim::Stands => speaker.one("claim-stands").to_owned(),
        Claim::Passes(passed) => passes(passed, speaker),
        Claim::Crosses => speaker.one("claim-crosses").to_owned(),
        Claim::Lost { behind, seconds, found } => {
            let place = if behind.is_some() { "hidden" } else { "outside" };
            let id = format!("claim-{place}[{}]", if *found { "found" } else { "gone" });
            speaker.say(&id, &[("h", behind.map_or("", hider)), ("s", &messages.seconds(&seconds.to_string()))])
        }
        Claim::PartlyHidden(by) => speaker.say("claim-partly-hidden", &[("h", hider(*by))]),
        Claim::WalksWith(count) => {
            let others = messages.filled(&format!("others[{count}]"), &[("n", &messages.numeral(*count))]);
            speaker.say("claim-walks-with", &[("others", &others)])
        }
        Claim::Meets(colour) | Claim::Overtakes(colour) => {
            let [top, a_top] = messages.colours(*colour);
            let id = if matches!(said.claim, Claim::Meets(_)) { "claim-meets" } else { "claim-overtakes" };
            speaker.say(id, &[("top", top), ("a-top", a_top)])
        }
        Claim::MeetsVehicle(kind) => {
            speaker.say("claim-meets-vehicle", &[("h", hider(super::claim::Hider::Body(*kind)))])
        }
        Claim::OvertakenBy(kind) => {
            speaker.say("claim-overtaken-by", &[("h", hider(super::claim::Hider::Body(*kind)))])
        }
    }
}

/// `walk past two trees on the left`.
fn passes(passed: &Passed, speaker: &mut Speaker<'_>) -> String {
    let number = if passed.count == 1 { "one" } else { "many" };
    let id = format!("landmark-{number}[{}]", landmark_name(passed.kind));
    let things = speaker.messages.filled(&id, &[("n", &speaker.messages.numeral(passed.count))]);
    by_side("claim-passes", passed, &[("t", &things)], speaker)
}

/// A move right after a crossing or the last of some landmarks: `turn left after the second tree on the right`.
pub(super) fn anchored(claim: &Claim, action: &str, speaker: &mut Speaker<'_>) -> String {
    let Claim::Passes(passed) = claim else { return speaker.say("anchored-crossing", &[("a", action)]) };
    let ordinal = speaker.messages.ordinal(passed.count);
    let id = format!("landmark-nth[{}]", landmark_name(passed.kind));
    let nth = speaker.messages.filled(&id, &[("nth", &ordinal)]);
    by_side("anchored", passed, &[("a", action), ("nth", &nth)], speaker)
}

fn by_side(id: &str, passed: &Passed, values: &[(&str, &str)], speaker: &mut Speaker<'_>) -> String {
    let pattern = speaker.one(&format!("{id}{}", if passed.after_crossing { "[after-crossing]" } else { "" }));
    let side = speaker.one(&format!("side[{}]", side_name(passed.side)));
    fill(pattern, &[&[("side", side)], values].concat())
}

/// Things that overlap in time.
pub(super) fn together(parts: &[String], speaker: &mut Speaker<'_>) -> String {
    let messages = speaker.messages;
    let marker = messages.text("together-marker");
    let nested = |part: &str| if part.contains(marker) { "[nested]" } else { "" };
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [first, last] => speaker.say(&format!("together-two{}", nested(first)), &[("first", first), ("last", last)]),
        [first, middle @ .., last] => {
            let middle = middle.join(messages.text("together-gap"));
            let id = format!("together-more{}", nested(last));
            speaker.say(&id, &[("first", first), ("middle", &middle), ("last", last)])
        }
    }
}

/// Things in order of time.
pub(super) fn joined(parts: &[String], speaker: &mut Speaker<'_>) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [one, two] => speaker.say("joined-two", &[("one", one), ("two", two)]),
        [one, two, rest @ ..] => {
            let rest = rest.join(speaker.messages.text("joined-gap"));
            speaker.say("joined-more", &[("one", one), ("two", two), ("rest", &rest)])
        }
    }
}
