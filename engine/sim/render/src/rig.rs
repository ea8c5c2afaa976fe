//! The rig of a stage: films of its cameras and pairs, the settings of each, and what is wrong with them.

use crate::cameras::CameraConfig;
use crate::config::{ConfigProblem, RenderConfig};
use cosfly_domain::channels::{depth_stereo, disparity};
use cosfly_domain::{Channel, LensModel, StereoEye};
use std::collections::BTreeMap;

/// Endings of the films of a stereo pair.
const EYES: [(&str, bool); 2] = [("_left", false), ("_right", true)];
/// Channels that only pairs have.
const OF_PAIRS: [&Channel; 2] = [&depth_stereo::CHANNEL, &disparity::CHANNEL];

/// Names of the films of a camera: its own, or those of the two cameras of a pair.
fn films<'a>(name: &'a str, camera: &'a CameraConfig) -> impl Iterator<Item = String> + use<'a> {
    let endings: &[_] = if camera.base_line_m.is_some() { &EYES } else { &[("", false)] };
    endings.iter().map(move |(ending, _)| format!("{name}{ending}"))
}

/// The camera that makes a film, and which one of a pair it is.
fn behind<'a>(
    cameras: &'a BTreeMap<String, CameraConfig>,
    film: &str,
) -> Option<(&'a CameraConfig, Option<StereoEye>)> {
    cameras.iter().find_map(|(name, camera)| match camera.base_line_m {
        None => (name == film).then_some((camera, None)),
        Some(base_line_m) => {
            let ending = film.strip_prefix(name.as_str())?;
            let (_, is_right) = EYES.into_iter().find(|(known, _)| *known == ending)?;
            Some((camera, Some(StereoEye { base_line_m, is_right })))
        }
    })
}

impl RenderConfig {
    /// The settings of one film; those of the stage where there is no such film.
    pub fn of_camera(&self, film: Option<&str>) -> Self {
        let mut config = Self { cameras: BTreeMap::new(), ..self.clone() };
        let Some((camera, stereo)) = film.and_then(|film| behind(&self.cameras, film)) else { return config };
        let CameraConfig { width, height, fov_deg, gimbal, optics, lens, motion_blur, rolling_shutter, noise, .. } =
            camera.clone();
        (config.stereo, config.every) = (stereo, camera.every.unwrap_or(1));
        config.begins_ns = (camera.offset_s.unwrap_or(0.0) * 1e9).round() as u64;
        if stereo.is_none() {
            config.channels = OF_PAIRS.iter().fold(self.channels.clone(), |all, of_pairs| all.without(of_pairs));
        }
        config.width = width.unwrap_or(config.width);
        config.height = height.unwrap_or(config.height);
        config.fov_range_deg = config.fov_range_deg.filter(|_| fov_deg.is_none());
        config.fov_deg = fov_deg.unwrap_or(config.fov_deg);
        config.gimbal = gimbal.unwrap_or(config.gimbal);
        config.optics = optics.unwrap_or(config.optics);
        config.lens = lens.unwrap_or(config.lens);
        config.motion_blur = motion_blur.unwrap_or(config.motion_blur);
        config.rolling_shutter = rolling_shutter.unwrap_or(config.rolling_shutter);
        config.noise = noise.or(config.noise);
        config
    }

    /// Names of the films of one flight: cameras, or weathers where they are paired; none where there is one film.
    pub fn films(&self) -> Vec<String> {
        if self.paired_weathers {
            return self.weathers.clone();
        }
        self.cameras.iter().flat_map(|(name, camera)| films(name, camera)).collect()
    }

    /// Checks the cameras, each with its own settings.
    pub(crate) fn check_cameras(&self) -> Result<(), ConfigProblem> {
        let problem =
            |path: String, message: String, hint: &str| Err(ConfigProblem { path, message, hint: hint.into() });
        if self.paired_weathers && !self.cameras.is_empty() {
            let hint = "write one recipe for each weather, or one for each camera";
            return problem(
                "cameras".into(),
                "`cameras` and `paired_weathers` both name the films of a flight".into(),
                hint,
            );
        }
        for (name, camera) in &self.cameras {
            let is_word = name.starts_with(|first: char| first.is_ascii_lowercase())
                && name.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_')
                && name.len() <= 32;
            if !is_word {
                let hint =
                    "a camera is named by a lower-case letter, then lower-case letters, digits and `_`, 32 at most";
                return problem(format!("cameras.{name}"), format!("the name is `{name}`"), hint);
            }
            if let Some(base_line_m) = camera.base_line_m.filter(|it| !(0.001..=10.0).contains(it)) {
                let path = format!("cameras.{name}.base_line_m");
                return problem(path, format!("the base line is `{base_line_m}` m"), "0.001 to 10 metres");
            }
            if let Some(every) = camera.every.filter(|it| !(1..=1000).contains(it)) {
                let path = format!("cameras.{name}.every");
                return problem(path, format!("the camera films every `{every}`th frame"), "1 to 1000: whole frames");
            }
            if let Some(offset_s) = camera.offset_s.filter(|it| !(0.0..=1e6).contains(it)) {
                let path = format!("cameras.{name}.offset_s");
                let hint = "0 or more, and less than the time from one picture to the next";
                return problem(path, format!("the pictures are `{offset_s}` s after their frames"), hint);
            }
            let lens = camera.lens.unwrap_or(self.lens);
            if camera.fov_deg.is_some() && lens.model == LensModel::Equirectangular {
                let message = "an equirectangular picture shows 360 x 180 degrees".into();
                return problem(format!("cameras.{name}.fov_deg"), message, "leave the key out");
            }
            for film in films(name, camera) {
                if film != *name && self.cameras.contains_key(&film) {
                    let message = format!("the pair `{name}` makes a film of this name, too");
                    return problem(format!("cameras.{film}"), message, "give one of the two another name");
                }
                self.of_camera(Some(&film))
                    .validate()
                    .map_err(|found| ConfigProblem { path: format!("cameras.{name}.{}", found.path), ..found })?;
            }
        }
        self.check_pairs()
    }

    /// Checks what only pairs have.
    fn check_pairs(&self) -> Result<(), ConfigProblem> {
        let problem = |message, hint| Err(ConfigProblem { path: "channels".into(), message, hint });
        let asked = OF_PAIRS.into_iter().find(|channel| self.channels.contains(channel));
        let Some(Channel { name, .. }) = asked else { return Ok(()) };
        let is_pair = self.stereo.is_some() || self.cameras.values().any(|camera| camera.base_line_m.is_some());
        if !is_pair {
            let hint = format!("give a camera of `cameras` a `base_line_m`, or leave out `{name}`");
            return problem(format!("`{name}` is of a stereo pair, and no camera is one"), hint);
        }
        if self.stereo.is_some() && !self.lens.is_none() {
            let message = format!("`{name}` is of rectified pictures, and `lens` bends them");
            return problem(message, format!("leave out `{name}`, or `lens`"));
        }
        Ok(())
    }
}
