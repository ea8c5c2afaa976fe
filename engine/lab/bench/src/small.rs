//! Small pictures: CPU time of depth, labels and ids in the large renderer and in the batch renderer, in turns, and the
//! pixels in which they differ.

use crate::clock::timed;
use crate::render::views::Ground;
use cosfly_batch::{BatchRenderer, BatchScene, Outputs, View};
use cosfly_frames::{DVec3, TargetState};
use cosfly_maps::GroundIndex;
use cosfly_random::Seed;
use cosfly_render::{Bystander, Camera, FrameParts, FrameSetup, Renderer, Walker, Weather};
use serde::Serialize;
use std::fmt;
use std::hint::black_box;

/// Field of view, radians.
const FOV_RAD: f64 = core::f64::consts::FRAC_PI_2;
/// People stand and walk within this distance of the target along both axes, metres.
const AROUND_M: f64 = 40.0;

/// Options of the measurement.
pub struct SmallOptions {
    /// The town with its views.
    pub ground: Ground,
    /// Sides of the square pictures, pixels.
    pub sizes: Vec<u32>,
    /// People around each target.
    pub people: u32,
    /// Rounds over all views; the minimum counts.
    pub rounds: usize,
}

/// Times of one size.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SmallRow {
    /// Side of the pictures, pixels.
    pub size: u32,
    /// CPU time of a picture in the large renderer, milliseconds.
    pub large_ms: f64,
    /// CPU time of a picture in the batch renderer, milliseconds.
    pub small_ms: f64,
    /// Pixels that differ in depth by more than the bound, in label, or in id, of a million.
    pub differing_ppm: f64,
}

/// All sizes, printed as a table.
#[derive(Clone, Debug, Serialize)]
pub struct SmallReport {
    /// Name of the town.
    pub town: String,
    /// Number of boxes in the town.
    pub boxes: usize,
    /// Number of views.
    pub views: usize,
    /// People around each target.
    pub people: u32,
    /// CPU time of preparing the town, once, milliseconds.
    pub prepare_ms: f64,
    /// Memory of the prepared town, megabytes.
    pub town_mb: f64,
    /// By size.
    pub rows: Vec<SmallRow>,
}

/// Runs the measurement.
pub fn measure(options: &SmallOptions) -> SmallReport {
    let ground = &options.ground;
    let (scene, prepare_s) = timed(|| BatchScene::without_colours(&ground.town));
    let index = GroundIndex::new(&ground.town);
    let crowds: Vec<Vec<Bystander>> =
        ground.views.iter().map(|place| crowd(place.target.state.feet_in_world, options.people, &index)).collect();
    let rows = options.sizes.iter().map(|size| row(options, &scene, &crowds, *size)).collect();
    SmallReport {
        town: ground.name.clone(),
        boxes: ground.town.obstacles.len(),
        views: ground.views.len(),
        people: options.people,
        prepare_ms: 1e3 * prepare_s,
        town_mb: 1e-6 * scene.bytes() as f64,
        rows,
    }
}

fn crowd(around: DVec3, count: u32, index: &GroundIndex) -> Vec<Bystander> {
    let mut random = Seed([6; 32]).stream("crowd");
    let person = |number: u32| {
        let away = DVec3::new(random.uniform(-AROUND_M, AROUND_M), random.uniform(-AROUND_M, AROUND_M), 0.0);
        let mut feet_in_world = around + away;
        feet_in_world.z = index.ground_height_m(feet_in_world.x, feet_in_world.y).unwrap_or(around.z);
        let walker = Walker {
            state: TargetState {
                feet_in_world,
                heading_rad: random.uniform(-3.1, 3.1),
                speed_mps: random.uniform(0.0, 1.8),
            },
            height_m: random.uniform(1.5, 1.95),
            radius_m: random.uniform(0.24, 0.34),
            clothes_seed: Seed([6; 32]).child("clothes", u64::from(number)),
            gait_phase_rad: random.uniform(-3.1, 3.1),
            body: cosfly_render::BodyShape::Person,
        };
        Bystander { walker, instance: 1_000_000 + number }
    };
    (0..count).map(person).collect()
}

