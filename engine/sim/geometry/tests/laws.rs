//! Every implementation of [`SpatialQuery`] gives the answers of brute force, bit for bit, on degenerate scenes; and
//! the kernels agree with `parry3d`, an independent library.

use cosfly_domain::OrientedBox;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, RandomStream, Seed, real};
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery, Triangle, TriangleBruteForce, TriangleBvh};
use parry3d_f64::query::{PointQuery, Ray, RayCast};
use proptest::collection::vec;
use proptest::prelude::*;

fn random(seed: u64) -> RandomStream {
    Seed::of_item(seed, "geometry", "laws").stream("scene")
}

fn point(stream: &mut RandomStream, reach_m: f64) -> DVec3 {
    let mut one = || stream.uniform(-reach_m, reach_m);
    DVec3::new(one(), one(), one())
}

fn random_box(stream: &mut RandomStream, reach_m: f64) -> OrientedBox {
    let mut size = point(stream, 3.0).abs();
    for axis in 0..3 {
        if stream.chance(0.1) {
            size[axis] = 0.0;
        }
    }
    let yaw_rad = if stream.chance(0.3) { 0.0 } else { stream.uniform(-7.0, 7.0) };
    OrientedBox { center_in_world: point(stream, reach_m), half_extents_m: size, yaw_rad }
}

fn check_same(name: &str, tested: &dyn SpatialQuery, oracle: &dyn SpatialQuery, queries: &[(DVec3, DVec3)]) {
    assert_eq!(tested.len(), oracle.len(), "{name}");
    for &(from, to) in queries {
        let place = format!("{name}: from {from} to {to}");
        for max_t in [0.0, 1.0, 30.0, f64::INFINITY] {
            assert_eq!(
                tested.closest_hit(from, to - from, max_t),
                oracle.closest_hit(from, to - from, max_t),
                "{place}, max_t {max_t}"
            );
        }
        assert_eq!(tested.blocked(from, to), oracle.blocked(from, to), "{place}");
        for within_m in [0.0, 0.5, 5.0, f64::INFINITY] {
            assert_eq!(tested.nearest(from, within_m), oracle.nearest(from, within_m), "{place}, within {within_m}");
            let clearance_m = tested.segment_clearance(from, to, within_m);
            assert_eq!(clearance_m, oracle.segment_clearance(from, to, within_m), "{place}, within {within_m}");
            if tested.blocked(from, to) {
                assert!(clearance_m <= 0.0, "{place}: blocked, yet {clearance_m} m clear");
            }
        }
        let listed = |scene: &dyn SpatialQuery| {
            let mut found = Vec::new();
            scene.within(from.min(to), from.max(to), &mut |primitive| found.push(primitive));
            found.sort_unstable();
            found
        };
        assert_eq!(listed(tested), listed(oracle), "{place}");
    }
    let Some(&(from, _)) = queries.first() else { return };
    let ends: Vec<DVec3> = queries.iter().map(|&(_, to)| to).collect();
    let mut blocked = vec![false; ends.len()];
    tested.blocked_batch(from, &ends, &mut blocked);
    let expected: Vec<bool> = ends.iter().map(|&to| oracle.blocked(from, to)).collect();
    assert_eq!(blocked, expected, "{name}: batch");
}

/// A coordinate, metres: half of them whole numbers, so that rays run along faces, edges and corners.
fn coordinate(reach: i32) -> impl Strategy<Value = f64> {
    prop_oneof![(-reach..=reach).prop_map(f64::from), -f64::from(reach)..f64::from(reach)]
}

fn points(reach: i32) -> impl Strategy<Value = DVec3> {
    [coordinate(reach), coordinate(reach), coordinate(reach)].prop_map(DVec3::from_array)
}

/// Boxes, some without extent along an axis, turned or along the axes.
fn boxes(reach: i32) -> impl Strategy<Value = OrientedBox> {
    let yaw = prop_oneof![Just(0.0), -7.0..7.0];
    (points(reach), points(3), yaw).prop_map(|(center_in_world, size, yaw_rad)| OrientedBox {
        center_in_world,
        half_extents_m: size.abs(),
        yaw_rad,
    })
}

