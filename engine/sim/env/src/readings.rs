//! Readings of the sensors of an environment that are no cameras.

use crate::environment::Environment;
use crate::episode::Episode;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, Pose};
use cosfly_sensors::{Airframe, Carrier, Sensor, SensorMoment};

/// Readings of an environment's sensors at the present moment, with the numbers of each but the true ones. They sit in the middle of the
/// drone and are turned as its camera or, where it carries them, its airframe. They meet the town, the target and everybody else, but not the drones of a team.
pub fn readings(environment: &Environment) -> Vec<(&'static Sensor, Vec<f64>)> {
    let (episode, observation) = (environment.episode(), environment.observation());
    let mut sensors = environment.settings().sensors.iter().peekable();
    if sensors.peek().is_none() {
        return vec![];
    }
    let bodies = bodies(episode, observation.time_s);
    let airframe = environment.airframe();
    let read = |sensor: &'static Sensor| {
        let mut values = vec![0.0; sensor.count()];
        let moment = SensorMoment {
            time_s: observation.time_s,
            sensor_in_world: pose(sensor, environment, &airframe),
            velocity_in_world: observation.motion.velocity_in_world,
            step_s: environment.settings().step_s,
            airframe,
            town: &episode.place.exact,
            ground: episode.place.ground(),
            bodies: &bodies,
            origin: episode.place.origin(),
            flight_seed: episode.seed.child(sensor.name, u64::MAX),
            seed: episode.seed.child(sensor.name, u64::from(observation.step)),
        };
        (sensor.read)(&moment, &mut values);
        values.truncate(sensor.quantities.len());
        (sensor, values)
    };
    sensors.map(read).collect()
}

/// Pose of what carries a sensor.
fn pose(sensor: &Sensor, environment: &Environment, airframe: &Airframe) -> Pose {
    match sensor.carrier {
        Carrier::Camera => environment.camera(),
        Carrier::Airframe => airframe.pose(),
    }
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
    let others = episode.others.at(time_s).map(|present| present.body.plan.box_at(&present.state));
    // A target without extent is a point.
    others.chain((track.radius_m > 0.0).then_some(target)).collect()
}
