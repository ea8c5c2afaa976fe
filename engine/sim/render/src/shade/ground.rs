//! Ground: asphalt, pavement slabs, road marks, grass, each from world coordinates.

use super::lanes::{Block, Shared, WIDE, groups};
use super::pattern::{NoiseTexture, Noises, hash, lerp, most, one_if, smoothstep, stripes, unit};
use super::surface::{Look, SurfacePoint};
use super::vector::Vec3;
use cosfly_frames::simd_kernel;
use cosfly_maps::SemanticLabel;

/// Dull surfaces whose colour follows from the place. Not a function: closures are not always inlined, and only what is
/// inlined becomes vector code.
macro_rules! paint_all {
    ($shared:ident, $blocks:ident, $point:ident => $albedo:expr) => {
        for (shared, four) in groups($shared, $blocks) {
            for block in four {
                for k in 0..WIDE {
                    let $point = block.point(shared, k);
                    let look = Look::matt($albedo, $point.normal);
                    block.put(k, &look);
                }
            }
        }
    };
}

/// The same where a pattern of wide patches is told once for the pixels of a four.
macro_rules! paint_patches {
    ($shared:ident, $blocks:ident, $middle:ident => $patches:expr, $point:ident, $patch:ident => $albedo:expr) => {
        for (shared, four) in groups($shared, $blocks) {
            let mut patches = [0.0f32; WIDE];
            for k in 0..WIDE {
                let $middle = shared.point(k);
                patches[k] = $patches;
            }
            for block in four {
                for k in 0..WIDE {
                    let ($point, $patch) = (block.point(shared, k), patches[k]);
                    let look = Look::matt($albedo, $point.normal);
                    block.put(k, &look);
                }
            }
        }
    };
}

simd_kernel! {
    /// The look of ground with a label.
    pub fn ground(shared: &[Shared], blocks: &mut [Block], label: SemanticLabel, noise: &NoiseTexture) {
        match label {
            SemanticLabel::Roads | SemanticLabel::Bridge => paint_all!(shared, blocks, point => asphalt(&point, noise)),
            SemanticLabel::SideWalks => paint_all!(shared, blocks, point => slabs(&point, noise)),
            SemanticLabel::RoadLine => paint_all!(shared, blocks, point => paint(&point, noise)),
            SemanticLabel::Ground | SemanticLabel::Static | SemanticLabel::Other => {
                paint_patches!(shared, blocks, middle => stains(&middle, noise), point, stain => gravel(&point, stain, noise));
            }
            SemanticLabel::Water => {
                paint_all!(shared, blocks, point => Vec3::new(0.02, 0.05, 0.06));
                blocks.iter_mut().for_each(|block| block.mirror = [0.9; WIDE]);
            }
            _ => paint_patches!(shared, blocks, middle => dryness(&middle, noise), point, dry => grass(&point, dry, noise)),
        }
    }
}

#[inline(always)]
fn asphalt(point: &SurfacePoint, noise: &NoiseTexture) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let rough = noise.rough(x * 19.0, y * 19.0, size * 19.0);
    let wide = noise.clumps(x * 1.05 + 50.0, y * 1.05, size * 1.05);
    // Mended pieces and cracks: level sets of wide noise.
    let mended = 0.16 * smoothstep(0.63, 0.64 + 0.03 * size, wide) - 0.07 * smoothstep(0.40, 0.39 - 0.03 * size, wide);
    let crack = 0.30 * (1.0 - smoothstep(0.0, 0.004 + 0.04 * size, (wide - 0.52).abs())) * most(0.12 - size, 0.0) * 8.0;
    let tone = 0.125 * (0.62 + 0.62 * rough + 0.18 * wide) * (1.0 - mended) * (1.0 - crack);
    Vec3::new(tone, tone * 0.99, tone * 0.975)
}

#[inline(always)]
fn slabs(point: &SurfacePoint, noise: &NoiseTexture) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let footprints = point.footprints_m;
    const PER_M: f32 = 1.0 / 0.75;
    let (u, v) = (x * PER_M, y * PER_M);
    let (wu, wv) = (footprints[0] * PER_M, footprints[1] * PER_M);
    let joint = most(stripes(u, 0.0, 0.04, wu), stripes(v, 0.0, 0.04, wv));
    let near = 1.0 - smoothstep(0.25, 0.8, size * PER_M);
    let slab = unit(hash(super::pattern::floor_int(u) as u32, super::pattern::floor_int(v) as u32)) - 0.5;
    let rough = noise.rough(x * 15.0, y * 15.0, size * 15.0) - 0.5;
    let slab_tone = 0.34 * (1.0 + 0.18 * slab * near + 0.42 * rough) * (1.0 - 0.4 * joint);
    // Kerbs: upright faces of lighter stone.
    let kerb_tone = 0.44 * (1.0 + 0.3 * rough) * (1.0 - 0.3 * joint);
    let tone = lerp(slab_tone, kerb_tone, one_if(point.normal.z < 0.6));
    Vec3::new(tone, tone * 0.97, tone * 0.925)
}

#[inline(always)]
fn paint(point: &SurfacePoint, noise: &NoiseTexture) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let worn = smoothstep(0.62, 0.86, noise.clumps(x * 9.0, y * 9.0, size * 9.0));
    Vec3::splat(0.70).lerp(Vec3::splat(0.15), 0.75 * worn)
}

#[inline(always)]
fn stains(point: &SurfacePoint, noise: &NoiseTexture) -> f32 {
    noise.clumps(point.world.x * 1.7, point.world.y * 1.7, point.footprint_m * 1.7)
}

#[inline(always)]
fn gravel(point: &SurfacePoint, stain: f32, noise: &NoiseTexture) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let rough = noise.rough(x * 12.0, y * 12.0, size * 12.0);
    Vec3::new(0.25, 0.23, 0.20) * (0.45 + 0.7 * rough + 0.5 * (stain - 0.3))
}

#[inline(always)]
fn dryness(point: &SurfacePoint, noise: &NoiseTexture) -> f32 {
    smoothstep(0.42, 0.75, noise.clumps(point.world.x * 1.43, point.world.y * 1.43, point.footprint_m * 1.43))
}

#[inline(always)]
fn grass(point: &SurfacePoint, dry: f32, noise: &NoiseTexture) -> Vec3 {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let blades = noise.rough(x * 16.0, y * 16.0, size * 16.0);
    let fresh = Vec3::new(0.088, 0.160, 0.040);
    let straw = Vec3::new(0.200, 0.195, 0.080);
    fresh.lerp(straw, 0.65 * dry) * lerp(0.45, 1.55, blades)
}
