//! Parameters of a recipe's pictures: renderer, camera, effects, weathers.

use crate::cameras::{CameraConfig, GimbalConfig};
use crate::effects::Effects;
use crate::look::PictureLook;
use cosfly_domain::{
    Camera, ChannelSet, Lens, LensModel, MotionBlur, Mount, Noise, RollingShutter, Season, StereoEye, Weather,
};
use cosfly_frames::{DVec3, Seed};
use cosfly_materials::dry_days;
use cosfly_materials::weather::WeatherRanges;
use cosfly_models::ModelConfig;
use cosfly_models::mesh::MeshConfig;
use cosfly_optics::OpticsConfig;
use cosfly_splats::SplatsConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Hint at the key that chose between two renderers.
const BACKEND_IS_GONE: &str = "leave `backend` out: there is one renderer, on the processor, which was faster than the one \
     on graphics cards; a CARLA server draws a finished dataset anew, see `cosfly carla-job`";

/// Camera and weather of rendered trajectories.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = { "backend": BACKEND_IS_GONE }))]
pub struct RenderConfig {
    /// Look of colours: `full` (shadows, textures, weather, smooth edges) or `simple` (plain colours and windows in the
    /// light of sun, sky and haze, in about a third of the time). Depth, labels and ids are the same in both.
    pub look: PictureLook,
    /// Channels to draw: `rgb`, `depth`, `semantic` and `instance` always, others on request, such as `normals`.
    #[serde(skip_serializing_if = "ChannelSet::is_default")]
    pub channels: ChannelSet,
    /// Image width, pixels.
    #[schemars(range(min = 16, max = 7680))]
    pub width: u32,
    /// Image height, pixels.
    #[schemars(range(min = 16, max = 4320))]
    pub height: u32,
    /// Horizontal field of view, degrees.
    #[schemars(range(min = 5, max = 150))]
    pub fov_deg: f64,
    /// Lowest and highest horizontal field of view, degrees, 5 to 150: each walk draws one instead of `fov_deg`, and all
    /// flights behind it share it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov_range_deg: Option<[f64; 2]>,
    /// Cameras of the drone by name: each films every flight, with keys of its own in the place of the stage's. The films are
    /// named `<trajectory>-<camera>`; weather, clothes and everything else are the same. Left out: one camera.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub cameras: BTreeMap<String, CameraConfig>,
    /// Place and turn of the camera on the drone; the turn is drawn once per walk, the same for all of its flights and frames.
    pub gimbal: GimbalConfig,
    /// Lens, sensor and image processor; of colours in the full look. Left out: a drone's camera, drawn per walk.
    pub optics: OpticsConfig,
    /// Distortion of the lens; the focal length is that of the undistorted camera.
    pub lens: Lens,
    /// Motion blur of colour.
    pub motion_blur: MotionBlur,
    /// Rows that are taken one after the other, in all channels.
    pub rolling_shutter: RollingShutter,
    /// Sensor noise on colour; left out: in the full look drawn per walk as `optics.preset` says, more in the dark.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<Noise>,
    /// Probability that a followed person wears a colour that stands out from asphalt, pavement and grass, beyond the quarter
    /// of all people who do. Default 0: everybody's clothes are drawn from one palette and stay the same in all flights, so
    /// that colour does not tell whom the drone follows; above 0 people may change clothes when followed.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub target_stands_out: f64,
    /// Names of CARLA weather presets; each walk draws one, and the sun's azimuth with it.
    #[schemars(length(min = 1))]
    pub weathers: Vec<String>,
    /// Render every trajectory once in each of `weathers` instead of drawing one: same poses, ids, clothes and sun azimuth,
    /// pixel by pixel. The items are named `<trajectory>-<weather>`.
    pub paired_weathers: bool,
    /// Ranges to draw single weather numbers from, on top of the preset.
    pub weather: WeatherRanges,
    /// Season of trees and lawns; left out: each town's own, summer in four towns of five, else autumn; winter only where it is named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub season: Option<Season>,
    /// Models from glTF files, drawn instead of the boxes of the town's things; labels and ids stay those of the things.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub models: Vec<ModelConfig>,
    /// A textured mesh of a scan, drawn in the place of the town's boxes, with the light that is in its colours. Dry ground by day, in
    /// the season of the scan; rain and haze in the air.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshConfig>,
    /// Gaussian splats of a scan: colours over the geometry that the map's file gives. Weathers as with `mesh`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub splats: Option<SplatsConfig>,
    /// Writes a 3-D box of each body that a frame shows, and COCO's seventeen key points of people: table `bodies_3d`.
    #[serde(skip_serializing_if = "core::ops::Not::not")]
    pub bodies_3d: bool,
    /// Which camera of a stereo pair this is; set by [`Self::of_camera`].
    #[serde(skip)]
    pub stereo: Option<StereoEye>,
    /// Frames of the flight from one picture to the next; set by [`Self::of_camera`].
    #[serde(skip)]
    pub every: u32,
    /// Time of the first picture after the beginning of the flight, nanoseconds; set by [`Self::of_camera`].
    #[serde(skip)]
    pub begins_ns: u64,
}

