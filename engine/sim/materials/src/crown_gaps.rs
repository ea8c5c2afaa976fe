//! Gaps in the edges of crowns, and between the twigs of bare ones: how much of a pixel is open, and how much boughs cover.

use super::boughs::boughs;
use super::clumps::CrownRays;
use super::leaves::LeafCrown;
use super::pattern::{NoiseTexture, Noises, least, lerp, most, share};
use super::vector::Vec3;
use cosfly_domain::SemanticLabel;
use cosfly_frames::simd_kernel;

/// How thin leaves must be for a gap: at the edge, and that much more at the end of its reach.
const THIN: [f32; 2] = [0.96, 0.78];
/// How far from the middle of a twig a gap begins: at the rim of a bare crown, and that much more in its middle.
const BARE_THIN: [f32; 2] = [0.03, 0.02];
/// How much of a pixel is open where twigs are thinner than it.
const BARE_OPEN: f32 = 0.8;
/// How fast leaves become a gap as noise grows: edges of leaves are soft, so that no pixel pops.
const STEEPNESS: f32 = 8.0;
/// How fast leaves get thin beyond clumps, and how much at most; within clumps they are as much denser.
const BEYOND: f32 = 3.0;
const MOST_BEYOND: f32 = 0.6;
/// How much denser twigs are within clumps at most.
const BARE_DENSER: f32 = 0.045;
/// Pixels that are looked at together.
pub const TOGETHER: usize = 256;

/// A pixel of a crown.
pub struct GapPlace<'a> {
    /// The round crown.
    pub crown: &'a LeafCrown,
    /// Whether it has twigs and no leaves.
    pub is_bare: bool,
    /// Where the pattern of the tree begins.
    pub shift: f32,
    /// The way from the eye, of length 1 along the optical axis.
    pub ray: Vec3,
    /// Depth along the optical axis, metres.
    pub depth_m: f32,
    /// Size of a pixel there, metres.
    pub pixel_m: f32,
    /// How far inside the crown, as a share of how far gaps reach.
    pub inside: f32,
}

/// Where pixels are, and how thin leaves must be.
pub struct GapPlaces {
    /// Middles of round crowns, metres, one divided by half their size, and ways from the eye.
    middle: [[f32; TOGETHER]; 3],
    shrink: [[f32; TOGETHER]; 3],
    ray: [[f32; TOGETHER]; 3],
    /// Cosine and sine of how clumps are turned.
    turn: [[f32; TOGETHER]; 2],
    depth_m: [f32; TOGETHER],
    /// Size of a pixel at the edge, metres.
    pixel_m: [f32; TOGETHER],
    shift: [f32; TOGETHER],
    /// Pixels with more of a gap than this have some of one.
    least: [f32; TOGETHER],
    /// One where there are twigs and no leaves.
    bare: [f32; TOGETHER],
}

impl GapPlaces {
    /// Nothing in particular.
    pub const EMPTY: Self = Self {
        middle: [[0.0; TOGETHER]; 3],
        shrink: [[1.0; TOGETHER]; 3],
        ray: [[1.0; TOGETHER]; 3],
        turn: [[0.0; TOGETHER]; 2],
        depth_m: [1.0; TOGETHER],
        pixel_m: [1.0; TOGETHER],
        shift: [0.0; TOGETHER],
        least: [0.0; TOGETHER],
        bare: [0.0; TOGETHER],
    };

    /// Sets pixel `at`.
    pub fn put(&mut self, at: usize, new: &GapPlace<'_>) {
        let LeafCrown { middle, shrink, turn } = new.crown;
        for (rows, v) in [(&mut self.middle, middle), (&mut self.shrink, shrink), (&mut self.ray, &new.ray)] {
            (rows[0][at], rows[1][at], rows[2][at]) = (v.x, v.y, v.z);
        }
        (self.turn[0][at], self.turn[1][at]) = (turn[0], turn[1]);
        (self.depth_m[at], self.pixel_m[at], self.shift[at]) = (new.depth_m, new.pixel_m, new.shift);
        let [thin, more] = if new.is_bare { BARE_THIN } else { THIN };
        self.least[at] = thin + more * new.inside;
        self.bare[at] = if new.is_bare { 1.0 } else { 0.0 };
    }

