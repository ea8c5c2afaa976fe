//! Lamps of vehicles at night: white light on what is ahead, red light on the ground behind.

use super::contact::FOUR_SIZES;
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, real, simd_kernel};
use cosfly_materials::lanes::{Block, Shared, WIDE, get, groups, set};
use cosfly_materials::light::Light;
use cosfly_materials::pattern::{most, share, smoothstep};
use cosfly_materials::vector::Vec3;

/// Distance that lamps of full strength reach ahead of the vehicle and behind it, metres.
const AHEAD_M: f32 = 16.0;
const BEHIND_M: f32 = 2.0;
/// Half the width of the light at the vehicle, and how much wider each metre ahead is.
const HALF_WIDTH_M: f32 = 0.9;
const WIDER: f32 = 0.2;
/// Height of the lamps, metres.
const LAMPS_M: f32 = 0.65;
/// Light of the lamps where it is strongest, linear RGB.
const WHITE: Vec3 = Vec3::new(0.46, 0.43, 0.36);
const RED: Vec3 = Vec3::new(0.055, 0.0028, 0.0021);

/// The lamps of a vehicle.
#[derive(Clone, Copy)]
struct Lamps {
    /// Strength, and reach as a share of that of a car.
    strength: f32,
    scale: f32,
}

impl Lamps {
    fn of(figure: &BodyFigure) -> Option<Self> {
        let BodyShape::Vehicle { kind, .. } = figure.body else { return None };
        if figure.is_parked() {
            return None;
        }
        kind.row().lamps.map(|[strength, scale]| Self { strength, scale })
    }
}

/// How far the lamps of somebody light the ground beyond the body's upright box: towards smaller and larger x and y, metres.
pub(crate) fn reach_m(figure: &BodyFigure) -> [DVec2; 2] {
    let Some(lamps) = Lamps::of(figure) else { return [DVec2::ZERO; 2] };
    let (sin, cos) = real::sin_cos(figure.state.heading_rad);
    let ahead = DVec2::new(cos, sin) * f64::from(AHEAD_M * lamps.scale);
    let aside_m = f64::from(HALF_WIDTH_M + WIDER * AHEAD_M).max(f64::from(BEHIND_M));
    [(-ahead).max(DVec2::ZERO) + aside_m, ahead.max(DVec2::ZERO) + aside_m]
}

/// Adds the light of somebody's lamps to what flat surfaces send; whether there are lamps.
pub(super) fn shine(level: Level, shared: &[Shared], blocks: &mut [Block], figure: &BodyFigure, light: &Light) -> bool {
    let (Some(lamps), BodyShape::Vehicle { size_m, .. }) = (Lamps::of(figure), &figure.body) else { return false };
    let (sin, cos) = real::sin_cos(figure.state.heading_rad);
    let beam = Beam {
        feet: figure.state.feet_in_world.into(),
        along: [cos as f32, sin as f32],
        half_length_m: 0.5 * size_m.x as f32,
        per_scale: 1.0 / lamps.scale,
        strength: lamps.strength * light.night,
    };
    shine_on(level, shared, blocks, &beam);
    true
}

/// Lamps in place.
#[derive(Clone, Copy)]
struct Beam {
    feet: Vec3,
    along: [f32; 2],
    half_length_m: f32,
    per_scale: f32,
    strength: f32,
}

impl Beam {
    /// Place of a point: ahead of the middle, aside and above the feet, metres.
    #[inline(always)]
    fn place(&self, point: Vec3) -> [f32; 3] {
        let (away, [cos, sin]) = (point - self.feet, self.along);
        [away.x * cos + away.y * sin, away.y * cos - away.x * sin, away.z]
    }

    /// Light on a surface with this normal at a place.
    #[inline(always)]
    fn light(&self, [x, y, up_m]: [f32; 3], normal: Vec3) -> Vec3 {
        let ([cos, sin], half_length_m, strength) = (self.along, self.half_length_m, self.strength);
        let ahead_m = (x - half_length_m) * self.per_scale;
        let width_m = HALF_WIDTH_M + WIDER * most(ahead_m, 0.0);
        let inside = 1.0 - smoothstep(0.1 * width_m, width_m, y.abs());
        let near = smoothstep(0.2, 3.5, ahead_m) * (1.0 - smoothstep(0.3 * AHEAD_M, AHEAD_M, ahead_m));
        let low = 1.0 - smoothstep(LAMPS_M, 2.0 * LAMPS_M, up_m);
        // Ground is lit at a flat angle; what stands upright faces the lamps.
        let towards = normal.x * cos + normal.y * sin;
        let facing = share(0.9 * normal.z + most(-towards, 0.0));
        let white = WHITE * (strength * inside * near * low * facing);
        let behind_m = -x - half_length_m;
        let aside_m = most(y.abs() - 0.5 * HALF_WIDTH_M, 0.0);
        let gone = (behind_m * behind_m + aside_m * aside_m + up_m * up_m) * (1.0 / (BEHIND_M * BEHIND_M));
        // The bumper shades the ground below it.
        let glow = share(1.0 - gone) * smoothstep(-0.1, 0.7, behind_m);
        white + RED * (strength * glow * glow * share(normal.z))
    }
}

