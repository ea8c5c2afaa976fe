//! Covers of footprints and boxes of buildings against a slow oracle: points of the footprint lie in boxes, and
//! points in boxes lie near the footprint.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, Seed, real};
use cosfly_town::cover::{
    COVER_TOLERANCE_M, Cover, LOOSE_TOLERANCE_M, MOST, TurnedRectangle, cover_polygon, cover_rings,
};
use cosfly_town::polygons::contains;
use cosfly_town::solids::{Footprint, ROOF_STEP_M, Roof, SolidBoxes, building_boxes};
use proptest::prelude::*;

/// A simple ring around `center`: corners at equal angles, each at its own distance.
fn star(center: DVec2, distances_m: &[f64]) -> Vec<DVec2> {
    let step_rad = real::TAU / distances_m.len() as f64;
    let corner = |(index, distance_m): (usize, &f64)| {
        let (sin, cos) = real::sin_cos(step_rad * index as f64);
        center + *distance_m * DVec2::new(cos, sin)
    };
    distances_m.iter().enumerate().map(corner).collect()
}

fn ring(corners: &[(f64, f64)]) -> Vec<DVec2> {
    corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
}

fn rectangle(low: (f64, f64), high: (f64, f64)) -> Vec<DVec2> {
    ring(&[low, (high.0, low.1), high, (low.0, high.1)])
}

fn turned(ring: &[DVec2], angle_rad: f64) -> Vec<DVec2> {
    ring.iter().map(|corner| DVec2::from_angle(angle_rad).rotate(*corner)).collect()
}

/// Even-odd over all rings.
fn inside(rings: &[&[DVec2]], point: DVec2) -> bool {
    rings.iter().filter(|ring| contains(ring, point)).count() % 2 == 1
}

