//! Models and boxes agree.

use super::cars;
use super::model::Model;
use super::shapes::{CARS, VANS};
use crate::Clothes;
use crate::body_figure::BodyFigure;
use crate::body_shape::BodyShape;
use crate::region::Region;
use crate::{add_figure, figure_triangles};
use cosfly_domain::{BodyKind, BodyPlan, SemanticLabel};
use cosfly_frames::{DVec3, Seed, TargetState};

/// No corner is farther outside of the box than this, and every side of the box has a corner as near, metres.
const BOUND_M: f64 = 0.01;

/// Most triangles of a car or van.
const MOST_TRIANGLES: usize = 1000;

const KINDS: [(BodyKind, [f64; 3], SemanticLabel); 9] = [
    (BodyKind::EScooter, [1.15, 0.61, 1.87], SemanticLabel::Bicycle),
    (BodyKind::Bicycle, [1.8, 0.65, 1.75], SemanticLabel::Bicycle),
    (BodyKind::Motorcycle, [2.1, 0.8, 1.6], SemanticLabel::Motorcycle),
    (BodyKind::Car, [4.5, 1.85, 1.5], SemanticLabel::Car),
    (BodyKind::Van, [5.4, 2.0, 2.3], SemanticLabel::Car),
    (BodyKind::Truck, [8.5, 2.5, 3.4], SemanticLabel::Truck),
    (BodyKind::Bus, [12.0, 2.55, 3.1], SemanticLabel::Bus),
    (BodyKind::Wheelchair, [1.05, 0.65, 1.32], SemanticLabel::Dynamic),
    (BodyKind::Drone, [0.6, 0.6, 0.2], SemanticLabel::Dynamic),
];

fn vehicle(kind: BodyKind, size_m: DVec3, number: u64) -> BodyFigure {
    let turn = 0.77 * number as f64;
    BodyFigure {
        state: TargetState { feet_in_world: DVec3::new(14.0, -3.0, 1.5), heading_rad: turn, speed_mps: 5.0 },
        height_m: size_m.z,
        radius_m: 0.5 * size_m.y,
        clothes_seed: Seed([9; 32]).child("vehicle", number),
        gait_phase_rad: turn,
        body: BodyShape::of(kind, size_m),
    }
}

#[test]
fn models_fill_their_boxes_and_stay_inside() {
    for (kind, size_m, _) in KINDS {
        for number in 0..40 {
            let mut stream = Seed([1; 32]).child("size", number).stream("size");
            let size_m = DVec3::from_array(size_m.map(|side| side * stream.uniform(0.8, 1.25)));
            let figure = vehicle(kind, size_m, number);
            let plan = BodyPlan { source: String::new(), kind, size_m, looks: figure.clothes_seed, group: None };
            let shape = plan.box_at(&figure.state);
            let (sin, cos) = cosfly_frames::real::sin_cos(shape.yaw_rad);
            let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            for corner in figure_triangles(&figure).into_iter().flatten() {
                let away = corner - shape.center_in_world;
                let own = DVec3::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z);
                (low, high) = (low.min(own), high.max(own));
            }
            let off = (low + shape.half_extents_m).abs().max((high - shape.half_extents_m).abs());
            assert!(off.max_element() < BOUND_M, "{kind:?} {number}: {low} to {high} in {}", shape.half_extents_m);
        }
    }
}

#[test]
fn people_stay_in_the_box_with_what_they_take_along_and_keep_their_label() {
    for (kind, [length_m, width_m]) in [(BodyKind::PushChair, [1.5, 0.7]), (BodyKind::DogWalker, [1.6, 0.92])] {
        for number in 0..60 {
            let size_m = DVec3::new(length_m, width_m, 1.5 + 0.007 * number as f64);
            let mut figure = vehicle(kind, size_m, number);
            (figure.state.heading_rad, figure.state.feet_in_world) = (0.0, DVec3::ZERO);
            let mut triangles = vec![];
            add_figure(&figure, &Clothes::draw(&figure.clothes_seed), 0, &mut triangles);
            for triangle in &triangles {
                for corner in triangle.corners_in_world {
                    let inside = corner.x.abs() <= 0.5 * length_m && corner.y.abs() <= 0.5 * width_m;
                    assert!(inside && (-0.03..size_m.z + 0.01).contains(&corner.z), "{kind:?} {number}: {corner}");
                }
            }
            let labels: std::collections::BTreeSet<_> =
                triangles.iter().map(|it| figure.body.label(it.region)).collect();
            assert_eq!(labels.into_iter().collect::<Vec<_>>(), [SemanticLabel::Pedestrian, SemanticLabel::Dynamic]);
            let leash = triangles.iter().filter(|it| it.region == Region::Trim).flat_map(|it| it.corners_in_world);
            let lowest_m = leash.map(|corner| corner.z).fold(f64::INFINITY, f64::min);
            let hangs = (0.05..0.42).contains(&lowest_m);
            assert!(hangs || kind == BodyKind::PushChair, "{number}: the leash ends {lowest_m} m above the ground");
            let points = crate::key_points(&figure).expect("a person");
            assert!(points.iter().all(|point| point.x < 0.2 && point.z > 0.0 && point.z < size_m.z));
        }
    }
}

