//! What a recipe says about pictures: camera and weathers.

use crate::backend::BackendKind;
use crate::camera::Camera;
use crate::weather::Weather;
use cosfly_frames::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Camera and weather of rendered trajectories.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RenderConfig {
    /// What draws the pictures: `cpu` (cosfly's own renderer, the same bytes on every machine), `gpu` (a graphics card;
    /// needs a cosfly built with the feature `gpu`) or `carla` (a CARLA server; see the guide, it is driven from outside
    /// of a run).
    pub backend: BackendKind,
    /// Image width, pixels.
    #[schemars(range(min = 16, max = 7680))]
    pub width: u32,
    /// Image height, pixels.
    #[schemars(range(min = 16, max = 4320))]
    pub height: u32,
    /// Horizontal field of view, degrees.
    #[schemars(range(min = 5, max = 150))]
    pub fov_deg: f64,
    /// Names of CARLA weather presets; each trajectory draws one, and the sun's azimuth with it.
    #[schemars(length(min = 1))]
    pub weathers: Vec<String>,
}

impl Default for RenderConfig {
    fn default() -> Self {
        let weathers = ["ClearNoon", "CloudyNoon", "WetNoon", "ClearSunset", "SoftRainNoon", "CloudySunset"];
        Self {
            backend: BackendKind::Cpu,
            width: 1280,
            height: 720,
            fov_deg: 90.0,
            weathers: weathers.map(str::to_owned).to_vec(),
        }
    }
}

/// A value that the schema cannot refuse but the renderer must.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigProblem {
    /// Where in the stage's table, such as `weathers[1]`.
    pub path: String,
    /// What is wrong: a lower-case fragment.
    pub message: String,
    /// What is allowed, or the nearest valid value.
    pub hint: String,
}

impl fmt::Display for ConfigProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}): `{}`", self.message, self.hint, self.path)
    }
}

impl std::error::Error for ConfigProblem {}

impl RenderConfig {
    /// Checks every value.
    ///
    /// # Errors
    /// The first value that is out of range, or names no preset.
    pub fn validate(&self) -> Result<(), ConfigProblem> {
        let problem =
            |path: &str, message: String, hint: String| Err(ConfigProblem { path: path.into(), message, hint });
        if !(16..=7680).contains(&self.width) {
            return problem("width", format!("the width is `{}`", self.width), "16 to 7680 pixels".into());
        }
        if !(16..=4320).contains(&self.height) {
            return problem("height", format!("the height is `{}`", self.height), "16 to 4320 pixels".into());
        }
        if !(5.0..=150.0).contains(&self.fov_deg) {
            return problem("fov_deg", format!("the field of view is `{}`", self.fov_deg), "5 to 150 degrees".into());
        }
        if self.weathers.is_empty() {
            return problem("weathers", "there is no weather to draw from".into(), "name at least one preset".into());
        }
        for (index, name) in self.weathers.iter().enumerate() {
            if Weather::preset(name).is_none() {
                let path = format!("weathers[{index}]");
                let hint = format!("the presets are {}", Weather::PRESETS.join(", "));
                return problem(&path, format!("there is no weather preset `{name}`"), hint);
            }
        }
        Ok(())
    }

    /// The camera.
    pub fn camera(&self) -> Camera {
        Camera { width: self.width, height: self.height, horizontal_fov_rad: self.fov_deg.to_radians() }
    }

    /// The weather of one trajectory: a preset from the list and an azimuth of the sun, both from its seed.
    /// Names that are no preset (which [`Self::validate`] refuses) count as `ClearNoon`.
    pub fn draw_weather(&self, trajectory_seed: &Seed) -> Weather {
        let mut stream = trajectory_seed.stream("weather");
        let drawn = self.weathers.get(stream.index(self.weathers.len())).and_then(|name| Weather::preset(name));
        let mut weather = drawn.unwrap_or_else(crate::presets::clear_noon);
        // Whole degrees: readable in tables, and exact in every encoding.
        weather.sun_azimuth_angle = stream.index(360) as f64;
        weather
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_valid_and_draws_every_weather() {
        let config = RenderConfig::default();
        config.validate().expect("the default");
        let seed = Seed([1; 32]);
        for name in &config.weathers {
            assert!((0..200).any(|i| &config.draw_weather(&seed.child("t", i)).name == name), "{name}");
        }
    }

    #[test]
    fn bad_values_are_refused_with_their_path() {
        let good = RenderConfig::default();
        for (config, path) in [
            (RenderConfig { width: 0, ..good.clone() }, "width"),
            (RenderConfig { height: 9000, ..good.clone() }, "height"),
            (RenderConfig { fov_deg: f64::NAN, ..good.clone() }, "fov_deg"),
            (RenderConfig { weathers: vec![], ..good.clone() }, "weathers"),
            (RenderConfig { weathers: vec!["ClearNoon".into(), "Hail".into()], ..good.clone() }, "weathers[1]"),
        ] {
            assert_eq!(config.validate().expect_err(path).path, path);
        }
    }
}