fn distance_m(rings: &[&[DVec2]], point: DVec2) -> f64 {
    if inside(rings, point) {
        return 0.0;
    }
    let sides = rings.iter().flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
    let to_side = |(a, b): (DVec2, DVec2)| {
        let share = ((point - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
        point.distance(a.lerp(b, share))
    };
    sides.map(to_side).fold(f64::INFINITY, f64::min)
}

fn covered(cover: &[TurnedRectangle], point: DVec2) -> bool {
    cover.iter().any(|one| {
        let local = DVec2::from_angle(-one.yaw_rad).rotate(point - one.center).abs();
        local.cmple(one.half_extents_m + 1e-9).all()
    })
}

/// Asserts both halves of the contract at points of a grid of `count` steps across.
fn check_grid(name: &str, rings: &[&[DVec2]], count: i32, overhang_m: f64) -> usize {
    let Cover { rectangles: cover, coarse } = cover_rings(&rings[..1], &rings[1..]);
    assert_eq!(coarse, None, "{name}");
    let corners = || rings.iter().copied().flatten().copied();
    let low = corners().fold(DVec2::INFINITY, DVec2::min) - 2.0;
    let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max) + 2.0;
    for i in 0..=count {
        for j in 0..=count {
            let share = DVec2::new(f64::from(i), f64::from(j)) / f64::from(count);
            let point = low + share * (high - low) + 0.00137;
            let is_covered = covered(&cover, point);
            assert!(is_covered || !inside(rings, point), "{name}: {point} is not covered");
            let far_m = if is_covered { distance_m(rings, point) } else { 0.0 };
            assert!(far_m <= overhang_m + 1e-6, "{name}: {point} is covered but {far_m} m away");
        }
    }
    cover.len()
}

fn check_cover(name: &str, corners: &[(f64, f64)], at_most: usize, overhang_m: f64) {
    for angle_rad in [0.0, 0.3, 1.9] {
        let outline = turned(&ring(corners), angle_rad);
        let count = check_grid(name, &[&outline], 240, overhang_m);
        assert!((1..=at_most).contains(&count), "{name}: {count} rectangles");
    }
}

const L_SHAPE: [(f64, f64); 6] = [(0.0, 0.0), (20.0, 0.0), (20.0, 6.0), (6.0, 6.0), (6.0, 15.0), (0.0, 15.0)];

#[test]
fn covers_contain_the_polygon_and_stay_within_the_tolerance() {
    let tight_m = COVER_TOLERANCE_M;
    check_cover("rectangle", &[(0.0, 0.0), (8.0, 6.0), (5.0, 10.0), (-3.0, 4.0)], 1, tight_m);
    check_cover("L", &L_SHAPE, 2, tight_m);
    let comb = [(0.0, 0.0), (20.0, 0.0), (20.0, 9.0), (15.0, 9.0), (15.0, 4.0), (5.0, 4.0), (5.0, 9.0), (0.0, 9.0)];
    check_cover("U", &comb, 3, tight_m);
    check_cover("triangle", &[(0.0, 0.0), (12.0, 3.0), (4.0, 10.0)], 20, LOOSE_TOLERANCE_M);
    check_cover("chevron", &[(0.0, 0.0), (10.0, 4.0), (20.0, 0.0), (10.0, 14.0)], 64, LOOSE_TOLERANCE_M);
    // Rows end behind slanted walls, which have rectangles of their own.
    check_cover("slanted end", &[(0.0, 0.0), (20.0, 0.0), (26.0, 12.0), (0.0, 12.0)], 8, tight_m);
    let wings = [(0.0, 0.0), (20.0, 0.0), (34.0, 14.0), (28.3, 19.7), (16.7, 8.0), (0.0, 8.0)];
    check_cover("two wings", &wings, 8, tight_m);
    check_cover("thin wall", &[(0.0, 0.0), (14.0, 0.3), (14.0, 0.5), (0.0, 0.2)], 2, tight_m);
    let bent_wall = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (29.8, 20.0), (29.8, 0.2), (0.0, 0.2)];
    check_cover("bent wall", &bent_wall, 2, tight_m);
    // Corners of a survey are a few centimetres off.
    let noisy = [(0.0, 0.0), (20.0, 0.03), (19.98, 6.0), (6.02, 5.97), (6.0, 15.0), (0.03, 15.04)];
    check_cover("surveyed L", &noisy, 2, tight_m);
    let round = star(DVec2::ZERO, &[9.0; 24]);
    check_cover("round", &round.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>(), 64, LOOSE_TOLERANCE_M);
    let bow = [(0.0, 0.0), (12.0, 9.0), (12.0, 0.0), (0.0, 9.0)];
    check_cover("crossed ring", &bow, 64, LOOSE_TOLERANCE_M);
}

#[test]
fn courtyards_stay_open() {
    for angle_rad in [0.0, 0.5] {
        let outer = turned(&rectangle((0.0, 0.0), (40.0, 30.0)), angle_rad);
        let yard = turned(&rectangle((10.0, 8.0), (28.0, 20.0)), angle_rad);
        let shaft = turned(&rectangle((32.0, 10.0), (34.0, 12.0)), angle_rad);
        let count = check_grid("yard", &[&outer, &yard, &shaft], 300, COVER_TOLERANCE_M);
        assert!((4..=8).contains(&count), "{count} rectangles");
        let skew = turned(&yard, 0.35);
        check_grid("skew yard", &[&outer, &skew], 300, LOOSE_TOLERANCE_M);
    }
}

#[test]
fn faces_that_share_sides_or_overlap_are_united() {
    let [a, b] = [rectangle((0.0, 0.0), (10.0, 8.0)), ring(&[(10.0, 0.0), (18.0, 0.0), (18.0, 8.0), (10.0, 8.0)])];
    let over = rectangle((6.0, 2.0), (14.0, 6.0));
    for angle_rad in [0.0, 0.7] {
        let faces = [&a, &b, &over].map(|face| turned(face, angle_rad));
        let faces: Vec<&[DVec2]> = faces.iter().map(Vec::as_slice).collect();
        let cover = cover_rings(&faces, &[]).rectangles;
        assert_eq!(cover.len(), 1, "{cover:?}");
        assert!((cover[0].half_extents_m.element_product() - 36.0).abs() < 1e-6, "{cover:?}");
    }
}