/// Pairs of points: far apart, equal, or along an axis.
fn segments() -> impl Strategy<Value = (DVec3, DVec3)> {
    (points(20), points(20), 0..8).prop_map(|(from, to, shape)| match shape {
        0 => (from, from),
        axis @ 1..=3 => (from, from + DVec3::AXES[axis as usize - 1] * to.x),
        4 => (from * 0.1, to * 10.0),
        _ => (from, to),
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_tree_of_boxes_answers_as_brute_force_does(
        boxes in prop_oneof![vec(boxes(8), 0..20), vec(boxes(30), 0..120)],
        asked in vec(segments(), 1..20),
    ) {
        let oracle = BruteForce::new(&boxes);
        for level in Level::available() {
            let tree = BoxBvh::build(boxes.clone()).at_level(level);
            tree.assert_well_formed();
            check_same(&format!("boxes, {}", level.name()), &tree, &oracle, &asked);
        }
    }

    /// Random triples of corners: long, thin, doubled-corner and far triangles.
    #[test]
    fn a_tree_of_triangles_answers_as_brute_force_does(
        vertices in vec(points(10), 3..300),
        corners in vec(any::<[prop::sample::Index; 3]>(), 0..150),
        asked in vec(segments(), 1..20),
    ) {
        let triangles: Vec<[u32; 3]> =
            corners.iter().map(|three| three.map(|corner| corner.index(vertices.len()) as u32)).collect();
        let tree = TriangleBvh::build(&vertices, &triangles);
        tree.assert_well_formed();
        check_same("triangles", &tree, &TriangleBruteForce::new(tree.triangles()), &asked);
    }
}

#[test]
fn a_thousand_equal_boxes_and_a_long_row_still_make_a_shallow_tree() {
    let one = OrientedBox { center_in_world: DVec3::ONE, half_extents_m: DVec3::ONE, yaw_rad: 0.4 };
    BoxBvh::build(vec![one; 1000]).assert_well_formed();
    let row = (0..1000).map(|i| OrientedBox { center_in_world: DVec3::X * 1.5_f64.powi(i / 2), ..one }).collect();
    BoxBvh::build(row).assert_well_formed();
}

#[test]
fn numbers_that_are_not_finite_are_answered_on_the_safe_side() {
    let good = OrientedBox { center_in_world: DVec3::ZERO, half_extents_m: DVec3::ONE, yaw_rad: 0.0 };
    let bad = OrientedBox { center_in_world: DVec3::NAN, ..good };
    let tree = BoxBvh::build(vec![bad, good]);
    tree.assert_well_formed();
    assert_eq!(tree.len(), 2);
    assert_eq!(tree.closest_hit(DVec3::X * 3.0, DVec3::NEG_X, 9.0).map(|hit| (hit.t, hit.primitive)), Some((2.0, 1)));
    let bad_numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let one_bad = bad_numbers
        .iter()
        .flat_map(|&bad| DVec3::AXES.map(|axis| DVec3::select(axis.cmpeq(DVec3::ONE), DVec3::splat(bad), axis)));
    for point in one_bad.chain([DVec3::NAN, DVec3::INFINITY]) {
        let ends = [DVec3::X * 9.0, point, DVec3::X * 9.1, DVec3::X * 9.2];
        for (from, expected) in [(DVec3::X * 8.0, [false, true, false, false]), (point, [true; 4])] {
            let mut blocked = [false; 4];
            tree.blocked_batch(from, &ends, &mut blocked);
            assert_eq!(blocked, expected, "{from} to {point}");
        }
        assert!(tree.blocked(DVec3::X * 9.0, point));
        assert_eq!(tree.closest_hit(point, DVec3::X, 9.0), None);
        assert_eq!(tree.nearest(point, 9.0), None);
        assert!(tree.blocked(point, DVec3::X * 9.0));
        assert_eq!(tree.segment_clearance(DVec3::X * 9.0, point, 5.0), 0.0);
    }
    let ground = TriangleBvh::build(&[DVec3::ZERO, DVec3::X], &[[0, 1, 2]]);
    assert_eq!(ground.closest_hit(DVec3::Z, DVec3::NEG_Z, 9.0), None);
}

#[test]
fn signed_distance_is_negative_inside_and_its_gradient_points_out() {
    let tree = BoxBvh::build(vec![OrientedBox {
        center_in_world: DVec3::ZERO,
        half_extents_m: DVec3::new(4.0, 2.0, 6.0),
        yaw_rad: 0.0,
    }]);
    for (at, distance_m, away) in [
        (DVec3::new(0.5, 1.5, 0.0), -0.5, DVec3::Y),
        (DVec3::new(-3.9, 0.0, 0.0), -0.1, DVec3::NEG_X),
        (DVec3::new(0.0, 0.0, 8.0), 2.0, DVec3::Z),
        (DVec3::new(7.0, 6.0, 0.0), 5.0, DVec3::new(0.6, 0.8, 0.0)),
        (DVec3::new(4.0, 0.0, 0.0), 0.0, DVec3::X),
    ] {
        let found = tree.nearest(at, 10.0).expect("something is near");
        assert!((found.distance_m - distance_m).abs() < 1e-12, "{at}: {found:?}");
        assert!((found.away_in_world - away).length() < 1e-12, "{at}: {found:?}");
    }
}

#[test]
fn the_gradient_of_the_distance_is_its_finite_difference() {
    let mut stream = random(7);
    let step_m = 1e-6;
    for _ in 0..300 {
        let tree = BoxBvh::build(vec![random_box(&mut stream, 5.0)]);
        let at = point(&mut stream, 10.0);
        let distance = |at: DVec3| tree.nearest(at, f64::INFINITY).expect("one box").distance_m;
        let difference = DVec3::from_array(core::array::from_fn(|axis| {
            let step = DVec3::AXES[axis] * step_m;
            (distance(at + step) - distance(at - step)) / (2.0 * step_m)
        }));
        let found = tree.nearest(at, f64::INFINITY).expect("one box");
        if found.distance_m.abs() > 1e-3 && (difference.length() - 1.0).abs() < 1e-6 {
            assert!((difference - found.away_in_world).length() < 1e-6, "{difference} {found:?}");
        }
    }
}

fn in_parry(shape: &OrientedBox) -> (parry3d_f64::shape::Cuboid, parry3d_f64::math::Pose) {
    let (half, at) = (shape.half_extents_m, shape.center_in_world);
    let cuboid = parry3d_f64::shape::Cuboid::new(parry3d_f64::math::Vector::new(half.x, half.y, half.z));
    let turn = parry3d_f64::math::Vector::new(0.0, 0.0, shape.yaw_rad);
    (cuboid, parry3d_f64::math::Pose::new(parry3d_f64::math::Vector::new(at.x, at.y, at.z), turn))
}

fn parry_point(at: DVec3) -> parry3d_f64::math::Vector {
    parry3d_f64::math::Vector::new(at.x, at.y, at.z)
}

#[test]
fn rays_and_distances_agree_with_parry() {
    let mut stream = random(11);
    for _ in 0..4000 {
        let mut shape = random_box(&mut stream, 8.0);
        shape.half_extents_m = shape.half_extents_m.max(DVec3::splat(0.01));
        let tree = BoxBvh::build(vec![shape]);
        let (cuboid, pose) = in_parry(&shape);
        let (from, to) = (point(&mut stream, 12.0), point(&mut stream, 12.0));
        let theirs = cuboid.distance_to_point(&pose, parry_point(from), false);
        let ours = tree.nearest(from, f64::INFINITY).expect("one box").distance_m;
        assert!((theirs - ours).abs() < 1e-9, "{shape:?} from {from}: {ours} against {theirs}");
        let ray = Ray::new(parry_point(from), parry_point(to - from));
        let theirs = cuboid.cast_ray(&pose, &ray, 10.0, true);
        let ours = tree.closest_hit(from, to - from, 10.0).map(|hit| hit.t);
        match (ours, theirs) {
            (Some(a), Some(b)) => assert!((a - b).abs() < 1e-9, "{shape:?} {from} {to}: {a} against {b}"),
            (None, None) => {}
            _ => panic!("{shape:?} {from} {to}: {ours:?} against {theirs:?}"),
        }
    }
}

#[test]
fn segment_distances_agree_with_parry_and_with_dense_samples() {
    let mut stream = random(12);
    for _ in 0..1000 {
        let mut shape = random_box(&mut stream, 8.0);
        shape.half_extents_m = shape.half_extents_m.max(DVec3::splat(0.01));
        let tree = BoxBvh::build(vec![shape]);
        let (from, to) = (point(&mut stream, 12.0), point(&mut stream, 12.0));
        let ours = tree.segment_clearance(from, to, f64::INFINITY);
        let sampled = (0..=2000)
            .map(|i| tree.nearest(from.lerp(to, f64::from(i) / 2000.0), f64::INFINITY).expect("one box").distance_m)
            .fold(f64::INFINITY, f64::min)
            .max(0.0);
        assert!(ours <= sampled + 1e-9 && sampled - ours < 0.02, "{shape:?} {from} {to}: {ours}, samples {sampled}");
        let (cuboid, pose) = in_parry(&shape);
        let segment = parry3d_f64::shape::Segment::new(parry_point(from), parry_point(to));
        let at_origin = parry3d_f64::math::Pose::IDENTITY;
        let theirs = parry3d_f64::query::distance(&at_origin, &segment, &pose, &cuboid).expect("supported").distance;
        assert!((ours - theirs).abs() < 1e-6, "{shape:?} {from} {to}: {ours} against {theirs}");
    }
}

#[test]
fn triangle_distances_agree_with_dense_samples() {
    let mut stream = random(13);
    for _ in 0..300 {
        let corners = core::array::from_fn(|_| point(&mut stream, 6.0));
        let triangle = Triangle { corners_in_world: corners };
        let tree = TriangleBvh::build(&corners, &[[0, 1, 2]]);
        let (from, to) = (point(&mut stream, 8.0), point(&mut stream, 8.0));
        let (near, segment) = (tree.nearest(from, 1e9).expect("one"), tree.segment_clearance(from, to, 1e9));
        let mut sampled = (f64::INFINITY, f64::INFINITY);
        for i in 0..=60 {
            for j in 0..=60 - i {
                let (u, v) = (f64::from(i) / 60.0, f64::from(j) / 60.0);
                let [a, b, c] = triangle.corners_in_world;
                let at = a + (b - a) * u + (c - a) * v;
                let along = ((at - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
                sampled.0 = sampled.0.min(at.distance(from));
                sampled.1 = sampled.1.min(at.distance(from.lerp(to, along)));
            }
        }
        assert!(near.distance_m <= sampled.0 + 1e-9 && sampled.0 - near.distance_m < 0.3, "{triangle:?} {from}");
        assert!(segment <= sampled.1 + 1e-9 && sampled.1 - segment < 0.3, "{triangle:?} {from} {to}");
    }
}

#[test]
fn a_ray_down_onto_a_grid_of_triangles_never_slips_through_an_edge() {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let (sin, cos) = real::sin_cos(0.3);
    for row in 0..12_u32 {
        for column in 0..12_u32 {
            let (x, y) = (f64::from(column), f64::from(row));
            vertices.push(DVec3::new(cos * x - sin * y, sin * x + cos * y, 0.1 * real::sin(x * y)));
            if row < 11 && column < 11 {
                let at = row * 12 + column;
                triangles.extend([[at, at + 1, at + 13], [at, at + 13, at + 12]]);
            }
        }
    }
    let tree = TriangleBvh::build(&vertices, &triangles);
    for row in 1..44 {
        for column in 1..44 {
            let (x, y) = (0.25 * f64::from(column), 0.25 * f64::from(row));
            let from = DVec3::new(cos * x - sin * y, sin * x + cos * y, 50.0);
            assert!(tree.closest_hit(from, DVec3::NEG_Z, 100.0).is_some(), "{from}");
        }
    }
}
