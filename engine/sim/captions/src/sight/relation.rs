//! The relation that singles a target out in a picture.

use super::facts::{Near, PlaceAmong, SeenTarget, Side};
use crate::part::PicturePart;
use cosfly_domain::Colour;

/// More people are not counted in words.
const MOST_COUNTED: usize = 6;

/// A relation that singles the target out.
pub(super) enum Relation {
    /// Ahead of, behind or beside one person.
    One(PlaceAmong, Colour),
    /// Ahead of, behind or beside several people.
    Several(PlaceAmong, usize),
    /// The only person in the picture.
    Alone,
    /// Outermost of so many people.
    Outermost(Side, usize),
    /// Nearest to the camera.
    Nearest,
    /// In a part of the picture.
    In(PicturePart),
}

/// The relation that singles the target out best: people who walk along, then all people, then the place in the picture.
pub(super) fn relation(seen: &SeenTarget) -> Option<Relation> {
    let near = PlaceAmong::ALL.into_iter().zip(&seen.near).find_map(|(place, near)| along(place, near));
    let outermost = seen.side.zip(seen.people.filter(|count| *count <= MOST_COUNTED));
    near.or_else(|| (seen.people == Some(1)).then_some(Relation::Alone))
        .or_else(|| outermost.map(|(side, count)| Relation::Outermost(side, count)))
        .or_else(|| seen.is_nearest.then_some(Relation::Nearest))
        .or_else(|| seen.part.map(Relation::In))
}

fn along(place: PlaceAmong, near: &Near) -> Option<Relation> {
    match near.tops[..] {
        _ if !near.is_clear => None,
        [] => None,
        [top] => Some(Relation::One(place, top)),
        _ if near.tops.len() <= MOST_COUNTED => Some(Relation::Several(place, near.tops.len())),
        _ => None,
    }
}
