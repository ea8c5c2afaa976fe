//! Settings that all frames of a flight share: camera, mount and weather.

use crate::looks::walk_seed;
use cosfly_diagnose::Result;
use cosfly_domain::{Camera, Followed, Mount, Noise, Optics, Trajectory, Weather};
use cosfly_figures::{BodyFigure, BodyShape, clothes_seed_of_target, gait_phase_rad};
use cosfly_frames::{Pose, Seed, TargetState, TargetTrack};
use cosfly_render::RenderConfig;

/// Settings of one flight.
pub struct Shooting {
    /// The ideal camera, without its lens.
    pub camera: Camera,
    /// Turn of the camera against the drone.
    pub mount: Mount,
    /// Lens, sensor and image processor.
    pub optics: Optics,
    /// Noise of the sensor.
    pub noise: Noise,
    /// Weather, with the azimuth of its sun drawn.
    pub weather: Weather,
    /// Seed of the clothes of the followed walker, or of the paint of a followed vehicle.
    pub clothes_seed: Seed,
    /// Shape of the followed body.
    pub body: BodyShape,
    /// Precipitation that people open umbrellas against; 0 where renderings in other weathers share the ids.
    rain: f64,
}

impl Shooting {
    /// Settings of a film of `trajectory` behind a walker or behind a body of traffic; `variant` is the one of its item. Twins
    /// follow the same walk: same clothes, same weather, same camera.
    ///
    /// # Errors
    /// None for tracks in memory.
    pub fn of(
        config: &RenderConfig,
        trajectory: &Trajectory,
        followed: Option<&Followed>,
        variant: Option<&str>,
    ) -> Result<Self> {
        let walk_seed = walk_seed(&trajectory.track)?;
        let weather = match preset(config, variant) {
            Some(preset) => config.weather_called(preset, &walk_seed),
            None => config.draw_weather(&walk_seed),
        };
        let (camera, mount) = (config.draw_camera(&walk_seed), config.draw_mount(&walk_seed));
        let (optics, noise) = (config.optics.draw(&walk_seed), config.draw_noise(&walk_seed, &weather));
        let looks = followed.map_or(walk_seed, |followed| followed.plan.looks);
        let clothes_seed = clothes_seed_of_target(&looks, config.target_stands_out);
        let body = followed.map_or(BodyShape::default(), |it| BodyShape::of(it.plan.kind, it.plan.size_m));
        let rain = if config.paired_weathers { 0.0 } else { weather.precipitation };
        let body = body.in_rain(rain, &clothes_seed);
        Ok(Self { camera, mount, optics, noise, weather, clothes_seed, body, rain })
    }

    /// The default camera under a clear sky, behind a person with these looks.
    pub fn plain(looks: Seed) -> Self {
        let config = RenderConfig { weathers: vec!["ClearNoon".to_owned()], ..RenderConfig::default() };
        let (weather, clothes_seed) = (config.draw_weather(&looks), clothes_seed_of_target(&looks, 0.0));
        let (camera, mount, optics) = (config.camera(), Mount::default(), cosfly_optics::of_mean_drone());
        Self {
            camera,
            mount,
            optics,
            noise: Noise::default(),
            weather,
            clothes_seed,
            body: BodyShape::default(),
            rain: 0.0,
        }
    }

    /// The shape of somebody else with these looks in the weather of the flight.
    pub fn dressed(&self, body: BodyShape, looks: &Seed) -> BodyShape {
        body.in_rain(self.rain, looks)
    }

    /// The target of a flight in a state, after metres of its way.
    pub fn target(&self, track: &TargetTrack, state: TargetState, walked_m: f64) -> BodyFigure {
        BodyFigure {
            state,
            height_m: track.height_m,
            radius_m: track.radius_m,
            clothes_seed: self.clothes_seed,
            gait_phase_rad: gait_phase_rad(walked_m, track.height_m),
            body: self.body,
        }
    }

    /// Poses of the camera, one per frame.
    pub fn poses(&self, trajectory: &Trajectory) -> Vec<Pose> {
        trajectory.poses_in_world.iter().map(|drone| self.mount.camera_pose(drone)).collect()
    }
}

/// Weather preset that a paired rendering names its item after: the variant of the item.
fn preset<'a>(config: &RenderConfig, variant: Option<&'a str>) -> Option<&'a str> {
    variant.filter(|_| config.paired_weathers)
}
