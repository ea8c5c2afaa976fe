//! The same test for the planner's queries: towns of thousands of boxes, body points seen from cameras, far origins,
//! edges.

use cosfly_domain::OrientedBox;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, RandomStream, Seed};
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery};

fn random(seed: u64) -> RandomStream {
    Seed::of_item(seed, "geometry", "towns").stream("scene")
}

/// Houses, trunks and crowns on integer and on random coordinates, some rotated, around `origin`.
fn town(stream: &mut RandomStream, count: usize, origin: DVec3, turned_share: f64) -> Vec<OrientedBox> {
    let side_m = 9.0 * (count as f64).sqrt();
    (0..count)
        .map(|i| {
            let (low_m, high_m) = if i % 3 == 0 { (3.0, 12.0) } else { (0.2, 2.5) };
            let height_m = stream.uniform(2.0, 20.0);
            let mut center = DVec3::new(stream.uniform(0.0, side_m), stream.uniform(0.0, side_m), 0.5 * height_m);
            let mut half = DVec3::new(stream.uniform(low_m, high_m), stream.uniform(low_m, high_m), 0.5 * height_m);
            if i % 5 == 0 {
                (center, half) = (center.round(), half.round());
            }
            let quarter = std::f64::consts::FRAC_PI_2 * stream.index(4) as f64;
            let yaw_rad = if stream.chance(turned_share) { stream.uniform(-4.0, 4.0) } else { quarter };
            OrientedBox { center_in_world: origin + center, half_extents_m: half, yaw_rad }
        })
        .collect()
}

/// A camera above eight points of a body; every fourth view has integer coordinates along an axis.
fn view(stream: &mut RandomStream, side_m: f64, origin: DVec3, kind: usize) -> (DVec3, [DVec3; 8]) {
    let mut feet = DVec3::new(stream.uniform(0.0, side_m), stream.uniform(0.0, side_m), 0.0);
    let mut camera =
        feet + DVec3::new(stream.uniform(-25.0, 25.0), stream.uniform(-25.0, 25.0), stream.uniform(1.0, 30.0));
    match kind % 4 {
        0 => {
            feet = feet.round();
            camera = DVec3::new(camera.x.round(), feet.y, camera.z.round());
        }
        1 => camera = DVec3::new(feet.x, camera.y, camera.z),
        _ => {}
    }
    let side = if kind % 8 < 4 { DVec3::Y } else { DVec3::new(0.6, 0.8, 0.0) };
    let heights = [0.12, 0.5, 0.9, 1.2, 1.45, 1.7, 1.4, 1.4];
    let sides = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.22, 0.22];
    let points = core::array::from_fn(|i| origin + feet + DVec3::Z * heights[i] + side * sides[i]);
    (origin + camera, points)
}

fn check_town(count: usize, views: usize, origin: DVec3, turned_share: f64, seed: u64) {
    let mut stream = random(seed);
    let boxes = town(&mut stream, count, origin, turned_share);
    let side_m = 9.0 * (count as f64).sqrt();
    let oracle = BruteForce::new(&boxes);
    let trees: Vec<BoxBvh> =
        Level::available().into_iter().map(|level| BoxBvh::build(boxes.clone()).at_level(level)).collect();
    trees[0].assert_well_formed();
    let mut hidden_rays = 0;
    for kind in 0..views {
        let (camera, points) = view(&mut stream, side_m, origin, kind);
        let later =
            camera + DVec3::new(stream.uniform(-3.0, 3.0), stream.uniform(-3.0, 3.0), stream.uniform(-1.0, 1.0));
        let count = if kind % 16 == 5 { 3 + kind / 16 % 6 } else { 8 };
        let expected: Vec<bool> = points[..count].iter().map(|&point| oracle.blocked(camera, point)).collect();
        hidden_rays += expected.iter().filter(|&&hidden| hidden).count();
        let reach_m = [0.7, 6.0, 50.0, f64::INFINITY][kind % 4];
        let expected_near = oracle.nearest(camera, reach_m);
        let expected_clearance = oracle.segment_clearance(camera, later, reach_m);
        let expected_first = oracle.closest_hit(camera, points[0] - camera, 2.0);
        for tree in &trees {
            let mut blocked = vec![false; count];
            tree.blocked_batch(camera, &points[..count], &mut blocked);
            assert_eq!(blocked, expected, "{camera} to {points:?}");
            for (&point, &hidden) in points.iter().zip(&expected) {
                assert_eq!(tree.blocked(camera, point), hidden, "{camera} to {point}");
            }
            assert_eq!(tree.nearest(camera, reach_m), expected_near, "{camera} within {reach_m}");
            assert_eq!(tree.segment_clearance(camera, later, reach_m), expected_clearance, "{camera} to {later}");
            assert_eq!(tree.closest_hit(camera, points[0] - camera, 2.0), expected_first, "{camera}");
        }
    }
    assert!(hidden_rays > views / 2, "{hidden_rays} hidden rays in {views} views");
}