#[test]
fn seated_people_stay_in_their_box_stand_on_the_ground_and_keep_their_label() {
    for number in 0..40 {
        let size_m = DVec3::new(1.05, 0.65, 1.25 + 0.00375 * number as f64);
        let mut figure = vehicle(BodyKind::Sitter, size_m, number);
        (figure.state.heading_rad, figure.state.feet_in_world) = (0.0, DVec3::ZERO);
        let mut triangles = vec![];
        add_figure(&figure, &Clothes::draw(&figure.clothes_seed), 0, &mut triangles);
        let corners: Vec<DVec3> = triangles.iter().flat_map(|it| it.corners_in_world).collect();
        let inside =
            |it: &DVec3| it.x.abs() <= 0.525 && it.y.abs() <= 0.325 && (-0.02..size_m.z + 0.01).contains(&it.z);
        assert_eq!(corners.iter().find(|it| !inside(it)), None, "{number}");
        let labels: std::collections::BTreeSet<_> = triangles.iter().map(|it| figure.body.label(it.region)).collect();
        assert_eq!(labels.into_iter().collect::<Vec<_>>(), [SemanticLabel::Pedestrian, SemanticLabel::Dynamic]);
        let people = triangles.iter().filter(|it| it.region.is_of_people()).flat_map(|it| it.corners_in_world);
        let (low, high) =
            people.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), it| (low.min(it.z), high.max(it.z)));
        assert!(low.abs() < 0.03 && high > size_m.z - 0.02, "{number}: {low} to {high} of {}", size_m.z);
    }
}

#[test]
fn faces_look_outward_and_have_the_labels_of_their_kind() {
    for (kind, size_m, label) in KINDS {
        let figure = vehicle(kind, DVec3::from_array(size_m), 3);
        let mut triangles = vec![];
        add_figure(&figure, &Clothes::draw(&figure.clothes_seed), 0, &mut triangles);
        let labels: std::collections::BTreeSet<_> = triangles.iter().map(|it| figure.body.label(it.region)).collect();
        let is_ridden =
            matches!(kind, BodyKind::Bicycle | BodyKind::EScooter | BodyKind::Motorcycle | BodyKind::Wheelchair);
        assert!(labels.contains(&label), "{kind:?}");
        assert_eq!(labels.contains(&SemanticLabel::Rider), is_ridden, "{kind:?}");
        assert_eq!(labels.len(), 1 + usize::from(is_ridden));
        for triangle in &triangles {
            let [a, b, c] = triangle.corners_in_world;
            let normal = triangle.normal_in_world;
            assert!((normal.length() - 1.0).abs() < 1e-9, "{kind:?} {:?}", triangle.region);
            assert!(normal.dot(b - a).abs() < 1e-6 && normal.dot(c - a).abs() < 1e-6, "{kind:?} {:?}", triangle.region);
        }
        // Windows of cabins look away from the middle; the lens of a drone is a body of its own.
        if !is_ridden && kind != BodyKind::Drone {
            let middle = figure.state.feet_in_world + DVec3::Z * (0.5 * size_m[2]);
            let wrong = triangles.iter().filter(|it| {
                it.region == Region::Glass && it.normal_in_world.dot(it.corners_in_world[0] - middle) <= 0.0
            });
            assert_eq!(wrong.count(), 0, "{kind:?}");
        }
    }
}

#[test]
fn every_shape_stays_in_its_box_is_round_and_has_few_triangles() {
    const SIZES_M: [[f64; 3]; 3] = [[3.6, 1.66, 1.42], [4.85, 1.9, 1.68], [5.9, 2.05, 2.55]];
    for (number, shape) in CARS.iter().chain(&VANS).enumerate() {
        let share: f64 = shape.sections.windows(2).map(|pair| f64::from(u8::from(pair[0].x < pair[1].x))).sum();
        assert_eq!(share as usize + 1, shape.sections.len(), "{number}: from tail to nose");
        for size_m in SIZES_M.map(DVec3::from_array) {
            let mut figure = vehicle(BodyKind::Car, size_m, 0);
            figure.state.feet_in_world = DVec3::ZERO;
            let mut triangles = vec![];
            let mut looks = figure.clothes_seed.stream("shape");
            cars::car(&mut Model::new(&figure, size_m, 0, &mut triangles), shape, 1.3, &mut looks);
            assert!(triangles.len() <= MOST_TRIANGLES, "{number}: {} triangles", triangles.len());
            for triangle in &triangles {
                for corner in triangle.corners_in_world {
                    let half = 0.5 * size_m + 1e-9;
                    let inside = corner.x.abs() <= half.x && corner.y.abs() <= half.y;
                    assert!(inside && (-1e-9..=size_m.z + 1e-9).contains(&corner.z), "{number}: {corner}");
                }
                for [x, y, z] in triangle.corner_normals.map(|normal| normal.map(f64::from)) {
                    let normal = DVec3::new(x, y, z);
                    let cosine = normal.dot(triangle.normal_in_world);
                    assert!((normal.length() - 1.0).abs() < 1e-5 && cosine > 0.39, "{number}: {cosine}");
                }
            }
        }
    }
}

