//! The sky behind everything, and the rain in front of it.

use cosfly_domain::FrameImages;
use cosfly_materials::light::Light;
use cosfly_materials::pattern::{NoiseTexture, Noises, hash, most, share, smoothstep, unit};
use cosfly_materials::vector::Vec3;

/// Colour of the sky in a direction (unit length): gradient, sun, clouds, and haze near the horizon.
#[inline(always)]
pub fn colour(light: &Light, direction: Vec3, haze: Vec3, noise: &NoiseTexture) -> Vec3 {
    let colour = light.sky(direction);
    let toward = most(direction.dot(light.to_sun), 0.0);
    let clear = 1.0 - light.clouds;
    let disc = smoothstep(0.9994, 0.9998, toward) * clear;
    let near2 = toward * toward;
    let near8 = near2 * near2 * near2 * near2;
    let near32 = near8 * near8 * near8 * near8;
    let ring = near32 * near32 * near8 * near8 * near8 * (0.25 * clear);
    let colour = colour + light.sun * (disc * if light.night > 0.5 { 12.0 } else { 5.0 } + ring);
    let up = most(direction.z, 0.02);
    let (x, y) = (direction.x / up, direction.y / up);
    let size = 0.012 / (up * up);
    // High veils: noise drawn out along one direction.
    let veil = noise.clumps((x + 0.6 * y) * 6.0, (y - 0.6 * x) * 31.0, size * 20.0);
    let veil = smoothstep(0.50, 0.85, veil) * smoothstep(0.04, 0.30, direction.z) * (0.45 - 0.3 * light.clouds);
    let colour = colour.lerp(light.horizon * 0.8 + light.sun * 0.10, veil);
    // Heaps: darker below and away from the sun, where they are thick.
    let fine = 0.30 * noise.clumps(x * 131.0, y * 131.0, size * 131.0);
    let shape = 0.70 * noise.clumps(x * 34.0, y * 34.0, size * 34.0) + fine;
    let (aside_x, aside_y) = (x + 0.22 * light.to_sun.x, y + 0.22 * light.to_sun.y);
    let beyond = 0.70 * noise.clumps(aside_x * 34.0, aside_y * 34.0, size * 34.0) + fine;
    let threshold = 0.74 - 0.62 * light.clouds;
    let cover = smoothstep(threshold, threshold + 0.20, shape) * smoothstep(0.015, 0.14, direction.z);
    let thick = share((shape - threshold) * 2.2);
    let lit = share(0.62 - 0.42 * thick + 1.5 * (shape - beyond));
    let shaded = light.zenith * 0.55 + light.horizon * 0.30;
    let body = (shaded + light.sun * (0.30 * lit * lit) + light.horizon * (0.22 * lit)) * (1.0 - 0.25 * light.rain);
    let colour = colour.lerp(body, cover * (0.94 - 0.14 * light.clouds));
    let low = 1.0 - share(direction.z * 7.0);
    colour.lerp(haze, low * low * low * 0.9)
}

/// Streaks of rain: light lines slanted by the wind, drawn from the frame's seed.
pub fn rain(light: &Light, seed: u32, images: &mut FrameImages) {
    if light.rain <= 0.02 {
        return;
    }
    let (width, height) = (images.width as usize, images.height as usize);
    let streaks = (light.rain * (width * height) as f32 / 520.0) as u32;
    let slant = (unit(hash(seed, 1)) - 0.3) * light.wind * 0.9;
    let white = [205.0f32, 212.0, 220.0].map(|c| if light.night > 0.5 { 0.55 * c } else { c });
    for streak in 0..streaks {
        let h = hash(seed, streak.wrapping_add(100));
        let near = unit(hash(h, 1));
        let length = (0.012 + 0.055 * near * near) * height as f32;
        let strength = 0.08 + 0.20 * near;
        let (u, v) = (unit(hash(h, 2)) * width as f32, unit(hash(h, 3)) * height as f32 * 1.1 - 0.05 * height as f32);
        for step in 0..length as i32 {
            let (x, y) = (u + slant * step as f32 - 0.5, v + step as f32);
            if x < 0.0 || y < 0.0 || x as usize + 1 >= width || y as usize >= height {
                continue;
            }
            // A drop on its way: faint where it came and went, between two columns.
            let along = (step as f32 + 0.5) / length;
            let strength = strength * 5.0 * along * (1.0 - along);
            let aside = x - x.floor();
            let at = 3 * (y as usize * width + x as usize);
            for (column, part) in [1.0 - aside, aside].into_iter().enumerate() {
                for (byte, bright) in images.rgb[at + 3 * column..][..3].iter_mut().zip(white) {
                    *byte =
                        (f32::from(*byte) + (bright - f32::from(*byte)) * (strength * part)).clamp(0.0, 255.0) as u8;
                }
            }
        }
    }
}
