//! Relations of a person to landmarks that a picture shows: passing a tree, approaching a street lamp, in front of a building.

use super::landmarks::{LandmarkKind, Landmarks, way_to};
use super::view::{STANDS_M, SeenPerson, WALKS_M, WindowView};
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, real};

/// Slowest walk of somebody who passes or approaches a landmark, m/s.
const WALKS_MPS: f64 = 0.3;
/// Largest angle between the walking direction and the way over the input, degrees: a turn has no "ahead".
const STRAIGHT_DEG: f64 = 35.0;
/// Who passes a landmark has it at most this far before or behind, and this far aside, metres.
const PASSES_M: [f64; 2] = [1.5, 3.5];
/// Who approaches a landmark has it this far ahead, and at most so far aside, metres.
const APPROACHES_M: [f64; 2] = [2.5, 8.0];
const APPROACHES_ASIDE_M: f64 = 1.5;
/// Who stands beside a landmark is at most this far away, metres.
const BESIDE_M: f64 = 2.5;
/// A relation is said of no landmark that has another of its kind within the relation and this much around it, metres.
const APART_M: f64 = 2.0;
/// A building behind the target is no farther from it than this, metres, and is seen above the ground.
const IN_FRONT_M: f64 = 10.0;
const ABOVE_GROUND_M: f64 = 0.3;
/// Middle of a body above its feet, metres.
const MIDDLE_M: f64 = 0.9;
/// A landmark begins at most this far above or below the feet, metres.
const LEVEL_M: f64 = 3.0;
/// Share of points of a landmark that the camera sees, at least.
const SEEN_SHARE: f64 = 0.4;
/// Border of the picture in which nothing counts as seen, as a share of its width or height.
const BORDER: f64 = 0.04;
/// Smallest size of a landmark in the picture and smallest width of its box, pixels.
const SMALLEST_PX: f64 = 12.0;
const THINNEST_PX: f64 = 1.5;
/// A landmark beside the target in the picture is this far from its box, as a share of the picture's width.
const ASIDE: f64 = 0.01;

/// How the target is placed to a landmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// Walks past it.
    Passes,
    /// Walks up to it.
    Approaches,
    /// Stands next to it.
    NextTo,
    /// Is in front of it, as the camera sees it.
    InFront,
}

/// Side on which a landmark is, both for the target and in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum OnSide {
    Left,
    Right,
}

/// A landmark that the picture shows, and the target's place to it. No other thing of its kind and no other person in the
/// picture is in the same relation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NearLandmark {
    /// The relation.
    pub beside: Beside,
    /// Kind of the landmark.
    pub kind: LandmarkKind,
    /// Side; `None` where target and picture differ, or neither is clear.
    pub side: Option<OnSide>,
}

/// All landmarks that single the target out in a picture, the best first.
pub(super) fn near_landmarks(view: &WindowView, landmarks: &Landmarks) -> Vec<NearLandmark> {
    let around = landmarks.around(view.target.feet_in_world, APPROACHES_M[1] + APART_M);
    let mut found = vec![];
    for beside in [Beside::Passes, Beside::NextTo, Beside::Approaches] {
        for kind in LandmarkKind::ALL.into_iter().filter(|kind| *kind != LandmarkKind::Building) {
            let of_kind = || around.iter().filter(move |(it, ..)| *it == kind);
            let holds = |person: &SeenPerson, shape: &OrientedBox, more_m: f64| {
                is_there(person, beside, shape, more_m) && is_moved_so(view, beside)
            };
            let mut there = of_kind().filter(|(_, _, shape)| holds(&view.target, shape, APART_M));
            let (Some((_, object, shape)), None) = (there.next(), there.next()) else { continue };
            let is_level = (bottom_m(shape) - view.target.feet_in_world.z).abs() <= LEVEL_M;
            let is_shared = view.others.iter().any(|other| is_there(other, beside, shape, 0.5));
            if is_level && holds(&view.target, shape, 0.0) && !is_shared && is_seen(view, landmarks, *object, shape) {
                let side = if beside == Beside::Passes { side(view, shape) } else { None };
                found.push(NearLandmark { beside, kind, side });
            }
        }
    }
    let building = building_behind(view, landmarks, &view.target);
    if building.is_some() && view.others.iter().all(|other| building_behind(view, landmarks, other) != building) {
        found.push(NearLandmark { beside: Beside::InFront, kind: LandmarkKind::Building, side: None });
    }
    found
}

