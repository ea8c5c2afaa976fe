//! Pictures of channels that are not pictures: semantic colours and coloured depth.

use cosfly_maps::SemanticLabel;

/// CARLA's palette applied to label ids; unknown ids are black. 3 bytes a pixel.
pub fn palette_image(semantic: &[u8]) -> Vec<u8> {
    let palette: [[u8; 3]; 256] =
        core::array::from_fn(|id| SemanticLabel::ALL.get(id).map_or([0, 0, 0], |label| label.colour()));
    semantic.iter().flat_map(|&id| palette[usize::from(id)]).collect()
}

/// Depth as colours from warm (near, 1 m) to cold (far, 300 m) on a logarithmic scale; no hit is black. 3 bytes a pixel.
pub fn depth_preview(depth_m: &[f32]) -> Vec<u8> {
    const STEPS: usize = 1024;
    let table: Vec<[u8; 3]> = (0..STEPS).map(|i| turbo(1.0 - i as f32 / (STEPS - 1) as f32)).collect();
    // The bits of a float grow nearly like its logarithm: index by them, no transcendental per pixel.
    let (low, high) = (1.0f32.to_bits(), 300.0f32.to_bits());
    depth_m
        .iter()
        .flat_map(|depth| {
            if !depth.is_finite() {
                return [0, 0, 0];
            }
            let bits = depth.clamp(1.0, 300.0).to_bits();
            table[((u64::from(bits - low) * (STEPS as u64 - 1)) / u64::from(high - low)) as usize]
        })
        .collect()
}

/// The "turbo" colour map (Mikhailov 2019, polynomial fit), 0 cold to 1 warm.
fn turbo(x: f32) -> [u8; 3] {
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
}
