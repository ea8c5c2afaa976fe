//! Facts of one picture, from what is visible in it: pixels of the target and of bystanders, and their places in the world.
//!
//! A fact that a person who sees the picture could dispute is left out: people of a few pixels make no counts, and
//! directions near a border have no name.

use super::beside::{NearLandmark, near_landmarks};
use super::landmarks::Landmarks;
use super::view::{STANDS_M, SeenPerson, WALKS_M, WindowView};
use crate::facts::{Wear, runs};
use crate::part::PicturePart;
use cosfly_domain::{BodyKind, Colour};
use cosfly_frames::real;

/// A way within this angle of a direction of the picture has its name, degrees.
const ACROSS_DEG: f64 = 30.0;
/// In a picture that looks down more steeply, "away" and "towards" mean little, degrees.
const STEEP_DEG: f64 = 70.0;
/// Someone who walks within this angle of the target's direction walks along, degrees.
const ALONG_DEG: f64 = 30.0;
/// Slowest walk of somebody who walks along, m/s.
const ALONG_MPS: f64 = 0.3;
/// Someone who walks along within this distance is near, metres.
const NEAR_M: f64 = 6.0;
/// Someone who is not farther than this before or behind the target is beside it, metres.
const BESIDE_M: f64 = 0.7;
/// Largest distance across the way, metres.
const ASIDE_M: f64 = 1.8;
/// Factor on all limits: where people are near only by wider ones, nobody can say whether they are, and no text does.
const BORDER: f64 = 1.3;
/// The nearest person is nearer than all others by this factor at least.
const NEARER: f64 = 1.25;
/// The outermost person is this far from the next one at least, as a share of the picture's width.
const OUTER: f64 = 0.03;

/// Way across the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Across {
    Away,
    Towards,
    ToTheLeft,
    ToTheRight,
    Stands,
}

/// Side on which the target is outermost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Side {
    Leftmost,
    Rightmost,
}

/// Place of the target relative to people who walk along with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum PlaceAmong {
    Ahead,
    Behind,
    Beside,
}

impl PlaceAmong {
    /// All places, in the order of [`SeenTarget::near`].
    pub const ALL: [Self; 3] = [Self::Ahead, Self::Behind, Self::Beside];
}

/// The people of whom the target is ahead, or whom it is behind or beside.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Near {
    /// Colours of their shirts or jackets.
    pub tops: Vec<Colour>,
    /// Whether all of them are clear in the picture and nobody is at the border of being near; else nothing is said of them.
    pub is_clear: bool,
}

/// Facts of a picture that shows the target.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenTarget {
    /// Way across the picture; `None` between two directions, and for a target that is not clear.
    pub across: Option<Across>,
    /// Part of the picture; `None` near a border.
    pub part: Option<PicturePart>,
    /// Number of people in the picture, with the target; `None` where somebody is not clear.
    pub people: Option<usize>,
    /// Side on which the target is outermost of all people.
    pub side: Option<Side>,
    /// Whether the target is the one nearest to the camera of at least two.
    pub is_nearest: bool,
    /// People who walk along, in the order of [`PlaceAmong::ALL`].
    pub near: [Near; 3],
    /// Landmarks that single the target out, the best first.
    pub landmarks: Vec<NearLandmark>,
}

/// Facts of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Sight {
    /// Clothes of the target.
    pub wear: Option<Wear>,
    /// Whether the target runs.
    pub runs: bool,
    /// Facts of the picture; `None` where it shows no pixel of the target.
    pub seen: Option<SeenTarget>,
}

/// Facts of the picture in a town with these landmarks.
pub fn sight(view: &WindowView, landmarks: &Landmarks) -> Sight {
    let runs = runs(view.kind == BodyKind::Runner, view.target.speed_mps);
    Sight { wear: view.wear, runs, seen: view.target.box_px.map(|_| seen(view, landmarks)) }
}

fn seen(view: &WindowView, landmarks: &Landmarks) -> SeenTarget {
    let (target, width_px) = (&view.target, f64::from(view.optics.width));
    let at = target.across(width_px);
    let all_clear = target.is_clear() && view.others.iter().all(SeenPerson::is_clear);
    let others = || view.others.iter().map(|other| other.across(width_px));
    let side = match () {
        () if !all_clear || view.others.is_empty() => None,
        () if others().all(|other| at + OUTER < other) => Some(Side::Leftmost),
        () if others().all(|other| at - OUTER > other) => Some(Side::Rightmost),
        () => None,
    };
    let distance_m = |person: &SeenPerson| person.feet_in_world.distance(view.camera.position_in_world);
    let is_nearest = target.is_clear()
        && view.others.iter().any(SeenPerson::is_clear)
        && view.others.iter().all(|other| distance_m(other) > NEARER * distance_m(target));
    SeenTarget {
        across: across(view).filter(|_| target.is_clear()),
        part: PicturePart::at(at),
        people: all_clear.then_some(view.others.len() + 1),
        side,
        is_nearest,
        near: PlaceAmong::ALL.map(|place| near(view, place)),
        landmarks: if target.is_clear() { near_landmarks(view, landmarks) } else { vec![] },
    }
}

