//! Pictures of channels that are not pictures: semantic colours, coloured depth, channels on request.

use crate::colour_wheel::flow_picture;
use cosfly_domain::channels::Element;
use cosfly_domain::{Channel, SemanticLabel};

/// CARLA's palette applied to label ids; unknown ids are black. 3 bytes a pixel.
pub fn palette_image(semantic: &[u8]) -> Vec<u8> {
    let palette: [[u8; 3]; 256] =
        core::array::from_fn(|id| SemanticLabel::ALL.get(id).map_or([0, 0, 0], |label| label.colour()));
    semantic.iter().flat_map(|&id| palette[usize::from(id)]).collect()
}

/// Stored pixels of a channel on request as a picture: numbers in colours as [`depth_preview`] has them, pairs as
/// [`flow_picture`] has them, 1 white and 0 black, three bytes as they are. 3 bytes a pixel.
pub fn picture_on_request(channel: &Channel, bytes: &[u8]) -> Vec<u8> {
    match channel.element() {
        Element::Float => {
            let numbers = bytes.as_chunks::<4>().0.iter().map(|number| f32::from_le_bytes(*number));
            depth_preview(&numbers.collect::<Vec<f32>>())
        }
        Element::Pair => flow_picture(&pairs(bytes)),
        Element::Flag => bytes.iter().flat_map(|flag| [if *flag == 0 { 0 } else { 255 }; 3]).collect(),
        _ => bytes.to_vec(),
    }
}

/// Pairs of numbers from stored pixels.
fn pairs(bytes: &[u8]) -> Vec<[f32; 2]> {
    let (numbers, _) = bytes.as_chunks::<4>();
    numbers.as_chunks::<2>().0.iter().map(|pair| pair.map(f32::from_le_bytes)).collect()
}

/// Nearest and farthest depth that previews tell apart, metres.
const PREVIEW_M: [f32; 2] = [0.25, 4096.0];
/// Steps between them, equal on a logarithmic scale within each doubling.
const STEPS: usize = 4096;

/// Depth as colours from warm (near) to cold (far) on a logarithmic scale; no hit is black. 3 bytes a pixel.
///
/// A picture to look at, not data: the scale is the image's own, so that one colour means another depth in another frame.
pub fn depth_preview(depth_m: &[f32]) -> Vec<u8> {
    DepthScale::of(depth_m.iter().copied()).colours(depth_m)
}

/// Which colours depths have: from the 1st to the 99th percentile of some depths (at least a factor of two), with a
/// rest at both ends for what lies beyond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthScale {
    near: usize,
    far: usize,
}

impl DepthScale {
    /// The scale for these depths, metres; those that are not finite are left out.
    pub fn of(depths_m: impl Iterator<Item = f32>) -> Self {
        let mut counts = vec![0u32; STEPS];
        depths_m.filter(|depth| depth.is_finite()).for_each(|depth| counts[step_of(depth)] += 1);
        let [near, far] = percentiles(&counts);
        Self { near, far }
    }

    /// Depths as colours, warm (near) to cold (far); no hit is black. 3 bytes a pixel.
    pub fn colours(&self, depth_m: &[f32]) -> Vec<u8> {
        let scale = 1.0 / (self.far - self.near).max(STEPS / 14) as f32;
        let near = self.near as f32;
        let table: Vec<[u8; 3]> = (0..STEPS).map(|step| turbo(0.96 - 0.92 * (step as f32 - near) * scale)).collect();
        let mut colours = vec![0; 3 * depth_m.len()];
        for (pixel, depth) in colours.as_chunks_mut::<3>().0.iter_mut().zip(depth_m) {
            if depth.is_finite() {
                *pixel = table[step_of(*depth)];
            }
        }
        colours
    }
}

/// A depth's place on the scale. The bits of a float grow nearly like its logarithm: no transcendental per pixel.
fn step_of(depth_m: f32) -> usize {
    let [low, high] = PREVIEW_M.map(f32::to_bits);
    let bits = depth_m.clamp(PREVIEW_M[0], PREVIEW_M[1]).to_bits();
    ((u64::from(bits - low) * (STEPS as u64 - 1)) / u64::from(high - low)) as usize
}

/// Steps below which 1 and 99 of 100 counted pixels lie.
fn percentiles(counts: &[u32]) -> [usize; 2] {
    let total: u64 = counts.iter().map(|count| u64::from(*count)).sum();
    [1, 99]
        .map(|percent| {
            let mut seen = 0;
            counts.iter().position(|count| {
                seen += u64::from(*count);
                100 * seen >= percent * total
            })
        })
        .map(|step| step.unwrap_or(0))
}

/// The "turbo" colour map (Mikhailov 2019, polynomial fit), 0 cold to 1 warm.
fn turbo(x: f32) -> [u8; 3] {
    let x = x.clamp(0.0, 1.0);
    let polynomial = |c: [f32; 6]| c.iter().rev().fold(0.0f32, |sum, k| sum * x + k);
    [
        polynomial([0.135_721_4, 4.615_392_6, -42.660_324, 132.131_08, -152.942_4, 59.286_38]),
        polynomial([0.091_402_6, 2.194_188_4, 4.842_966_6, -14.185_033, 4.277_298_6, 2.829_566]),
        polynomial([0.106_673_3, 12.641_946, -60.582_05, 110.362_77, -89.903_11, 27.348_25]),
    ]
    .map(|value| (255.0 * value.clamp(0.0, 1.0) + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn palettes_follow_carla_and_unknown_ids_are_black() {
        assert_eq!(palette_image(&[12, 11, 200]), [220, 20, 60, 70, 130, 180, 0, 0, 0]);
    }

    #[test]
    fn near_is_warm_far_is_cold_and_sky_is_black() {
        let colours = depth_preview(&[2.0, 250.0, f32::INFINITY, f32::NAN, -1.0]);
        assert!(colours[0] > colours[2] && colours[5] > colours[3]);
        assert_eq!(colours[6..12], [0; 6]);
    }

    #[test]
    fn a_few_stray_pixels_do_not_eat_the_scale() {
        let mut depth_m: Vec<f32> = (0..1000).map(|i| 20.0 + 0.02 * i as f32).collect();
        let plain = depth_preview(&depth_m);
        assert!(plain[0] > plain[2] && plain[3 * 999 + 2] > plain[3 * 999]);
        depth_m.extend([0.3, 3000.0]);
        assert_eq!(depth_preview(&depth_m)[..3000], plain);
        assert_eq!(depth_preview(&[f32::INFINITY; 4]), [0; 12]);
        assert!(depth_preview(&[]).is_empty());
    }
}