impl Default for RenderConfig {
    fn default() -> Self {
        let weathers = ["ClearNoon", "CloudyNoon", "WetNoon", "ClearSunset", "SoftRainNoon", "CloudySunset"];
        Self {
            look: PictureLook::Full,
            channels: ChannelSet::default(),
            width: 1280,
            height: 720,
            fov_deg: 90.0,
            fov_range_deg: None,
            cameras: BTreeMap::new(),
            gimbal: GimbalConfig::default(),
            optics: OpticsConfig::default(),
            lens: Lens::default(),
            motion_blur: MotionBlur::default(),
            rolling_shutter: RollingShutter::default(),
            noise: None,
            target_stands_out: 0.0,
            weathers: weathers.map(str::to_owned).to_vec(),
            paired_weathers: false,
            weather: WeatherRanges::default(),
            season: None,
            models: vec![],
            mesh: None,
            splats: None,
            bodies_3d: false,
            stereo: None,
            every: 1,
            begins_ns: 0,
        }
    }
}

/// A value that the schema cannot refuse but the renderer must.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigProblem {
    /// Path in the stage's table, such as `weathers[1]`.
    pub path: String,
    /// The refused value and the violated rule: a lower-case fragment.
    pub message: String,
    /// Allowed values, or the nearest valid one.
    pub hint: String,
}

impl fmt::Display for ConfigProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}): `{}`", self.message, self.hint, self.path)
    }
}

impl std::error::Error for ConfigProblem {}

impl RenderConfig {
    /// Parameters that no single film depends on where weathers are paired: it is named after its own; not in its key.
    pub const NOT_IN_KEY: &[&str] = &["weathers"];

    /// Checks every value.
    ///
    /// # Errors
    /// The first value that is out of range, or names no preset.
    pub fn validate(&self) -> Result<(), ConfigProblem> {
        let problem =
            |path: &str, message: String, hint: String| Err(ConfigProblem { path: path.into(), message, hint });
        if let Some(missing) = self.channels.missing() {
            let every: Vec<&str> = ChannelSet::default().iter().map(|channel| channel.name).collect();
            let hint = format!("{} are part of every frame: add channels to them", every.join(", "));
            return problem("channels", format!("the list leaves out `{}`", missing.name), hint);
        }
        if !(16..=7680).contains(&self.width) {
            return problem("width", format!("the width is `{}`", self.width), "16 to 7680 pixels".into());
        }
        if !(16..=4320).contains(&self.height) {
            return problem("height", format!("the height is `{}`", self.height), "16 to 4320 pixels".into());
        }
        if !(5.0..=150.0).contains(&self.fov_deg) {
            return problem("fov_deg", format!("the field of view is `{}`", self.fov_deg), "5 to 150 degrees".into());
        }
        if !(0.0..=1.0).contains(&self.target_stands_out) {
            let message = format!("the probability is `{}`", self.target_stands_out);
            return problem("target_stands_out", message, "0 to 1".into());
        }
        if let Some(range) = self.fov_range_deg {
            check_range("fov_range_deg", range, [5.0, 150.0])?;
        }
        check_range("gimbal.pitch_range_deg", self.gimbal.pitch_range_deg, [-90.0, 90.0])?;
        check_range("gimbal.yaw_range_deg", self.gimbal.yaw_range_deg, [-180.0, 180.0])?;
        check_range("gimbal.roll_deg", [self.gimbal.roll_deg; 2], [-180.0, 180.0])?;
        for metres in self.gimbal.position_in_body_m {
            check_range("gimbal.position_in_body_m", [metres; 2], [-10.0, 10.0])?;
        }
        self.check_effects()?;
        self.check_cameras()?;
        self.check_scan()?;
        for (index, model) in self.models.iter().enumerate() {
            if !(-360.0..=360.0).contains(&model.turn_deg) {
                let message = format!("the turn is `{}`", model.turn_deg);
                return problem(&format!("models[{index}].turn_deg"), message, "-360 to 360 degrees".into());
            }
        }
        for (name, range, bounds) in self.weather.all() {
            if let Some(range) = range {
                check_range(&format!("weather.{name}"), range, bounds)?;
            }
        }
        if self.weathers.is_empty() {
            return problem("weathers", "there is no weather to draw from".into(), "name at least one preset".into());
        }
        for (index, name) in self.weathers.iter().enumerate() {
            if cosfly_materials::presets::preset(name).is_none() {
                let path = format!("weathers[{index}]");
                let hint = format!("the presets are {}", cosfly_materials::presets::PRESETS.join(", "));
                return problem(&path, format!("there is no weather preset `{name}`"), hint);
            }
            if self.paired_weathers && self.weathers[..index].contains(name) {
                let path = format!("weathers[{index}]");
                let message = format!("`{name}` stands twice in the list, and `paired_weathers` is on");
                return problem(&path, message, "name each weather once".into());
            }
        }
        Ok(())
    }