    /// The row of pixel `at` among three.
    #[inline(always)]
    fn three(rows: &[[f32; TOGETHER]; 3], at: usize) -> Vec3 {
        Vec3::new(rows[0][at], rows[1][at], rows[2][at])
    }
}

simd_kernel! {
    /// Share of pixels without leaves, and that boughs cover, where there are bare crowns. Noise of leaves and of branches stays where
    /// it is in the world while the camera moves little.
    pub fn crown_gaps(
        places: &GapPlaces,
        eye: Vec3,
        noise: &NoiseTexture,
        has_bare: bool,
        gap: &mut [f32; TOGETHER],
        wood: &mut [f32; TOGETHER],
    ) {
        let (mut rays, mut met) = (CrownRays::EMPTY, [0.0; TOGETHER]);
        for k in 0..TOGETHER {
            let [middle, shrink, ray] = [&places.middle, &places.shrink, &places.ray].map(|rows| GapPlaces::three(rows, k));
            let crown = LeafCrown { middle, shrink, turn: [places.turn[0][k], places.turn[1][k]] };
            rays.put(k, crown.ray(eye, ray));
        }
        rays.most_met(&mut met);
        for (k, gap) in gap.iter_mut().enumerate() {
            let place = eye + GapPlaces::three(&places.ray, k) * places.depth_m[k];
            let beyond = least(most(-BEYOND * met[k], lerp(-MOST_BEYOND, -BARE_DENSER, places.bare[k])), MOST_BEYOND);
            // No face of a box is seen edge-on in these two directions.
            let x = 0.8 * place.x + 0.45 * place.y + 0.3 * place.z;
            let y = 0.35 * place.x - 0.7 * place.y + 0.85 * place.z;
            let (pixel_m, shift) = (places.pixel_m[k], places.shift[k]);
            let leaves = noise.rough(x * 26.0 + shift, y * 26.0, pixel_m * 32.0);
            let branches = noise.clumps(x * 15.0, y * 15.0 + shift, pixel_m * 19.0);
            let twigs = 0.35 * (branches - 0.5).abs() + (leaves - 0.5).abs();
            // Twigs that are thinner than a pixel cover a part of it.
            let fine = share(0.8 * (pixel_m * 20.0 - 0.5));
            let twigs = lerp(twigs, places.least[k] + BARE_OPEN / STEEPNESS, fine);
            let thin = lerp(1.7 * branches + 0.75 * leaves, twigs, places.bare[k]);
            *gap = share((thin + beyond - places.least[k]) * STEEPNESS);
        }
        wood.fill(0.0);
        if has_bare {
            let mut pixel = [0.0; TOGETHER];
            for (k, pixel) in pixel.iter_mut().enumerate() {
                *pixel = most(places.pixel_m[k] * least(places.shrink[0][k], places.shrink[2][k]), 1e-4);
            }
            boughs(&rays, &pixel, wood);
            for k in 0..TOGETHER {
                wood[k] *= places.bare[k];
                gap[k] *= 1.0 - wood[k];
            }
        }
    }
}

/// From one colour to another, as `part` goes from 0 to 256.
pub fn mixed(from: [u8; 3], to: [u8; 3], part: i32) -> [u8; 3] {
    let mix = |k: usize| i32::from(from[k]) + (part.wrapping_mul(i32::from(to[k]) - i32::from(from[k])) >> 8);
    [0, 1, 2].map(|k| mix(k) as u8)
}

/// Whether a label is one of people, vehicles and what they take along.
pub fn is_body(label: u8) -> bool {
    (SemanticLabel::Pedestrian.id()..=SemanticLabel::Bicycle.id()).contains(&label)
        || label == SemanticLabel::Dynamic.id()
}
