//! [`StereoMatcher`]: the best disparity of each pixel, to fractions of a pixel, where it is unique and both pictures agree.

use super::census::Grey;
use super::paths::{BLOCK, Paths, add_row};
use super::speckles::Speckles;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Steps of a pixel that disparities are counted in.
pub const STEPS: u16 = 16;
/// Most disparities.
const MOST: usize = 128;
/// A second disparity whose costs are at most a tenth and so much above the best is as good.
const AMBIGUOUS: u16 = 4;

/// Matches pictures of one size; keep one per thread.
pub struct StereoMatcher {
    width: usize,
    disparities: usize,
    pictures: [Grey; 2],
    /// Codes of a row of both pictures; those of the other one from right to left.
    codes: [Vec<u32>; 2],
    paths: Paths,
    found: Vec<u16>,
    /// The best disparity of each pixel of a row, and of the other picture's pixels with its costs.
    best: Vec<usize>,
    others_best: Vec<(u16, usize)>,
    speckles: Speckles,
}

impl StereoMatcher {
    /// A matcher of pictures of this width. It finds disparities up to the asked one, pixels, 127 at most.
    pub fn new(width: usize, largest: usize) -> Self {
        // The disparity after the largest one is compared, too.
        let disparities = (largest + 2).next_multiple_of(BLOCK).min(MOST);
        Self {
            width,
            disparities,
            pictures: [Grey::default(), Grey::default()],
            codes: [vec![0; width], vec![0; width]],
            paths: Paths::new(width, disparities),
            found: vec![],
            best: vec![0; width],
            others_best: vec![(0, 0); width],
            speckles: Speckles::default(),
        }
    }

    /// Disparities of the pixels of a picture in sRGB, in [`STEPS`] of a pixel; 0 where there is none. A point in column u is in column
    /// u - disparity of the other picture, or u + disparity where this is the right one.
    pub fn matched(&mut self, level: Level, [this, other]: [&[u8]; 2], is_right: bool) -> &[u16] {
        let width = self.width;
        self.pictures[0].take(this, width, is_right);
        self.pictures[1].take(other, width, is_right);
        self.found.resize(this.len() / 3, 0);
        self.paths.begin();
        for (row, found) in self.found.chunks_mut(width).enumerate() {
            let [codes, others] = &mut self.codes;
            self.pictures[0].codes(level, row, codes);
            self.pictures[1].codes(level, row, others);
            others.reverse();
            add_row(level, &mut self.paths, codes, others);
            let sums = &self.paths.sums;
            choose(level, sums, self.disparities, &mut self.best, &mut self.others_best, found);
            if is_right {
                found.reverse();
            }
        }
        self.speckles.drop_from(&mut self.found, width, STEPS);
        &self.found
    }
}

simd_kernel! {
    /// The disparities of a row from the costs of all.
    fn choose(
        sums: &[u16],
        disparities: usize,
        best: &mut [usize],
        others_best: &mut [(u16, usize)],
        found: &mut [u16],
    ) {
        others_best.fill((u16::MAX, 0));
        for (at, (sums, (best, found))) in sums.chunks(disparities).zip(best.iter_mut().zip(&mut *found)).enumerate() {
            let least = sums.iter().fold(u16::MAX, |least, sum| least.min(*sum));
            *best = sums.iter().position(|sum| *sum == least).unwrap_or(0);
            if let Some(column) = at.checked_sub(*best) {
                others_best[column] = others_best[column].min((least, *best));
            }
            let as_good = least + least / 10 + AMBIGUOUS;
            let as_good = |sums: &[u16]| sums.iter().fold(0_u16, |count, sum| count.wrapping_add(u16::from(*sum <= as_good)));
            let (rivals, near) = (as_good(sums), as_good(&sums[best.saturating_sub(1)..(*best + 2).min(disparities)]));
            *found = if rivals > near || *best + 1 == disparities { 0 } else { fraction(sums, *best) };
        }
        for (at, (best, found)) in best.iter().zip(found).enumerate() {
            let agreed = at.checked_sub(*best).is_some_and(|column| others_best[column].1.abs_diff(*best) <= 1);
            if !agreed {
                *found = 0;
            }
        }
    }
}

