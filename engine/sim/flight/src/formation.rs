//! The drones behind the same walk: what twins, pictures and filters of a drone's flight need to know of the others.

use cosfly_domain::{Body, BodyKind, BodyPlan, OrientedBox, Trajectory};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_surroundings::moving::{OtherDrones, drone_boxes};
use serde::{Deserialize, Serialize};

/// Length, width and height of a drone's body in pictures, metres; it lies within the cube that the planner keeps free and
/// looks past.
const BODY_M: DVec3 = DVec3::new(0.6, 0.6, 0.2);

/// All drones behind one walk.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Formation {
    /// Smallest distance from drone to drone, metres.
    pub separation_m: f64,
    /// Place of the flight's own drone in the list.
    pub own: u32,
    /// The drones; `None` where one has no flight.
    pub drones: Vec<Option<Drone>>,
}

/// The flight of one of several drones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drone {
    /// Name of the flight as a dataset has it, such as `expert-p00000-d2`.
    pub flight: String,
    /// Pose in every frame of the walk.
    pub poses_in_world: Vec<Pose>,
}

impl Formation {
    fn others(&self) -> impl Iterator<Item = &Drone> {
        let others = self.drones.iter().enumerate().filter(|(place, _)| *place != self.own as usize);
        others.filter_map(|(_, drone)| drone.as_ref())
    }

    /// Places of the drones that were planned before the own one, frame by frame, world frame, metres.
    pub fn before(&self) -> impl Iterator<Item = Vec<DVec3>> {
        self.drones.iter().take(self.own as usize).flatten().map(Drone::places)
    }

    /// Boxes of the drones that the distances of a flight count, and what is kept from them: those before it, of a perturbed twin all others.
    pub fn counted(&self, flight: &Trajectory) -> (Vec<Vec<OrientedBox>>, OtherDrones) {
        let mut boxes = vec![];
        let kept = self.join(&mut boxes);
        if flight.perturbation.is_some() {
            return (boxes, kept);
        }
        boxes = self.before().map(|places| drone_boxes(&places)).collect();
        let count = boxes.len();
        (boxes, OtherDrones { count, ..kept })
    }

    /// Adds the boxes of all other drones to those that move; says what is kept from them.
    pub fn join(&self, movers: &mut Vec<Vec<OrientedBox>>) -> OtherDrones {
        let count = self.others().count();
        movers.extend(self.others().map(|drone| drone_boxes(&drone.places())));
        OtherDrones { count, separation_m: self.separation_m }
    }

    /// All other drones as bodies, with their numbers behind the walk.
    pub fn bodies(&self, dt_s: f64) -> impl Iterator<Item = (u32, Body)> {
        let body = move |(number, drone): (u32, &Option<Drone>)| {
            let drone = drone.as_ref().filter(|_| number != self.own)?;
            let (source, looks) = (drone.flight.clone(), Seed([0; 32]).child("drone", u64::from(number)));
            let plan = BodyPlan { source, kind: BodyKind::Drone, size_m: BODY_M, looks, group: None };
            Some((number, Body { plan, first_frame: 0, states: drone.states(dt_s) }))
        };
        (0..).zip(&self.drones).filter_map(body)
    }
}

impl Drone {
    fn places(&self) -> Vec<DVec3> {
        self.poses_in_world.iter().map(|pose| pose.position_in_world).collect()
    }

    /// Foot of the body, its heading, and its speed up to the next frame.
    fn states(&self, dt_s: f64) -> Vec<TargetState> {
        let poses = &self.poses_in_world;
        let speed_mps = |frame: usize| {
            let first = frame.min(poses.len().saturating_sub(2));
            let way = |pair: &[Pose]| (pair[1].position_in_world - pair[0].position_in_world).length() / dt_s;
            poses.get(first..first + 2).map_or(0.0, way)
        };
        let state = |(frame, pose): (usize, &Pose)| TargetState {
            feet_in_world: pose.position_in_world - DVec3::Z * (0.5 * BODY_M.z),
            heading_rad: pose.yaw_rad,
            speed_mps: speed_mps(frame),
        };
        poses.iter().enumerate().map(state).collect()
    }
}
