//! Steadiness of pictures: pixels whose colour changes more than the camera's motion explains, in a clip of a still town.
//!
//! Each frame is compared with the one before it: a pixel's place in the world, from its depth, is found in the earlier frame.
//! Where the same thing is seen there with all its neighbours, the pixel's brightness must lie between the least and the
//! greatest of the nine pixels around that place, give or take [`TOLERANCE_CODES`]: what lies outside popped.

use cosfly_domain::{Camera, FrameImages, SemanticLabel, Weather};
use cosfly_frames::{DVec3, Pose, real};
use cosfly_render::{FrameSetup, PictureLook, Renderer, Scene};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// Brightness may leave its surroundings of the frame before by this much, codes.
const TOLERANCE_CODES: f64 = 10.0;
/// Depths that differ by a greater share belong to other surfaces.
const SAME_DEPTH: f64 = 0.01;

/// Counts for pixels of a kind.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SteadyRow {
    /// Town, weather and label.
    pub name: String,
    /// Pairs of pixels compared.
    pub pixels: u64,
    /// Share of pixels that popped.
    pub popped: f64,
    /// Greatest share of pixels that popped within a frame that compares at least a thousand of the kind.
    pub worst_frame: f64,
    /// Mean change of brightness along the motion, codes.
    pub mean_change: f64,
}

/// Rows of all clips, printed as a table.
#[derive(Clone, Debug, Serialize)]
pub struct SteadyReport {
    /// Rows.
    pub rows: Vec<SteadyRow>,
}

impl fmt::Display for SteadyReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Brightness along the motion of a camera in a still town")?;
        writeln!(
            f,
            "{:<44} {:>12} {:>10} {:>15} {:>13}",
            "seen", "pixels", "popped, %", "worst frame, %", "change, codes"
        )?;
        for row in &self.rows {
            let [popped, worst] = [row.popped, row.worst_frame].map(|share| 100.0 * share);
            let SteadyRow { name, pixels, mean_change, .. } = row;
            writeln!(f, "{name:<44} {pixels:>12} {popped:>10.3} {worst:>15.3} {mean_change:>13.2}")?;
        }
        Ok(())
    }
}

/// Counts of one kind.
#[derive(Clone, Copy, Default)]
struct Count {
    pixels: u64,
    popped: u64,
    change: f64,
}

/// A frame that the next one is compared with.
struct Before {
    images: FrameImages,
    luma: Vec<f64>,
    pose: Pose,
}

/// Pose `frame` of a clip that begins at `start`: the camera glides by `step_m`, sinks and turns a little.
fn glide(start: &Pose, frame: usize, step_m: f64) -> Pose {
    let (sin, cos) = real::sin_cos(start.yaw_rad + 0.7);
    let far_m = frame as f64 * step_m;
    Pose {
        position_in_world: start.position_in_world + far_m * DVec3::new(cos, sin, -0.15),
        yaw_rad: start.yaw_rad + 0.0015 * frame as f64,
        ..*start
    }
}

/// Follows the camera from each of `starts` for `frames` frames.
pub fn of_clips(
    name: &str,
    scene: &Scene,
    (camera, look): (Camera, PictureLook),
    weather: &Weather,
    starts: &[Pose],
    (frames, step_m): (usize, f64),
) -> Vec<SteadyRow> {
    let mut renderer = Renderer::new(camera);
    renderer.set_look(look);
    let mut kinds: BTreeMap<&'static str, (Count, f64)> = BTreeMap::new();
    for start in starts {
        let mut before: Option<Before> = None;
        for frame in 0..frames {
            let pose = glide(start, frame, step_m);
            let setup = FrameSetup { pose, weather, target: None, others: &[] };
            let images = renderer.render(scene, &setup).images.clone();
            let now = Before { luma: luma(&images.rgb), images, pose };
            if let Some(before) = &before {
                for (kind, count) in compared(&camera, before, &now) {
                    let (sum, worst) = kinds.entry(kind).or_default();
                    sum.pixels += count.pixels;
                    sum.popped += count.popped;
                    sum.change += count.change;
                    if count.pixels >= 1000 {
                        *worst = worst.max(count.popped as f64 / count.pixels as f64);
                    }
                }
            }
            before = Some(now);
        }
    }
    let row = |(kind, (count, worst_frame)): (&&str, &(Count, f64))| {
        let per_pixel = 1.0 / count.pixels.max(1) as f64;
        SteadyRow {
            name: format!("{name}, {}, {kind}", weather.name),
            pixels: count.pixels,
            popped: count.popped as f64 * per_pixel,
            worst_frame: *worst_frame,
            mean_change: count.change * per_pixel,
        }
    };
    kinds.iter().map(row).collect()
}

