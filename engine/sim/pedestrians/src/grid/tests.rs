//! Laws of the grid: steps are symmetric and free, pieces are parted by obstacles, useless ground is refused.

use super::test_towns::{pillar, rectangle, streets, town};
use super::*;

fn build(town: &Town) -> Result<WalkableGrid, PedestrianError> {
    WalkableGrid::build(town, &PedestrianConfig::default())
}

/// Law of the grid: steps are symmetric, stay on the exact ground and out of the exact obstacles.
fn assert_well_formed(grid: &WalkableGrid) {
    for node in 0..grid.nodes.len() as u32 {
        for step in 0..8 {
            let Some(other) = grid.neighbour(node, step) else { continue };
            assert_eq!(grid.neighbour(other, (step + 4) % 8), Some(node));
            assert_eq!(grid.nodes[node as usize].component, grid.nodes[other as usize].component);
            let at = |node: u32| grid.center(node).extend(f64::from(grid.nodes[node as usize].z));
            assert!(grid.ground.covers(at(node), at(other)), "{} to {}", at(node), at(other));
            assert!(grid.obstruction.lets_through(at(node), at(other), grid.radius_m, grid.height_m));
        }
    }
}

#[test]
fn every_step_of_the_grid_is_free_in_the_exact_sense() {
    let mut town = streets();
    for i in 0..40 {
        let mut post = pillar((f64::from(i) * 2.9, 0.3 + 0.07 * f64::from(i)), 0.15, 3.0);
        post.shape.yaw_rad = f64::from(i);
        town.obstacles.push(post);
    }
    let grid = build(&town).unwrap();
    assert_well_formed(&grid);
    assert_eq!(grid.components.len(), 1);
}

#[test]
fn free_steps_agree_with_the_exact_test_everywhere() {
    let mut town = streets();
    town.obstacles.push(pillar((30.0, 1.0), 0.4, 3.0));
    let grid = build(&town).unwrap();
    let mut stream = cosfly_frames::Seed::of_item(1, "grid", "steps").stream("points");
    let mut agreed = [0, 0];
    for _ in 0..20_000 {
        let from = DVec2::new(stream.uniform(-3.0, 60.0), stream.uniform(-3.0, 40.0));
        let to = from + DVec2::new(stream.uniform(-2.0, 2.0), stream.uniform(-2.0, 2.0));
        let (from3, to3) = (from.extend(0.0), to.extend(0.0));
        let exact =
            grid.ground.covers(from3, to3) && grid.obstruction.lets_through(from3, to3, grid.radius_m, grid.height_m);
        let near = grid.z_near(from).is_some() && grid.z_near(to).is_some();
        assert_eq!(grid.step_is_free(from, to), exact && near, "{from} to {to}");
        agreed[usize::from(exact)] += 1;
    }
    assert!(agreed[0] > 1000 && agreed[1] > 1000, "{agreed:?}");
}

#[test]
fn heights_follow_a_slope_and_a_cliff_parts_the_ground() {
    let mut slope = rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (100.0, 3.0), 0.0);
    slope.outline_in_world[1].z = 8.0;
    slope.outline_in_world[2].z = 8.0;
    let terrace = rectangle(WalkableKind::Sidewalk, (0.0, 3.0), (100.0, 6.0), 20.0);
    let grid = build(&town(vec![slope, terrace], vec![])).unwrap();
    assert_eq!(grid.components.len(), 2);
    let (feet, kind) = grid.feet_at(DVec2::new(50.0, 1.0));
    assert!((feet.z - 4.0).abs() < 1e-9 && kind == Some(WalkableKind::Sidewalk));
    assert_well_formed(&grid);
}

#[test]
fn a_wall_of_boxes_parts_a_pavement_and_a_crown_does_not() {
    let pavement = rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (60.0, 3.0), 0.0);
    let mut crown = pillar((30.0, 1.5), 2.0, 2.0);
    crown.shape.center_in_world.z = 5.0;
    assert_eq!(build(&town(vec![pavement.clone()], vec![crown])).unwrap().components.len(), 1);
    let wall = pillar((30.0, 1.5), 1.6, 2.0);
    assert_eq!(build(&town(vec![pavement], vec![wall])).unwrap().components.len(), 2);
}

#[test]
fn ground_that_nobody_can_walk_on_is_refused_with_what_helps() {
    let pavement = rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (60.0, 3.0), 0.0);
    let check = |town: Town, message: &str, hint: &str| {
        let error = build(&town).unwrap_err();
        assert!(error.to_string().contains(message), "{error}");
        assert!(error.hint().contains(hint), "{}", error.hint());
    };
    check(town(vec![], vec![]), "no walkable ground", "pavements or streets");
    check(town(vec![pavement.clone()], vec![pillar((30.0, 0.0), 80.0, 3.0)]), "none of the town's 1", "radius");
    check(town(vec![rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (0.5, 0.5), 0.0)], vec![]), "none of", "grid_m");
    let mut broken = pavement.clone();
    broken.outline_in_world[2].y = f64::NAN;
    check(town(vec![broken], vec![]), "corner 2 of walkable polygon 0", "repair");
    let mut thing = pillar((0.0, 0.0), 1.0, 1.0);
    thing.shape.half_extents_m.x = f64::INFINITY;
    check(town(vec![pavement], vec![thing]), "obstacle 0", "repair");
    let vast = rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (60_000.0, 60_000.0), 0.0);
    check(town(vec![vast], vec![]), "spans 3600 square kilometres", "`bounds_m = [");
    let dense = rectangle(WalkableKind::Sidewalk, (0.0, 0.0), (4_000.0, 4_000.0), 0.0);
    check(town(vec![dense], vec![]), "cells at `grid_m` of 0.5 m", "larger");
}
