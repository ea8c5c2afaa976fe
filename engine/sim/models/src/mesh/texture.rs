//! [`MeshTexture`]: a picture of a scan at its full size with smaller copies, four bytes a texel.

use super::used_texels::UsedTexels;
use crate::picture::Picture;
use cosfly_frames::real;
use cosfly_scans::gltf::materials::TextureWrap;
use std::sync::OnceLock;

/// Change of a place in a texture from a pixel to the one on its right, and to the one below.
pub type PixelSides = [[f32; 2]; 2];

/// Width of a probe beside that of what it stands for: between texels, it takes in more than its own width.
const SHARPNESS: f32 = 0.7;
/// Most probes of a picture for one pixel.
const MOST_PROBES: f32 = 16.0;

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshTexture {
    /// The picture, then copies of half the size.
    levels: Vec<Level>,
    /// Continuation beyond its edges, across and down.
    wraps: [TextureWrap; 2],
    has_holes: bool,
    /// Whether what is less opaque than some is never drawn: colours then count as much as they are opaque, since what hidden
    /// texels hold is left to the program that wrote the file.
    is_cut: bool,
}

#[derive(Clone, Debug, PartialEq)]
struct Level {
    width: usize,
    height: usize,
    /// sRGB red, green, blue, and opacity.
    texels: Vec<[u8; 4]>,
}

/// Light of each sRGB code, 0 to 1.
pub fn light() -> &'static [f32; 256] {
    static LIGHT: OnceLock<[f32; 256]> = OnceLock::new();
    LIGHT.get_or_init(|| {
        core::array::from_fn(|code| {
            let value = code as f64 / 255.0;
            (if value <= 0.04045 { value / 12.92 } else { real::powf((value + 0.055) / 1.055, 2.4) }) as f32
        })
    })
}

/// The sRGB code next to a light.
pub fn code(value: f32) -> u8 {
    let light = light();
    let above = light.partition_point(|own| *own < value).min(255);
    let below = above.saturating_sub(1);
    (if value - light[below] < light[above] - value { below } else { above }) as u8
}

impl MeshTexture {
    /// Takes over a picture.
    pub(crate) fn new(picture: Picture, wraps: [TextureWrap; 2]) -> Self {
        let Picture { width, height, rgb, alpha } = picture;
        let alpha = alpha.into_iter().chain(core::iter::repeat(u8::MAX));
        let texels: Vec<[u8; 4]> =
            rgb.into_iter().zip(alpha).map(|([red, green, blue], alpha)| [red, green, blue, alpha]).collect();
        let has_holes = texels.iter().any(|texel| texel[3] < 128);
        Self { levels: vec![Level { width, height, texels }], wraps, has_holes, is_cut: false }
    }

    /// None of its texels.
    pub(super) fn unused(&self) -> UsedTexels {
        UsedTexels::new(self.levels[0].width, self.levels[0].height)
    }

    /// Adds copies of half the size, down to one texel, of what is used; `is_cut` where all that use it leave out what is transparent.
    pub(super) fn add_copies(&mut self, mut used: UsedTexels, is_cut: bool) {
        self.is_cut = is_cut && self.has_holes;
        while let Some(last) = self.levels.last().filter(|last| last.width.max(last.height) > 1) {
            let next = last.halved(&used, self.is_cut);
            self.levels.push(next);
            used = used.halved();
        }
    }

    /// Texels of the whole picture, across and down.
    pub fn size(&self) -> [f32; 2] {
        [self.levels[0].width as f32, self.levels[0].height as f32]
    }

    /// Whether a texel is less opaque than not.
    pub(crate) fn has_holes(&self) -> bool {
        self.has_holes
    }

    /// Mean linear colour and opacity of a pixel around a place (0 to 1 over the picture): by probes along its longer side, each
    /// from the copies whose texels are about as wide as the shorter one.
    pub fn sample(&self, place: [f32; 2], pixel: PixelSides) -> [f32; 4] {
        let [width, height] = self.size();
        let [[ax, ay], [bx, by]] = pixel.map(|[across, down]| [across * width, down * height]);
        // Singular values of the pixel's sides in texels, and the direction of the larger one.
        let (xx, xy, yy) = (ax * ax + bx * bx, ax * ay + bx * by, ay * ay + by * by);
        let (mean, apart) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
        let [long, short] = [mean + apart, mean - apart].map(|it| it.max(0.0).sqrt());
        let short = SHARPNESS * short;
        let probes = (long / short.max(1.0)).ceil().clamp(1.0, MOST_PROBES);
        let texels = short.max(SHARPNESS * long / probes);
        if probes < 2.0 || probes.is_nan() {
            return self.unweighted(self.sample_square(place, texels));
        }
        let (x, y) = if xx > yy { (mean + apart - yy, xy) } else { (xy, mean + apart - xx) };
        let step = long / (probes * (x * x + y * y).sqrt());
        let step = [x * step / width, y * step / height];
        let probe = |number: usize| {
            let away = number as f32 + 0.5 - 0.5 * probes;
            self.sample_square([place[0] + away * step[0], place[1] + away * step[1]], texels)
        };
        let sum = (0..probes as usize).map(probe).fold([0.0; 4], |sum, own| [0, 1, 2, 3].map(|k| sum[k] + own[k]));
        self.unweighted(sum.map(|sum| sum / probes))
    }

