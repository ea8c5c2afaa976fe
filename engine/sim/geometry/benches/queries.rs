//! Nanoseconds per query of the box tree in a town-like scene of 200 and 2,000 boxes.

#![expect(missing_docs, reason = "the benchmark macro writes an undocumented function")]

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, Seed};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn town(count: usize) -> BoxBvh {
    let mut stream = Seed::of_item(1, "bench", "town").stream("boxes");
    let side_m = 12.0 * (count as f64).sqrt();
    let boxes = (0..count).map(|_| {
        let height_m = stream.uniform(4.0, 30.0);
        OrientedBox {
            center_in_world: DVec3::new(stream.uniform(0.0, side_m), stream.uniform(0.0, side_m), 0.5 * height_m),
            half_extents_m: DVec3::new(stream.uniform(0.3, 6.0), stream.uniform(0.3, 6.0), 0.5 * height_m),
            yaw_rad: if stream.chance(0.5) { 0.0 } else { stream.uniform(0.0, 3.0) },
        }
    });
    BoxBvh::build(boxes.collect())
}

/// Views of a drone 20 m above and 20 m behind a pedestrian: (drone, body point, next drone).
fn follow_queries(scene: &BoxBvh) -> Vec<(DVec3, DVec3, DVec3)> {
    let mut stream = Seed::of_item(2, "bench", "town").stream("queries");
    let side_m = 12.0 * (scene.len() as f64).sqrt();
    (0..1024)
        .map(|_| {
            let feet = DVec3::new(stream.uniform(0.0, side_m), stream.uniform(0.0, side_m), 1.0);
            let drone = feet + DVec3::new(stream.uniform(-20.0, 20.0), stream.uniform(-20.0, 20.0), 20.0);
            (drone, feet, drone + DVec3::new(stream.uniform(-1.0, 1.0), stream.uniform(-1.0, 1.0), 0.1))
        })
        .collect()
}

fn queries(criterion: &mut Criterion) {
    for count in [200, 2000] {
        let scene = town(count);
        let asked = follow_queries(&scene);
        let mut at = 0;
        let mut next = || {
            at = (at + 1) % asked.len();
            asked[at]
        };
        let name = |query: &str| format!("{query}/{count}");
        criterion.bench_function(&name("blocked"), |b| {
            b.iter(|| {
                let (drone, body, _) = next();
                black_box(scene.blocked(drone, body))
            });
        });
        criterion.bench_function(&name("blocked_batch_of_8"), |b| {
            b.iter(|| {
                let (drone, body, _) = next();
                let points: [DVec3; 8] = core::array::from_fn(|i| body + DVec3::Z * (0.2 * i as f64));
                let mut blocked = [false; 8];
                scene.blocked_batch(drone, &points, &mut blocked);
                black_box(blocked)
            });
        });
        criterion.bench_function(&name("closest_hit"), |b| {
            b.iter(|| {
                let (drone, body, _) = next();
                black_box(scene.closest_hit(drone, body - drone, 50.0))
            });
        });
        criterion.bench_function(&name("nearest_within_5_m"), |b| {
            b.iter(|| black_box(scene.nearest(next().0, 5.0)));
        });
        criterion.bench_function(&name("segment_clearance_within_5_m"), |b| {
            b.iter(|| {
                let (drone, _, later) = next();
                black_box(scene.segment_clearance(drone, later, 5.0))
            });
        });
    }
}

criterion_group!(benches, queries);
criterion_main!(benches);
