//! Ground: asphalt, pavement slabs, road marks, grass, each from world coordinates.

use super::pattern::{NoiseTexture, hash, lerp, smoothstep, stripes, unit};
use super::surface::{Look, SurfacePoint};
use cosfly_maps::SemanticLabel;
use glam::Vec3;

/// The look of ground with a label.
#[inline(always)]
pub fn look(point: &SurfacePoint, label: SemanticLabel, noise: &NoiseTexture) -> Look {
    let (x, y, size) = (point.world.x, point.world.y, point.footprint_m);
    let albedo = match label {
        SemanticLabel::Roads | SemanticLabel::Bridge => asphalt(x, y, size, noise),
        SemanticLabel::SideWalks => slabs(x, y, size, point.footprints_m, noise),
        SemanticLabel::RoadLine => paint(x, y, size, noise),
        SemanticLabel::Ground | SemanticLabel::Static | SemanticLabel::Other => gravel(x, y, size, noise),
        SemanticLabel::Water => Vec3::new(0.02, 0.05, 0.06),
        _ => grass(x, y, size, noise),
    };
    let mirror = if label == SemanticLabel::Water { 0.9 } else { 0.0 };
    Look { mirror, ..Look::matt(albedo, point.normal) }
}

fn asphalt(x: f32, y: f32, size: f32, noise: &NoiseTexture) -> Vec3 {
    let grain = noise.grain(x * 24.0, y * 24.0, size * 24.0);
    let stain = noise.clumps(x * 3.1, y * 3.1, size * 3.1);
    let wide = noise.clumps(x * 0.37 + 50.0, y * 0.37, size * 0.37);
    // Mended pieces: the level sets of wide noise.
    let mended = smoothstep(0.66, 0.67 + 0.05 * size, wide) * 0.22;
    // Cracks where two noises meet their mean.
    let meet = (noise.clumps(x * 1.3, y * 1.3 + 91.0, size * 1.3) - 0.5).abs();
    let crack = (1.0 - smoothstep(0.0, 0.012 + 0.1 * size, meet)) * 0.35 * (1.0 - smoothstep(0.03, 0.25, size));
    let tone = 0.115 * (0.72 + 0.3 * grain + 0.38 * (stain - 0.25)) * (1.0 - mended) * (1.0 - crack);
    Vec3::new(tone, tone * 0.99, tone * 0.98)
}

fn slabs(x: f32, y: f32, size: f32, footprints: [f32; 2], noise: &NoiseTexture) -> Vec3 {
    const SLAB_M: f32 = 0.75;
    let (u, v) = (x / SLAB_M, y / SLAB_M);
    let (wu, wv) = (footprints[0] / SLAB_M, footprints[1] / SLAB_M);
    let joint = stripes(u, 0.0, 0.045, wu).max(stripes(v, 0.0, 0.045, wv));
    let near = 1.0 - smoothstep(0.25, 0.8, size / SLAB_M);
    let slab = unit(hash(super::pattern::floor_int(u) as u32, super::pattern::floor_int(v) as u32)) - 0.5;
    let grain = noise.grain(x * 30.0, y * 30.0, size * 30.0) - 0.5;
    let stain = noise.clumps(x * 2.3, y * 2.3, size * 2.3) - 0.5;
    let tone = 0.40 * (1.0 + 0.16 * slab * near + 0.14 * grain + 0.42 * stain) * (1.0 - 0.45 * joint);
    Vec3::new(tone, tone * 0.97, tone * 0.915)
}

fn paint(x: f32, y: f32, size: f32, noise: &NoiseTexture) -> Vec3 {
    let worn = smoothstep(0.62, 0.86, noise.clumps(x * 9.0, y * 9.0, size * 9.0));
    Vec3::splat(0.70).lerp(Vec3::splat(0.15), 0.75 * worn)
}

fn gravel(x: f32, y: f32, size: f32, noise: &NoiseTexture) -> Vec3 {
    let grain = noise.grain(x * 14.0, y * 14.0, size * 14.0);
    let stain = noise.clumps(x * 1.7, y * 1.7, size * 1.7);
    Vec3::new(0.30, 0.275, 0.24) * (0.62 + 0.4 * grain + 0.5 * (stain - 0.3))
}

fn grass(x: f32, y: f32, size: f32, noise: &NoiseTexture) -> Vec3 {
    let blades = noise.grain(x * 20.0, y * 20.0, size * 20.0);
    let tufts = noise.clumps(x * 5.0, y * 5.0, size * 5.0);
    let dry = smoothstep(0.42, 0.75, noise.clumps(x * 0.43, y * 0.43, size * 0.43));
    let fresh = Vec3::new(0.075, 0.155, 0.035);
    let straw = Vec3::new(0.20, 0.185, 0.075);
    fresh.lerp(straw, 0.65 * dry) * (lerp(0.55, 1.25, tufts) * lerp(0.7, 1.3, blades))
}
