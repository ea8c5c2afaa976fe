//! Laws of plan-view polygons over star-shaped outlines of any size, found wrong ones shrunk.

use cosfly_frames::{DVec2, real};
use cosfly_town::cover::cover_polygon;
use cosfly_town::polygons::{PolygonIndex, clipped_to_band, contains, triangulated, twice_area_m2};
use proptest::prelude::*;

/// A simple polygon around `center`: corners at equal angles, each at its own distance.
fn star(center: DVec2, distances_m: &[f64]) -> Vec<DVec2> {
    let step_rad = real::TAU / distances_m.len() as f64;
    let corner = |(index, distance_m): (usize, &f64)| {
        let (sin, cos) = real::sin_cos(step_rad * index as f64);
        center + *distance_m * DVec2::new(cos, sin)
    };
    distances_m.iter().enumerate().map(corner).collect()
}

fn outline() -> impl Strategy<Value = Vec<DVec2>> {
    ((-1e3..1e3, -1e3..1e3), prop::collection::vec(0.5..60.0, 3..40))
        .prop_map(|((x, y), distances_m)| star(DVec2::new(x, y), &distances_m))
}

fn area_of(outline: &[DVec2], triangles: &[[u32; 3]]) -> f64 {
    triangles.iter().map(|triangle| twice_area_m2(&triangle.map(|corner| outline[corner as usize]))).sum()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn triangles_tile_the_polygon(outline in outline(), is_reversed: bool) {
        let outline: Vec<DVec2> = if is_reversed { outline.into_iter().rev().collect() } else { outline };
        let triangles = triangulated(&outline);
        let (area, tiled) = (twice_area_m2(&outline).abs(), area_of(&outline, &triangles));
        prop_assert!((area - tiled).abs() <= 1e-9 * area + 1e-6, "{area} and {tiled}");
    }

    #[test]
    fn two_bands_that_meet_have_the_area_of_the_polygon(outline in outline(), angle in 0.0..real::TAU, share in 0.0..1.0) {
        let (sin, cos) = real::sin_cos(angle);
        let along = DVec2::new(cos, sin);
        let reach = outline.iter().map(|corner| corner.dot(along));
        let (low, high) = reach.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        let middle = low + share * (high - low);
        let part = |from, to| twice_area_m2(&clipped_to_band(&outline, along, from, to)).abs();
        let (area, parts) = (twice_area_m2(&outline).abs(), part(low - 1.0, middle) + part(middle, high + 1.0));
        prop_assert!((area - parts).abs() <= 1e-9 * area + 1e-6, "{area} and {parts}");
    }

    #[test]
    fn the_index_finds_the_polygons_that_contain_a_point(outlines in prop::collection::vec(outline(), 0..12), x in -1e3..1e3, y in -1e3..1e3) {
        let point = DVec2::new(x, y);
        let expected: Vec<usize> = (0..outlines.len()).filter(|&i| contains(&outlines[i], point)).collect();
        prop_assert_eq!(PolygonIndex::new(outlines).at(point).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn covers_hold_every_point_of_the_polygon(outline in outline(), index in any::<prop::sample::Index>(), share in 0.0..1.0) {
        let center = outline.iter().sum::<DVec2>() / outline.len() as f64;
        let point = center.lerp(outline[index.index(outline.len())], share);
        let is_covered = cover_polygon(&outline).iter().any(|rectangle| {
            let (sin, cos) = real::sin_cos(rectangle.yaw_rad);
            let offset = point - rectangle.center;
            let local = DVec2::new(cos * offset.x + sin * offset.y, cos * offset.y - sin * offset.x).abs();
            local.cmple(rectangle.half_extents_m + 1e-6).all()
        });
        prop_assert!(is_covered || !contains(&outline, point), "{point}");
    }
}
