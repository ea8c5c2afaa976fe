//! [`Texture`]: a picture in linear light with smaller copies, so that far models do not flicker.

use crate::picture::Picture;
use cosfly_frames::real;

/// Largest side that is kept, texels; larger pictures are halved.
const LARGEST_KEPT: usize = 1024;

/// A picture that repeats in both directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The picture, then copies of half the size, down to one texel.
    levels: Vec<Level>,
}

#[derive(Clone, Debug, PartialEq)]
struct Level {
    width: usize,
    height: usize,
    /// Linear red, green, blue.
    texels: Vec<[f32; 3]>,
}

impl Texture {
    /// Takes over a picture.
    pub(crate) fn new(picture: &Picture) -> Self {
        let light: [f32; 256] = core::array::from_fn(|code| {
            let value = code as f64 / 255.0;
            (if value <= 0.04045 { value / 12.92 } else { real::powf((value + 0.055) / 1.055, 2.4) }) as f32
        });
        let texel = |at: usize| picture.rgb[at].map(|code| light[usize::from(code)]);
        let (width, height) = (picture.width, picture.height);
        // Large pictures are never in memory as numbers at their full size.
        let mut level = if width.max(height) > LARGEST_KEPT {
            halved(width, height, &texel)
        } else {
            Level { width, height, texels: (0..width * height).map(texel).collect() }
        };
        while level.width.max(level.height) > LARGEST_KEPT {
            level = level.halved();
        }
        let mut levels = vec![level];
        while let Some(last) = levels.last().filter(|last| last.width.max(last.height) > 1) {
            let next = last.halved();
            levels.push(next);
        }
        Self { levels }
    }

    /// Texels of the whole picture, across and down.
    pub fn size(&self) -> [f32; 2] {
        [self.levels[0].width as f32, self.levels[0].height as f32]
    }

    /// Linear colour at a place (0 to 1 over the picture, which repeats) for a pixel that covers `texels` of the whole picture a side.
    pub fn sample(&self, [u, v]: [f32; 2], texels: f32) -> [f32; 3] {
        let step = libm::log2f(texels.max(1.0)).min((self.levels.len() - 1) as f32);
        let (fine, share) = (step.floor(), step - step.floor());
        let near = self.levels[fine as usize].sample(u, v);
        if share <= 0.0 {
            return near;
        }
        let far = self.levels[(fine as usize + 1).min(self.levels.len() - 1)].sample(u, v);
        [0, 1, 2].map(|k| near[k] + (far[k] - near[k]) * share)
    }
}

/// Means of two by two texels; of one at an odd edge.
fn halved(width: usize, height: usize, texel: &dyn Fn(usize) -> [f32; 3]) -> Level {
    let (half_width, half_height) = (width.div_ceil(2), height.div_ceil(2));
    let mut texels = Vec::with_capacity(half_width * half_height);
    for row in 0..half_height {
        for column in 0..half_width {
            let (left, top) = (2 * column, 2 * row);
            let (right, below) = ((left + 1).min(width - 1), (top + 1).min(height - 1));
            let four = [(left, top), (right, top), (left, below), (right, below)];
            let four = four.map(|(x, y)| texel(y * width + x));
            texels.push([0, 1, 2].map(|k| 0.25 * four.iter().map(|texel| texel[k]).sum::<f32>()));
        }
    }
    Level { width: half_width, height: half_height, texels }
}

impl Level {
    fn halved(&self) -> Self {
        halved(self.width, self.height, &|at| self.texels[at])
    }

    /// Between the four texels around a place.
    fn sample(&self, u: f32, v: f32) -> [f32; 3] {
        let place = |at: f32, count: usize| {
            let at = at - at.floor();
            let texel = (if at.is_finite() { at } else { 0.0 }) * count as f32 - 0.5;
            let (first, share) = (texel.floor(), texel - texel.floor());
            let wrapped = |texel: f32| (texel as i64).rem_euclid(count as i64) as usize;
            (wrapped(first), wrapped(first + 1.0), share)
        };
        let ((left, right, x), (top, below, y)) = (place(u, self.width), place(v, self.height));
        let row = |row: usize| {
            let (from, to) = (self.texels[row * self.width + left], self.texels[row * self.width + right]);
            [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * x)
        };
        let (from, to) = (row(top), row(below));
        [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_lie_between_texels_and_far_ones_are_the_mean() {
        let picture = Picture { width: 4, height: 1, rgb: vec![[0; 3], [255; 3], [0; 3], [255; 3]], alpha: vec![] };
        let texture = Texture::new(&picture);
        assert_eq!(texture.sample([0.125, 0.5], 1.0), [0.0; 3]);
        assert_eq!(texture.sample([0.375, 0.5], 1.0), [1.0; 3]);
        assert!((texture.sample([0.25, 7.3], 1.0)[0] - 0.5).abs() < 1e-6);
        // Repeats on both sides.
        assert_eq!(texture.sample([1.375, 0.0], 1.0), texture.sample([-0.625, 0.0], 1.0));
        assert_eq!(texture.sample([0.1, 0.1], 1e9), [0.5; 3]);
        assert!(texture.sample([f32::NAN, f32::INFINITY], f32::NAN).iter().all(|it| it.is_finite()));
    }
}
