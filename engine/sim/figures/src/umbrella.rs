//! Umbrellas of people on foot: held in the right hand, above the head.

use crate::clothes::Region;
use crate::figure::{FigurePart, ring};
use cosfly_frames::Seed;

/// Colours of umbrellas, linear RGB; half of all are black.
const COLOURS: [[f32; 3]; 8] = [
    [0.012, 0.012, 0.014],
    [0.016, 0.016, 0.018],
    [0.014, 0.013, 0.013],
    [0.012, 0.014, 0.016],
    [0.020, 0.040, 0.110],
    [0.330, 0.030, 0.035],
    [0.060, 0.160, 0.120],
    [0.420, 0.360, 0.240],
];

/// Share of the people who carry one in the rain.
const SHARE: f64 = 0.7;

/// Whether somebody with this seed opens an umbrella when it rains.
pub fn has_umbrella(clothes_seed: &Seed) -> bool {
    clothes_seed.stream("umbrella").chance(SHARE)
}

/// The colour of somebody's umbrella, linear RGB.
pub fn umbrella_colour(clothes_seed: &Seed) -> [f32; 3] {
    COLOURS[clothes_seed.stream("umbrella colour").index(COLOURS.len())]
}

/// Stick and canopy, in body heights.
pub(crate) fn parts() -> [FigurePart; 3] {
    let part = |low, high| FigurePart { low, high, region: Region::Umbrella };
    let shoulder = ring(0.05, 0.045, 1.185, 0.21, 0.21);
    [
        part(ring(0.15, 0.11, 0.64, 0.008, 0.008), ring(0.05, 0.045, 1.19, 0.007, 0.007)),
        part(ring(0.05, 0.045, 1.10, 0.30, 0.30), shoulder),
        part(shoulder, ring(0.05, 0.045, 1.235, 0.02, 0.02)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BodyShape, Walker, walker_triangles};
    use cosfly_frames::{DVec3, TargetState};

    #[test]
    fn an_umbrella_is_above_the_head_and_within_the_bounds_of_everybody() {
        for number in 0..200 {
            let clothes_seed = Seed([4; 32]).child("person", number);
            let state = TargetState { feet_in_world: DVec3::ZERO, heading_rad: 0.1 * number as f64, speed_mps: 1.2 };
            let height_m = 1.0 + 0.005 * number as f64;
            let body = BodyShape::Person;
            let dry =
                Walker { state, height_m, radius_m: 0.3, clothes_seed, gait_phase_rad: 0.3, body, umbrella: false };
            let wet = Walker { umbrella: true, ..dry };
            let (low, high) = wet.bounds_in_world();
            let corners: Vec<DVec3> = walker_triangles(&wet).into_iter().flatten().collect();
            assert!(corners.iter().all(|corner| corner.cmpge(low).all() && corner.cmple(high).all()), "{number}");
            let top =
                |walker: &Walker| walker_triangles(walker).into_iter().flatten().map(|at| at.z).fold(0.0, f64::max);
            assert!(top(&wet) > top(&dry) + 0.1 * height_m);
        }
    }
}
