//! Ranges of CARLA's 14 weather numbers.

use cosfly_domain::Weather;
use cosfly_frames::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Ranges to draw weather numbers from, on top of the drawn preset. Numbers without a range keep the preset's value (the
/// sun's azimuth, of which presets say nothing, is any whole degree).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WeatherRanges {
    /// Clouds, percent: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cloudiness: Option<[f64; 2]>,
    /// Rain, percent: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precipitation: Option<[f64; 2]>,
    /// Puddles, percent: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precipitation_deposits: Option<[f64; 2]>,
    /// Wind, percent: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind_intensity: Option<[f64; 2]>,
    /// Direction towards the sun, measured as yaw, degrees: lowest and highest value to draw, 0 to 360; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun_azimuth_angle: Option<[f64; 2]>,
    /// Height of the sun, degrees; negative: night: lowest and highest value to draw, -90 to 90; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun_altitude_angle: Option<[f64; 2]>,
    /// Fog, percent: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fog_density: Option<[f64; 2]>,
    /// Distance at which fog begins, metres: lowest and highest value to draw, 0 to 10000; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fog_distance: Option<[f64; 2]>,
    /// Falloff of fog with height: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fog_falloff: Option<[f64; 2]>,
    /// Wet surfaces, percent: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wetness: Option<[f64; 2]>,
    /// Strength of light scattered by fog: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scattering_intensity: Option<[f64; 2]>,
    /// Scattering by haze: lowest and highest value to draw, 0 to 5; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mie_scattering_scale: Option<[f64; 2]>,
    /// Scattering by air: lowest and highest value to draw, 0 to 2; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rayleigh_scattering_scale: Option<[f64; 2]>,
    /// Dust, percent: lowest and highest value to draw, 0 to 100; left out: the preset's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dust_storm: Option<[f64; 2]>,
}

/// Name of a weather number, the range to draw it from, and the bounds that a range must keep to.
pub type WeatherRange = (&'static str, Option<[f64; 2]>, [f64; 2]);

impl WeatherRanges {
    /// Name, range and the bounds that it must keep to, of each number in the order of [`Weather::numbers_mut`].
    pub fn all(&self) -> [WeatherRange; 14] {
        [
            ("cloudiness", self.cloudiness, [0.0, 100.0]),
            ("precipitation", self.precipitation, [0.0, 100.0]),
            ("precipitation_deposits", self.precipitation_deposits, [0.0, 100.0]),
            ("wind_intensity", self.wind_intensity, [0.0, 100.0]),
            ("sun_azimuth_angle", self.sun_azimuth_angle, [0.0, 360.0]),
            ("sun_altitude_angle", self.sun_altitude_angle, [-90.0, 90.0]),
            ("fog_density", self.fog_density, [0.0, 100.0]),
            ("fog_distance", self.fog_distance, [0.0, 10000.0]),
            ("fog_falloff", self.fog_falloff, [0.0, 100.0]),
            ("wetness", self.wetness, [0.0, 100.0]),
            ("scattering_intensity", self.scattering_intensity, [0.0, 100.0]),
            ("mie_scattering_scale", self.mie_scattering_scale, [0.0, 5.0]),
            ("rayleigh_scattering_scale", self.rayleigh_scattering_scale, [0.0, 2.0]),
            ("dust_storm", self.dust_storm, [0.0, 100.0]),
        ]
    }

    /// Draws every number that has a range. Each has a stream of its own: another range changes no other number.
    pub fn draw(&self, weather: &mut Weather, walk_seed: &Seed) {
        for ((name, range, _), number) in self.all().into_iter().zip(weather.numbers_mut()) {
            if let Some([low, high]) = range {
                let drawn = walk_seed.stream(&format!("weather-{name}")).uniform(low, high);
                // Thousandths: readable in tables.
                *number = ((drawn * 1000.0).round() / 1000.0).clamp(low, high);
            }
        }
    }
}
