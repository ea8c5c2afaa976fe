//! Instructions of a flight: whom to follow, how far away, at which angle.

use crate::facts::Facts;
use crate::messages::{Messages, Speaker, capital, fill};
use crate::precision::{DISTANCE_STEP_M, PITCH_STEP_DEG};
use crate::who::who;
use crate::wording::rounded;

/// One or two sentences for the pilot.
pub(crate) fn instruction(facts: &Facts, template: usize, speaker: &mut Speaker<'_>) -> String {
    let messages = speaker.messages;
    let standing = match (facts.walks, &facts.wear) {
        (true, _) => "flight-who",
        (false, Some(_)) => "flight-who[stands]",
        (false, None) => "flight-who[stands-plain]",
    };
    let who = messages.filled(standing, &[("who", &who(facts.wear.as_ref(), speaker))]);
    // Nobody says of who stands where they go.
    let frames = speaker.without("flight-instruction", Some("flight-walking").filter(|_| !facts.walks));
    let look = format!("flight-look[{}]", side(facts));
    let parts = [("c", "flight-call"), ("k", "flight-keep"), ("f", "flight-from"), ("l", &look), ("w", "flight-with")]
        .map(|(slot, id)| (slot, speaker.drawn(id)));
    let mut text = fill(frames[template % frames.len()], &parts);
    for (slot, part) in parts {
        text = fill(&text, &[(&slot.to_uppercase(), &capital(part))]);
    }
    with_numbers(&text, facts, messages, &[("who", &who)])
}

/// Direction of the camera: `up` or `down`.
pub(crate) fn side(facts: &Facts) -> &'static str {
    if facts.pitch_down_deg < 0.0 { "up" } else { "down" }
}

/// `text` with distance, angle and other values.
pub(crate) fn with_numbers(text: &str, facts: &Facts, messages: &Messages, values: &[(&str, &str)]) -> String {
    let (distance, pitch) =
        (rounded(facts.distance_m, DISTANCE_STEP_M), rounded(facts.pitch_down_deg.abs(), PITCH_STEP_DEG));
    let aim = messages.text(&format!("aim[{}]", side(facts)));
    fill(text, &[&[("d", distance.as_str()), ("p", &pitch), ("v", aim)], values].concat())
}