/// Whether somebody is in a relation to a landmark; `more_m` widens it.
fn is_there(person: &SeenPerson, beside: Beside, shape: &OrientedBox, more_m: f64) -> bool {
    let way = way_to(shape, person.feet_in_world);
    let (before_m, aside_m) = along(person.heading_rad, way);
    let walks = person.speed_mps >= WALKS_MPS;
    match beside {
        Beside::Passes => walks && before_m.abs() <= PASSES_M[0] + more_m && aside_m.abs() <= PASSES_M[1] + more_m,
        Beside::Approaches => {
            let ahead = APPROACHES_M[0] - more_m..=APPROACHES_M[1] + more_m;
            walks && ahead.contains(&before_m) && aside_m.abs() <= APPROACHES_ASIDE_M + more_m
        }
        Beside::NextTo => way.length() <= BESIDE_M + more_m,
        Beside::InFront => false,
    }
}

/// Whether the target's way over the input goes with the relation.
fn is_moved_so(view: &WindowView, beside: Beside) -> bool {
    let moved = view.moved_in_world.truncate();
    if beside == Beside::NextTo {
        return moved.length() < STANDS_M;
    }
    let turned_rad = real::wrap_angle_rad(real::atan2(moved.y, moved.x) - view.target.heading_rad);
    moved.length() >= WALKS_M && turned_rad.to_degrees().abs() <= STRAIGHT_DEG
}

/// A way on the ground along a heading and to its right, metres.
fn along(heading_rad: f64, way: DVec2) -> (f64, f64) {
    let (sin, cos) = real::sin_cos(heading_rad);
    (cos * way.x + sin * way.y, cos * way.y - sin * way.x)
}

fn bottom_m(shape: &OrientedBox) -> f64 {
    shape.center_in_world.z - shape.half_extents_m.z
}

/// Whether the picture shows enough of an object, whose place is `shape`.
fn is_seen(view: &WindowView, landmarks: &Landmarks, object: u32, shape: &OrientedBox) -> bool {
    let size = DVec2::new(f64::from(view.optics.width), f64::from(view.optics.height));
    let (mut points, mut seen) = (0, 0);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let Some((.., depth_m)) = view.project(shape.center_in_world) else { return false };
    let width_m = 2.0 * shape.half_extents_m.truncate().max_element();
    if view.optics.focal_px() * width_m / depth_m < THINNEST_PX {
        return false;
    }
    for part in landmarks.boxes_of(object) {
        for share in [-0.7, 0.0, 0.7] {
            points += 1;
            let point = part.center_in_world + share * part.half_extents_m.z * DVec3::Z;
            let Some((u, v, _)) = view.project(point) else { continue };
            let (at, border) = (DVec2::new(u, v), BORDER * size);
            let is_inside = at.cmpge(border).all() && at.cmple(size - border).all();
            let first = landmarks.first_between(view.camera.position_in_world, point);
            if is_inside && first.is_none_or(|(_, it, _)| it == object) {
                seen += 1;
                (low, high) = (low.min(at), high.max(at));
            }
        }
    }
    f64::from(seen) >= (SEEN_SHARE * f64::from(points)).max(2.0) && (high - low).max_element() >= SMALLEST_PX
}

/// The side on which the target passes a landmark, where the picture shows the same one.
fn side(view: &WindowView, shape: &OrientedBox) -> Option<OnSide> {
    let (_, right_m) = along(view.target.heading_rad, way_to(shape, view.target.feet_in_world));
    let beside = shape.center_in_world.with_z(view.target.feet_in_world.z + MIDDLE_M);
    let ((u, ..), edges) = (view.project(beside)?, view.target.box_px?);
    let aside_px = ASIDE * f64::from(view.optics.width);
    match () {
        () if right_m < -0.3 && u < edges[0] - aside_px => Some(OnSide::Left),
        () if right_m > 0.3 && u > edges[2] + aside_px => Some(OnSide::Right),
        () => None,
    }
}

