//! Motion blur: the mean light of several moments while the shutter is open.

use cosfly_frames::{Pose, TargetState, real};

/// The pose at frame number `at`, which may lie between two frames or a little outside of all: linear, angles the short way.
pub fn pose_at(poses: &[Pose], at: f64) -> Pose {
    let Some((first, share)) = place(poses.len(), at) else { return poses[0] };
    let (a, b) = (&poses[first], &poses[first + 1]);
    let angle = |from: f64, to: f64| from + turn_rad(to - from) * share;
    Pose {
        position_in_world: a.position_in_world + (b.position_in_world - a.position_in_world) * share,
        pitch_rad: angle(a.pitch_rad, b.pitch_rad),
        yaw_rad: angle(a.yaw_rad, b.yaw_rad),
        roll_rad: angle(a.roll_rad, b.roll_rad),
    }
}

/// The target's state at frame number `at`, as [`pose_at`].
pub fn target_state_at(states: &[TargetState], at: f64) -> TargetState {
    let Some((first, share)) = place(states.len(), at) else { return states[0] };
    let (a, b) = (&states[first], &states[first + 1]);
    TargetState {
        feet_in_world: a.feet_in_world + (b.feet_in_world - a.feet_in_world) * share,
        heading_rad: a.heading_rad + turn_rad(b.heading_rad - a.heading_rad) * share,
        speed_mps: (a.speed_mps + (b.speed_mps - a.speed_mps) * share).max(0.0),
    }
}

/// The first of the two frames that `at` lies between, and the share of the second; `None` when there is one frame only.
fn place(frames: usize, at: f64) -> Option<(usize, f64)> {
    let last = frames.checked_sub(2)?;
    let first = (at.floor().max(0.0) as usize).min(last);
    Some((first, at - first as f64))
}

fn turn_rad(difference: f64) -> f64 {
    difference - real::TAU * (difference / real::TAU).round()
}

/// Sums of light, per colour channel.
#[derive(Default)]
pub struct Exposure {
    tables: Option<Box<Tables>>,
    sums: Vec<u32>,
    pictures: u32,
    developed: Vec<u8>,
}

/// sRGB to light (16 bits) and back (upper 12 bits of it).
struct Tables {
    light: [u16; 256],
    srgb: [u8; 4097],
}

impl Tables {
    fn new() -> Box<Self> {
        let light = core::array::from_fn(|code| {
            let value = code as f32 / 255.0;
            let linear = if value <= 0.04045 { value / 12.92 } else { libm::powf((value + 0.055) / 1.055, 2.4) };
            (65535.0 * linear + 0.5) as u16
        });
        let srgb = core::array::from_fn(|step| {
            let linear = step as f32 / 4096.0;
            let value =
                if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 };
            (255.0 * value.clamp(0.0, 1.0) + 0.5) as u8
        });
        Box::new(Self { light, srgb })
    }
}

impl Exposure {
    /// Begins another picture.
    pub fn open(&mut self) {
        self.pictures = 0;
    }

    /// Adds a picture of one moment, sRGB bytes; all have one size.
    pub fn add(&mut self, rgb: &[u8]) {
        let light = &self.tables.get_or_insert_with(Tables::new).light;
        if self.pictures == 0 {
            self.sums.clear();
            self.sums.resize(rgb.len(), 0);
        }
        self.pictures += 1;
        self.sums.iter_mut().zip(rgb).for_each(|(sum, code)| *sum += u32::from(light[usize::from(*code)]));
    }

    /// The mean picture; `None` when nothing was added.
    pub fn developed(&mut self) -> Option<&[u8]> {
        let mut developed = std::mem::take(&mut self.developed);
        developed.resize(self.sums.len(), 0);
        let is_any = self.develop_into(&mut developed);
        self.developed = developed;
        is_any.then_some(&self.developed)
    }

    /// Writes the mean picture to `rgb`; nothing when nothing was added.
    pub fn develop_into(&self, rgb: &mut [u8]) -> bool {
        let Some(tables) = self.tables.as_ref().filter(|_| self.pictures > 0) else { return false };
        for (code, sum) in rgb.iter_mut().zip(&self.sums) {
            // Steps of 1/4096 are finer than a code everywhere but near black, where they are half a code.
            let mean = (sum + self.pictures / 2) / self.pictures;
            *code = tables.srgb[((mean + 8) >> 4) as usize];
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;

    #[test]
    fn a_still_picture_stays_as_it_is_and_black_and_white_give_the_grey_of_half_the_light() {
        let every: Vec<u8> = (0..=255).collect();
        let mut exposure = Exposure::default();
        exposure.open();
        (0..5).for_each(|_| exposure.add(&every));
        let off = exposure.developed().unwrap().iter().zip(&every).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(off <= Some(1), "{off:?}");
        exposure.open();
        exposure.add(&[0]);
        exposure.add(&[255]);
        assert_eq!(exposure.developed().unwrap(), [188]);
    }

    #[test]
    fn poses_between_frames_turn_the_short_way() {
        let pose = |x: f64, yaw_rad: f64| Pose {
            position_in_world: DVec3::new(x, 0.0, 0.0),
            pitch_rad: 0.0,
            yaw_rad,
            roll_rad: 0.0,
        };
        let poses = [pose(0.0, 3.0), pose(1.0, -3.0), pose(3.0, -3.0)];
        assert_eq!(pose_at(&poses, 1.0), poses[1]);
        let between = pose_at(&poses, 0.5);
        assert!((between.yaw_rad - real::PI).abs() < 1e-12 && between.position_in_world.x == 0.5);
        assert_eq!(pose_at(&poses, 2.5).position_in_world.x, 4.0);
        assert_eq!(pose_at(&poses[..1], -0.25), poses[0]);
    }
}
