//! Simplification of towns of voxels: `cargo bench -p cosfly-town --bench simplify`.

#![expect(missing_docs, reason = "the benchmark macro writes an undocumented function")]

use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox};
use cosfly_frames::{DVec3, Seed, real};
use cosfly_town::simplify::{SimplifyConfig, simplify};
use criterion::{Criterion, criterion_group, criterion_main};

/// Houses of cells of one size: `kind` 0 stand on one grid and have pitched roofs, 1 are turned each its own way, 2 are rough crowns of random cells.
fn town(kind: usize, boxes: usize) -> Vec<Obstacle> {
    let mut stream = Seed::of_item(5, "bench", "voxels").stream("town");
    let mut scene = Vec::with_capacity(boxes);
    for house in 0.. {
        let corner = DVec3::new(f64::from(house % 24) * 18.0, f64::from(house / 24) * 18.0, 0.0);
        let yaw_rad = if kind == 1 { stream.uniform(-0.7, 0.7) } else { 0.0 };
        let (sin, cos) = real::sin_cos(yaw_rad);
        for cell in 0..10 * 12 * 16 {
            let [x, y, z] = [cell % 10, cell / 10 % 12, cell / 120].map(f64::from);
            let is_there = if kind == 2 { stream.uniform(0.0, 1.0) < 0.35 } else { z < 10.0 + 5.0 - (x - 4.5).abs() };
            if is_there {
                let center = DVec3::new(cos * x - sin * y, sin * x + cos * y, z + 0.5);
                let shape =
                    OrientedBox { center_in_world: corner + center, half_extents_m: DVec3::splat(0.5), yaw_rad };
                scene.push(Obstacle { shape, kind: ObstacleKind::Building, object_id: 1, synthetic: false });
            }
            if scene.len() == boxes {
                return scene;
            }
        }
    }
    scene
}

fn benches(criterion: &mut Criterion) {
    for (name, kind) in [("one grid", 0), ("turned houses", 1), ("rough crowns", 2)] {
        let scene = town(kind, 65_000);
        let report = simplify(&scene, &[], &SimplifyConfig::default()).1;
        println!("{name}: {} -> {} boxes", report.input_boxes, report.output_boxes);
        let mut group = criterion.benchmark_group("simplify 65,000 voxels");
        group.sample_size(10);
        group.bench_function(name, |bencher| bencher.iter(|| simplify(&scene, &[], &SimplifyConfig::default())));
    }
}

criterion_group!(all, benches);
criterion_main!(all);
