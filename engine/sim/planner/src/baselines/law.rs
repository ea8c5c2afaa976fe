//! Laws of the voxel searches: the cheapest path there is, and none that comes near an obstacle.

use super::astar::astar;
use super::beam::beam;
use super::grid::{Cell, MOVES, VoxelGrid, VoxelOptions};
use super::{Baseline, BaselineInput, plan_baseline};
use crate::config::muco::MucoConfig;
use crate::problem::Problem;
use crate::terms::term::{CostTerm, TermContext};
use crate::terms::{altitude, built_in_terms, pitch, safety, tracking, viewpoint, visibility};
use crate::walk::Walk;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_geometry::{BoxBvh, BruteForce};
use cosfly_scenes::{SceneKind, SeededScene};
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::exact::ExactObstacles;
use cosfly_surroundings::ground::GroundGrid;

fn track_of(scene: &SeededScene, frames: usize) -> TargetTrack {
    let mut track = scene.walker(5, 1);
    track.states.truncate(frames);
    track
}

fn with_input<T>(
    track: &TargetTrack,
    boxes: &[OrientedBox],
    config: &MucoConfig,
    f: impl Fn(&BaselineInput<'_>) -> T,
) -> T {
    let terms = built_in_terms(&config.resolved_weights());
    let walk = Walk::of(track);
    let problem =
        Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in: terms.len(), first_frame: 0 };
    let ground = GroundGrid::sample(track, &|_, _| 0.0, 60.0);
    let exact = BruteForce::new(boxes);
    f(&BaselineInput { problem: &problem, planning_boxes: boxes, exact: &exact, movers: &[], ground: &ground, config })
}

/// Costs of every cell from the terms themselves, hovering there; infinite where it may not be.
fn cell_costs(grid: &VoxelGrid<'_>, input: &BaselineInput<'_>, keep_m: f64) -> Vec<f64> {
    let track = input.problem.track;
    let surroundings = ExactObstacles::still(track, input.exact, input.ground);
    let (view, walk) = (input.problem.view, input.problem.walk);
    let context = TermContext { track, view, walk, surroundings: &surroundings };
    let weights = input.config.resolved_weights();
    let terms: [(&dyn CostTerm, f64); 6] = [
        (&tracking::Tracking, weights.tracking),
        (&pitch::Pitch, weights.pitch),
        (&viewpoint::Viewpoint, weights.viewpoint),
        (&altitude::Altitude, weights.altitude),
        (&safety::Safety, weights.safety),
        (&visibility::Visibility, weights.visibility),
    ];
    let mut per_frame = vec![0.0; track.len()];
    (0..grid.nodes())
        .map(|node| {
            let cell = grid.cell_of(node);
            let position = grid.position(cell);
            let near = surroundings.nearest(cell.layer, position, keep_m).is_some();
            if near || grid.bare_cost(cell).is_none() {
                return f64::INFINITY;
            }
            let mut sum = 0.0;
            for (term, weight) in terms {
                term.cost(&vec![position; track.len()], &context, &mut per_frame);
                sum += weight * per_frame[cell.layer];
            }
            sum
        })
        .collect()
}

/// The cheapest way from a cell to the last layer by trying all.
fn exhaustive(grid: &VoxelGrid<'_>, costs: &[f64], free: &dyn Fn(DVec3, DVec3) -> bool, cell: Cell) -> f64 {
    let own = costs[grid.node_of(cell)];
    if cell.layer + 1 == grid.layers.len() || own.is_infinite() {
        return own;
    }
    let ways = (0..MOVES).filter_map(|m| {
        let next = grid.moved(cell, m)?;
        free(grid.position(cell), grid.position(next))
            .then(|| f64::from(grid.move_cost[m]) + exhaustive(grid, costs, free, next))
    });
    own + ways.fold(f64::INFINITY, f64::min)
}

