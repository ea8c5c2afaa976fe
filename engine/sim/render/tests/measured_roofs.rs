//! Pitched roofs of houses that maps give as measured: what is drawn is the true roof, without steps.

use cosfly_frames::{DVec2, DVec3, Seed};
use cosfly_maps::{MapConfig, read_town};
use cosfly_render::Scene;
use std::fmt::Write;

/// Middle, half length along the ridge, half width, and turn of the house; eaves and ridge, metres.
const MIDDLE: DVec2 = DVec2::new(20.0, 20.0);
const HALF_M: DVec2 = DVec2::new(9.0, 5.0);
const TURN_RAD: f64 = 0.3;
const EAVES_M: f64 = 5.0;
const RIDGE_M: f64 = 8.0;
/// `BUILDING` of CARLA's labels.
const BUILDING: u8 = 3;

/// Place along the ridge and across it, metres.
fn own(at: DVec2) -> DVec2 {
    DVec2::from_angle(-TURN_RAD).rotate(at - MIDDLE)
}

fn roof_m(at: DVec2) -> f64 {
    RIDGE_M - (RIDGE_M - EAVES_M) * own(at).y.abs() / HALF_M.y
}

fn drawn_m(triangles: &[[DVec3; 3]], at: DVec2) -> f64 {
    let height = |[a, b, c]: &[DVec3; 3]| {
        let [ab, ac, away] = [*b - *a, *c - *a, at.extend(0.0) - *a].map(|way| way.truncate());
        let area = ab.perp_dot(ac);
        let (u, v) = (away.perp_dot(ac) / area, ab.perp_dot(away) / area);
        let is_in = area.abs() > 1e-9 && u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9;
        is_in.then_some(a.z + u * (b.z - a.z) + v * (c.z - a.z))
    };
    triangles.iter().filter_map(height).fold(f64::NEG_INFINITY, f64::max)
}

/// Mean and largest distance of the drawn roof from the true one, and its largest jump over a decimetre, more than `inset_m` inside the walls.
fn errors_m(map: &[u8], world_from_map: impl Fn(DVec2) -> DVec2, inset_m: f64) -> [f64; 3] {
    let town = read_town(map, &MapConfig::default(), Seed([1; 32])).unwrap().0;
    let scene = Scene::of_boxes(&town, Seed([2; 32]));
    let triangles: Vec<[DVec3; 3]> = scene
        .triangles()
        .iter()
        .filter(|triangle| triangle.label == BUILDING)
        .map(|triangle| triangle.corners_in_world)
        .collect();
    let [mut sum_m, mut worst_m, mut jump_m, mut count] = [0.0_f64; 4];
    for place in 0..240 * 240 {
        let at = MIDDLE + 0.1 * DVec2::new(f64::from(place % 240) - 120.0, f64::from(place / 240) - 120.0) + 0.013;
        if own(at).abs().cmpgt(HALF_M - inset_m).any() {
            continue;
        }
        let height_m = drawn_m(&triangles, world_from_map(at));
        let off_m = (height_m - roof_m(at)).abs();
        (sum_m, worst_m, count) = (sum_m + off_m, worst_m.max(off_m), count + 1.0);
        let beside_m = drawn_m(&triangles, world_from_map(at + DVec2::new(0.1, 0.0)));
        jump_m = jump_m.max((beside_m - height_m).abs());
    }
    assert!(count > 1000.0);
    [sum_m / count, worst_m, jump_m]
}

#[test]
fn roof_of_a_scanned_gable_is_drawn_without_steps() {
    let mut points = String::new();
    let mut count = 0;
    let mut stream = Seed([3; 32]).stream("points");
    for place in 0..60 * 60 {
        let at = DVec2::new(f64::from(place % 60), f64::from(place / 60)) * 0.8
            + DVec2::new(stream.uniform(-0.3, 0.3), stream.uniform(-0.3, 0.3));
        let is_house = own(at).abs().cmple(HALF_M).all();
        let height_m = if is_house { roof_m(at) } else { 0.0 } + stream.uniform(-0.04, 0.04);
        let _ = writeln!(points, "{:.3} {:.3} {height_m:.3} {}", at.x, at.y, if is_house { 6 } else { 2 });
        count += 1;
    }
    let columns = "property double x\nproperty double y\nproperty double z\nproperty uchar classification\n";
    let map = format!("ply\nformat ascii 1.0\nelement vertex {count}\n{columns}end_header\n{points}");
    let [mean_m, worst_m, jump_m] = errors_m(map.as_bytes(), |at| DVec2::new(at.x, -at.y), 1.2);
    assert!(mean_m < 0.25 && worst_m < 0.6 && jump_m < 0.3, "{mean_m} {worst_m} {jump_m}");
}

#[test]
fn roof_of_a_gable_in_cityjson_is_drawn_without_steps() {
    let corner = |x: f64, y: f64, z: f64| {
        let at = MIDDLE + DVec2::from_angle(TURN_RAD).rotate(DVec2::new(x, y) * HALF_M);
        format!("[{:.4},{:.4},{z:.4}]", at.x, at.y)
    };
    let plan = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut vertices: Vec<String> = plan.iter().map(|(x, y)| corner(*x, *y, 0.0)).collect();
    vertices.extend(plan.iter().map(|(x, y)| corner(*x, *y, EAVES_M)));
    vertices.extend([corner(-1.0, 0.0, RIDGE_M), corner(1.0, 0.0, RIDGE_M)]);
    // A square around it, for people.
    vertices.extend([(-3.0, -4.0), (3.0, -4.0), (3.0, 4.0), (-3.0, 4.0)].map(|(x, y)| corner(x, y, 0.0)));
    let map = format!(
        r#"{{"type":"CityJSON","version":"1.1","transform":{{"scale":[1,1,1],"translate":[0,0,0]}},"CityObjects":{{
        "house":{{"type":"Building","geometry":[{{"type":"MultiSurface","lod":"2","boundaries":[[[0,3,2,1]],[[4,5,9,8]],[[8,9,6,7]],
        [[0,1,5,4]],[[2,3,7,6]],[[1,2,6,9,5]],[[3,0,4,8,7]]],"semantics":{{"surfaces":[{{"type":"GroundSurface"}},
        {{"type":"RoofSurface"}},{{"type":"WallSurface"}}],"values":[0,1,1,2,2,2,2]}}}}]}},
        "square":{{"type":"TransportSquare","geometry":[{{"type":"MultiSurface","lod":"2","boundaries":[[[10,11,12,13]]]}}]}}}},
        "vertices":[{}]}}"#,
        vertices.join(",")
    );
    let [mean_m, worst_m, jump_m] = errors_m(map.as_bytes(), |at| DVec2::new(at.x, -at.y), 0.3);
    assert!(mean_m < 0.15 && worst_m < 0.4 && jump_m < 0.3, "{mean_m} {worst_m} {jump_m}");
}
