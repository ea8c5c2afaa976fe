//! [`assert_well_formed`]: the rules that every town keeps.

use cosfly_domain::{OrientedBox, Town};
use cosfly_frames::DVec3;

/// Largest coordinate of a town, metres.
const FARTHEST_M: f64 = 1e7;

/// Checks every rule of the type: finite numbers, indices in range, sizes not negative, polygons with at
/// least three corners, everything within the bounds. The error names the broken rule and the place.
pub fn assert_well_formed(town: &Town) -> Result<(), String> {
    let near = |point: DVec3| point.is_finite() && point.abs().max_element() <= FARTHEST_M;
    for (i, obstacle) in town.obstacles.iter().enumerate() {
        check_box(&obstacle.shape).map_err(|rule| format!("obstacle {i}: {rule}"))?;
    }
    for (i, shape) in town.planning_boxes.iter().enumerate() {
        check_box(shape).map_err(|rule| format!("planning box {i}: {rule}"))?;
    }
    for (i, polygon) in town.walkable.iter().enumerate() {
        let outline = &polygon.outline_in_world;
        if outline.len() < 3 || !outline.iter().all(|point| near(*point)) {
            return Err(format!("walkable polygon {i} has {} corners or one that is far away", outline.len()));
        }
    }
    check_lanes(town, near)?;
    for (i, mesh) in town.surfaces.iter().enumerate() {
        let count = mesh.vertices_in_world.len();
        if mesh.along_across_m.len() != count || !mesh.along_across_m.iter().all(|uv| uv.is_finite()) {
            return Err(format!("surface {i} lacks finite along/across values for its {count} vertices"));
        }
        if !mesh.vertices_in_world.iter().all(|point| near(*point)) {
            return Err(format!("surface {i} has a vertex that is far away"));
        }
        if mesh.triangles.iter().flatten().any(|corner| *corner as usize >= count) {
            return Err(format!("surface {i} has a triangle beyond its {count} vertices"));
        }
    }
    if !(near(town.min_in_world) && near(town.max_in_world) && town.min_in_world.cmple(town.max_in_world).all()) {
        return Err(format!("the bounds {} to {} are not an ordered box", town.min_in_world, town.max_in_world));
    }
    Ok(())
}

/// Checks the lanes; see [`assert_well_formed`].
fn check_lanes(town: &Town, is_near: impl Fn(DVec3) -> bool) -> Result<(), String> {
    for (i, lane) in town.lanes.iter().enumerate() {
        let line = &lane.middle_in_world;
        if line.len() < 2 || !line.iter().all(|point| is_near(*point)) {
            return Err(format!("lane {i} has {} points or one that is far away", line.len()));
        }
        let sizes = [lane.width_m, lane.speed_limit_mps];
        if !sizes.iter().all(|size| size.is_finite() && *size > 0.0) {
            return Err(format!("lane {i} has the width and speed limit {sizes:?}"));
        }
        let has = |list: &[u32], count: usize| list.iter().all(|index| (*index as usize) < count);
        if !has(&lane.successors, town.lanes.len()) || !has(&lane.crossings, town.walkable.len()) {
            return Err(format!("lane {i} has a follower or a crossing that does not exist"));
        }
    }
    Ok(())
}

fn check_box(shape: &OrientedBox) -> Result<(), String> {
    let half = shape.half_extents_m;
    if !(shape.center_in_world.is_finite() && half.is_finite() && shape.yaw_rad.is_finite()) {
        return Err("its numbers are not finite".to_owned());
    }
    if half.min_element() < 0.0 || shape.center_in_world.abs().max_element() + half.length() > FARTHEST_M {
        return Err(format!("its half extents are {half} at {}", shape.center_in_world));
    }
    Ok(())
}
