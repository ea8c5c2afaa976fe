//! [`Weather`]: CARLA's 14 numbers.

use serde::{Deserialize, Serialize};

/// CARLA's `WeatherParameters` (0.9.16), in CARLA's units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are CARLA's own and say what they are")]
pub struct Weather {
    /// Preset it came from.
    pub name: String,
    pub cloudiness: f64,
    pub precipitation: f64,
    pub precipitation_deposits: f64,
    pub wind_intensity: f64,
    pub sun_azimuth_angle: f64,
    pub sun_altitude_angle: f64,
    pub fog_density: f64,
    pub fog_distance: f64,
    pub fog_falloff: f64,
    pub wetness: f64,
    pub scattering_intensity: f64,
    pub mie_scattering_scale: f64,
    pub rayleigh_scattering_scale: f64,
    pub dust_storm: f64,
}

impl Weather {
    /// The 14 numbers in the order of CARLA's documentation.
    pub fn numbers_mut(&mut self) -> [&mut f64; 14] {
        [
            &mut self.cloudiness,
            &mut self.precipitation,
            &mut self.precipitation_deposits,
            &mut self.wind_intensity,
            &mut self.sun_azimuth_angle,
            &mut self.sun_altitude_angle,
            &mut self.fog_density,
            &mut self.fog_distance,
            &mut self.fog_falloff,
            &mut self.wetness,
            &mut self.scattering_intensity,
            &mut self.mie_scattering_scale,
            &mut self.rayleigh_scattering_scale,
            &mut self.dust_storm,
        ]
    }
}
