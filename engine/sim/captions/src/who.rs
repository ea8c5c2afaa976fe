//! The target by its clothes.

use crate::facts::Wear;
use crate::messages::{Speaker, fill};

/// `pedestrian in a red top and blue trousers`; without clothes where they are unknown.
pub(crate) fn who(wear: Option<&Wear>, speaker: &mut Speaker<'_>) -> String {
    let noun = speaker.one("who-noun");
    let Some(wear) = wear else { return noun.to_owned() };
    let messages = speaker.messages;
    let choices = messages.all("who-backpack").len();
    let drawn = wear.backpack.then(|| speaker.words.index(choices));
    let backpack = |id: &str| drawn.and_then(|it| messages.all(id).get(it)).map_or("", String::as_str);
    let ([top, a_top], [trousers, _]) = (messages.colours(wear.top), messages.colours(wear.trousers));
    let values = [
        ("noun", noun),
        ("top", top),
        ("a-top", a_top),
        ("trousers", trousers),
        ("backpack", backpack("who-backpack")),
        ("carries", backpack("who-carries")),
    ];
    fill(speaker.one("who-wears"), &values)
}