#[test]
fn cars_of_all_sizes_have_several_shapes() {
    for (kind, least) in [(BodyKind::Car, 7), (BodyKind::Van, 3)] {
        let sizes_m = kind.row().driving.as_ref().expect("it drives").sizes_m;
        let mut drawn = std::collections::BTreeSet::new();
        for number in 0..400 {
            let mut random = Seed([4; 32]).child("size", number).stream("size");
            let size_m = DVec3::from_array(sizes_m.map(|[low, high]| random.uniform(low, high)));
            let shape = cars::shape(kind, size_m, &mut Seed([5; 32]).child("car", number).stream("shape"));
            let fits = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
            assert!(fits(shape.lengths_m, size_m.x) && fits(shape.heights_m, size_m.z), "{kind:?} {size_m}");
            drawn.insert(std::ptr::from_ref(shape) as usize);
        }
        assert!(drawn.len() >= least, "{kind:?}: {}", drawn.len());
    }
}

#[test]
fn cars_have_the_bodies_of_real_traffic() {
    let sizes_m = BodyKind::Car.row().driving.as_ref().expect("it drives").sizes_m;
    let mut counts = [0; CARS.len()];
    for number in 0..4000 {
        let mut random = Seed([4; 32]).child("size", number).stream("size");
        let size_m = DVec3::from_array(sizes_m.map(|[low, high]| random.uniform(low, high)));
        let drawn = cars::shape(BodyKind::Car, size_m, &mut Seed([5; 32]).child("car", number).stream("shape"));
        counts[CARS.iter().position(|shape| shape.axles == drawn.axles).expect("a shape of the list")] += 1;
    }
    let [hatchback, saloon, _, off_road, ..] = counts;
    assert!([hatchback, saloon, off_road].iter().all(|count| (880..1120).contains(count)), "{counts:?}");
    // Panes at the tail lean: seen from behind and above, they are dark between roof and boot.
    for (number, shape) in CARS.iter().enumerate() {
        let pane = shape.sections.windows(2).find(|pair| pair[0].regions[2] == Region::Glass).expect("a rear pane");
        let (deep_m, high_m) = (4.4 * (pane[1].x - pane[0].x), 1.5 * (pane[1].top - pane[0].top));
        let is_upright = deep_m < high_m / 2.0;
        assert_eq!(is_upright, [5, 6].contains(&number), "{number}: {deep_m} {high_m}");
    }
}

#[test]
fn lamps_bumpers_and_signs_are_on_the_sheet() {
    let mut signed = 0;
    for (kind, size_m, _) in KINDS {
        for number in 0..60 {
            let fittings = crate::Fittings::of(&vehicle(kind, DVec3::from_array(size_m), number));
            let (sign, [inner, low, high]) = (fittings.sign, fittings.tail_lamps);
            signed += u32::from(kind == BodyKind::Truck && sign.word[0] < 1.0);
            if matches!(kind, BodyKind::Car | BodyKind::Van) {
                assert!((0.0..0.8).contains(&inner) && 0.1 < low && low < high && high < 0.7, "{kind:?} {number}");
                assert!(fittings.skirt < fittings.rear_plate && fittings.skirt < high, "{kind:?} {number}");
            }
            match kind {
                BodyKind::Truck | BodyKind::Van => {}
                BodyKind::Bus => assert!(sign.band[0] > 0.0 && sign.word[0] > 1.0),
                _ => assert!(sign.band[1] < 0.0 && sign.word[0] > 1.0, "{kind:?} {number}"),
            }
        }
    }
    assert!((30..50).contains(&signed), "{signed}");
}

#[test]
fn boxes_of_lorries_have_doors_and_tanks_have_none() {
    let mut boxed = 0;
    for number in 0..60 {
        let lorry = vehicle(BodyKind::Truck, DVec3::new(8.5, 2.5, 3.4), number);
        let mut triangles = vec![];
        add_figure(&lorry, &Clothes::draw(&lorry.clothes_seed), 0, &mut triangles);
        // A box has six sides.
        let is_box = triangles.iter().filter(|it| it.region == Region::Cargo).count() == 12;
        assert_eq!(crate::Fittings::of(&lorry).has_rear_doors, is_box, "{number}");
        boxed += u32::from(is_box);
    }
    assert!((25..48).contains(&boxed), "{boxed}");
}

#[test]
fn a_size_that_is_none_is_not_drawn() {
    for size_m in [[4.0, 0.0, 1.5], [f64::NAN, 2.0, 1.5], [400.0, 2.0, 1.5]] {
        assert!(figure_triangles(&vehicle(BodyKind::Car, DVec3::from_array(size_m), 1)).is_empty());
    }
}
