//! Readings of the sensors of an environment that are no cameras.

use crate::environment::Environment;
use crate::episode::Episode;
use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;
use cosfly_sensors::{Sensor, SensorMoment};

/// Readings of an environment's sensors at the present moment, with the numbers of each. They sit in the middle of the drone and are
/// turned as its camera. They meet the town, the target and everybody else, but not the drones of a team.
pub fn readings(environment: &Environment) -> Vec<(&'static Sensor, Vec<f64>)> {
    let (episode, observation) = (environment.episode(), environment.observation());
    let mut sensors = environment.settings().sensors.iter().peekable();
    if sensors.peek().is_none() {
        return vec![];
    }
    let bodies = bodies(episode, observation.time_s);
    let read = |sensor: &'static Sensor| {
        let mut values = vec![0.0; sensor.quantities.len()];
        let moment = SensorMoment {
            time_s: observation.time_s,
            sensor_in_world: environment.camera(),
            velocity_in_world: observation.motion.velocity_in_world,
            town: &episode.place.exact,
            ground: episode.place.ground(),
            bodies: &bodies,
            seed: episode.seed.child(sensor.name, u64::from(observation.step)),
        };
        (sensor.read)(&moment, &mut values);
        (sensor, values)
    };
    sensors.map(read).collect()
}

/// Boxes of the target and of everybody else who is there at a time.
fn bodies(episode: &Episode, time_s: f64) -> Vec<OrientedBox> {
    let (track, state) = (&episode.target, episode.target_at(time_s));
    let person = || OrientedBox {
        center_in_world: state.feet_in_world + DVec3::Z * (0.5 * track.height_m),
        half_extents_m: DVec3::new(track.radius_m, track.radius_m, 0.5 * track.height_m),
        yaw_rad: state.heading_rad,
    };
    let target = episode.followed.as_ref().map_or_else(person, |plan| plan.box_at(&state));
    let others = episode.others.at(time_s).map(|present| present.mover.plan.box_at(&present.state));
    // A target without extent is a point.
    others.chain((track.radius_m > 0.0).then_some(target)).collect()
}