#[test]
fn degenerate_outlines_do_not_panic() {
    for outline in [vec![], vec![DVec2::ZERO], vec![DVec2::ZERO; 5], vec![DVec2::ZERO, DVec2::X, 2.0 * DVec2::X]] {
        assert!(cover_polygon(&outline).len() <= 1, "{outline:?}");
    }
    let broken = [DVec2::ZERO, DVec2::new(5.0, f64::NAN), DVec2::new(5.0, 5.0)];
    assert!(cover_polygon(&broken).is_empty());
    assert!(cover_polygon(&[DVec2::ZERO, DVec2::new(f64::INFINITY, 0.0), DVec2::ONE]).is_empty());
    let footprint = Footprint { outer: rectangle((0.0, 0.0), (9.0, 9.0)), holes: vec![] };
    assert!(building_boxes(&footprint, f64::NAN, 5.0, Roof::Flat).boxes.is_empty());
    assert!(building_boxes(&footprint, 0.0, 5.0, Roof::Hipped { rise_m: f64::INFINITY }).boxes.is_empty());
}

#[test]
fn outlines_of_a_million_corners_are_covered_by_few_rectangles() {
    for count in [1000, 1_000_000] {
        let distances: Vec<f64> = (0..count).map(|i| 80.0 + 0.3 * f64::from(i % 1000 * 7919 % 1000) / 1000.0).collect();
        let outline = star(DVec2::new(4e5, -5e6), &distances);
        let Cover { rectangles: cover, coarse } = cover_rings(&[&outline], &[]);
        assert_eq!(coarse.is_some(), count > 1000, "said: {coarse:?}");
        assert!(!cover.is_empty() && cover.len() <= 4 * MOST, "{} rectangles", cover.len());
        assert!(outline.iter().step_by(97).all(|corner| covered(&cover, *corner)));
        // The sides waver by 0.3 m; thinning them out may cost a few metres of 160.
        let corner = |one: &TurnedRectangle| one.center + DVec2::from_angle(one.yaw_rad).rotate(one.half_extents_m);
        let farthest_m = cover.iter().map(|one| corner(one).distance(DVec2::new(4e5, -5e6))).fold(0.0, f64::max);
        assert!(farthest_m < 85.0, "{farthest_m}");
    }
}

#[test]
fn thousands_of_faces_are_covered_coarsely() {
    let face = |i: u32| {
        let (x, y) = (f64::from(i * 37 % 4001) * 0.05, f64::from(i * 61 % 3989) * 0.02);
        ring(&[(x, y), (x + 3.0, y + 0.5), (x + 0.3, y + 2.0 + 0.01 * y)])
    };
    let faces: Vec<Vec<DVec2>> = (0..6000).map(face).collect();
    let Cover { rectangles: cover, coarse } = cover_rings(&faces.iter().map(Vec::as_slice).collect::<Vec<_>>(), &[]);
    assert!(coarse.is_some_and(|coarse| coarse.gained_m2 > 100.0), "said: {coarse:?}");
    assert!(!cover.is_empty() && cover.len() <= MOST, "{} rectangles", cover.len());
    let inner = faces.iter().flat_map(|face| [face[0], face[1], face[2], (face[0] + face[1] + face[2]) / 3.0]);
    assert!(inner.into_iter().all(|point| covered(&cover, point)));
}

/// Farthest point of rectangles from the rings, metres, on a grid of a width: by brute force, without a line of the room.
fn overhang_m(cover: &[TurnedRectangle], rings: &[&[DVec2]], grid_m: f64) -> f64 {
    let mut farthest_m = 0.0_f64;
    for one in cover {
        let half = one.half_extents_m;
        let steps = (2.0 * half / grid_m).ceil().max(DVec2::ONE);
        for i in 0..=steps.x as usize {
            for j in 0..=steps.y as usize {
                let local = DVec2::new(i as f64, j as f64) / steps * 2.0 * half - half;
                farthest_m =
                    farthest_m.max(distance_m(rings, one.center + DVec2::from_angle(one.yaw_rad).rotate(local)));
            }
        }
    }
    farthest_m
}

