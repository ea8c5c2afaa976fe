//! Light of a frame from CARLA's weather numbers: sun or moon, sky, haze, wetness, exposure.

use super::pattern::{lerp, most, smoothstep};
use super::vector::Vec3;
use cosfly_domain::Weather;
use cosfly_frames::real;

/// Everything about light that is the same in the whole frame. Colours are linear RGB.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Towards the sun, or the moon at night; unit length, above the horizon.
    pub to_sun: Vec3,
    /// Light of the sun or moon on a surface that faces it.
    pub sun: Vec3,
    /// Sky straight up.
    pub zenith: Vec3,
    /// Sky near the horizon, and the colour that far things fade into.
    pub horizon: Vec3,
    /// Light of the whole sky on an upward face.
    pub dome: Vec3,
    /// Light from the ground on downward faces.
    pub bounce: Vec3,
    /// Share of a surface's light lost to haze per metre.
    pub haze_per_m: f32,
    /// Haze starts here, metres.
    pub haze_start_m: f32,
    /// 0 by day, 1 at night.
    pub night: f32,
    /// 0 dry, 1 soaked.
    pub wet: f32,
    /// Share of flat ground under puddles.
    pub puddles: f32,
    /// Share of the sky under clouds.
    pub clouds: f32,
    /// 0 none, 1 hard rain.
    pub rain: f32,
    /// Wind, 0..=1; slants the rain.
    pub wind: f32,
    /// Brightness of the picture.
    pub exposure: f32,
    /// Lamps and lit windows.
    pub lamp: Vec3,
}

impl Light {
    /// The light of a weather.
    pub fn new(weather: &Weather) -> Self {
        let share = |percent: f64| (percent / 100.0).clamp(0.0, 1.0) as f32;
        let altitude = weather.sun_altitude_angle.clamp(-90.0, 90.0) as f32;
        let clouds = share(weather.cloudiness);
        let rain = share(weather.precipitation);
        let dust = share(weather.dust_storm);
        let night = 1.0 - smoothstep(-8.0, 6.0, altitude);
        let low = 1.0 - smoothstep(4.0, 40.0, altitude);
        let overcast = smoothstep(0.05, 0.95, clouds).max(0.8 * dust);

        let to_sun = direction(weather.sun_azimuth_angle, if altitude > 2.0 { f64::from(altitude) } else { 52.0 });
        let air = 1.0 / to_sun.z.max(0.08);
        let through = Vec3::new(0.045, 0.12, 0.26).map(|k| libm::expf(-k * air));
        let covered = (1.0 - 1.12 * overcast).max(0.03);
        let day_sun = through * (3.7 * (1.0 + 0.5 * low) * (covered * covered.sqrt()) * smoothstep(0.0, 8.0, altitude));
        let moon = Vec3::new(0.013, 0.017, 0.026) * (1.0 - 0.9 * overcast) * night;
        let sun = day_sun * (1.0 - night) + moon;

        let clear_zenith = Vec3::new(0.16, 0.30, 0.62).lerp(Vec3::new(0.20, 0.27, 0.50), low);
        let clear_horizon = Vec3::new(0.58, 0.70, 0.88).lerp(Vec3::new(1.05, 0.62, 0.34), low);
        let grey = Vec3::new(0.62, 0.66, 0.70) * (1.0 - 0.35 * low) * (1.0 - 0.35 * rain);
        let sand = Vec3::new(0.62, 0.42, 0.22);
        let day = |clear: Vec3| clear.lerp(grey, 0.9 * overcast).lerp(sand, dust);
        let dark = Vec3::new(0.0012, 0.0017, 0.0038) + Vec3::new(0.0050, 0.0038, 0.0026) * overcast;
        let zenith = day(clear_zenith).lerp(dark, night);
        // Towns light the air above them.
        let horizon = day(clear_horizon).lerp(dark * 1.8 + Vec3::new(0.0035, 0.0026, 0.0018), night);

        // CARLA's presets use densities of 60 at night that look like clear air, so night counts for less.
        let density = share(weather.fog_density) * lerp(1.0, 0.35, night);
        let haze_per_m = 0.00035 + 0.006 * density + 0.0010 * rain * rain + 0.014 * dust;
        Self {
            to_sun,
            sun,
            zenith,
            horizon,
            dome: grey_towards(zenith.lerp(horizon, lerp(0.38, 0.28, low)), 0.45)
                * lerp(lerp(2.7, 2.0, overcast), 9.5, night),
            bounce: (sun * (0.7 * to_sun.z) + zenith) * 0.36,
            haze_per_m,
            haze_start_m: weather.fog_distance.clamp(0.0, 1000.0) as f32,
            night,
            wet: share(weather.wetness).max(0.85 * share(weather.precipitation_deposits)).max(0.7 * rain),
            puddles: 0.75 * share(weather.precipitation_deposits),
            clouds,
            rain,
            wind: share(weather.wind_intensity),
            exposure: lerp(lerp(0.60, 0.68, overcast) * (1.0 + 0.28 * low) * (1.0 + 0.25 * rain), 4.2, night),
            lamp: Vec3::new(0.46, 0.29, 0.13) * night,
        }
    }

    /// Radiance of the sky in a direction (unit length), without clouds' shapes; haze below the horizon.
    #[inline(always)]
    pub fn sky(&self, direction: Vec3) -> Vec3 {
        let up = most(direction.z, 0.0);
        let rise = 1.0 - (1.0 - up) * (1.0 - up) * (1.0 - up);
        let toward = most(direction.dot(self.to_sun), 0.0);
        let toward2 = toward * toward;
        let glow = toward2 * toward2 * toward2 * (1.0 - 0.9 * self.clouds) * (1.0 - self.night);
        self.horizon.lerp(self.zenith, rise) + self.sun * (0.10 * glow)
    }

    /// Light from the whole sky and ground on a surface with this normal, when nothing stands around.
    #[inline(always)]
    pub fn ambient(&self, normal: Vec3) -> Vec3 {
        let t = 0.5 + 0.5 * normal.z;
        self.bounce.lerp(self.dome, t)
    }
}

/// A colour less saturated by `share`.
fn grey_towards(colour: Vec3, share: f32) -> Vec3 {
    colour.lerp(Vec3::splat(colour.dot(Vec3::splat(1.0 / 3.0))), share)
}

/// Unit vector towards azimuth (x towards y) and altitude in degrees.
fn direction(azimuth_deg: f64, altitude_deg: f64) -> Vec3 {
    let (sin_azimuth, cos_azimuth) = real::sin_cos(azimuth_deg.to_radians());
    let (sin, cos) = real::sin_cos(altitude_deg.to_radians());
    Vec3::new((cos * cos_azimuth) as f32, (cos * sin_azimuth) as f32, sin as f32)
}
