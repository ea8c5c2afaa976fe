//! Grass: blades in tufts, clover in flower, dry patches with ragged edges, mown tracks, litter below trees, and what lies along walls.
//!
//! What is wider than some pixels is told once for the pixels of a four; the blades of each pixel make its edges ragged.

use super::grid::{FAR_FROM_WALLS_M, GridFrame, GridTables};
use super::lanes::{Block, PixelLane, Shared, WIDE, get, groups, set};
use super::pattern::{NoiseLevel, NoiseLevels, NoiseTexture, Noises, band, lerp, most, smoothstep, stripes};
use super::surface::{Look, SurfacePoint};
use super::vector::Vec3;

/// Texels of a lawn's blades per metre.
const BLADES_PER_M: f32 = 16.0;
/// Texels per metre of dry patches, and of tufts.
const DRY_PER_M: f32 = 1.9;
const TUFTS_PER_M: f32 = 6.3;
/// Ground along a wall is none of the lawn up to about this far from it, metres.
const APRON_M: f32 = 3.4;
/// Way across the tracks of mowers, and tracks per metre.
const ACROSS: [f32; 2] = [0.83, 0.558];
const TRACKS_PER_M: f32 = 0.42;
/// Leaves of clover, its flowers, and litter below trees, linear RGB.
const CLOVER: Vec3 = Vec3::new(0.056, 0.098, 0.036);
const FLOWERS: Vec3 = Vec3::new(0.21, 0.20, 0.15);
const LITTER: Vec3 = Vec3::new(0.105, 0.082, 0.050);
/// Mean share of tufts, for pixels as large as they.
const TUFTS: f32 = 0.36;

/// What grows at a place, told for all pixels of a four.
#[derive(Clone, Copy)]
struct Growth {
    /// Colours where the grass is fresh, and where it is dry or litter lies.
    fresh: Vec3,
    straw: Vec3,
    /// Numbers that pass a limit where the grass is dry, and where there are tufts.
    dry: f32,
    tuft: f32,
    /// Share of clover.
    clover: f32,
    /// Light as a share of that of other grass: of the track of a mower.
    light: f32,
    /// How far pixels are too large for tufts, 0 to 1.
    far: f32,
}

impl Growth {
    /// What grows at a place with a share of litter.
    #[inline(always)]
    fn at([x, y]: [f32; 2], size: f32, litter: f32, [fresh, straw]: [Vec3; 2], noise: &NoiseTexture) -> Self {
        let dry = noise.clumps(x * DRY_PER_M, y * DRY_PER_M, size * DRY_PER_M);
        let tuft = noise.clumps(x * TUFTS_PER_M + 40.0, y * TUFTS_PER_M, size * TUFTS_PER_M);
        // Mowers turn at each track: every second one is lighter. They leave out where grass is dry.
        let across = (x * ACROSS[0] + y * ACROSS[1]) * TRACKS_PER_M;
        let track = stripes(across, 0.0, 0.5, 3.0 * size * TRACKS_PER_M) - 0.5;
        let clover = smoothstep(0.53, 0.58, 0.62 * (1.0 - dry) + 0.38 * tuft);
        Self {
            fresh: fresh.lerp(CLOVER, 0.5 * clover),
            straw: fresh.lerp(straw, 0.65).lerp(LITTER, 0.8 * litter),
            dry: dry + 0.3 * litter,
            tuft,
            clover,
            light: 1.0 + 0.15 * track * (1.0 - smoothstep(0.40, 0.47, dry)),
            far: smoothstep(0.2, 1.0, size),
        }
    }
}

/// Lawn of a season's two colours at a place of the world where pixels are `size` metres wide.
#[inline(always)]
pub fn lawn(place: [f32; 2], size: f32, colours: [Vec3; 2], noise: &NoiseTexture) -> Vec3 {
    grass(place, &Growth::at(place, size, 0.0, colours, noise), NoiseLevel::of(size * BLADES_PER_M), noise)
}