#[test]
fn cameras_over_towns_see_what_brute_force_sees() {
    for (seed, count) in [5, 16, 17, 40, 200, 900].into_iter().enumerate() {
        for (kind, turned_share) in [0.0, 0.5, 1.0].into_iter().enumerate() {
            check_town(count, 500, DVec3::ZERO, turned_share, (10 * seed + kind) as u64);
        }
    }
    check_town(6000, 300, DVec3::ZERO, 0.3, 77);
}

#[test]
fn towns_far_from_the_origin_are_answered_exactly() {
    check_town(300, 600, DVec3::new(4.1e5, 5.3e6, 120.0), 0.5, 1);
    check_town(300, 300, DVec3::new(-1e9, 3e9, 0.0), 0.5, 2);
}

#[test]
fn boxes_and_points_that_are_impossibly_far_away_are_answered_exactly() {
    let mut stream = random(9);
    let mut boxes = town(&mut stream, 100, DVec3::ZERO, 0.5);
    boxes[3].center_in_world.x = 1e12;
    boxes[7].half_extents_m.y = 1e9;
    boxes[8].center_in_world = DVec3::splat(-1e300);
    let oracle = BruteForce::new(&boxes);
    for level in Level::available() {
        let tree = BoxBvh::build(boxes.clone()).at_level(level);
        tree.assert_well_formed();
        for kind in 0..200 {
            let (camera, points) = view(&mut stream, 90.0, DVec3::ZERO, kind);
            let far = [1e7, 1e12, 1e200][kind % 3];
            for from in [camera, camera + DVec3::X * far] {
                let mut blocked = [false; 8];
                tree.blocked_batch(from, &points, &mut blocked);
                assert_eq!(blocked, points.map(|point| oracle.blocked(from, point)), "{from}");
                assert_eq!(tree.nearest(from, f64::INFINITY), oracle.nearest(from, f64::INFINITY));
                let segment = (from, points[0], f64::INFINITY);
                let of = |scene: &dyn SpatialQuery| scene.segment_clearance(segment.0, segment.1, segment.2);
                assert_eq!(of(&tree), of(&oracle));
                for max_t in [0.0, -1.0, 1.0, 1e300, f64::INFINITY, f64::NAN] {
                    for scale in [1e-300, 1e-40, 1.0, 1e40] {
                        let direction = (points[1] - from) * scale;
                        assert_eq!(
                            tree.closest_hit(from, direction, max_t),
                            oracle.closest_hit(from, direction, max_t)
                        );
                    }
                }
            }
        }
    }
}

