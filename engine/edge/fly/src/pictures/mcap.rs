//! The log of a flight as an MCAP file.

use super::window::losses;
use crate::flight::{FlownEpisode, Row};
use crate::log::LogLine;
use crate::suite::EpisodeTask;
use cosfly_diagnose::Result;
use cosfly_domain::{Camera, OrientedBox};
use cosfly_drone::Sensed;
use cosfly_env::{End, EnvironmentSettings, Reward};
use cosfly_frames::DVec3;
use cosfly_geometry::SpatialQuery;
use cosfly_schema::log::reading::LoggedSensor;
use cosfly_sensors::Sensor;
use cosfly_write::log::{FlownFlight, FlownStep, SensedSample, write_flown_log};
use std::collections::BTreeMap;

/// Width of the camera's nominal picture, pixels: calibrations have sizes.
const WIDTH_PX: f64 = 640.0;
/// Distance beyond which obstacles do not count, metres.
const FAR_M: f64 = 50.0;
/// Slack for the comparison of times, seconds.
const ROUNDING_S: f64 = 1e-6;
/// Stretches without tracking that are shorter are no events, seconds.
const SHORTEST_LOSS_S: f64 = 0.45;

/// The log of a flight as an MCAP file.
///
/// # Errors
/// None that is expected: memory takes all bytes.
pub fn mcap(task: &EpisodeTask, settings: &EnvironmentSettings, flown: &FlownEpisode) -> Result<Vec<u8>> {
    let (episode, row, lines) = (&task.episode, &flown.row, &flown.steps);
    let mut steps: Vec<FlownStep> = lines.iter().map(|line| step(task, settings, line)).collect();
    let mut rest = &flown.sensed[..];
    for step in &mut steps {
        let (due, later) = rest.split_at(rest.partition_point(|sample| sample.time_s <= step.time_s + ROUNDING_S));
        (step.sensed, rest) = (due.iter().map(sample).collect(), later);
    }
    tell_events(&mut steps, lines, row);
    let entry = |key: &str, value: String| (key.to_owned(), value);
    let mut about = BTreeMap::from([
        entry("episode", row.episode.clone()),
        entry("stratum", row.stratum.clone()),
        entry("step_s", row.step_s.to_string()),
        entry("reward_terms", Reward::NAMES.join(" ")),
        entry("weather", task.shooting.weather.name.clone()),
        entry("map_frame", "right-handed, metres: x = x of CARLA, y = -y of CARLA, z up".to_owned()),
    ]);
    about.extend(row.policy_failure.iter().map(|reason| entry("policy_failure", reason.clone())));
    let lens = &settings.lens;
    let camera = Camera {
        width: WIDTH_PX as u32,
        height: (lens.aspect * WIDTH_PX) as u32,
        horizontal_fov_rad: lens.horizontal_deg.to_radians(),
    };
    let target = &episode.target;
    let sensor = |it: &Sensor| LoggedSensor {
        name: it.name.to_owned(),
        quantities: it.quantities.iter().map(|quantity| quantity.name.to_owned()).collect(),
    };
    let sensors: Vec<LoggedSensor> = settings.sensors.iter().map(sensor).collect();
    let flight = FlownFlight {
        about: &about,
        town: &task.scenery.town,
        camera,
        target_size_m: [target.height_m, target.radius_m],
        sensors: &sensors,
        walk: &target.states,
        steps: &steps,
    };
    let mut bytes = Vec::new();
    write_flown_log(&mut bytes, &flight)?;
    Ok(bytes)
}

fn step(task: &EpisodeTask, settings: &EnvironmentSettings, line: &LogLine) -> FlownStep {
    let pose = line.pose();
    let nearest = task.episode.place.exact.nearest(pose.position_in_world, FAR_M);
    FlownStep {
        step: line.step,
        time_s: line.time_s,
        pose,
        velocity_in_world: DVec3::from_array(line.velocity_in_world),
        target: task.episode.target_at(line.time_s),
        visible: line.visible,
        in_picture: line.in_picture,
        tracked: line.tracked,
        clearance_m: nearest.map_or(FAR_M, |nearest| nearest.distance_m),
        others: episode_boxes(task, line.time_s),
        attitude_xyzw: line.attitude_xyzw,
        sensed: vec![],
        action: line.action.clone().unwrap_or_default(),
        reward: Reward::of_terms(line.reward).sum(&settings.weights),
        reward_terms: line.reward.to_vec(),
        // By name, as the sensors are.
        readings: line.readings.values().cloned().collect(),
        events: vec![],
    }
}

fn episode_boxes(task: &EpisodeTask, time_s: f64) -> Vec<OrientedBox> {
    task.episode.others.at(time_s).map(|present| present.body.plan.box_at(&present.state)).collect()
}

fn sample(sensed: &Sensed) -> SensedSample {
    SensedSample {
        time_s: sensed.time_s,
        rates_rad_s: sensed.inertial.rates_rad_s,
        force_mps2: sensed.inertial.force_mps2,
        height_m: sensed.height_m,
        fix: sensed.fix,
    }
}

/// Writes losses, reacquisitions and the end into the steps where they happen.
fn tell_events(steps: &mut [FlownStep], lines: &[LogLine], row: &Row) {
    for loss in losses(lines) {
        let length_s = loss.len() as f64 * row.step_s;
        if length_s < SHORTEST_LOSS_S {
            continue;
        }
        let why = if lines[loss.start].in_picture { "hidden or too far" } else { "out of the picture" };
        steps[loss.start].events.push((true, format!("target lost: {why}")));
        if let Some(step) = steps.get_mut(loss.end) {
            step.events.push((false, format!("target tracked again after {length_s:.1} s")));
        }
    }
    let (Some(last), Some(line)) = (steps.last_mut(), lines.last()) else { return };
    last.events.extend(match line.end {
        Some(End::Finished) => Some((false, "end of the walk".to_owned())),
        Some(End::Collision) => Some((true, "collision".to_owned())),
        Some(End::Lost) => Some((true, "target lost for too long: the episode ends".to_owned())),
        None => row.policy_failure.clone().map(|reason| (true, format!("the policy failed: {reason}"))),
    });
}