    /// A colour without its weight.
    fn unweighted(&self, [red, green, blue, alpha]: [f32; 4]) -> [f32; 4] {
        let weight = if self.is_cut && alpha > 0.0 { alpha } else { 1.0 };
        [red / weight, green / weight, blue / weight, alpha]
    }

    /// Between the two copies whose texels are nearest to a square of so many texels of the whole picture a side.
    fn sample_square(&self, place: [f32; 2], texels: f32) -> [f32; 4] {
        let step = libm::log2f(texels.max(1.0)).min((self.levels.len() - 1) as f32);
        let (fine, share) = (step.floor(), step - step.floor());
        let near = self.levels[fine as usize].sample(place, self.wraps, self.is_cut);
        if share <= 0.0 {
            return near;
        }
        let far = self.levels[(fine as usize + 1).min(self.levels.len() - 1)].sample(place, self.wraps, self.is_cut);
        [0, 1, 2, 3].map(|k| near[k] + (far[k] - near[k]) * share)
    }
}

impl Level {
    /// Means of two by two texels in light, of those that are used if any are; of one at an odd edge. Of a picture that is cut,
    /// texels count as much as they are opaque, if any is.
    fn halved(&self, used: &UsedTexels, is_cut: bool) -> Self {
        let light = light();
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut texels = Vec::with_capacity(width * height);
        for row in 0..height {
            for column in 0..width {
                let (left, top) = (2 * column, 2 * row);
                let (right, below) = ((left + 1).min(self.width - 1), (top + 1).min(self.height - 1));
                let four = [(left, top), (right, top), (left, below), (right, below)];
                let is_any = four.iter().any(|(x, y)| used.is_used(*x, *y));
                let kept = four.iter().filter(|(x, y)| !is_any || used.is_used(*x, *y));
                let kept = || kept.clone().map(|(x, y)| self.texels[y * self.width + x]);
                // Most of a large picture of few bytes.
                let first = self.texels[top * self.width + left];
                if kept().all(|texel| texel == first) {
                    texels.push(first);
                    continue;
                }
                let count = kept().count() as u16;
                let opacity = kept().map(|texel| u16::from(texel[3])).sum::<u16>();
                let weight = |texel: &[u8; 4]| if is_cut && opacity > 0 { f32::from(texel[3]) } else { 1.0 };
                let weights = kept().map(|texel| weight(&texel)).sum::<f32>();
                let mean = |channel: usize| {
                    let light = kept().map(|texel| weight(&texel) * light[usize::from(texel[channel])]);
                    code(light.sum::<f32>() / weights)
                };
                texels.push([mean(0), mean(1), mean(2), ((opacity + count / 2) / count) as u8]);
            }
        }
        Self { width, height, texels }
    }