/// The direction of the picture in which the target moved over the input.
fn across(view: &WindowView) -> Option<Across> {
    let moved_m = real::hypot(view.moved_in_world.x, view.moved_in_world.y);
    if moved_m < STANDS_M {
        return Some(Across::Stands);
    }
    if moved_m < WALKS_M {
        return None;
    }
    let walked_rad = real::atan2(view.moved_in_world.y, view.moved_in_world.x);
    let turned_deg = real::wrap_angle_rad(walked_rad - view.camera.yaw_rad).to_degrees();
    let is_steep = view.camera.pitch_rad.to_degrees().abs() > STEEP_DEG;
    match turned_deg {
        right if (right - 90.0).abs() <= ACROSS_DEG => Some(Across::ToTheRight),
        left if (left + 90.0).abs() <= ACROSS_DEG => Some(Across::ToTheLeft),
        _ if is_steep => None,
        away if away.abs() <= ACROSS_DEG => Some(Across::Away),
        towards if towards.abs() >= 180.0 - ACROSS_DEG => Some(Across::Towards),
        _ => None,
    }
}

/// The people who walk along with the target and of whom it is at `place`.
fn near(view: &WindowView, place: PlaceAmong) -> Near {
    let target = &view.target;
    let mut near = Near { tops: vec![], is_clear: true };
    if target.speed_mps < ALONG_MPS {
        return near;
    }
    let (sin, cos) = real::sin_cos(target.heading_rad);
    for other in &view.others {
        let turned_deg = real::wrap_angle_rad(other.heading_rad - target.heading_rad).to_degrees().abs();
        let apart = other.feet_in_world - target.feet_in_world;
        let (before_m, aside_m) = (cos * apart.x + sin * apart.y, (cos * apart.y - sin * apart.x).abs());
        // `wider` holds of people at the border, too.
        let is_near = |wider: f64| {
            let is_there = match place {
                PlaceAmong::Ahead => before_m < -BESIDE_M / wider,
                PlaceAmong::Behind => before_m > BESIDE_M / wider,
                PlaceAmong::Beside => before_m.abs() <= BESIDE_M * wider,
            };
            let is_along = turned_deg <= ALONG_DEG * wider && other.speed_mps >= ALONG_MPS / wider;
            is_along && is_there && before_m.abs() <= NEAR_M * wider && aside_m <= ASIDE_M * wider
        };
        if is_near(1.0) {
            near.tops.push(other.top);
            near.is_clear &= other.is_clear();
        } else if is_near(BORDER) {
            near.is_clear = false;
        }
    }
    near
}

#[cfg(test)]
mod tests {
    use super::super::test_views::{person, town, view, views};
    use super::*;

    fn seen_in(number: usize) -> SeenTarget {
        sight(&views()[number], &town()).seen.expect("it is seen")
    }

    #[test]
    fn the_facts_are_those_of_the_picture() {
        assert_eq!(
            [0, 1, 2, 3, 9].map(|number| seen_in(number).across),
            [Some(Across::Away), None, Some(Across::Towards), Some(Across::ToTheRight), Some(Across::Stands),]
        );
        assert_eq!(
            [0, 11, 13].map(|number| seen_in(number).part),
            [Some(PicturePart::Middle), Some(PicturePart::Left), Some(PicturePart::Right)]
        );
        assert_eq!([0, 2, 3].map(|number| seen_in(number).people), [Some(1), Some(2), Some(3)]);
        assert_eq!([0, 2, 3].map(|number| seen_in(number).side), [None, Some(Side::Leftmost), Some(Side::Rightmost)]);
        assert_eq!([0, 2, 4].map(|number| seen_in(number).is_nearest), [false, true, false]);
        let tops = |number: usize| seen_in(number).near.map(|near| near.tops);
        assert_eq!(tops(5), [vec![Colour::Black, Colour::Green], vec![], vec![]]);
        assert_eq!(tops(6), [vec![], vec![Colour::Purple], vec![]]);
        assert_eq!(tops(7), [vec![], vec![], vec![Colour::Beige]]);
        assert_eq!(sight(&views()[10], &town()).seen, None);
    }

    #[test]
    fn people_of_a_few_pixels_make_no_counts() {
        let far = seen_in(8);
        assert_eq!((far.people, far.side), (None, None));
        assert!(far.near[2].is_clear, "the one beside the target is clear");
        let target = person(12.0, 0.0, 0.0, Colour::Red);
        let faint = SeenPerson { pixels: 5, ..person(10.0, 0.0, 0.0, Colour::Black) };
        assert!(!sight(&view(target, vec![faint]), &town()).seen.expect("it is seen").near[0].is_clear);
    }

    #[test]
    fn runners_run_from_a_lower_pace_on_than_others() {
        let runs = |kind: BodyKind, speed_mps: f64| {
            let target = SeenPerson { speed_mps, ..person(10.0, 0.0, 0.0, Colour::Black) };
            sight(&WindowView { kind, ..view(target, vec![]) }, &town()).runs
        };
        let paces_mps = [0.0, 0.9, 1.9, 2.5];
        assert_eq!(paces_mps.map(|it| runs(BodyKind::Pedestrian, it)), [false, false, false, true]);
        assert_eq!(paces_mps.map(|it| runs(BodyKind::Runner, it)), [false, false, true, true]);
    }
}