/// Asserts that a cover holds its rings and stands over them by no more than the book says; gives the number of rectangles.
fn check_bound(name: &str, rings: &[&[DVec2]], points: usize) -> usize {
    let Cover { rectangles: cover, coarse } = cover_rings(&rings[..1], &rings[1..]);
    assert_eq!(coarse, None, "{name}");
    let allowed_m = if cover.len() <= 20 { COVER_TOLERANCE_M } else { LOOSE_TOLERANCE_M };
    let far_m = overhang_m(&cover, rings, 0.6);
    assert!(far_m <= allowed_m + 1e-5, "{name}: {} rectangles, {far_m} m beyond the walls", cover.len());
    let corners = || rings.iter().copied().flatten().copied();
    let (low, high) = corners().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
    let mut stream = Seed::of_item(1, "covers", name).stream("points");
    for _ in 0..points {
        let point = DVec2::new(stream.uniform(low.x, high.x), stream.uniform(low.y, high.y));
        assert!(covered(&cover, point) || !inside(rings, point), "{name}: {point} is not covered");
    }
    // And just inside of the walls, where slits would be.
    for ring in rings {
        for (i, a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            let aside = 1e-4 * (b - *a).normalize_or_zero().perp();
            for point in
                [0.01, 0.37, 0.5, 0.99].iter().flat_map(|share| [a.lerp(b, *share) + aside, a.lerp(b, *share) - aside])
            {
                assert!(covered(&cover, point) || !inside(rings, point), "{name}: {point} is not covered");
            }
        }
    }
    cover.len()
}

/// Stars, halls, thin rings and forts, drawn from a seed.
fn crooked_rings(kind: &str, seed: u64) -> Vec<Vec<DVec2>> {
    let mut stream = Seed::of_item(seed, "rings", kind).stream("corners");
    let mut draw = |low: f64, high: f64| stream.uniform(low, high);
    let center = DVec2::new(draw(-900.0, 900.0), draw(-900.0, 900.0));
    let count = 3 + draw(0.0, 45.0) as usize;
    let shrunk = |ring: &[DVec2], share: f64| ring.iter().map(|corner| center.lerp(*corner, share)).collect::<Vec<_>>();
    match kind {
        "star" => vec![star(center, &(0..count).map(|_| draw(4.0, 60.0)).collect::<Vec<_>>())],
        "round" => vec![star(center, &vec![draw(8.0, 70.0); 3 * count])],
        "thin ring" => {
            let outer = star(center, &(0..count).map(|_| draw(25.0, 70.0)).collect::<Vec<_>>());
            let inner = shrunk(&outer, draw(0.8, 0.97));
            vec![outer, inner]
        }
        // Bastions: long and short distances in turn.
        "fort" => {
            let (long_m, short_m) = (draw(40.0, 90.0), draw(20.0, 38.0));
            let outer = star(
                center,
                &(0..2 * (count % 9 + 4))
                    .map(|i| if i.is_multiple_of(2) { long_m } else { short_m })
                    .collect::<Vec<_>>(),
            );
            let inner = shrunk(&outer, draw(0.7, 0.95));
            vec![outer, inner]
        }
        _ => {
            // A hall with bays along a slanted wall and two courtyards, turned.
            let (wide_m, deep_m, yaw_rad) = (draw(60.0, 160.0), draw(40.0, 90.0), draw(0.0, 6.0));
            let bays = 4 + count % 14;
            let bay = |i: usize| {
                DVec2::new(
                    wide_m * (1.0 - i as f64 / (2 * bays) as f64),
                    deep_m + if (i / 2).is_multiple_of(2) { 3.0 } else { -2.0 } + 0.05 * i as f64,
                )
            };
            let mut outer = vec![DVec2::ZERO, DVec2::new(wide_m, 4.0)];
            outer.extend((0..=2 * bays).map(bay));
            let yard = |x: f64, y: f64| star(DVec2::new(x * wide_m, y * deep_m), &[0.18 * deep_m; 7]);
            [outer, yard(0.3, 0.5), yard(0.7, 0.45)]
                .iter()
                .map(|ring| turned(ring, yaw_rad).iter().map(|corner| *corner + center).collect())
                .collect()
        }
    }
}

