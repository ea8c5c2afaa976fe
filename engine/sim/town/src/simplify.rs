//! Merge, crop and prune: few boxes for the planner that lose no occupied space beyond a stated tolerance.
//!
//! Crop drops what is far from all walkable ground. Containment drops boxes inside others. Merging joins neighbours of
//! one orientation. Prune drops specks beside a kept box.

pub mod candidate;
pub mod config;
pub mod containment;
pub mod crop;
pub mod merging;
pub mod prune;

pub use candidate::BoxCandidate;
pub use config::SimplifyConfig;

use cosfly_domain::{Obstacle, OrientedBox, SimplificationReport, WalkablePolygon};

/// Boxes for planning and what was done to get them; `walkable` is the region that `crop` keeps the surroundings of.
///
/// Every point of an original box near the region lies in a kept box, or (pruned specks only) within
/// `tolerance_m` of one. No point of a kept box is farther than `tolerance_m` from an original box.
pub fn simplify(
    obstacles: &[Obstacle],
    walkable: &[WalkablePolygon],
    config: &SimplifyConfig,
) -> (Vec<OrientedBox>, SimplificationReport) {
    let original = |(first, obstacle): (usize, &Obstacle)| {
        let mut one = BoxCandidate { shape: obstacle.shape, filled_m3: 0.0, growth_m: 0.0, first };
        one.filled_m3 = one.volume_m3();
        one
    };
    let mut kept: Vec<BoxCandidate> = obstacles.iter().enumerate().map(original).collect();
    let mut report = SimplificationReport {
        input_boxes: kept.len(),
        tolerance_m: config.tolerance_m,
        ..SimplificationReport::default()
    };
    if config.crop {
        crop::drop_far_from(&mut kept, walkable, config.crop_radius_m);
        report.cropped = report.input_boxes - kept.len();
    }
    let original_m3: f64 = kept.iter().map(BoxCandidate::volume_m3).sum();
    let before = kept.len();
    if config.merge {
        containment::drop_contained(&mut kept);
        kept = merging::merge_neighbours(kept, config.max_empty_share, config.tolerance_m);
        containment::drop_contained(&mut kept);
        report.merged = before - kept.len();
    }
    let mut lost_m3 = 0.0;
    if config.prune {
        let before = kept.len();
        let filled_m3 = |kept: &[BoxCandidate]| kept.iter().map(|one| one.filled_m3).sum::<f64>();
        let before_m3 = filled_m3(&kept);
        prune::drop_specks(&mut kept, config.tolerance_m);
        lost_m3 = before_m3 - filled_m3(&kept);
        report.pruned = before - kept.len();
    }
    kept.sort_by_key(|one| one.first);
    let added_m3: f64 = kept.iter().map(|one| (one.volume_m3() - one.filled_m3).max(0.0)).sum();
    let share = |volume_m3: f64| if original_m3 > 0.0 { volume_m3 / original_m3 } else { 0.0 };
    (report.added_volume_share, report.lost_volume_share) = (share(added_m3), share(lost_m3));
    report.output_boxes = kept.len();
    (kept.into_iter().map(|one| one.shape).collect(), report)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{ObstacleKind, WalkableKind};
    use cosfly_frames::{DVec3, RandomStream, Seed, real};
    use cosfly_geometry::{BoxBvh, SpatialQuery};

    fn obstacle(shape: OrientedBox) -> Obstacle {
        Obstacle { shape, kind: ObstacleKind::Building, object_id: 1, synthetic: false }
    }

    fn random_scene(stream: &mut RandomStream, count: usize) -> Vec<Obstacle> {
        let mut scene = Vec::new();
        while scene.len() < count {
            let center = DVec3::new(stream.uniform(0.0, 60.0), stream.uniform(0.0, 60.0), stream.uniform(0.0, 20.0));
            let half = DVec3::new(stream.uniform(0.0, 3.0), stream.uniform(0.0, 3.0), stream.uniform(0.0, 5.0));
            let yaw_rad = [0.0, 0.6, real::FRAC_PI_2, stream.uniform(-9.0, 9.0)][stream.index(4)];
            let shape = OrientedBox { center_in_world: center, half_extents_m: half, yaw_rad };
            scene.push(obstacle(shape));
            // Neighbours of like size, with gaps and offsets around the tolerance, specks, and boxes inside.
            let (sin, cos) = real::sin_cos(yaw_rad);
            let step = DVec3::new(cos, sin, 0.0) * (2.0 * half.x + stream.uniform(0.0, 0.6));
            let offset = DVec3::new(0.0, 0.0, stream.uniform(-0.2, 0.2));
            scene.push(obstacle(OrientedBox { center_in_world: center + step + offset, ..shape }));
            let speck =
                OrientedBox { center_in_world: center - 0.6 * step, half_extents_m: DVec3::splat(0.1), yaw_rad: 1.0 };
            scene.push(obstacle(speck));
            scene.push(obstacle(OrientedBox { half_extents_m: 0.5 * half, ..shape }));
        }
        scene
    }

    fn points_of(shape: &OrientedBox, stream: &mut RandomStream) -> Vec<DVec3> {
        let mut points = shape.corners_in_world().to_vec();
        let (sin, cos) = real::sin_cos(shape.yaw_rad);
        for _ in 0..12 {
            let mut one = || stream.uniform(-1.0, 1.0);
            let local = shape.half_extents_m * DVec3::new(one(), one(), one());
            let turned = DVec3::new(cos * local.x - sin * local.y, sin * local.x + cos * local.y, local.z);
            points.push(shape.center_in_world + turned);
        }
        points
    }

    /// Largest distance of sampled points of `from` to the boxes `to`.
    fn largest_gap_m(from: &[OrientedBox], to: &[OrientedBox], stream: &mut RandomStream) -> f64 {
        let scene = BoxBvh::build(to.to_vec());
        let points: Vec<DVec3> = from.iter().flat_map(|shape| points_of(shape, stream)).collect();
        let gap_m = |at: &DVec3| scene.nearest(*at, f64::INFINITY).map_or(f64::INFINITY, |near| near.distance_m);
        points.iter().map(gap_m).fold(0.0, f64::max)
    }

    #[test]
    fn no_occupied_space_is_lost_and_none_is_added_beyond_the_tolerance() {
        for seed in 0..12 {
            let mut stream = Seed::of_item(seed, "simplify", "scene").stream("boxes");
            let scene = random_scene(&mut stream, 400);
            for tolerance_m in [0.0, 0.25, 0.5, 1.0] {
                let config = SimplifyConfig { tolerance_m, max_empty_share: 0.3, ..SimplifyConfig::default() };
                let (kept, report) = simplify(&scene, &[], &config);
                assert_eq!(
                    report.input_boxes,
                    report.merged + report.cropped + report.pruned + report.output_boxes,
                    "{report:?}"
                );
                assert_eq!(report.output_boxes, kept.len());
                assert!(kept.len() < scene.len());
                let originals: Vec<OrientedBox> = scene.iter().map(|one| one.shape).collect();
                let lost_m = largest_gap_m(&originals, &kept, &mut stream);
                let added_m = largest_gap_m(&kept, &originals, &mut stream);
                assert!(lost_m <= tolerance_m + 1e-6, "{lost_m} m lost at tolerance {tolerance_m}");
                assert!(added_m <= tolerance_m + 1e-6, "{added_m} m added at tolerance {tolerance_m}");
                let unpruned = SimplifyConfig { prune: false, ..config };
                let lost_m = largest_gap_m(&originals, &simplify(&scene, &[], &unpruned).0, &mut stream);
                assert!(lost_m <= 1e-6, "merging alone lost {lost_m} m");
            }
        }
    }

    /// Buildings cut into cells of half a metre to two metres, as exporters of voxel maps give them.
    fn finely_split_town(buildings: usize, cells: usize) -> Vec<Obstacle> {
        let mut stream = Seed::of_item(5, "simplify", "voxels").stream("town");
        let mut scene = Vec::new();
        for building in 0..buildings {
            let corner = DVec3::new((building % 16) as f64 * 30.0, (building / 16) as f64 * 30.0, 0.0);
            let yaw_rad = [0.0, 0.3][building % 2];
            let (sin, cos) = real::sin_cos(yaw_rad);
            let cell_m = stream.uniform(0.5, 2.0);
            let stories = 4 + stream.index(2 * cells);
            for (x, y, z) in (0..cells * cells * stories).map(|i| (i % cells, i / cells % cells, i / (cells * cells))) {
                let local = cell_m * DVec3::new(x as f64 + 0.5, y as f64 + 0.5, z as f64 + 0.5);
                let turned = DVec3::new(cos * local.x - sin * local.y, sin * local.x + cos * local.y, local.z);
                let half_extents_m = DVec3::splat(0.5 * cell_m);
                // A courtyard and a set-back top keep it from being one block.
                let is_hollow = x > 2 && x < 5 && y > 2 && y < 5 || z > stories / 2 && x > cells / 2;
                if !is_hollow {
                    scene.push(obstacle(OrientedBox { center_in_world: corner + turned, half_extents_m, yaw_rad }));
                }
            }
        }
        scene
    }

    #[test]
    fn a_finely_split_town_of_65_thousand_boxes_becomes_two_thousand_quickly() {
        let scene = finely_split_town(180, 8);
        assert!(scene.len() > 50_000, "{}", scene.len());
        let (kept, report) = simplify(&scene, &[], &SimplifyConfig::default());
        println!("finely split town: {report:?}");
        assert!(kept.len() <= 2_600, "{report:?}");
        assert!(report.added_volume_share < 0.1 && report.lost_volume_share < 1e-3, "{report:?}");
    }

    #[test]
    fn crop_keeps_what_is_near_walkable_ground() {
        let at = |x_m: f64| {
            obstacle(OrientedBox { center_in_world: DVec3::X * x_m, half_extents_m: DVec3::ONE, yaw_rad: 0.0 })
        };
        let outline_in_world = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let ground = [WalkablePolygon { kind: WalkableKind::Sidewalk, outline_in_world, synthetic: false }];
        let config = SimplifyConfig { crop: true, crop_radius_m: 50.0, ..SimplifyConfig::default() };
        let scene = [at(-20.0), at(51.9), at(52.1), at(400.0)];
        let (kept, report) = simplify(&scene, &ground, &config);
        assert_eq!((kept.len(), report.cropped), (2, 2));
        assert_eq!(simplify(&scene, &[], &config).1.cropped, 0, "without walkable ground nothing is far from it");
        assert_eq!(simplify(&scene, &ground, &SimplifyConfig::default()).1.cropped, 0);
    }

    #[test]
    fn boxes_that_cannot_be_joined_stay_exactly_as_they_are() {
        let mut stream = Seed::of_item(1, "simplify", "apart").stream("boxes");
        let scene: Vec<Obstacle> = (0..200)
            .map(|i| {
                let center_in_world = DVec3::new(f64::from(i) * 20.0, 0.0, 0.0);
                obstacle(OrientedBox {
                    center_in_world,
                    half_extents_m: DVec3::ONE,
                    yaw_rad: stream.uniform(-9.0, 9.0),
                })
            })
            .collect();
        let (kept, report) = simplify(&scene, &[], &SimplifyConfig::default());
        assert_eq!(kept, scene.iter().map(|one| one.shape).collect::<Vec<_>>());
        assert_eq!((report.merged, report.pruned, report.added_volume_share), (0, 0, 0.0));
    }
}