/// A point on the surface of a box: on a corner, an edge or a face.
fn on_surface(stream: &mut RandomStream, shape: &OrientedBox) -> DVec3 {
    let corners = shape.corners_in_world();
    let fixed = 1 + stream.index(3);
    let (from, axes) = (stream.index(8), [0, 1, 2].map(|axis| 1_usize << ((axis + stream.index(3)) % 3)));
    let mut at = corners[from];
    for axis in &axes[fixed.min(3)..] {
        at += (corners[from ^ axis] - corners[from]) * stream.uniform(0.0, 1.0);
    }
    at
}

#[test]
fn rays_that_graze_boxes_by_a_hair_are_answered_exactly() {
    let nudges = [0.0, 1e-14, 1e-10, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3];
    for (seed, origin) in [DVec3::ZERO, DVec3::new(300.0, -4000.0, 20.0), DVec3::splat(5e5)].into_iter().enumerate() {
        let mut stream = random(40 + seed as u64);
        for round in 0..60 {
            let count = 1 + stream.index(40);
            let turned_share = [0.0, 1.0][round % 2];
            let boxes = town(&mut stream, count, origin, turned_share);
            let oracle = BruteForce::new(&boxes);
            let trees: Vec<BoxBvh> =
                Level::available().into_iter().map(|level| BoxBvh::build(boxes.clone()).at_level(level)).collect();
            for _ in 0..40 {
                let shape = boxes[stream.index(count)];
                let through = on_surface(&mut stream, &shape);
                let mut aim = || {
                    let nudge = nudges[stream.index(nudges.len())];
                    let point = through + nudge * DVec3::new(stream.uniform(-1.0, 1.0), stream.uniform(-1.0, 1.0), 0.3);
                    let along =
                        DVec3::new(stream.uniform(-9.0, 9.0), stream.uniform(-9.0, 9.0), stream.uniform(-5.0, 5.0));
                    (point + along, point - along * stream.uniform(0.0, 2.0))
                };
                let rays: [(DVec3, DVec3); 8] = core::array::from_fn(|_| aim());
                let from = rays[0].0;
                let ends = rays.map(|(_, to)| from + (to - from).clamp_length_max(40.0));
                let near_ends: [DVec3; 8] = core::array::from_fn(|ray| ends[0] + 1e-5 * (ends[ray] - ends[0]));
                for tree in &trees {
                    for (a, b) in rays {
                        assert_eq!(tree.blocked(a, b), oracle.blocked(a, b), "{shape:?} {a} {b}");
                        assert_eq!(
                            tree.closest_hit(a, b - a, 1.0),
                            oracle.closest_hit(a, b - a, 1.0),
                            "{shape:?} {a} {b}"
                        );
                        assert_eq!(tree.nearest(b, 9.0), oracle.nearest(b, 9.0), "{shape:?} {b}");
                        let clearance = |scene: &dyn SpatialQuery| scene.segment_clearance(a, b, 5.0);
                        assert_eq!(clearance(tree), clearance(&oracle), "{shape:?} {a} {b}");
                    }
                    for ends in [ends, near_ends] {
                        let mut blocked = [false; 8];
                        tree.blocked_batch(from, &ends, &mut blocked);
                        assert_eq!(blocked, ends.map(|to| oracle.blocked(from, to)), "{shape:?} {from} {ends:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn half_a_million_boxes_most_of_them_equal_are_built_and_asked() {
    let mut stream = random(90);
    let mut boxes = town(&mut stream, 50_000, DVec3::ZERO, 0.1);
    boxes.extend(vec![boxes[7]; 450_000]);
    let tree = BoxBvh::build(boxes.clone());
    tree.assert_well_formed();
    let oracle = BruteForce::new(&boxes[..50_000]);
    for kind in 0..20 {
        let (camera, points) = view(&mut stream, 2000.0, DVec3::ZERO, kind);
        let mut blocked = [false; 8];
        tree.blocked_batch(camera, &points, &mut blocked);
        assert_eq!(blocked, points.map(|point| oracle.blocked(camera, point)));
        assert_eq!(tree.nearest(camera, 50.0), oracle.nearest(camera, 50.0));
    }
}
