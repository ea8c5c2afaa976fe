//! The weather of a trajectory: the preset, the season, and CARLA's fourteen numbers.

use super::columns::Trajectories;
use crate::tables::column::columns;
use crate::tables::{Column, DatasetItem};
use cosfly_domain::Weather;

columns! { Trajectories::WEATHER of DatasetItem;
    /// CARLA's preset on which the numbers are based.
    weather_preset: String = |item, _| item.record.weather.name.clone();
    /// Season of trees and lawns in the pictures, such as `summer`.
    season: String = |item, _| item.record.season.name().into();
}

/// One of CARLA's weather numbers, as in tables, logs and cards.
pub struct WeatherNumber {
    /// CARLA's name, such as `cloudiness`.
    pub name: &'static str,
    /// Column `weather_<name>`.
    pub column: Column<DatasetItem, f64>,
    /// Function from a weather to the number.
    pub of: fn(&Weather) -> f64,
}

macro_rules! numbers {
    ($($name:ident [$unit:literal] $doc:literal;)*) => {
        /// All of CARLA's weather numbers, in the order of CARLA's documentation.
        pub static WEATHER_NUMBERS: [WeatherNumber; 14] = [$(WeatherNumber {
            name: stringify!($name),
            column: Column {
                name: concat!("weather_", stringify!($name)),
                unit: Some($unit),
                doc: $doc,
                cell: |item, _| item.record.weather.$name,
            },
            of: |weather| weather.$name,
        }),*];
    };
}

numbers! {
    cloudiness ["percent"] "Clouds, CARLA's number, 0..100.";
    precipitation ["percent"] "Rain, CARLA's number, 0..100.";
    precipitation_deposits ["percent"] "Puddles, CARLA's number, 0..100.";
    wind_intensity ["percent"] "Wind, CARLA's number, 0..100.";
    sun_azimuth_angle ["degrees"] "Direction towards the sun, measured as yaw: 0 at +x, positive towards y.";
    sun_altitude_angle ["degrees"] "Height of the sun, CARLA's number, -90..90; negative: night.";
    fog_density ["percent"] "Fog, CARLA's number, 0..100.";
    fog_distance ["m"] "Distance from which on there is fog, CARLA's number.";
    fog_falloff ["1/m"] "Rate at which fog thins out with height, CARLA's number.";
    wetness ["percent"] "Wetness of surfaces, CARLA's number, 0..100.";
    scattering_intensity ["1"] "Strength of light scattered by fog, CARLA's number.";
    mie_scattering_scale ["1"] "Scattering by haze, CARLA's number.";
    rayleigh_scattering_scale ["1"] "Scattering by air, CARLA's number.";
    dust_storm ["percent"] "Dust, CARLA's number, 0..100.";
}
