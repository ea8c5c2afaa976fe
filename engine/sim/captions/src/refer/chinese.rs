//! Chinese referring phrases.

use super::phrase::{Phrase, Property};
use crate::chinese::colour;
use crate::part::Part;
use cosfly_domain::{BodyKind, BodyKindRow};

/// `画面左侧正在行走、穿红色上衣、蓝色裤子、背着背包的人`.
pub(super) fn text(phrase: &Phrase) -> String {
    let of = &phrase.of;
    let BodyKindRow { is_dressed, words: names, .. } = of.kind.row();
    let (noun, is_dressed) = (names.chinese, *is_dressed);
    let mut said: Vec<String> = vec![];
    if phrase.names(Property::Motion) {
        said.push(motion(of.kind, of.moves() == Some(true)).to_owned());
    }
    match (phrase.names(Property::Top), phrase.names(Property::Trousers)) {
        (true, _) if !is_dressed => said.push(colour(of.top).to_owned()),
        (true, true) => said.push(format!("穿{}上衣、{}裤子", colour(of.top), colour(of.trousers))),
        (true, false) => said.push(format!("穿{}上衣", colour(of.top))),
        (false, true) => said.push(format!("穿{}裤子", colour(of.trousers))),
        (false, false) => {}
    }
    if phrase.names(Property::Backpack) {
        said.push("背着背包".to_owned());
    }
    if phrase.names(Property::ShoulderBag) {
        said.push("挎着单肩包".to_owned());
    }
    let place = phrase.names(Property::Part).then(|| match of.part() {
        Some(Part::Left) => "画面左侧",
        Some(Part::Right) => "画面右侧",
        Some(Part::Middle) | None => "画面中间",
    });
    match (place, said.join("、")) {
        (None, said) if said.is_empty() => match is_dressed {
            true => format!("那个{noun}"),
            false => format!("那辆{noun}"),
        },
        (Some(place), said) if said.is_empty() => format!("{place}的{noun}"),
        (place, said) => format!("{}{said}的{noun}", place.unwrap_or_default()),
    }
}

fn motion(kind: BodyKind, moves: bool) -> &'static str {
    match (kind, moves) {
        (BodyKind::Pedestrian, true) => "正在行走",
        (BodyKind::Pedestrian, false) => "站着不动",
        (_, true) => "正在行驶",
        (_, false) => "停着不动",
    }
}