fn row(options: &SmallOptions, scene: &BatchScene, crowds: &[Vec<Bystander>], size: u32) -> SmallRow {
    let ground = &options.ground;
    let weather = Weather::preset("ClearNoon").expect("a preset");
    let pixels = (size * size) as usize;
    let mut large = Renderer::new(Camera { width: size, height: size, horizontal_fov_rad: FOV_RAD });
    let mut small = BatchRenderer::new(size, size);
    let views: Vec<View<'_>> = ground
        .views
        .iter()
        .zip(crowds)
        .map(|(place, others)| View {
            scene,
            pose: place.pose,
            horizontal_fov_rad: FOV_RAD,
            target: Some(place.target.walker()),
            others,
            weather: None,
            figures: &[],
        })
        .collect();
    let mut depth_m = vec![0.0f32; views.len() * pixels];
    let mut semantic = vec![0u8; views.len() * pixels];
    let mut instance = vec![0u32; views.len() * pixels];
    let (mut large_s, mut small_s, mut differing) = (f64::INFINITY, f64::INFINITY, 0);
    for round in 0..options.rounds.max(1) {
        let outputs = Outputs {
            depth_m: Some(&mut depth_m),
            semantic: Some(&mut semantic),
            instance: Some(&mut instance),
            target_mask: None,
            rgb: None,
        };
        small_s = small_s.min(timed(|| small.render(&views, outputs)).1);
        let mut spent_s = 0.0;
        for (number, (place, others)) in ground.views.iter().zip(crowds).enumerate() {
            let setup = FrameSetup { pose: place.pose, weather: &weather, target: Some(place.target), others };
            let (frame, frame_s) = timed(|| large.render_parts(&ground.scene, &setup, FrameParts::Ids));
            spent_s += frame_s;
            if round == 0 {
                let images = black_box(frame).images;
                let at = number * pixels;
                differing += (0..pixels)
                    .filter(|pixel| {
                        let (ours, theirs) = (f64::from(depth_m[at + pixel]), f64::from(images.depth_m[*pixel]));
                        let is_same_depth = ours == theirs || (ours - theirs).abs() <= 1e-3 + 1e-5 * theirs;
                        !is_same_depth
                            || semantic[at + pixel] != images.semantic[*pixel]
                            || instance[at + pixel] != images.instance[*pixel]
                    })
                    .count();
            }
        }
        large_s = large_s.min(spent_s);
    }
    let count = views.len().max(1) as f64;
    SmallRow {
        size,
        large_ms: 1e3 * large_s / count,
        small_ms: 1e3 * small_s / count,
        differing_ppm: 1e6 * differing as f64 / (count * pixels as f64),
    }
}

impl fmt::Display for SmallReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}: {} boxes, {} people around each target, {} views; CPU milliseconds per picture on one core",
            self.town, self.boxes, self.people, self.views
        )?;
        writeln!(f, "the town: {:.0} ms once, {:.1} MB\n", self.prepare_ms, self.town_mb)?;
        writeln!(f, "{:>6} {:>10} {:>10} {:>8} {:>14}", "pixels", "large", "batch", "times", "differ (ppm)")?;
        for row in &self.rows {
            let times = row.large_ms / row.small_ms;
            writeln!(
                f,
                "{:>6} {:>10.3} {:>10.3} {times:>8.1} {:>14.0}",
                row.size, row.large_ms, row.small_ms, row.differing_ppm
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tiny_measurement_has_every_figure() {
        let camera = Camera { width: 64, height: 64, horizontal_fov_rad: FOV_RAD };
        let report = measure(&SmallOptions {
            ground: Ground::of_boxes(60, camera, 3),
            sizes: vec![32, 64],
            people: 4,
            rounds: 1,
        });
        assert!(report.rows.iter().all(|row| row.small_ms > 0.0 && row.large_ms > 0.0 && row.differing_ppm < 1500.0));
        assert!(report.to_string().contains("60 boxes, 4 people") && report.rows.len() == 2);
    }
}