    /// Between the four texels around a place; the colours of a picture that is cut times their opacity.
    fn sample(&self, [u, v]: [f32; 2], [across, down]: [TextureWrap; 2], is_cut: bool) -> [f32; 4] {
        let light = light();
        let place = |at: f32, count: usize, wrap: TextureWrap| {
            let at = match wrap {
                TextureWrap::Repeat => at - at.floor(),
                TextureWrap::Mirror => 1.0 - (2.0 * (0.5 * at - (0.5 * at).floor()) - 1.0).abs(),
                TextureWrap::Clamp => at.clamp(0.0, 1.0),
            };
            let texel = (if at.is_finite() { at } else { 0.0 }) * count as f32 - 0.5;
            let (first, share) = (texel.floor() as i64, texel - texel.floor());
            let next = (first + 1) as usize;
            match wrap {
                TextureWrap::Repeat => (first.rem_euclid(count as i64) as usize, next % count, share),
                _ => (first.max(0) as usize, next.min(count - 1), share),
            }
        };
        let ((left, right, x), (top, below, y)) = (place(u, self.width, across), place(v, self.height, down));
        let texel = |column: usize, row: usize| {
            let [red, green, blue, alpha] = self.texels[row * self.width + column];
            let alpha = f32::from(alpha) / 255.0;
            let weight = if is_cut { alpha } else { 1.0 };
            let [red, green, blue] = [red, green, blue].map(|code| weight * light[usize::from(code)]);
            [red, green, blue, alpha]
        };
        let row = |row: usize| {
            let (from, to) = (texel(left, row), texel(right, row));
            [0, 1, 2, 3].map(|k| from[k] + (to[k] - from[k]) * x)
        };
        let (from, to) = (row(top), row(below));
        [0, 1, 2, 3].map(|k| from[k] + (to[k] - from[k]) * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_lie_between_texels_and_far_ones_are_the_mean_of_their_light() {
        let picture =
            Picture { width: 4, height: 1, rgb: vec![[0; 3], [255; 3], [0; 3], [255; 3]], alpha: vec![255, 0, 255, 0] };
        let whole = |picture: &Picture, wrap| {
            let mut texture = MeshTexture::new(picture.clone(), [wrap; 2]);
            texture.add_copies(texture.unused(), false);
            texture
        };
        let texture = whole(&picture, TextureWrap::Repeat);
        // Pixels that cover a square of the picture.
        let square = |texels: f32| [[texels / 4.0, 0.0], [0.0, texels]];
        assert_eq!(texture.sample([0.125, 0.5], square(1.0)), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(texture.sample([0.375, 0.5], square(1.0)), [1.0, 1.0, 1.0, 0.0]);
        // Half the light is the code 188, half the opacity 128 of 255.
        let mean = texture.sample([0.1, 0.1], square(1e9));
        assert!((mean[0] - 0.5).abs() < 5e-3 && (mean[3] - 0.5).abs() < 5e-3, "{mean:?}");
        assert!(texture.sample([f32::NAN, f32::INFINITY], square(f32::NAN)).iter().all(|it| it.is_finite()));
        for (wrap, beyond) in [(TextureWrap::Clamp, 1.0), (TextureWrap::Mirror, 1.0), (TextureWrap::Repeat, 0.0)] {
            let texture = whole(&picture, wrap);
            assert_eq!(texture.sample([1.125, 0.5], square(1.0))[0], beyond, "{wrap:?}");
            // At the edge itself, a repeated picture is between its two sides.
            assert_eq!(texture.sample([1.0, 0.5], square(1.0))[0], if beyond == 1.0 { 1.0 } else { 0.5 }, "{wrap:?}");
            assert!(texture.sample([-7.3, f32::NAN], square(3.0)).iter().all(|it| it.is_finite()));
        }
        // A pixel that is long across covers both columns of a pair, and one that is long down none but its own.
        let texture = whole(&picture, TextureWrap::Repeat);
        assert!((texture.sample([0.25, 0.5], [[0.0, 0.0], [0.5, 0.0]])[0] - 0.5).abs() < 1e-3);
        assert_eq!(texture.sample([0.375, 0.5], [[0.0, 7.0], [0.01, 0.0]])[0], 1.0);
        // Where one piece of the picture is used, the rest does not mix into far copies.
        let (mut texture, mut used) = (MeshTexture::new(picture, [TextureWrap::Clamp; 2]), texture.unused());
        used.add([[0.3, 0.2], [0.45, 0.2], [0.3, 0.8]]);
        texture.add_copies(used, false);
        assert_eq!(texture.sample([0.375, 0.5], square(4.0))[0], 1.0);
        assert!((0..=255).all(|own: u8| code(light()[usize::from(own)]) == own));
        assert_eq!((code(-1.0), code(2.0), code(f32::NAN)), (0, 255, 0));
    }

    /// A leaf of one green, a disc on a square, whose hidden texels have another colour.
    fn leaf(hidden: [u8; 3], is_cut: bool) -> MeshTexture {
        let green = [40, 120, 20];
        let is_leaf = |at: i32| (2 * (at % 16) - 15).pow(2) + (2 * (at / 16) - 15).pow(2) < 150;
        let rgb = (0..256).map(|at| if is_leaf(at) { green } else { hidden }).collect();
        let alpha = (0..256).map(|at| if is_leaf(at) { 255 } else { 0 }).collect();
        let mut texture = MeshTexture::new(Picture { width: 16, height: 16, rgb, alpha }, [TextureWrap::Clamp; 2]);
        let mut used = texture.unused();
        used.add([[-1.0, -1.0], [2.0, 0.0], [0.0, 2.0]]);
        texture.add_copies(used, is_cut);
        texture
    }

    #[test]
    fn hidden_texels_give_a_leaf_no_colour_at_any_distance() {
        let green = [40, 120, 20].map(|code| light()[code]);
        for hidden in [[0; 3], [255; 3]] {
            let (cut, whole) = (leaf(hidden, true), leaf(hidden, false));
            for texels in [1.0, 1.7, 3.0, 6.0, 16.0, 100.0_f32] {
                let square = [[texels / 16.0, 0.0], [0.0, texels / 16.0]];
                for place in [[0.5, 0.5], [0.25, 0.5], [0.22, 0.31], [0.9, 0.5]] {
                    let [red, green_light, blue, alpha] = cut.sample(place, square);
                    assert!((0.0..=1.0).contains(&alpha));
                    let apart = (0..3).map(|k| ([red, green_light, blue][k] - green[k]).abs()).fold(0.0, f32::max);
                    // Copies keep codes of sRGB, whose steps are up to a hundredth of the light.
                    assert!(alpha < 0.01 || apart < 0.01, "{hidden:?}, {texels} texels at {place:?}: {apart}");
                }
            }
            // What all opaque things show of a picture is all of it.
            let far = whole.sample([0.5, 0.5], [[9.0, 0.0], [0.0, 9.0]]);
            assert!((far[1] - green[1]).abs() > 0.05, "{far:?}");
        }
    }
}
