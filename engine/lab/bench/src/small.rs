//! Small pictures: CPU time of depth, labels and ids, and of colours, in the large renderer and in the batch renderer, in
//! turns, and the pixels in which they differ.

use crate::clock::timed;
use crate::render::views::Ground;
use cosfly_batch::{BatchRenderer, BatchScene, BatchView, Outputs};
use cosfly_domain::{Camera, FrameImages};
use cosfly_figures::{BodyFigure, FigureInPicture};
use cosfly_frames::{DVec3, TargetState};
use cosfly_random::Seed;
use cosfly_render::{FrameParts, FrameSetup, PictureLook, Renderer};
use cosfly_town::GroundIndex;
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
    /// Whether colours are measured, too.
    pub has_colours: bool,
}

/// Content of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Content {
    /// Depth, labels and ids.
    Geometry,
    /// Colours in the simple look.
    Simple,
    /// Colours in the full look.
    Full,
}

impl Content {
    fn name(self) -> &'static str {
        match self {
            Self::Geometry => "depth + ids",
            Self::Simple => "simple",
            Self::Full => "full",
        }
    }

    fn look(self) -> PictureLook {
        if self == Self::Full { PictureLook::Full } else { PictureLook::Simple }
    }

    fn parts(self) -> FrameParts {
        if self == Self::Geometry { FrameParts::Ids } else { FrameParts::All }
    }
}

/// Times of one size.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SmallRow {
    /// Side of the pictures, pixels.
    pub size: u32,
    /// Content of the pictures.
    pub content: Content,
    /// CPU time of a picture in the large renderer, milliseconds.
    pub large_ms: f64,
    /// CPU time of a picture in the batch renderer, milliseconds.
    pub small_ms: f64,
    /// Pixels that differ in depth by more than the bound, in label, or in id, or in a colour by more than two levels, of a
    /// million.
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
    let (scene, prepare_s) = timed(|| BatchScene::without_colours(&ground.town, &GroundIndex::new(&ground.town)));
    let index = GroundIndex::new(&ground.town);
    let crowds: Vec<Vec<FigureInPicture>> =
        ground.views.iter().map(|place| crowd(place.target.state.feet_in_world, options.people, &index)).collect();
    let mut rows: Vec<SmallRow> =
        options.sizes.iter().map(|size| row(options, &scene, &crowds, (*size, Content::Geometry))).collect();
    let town_mb = 1e-6 * scene.bytes() as f64;
    if options.has_colours {
        let scene = BatchScene::new(&ground.town, Seed([1; 32]));
        for content in [Content::Simple, Content::Full] {
            rows.extend(options.sizes.iter().map(|size| row(options, &scene, &crowds, (*size, content))));
        }
    }
    SmallReport {
        town: ground.name.clone(),
        boxes: ground.town.obstacles.len(),
        views: ground.views.len(),
        people: options.people,
        prepare_ms: 1e3 * prepare_s,
        town_mb,
        rows,
    }
}

fn crowd(around: DVec3, count: u32, index: &GroundIndex) -> Vec<FigureInPicture> {
    let mut random = Seed([6; 32]).stream("crowd");
    let person = |number: u32| {
        let away = DVec3::new(random.uniform(-AROUND_M, AROUND_M), random.uniform(-AROUND_M, AROUND_M), 0.0);
        let mut feet_in_world = around + away;
        feet_in_world.z = index.ground_height_m(feet_in_world.x, feet_in_world.y).unwrap_or(around.z);
        let figure = BodyFigure {
            state: TargetState {
                feet_in_world,
                heading_rad: random.uniform(-3.1, 3.1),
                speed_mps: random.uniform(0.0, 1.8),
            },
            height_m: random.uniform(1.5, 1.95),
            radius_m: random.uniform(0.24, 0.34),
            clothes_seed: Seed([6; 32]).child("clothes", u64::from(number)),
            gait_phase_rad: random.uniform(-3.1, 3.1),
            body: cosfly_figures::BodyShape::default(),
        };
        FigureInPicture { figure, instance: 1_000_000 + number }
    };
    (0..count).map(person).collect()
}

