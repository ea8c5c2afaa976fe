//! The ground that a picture shows around somebody's feet, by its depths and labels alone.

use cosfly_domain::Camera;
use cosfly_frames::{DVec2, DVec3, Pose};

/// CARLA's labels of ground: road, pavement, terrain, road line, other ground, rails.
const GROUND: [u8; 6] = [1, 2, 10, 24, 25, 27];
/// Ground this near to the axis of a body counts, metres.
const REACH_M: f64 = 0.55;
/// Its middle must be this near to the axis, metres: ground on one side alone may be the edge of a terrace that hides a lower path.
const MOST_OFFSET_M: f64 = 0.3;
/// Lowest ground that counts, from the feet, metres.
const LOWEST_M: f64 = -1.5;
/// Fewest pixels for a height.
const ENOUGH: usize = 4;
/// The share of pixels that may lie lower: they are seen past an edge.
const LOWER_SHARE: f64 = 0.1;
/// Most rows and columns of pixels that are looked at.
const MOST_STEPS: usize = 64;

/// Rise of the drawn ground over the feet from which on somebody stands below it, metres: more than rounding, less than a kerb.
pub const BELOW_GROUND_M: f64 = 0.08;
/// Fewest frames that show the ground around the feet for a verdict.
const ENOUGH_FRAMES: usize = 3;
/// The share of them in which it lies above the feet: ground in front of a lower path hides it for a while only.
const BELOW_SHARE: f64 = 0.6;

/// Whether somebody stands below drawn ground who does so in `below` of `seen` frames that show the ground around the feet.
pub fn is_below(below: usize, seen: usize) -> bool {
    seen >= ENOUGH_FRAMES && below as f64 >= BELOW_SHARE * seen as f64
}

/// Depths and labels of a frame, by the number of the pixel.
pub struct DrawnGround<'a> {
    /// The camera; its lens must be straight.
    pub camera: &'a Camera,
    /// Its pose.
    pub pose: &'a Pose,
    /// Planar depth, metres.
    pub depth_m: &'a dyn Fn(usize) -> Option<f64>,
    /// CARLA's label.
    pub label: &'a dyn Fn(usize) -> Option<u8>,
}

impl DrawnGround<'_> {
    /// Height of the ground around feet over them, metres; none where too little of it is seen. Ground from the height of a head on
    /// is a deck that somebody walks under.
    pub fn rise_m(&self, feet: DVec3, height_m: f64) -> Option<f64> {
        let [columns, rows] = self.window(feet, height_m)?;
        let step = |range: &core::ops::Range<usize>| range.len().div_ceil(MOST_STEPS).max(1);
        let (mut rises, mut sum) = (Vec::new(), DVec2::ZERO);
        for row in rows.clone().step_by(step(&rows)) {
            for column in columns.clone().step_by(step(&columns)) {
                let at = row * self.camera.width as usize + column;
                if !(self.label)(at).is_some_and(|label| GROUND.contains(&label)) {
                    continue;
                }
                let Some(depth_m) = (self.depth_m)(at).filter(|depth| depth.is_finite()) else { continue };
                let ray = self.camera.ray_in_world(self.pose, column as f64 + 0.5, row as f64 + 0.5);
                let away = self.pose.position_in_world + depth_m * ray - feet;
                if away.truncate().length() <= REACH_M && (LOWEST_M..height_m).contains(&away.z) {
                    rises.push(away.z);
                    sum += away.truncate();
                }
            }
        }
        rises.sort_by(f64::total_cmp);
        let is_around = rises.len() >= ENOUGH && sum.length() <= MOST_OFFSET_M * rises.len() as f64;
        rises.get((LOWER_SHARE * rises.len() as f64) as usize).copied().filter(|_| is_around)
    }

    /// Columns and rows that may show the ground around the feet.
    fn window(&self, feet: DVec3, height_m: f64) -> Option<[core::ops::Range<usize>; 2]> {
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for corner in 0..8 {
            let side = |bit: usize, low: f64, high: f64| if corner >> bit & 1 == 0 { low } else { high };
            let away = DVec3::new(
                side(0, -REACH_M, REACH_M),
                side(1, -REACH_M, REACH_M),
                side(2, LOWEST_M.max(-REACH_M), height_m),
            );
            let (u, v, _) = self.camera.project(self.pose, feet + away)?;
            for (ends, at) in ends.iter_mut().zip([u, v]) {
                *ends = [ends[0].min(at), ends[1].max(at)];
            }
        }
        let range = |[from, to]: [f64; 2], most: u32| {
            let within = |at: f64| at.clamp(0.0, f64::from(most)) as usize;
            within(from.floor())..within(to.ceil())
        };
        Some([range(ends[0], self.camera.width), range(ends[1], self.camera.height)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera { width: 320, height: 180, horizontal_fov_rad: 1.2 };

    /// Rise over feet at the origin where the drawn ground is level, seen from behind and above.
    fn rise_of(ground_m: f64, label: u8) -> Option<f64> {
        let pose = Pose::looking_at(DVec3::new(-9.0, 2.0, 7.0), DVec3::Z);
        let depth_m = |at: usize| {
            let (u, v) = ((at % 320) as f64 + 0.5, (at / 320) as f64 + 0.5);
            let ray = CAMERA.ray_in_world(&pose, u, v);
            Some((ground_m - 7.0) / ray.z).filter(|depth| *depth > 0.0)
        };
        DrawnGround { camera: &CAMERA, pose: &pose, depth_m: &depth_m, label: &|_| Some(label) }
            .rise_m(DVec3::ZERO, 1.8)
    }

    #[test]
    fn the_rise_of_level_ground_is_its_height_over_the_feet() {
        for ground_m in [0.0, 0.15, 0.5, 1.2, -0.2] {
            let rise_m = rise_of(ground_m, 2).expect("it is seen");
            assert!((rise_m - ground_m).abs() < 1e-9, "{ground_m}: {rise_m}");
        }
    }

    #[test]
    fn the_edge_of_a_terrace_in_front_of_a_lower_path_tells_nothing() {
        let pose = Pose::looking_at(DVec3::new(-9.0, 2.0, 7.0), DVec3::Z);
        let depth_m = |at: usize| {
            let ray = CAMERA.ray_in_world(&pose, (at % 320) as f64 + 0.5, (at / 320) as f64 + 0.5);
            // Ground at 0.6 m up to 0.3 m before the feet; beyond, what it does not hide.
            let far_m = (0.6 - 7.0) / ray.z;
            (far_m > 0.0 && (pose.position_in_world + far_m * ray).x < -0.3).then_some(far_m)
        };
        let seen = DrawnGround { camera: &CAMERA, pose: &pose, depth_m: &depth_m, label: &|_| Some(2) };
        assert_eq!(seen.rise_m(DVec3::ZERO, 1.8), None);
    }

    #[test]
    fn decks_overhead_and_things_are_no_ground() {
        assert_eq!(rise_of(3.0, 1), None);
        assert_eq!(rise_of(0.5, 3), None);
    }
}
