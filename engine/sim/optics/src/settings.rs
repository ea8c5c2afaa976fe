//! The table `optics` of a recipe: a named camera, and what single keys change of it.

use cosfly_domain::{Noise, Optics};
use cosfly_frames::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Named cameras.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum OpticsPreset {
    /// Cameras of small drones: blur, sharpening, tone, exposure, white balance and noise are drawn per walk.
    #[default]
    Drone,
    /// A soft video camera, the same in every flight: a blur of 0.7 pixels, no noise.
    Soft,
    /// A pinhole: no blur, no noise, no glow.
    Ideal,
}

/// Lens, sensor and image processor; of colours in the full look. A key that is left out is as `preset` says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OpticsConfig {
    /// Named camera that gives what the other keys leave out.
    pub preset: OpticsPreset,
    /// Standard deviation of the blur of lens and sensor, pixels; 0: none. `drone` draws 0.15 to 0.45.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1.2))]
    pub point_spread_px: Option<f64>,
    /// Strength of the image processor's sharpening; 0: none. `drone` draws 0.1 to 0.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub sharpening: Option<f64>,
    /// Steepness of the image processor's tone curve; 0: none. `drone` draws 0 to 0.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub contrast: Option<f64>,
    /// Exposure beyond the one that suits the weather, in stops: 1 doubles the light. `drone` draws -0.25 to 0.25.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -4, max = 4))]
    pub exposure_ev: Option<f64>,
    /// Colour temperature that is rendered as white, kelvin; below 6500 pictures are bluer, above they are redder. `drone` draws
    /// 6000 to 7000.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2500, max = 10000))]
    pub white_balance_k: Option<f64>,
    /// Strength of the glow around bright lamps at night; 0: none. `drone` and `soft` have 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 2))]
    pub bloom: Option<f64>,
}

/// Ranges from which a walk's camera is drawn.
struct Ranges {
    point_spread_px: [f64; 2],
    sharpening: [f64; 2],
    contrast: [f64; 2],
    exposure_ev: [f64; 2],
    white_balance_k: [f64; 2],
    bloom: f64,
    /// In daylight, steps of 8-bit colour.
    gaussian: [f64; 2],
    shot: [f64; 2],
}

const IDEAL: Ranges = Ranges {
    point_spread_px: [0.0; 2],
    sharpening: [0.0; 2],
    contrast: [0.0; 2],
    exposure_ev: [0.0; 2],
    white_balance_k: [6500.0; 2],
    bloom: 0.0,
    gaussian: [0.0; 2],
    shot: [0.0; 2],
};
const SOFT: Ranges = Ranges { point_spread_px: [0.7; 2], bloom: 1.0, ..IDEAL };
const DRONE: Ranges = Ranges {
    point_spread_px: [0.15, 0.45],
    sharpening: [0.1, 0.5],
    contrast: [0.0, 0.5],
    exposure_ev: [-0.25, 0.25],
    white_balance_k: [6000.0, 7000.0],
    bloom: 1.0,
    gaussian: [0.5, 1.5],
    shot: [1.0, 3.0],
};

impl OpticsPreset {
    fn ranges(self) -> &'static Ranges {
        match self {
            Self::Drone => &DRONE,
            Self::Soft => &SOFT,
            Self::Ideal => &IDEAL,
        }
    }
}

impl OpticsConfig {
    /// The numbers of all flights behind one walk.
    pub fn draw(&self, walk_seed: &Seed) -> Optics {
        let ranges = self.preset.ranges();
        let of = |given: Option<f64>, purpose: &str, [low, high]: [f64; 2]| {
            // Hundredths: readable in tables, and exact in every encoding.
            given.unwrap_or_else(|| (walk_seed.stream(purpose).uniform(low, high) * 100.0).round() / 100.0)
        };
        Optics {
            point_spread_px: of(self.point_spread_px, "point-spread", ranges.point_spread_px),
            sharpening: of(self.sharpening, "sharpening", ranges.sharpening),
            contrast: of(self.contrast, "contrast", ranges.contrast),
            exposure_ev: of(self.exposure_ev, "exposure", ranges.exposure_ev),
            white_balance_k: of(self.white_balance_k, "white-balance", ranges.white_balance_k).round(),
            bloom: self.bloom.unwrap_or(ranges.bloom),
        }
    }

    /// The sensor's noise on all flights behind one walk under a sun this high, degrees: the darker, the higher the gain.
    pub fn draw_noise(&self, walk_seed: &Seed, sun_altitude_deg: f64) -> Noise {
        let ranges = self.preset.ranges();
        let gain = 1.0 + 1.5 * ((20.0 - sun_altitude_deg) / 25.0).clamp(0.0, 1.0);
        let drawn = |purpose: &str, [low, high]: [f64; 2]| {
            (walk_seed.stream(purpose).uniform(low, high) * gain * 100.0).round() / 100.0
        };
        Noise { gaussian: drawn("read-noise", ranges.gaussian), shot: drawn("shot-noise", ranges.shot) }
    }
}

/// The camera of pictures that no recipe describes: each number is the middle of the range of [`OpticsPreset::Drone`].
pub fn of_mean_drone() -> Optics {
    let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
    Optics {
        point_spread_px: middle(DRONE.point_spread_px),
        sharpening: middle(DRONE.sharpening),
        contrast: middle(DRONE.contrast),
        exposure_ev: middle(DRONE.exposure_ev),
        white_balance_k: middle(DRONE.white_balance_k),
        bloom: DRONE.bloom,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_fills_what_the_keys_leave_out() {
        let seeds = (0..100).map(|i| Seed([1; 32]).child("walk", i));
        let drone = OpticsConfig { exposure_ev: Some(1.0), ..OpticsConfig::default() };
        let drawn: Vec<Optics> = seeds.clone().map(|seed| drone.draw(&seed)).collect();
        assert!(drawn.iter().all(|it| (0.15..=0.45).contains(&it.point_spread_px) && it.exposure_ev == 1.0));
        assert!(drawn.iter().any(|it| it.point_spread_px < 0.2) && drawn.iter().any(|it| it.point_spread_px > 0.4));
        for seed in seeds {
            let of = |preset| OpticsConfig { preset, ..OpticsConfig::default() };
            assert_eq!(of(OpticsPreset::Ideal).draw(&seed), Optics::IDEAL);
            assert!(of(OpticsPreset::Ideal).draw_noise(&seed, 45.0).is_none());
            assert!(of(OpticsPreset::Soft).draw_noise(&seed, -90.0).is_none());
            assert_eq!(of(OpticsPreset::Soft).draw(&seed).point_spread_px, 0.7);
        }
    }

    #[test]
    fn noise_grows_with_darkness() {
        let (seed, camera) = (Seed([7; 32]), OpticsConfig::default());
        let at = |altitude_deg: f64| camera.draw_noise(&seed, altitude_deg).gaussian;
        assert!(at(45.0) == at(90.0) && at(45.0) < at(10.0) && at(10.0) < at(-5.0) && at(-5.0) == at(-90.0));
        assert!((at(-90.0) / at(90.0) - 2.5).abs() < 0.05);
    }
}
