//! `lidar`: beams and points a second of each device.

use super::outcome::{Outcome, print};
use super::vehicles::town_of;
use clap::Args;
use cosfly_domain::Mount;
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_lab::clock::timed;
use cosfly_materials::presets::clear_noon;
use cosfly_render::Scene;
use cosfly_sensors::SensorPlace;
use cosfly_sensors::lidar::{LIDARS, Lidar, LidarScene, LidarTriangle, ScannedFlight};
use std::path::PathBuf;

/// Examples of `lidar`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab lidar --town recipes/towns/downtown.xodr
  cosfly-lab lidar --town recipes/towns/downtown.xodr --pitch-deg -30
  cosfly-lab lidar --town recipes/towns/uptown.xodr --seconds 5 --height-m 40";

/// Arguments of `lidar`.
#[derive(Args, Debug)]
pub struct LidarArguments {
    /// Map of the town
    #[arg(long, value_name = "FILE")]
    pub town: PathBuf,
    /// Length of the flight, seconds
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=60))]
    pub seconds: u32,
    /// Height of the flight above the lowest box, metres
    #[arg(long, value_name = "M", default_value_t = 25.0)]
    pub height_m: f64,
    /// Turn of the devices upwards, degrees: -30 looks down as they do on drones
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true)]
    pub pitch_deg: f64,
    /// Seed of the noise
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

/// Measures and prints the table: a flight at 5 m/s over the middle of the town, without people, on one core.
pub fn lidar(arguments: &LidarArguments) -> Outcome {
    let town = town_of(&arguments.town, arguments.seed)?;
    let seed = Seed::of_item(arguments.seed, "lidar", "town");
    let (scene, scene_s) = timed(|| {
        let met = |it: cosfly_render::SceneTriangle| LidarTriangle {
            corners_in_world: it.corners_in_world,
            label: it.label,
            instance: it.instance,
        };
        LidarScene::new(&Scene::new(&town, seed).triangles().into_iter().map(met).collect::<Vec<_>>())
    });
    let places = || town.obstacles.iter().map(|obstacle| obstacle.shape.center_in_world);
    let middle = places().sum::<DVec3>() / places().count().max(1) as f64;
    let low_m = places().map(|place| place.z).fold(f64::INFINITY, f64::min).min(middle.z);
    let pose = |second: u32| Pose {
        position_in_world: DVec3::new(middle.x + 5.0 * f64::from(second), middle.y, low_m + arguments.height_m),
        pitch_rad: 0.0,
        yaw_rad: 0.0,
        roll_rad: 0.0,
    };
    let poses: Vec<Pose> = (0..=arguments.seconds).map(pose).collect();
    let mount = Mount { pitch_rad: arguments.pitch_deg.to_radians(), ..Mount::default() };
    let place = SensorPlace { mount, ..SensorPlace::default() };
    let row = |lidar: &&Lidar| {
        let (pattern, [_, rate_hz, _]) = (lidar.pattern(), lidar.rates_hz);
        let flight = ScannedFlight {
            scene: &scene,
            bodies: &|_, _| {},
            poses_in_world: &poses,
            dt_s: 1.0,
            place,
            rate_hz,
            weather: &clear_noon(),
            seed,
        };
        let mut points = 0;
        let (beams, ((), cpu_s)) =
            (flight.beams(&pattern) as f64, timed(|| flight.scan(&pattern, &mut |sweep| points += sweep.points.len())));
        let share = 100.0 * points as f64 / beams;
        let [beams_s, points_s] = [beams, points as f64].map(|count| count / cpu_s / 1e6);
        format!("| `{}` | {:.0} | {beams_s:.2} | {share:.0} | {points_s:.2} |\n", lidar.name, beams / 1e3)
    };
    let rows: String = LIDARS.iter().map(row).collect();
    print(&format!(
        "scene of {}: {scene_s:.2} s\n\n| device | thousand beams | million beams a second of a core | % that are points | million points a second |\n\
         | --- | ---: | ---: | ---: | ---: |\n{rows}",
        town.name
    ))
}
