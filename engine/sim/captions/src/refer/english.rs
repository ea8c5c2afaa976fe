//! English referring phrases.

use super::phrase::{Phrase, Property};
use crate::english::article;
use crate::part::Part;
use cosfly_domain::{BodyKind, BodyKindRow};

/// `the walking person in a red top and blue trousers with a backpack on the left of the picture`.
pub(super) fn text(phrase: &Phrase) -> String {
    let of = &phrase.of;
    let BodyKindRow { is_dressed, words: names, .. } = of.kind.row();
    let (noun, is_dressed) = (names.english, *is_dressed);
    let (top, trousers) = (of.top.name(), of.trousers.name());
    let mut words = vec!["the".to_owned()];
    if phrase.names(Property::Motion) {
        words.push(motion(of.kind, of.moves() == Some(true)).to_owned());
    }
    if phrase.names(Property::Top) && !is_dressed {
        words.push(top.to_owned());
    }
    words.push(noun.to_owned());
    match (phrase.names(Property::Top) && is_dressed, phrase.names(Property::Trousers)) {
        (true, true) => words.push(format!("in {} {top} top and {trousers} trousers", article(top))),
        (true, false) => words.push(format!("in {} {top} top", article(top))),
        (false, true) => words.push(format!("in {trousers} trousers")),
        (false, false) => {}
    }
    if phrase.names(Property::Backpack) {
        words.push("with a backpack".to_owned());
    }
    if phrase.names(Property::ShoulderBag) {
        words.push("with a shoulder bag".to_owned());
    }
    if phrase.names(Property::Part) {
        let place = match of.part() {
            Some(Part::Left) => "on the left",
            Some(Part::Right) => "on the right",
            Some(Part::Middle) | None => "in the middle",
        };
        words.push(format!("{place} of the picture"));
    }
    words.join(" ")
}

fn motion(kind: BodyKind, moves: bool) -> &'static str {
    match (kind, moves) {
        (BodyKind::Pedestrian, true) => "walking",
        (BodyKind::Pedestrian, false) => "standing",
        (_, true) => "moving",
        (_, false) => "stationary",
    }
}
