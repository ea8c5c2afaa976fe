//! CARLA 0.9.16's weather presets, all 22.

use cosfly_domain::Weather;

/// Name, cloudiness, precipitation, deposits, wind, sun altitude, fog density, fog distance, fog falloff, wetness, dust.
type Row = (&'static str, [f64; 10]);

const NEAR: f64 = 0.75;

const ROWS: [Row; 22] = [
    ("ClearNoon", [5.0, 0.0, 0.0, 10.0, 45.0, 2.0, NEAR, 0.1, 0.0, 0.0]),
    ("CloudyNoon", [60.0, 0.0, 0.0, 10.0, 45.0, 3.0, NEAR, 0.1, 0.0, 0.0]),
    ("WetNoon", [5.0, 0.0, 50.0, 10.0, 45.0, 3.0, NEAR, 0.1, 0.0, 0.0]),
    ("WetCloudyNoon", [60.0, 0.0, 50.0, 10.0, 45.0, 3.0, NEAR, 0.1, 0.0, 0.0]),
    ("SoftRainNoon", [20.0, 30.0, 50.0, 30.0, 45.0, 3.0, NEAR, 0.1, 0.0, 0.0]),
    ("MidRainyNoon", [60.0, 60.0, 60.0, 60.0, 45.0, 3.0, NEAR, 0.1, 0.0, 0.0]),
    ("HardRainNoon", [100.0, 100.0, 90.0, 100.0, 45.0, 7.0, NEAR, 0.1, 0.0, 0.0]),
    ("ClearSunset", [5.0, 0.0, 0.0, 10.0, 15.0, 2.0, NEAR, 0.1, 0.0, 0.0]),
    ("CloudySunset", [60.0, 0.0, 0.0, 10.0, 15.0, 3.0, NEAR, 0.1, 0.0, 0.0]),
    ("WetSunset", [5.0, 0.0, 50.0, 10.0, 15.0, 2.0, NEAR, 0.1, 0.0, 0.0]),
    ("WetCloudySunset", [60.0, 0.0, 50.0, 10.0, 15.0, 2.0, NEAR, 0.1, 0.0, 0.0]),
    ("SoftRainSunset", [20.0, 30.0, 50.0, 30.0, 15.0, 2.0, NEAR, 0.1, 0.0, 0.0]),
    ("MidRainSunset", [60.0, 60.0, 60.0, 60.0, 15.0, 3.0, NEAR, 0.1, 0.0, 0.0]),
    ("HardRainSunset", [100.0, 100.0, 90.0, 100.0, 15.0, 7.0, NEAR, 0.1, 0.0, 0.0]),
    ("ClearNight", [5.0, 0.0, 0.0, 10.0, -90.0, 60.0, 75.0, 1.0, 0.0, 0.0]),
    ("CloudyNight", [60.0, 0.0, 0.0, 10.0, -90.0, 60.0, NEAR, 0.1, 0.0, 0.0]),
    ("WetNight", [5.0, 0.0, 50.0, 10.0, -90.0, 60.0, 75.0, 1.0, 60.0, 0.0]),
    ("WetCloudyNight", [60.0, 0.0, 50.0, 10.0, -90.0, 60.0, NEAR, 0.1, 60.0, 0.0]),
    ("SoftRainNight", [60.0, 30.0, 50.0, 30.0, -90.0, 60.0, NEAR, 0.1, 60.0, 0.0]),
    ("MidRainyNight", [80.0, 60.0, 60.0, 60.0, -90.0, 60.0, NEAR, 0.1, 80.0, 0.0]),
    ("HardRainNight", [100.0, 100.0, 90.0, 100.0, -90.0, 100.0, NEAR, 0.1, 100.0, 0.0]),
    ("DustStorm", [100.0, 0.0, 0.0, 100.0, 45.0, 2.0, NEAR, 0.1, 0.0, 100.0]),
];

const fn names() -> [&'static str; 22] {
    let mut names = [""; 22];
    let mut i = 0;
    while i < 22 {
        names[i] = ROWS[i].0;
        i += 1;
    }
    names
}

impl Weather {
    /// Names of all presets, in CARLA's order.
    pub const PRESETS: [&'static str; 22] = names();

    /// A preset by its name. Its `sun_azimuth_angle` is CARLA's -1 ("keep"); the renderer draws it.
    pub fn preset(name: &str) -> Option<Self> {
        ROWS.iter().find(|row| row.0 == name).map(from_row)
    }
}

/// The preset that is used where none is asked for.
pub fn clear_noon() -> Weather {
    from_row(&ROWS[0])
}

fn from_row(&(name, numbers): &Row) -> Weather {
    let [cloudiness, rain, deposits, wind, altitude, fog, fog_distance, fog_falloff, wetness, dust] = numbers;
    Weather {
        name: name.to_owned(),
        cloudiness,
        precipitation: rain,
        precipitation_deposits: deposits,
        wind_intensity: wind,
        sun_azimuth_angle: -1.0,
        sun_altitude_angle: altitude,
        fog_density: fog,
        fog_distance,
        fog_falloff,
        wetness,
        scattering_intensity: 1.0,
        mie_scattering_scale: 0.03,
        rayleigh_scattering_scale: 0.0331,
        dust_storm: dust,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_found_by_its_own_name_only() {
        for name in Weather::PRESETS {
            assert_eq!(Weather::preset(name).expect("listed").name, name);
        }
        assert!(Weather::preset("clearnoon").is_none() && Weather::preset("MidRainNoon").is_none());
    }

    #[test]
    fn presets_carry_carlas_numbers() {
        let night = Weather::preset("WetNight").expect("listed");
        let expected = (60.0, 75.0, 1.0, 50.0, -90.0);
        let read = (night.fog_density, night.fog_distance, night.fog_falloff);
        assert_eq!((read.0, read.1, read.2, night.precipitation_deposits, night.sun_altitude_angle), expected);
        assert_eq!(Weather::preset("DustStorm").expect("listed").dust_storm, 100.0);
    }
}