#[test]
fn astar_finds_the_cheapest_of_all_ways_through_a_small_grid() {
    let scene = SeededScene::generate(SceneKind::Leafy, 3);
    let mut config = MucoConfig::default();
    config.view.min_altitude_m = 4.0;
    config.view.preferred_altitude_m = 5.0;
    config.view.max_altitude_m = 8.0;
    (config.view.min_radius_m, config.view.max_radius_m) = (1.0, 5.0);
    let options = VoxelOptions { voxel_m: 2.5, motion_per_m: 0.7 };
    for first in [0, 40, 80] {
        let mut track = track_of(&scene, 200);
        track.states = track.states[first..first + 4].to_vec();
        with_input(&track, &scene.boxes, &config, |input| {
            let grid = VoxelGrid::new(input.problem, input.ground, &config, options).expect("small");
            let keep_m = 0.6;
            let costs = cell_costs(&grid, input, keep_m);
            let free = |a: DVec3, b: DVec3| input.exact.segment_clearance(a, b, keep_m) >= keep_m;
            let starts = (0..grid.cells_per_layer()).map(|node| exhaustive(&grid, &costs, &free, grid.cell_of(node)));
            let best = starts.fold(f64::INFINITY, f64::min);
            let tree = BoxBvh::build(scene.boxes.clone());
            let found = astar(&grid, &tree, keep_m, 8.0).expect("there is a way");
            assert!((found.cost - best).abs() < 1e-3 * best, "A* {} exhaustive {best}", found.cost);
            let wide = beam(&grid, &tree, keep_m, 8.0, grid.cells_per_layer()).expect("there is a way");
            assert!((wide.cost - best).abs() < 1e-3 * best, "beam {} exhaustive {best}", wide.cost);
        });
    }
}

#[test]
fn no_voxel_path_comes_nearer_than_the_clearance_and_no_beam_is_cheaper_than_the_optimum() {
    let config = MucoConfig::default();
    for kind in [SceneKind::Leafy, SceneKind::Alley, SceneKind::Canyon] {
        let mut scene = SeededScene::generate(kind, 4);
        scene.boxes.iter_mut().step_by(5).for_each(|shape| shape.yaw_rad = 0.1);
        let track = track_of(&scene, 25);
        with_input(&track, &scene.boxes, &config, |input| {
            let mut costs = Vec::new();
            for baseline in [Baseline::AstarFast, Baseline::Beam] {
                let found = plan_baseline(baseline, input).expect("the way is free");
                assert_eq!(found.waypoints.len(), track.len());
                for pair in found.waypoints.windows(2) {
                    let clearance_m = input.exact.segment_clearance(pair[0], pair[1], 50.0);
                    assert!(clearance_m >= config.limits.clearance_m, "{} {clearance_m}", baseline.name());
                    let step = (pair[1] - pair[0]).abs();
                    assert!(step.cmple(DVec3::splat(2.0 + 1e-9)).all(), "{step}");
                }
                costs.push(found.cost);
            }
            assert!(costs[1] >= costs[0] - 1e-3, "{}: a beam cannot beat the optimum", kind.name());
        });
    }
}

#[test]
fn sealed_places_long_tracks_and_broken_ones_are_refused_in_words() {
    let scene = SeededScene::generate(SceneKind::Light, 1);
    let config = MucoConfig::default();
    let track = track_of(&scene, 10);
    let around = OrientedBox::from_corners(DVec3::splat(-600.0), DVec3::splat(600.0));
    with_input(&track, &[around], &config, |input| {
        for baseline in [Baseline::AstarFast, Baseline::Beam] {
            let reason = plan_baseline(baseline, input).expect_err("no room").to_string();
            assert!(reason.contains("frame 0"), "{reason}");
        }
    });
    let mut long = track.clone();
    long.states = vec![track.states[0]; 100_000];
    with_input(&long, &[], &config, |input| {
        assert!(plan_baseline(Baseline::AstarFast, input).expect_err("too long").to_string().contains("nodes"));
    });
    let mut lost = track.clone();
    lost.states[3].feet_in_world.x = f64::NAN;
    let mut leaping = track.clone();
    leaping.states[3].feet_in_world.x += 1e9;
    for (broken, word) in [(lost, "finite"), (leaping, "frame 3")] {
        with_input(&broken, &[], &config, |input| {
            for baseline in Baseline::ALL {
                let reason = plan_baseline(baseline, input).expect_err("refused").to_string();
                assert!(reason.contains(word), "{reason}");
            }
        });
    }
    let one = TargetTrack { states: track.states[..1].to_vec(), ..track.clone() };
    with_input(&one, &[], &config, |input| {
        assert_eq!(plan_baseline(Baseline::AstarFast, input).expect("one frame").waypoints.len(), 1);
    });
}
