//! Distance of the walls in a depth image from the walls of the town, seen from a pose.

use cosfly_domain::Camera;
use cosfly_frames::{DVec3, Pose, real};
use cosfly_read::BoxInWorld;
use std::collections::BTreeMap;

/// Number of pixels of an image that are used, about.
const SAMPLES: f64 = 400.0;
/// Smallest number of pixels with walls.
const ENOUGH: usize = 12;

/// Boxes of a town's buildings and walls by their instance ids.
pub type Walls = BTreeMap<u32, Vec<BoxInWorld>>;

/// Points of walls that an image shows: instance id and place in the camera's body frame (x ahead, y right, z up), metres.
pub fn points(camera: &Camera, depth_m: &[f32], instances: &[u32], walls: &Walls) -> Vec<(u32, DVec3)> {
    let (width, height) = (camera.width as usize, camera.height as usize);
    let step = (((width * height) as f64 / SAMPLES).sqrt() as usize).max(1);
    let focal_px = camera.focal_px();
    let (cx, cy) = (0.5 * width as f64, 0.5 * height as f64);
    let mut points = vec![];
    for v in (step / 2..height).step_by(step) {
        for u in (step / 2..width).step_by(step) {
            let at = v * width + u;
            let (Some(depth), Some(id)) = (depth_m.get(at), instances.get(at)) else { continue };
            if depth.is_finite() && walls.contains_key(id) {
                let ahead = f64::from(*depth);
                let right = (u as f64 + 0.5 - cx) / focal_px;
                let down = (v as f64 + 0.5 - cy) / focal_px;
                points.push((*id, ahead * DVec3::new(1.0, right, -down)));
            }
        }
    }
    points
}

/// Median distance of the points from their walls, seen from `pose`, metres; none for few points.
pub fn middle_gap_m(points: &[(u32, DVec3)], pose: &Pose, walls: &Walls) -> Option<f64> {
    let world_from_body = pose.world_from_body();
    let gap = |(id, point): &(u32, DVec3)| {
        let place = pose.position_in_world + world_from_body * *point;
        walls[id].iter().map(|it| surface_distance_m(it, place)).fold(f64::INFINITY, f64::min)
    };
    let mut gaps: Vec<f64> = points.iter().map(gap).collect();
    gaps.sort_by(f64::total_cmp);
    gaps.get(gaps.len() / 2).copied().filter(|_| gaps.len() >= ENOUGH)
}

fn surface_distance_m((center, half, yaw_rad): &BoxInWorld, place: DVec3) -> f64 {
    let (sin, cos) = real::sin_cos(*yaw_rad);
    let away = place - *center;
    let own = DVec3::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z);
    let out = own.abs() - *half;
    (out.max(DVec3::ZERO).length() + out.max_element().min(0.0)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_ahead_is_met_from_its_own_pose_and_missed_from_another() {
        let camera = Camera { width: 40, height: 30, horizontal_fov_rad: 1.2 };
        let wall = (DVec3::new(12.0, 0.0, 0.0), DVec3::new(2.0, 50.0, 50.0), 0.0);
        let walls = Walls::from([(7, vec![wall])]);
        let points = points(&camera, &[10.0; 1200], &[7; 1200], &walls);
        let pose = |x: f64| Pose { position_in_world: DVec3::X * x, pitch_rad: 0.0, yaw_rad: 0.0, roll_rad: 0.0 };
        assert!(middle_gap_m(&points, &pose(0.0), &walls).is_some_and(|gap| gap < 1e-6));
        assert!(middle_gap_m(&points, &pose(-0.5), &walls).is_some_and(|gap| (gap - 0.5).abs() < 1e-6));
        assert!(middle_gap_m(&points[..5], &pose(0.0), &walls).is_none());
    }
}
