//! Part of a map over the ground that a view can need, such as a map of shadows.

use crate::eye::Eye;
use crate::visibility::Screen;
use cosfly_frames::{DVec2, DVec3};

/// Reach of a view ahead, metres.
pub const FAR_M: f64 = 600.0;

/// Rectangle of texels, by column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SeenRegion {
    /// First texels.
    pub first: [usize; 2],
    /// Texels past the last.
    pub end: [usize; 2],
}

impl SeenRegion {
    /// Least rectangle of whole steps, within a map, around places between `low` and `high` (texels).
    pub fn around(low: DVec2, high: DVec2, side: usize, step: usize) -> Self {
        let size = step as f64;
        let inside = |steps: f64| ((steps.clamp(0.0, side as f64) as usize) * step).min(side);
        let first = (low / size).floor().to_array().map(inside);
        let end = (high / size).ceil().to_array().map(inside);
        let is_empty = first[0] >= end[0] || first[1] >= end[1];
        if is_empty { Self { first: [0; 2], end: [0; 2] } } else { Self { first, end } }
    }
}

/// Visits points whose convex hull holds all that a camera sees above a height, up to [`FAR_M`] ahead: corners of the
/// view's pyramid, cut.
pub fn for_seen_points(eye: &Eye, screen: &Screen, lowest_m: f64, mut visit: impl FnMut(DVec3)) {
    let apex = eye.position_in_world;
    let (width, height) = (screen.width as f64, screen.height as f64);
    let across = screen.center_u.max(width - screen.center_u) / screen.focal_px;
    let up = screen.center_v.max(height - screen.center_v) / screen.focal_px;
    let far = [(-across, -up), (across, -up), (across, up), (-across, up)]
        .map(|(y, z)| apex + FAR_M * (eye.world_from_body * DVec3::new(1.0, y, z)));
    let mut keep = |from: DVec3, to: DVec3| {
        [from, to].into_iter().filter(|point| point.z >= lowest_m).for_each(&mut visit);
        if (from.z < lowest_m) != (to.z < lowest_m) {
            visit(from + (to - from) * ((lowest_m - from.z) / (to.z - from.z)));
        }
    };
    for k in 0..4 {
        keep(apex, far[k]);
        keep(far[k], far[(k + 1) % 4]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::Camera;
    use cosfly_frames::Pose;

    #[test]
    fn what_a_camera_sees_lies_in_the_hull_of_its_points() {
        let camera = Camera { width: 64, height: 48, horizontal_fov_rad: 1.5 };
        let screen = Screen::new(&camera);
        for pitch_deg in [-80.0f64, -45.0, -20.0, 0.0, 30.0] {
            let pose = Pose {
                position_in_world: DVec3::new(5.0, -3.0, 20.0),
                pitch_rad: pitch_deg.to_radians(),
                yaw_rad: 0.7,
                roll_rad: 0.1,
            };
            let eye = Eye::new(&pose);
            let mut hull = vec![];
            for_seen_points(&eye, &screen, 0.0, |point| hull.push(point));
            for i in 0..48 * 64 {
                let y = ((i % 64) as f64 + 0.5 - screen.center_u) / screen.focal_px;
                let z = (screen.center_v - (i / 64) as f64 - 0.5) / screen.focal_px;
                let ray = eye.world_from_body * DVec3::new(1.0, y, z);
                let reach = if ray.z < 0.0 { (-20.0 / ray.z).min(FAR_M) } else { FAR_M };
                let point = pose.position_in_world + ray * reach;
                for turn in 0..8 {
                    let side = DVec3::new([1.0, 0.7, 0.0, -0.7][turn % 4], [0.0, 0.7, 1.0, 0.7][turn % 4], 0.3);
                    let side = if turn < 4 { side } else { -side };
                    let most = hull.iter().map(|corner| corner.dot(side)).fold(f64::NEG_INFINITY, f64::max);
                    assert!(point.dot(side) <= most + 1e-6, "{pitch_deg} {i} {turn}");
                }
            }
        }
    }

    #[test]
    fn regions_are_whole_steps_within_the_map() {
        let region = SeenRegion::around(DVec2::new(-40.0, 130.0), DVec2::new(200.0, 300.0), 1024, 128);
        assert_eq!(region, SeenRegion { first: [0, 128], end: [256, 384] });
        let nothing = SeenRegion::around(DVec2::new(-9.0, 5.0), DVec2::new(-1.0, 6.0), 1024, 128);
        assert_eq!(nothing, SeenRegion::around(DVec2::INFINITY, DVec2::NEG_INFINITY, 1024, 128));
    }
}