fn row(
    options: &SmallOptions,
    scene: &BatchScene,
    crowds: &[Vec<FigureInPicture>],
    (size, content): (u32, Content),
) -> SmallRow {
    let ground = &options.ground;
    let weather = cosfly_materials::presets::preset("ClearNoon").expect("a preset");
    let mut large = Renderer::new(Camera { width: size, height: size, horizontal_fov_rad: FOV_RAD });
    large.set_look(content.look());
    let mut small = BatchRenderer::new(size, size);
    let views: Vec<BatchView<'_>> = ground
        .views
        .iter()
        .zip(crowds)
        .map(|(place, others)| BatchView {
            scene,
            pose: place.pose,
            horizontal_fov_rad: FOV_RAD,
            target: Some(place.target),
            others,
            weather: None,
            look: content.look(),
        })
        .collect();
    let mut drawn = Drawn::new(content, (size * size) as usize, views.len());
    let (mut large_s, mut small_s, mut differing) = (f64::INFINITY, f64::INFINITY, 0);
    for round in 0..options.rounds.max(1) {
        small_s = small_s.min(timed(|| small.render(&views, drawn.outputs())).1);
        let mut spent_s = 0.0;
        for (number, (place, others)) in ground.views.iter().zip(crowds).enumerate() {
            let setup = FrameSetup { pose: place.pose, weather: &weather, target: Some(place.target), others };
            let (frame, frame_s) = timed(|| large.render_parts(&ground.scene, &setup, content.parts()));
            spent_s += frame_s;
            if round == 0 {
                differing += drawn.differing(number, black_box(frame).images);
            }
        }
        large_s = large_s.min(spent_s);
    }
    let count = views.len().max(1) as f64;
    SmallRow {
        size,
        content,
        large_ms: 1e3 * large_s / count,
        small_ms: 1e3 * small_s / count,
        differing_ppm: 1e6 * differing as f64 / (count * f64::from(size * size)),
    }
}

/// Small pictures, one after the other.
struct Drawn {
    content: Content,
    pixels: usize,
    depth_m: Vec<f32>,
    semantic: Vec<u8>,
    instance: Vec<u32>,
    rgb: Vec<u8>,
}

impl Drawn {
    fn new(content: Content, pixels: usize, views: usize) -> Self {
        let all = pixels * views;
        Self {
            content,
            pixels,
            depth_m: vec![0.0; all],
            semantic: vec![0; all],
            instance: vec![0; all],
            rgb: vec![0; 3 * all],
        }
    }

    fn outputs(&mut self) -> Outputs<'_> {
        match self.content {
            Content::Geometry => Outputs {
                depth_m: Some(&mut self.depth_m),
                semantic: Some(&mut self.semantic),
                instance: Some(&mut self.instance),
                ..Outputs::default()
            },
            _ => Outputs { rgb: Some(&mut self.rgb), ..Outputs::default() },
        }
    }

    /// Number of the pixels of a picture that differ from those of the large renderer.
    fn differing(&self, number: usize, images: &FrameImages) -> usize {
        let at = number * self.pixels;
        let geometry = |pixel: &usize| {
            let (ours, theirs) = (f64::from(self.depth_m[at + pixel]), f64::from(images.depth_m[*pixel]));
            let is_same_depth = ours == theirs || (ours - theirs).abs() <= 1e-3 + 1e-5 * theirs;
            !is_same_depth
                || self.semantic[at + pixel] != images.semantic[*pixel]
                || self.instance[at + pixel] != images.instance[*pixel]
        };
        let colours =
            |pixel: &usize| (0..3).any(|k| self.rgb[3 * (at + pixel) + k].abs_diff(images.rgb[3 * pixel + k]) > 2);
        let pixels = 0..self.pixels;
        match self.content {
            Content::Geometry => pixels.filter(geometry).count(),
            _ => pixels.filter(colours).count(),
        }
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
        let heads = ["content", "pixels", "large", "batch", "times", "differ (ppm)"];
        writeln!(
            f,
            "{:<12}{:>6} {:>10} {:>10} {:>8} {:>14}",
            heads[0], heads[1], heads[2], heads[3], heads[4], heads[5]
        )?;
        for row in &self.rows {
            let times = row.large_ms / row.small_ms;
            writeln!(
                f,
                "{:<12}{:>6} {:>10.3} {:>10.3} {times:>8.1} {:>14.0}",
                row.content.name(),
                row.size,
                row.large_ms,
                row.small_ms,
                row.differing_ppm
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
            has_colours: true,
        });
        assert!(report.rows.iter().all(|row| row.small_ms > 0.0 && row.large_ms > 0.0 && row.differing_ppm < 4000.0));
        assert!(report.to_string().contains("60 boxes, 4 people") && report.rows.len() == 6);
    }
}