#[test]
fn boxes_of_crooked_outlines_keep_to_the_bound_of_the_book() {
    let mut most = 0;
    for kind in ["star", "round", "thin ring", "fort", "hall"] {
        for seed in 0..12 {
            let rings = crooked_rings(kind, seed);
            let rings: Vec<&[DVec2]> = rings.iter().map(Vec::as_slice).collect();
            most = most.max(check_bound(&format!("{kind} {seed}"), &rings, 4000));
        }
    }
    assert!(most < 500, "{most} rectangles");
}

/// Height of the boxes over a point, none beside them.
fn top_m(boxes: &[OrientedBox], point: DVec2) -> Option<f64> {
    let over = boxes.iter().filter(|one| {
        let rectangle = TurnedRectangle {
            center: one.center_in_world.truncate(),
            half_extents_m: one.half_extents_m.truncate(),
            yaw_rad: one.yaw_rad,
        };
        covered(&[rectangle], point)
    });
    over.map(|one| one.center_in_world.z + one.half_extents_m.z).reduce(f64::max)
}

/// Compares the boxes with the exact height of the roof over a grid of points.
fn check_roof(footprint: &Footprint, roof: Roof, slope: f64, exact_m: impl Fn(DVec2) -> f64) {
    let SolidBoxes { boxes, coarse, is_roof_coarse } = building_boxes(footprint, 1.0, 7.0, roof);
    assert!(coarse.is_none() && !is_roof_coarse);
    assert!(boxes.iter().all(|one| one.half_extents_m.min_element() > 0.0));
    let volume = |shape: &OrientedBox| shape.half_extents_m.element_product();
    assert!(boxes.iter().map(volume).sum::<f64>() > 0.0);
    let rings: Vec<&[DVec2]> = core::iter::once(&footprint.outer).chain(&footprint.holes).map(Vec::as_slice).collect();
    for i in 0..240 {
        for j in 0..240 {
            let point = DVec2::new(f64::from(i) * 0.127 - 5.0, f64::from(j) * 0.121 - 5.0);
            if !inside(&rings, point) {
                continue;
            }
            let (exact_m, found_m) = (exact_m(point), top_m(&boxes, point).expect("a point of the footprint"));
            // A step, and the height that the roof gains over the overhang in plan.
            let above_m = ROOF_STEP_M + slope * LOOSE_TOLERANCE_M * 2.0;
            assert!(found_m >= exact_m - 1e-6, "{point}: {found_m} lies below the roof at {exact_m}");
            assert!(found_m <= exact_m + above_m, "{point}: {found_m} lies far above the roof at {exact_m}");
        }
    }
}

#[test]
fn roofs_are_contained_and_stand_over_by_one_step() {
    let plain = Footprint { outer: rectangle((0.0, 0.0), (16.0, 10.0)), holes: vec![] };
    check_roof(&plain, Roof::Flat, 0.0, |_| 7.0);
    let gable = |point: DVec2| 7.0 + 4.0 * (1.0 - (point.y - 5.0).abs() / 5.0);
    check_roof(&plain, Roof::Gabled { rise_m: 4.0, ridge_yaw_rad: None }, 0.8, gable);
    let across = |point: DVec2| 7.0 + 4.0 * (1.0 - (point.x - 8.0).abs() / 8.0);
    let ridge_yaw_rad = Some(0.5 * real::PI);
    check_roof(&plain, Roof::Gabled { rise_m: 4.0, ridge_yaw_rad }, 0.5, across);
    let to_wall = |point: DVec2| point.x.min(16.0 - point.x).min(point.y).min(10.0 - point.y);
    check_roof(&plain, Roof::Hipped { rise_m: 4.0 }, 0.8, |point| 7.0 + 0.8 * to_wall(point));
    let low = Roof::Gabled { rise_m: 0.4, ridge_yaw_rad: None };
    check_roof(&plain, low, 0.1, |point| 7.0 + 0.4 * (1.0 - (point.y - 5.0).abs() / 5.0));
}