/// Paints lawns.
#[inline(always)]
pub fn lawns(
    shared: &[Shared],
    blocks: &mut [Block],
    (tables, frame): (&GridTables, GridFrame),
    colours: [Vec3; 2],
    noise: &NoiseTexture,
) {
    for (shared, four) in groups(shared, blocks) {
        let fine = NoiseLevels::of(&shared.footprint_m, BLADES_PER_M);
        let [mut dry, mut tuft, mut clover, mut light, mut far]: [PixelLane; 5] = [[0.0; WIDE]; 5];
        let [mut fresh, mut straw]: [[PixelLane; 3]; 2] = [[[0.0; WIDE]; 3]; 2];
        let mut has_wall = 0u32;
        for k in 0..WIDE {
            let middle = shared.point(k);
            let (x, y) = (middle.world.x, middle.world.y);
            let place = frame.place(x, y);
            let wall_m = place.wall_m(tables);
            has_wall |= u32::from(wall_m < APRON_M + 2.0 * middle.footprint_m);
            // Houses take light from the ground, too, and have no leaves.
            let away = smoothstep(0.5 * FAR_FROM_WALLS_M, FAR_FROM_WALLS_M, wall_m);
            let litter = away * (1.0 - smoothstep(0.2, 0.6, place.sky(tables)));
            let growth = Growth::at([x, y], middle.footprint_m, litter, colours, noise);
            (dry[k], tuft[k], clover[k]) = (growth.dry, growth.tuft, growth.clover);
            (light[k], far[k]) = (growth.light, growth.far);
            set(&mut fresh, k, growth.fresh);
            set(&mut straw, k, growth.straw);
        }
        for block in &mut *four {
            for k in 0..WIDE {
                let point = block.point(shared, k);
                let growth = Growth {
                    fresh: get(&fresh, k),
                    straw: get(&straw, k),
                    dry: dry[k],
                    tuft: tuft[k],
                    clover: clover[k],
                    light: light[k],
                    far: far[k],
                };
                let albedo = grass([point.world.x, point.world.y], &growth, fine.at(k), noise);
                block.put(k, &Look::matt(albedo, point.normal));
            }
        }
        if has_wall != 0 {
            for block in four {
                for k in 0..WIDE {
                    let (point, albedo) = (block.point(shared, k), get(&block.albedo, k));
                    let wall_m = frame.place(point.world.x, point.world.y).wall_m(tables);
                    set(&mut block.albedo, k, apron(&point, wall_m, albedo, noise));
                }
            }
        }
    }
}

#[inline(always)]
fn grass([x, y]: [f32; 2], growth: &Growth, fine: NoiseLevel, noise: &NoiseTexture) -> Vec3 {
    let blades = noise.rough_at(x * BLADES_PER_M, y * BLADES_PER_M, fine);
    let ragged = 0.22 * (blades - 0.5);
    let dry = smoothstep(0.48, 0.68, growth.dry + ragged);
    // Tufts are dark and throw shade.
    let tuft = lerp(smoothstep(0.50, 0.60, growth.tuft + ragged), TUFTS, growth.far);
    let light = lerp(0.45, 1.55, blades) * growth.light * (1.0 + 0.34 * (TUFTS - tuft));
    growth.fresh.lerp(growth.straw, dry) * light + FLOWERS * (growth.clover * smoothstep(0.70, 0.80, blades))
}

/// Ground along a wall: slabs with an edging, then soil, then what `grass` is.
#[inline(always)]
fn apron(point: &SurfacePoint, wall_m: f32, grass: Vec3, noise: &NoiseTexture) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let rough = noise.rough(x * 15.0 + 31.0, y * 15.0, size * 15.0);
    let wild = noise.clumps(x * 6.0, y * 6.0, size * 6.0) - 0.5;
    let soil = Vec3::new(0.095, 0.072, 0.048) * (0.45 + 1.1 * rough);
    let plants = 1.0 - smoothstep(1.1, 2.3, wall_m + 1.6 * wild);
    let slabs = 1.0 - band(wall_m, 0.85, 99.0, size);
    let edging = band(wall_m, 0.77, 0.87, size);
    let joint = most(stripes(x * 2.0, 0.0, 0.05, size * 2.0), stripes(y * 2.0, 0.0, 0.05, size * 2.0));
    let stone = Vec3::new(0.30, 0.29, 0.27) * ((0.55 + 0.75 * rough) * (1.0 - 0.35 * joint));
    grass.lerp(soil, 0.8 * plants).lerp(stone, slabs).lerp(Vec3::splat(0.36) * (0.7 + 0.5 * rough), edging)
}

#[cfg(test)]
mod tests {
    use super::super::pattern::noise_texture;
    use super::*;

    /// Places of a square of ground.
    fn places(step_m: f32) -> impl Iterator<Item = [f32; 2]> {
        (0..40_000).map(move |k| [step_m * (k % 200) as f32, step_m * (k / 200) as f32])
    }

    #[test]
    fn lawns_keep_their_light_from_near_to_far() {
        let noise = noise_texture(3);
        let colours = crate::season::row(cosfly_domain::Season::Summer).lawn;
        let mean = |size: f32| places(0.61).map(|at| lawn(at, size, colours, &noise).y).sum::<f32>() / 40_000.0;
        let near = mean(0.02);
        for size in [0.1, 0.5, 2.0, 8.0] {
            assert!((mean(size) / near - 1.0).abs() < 0.1, "{size} m: {} {near}", mean(size));
        }
    }

    #[test]
    fn lawns_have_structure_from_decimetres_to_metres() {
        let noise = noise_texture(3);
        let colours = crate::season::row(cosfly_domain::Season::Summer).lawn;
        // Mean change of light over a step, as a share of the mean.
        for step_m in [0.1, 0.4, 1.0, 2.5] {
            let size = 0.5 * step_m;
            let light = |at: [f32; 2]| lawn(at, size, colours, &noise).y;
            let (change, sum) = places(0.37).fold((0.0, 0.0), |(change, sum), [x, y]| {
                let here = light([x, y]);
                (change + (light([x + step_m, y]) - here).abs(), sum + here)
            });
            assert!(change / sum > 0.06, "{step_m} m: {}", change / sum);
        }
    }
}
