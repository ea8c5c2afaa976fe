//! Less sky where somebody stands on the ground, and below vehicles.

use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::simd::Level;
use cosfly_frames::{real, simd_kernel};
use cosfly_materials::lanes::{Block, Shared, WIDE, get, groups};
use cosfly_materials::pattern::{most, share};
use cosfly_materials::vector::Vec3;

/// From the middle of a four, all its pixels lie within so many of their sizes.
pub(super) const FOUR_SIZES: f32 = 2.0;

/// One divided by how far below a vehicle no sky is seen, 1/m.
const PER_DEEP_M: f32 = 3.0;

/// Darkens ground below somebody and around.
pub(super) fn contact(level: Level, shared: &[Shared], blocks: &mut [Block], figure: &BodyFigure) {
    let feet = figure.state.feet_in_world.into();
    let footprint = match figure.body {
        BodyShape::Person { .. } => {
            let reach_m = 3.0 * figure.radius_m.clamp(0.1, 2.0) as f32;
            Footprint { feet, along: [1.0, 0.0], half_m: [0.0; 2], reach_m, taken: 0.55, below: 0.0 }
        }
        BodyShape::Vehicle { size_m, .. } => {
            let (sin, cos) = real::sin_cos(figure.state.heading_rad);
            // Two-wheelers touch the ground along a line.
            let width = if size_m.y < 1.0 { 0.15 } else { 1.0 };
            let half_m = [0.5 * size_m.x as f32, 0.5 * width * size_m.y as f32];
            Footprint { feet, along: [cos as f32, sin as f32], half_m, reach_m: 1.9, taken: 0.5, below: 0.35 }
        }
    };
    darken(level, shared, blocks, &footprint);
}

/// A rectangle of ground whose length lies along a unit vector.
#[derive(Clone, Copy)]
struct Footprint {
    feet: Vec3,
    along: [f32; 2],
    half_m: [f32; 2],
    /// Ground this far around it is darkened, too.
    reach_m: f32,
    /// Share of the sky that it takes at its edge, as a wall does, and from there to well below it.
    taken: f32,
    below: f32,
}

impl Footprint {
    /// Square of the distance of a point to it, square metres, and how far below it the point is from its edge, metres.
    #[inline(always)]
    fn away(&self, point: Vec3) -> (f32, f32) {
        let ([cos, sin], [half_length_m, half_width_m]) = (self.along, self.half_m);
        let away = point - self.feet;
        let (ahead, aside) = (away.x * cos + away.y * sin, away.y * cos - away.x * sin);
        let (ahead, aside) = (ahead.abs() - half_length_m, aside.abs() - half_width_m);
        let below_m = -most(ahead, aside);
        let (ahead, aside) = (most(ahead, 0.0), most(aside, 0.0));
        (ahead * ahead + aside * aside + away.z * away.z, below_m)
    }
}

simd_kernel! {
    fn darken(shared: &[Shared], blocks: &mut [Block], footprint: &Footprint) {
        let footprint = *footprint;
        let per_reach2 = 1.0 / (footprint.reach_m * footprint.reach_m);
        for (shared, four) in groups(shared, blocks) {
            let mut is_near = 0u32;
            for k in 0..WIDE {
                let near_m = footprint.reach_m + FOUR_SIZES * (shared.along_m[k] + shared.up_m[k]);
                is_near |= u32::from(footprint.away(get(&shared.middle, k)).0 < near_m * near_m);
            }
            if is_near == 0 {
                continue;
            }
            for block in four {
                for k in 0..WIDE {
                    let (away_m2, below_m) = footprint.away(get(&block.world, k));
                    let shade = share(1.0 - away_m2 * per_reach2);
                    let taken = footprint.taken + footprint.below * share(below_m * PER_DEEP_M);
                    block.openness[k] *= 1.0 - taken * shade * shade * shade;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::BodyKind;
    use cosfly_frames::{DVec3, Seed, TargetState};
    use cosfly_materials::lanes::{FOUR, set};

    /// Openness of level ground at places so far ahead and to the right of a car that drives along x, in fours of a row.
    fn openness(places: &[[f64; 2]; FOUR]) -> [f32; FOUR] {
        let car = BodyFigure {
            state: TargetState { feet_in_world: DVec3::new(30.0, -8.0, 1.0), heading_rad: 0.0, speed_mps: 0.0 },
            height_m: 1.5,
            radius_m: 1.0,
            clothes_seed: Seed([3; 32]),
            gait_phase_rad: 0.0,
            body: BodyShape::Vehicle { kind: BodyKind::Car, size_m: DVec3::new(4.4, 1.8, 1.5) },
        };
        let place = |k: usize| car.state.feet_in_world + DVec3::new(places[k][0], places[k][1], 0.0);
        let (mut shared, mut four) = (Shared::EMPTY, [const { Block::EMPTY }; FOUR]);
        set(&mut shared.middle, 0, (0.5 * (place(0) + place(3))).into());
        shared.along_m[0] = (place(3) - place(0)).length() as f32 / 3.0;
        for (k, block) in four.iter_mut().enumerate() {
            set(&mut block.world, 0, place(k).into());
            block.openness = [1.0; WIDE];
        }
        contact(Level::best(), &[shared], &mut four, &car);
        core::array::from_fn(|k| four[k].openness[0])
    }

    #[test]
    fn ground_is_darker_from_pixel_to_pixel_towards_a_car() {
        let open = openness(&[[2.9, 0.0], [2.7, 0.0], [2.5, 0.0], [2.3, 0.0]]);
        assert!(open.windows(2).all(|pair| pair[0] > pair[1] + 0.01), "{open:?}");
        assert!((openness(&[[0.0, 0.0]; FOUR])[0] - 0.15).abs() < 1e-6);
        // A wall takes half the sky of the ground at its foot.
        assert!((openness(&[[0.0, 0.901]; FOUR])[0] - 0.5).abs() < 1e-2);
        assert_eq!(openness(&[[0.0, 2.9], [0.0, 3.0], [4.2, 0.0], [-4.2, 0.0]]), [1.0; FOUR]);
        // Of a wide four, only the end is near.
        let open = openness(&[[12.0, 0.0], [9.0, 0.0], [6.0, 0.0], [2.4, 0.0]]);
        assert!(open[2] == 1.0 && open[3] < 0.7, "{open:?}");
    }
}