fn luma(rgb: &[u8]) -> Vec<f64> {
    let of = |[r, g, b]: &[u8; 3]| 0.299 * f64::from(*r) + 0.587 * f64::from(*g) + 0.114 * f64::from(*b);
    rgb.as_chunks::<3>().0.iter().map(of).collect()
}

/// Counts by kind of what is seen, and over `all`.
fn compared(camera: &Camera, before: &Before, now: &Before) -> BTreeMap<&'static str, Count> {
    let width = camera.width as usize;
    let mut kinds: BTreeMap<&'static str, Count> = BTreeMap::new();
    for (pixel, luma) in now.luma.iter().enumerate() {
        let depth = f64::from(now.images.depth_m[pixel]);
        if !depth.is_finite() {
            continue;
        }
        let (u, v) = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        let point = now.pose.position_in_world + depth * camera.ray_in_world(&now.pose, u, v);
        let Some((u, v, depth)) = camera.project(&before.pose, point) else { continue };
        let Some([least, value, greatest]) = around(before, (width, camera.height as usize), [u, v], |at| {
            let same = before.images.instance[at] == now.images.instance[pixel]
                && before.images.semantic[at] == now.images.semantic[pixel];
            same && (f64::from(before.images.depth_m[at]) - depth).abs() < SAME_DEPTH * depth
        }) else {
            continue;
        };
        let popped = *luma < least - TOLERANCE_CODES || *luma > greatest + TOLERANCE_CODES;
        for kind in ["all", kind(now.images.semantic[pixel])] {
            let count = kinds.entry(kind).or_default();
            count.pixels += 1;
            count.popped += u64::from(popped);
            count.change += (luma - value).abs();
        }
    }
    kinds
}

/// Least brightness of the nine pixels around a place, the brightness there, and the greatest; `None` unless all are alike.
fn around(
    before: &Before,
    (width, height): (usize, usize),
    [u, v]: [f64; 2],
    is_alike: impl Fn(usize) -> bool,
) -> Option<[f64; 3]> {
    if !(u > 1.5 && v > 1.5 && u < width as f64 - 2.5 && v < height as f64 - 2.5) {
        return None;
    }
    let (column, row) = (u as usize, v as usize);
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    for at in (row - 1..=row + 1).flat_map(|row| (column - 1..=column + 1).map(move |column| row * width + column)) {
        if !is_alike(at) {
            return None;
        }
        least = least.min(before.luma[at]);
        greatest = greatest.max(before.luma[at]);
    }
    let (left, top) = ((u - 0.5).floor(), (v - 0.5).floor());
    let (fx, fy) = (u - 0.5 - left, v - 0.5 - top);
    let at = |x: usize, y: usize| before.luma[(top as usize + y) * width + left as usize + x];
    let upper = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
    let lower = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
    Some([least, upper + (lower - upper) * fy, greatest])
}

/// Kind of a label in the table.
fn kind(label: u8) -> &'static str {
    const KINDS: [(SemanticLabel, &str); 7] = [
        (SemanticLabel::Building, "buildings"),
        (SemanticLabel::Vegetation, "trees"),
        (SemanticLabel::Roads, "roads"),
        (SemanticLabel::RoadLine, "road marks"),
        (SemanticLabel::SideWalks, "pavements"),
        (SemanticLabel::Terrain, "grass"),
        (SemanticLabel::Ground, "bare ground"),
    ];
    KINDS.iter().find(|(of, _)| of.id() == label).map_or("other things", |(_, kind)| kind)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clip_is_compared_along_its_motion_and_a_changed_picture_pops() {
        let camera = Camera { width: 160, height: 120, horizontal_fov_rad: 1.4 };
        let ground = crate::render::views::Ground::of_boxes(60, camera, 1);
        let weather = cosfly_materials::presets::preset("CloudyNoon").unwrap();
        let start = ground.views[0].pose;
        let clip = (camera, PictureLook::Full);
        let rows = of_clips("boxes", &ground.scene, clip, &weather, &[start], (4, 0.05));
        let all = rows.iter().find(|row| row.name.ends_with("all")).unwrap();
        assert!(all.pixels > 10_000 && all.popped < 0.02, "{all:?}");

        let frame = |level: f64| {
            let mut renderer = Renderer::new(camera);
            let setup = FrameSetup { pose: start, weather: &weather, target: None, others: &[] };
            let images = renderer.render(&ground.scene, &setup).images.clone();
            let luma = luma(&images.rgb).iter().map(|luma| luma + level).collect();
            Before { luma, images, pose: start }
        };
        let still = compared(&camera, &frame(0.0), &frame(0.0))["all"];
        assert!(still.popped == 0 && still.change < 1e-6, "a still camera sees the same");
        let changed = compared(&camera, &frame(0.0), &frame(150.0))["all"];
        assert_eq!(changed.popped, changed.pixels);
    }
}