/// The building that the camera sees right behind somebody as the first thing there, and to both sides of it.
fn building_behind(view: &WindowView, landmarks: &Landmarks, person: &SeenPerson) -> Option<u32> {
    let eye = view.camera.position_in_world;
    let middle = person.feet_in_world + MIDDLE_M * DVec3::Z;
    let ahead = (middle - eye).truncate().try_normalize()?;
    let aside = 0.6 * DVec3::new(-ahead.y, ahead.x, 0.0);
    let [left, middle, right] = [-1.0, 0.0, 1.0].map(|side| {
        let from = middle + side * aside;
        let to = from + (from - eye).normalize_or_zero() * IN_FRONT_M;
        let (kind, object, hit) = landmarks.first_between(from, to)?;
        let is_above = hit.z >= person.feet_in_world.z + ABOVE_GROUND_M;
        (kind == Some(LandmarkKind::Building) && is_above).then_some(object)
    });
    middle.filter(|_| left == middle && middle == right)
}

#[cfg(test)]
mod tests {
    use super::super::test_views::{person, town, view};
    use super::*;
    use cosfly_domain::Colour::{Black, Red};

    fn found(target: SeenPerson, others: Vec<SeenPerson>) -> Option<NearLandmark> {
        near_landmarks(&view(target, others), &town()).first().copied()
    }

    #[test]
    fn the_relations_are_those_of_the_ground_and_the_picture() {
        let landmark = |beside, kind, side| Some(NearLandmark { beside, kind, side });
        let still = SeenPerson { speed_mps: 0.0, ..person(12.0, 5.5, 0.0, Red) };
        for (target, expected) in [
            (person(12.0, 4.5, 0.0, Red), landmark(Beside::Passes, LandmarkKind::Tree, Some(OnSide::Right))),
            (person(12.0, 9.5, 0.0, Red), landmark(Beside::Passes, LandmarkKind::Tree, Some(OnSide::Left))),
            // The tree is on the left of the target and on its right in the picture.
            (person(12.0, 4.5, 180.0, Red), landmark(Beside::Passes, LandmarkKind::Tree, None)),
            (person(12.0, 3.0, 90.0, Red), landmark(Beside::Approaches, LandmarkKind::Tree, None)),
            (person(12.0, -4.0, 0.0, Red), landmark(Beside::Approaches, LandmarkKind::Lamp, None)),
            (still, landmark(Beside::NextTo, LandmarkKind::Tree, None)),
            (person(16.7, 3.0, 90.0, Red), landmark(Beside::InFront, LandmarkKind::Building, None)),
            (person(12.0, 0.0, 0.0, Red), None),
        ] {
            assert_eq!(found(target, vec![]), expected, "{target:?}");
        }
    }

    #[test]
    fn a_relation_that_another_person_is_in_is_not_said() {
        let target = person(12.0, 4.5, 0.0, Red);
        assert!(found(target, vec![person(12.5, 9.0, 180.0, Black)]).is_none());
        assert!(found(target, vec![person(20.0, 9.0, 180.0, Black)]).is_some());
    }

    #[test]
    fn a_landmark_that_is_hidden_or_out_of_the_picture_is_not_said() {
        let mut view = view(person(12.0, 4.5, 0.0, Red), vec![]);
        let is_said = |view: &WindowView| !near_landmarks(view, &town()).is_empty();
        assert!(is_said(&view));
        view.camera.yaw_rad -= 0.4;
        assert!(!is_said(&view));
        view.camera.yaw_rad += 0.4;
        // Behind the building.
        view.camera.position_in_world.x += 40.0;
        view.camera.yaw_rad += std::f64::consts::PI;
        assert!(!is_said(&view));
    }
}