simd_kernel! {
    fn shine_on(shared: &[Shared], blocks: &mut [Block], beam: &Beam) {
        let beam = *beam;
        let (behind_m, ahead_m) = (beam.half_length_m + BEHIND_M, beam.half_length_m + AHEAD_M / beam.per_scale);
        let aside_m = HALF_WIDTH_M + WIDER * AHEAD_M;
        for (shared, four) in groups(shared, blocks) {
            let mut is_near = 0u32;
            for k in 0..WIDE {
                let [x, y, _] = beam.place(get(&shared.middle, k));
                let margin_m = FOUR_SIZES * (shared.along_m[k] + shared.up_m[k]);
                let is_along = (x > -behind_m - margin_m) & (x < ahead_m + margin_m);
                is_near |= u32::from(is_along & (y.abs() < aside_m + margin_m));
            }
            if is_near == 0 {
                continue;
            }
            for block in four {
                for k in 0..WIDE {
                    let light = beam.light(beam.place(get(&block.world, k)), get(&block.normal, k));
                    let sent = get(&block.emission, k) + get(&block.albedo, k) * light;
                    set(&mut block.emission, k, sent);
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
    use cosfly_materials::lanes::FOUR;

    fn car(heading_rad: f64, kind: BodyKind) -> BodyFigure {
        BodyFigure {
            state: TargetState { feet_in_world: DVec3::new(30.0, -8.0, 1.0), heading_rad, speed_mps: 5.0 },
            height_m: 1.5,
            radius_m: 1.0,
            clothes_seed: Seed([3; 32]),
            gait_phase_rad: 0.0,
            body: BodyShape::Vehicle { kind, size_m: DVec3::new(4.4, 1.8, 1.5) },
        }
    }

    /// Light that level ground gets at places so far ahead and aside of the feet.
    fn light_at(figure: &BodyFigure, weather: &str, places: &[[f64; 2]]) -> Vec<Vec3> {
        let light = Light::new(&cosfly_materials::presets::preset(weather).expect("a preset"));
        let (sin, cos) = real::sin_cos(figure.state.heading_rad);
        let lit = |&[ahead, aside]: &[f64; 2]| {
            let (mut shared, mut four) = (Shared::EMPTY, [const { Block::EMPTY }; FOUR]);
            let place =
                figure.state.feet_in_world + DVec3::new(ahead * cos - aside * sin, ahead * sin + aside * cos, 0.0);
            set(&mut shared.middle, 0, place.into());
            set(&mut four[0].world, 0, place.into());
            set(&mut four[0].normal, 0, Vec3::new(0.0, 0.0, 1.0));
            set(&mut four[0].albedo, 0, Vec3::splat(1.0));
            shine(Level::best(), &[shared], &mut four, figure, &light);
            get(&four[0].emission, 0)
        };
        places.iter().map(lit).collect()
    }

    #[test]
    fn lamps_light_the_ground_ahead_and_redden_it_behind_at_night_only() {
        let places = [[8.0, 0.0], [8.0, 3.5], [-3.0, 0.5], [-8.0, 0.0], [25.0, 0.0]];
        for heading_rad in [0.0, 1.1, -2.4] {
            let at = light_at(&car(heading_rad, BodyKind::Car), "ClearNight", &places);
            assert!(at[0].x > 0.2 && at[0].z > 0.1, "ahead: {:?}", at[0]);
            assert!(at[2].x > 0.02 && at[2].z < 0.1 * at[2].x, "behind: {:?}", at[2]);
            // Less than a tenth of what lamps ahead send, and none below the bumper.
            let behind =
                light_at(&car(heading_rad, BodyKind::Car), "ClearNight", &[[-2.3, 0.0], [-2.9, 0.0], [-3.3, 0.0]]);
            assert!(behind.iter().all(|lit| lit.x < 0.045) && behind[0].x < 0.004, "behind: {behind:?}");
            for (place, dark) in [1, 3, 4].map(|k| (places[k], at[k])) {
                assert!(dark.x < 1e-6, "{place:?}: {dark:?}");
            }
            let at = light_at(&car(heading_rad, BodyKind::Bicycle), "ClearNight", &places[..1]);
            assert!(at[0].x < 0.1, "a bicycle's lamp is weak: {:?}", at[0]);
            let mut parked = car(heading_rad, BodyKind::Car);
            parked.state.speed_mps = 0.0;
            let [by_day, drone] = [BodyKind::Car, BodyKind::Drone].map(|kind| car(heading_rad, kind));
            for (figure, weather) in [(by_day, "ClearNoon"), (drone, "ClearNight"), (parked, "ClearNight")] {
                let at = light_at(&figure, weather, &places);
                assert!(at.iter().all(|lit| *lit == Vec3::splat(0.0)), "{:?} {weather}", figure.body);
            }
        }
    }

    #[test]
    fn lamps_light_nothing_beyond_their_reach() {
        for step in 0..12 {
            let figure = car(0.55 * f64::from(step), BodyKind::Truck);
            let (low, high) = figure.bounds_in_world();
            let [before, beyond] = reach_m(&figure);
            let (low, high) = (low.truncate() - before, high.truncate() + beyond);
            let (sin, cos) = real::sin_cos(figure.state.heading_rad);
            let places: Vec<[f64; 2]> =
                (0..60 * 30).map(|k| [f64::from(k % 60) - 30.0, f64::from(k / 60) - 15.0]).collect();
            for ([ahead, aside], lit) in places.iter().zip(light_at(&figure, "ClearNight", &places)) {
                let place = figure.state.feet_in_world.truncate()
                    + DVec2::new(ahead * cos - aside * sin, ahead * sin + aside * cos);
                let is_within = place.cmpge(low).all() && place.cmple(high).all();
                assert!(is_within || lit == Vec3::splat(0.0), "{ahead} {aside}: {lit:?}");
            }
        }
    }
}