    fn check_scan(&self) -> Result<(), ConfigProblem> {
        let problem = |path: String, message, hint: &str| ConfigProblem { path, message, hint: hint.to_owned() };
        if let Some(mesh) = &self.mesh {
            let place = mesh.place(DVec3::ZERO);
            place.map_err(|it| problem(format!("mesh.{}", it.key), it.message, it.hint))?;
        }
        if let Some(splats) = &self.splats {
            let place = splats.placement(DVec3::ZERO);
            place.map_err(|it| problem(format!("splats.{}", it.key), it.message, it.hint))?;
        }
        let scan = self.mesh.as_ref().map(|_| "mesh").or(self.splats.as_ref().map(|_| "splats"));
        // Splats have no light but their own, whatever mesh is beside them.
        let has_nights = self.splats.is_none() && self.mesh.as_ref().is_some_and(|mesh| !mesh.light.is_of_scan());
        let refused =
            scan.and_then(|key| dry_days::refusal((key, has_nights), &self.weathers, &self.weather, self.season));
        refused.map_or(Ok(()), |(path, message, hint)| Err(ConfigProblem { path, message, hint }))
    }

    fn check_effects(&self) -> Result<(), ConfigProblem> {
        let in_range = |path: &str, value: f64, [low, high]: [f64; 2]| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            let message = format!("the value is `{value}`");
            Err(ConfigProblem { path: path.into(), message, hint: format!("allowed are {low} to {high}") })
        };
        let optics = &self.optics;
        for (path, value, bounds) in [
            ("optics.point_spread_px", optics.point_spread_px, [0.0, 1.2]),
            ("optics.sharpening", optics.sharpening, [0.0, 1.0]),
            ("optics.contrast", optics.contrast, [0.0, 1.0]),
            ("optics.exposure_ev", optics.exposure_ev, [-4.0, 4.0]),
            ("optics.white_balance_k", optics.white_balance_k, [2500.0, 10_000.0]),
            ("optics.bloom", optics.bloom, [0.0, 2.0]),
            ("noise.gaussian", self.noise.map(|noise| noise.gaussian), [0.0, 64.0]),
            ("noise.shot", self.noise.map(|noise| noise.shot), [0.0, 64.0]),
        ] {
            value.map_or(Ok(()), |value| in_range(path, value, bounds))?;
        }
        self.check_lens()?;
        in_range("motion_blur.shutter_s", self.motion_blur.shutter_s, [0.0, 0.5])?;
        in_range("motion_blur.samples", f64::from(self.motion_blur.samples), [3.0, 65.0])?;
        in_range("rolling_shutter.readout_s", self.rolling_shutter.readout_s, [0.0, 0.5])?;
        in_range("rolling_shutter.strips", f64::from(self.rolling_shutter.strips), [2.0, 256.0])?;
        Ok(())
    }

    /// The camera, with the field of view of `fov_deg`; of a picture all around, with its pixels per radian as the focal length.
    pub fn camera(&self) -> Camera {
        self.camera_of(self.fov_deg)
    }

    /// The camera with a field of view, degrees.
    pub(crate) fn camera_of(&self, fov_deg: f64) -> Camera {
        let is_around = self.lens.model == LensModel::Equirectangular;
        let horizontal_fov_rad = if is_around { Camera::ALL_AROUND_FOV_RAD } else { fov_deg.to_radians() };
        Camera { width: self.width, height: self.height, horizontal_fov_rad }
    }

    /// The camera of all flights behind one walk.
    pub fn draw_camera(&self, walk_seed: &Seed) -> Camera {
        let fov_deg = self.fov_range_deg.map_or(self.fov_deg, |range| draw(walk_seed, "fov", range));
        self.camera_of(fov_deg)
    }

    /// Turn of the camera against the drone on all flights behind one walk.
    pub fn draw_mount(&self, walk_seed: &Seed) -> Mount {
        Mount {
            position_in_body_m: DVec3::from_array(self.gimbal.position_in_body_m),
            right_m: self.stereo.map_or(0.0, |eye| eye.right_m()),
            roll_rad: self.gimbal.roll_deg.to_radians(),
            pitch_rad: draw(walk_seed, "gimbal-pitch", self.gimbal.pitch_range_deg).to_radians(),
            yaw_rad: draw(walk_seed, "gimbal-yaw", self.gimbal.yaw_range_deg).to_radians(),
            levelled: self.gimbal.levelled,
        }
    }

    /// The sensor's noise on all flights behind one walk, in this weather.
    pub fn draw_noise(&self, walk_seed: &Seed, weather: &Weather) -> Noise {
        match (self.noise, self.look) {
            (Some(noise), _) => noise,
            (None, PictureLook::Simple) => Noise::default(),
            (None, PictureLook::Full) => self.optics.draw_noise(walk_seed, weather.sun_altitude_angle),
        }
    }

    /// The weather of all flights behind one walk: a preset from the list, an azimuth of the sun, and what the ranges say.
    /// Names that are no preset (which [`Self::validate`] refuses) count as `ClearNoon`.
    pub fn draw_weather(&self, walk_seed: &Seed) -> Weather {
        let drawn = self.weathers.get(walk_seed.stream("weather").index(self.weathers.len()));
        self.weather_called(drawn.map_or("ClearNoon", String::as_str), walk_seed)
    }

    /// The weather `preset` over one walk: everything that is drawn is the same for all presets.
    pub fn weather_called(&self, preset: &str, walk_seed: &Seed) -> Weather {
        let mut weather =
            cosfly_materials::presets::preset(preset).unwrap_or_else(cosfly_materials::presets::clear_noon);
        let mut stream = walk_seed.stream("weather");
        // The first number chose the preset.
        stream.bits();
        // Whole degrees: readable in tables, and exact in every encoding.
        weather.sun_azimuth_angle = stream.index(360) as f64;
        self.weather.draw(&mut weather, walk_seed);
        weather
    }

    /// Effects on ideal pictures of `camera`.
    pub fn effects(&self, camera: Camera) -> Effects {
        let effects = Effects::new(camera, self.lens, self.motion_blur, self.rolling_shutter);
        effects.of_pair(self.stereo)
    }
}

