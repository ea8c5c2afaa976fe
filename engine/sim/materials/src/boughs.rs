//! Boughs of crowns without leaves: which rays from the eye meet them. All crowns have the same, turned as their clumps are.

use super::clumps::CrownRays;
use super::pattern::{most, share};
use super::vector::Vec3;

/// A bough in the crown's own measure, in which half its size is 1: where it begins, where it ends, and half its width there where it
/// begins; it tapers to a sixth of that.
struct Bough {
    from: [f32; 3],
    to: [f32; 3],
    half_width: f32,
}

const fn bough(from: [f32; 3], to: [f32; 3], half_width: f32) -> Bough {
    Bough { from, to, half_width }
}

/// The trunk goes on into the crown; boughs leave it, and fork.
const BOUGHS: [Bough; 18] = [
    bough([0.0, 0.0, -1.70], [0.05, -0.03, -0.10], 0.080),
    bough([0.0, 0.0, -0.85], [0.55, 0.15, 0.25], 0.036),
    bough([0.0, 0.0, -0.80], [-0.50, 0.30, 0.30], 0.036),
    bough([0.01, 0.0, -0.70], [0.10, -0.60, 0.35], 0.034),
    bough([0.02, 0.0, -0.60], [-0.25, -0.45, 0.50], 0.032),
    bough([0.03, -0.01, -0.45], [0.30, 0.45, 0.60], 0.032),
    bough([0.05, -0.03, -0.15], [-0.10, 0.10, 0.85], 0.028),
    bough([0.05, -0.03, -0.10], [0.30, -0.20, 0.80], 0.028),
    bough([0.0, 0.0, -0.75], [-0.60, -0.35, -0.10], 0.030),
    bough([0.0, 0.0, -0.70], [0.35, 0.60, -0.05], 0.028),
    bough([0.30, 0.08, -0.28], [0.75, -0.20, 0.10], 0.022),
    bough([0.35, 0.10, -0.20], [0.60, 0.50, 0.30], 0.020),
    bough([-0.30, 0.18, -0.14], [-0.75, -0.05, 0.20], 0.022),
    bough([-0.35, 0.20, -0.03], [-0.45, 0.65, 0.30], 0.020),
    bough([0.06, -0.35, -0.08], [0.50, -0.60, 0.20], 0.020),
    bough([0.07, -0.40, 0.0], [-0.35, -0.75, 0.15], 0.020),
    bough([0.20, 0.28, 0.15], [0.05, 0.70, 0.40], 0.018),
    bough([-0.15, -0.25, 0.06], [-0.55, -0.35, 0.55], 0.018),
];
/// How much of its width a bough has lost at its end.
const TAPER: f32 = 0.84;

/// Share of each pixel that boughs cover; `pixel` is its size in the crown's own measure.
#[inline(always)]
pub fn boughs<const N: usize>(rays: &CrownRays<N>, pixel: &[f32; N], covered: &mut [f32; N]) {
    covered.fill(0.0);
    for Bough { from: [x, y, z], to, half_width } in &BOUGHS {
        let start = Vec3::new(*x, *y, *z);
        let along = Vec3::new(to[0] - x, to[1] - y, to[2] - z);
        for (k, covered) in covered.iter_mut().enumerate() {
            let (ray, pixel) = (rays.at(k), pixel[k]);
            // The place on the bough that is nearest to the ray, and the way from the ray to it.
            let reach = ray.from() - start;
            let (both, own) = (ray.along().dot(along), along.dot(along));
            let (ahead, beside) = (ray.along().dot(reach), along.dot(reach));
            let at = share((beside - both * ahead) / most(own - both * both, 1e-4));
            let away = along * at - reach;
            let forth = away.dot(ray.along());
            let apart_squared = away.dot(away) - forth * forth;
            let half_width = half_width * (1.0 - TAPER * at);
            // Thinner than a pixel, a bough covers a part of it.
            let drawn = most(half_width, 0.5 * pixel);
            let edge = share((drawn * drawn - apart_squared) / (2.0 * drawn * pixel) + 0.5);
            *covered = most(*covered, edge * half_width / drawn);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clumps::CrownRay;

    fn covered(ray: CrownRay, pixel: f32) -> f32 {
        let (mut rays, mut covered) = (CrownRays::<1>::EMPTY, [0.0]);
        rays.put(0, ray);
        boughs(&rays, &[pixel], &mut covered);
        covered[0]
    }

    /// A ray through a place, from far away.
    fn through(place: Vec3, from: Vec3) -> CrownRay {
        CrownRay::new(from, (place - from).unit())
    }

    #[test]
    fn rays_through_boughs_are_covered_from_all_sides_and_rays_beside_the_crown_are_not() {
        let sides = [Vec3::new(8.0, 1.0, 2.0), Vec3::new(-3.0, 7.0, 4.0), Vec3::new(0.5, -0.3, 9.0)];
        for Bough { from: [x, y, z], to, .. } in &BOUGHS {
            let middle = (Vec3::new(*x, *y, *z) + Vec3::new(to[0], to[1], to[2])) * 0.5;
            for side in sides {
                assert!(covered(through(middle, side), 0.005) > 0.9, "{middle:?} from {side:?}");
            }
        }
        for beside in [Vec3::new(0.0, 1.2, 0.5), Vec3::new(0.0, 0.4, 1.1), Vec3::new(0.0, -1.0, -0.6)] {
            assert_eq!(covered(through(beside, beside + Vec3::new(8.0, 0.0, 0.0)), 0.005), 0.0);
        }
    }

    #[test]
    fn boughs_cover_as_much_in_large_pixels_as_in_small_ones() {
        let share = |pixel: f32| {
            let rays = (0..6400).map(|k| {
                let place = Vec3::new(0.0, (k % 80) as f32 / 40.0 - 1.0, (k / 80) as f32 / 40.0 - 1.0);
                CrownRay::new(place + Vec3::new(6.0, 0.0, 0.0), Vec3::new(-1.0, 0.0, 0.0))
            });
            rays.map(|ray| covered(ray, pixel)).sum::<f32>() / 6400.0
        };
        let [small, large] = [0.005, 0.06].map(share);
        assert!((0.02..0.25).contains(&small) && (large - small).abs() < 0.35 * small, "{small}, {large}");
    }
}
