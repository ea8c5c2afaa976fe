//! Umbrellas of people on foot: who opens one in which rain, and how it looks, held in the right hand above the head.

use crate::frustum::{FigurePart, ring};
use crate::region::Region;
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

/// Share of the people on foot who open one in steady rain.
const SHARE: f64 = 0.75;
/// Precipitation from which on rain is steady, as CARLA counts it; below, the share is in proportion.
const STEADY: f64 = 60.0;

/// Whether somebody with these looks opens an umbrella. Whoever opens one in light rain does so in heavier rain.
pub fn opens(precipitation: f64, looks: &Seed) -> bool {
    looks.stream("umbrella").unit() < SHARE * (precipitation / STEADY).min(1.0)
}

/// The colour of somebody's umbrella, linear RGB.
pub fn colour(looks: &Seed) -> [f32; 3] {
    COLOURS[looks.stream("umbrella colour").index(COLOURS.len())]
}

/// Stick and canopy, in body heights.
pub fn parts() -> [FigurePart; 3] {
    let part = |low, high| FigurePart { low, high, region: Region::Umbrella };
    let shoulder = ring(0.05, 0.045, 1.185, 0.21, 0.21);
    [
        part(ring(0.15, 0.11, 0.60, 0.008, 0.008), ring(0.05, 0.045, 1.19, 0.007, 0.007)),
        part(ring(0.05, 0.045, 1.10, 0.30, 0.30), shoulder),
        part(shoulder, ring(0.05, 0.045, 1.235, 0.02, 0.02)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BodyFigure, BodyShape, Posture, figure_triangles};
    use cosfly_domain::BodyKind;
    use cosfly_frames::{DVec3, TargetState};

    fn looks(number: u64) -> Seed {
        Seed([4; 32]).child("person", number)
    }

    #[test]
    fn shares_follow_the_rain_and_nobody_closes_an_umbrella_when_it_rains_more() {
        let open = |rain: f64| (0..1000).map(|number| opens(rain, &looks(number))).collect::<Vec<bool>>();
        let count = |rain: f64| open(rain).into_iter().filter(|open| *open).count() as f64 / 1000.0;
        assert_eq!(count(0.0), 0.0);
        assert!((count(30.0) - 0.375).abs() < 0.05 && (count(60.0) - 0.75).abs() < 0.05);
        assert_eq!(count(60.0), count(100.0));
        assert!(open(30.0).into_iter().zip(open(60.0)).all(|(light, heavy)| heavy || !light));
    }

    #[test]
    fn riders_and_vehicles_have_none() {
        let bicycle = BodyShape::of(BodyKind::Bicycle, DVec3::new(1.8, 0.65, 1.75));
        assert!((0..100).all(|number| !bicycle.in_rain(100.0, &looks(number)).has_umbrella()));
    }

    #[test]
    fn an_umbrella_is_above_the_head_and_within_the_bounds_of_everybody() {
        for number in 0..200 {
            let state = TargetState { feet_in_world: DVec3::ZERO, heading_rad: 0.1 * number as f64, speed_mps: 1.2 };
            let (height_m, clothes_seed) = (1.0 + 0.005 * number as f64, looks(number));
            let body = BodyShape::default();
            let dry = BodyFigure { state, height_m, radius_m: 0.3, clothes_seed, gait_phase_rad: 0.3, body };
            let wet = BodyFigure { body: BodyShape::Person { umbrella: true, posture: Posture::Upright }, ..dry };
            let (low, high) = wet.bounds_in_world();
            let corners: Vec<DVec3> = figure_triangles(&wet).into_iter().flatten().collect();
            assert!(corners.iter().all(|corner| corner.cmpge(low).all() && corner.cmple(high).all()), "{number}");
            let top =
                |figure: &BodyFigure| figure_triangles(figure).into_iter().flatten().map(|at| at.z).fold(0.0, f64::max);
            assert!(top(&wet) > top(&dry) + 0.1 * height_m);
        }
    }
}