/// A hundredth of a unit between two values, ends included.
fn draw(walk_seed: &Seed, purpose: &str, [low, high]: [f64; 2]) -> f64 {
    let drawn = walk_seed.stream(purpose).uniform(low, high);
    ((drawn * 100.0).round() / 100.0).clamp(low, high)
}

fn check_range(path: &str, [low, high]: [f64; 2], [least, most]: [f64; 2]) -> Result<(), ConfigProblem> {
    let problem = |message: String, hint: String| Err(ConfigProblem { path: path.to_owned(), message, hint });
    for value in [low, high] {
        if !(least..=most).contains(&value) {
            return problem(
                format!("the range `[{low}, {high}]` leaves what is allowed"),
                format!("{least} to {most}"),
            );
        }
    }
    if low > high {
        return problem(
            format!("the range `[{low}, {high}]` begins above its end"),
            "write the lower value first".into(),
        );
    }
    Ok(())
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
            (RenderConfig { target_stands_out: 1.5, ..good.clone() }, "target_stands_out"),
            (RenderConfig { fov_range_deg: Some([60.0, 200.0]), ..good.clone() }, "fov_range_deg"),
            (RenderConfig { fov_range_deg: Some([90.0, 60.0]), ..good.clone() }, "fov_range_deg"),
            (
                RenderConfig {
                    gimbal: GimbalConfig { yaw_range_deg: [0.0, f64::NAN], ..GimbalConfig::default() },
                    ..good.clone()
                },
                "gimbal.yaw_range_deg",
            ),
            (RenderConfig { lens: Lens::brown(-0.9, 0.0), ..good.clone() }, "lens"),
            (
                RenderConfig {
                    lens: Lens::brown(-0.1, 0.0),
                    channels: ChannelSet::of(|channel| channel.name != "mask"),
                    ..good.clone()
                },
                "channels",
            ),
            (
                RenderConfig {
                    optics: OpticsConfig { white_balance_k: Some(f64::NAN), ..OpticsConfig::default() },
                    ..good.clone()
                },
                "optics.white_balance_k",
            ),
            (RenderConfig { noise: Some(Noise { gaussian: -1.0, shot: 0.0 }), ..good.clone() }, "noise.gaussian"),
            (
                RenderConfig {
                    weather: WeatherRanges { cloudiness: Some([0.0, 120.0]), ..WeatherRanges::default() },
                    ..good.clone()
                },
                "weather.cloudiness",
            ),
            (
                RenderConfig {
                    paired_weathers: true,
                    weathers: vec!["ClearNoon".into(), "ClearNoon".into()],
                    ..good.clone()
                },
                "weathers[1]",
            ),
            (RenderConfig { weathers: vec![], ..good.clone() }, "weathers"),
            (RenderConfig { weathers: vec!["ClearNoon".into(), "Hail".into()], ..good.clone() }, "weathers[1]"),
        ] {
            assert_eq!(config.validate().expect_err(path).path, path);
        }
    }

    #[test]
    fn ranges_are_drawn_per_walk_and_the_other_numbers_stay_the_preset_s() {
        let mut config = RenderConfig { fov_range_deg: Some([60.0, 100.0]), ..RenderConfig::default() };
        config.weather.sun_altitude_angle = Some([-10.0, 60.0]);
        config.gimbal.yaw_range_deg = [-20.0, 20.0];
        config.validate().expect("a good configuration");
        let seeds: Vec<Seed> = (0..200).map(|i| Seed([1; 32]).child("walk", i)).collect();
        for seed in &seeds {
            let (weather, camera, mount) =
                (config.draw_weather(seed), config.draw_camera(seed), config.draw_mount(seed));
            assert!((-10.0..=60.0).contains(&weather.sun_altitude_angle) && mount.pitch_rad == 0.0);
            assert!((60.0..=100.0).contains(&camera.horizontal_fov_rad.to_degrees().round()));
            let preset = cosfly_materials::presets::preset(&weather.name).expect("a preset");
            assert_eq!((weather.cloudiness, weather.wetness), (preset.cloudiness, preset.wetness));
        }
        let spread = |value: &dyn Fn(&Seed) -> f64| {
            let values = seeds.iter().map(value);
            values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
        };
        assert!(spread(&|seed| config.draw_weather(seed).sun_altitude_angle) > 60.0);
        assert!(spread(&|seed| config.draw_mount(seed).yaw_rad.to_degrees()) > 35.0);
    }

    #[test]
    fn paired_weathers_share_everything_that_is_drawn() {
        let mut config = RenderConfig::default();
        config.weather.fog_density = Some([0.0, 40.0]);
        let seed = Seed([9; 32]);
        let (noon, rain) = (config.weather_called("ClearNoon", &seed), config.weather_called("HardRainNoon", &seed));
        assert_eq!((noon.sun_azimuth_angle, noon.fog_density), (rain.sun_azimuth_angle, rain.fog_density));
        assert!(rain.precipitation > noon.precipitation);
        let drawn = config.draw_weather(&seed);
        assert_eq!(config.weather_called(&drawn.name, &seed), drawn);
    }

    fn with_camera(name: &str, camera: CameraConfig) -> RenderConfig {
        RenderConfig { cameras: BTreeMap::from([(name.to_owned(), camera)]), ..RenderConfig::default() }
    }

    #[test]
    fn a_camera_has_its_own_keys_and_the_stages_where_it_has_none() {
        let down = GimbalConfig { pitch_range_deg: [-90.0; 2], ..GimbalConfig::default() };
        let mut config =
            with_camera("down", CameraConfig { width: Some(320), gimbal: Some(down), ..CameraConfig::default() });
        config.noise = Some(Noise { gaussian: 2.0, shot: 0.0 });
        config.validate().expect("a camera");
        let own = config.of_camera(Some("down"));
        assert_eq!((own.width, own.height, own.noise, own.gimbal), (320, 720, config.noise, down));
        assert_eq!(config.of_camera(None), RenderConfig { cameras: BTreeMap::new(), ..config.clone() });
        assert_eq!((config.films(), RenderConfig::default().films()), (vec!["down".to_owned()], vec![]));
        // A field of view of its own takes the place of a range.
        let ranged = RenderConfig {
            fov_range_deg: Some([60.0, 100.0]),
            ..with_camera("tele", CameraConfig { fov_deg: Some(20.0), ..CameraConfig::default() })
        };
        let tele = ranged.of_camera(Some("tele"));
        assert_eq!((tele.fov_deg, tele.fov_range_deg), (20.0, None));
    }

    #[test]
    fn a_pair_is_two_films_a_base_line_apart() {
        let pair = CameraConfig { base_line_m: Some(0.12), ..CameraConfig::default() };
        let mut config = RenderConfig { channels: ChannelSet::of(|_| true), ..with_camera("front", pair) };
        config.cameras.insert("down".into(), CameraConfig::default());
        config.validate().expect("a pair and a single camera");
        assert_eq!(config.films(), ["down", "front_left", "front_right"]);
        let [down, left, right] = ["down", "front_left", "front_right"].map(|film| config.of_camera(Some(film)));
        let right_m = |config: &RenderConfig| config.draw_mount(&Seed([1; 32])).right_m;
        assert_eq!([right_m(&down), right_m(&left), right_m(&right)], [0.0, 0.0, 0.12]);
        let has_disparity =
            |config: &RenderConfig| config.channels.contains(&cosfly_domain::channels::disparity::CHANNEL);
        assert!(!has_disparity(&down) && has_disparity(&left) && has_disparity(&right));
        assert!(!down.channels.contains(&cosfly_domain::channels::depth_stereo::CHANNEL));
    }

    #[test]
    fn cameras_are_refused_with_their_path() {
        let path = |config: &RenderConfig| config.validate().expect_err("refused").path;
        assert_eq!(path(&with_camera("Down", CameraConfig::default())), "cameras.Down");
        assert_eq!(path(&with_camera("", CameraConfig::default())), "cameras.");
        let zero = CameraConfig { base_line_m: Some(0.0), ..CameraConfig::default() };
        assert_eq!(path(&with_camera("front", zero)), "cameras.front.base_line_m");
        let mut twice = with_camera("front", CameraConfig { base_line_m: Some(0.1), ..CameraConfig::default() });
        twice.cameras.insert("front_left".into(), CameraConfig::default());
        assert_eq!(path(&twice), "cameras.front_left");
        let all = ChannelSet::of(|channel| !channel.name.starts_with("depth_"));
        let single = RenderConfig { channels: all.clone(), ..with_camera("front", CameraConfig::default()) };
        assert_eq!(path(&single), "channels");
        let bent =
            CameraConfig { base_line_m: Some(0.1), lens: Some(Lens::brown(-0.1, 0.0)), ..CameraConfig::default() };
        assert_eq!(path(&RenderConfig { channels: all, ..with_camera("front", bent) }), "cameras.front.channels");
        let long = Lens { k3: 0.1, ..Lens::brown(0.0, 0.0) };
        assert_eq!(path(&RenderConfig { lens: long, ..RenderConfig::default() }), "lens.model");
        let far = GimbalConfig { position_in_body_m: [0.0, 0.0, 40.0], ..GimbalConfig::default() };
        assert_eq!(path(&RenderConfig { gimbal: far, ..RenderConfig::default() }), "gimbal.position_in_body_m");
        let wide = CameraConfig { lens: Some(Lens::brown(-0.9, 0.0)), ..CameraConfig::default() };
        assert_eq!(path(&with_camera("wide", wide)), "cameras.wide.lens");
        assert_eq!(
            path(&RenderConfig { paired_weathers: true, ..with_camera("down", CameraConfig::default()) }),
            "cameras"
        );
    }
}
