//! `reference`: what to look at and where to be, step by step, as something from outside says (a plugin).

use super::config::DT_S;
use super::meeting::Meeting;
use super::{Mission, POINT_HEIGHT_M};
use cosfly_frames::{DVec3, Pose, TargetState, TargetTrack, real};
use cosfly_planner::MucoConfig;

/// Weight of a place that matters fully.
const WEIGHT: f64 = 60.0;
/// Weight of seeing the watched point, unless the recipe says otherwise.
const VISIBILITY_WEIGHT: f64 = 10.0;
/// Altitudes below and above those of the places that are allowed, metres.
const BAND_M: f64 = 4.0;

/// Per step, all of one length, finite numbers, shares between 0 and 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// Point that the camera looks at, world frame, metres.
    pub watched: Vec<DVec3>,
    /// Wanted position of the drone, world frame, metres.
    pub places: Vec<DVec3>,
    /// Weight of the wish, 0 to 1.
    pub pull: Vec<f64>,
}

impl Reference {
    /// Steps at which the drone is to be just at its place.
    pub fn marks(&self) -> impl Iterator<Item = usize> {
        self.pull.iter().enumerate().filter(|(_, pull)| **pull >= 1.0).map(|(step, _)| step)
    }

    /// Distance of the drone from the places of its marks, metres.
    pub fn shortfalls_m(&self, poses: &[Pose]) -> Vec<f64> {
        let miss = |step: usize| {
            poses.get(step).map_or(f64::INFINITY, |pose| pose.position_in_world.distance(self.places[step]))
        };
        self.marks().map(miss).collect()
    }
}

/// A flight along a reference. Distance, pitch, altitudes and radii of `view` are set by it.
pub fn mission(reference: &Reference, config: &MucoConfig) -> Mission {
    let last = reference.watched.len().saturating_sub(1);
    let state = |step: usize| {
        let (here, next) = (reference.watched[step], reference.watched[(step + 1).min(last)]);
        let sight = here - reference.places[step];
        TargetState {
            feet_in_world: here,
            heading_rad: real::atan2(sight.y, sight.x),
            speed_mps: (next - here).length() / DT_S,
        }
    };
    let track = TargetTrack {
        dt_s: DT_S,
        height_m: POINT_HEIGHT_M,
        radius_m: 0.0,
        states: (0..reference.watched.len()).map(state).collect(),
    };
    let drawn = reference.places.iter().copied().zip(reference.pull.iter().copied()).collect();
    let meetings = vec![(Meeting::new("reference", drawn), WEIGHT)];
    Mission { track, config: wishes(reference, config), meetings }
}

/// Bands around the places' own offsets from the watched point.
fn wishes(reference: &Reference, config: &MucoConfig) -> MucoConfig {
    let offsets = || reference.places.iter().zip(&reference.watched).map(|(place, point)| *place - *point);
    let count = reference.places.len().max(1) as f64;
    let across = |offset: DVec3| offset.truncate().length();
    let low = offsets().map(|it| it.z).fold(f64::INFINITY, f64::min);
    let high = offsets().map(|it| it.z).fold(f64::NEG_INFINITY, f64::max);
    let (nearest, furthest) = offsets().map(across).fold((f64::INFINITY, 0.0_f64), |(a, b), r| (a.min(r), b.max(r)));
    let mean = offsets().sum::<DVec3>() / count;
    let (mean_up, mean_across) = (mean.z, offsets().map(across).sum::<f64>() / count);
    let mut config = super::agile(config);
    let view = &mut config.view;
    view.distance_m = real::hypot(mean_up, mean_across).clamp(2.0, 200.0);
    view.pitch_deg = real::atan2(mean_up, mean_across).to_degrees().clamp(5.0, 85.0);
    view.min_altitude_m = (low - BAND_M).clamp(0.5, 200.0);
    view.preferred_altitude_m = high.clamp(view.min_altitude_m, 200.0);
    view.max_altitude_m = (high + BAND_M).clamp(view.preferred_altitude_m, 400.0);
    view.min_radius_m = (0.5 * nearest).clamp(0.5, 200.0);
    view.max_radius_m = (1.5 * furthest + 2.0).clamp(view.min_radius_m + 1.0, 400.0);
    (view.rear_sector_deg, view.start_sector_deg) = (180.0, 180.0);
    config.weights.visibility = config.weights.visibility.or(Some(VISIBILITY_WEIGHT));
    config.weights.viewpoint = config.weights.viewpoint.or(Some(0.0));
    let reach_m = (view.max_radius_m + 10.0).min(500.0);
    config.search.filter_radius_m = config.search.filter_radius_m.max(reach_m);
    config
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{OrientedBox, PlanOutcome};
    use cosfly_geometry::BoxBvh;
    use cosfly_planner::plan_request;

    #[test]
    fn marks_are_met_and_a_tower_on_the_way_is_flown_round() {
        let tower = OrientedBox {
            center_in_world: DVec3::new(0.0, 24.0, 20.0),
            half_extents_m: DVec3::new(3.0, 3.0, 20.0),
            yaw_rad: 0.2,
        };
        let step = |k: usize| {
            let (sin, cos) = real::sin_cos(0.05 * k as f64);
            (DVec3::ZERO, DVec3::new(24.0 * cos, 24.0 * sin, 15.0))
        };
        let (watched, places): (Vec<DVec3>, Vec<DVec3>) = (0..120).map(step).unzip();
        let pull = (0..120).map(|k| if k % 60 == 0 { 1.0 } else { 0.02 }).collect();
        let reference = Reference { watched, places, pull };
        let (boxes, exact) = (vec![tower], BoxBvh::build(vec![tower]));
        let mission = mission(&reference, &MucoConfig::default());
        let PlanOutcome::Planned(flight) = plan_request(mission.request(&exact, &boxes, &|_, _| 0.0)) else {
            panic!("no flight");
        };
        assert!(flight.certificate.holds, "{:?}", flight.certificate.violations);
        assert_eq!(reference.marks().collect::<Vec<_>>(), [0, 60]);
        assert!(reference.shortfalls_m(&flight.poses_in_world).iter().all(|miss| *miss < 2.0));
    }
}