/// Where two lines of the same steepness through the best costs and those beside them meet; 0 below a whole pixel.
#[inline(always)]
fn fraction(sums: &[u16], best: usize) -> u16 {
    if best == 0 {
        return 0;
    }
    let [before, least, behind] = [best - 1, best, best + 1].map(|at| i32::from(sums[at]));
    let (steep, steps) = ((before.max(behind) - least).max(1), i32::from(STEPS));
    let found = steps * best as i32 + ((before - behind) * steps + steep).div_euclid(2 * steep);
    if found < steps { 0 } else { found as u16 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    const WIDTH: usize = 160;
    const HEIGHT: usize = 48;

    /// A texture, at eight places a pixel, smooth over two pixels.
    fn texture(seed: u8) -> Vec<u8> {
        let mut stream = Seed([seed; 32]).stream("texture");
        let knots: Vec<f64> = (0..WIDTH * 2 * HEIGHT).map(|_| stream.uniform(20.0, 235.0)).collect();
        let places = 8 * 2 * WIDTH * HEIGHT;
        let at = |place: usize| (place / 16, (place % 16) as f64 / 16.0);
        let value =
            |(knot, share): (usize, f64)| knots[knot] + share * (knots[(knot + 1).min(knots.len() - 1)] - knots[knot]);
        (0..places).map(|place| value(at(place)) as u8).collect()
    }

    /// A pair: every pixel shows the texture of its surface, moved in the right picture. Disparities in eighths of a pixel.
    fn pair(disparity: impl Fn(usize, usize) -> usize) -> [Vec<u8>; 2] {
        let (ground, near) = (texture(1), texture(2));
        let nearest = (0..HEIGHT * WIDTH).map(|at| disparity(at % WIDTH, at / WIDTH)).max().unwrap_or(0);
        let picture = |is_right: bool| {
            let mut rgb = vec![];
            for at in 0..WIDTH * HEIGHT {
                let (column, row) = (at % WIDTH, at / WIDTH);
                // Of the right picture: the largest disparity whose surface is at its place on the left.
                let seen = (0..=nearest)
                    .rev()
                    .find(|it| !is_right || disparity((8 * column + it + 4) / 8, row) == *it)
                    .unwrap_or(0);
                let seen = if is_right { seen } else { disparity(column, row) };
                let place = 8 * column + if is_right { seen } else { 0 };
                let texture = if seen == nearest { &near } else { &ground };
                rgb.extend([texture[row * 16 * WIDTH + place]; 3]);
            }
            rgb
        };
        [picture(false), picture(true)]
    }

    /// Errors of the disparities found, pixels, and the share of pixels without one, over columns that both pictures have.
    fn errors(found: &[u16], disparity: impl Fn(usize, usize) -> usize) -> (f64, f64) {
        let (mut errors, mut holes) = (vec![], 0);
        for (at, found) in found.iter().enumerate().filter(|(at, _)| (40..WIDTH - 40).contains(&(at % WIDTH))) {
            let exact = disparity(at % WIDTH, at / WIDTH) as f64 / 8.0;
            if *found == 0 { holes += 1 } else { errors.push((f64::from(*found) / f64::from(STEPS) - exact).abs()) }
        }
        errors.sort_by(f64::total_cmp);
        (errors[errors.len() / 2], f64::from(holes) / (holes as f64 + errors.len() as f64))
    }

    #[test]
    fn shifts_of_a_plane_are_found_to_fractions_of_a_pixel() {
        for eighths in [11, 40, 77, 150] {
            let [left, right] = pair(|_, _| eighths);
            let mut matcher = StereoMatcher::new(WIDTH, 30);
            let of_left = errors(matcher.matched(Level::best(), [&left, &right], false), |_, _| eighths);
            let of_right = errors(matcher.matched(Level::best(), [&right, &left], true), |_, _| eighths);
            for (median, holes) in [of_left, of_right] {
                assert!(median < 0.25 && holes < 0.06, "{eighths}/8 px: {median} {holes}");
            }
        }
    }

    #[test]
    fn what_the_other_camera_does_not_see_is_a_hole() {
        let surface = |column: usize, row: usize| {
            if (70..100).contains(&column) && (10..40).contains(&row) { 160 } else { 48 }
        };
        let [left, right] = pair(surface);
        let mut matcher = StereoMatcher::new(WIDTH, 30);
        let found = matcher.matched(Level::best(), [&left, &right], false);
        let (median, _) = errors(found, surface);
        assert!(median < 0.2, "{median}");
        // 20 - 6 px beside the near surface's left edge.
        let hidden: Vec<u16> = (15..35).flat_map(|row| found[row * WIDTH + 59..row * WIDTH + 67].to_vec()).collect();
        let holes = hidden.iter().filter(|found| **found == 0).count();
        assert!(holes * 10 > hidden.len() * 7, "{holes} of {}", hidden.len());
    }

    #[test]
    fn a_picture_without_texture_has_no_disparities_and_all_levels_give_the_same() {
        let flat = vec![90; 3 * WIDTH * HEIGHT];
        let mut matcher = StereoMatcher::new(WIDTH, 30);
        assert!(matcher.matched(Level::best(), [&flat, &flat], false).iter().all(|found| *found == 0));
        let [left, right] = pair(|column, _| 20 + column / 4);
        let first = matcher.matched(Level::PLAIN, [&left, &right], false).to_vec();
        assert!(Level::available().into_iter().all(|it| matcher.matched(it, [&left, &right], false) == first));
    }
}
