//! From looks to bytes: sun, sky, lamps, wetness, mirrors, haze and the tone curve.

use super::geometry::View;
use super::lanes::{Block, Stage, WIDE, get, set};
use super::light::Light;
use super::pattern::{NoiseTexture, Noises, least, most, share, smoothstep};
use super::tone::ToneCurve;
use super::vector::Vec3;
use cosfly_frames::simd_kernel;

/// Which kinds of light a material answers to.
#[derive(Clone, Copy, Debug)]
pub struct Answers {
    /// Rain makes it dark and shiny, puddles gather on it.
    pub wettable: bool,
    /// It mirrors a little, dry too.
    pub shiny: bool,
    /// It shines by itself.
    pub glows: bool,
}

simd_kernel! {
    /// Wet ground: darker, and a mirror where water stands.
    pub fn wet(blocks: &mut [Block], light: &Light, noise: &NoiseTexture) {
        let wetness = light.wet;
        let edge = 0.82 - 0.32 * light.puddles;
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let point = block.point(k);
                let level = noise.clumps(point.world.x * 2.1, point.world.y * 2.1, point.footprint_m * 2.1);
                let flat = if point.normal.z > 0.9 { wetness } else { 0.0 };
                let puddle = smoothstep(edge, edge + 0.05, level) * flat;
                let albedo = get(&block.albedo, k) * (1.0 - 0.42 * flat - 0.10 * puddle);
                set(&mut block.albedo, k, albedo);
                set(&mut block.bent, k, point.normal);
                block.mirror[k] = most(block.mirror[k], 0.10 * flat + 0.45 * puddle);
            }
        }
    }
}

simd_kernel! {
    /// Light from sun, sky and lamps that a dull surface sends back, and what it gives itself.
    pub fn dull(blocks: &mut [Block], light: &Light) {
        let light = *light;
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let bent = get(&block.bent, k);
                let toward = most(bent.dot(light.to_sun), 0.0);
                let arriving = light.sun * (toward * block.sunlight[k])
                    + light.ambient(bent) * (block.sky[k] * block.openness[k]);
                set(&mut block.colour, k, get(&block.albedo, k) * arriving);
            }
        }
    }
}

simd_kernel! {
    /// Light of street lamps.
    pub fn lamps(blocks: &mut [Block], light: &Light) {
        let lamp = light.lamp;
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let arriving = lamp * (block.lamps[k] * (0.75 + 0.25 * block.bent[2][k]));
                let colour = get(&block.colour, k) + get(&block.albedo, k) * arriving;
                set(&mut block.colour, k, colour);
            }
        }
    }
}

simd_kernel! {
    /// Adds a surface's own light.
    pub fn glow(blocks: &mut [Block]) {
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let colour = get(&block.colour, k) + get(&block.emission, k);
                set(&mut block.colour, k, colour);
            }
        }
    }
}

simd_kernel! {
    /// Mixes the mirrored sky in.
    pub fn mirrored(blocks: &mut [Block], light: &Light) {
        let light = *light;
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let (ray, bent) = (get(&block.ray, k), get(&block.bent, k));
                let view = ray * (1.0 / ray.dot(ray).sqrt());
                let cosine = share(-view.dot(bent));
                let grazing = 1.0 - cosine;
                let grazing2 = grazing * grazing;
                let fresnel = 0.05 + 0.95 * grazing2 * grazing2 * grazing;
                let out = view + bent * (2.0 * cosine);
                let mirror = least(block.mirror[k] * (0.30 + 0.9 * fresnel), 0.85);
                // Near the horizon a street mirrors its houses more than the sky.
                let open = block.sky[k] * (0.30 + 0.70 * share(2.2 * out.z));
                // Lamps stand near the horizon of what a street mirrors.
                let level = 1.0 - share(1.4 * out.z);
                let from_lamps = block.lamps[k] * (0.6 + 2.4 * level * level);
                let arriving = light.ambient(bent) * (0.10 * block.sky[k]) + light.lamp * from_lamps;
                // The sun's own image, wide on rough water.
                let toward = most(out.dot(light.to_sun), 0.0);
                let toward4 = toward * toward * toward * toward;
                let toward16 = toward4 * toward4 * toward4 * toward4;
                let glint = toward16 * toward16 * toward16 * toward16 * (1.6 * block.sunlight[k]);
                let seen = light.sky(out) * open + arriving + light.sun * glint;
                let colour = get(&block.colour, k);
                set(&mut block.colour, k, colour.lerp(seen, mirror));
            }
        }
    }
}

simd_kernel! {
    /// Haze between the surface and the camera.
    pub fn hazy(blocks: &mut [Block], haze: Vec3) {
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let colour = haze.lerp(get(&block.colour, k), block.kept[k]);
                set(&mut block.colour, k, colour);
            }
        }
    }
}

simd_kernel! {
    /// Linear colours to sRGB bytes.
    pub fn develop(blocks: &mut [Block], exposure: f32, tone: &ToneCurve) {
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let colour = get(&block.colour, k);
                let [r, g, b] = [colour.x, colour.y, colour.z].map(|value| tone.byte(value * exposure));
                block.bytes[k] = r | (g << 8) | (b << 16);
            }
        }
    }
}

simd_kernel! {
    /// Colours of the sky.
    pub fn sky(blocks: &mut [Block], stage: &Stage, view: &View, light: &Light, noise: &NoiseTexture) {
        let (view, light) = (*view, *light);
        for (b, block) in blocks.iter_mut().enumerate() {
            let (u, v, _) = stage.lanes(b);
            for k in 0..WIDE {
                let direction = view.ray(u[k], v[k]).unit();
                set(&mut block.colour, k, super::sky::colour(&light, direction, noise));
            }
        }
    }
}