#[test]
fn roofs_of_wings_and_around_courtyards_follow_the_walls() {
    let wings = Footprint { outer: ring(&L_SHAPE), holes: vec![] };
    let outer = wings.outer.clone();
    // The deepest point of this shape is at the inner corner's diagonal, 3 to 3.6 m from the walls.
    let from_wall = |point: DVec2| {
        (0..6)
            .map(|i| {
                let (a, b) = (outer[i], outer[(i + 1) % 6]);
                point.distance(a.lerp(b, ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0)))
            })
            .fold(f64::INFINITY, f64::min)
    };
    // The roof's own depth is found a little larger.
    let slope = 3.0 / 4.1;
    // It is at most as steep as if its deepest point were 3 m from the walls.
    check_roof(&wings, Roof::Gabled { rise_m: 3.0, ridge_yaw_rad: None }, 1.5, |p| 7.0 + slope * from_wall(p));
    let yard =
        Footprint { outer: rectangle((-4.0, -4.0), (24.0, 22.0)), holes: vec![rectangle((4.0, 4.0), (16.0, 14.0))] };
    let boxes = building_boxes(&yard, 0.0, 9.0, Roof::Hipped { rise_m: 3.0 }).boxes;
    assert_eq!(top_m(&boxes, DVec2::new(10.0, 9.0)), None);
    // The roof is deepest at the corners: along the wings its ridge is lower.
    assert!(top_m(&boxes, DVec2::new(0.0, 9.0)).is_some_and(|top_m| top_m > 11.0));
    assert!(boxes.len() <= 40, "{} boxes", boxes.len());
    let low = boxes.iter().map(|one| one.center_in_world - DVec3::Z * one.half_extents_m.z).map(|foot| foot.z);
    assert_eq!(low.reduce(f64::min), Some(0.0));
}

fn outline() -> impl Strategy<Value = Vec<DVec2>> {
    ((-1e3..1e3, -1e3..1e3), prop::collection::vec(0.5..60.0, 3..40))
        .prop_map(|((x, y), distances_m)| star(DVec2::new(x, y), &distances_m))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn covers_hold_the_polygon_without_its_courtyard(outline in outline(), hole in 0.05..0.9, shares in prop::collection::vec((0.0..1.0, 0.0..1.0), 40)) {
        let center = outline.iter().sum::<DVec2>() / outline.len() as f64;
        let yard: Vec<DVec2> = outline.iter().map(|corner| center.lerp(*corner, hole)).collect();
        let cover = cover_rings(&[&outline], &[&yard]).rectangles;
        let (low, high) = outline.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
        for (x, y) in shares {
            let point = low + DVec2::new(x, y) * (high - low);
            prop_assert!(covered(&cover, point) || !inside(&[&outline, &yard], point), "{point}");
        }
    }

    #[test]
    fn covers_hold_rings_that_cross_themselves(corners in prop::collection::vec((-30.0..30.0, -30.0..30.0), 3..14), shares in prop::collection::vec((-30.0..30.0, -30.0..30.0), 60)) {
        let outline = ring(&corners);
        let cover = cover_polygon(&outline);
        for (x, y) in shares {
            let point = DVec2::new(x, y);
            prop_assert!(covered(&cover, point) || !contains(&outline, point), "{point}");
        }
    }

    #[test]
    fn roofs_hold_the_points_far_from_all_walls(outline in outline(), rise_m in 1.0..9.0, share in 0.0..1.0, index in any::<prop::sample::Index>()) {
        let footprint = Footprint { outer: outline.clone(), holes: vec![] };
        let boxes = building_boxes(&footprint, 0.0, 5.0, Roof::Hipped { rise_m }).boxes;
        let center = outline.iter().sum::<DVec2>() / outline.len() as f64;
        let point = center.lerp(outline[index.index(outline.len())], share);
        let top_m = top_m(&boxes, point);
        prop_assert!(top_m.is_some_and(|top_m| top_m >= 5.0) || !contains(&outline, point));
        prop_assert!(boxes.iter().all(|one| one.center_in_world.z + one.half_extents_m.z <= 5.0 + rise_m + 1e-9));
    }
}
