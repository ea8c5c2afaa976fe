//! A film of every n-th frame, or of moments between frames: what a camera with a rate or an offset of its own takes, and the flight
//! as its film has it.

use crate::Shooting;
use crate::walks::{BodyOnTrack, walked_m};
use cosfly_domain::{Around, FramePerturbation, OrientedBox, Trajectory};
use cosfly_frames::{Pose, TargetState, TargetTrack, real};
use cosfly_geometry::SpatialQuery;
use cosfly_optics::{pose_at, target_state_at};
use cosfly_render::{Moment, RenderConfig};
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::moving::OtherDrones;

/// Largest distance from obstacles that is stated, metres.
const CLEARANCE_CAP_M: f64 = 50.0;

/// The moments of a film: frames of the flight, and a time after each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    first: usize,
    every: usize,
    /// Time after each frame, less than that between two, seconds.
    after_s: f64,
    dt_s: f64,
}

impl Rate {
    /// The moments that a camera films along a flight with `dt_s` between its frames.
    pub fn of(config: &RenderConfig, dt_s: f64) -> Self {
        let offset_s = config.begins_ns as f64 / 1e9;
        // A nanosecond before a frame is that frame.
        let first = ((offset_s + 1e-9) / dt_s).floor();
        let after_s = offset_s - first * dt_s;
        let after_s = if after_s > 1e-9 { after_s } else { 0.0 };
        Self { first: first as usize, every: config.every.max(1) as usize, after_s, dt_s }
    }

    /// Time between frames of the film where those of the flight are `dt_s` apart, seconds: without the last digits of the product, so that
    /// three steps of 0.2 s are 0.6 s and not 0.6000000000000001 s.
    fn step_s(&self, dt_s: f64) -> f64 {
        match self.every {
            1 => dt_s,
            every => (dt_s * every as f64 * 1e12).round_ties_even() / 1e12,
        }
    }

    /// Whether the film has the flight's frames, all of them.
    fn is_whole(&self) -> bool {
        (self.first, self.every, self.after_s) == (0, 1, 0.0)
    }

    /// Number of frames after which there is a flight of `frames` frames at the time of the film.
    fn count(&self, frames: usize) -> usize {
        frames - usize::from(self.after_s > 0.0 && frames > 0)
    }

    /// Frames of a flight of `frames` frames that the film has.
    pub fn frames(&self, frames: usize) -> impl Iterator<Item = usize> + use<> {
        (self.first..self.count(frames)).step_by(self.every)
    }

    /// Place among the frames of the flight, some seconds after a frame of the film.
    pub fn at(&self, frame: usize, offset_s: f64) -> f64 {
        frame as f64 + (self.after_s + offset_s) / self.dt_s
    }

    /// Time of a frame of the film since the flight's first frame, seconds.
    pub fn time_s(&self, frame: usize) -> f64 {
        frame as f64 * self.dt_s + self.after_s
    }

    /// State of the target in a frame of the film.
    pub fn state(&self, track: &TargetTrack, frame: usize) -> TargetState {
        if self.after_s > 0.0 { target_state_at(&track.states, self.at(frame, 0.0)) } else { track.states[frame] }
    }

    /// Pose in a frame of the film.
    fn pose(&self, poses: &[Pose], frame: usize) -> Pose {
        if self.after_s > 0.0 { pose_at(poses, self.at(frame, 0.0)) } else { poses[frame] }
    }

    /// Keeps those of the flight's frames that the film has.
    fn thin<T>(&self, all: &mut Vec<T>) {
        let mut place = 0..;
        all.truncate(self.count(all.len()));
        all.retain(|_| {
            place.next().is_some_and(|it: usize| it >= self.first && (it - self.first).is_multiple_of(self.every))
        });
    }
}

/// The moments of a flight that a camera films.
pub struct FilmedFlight<'a> {
    shooting: &'a Shooting,
    track: &'a TargetTrack,
    /// Poses of the drone in all frames of the flight.
    poses: &'a [Pose],
    walked_m: Vec<f64>,
    rate: Rate,
}

impl<'a> FilmedFlight<'a> {
    /// The film of a flight as the settings of a camera ask.
    pub fn new(shooting: &'a Shooting, flight: &'a Trajectory, config: &RenderConfig) -> Self {
        let (rate, walked_m) = (Rate::of(config, flight.track.dt_s), walked_m(&flight.track.states));
        Self { shooting, track: &flight.track, poses: &flight.poses_in_world, walked_m, rate }
    }

    /// Pose of the camera some seconds after a frame of the film: of its mount on the drone, whose place and angles change evenly. Angles
    /// of a camera that looks straight down jump from frame to frame, those of the drone do not.
    pub fn pose(&self, frame: usize, offset_s: f64) -> Pose {
        self.shooting.mount.camera_pose(&pose_at(self.poses, self.rate.at(frame, offset_s)))
    }

    /// Frames of the flight that the film has.
    pub fn frames(&self) -> impl Iterator<Item = usize> + use<> {
        self.rate.frames(self.track.len())
    }

    /// Poses of the camera, one per frame of the film.
    pub fn poses(&self) -> impl Iterator<Item = Pose> {
        self.frames().map(|frame| self.pose(frame, 0.0))
    }

    /// Frame of the flight before a frame of the film; none before the first one.
    pub fn before(&self, frame: usize) -> Option<usize> {
        frame.checked_sub(self.rate.every).filter(|before| *before >= self.rate.first)
    }

    /// Frame of the flight after a frame of the film; none after the last one.
    pub fn after(&self, frame: usize) -> Option<usize> {
        Some(frame + self.rate.every).filter(|next| *next < self.rate.count(self.track.len()))
    }

    /// Time between frames of the film, seconds.
    pub fn dt_s(&self) -> f64 {
        self.rate.step_s(self.track.dt_s)
    }

    /// Time of a frame of the film since the flight's first frame, seconds.
    pub fn time_s(&self, frame: usize) -> f64 {
        self.rate.time_s(frame)
    }

    /// Camera and target some seconds after a frame of the film.
    pub fn moment(&self, frame: usize, offset_s: f64) -> Moment {
        let at = self.rate.at(frame, offset_s);
        let state = target_state_at(&self.track.states, at);
        let way_m = self.walked_m[frame] + (self.rate.after_s + offset_s) * state.speed_mps;
        let target = self.shooting.target(self.track, state, way_m);
        // A target without extent is a point: it is watched, not drawn.
        Moment { pose: self.pose(frame, offset_s), target: Some(target).filter(|target| target.radius_m > 0.0) }
    }
}

/// The flight as a film has it: every n-th frame, or moments between frames. Means and lengths of the certificate are those of the film's
/// frames; limits, and what was measured against them between frames, stay those of the flight. `boxes`, `around` and `drones` are what
/// stands and moves there.
pub fn filmed_flight(
    mut flight: Trajectory,
    config: &RenderConfig,
    boxes: &dyn SpatialQuery,
    (around, (drones, kept)): (&Around, (Vec<Vec<OrientedBox>>, OtherDrones)),
) -> Trajectory {
    let rate = Rate::of(config, flight.track.dt_s);
    if rate.is_whole() {
        return flight;
    }
    if rate.after_s > 0.0 {
        let mut movers = later_around(around, rate.after_s).boxes();
        let between = |pair: &[OrientedBox]| {
            let center_in_world = pair[0].center_in_world.lerp(pair[1].center_in_world, rate.after_s / rate.dt_s);
            OrientedBox { center_in_world, ..pair[0] }
        };
        movers.extend(drones.iter().map(|places| places.windows(2).map(between).collect()));
        let clearance_m = flight.certificate.limits.clearance_m;
        be_later(&mut flight, &rate, ExactMap { drones: kept, clearance_m, ..ExactMap::among(boxes, &movers) });
    }
    flight.track.dt_s = rate.step_s(flight.track.dt_s);
    // What was seen first since the frame before.
    let frames = rate.frames(flight.coverage.len()).count();
    let (start, rest) = flight.coverage.split_at(flight.coverage.len().min(rate.first + 1));
    let stretches = start.chunks(rate.first + 1).chain(rest.chunks_exact(rate.every)).take(frames);
    flight.coverage = stretches.map(|stretch| stretch.iter().sum()).collect();
    flight.labels.iter_mut().for_each(|label| rate.thin(&mut label.per_frame));
    for term in &mut flight.terms {
        rate.thin(&mut term.per_frame);
        term.sum = term.per_frame.iter().sum();
    }
    rate.thin(&mut flight.track.states);
    rate.thin(&mut flight.poses_in_world);
    rate.thin(&mut flight.visibility);
    rate.thin(&mut flight.clearance_m);
    if let Some(twin) = &mut flight.perturbation {
        rate.thin(&mut twin.frames);
        let of_film = |frame: u32| frame.saturating_sub(rate.first as u32) / rate.every as u32;
        twin.frames.iter_mut().for_each(|frame| frame.expert_frame = of_film(frame.expert_frame));
    }
    measure_frames(&mut flight);
    flight
}

/// Puts what has a place in the world where it is some time after each frame but the last. Costs and labels stay those of the frame.
fn be_later(flight: &mut Trajectory, rate: &Rate, map: ExactMap<'_>) {
    let (frames, track) = (0..rate.count(flight.poses_in_world.len()), &flight.track);
    let wrapped = |pose: Pose| Pose { yaw_rad: real::wrap_angle_rad(pose.yaw_rad), ..pose };
    let poses = frames.clone().map(|frame| wrapped(rate.pose(&flight.poses_in_world, frame)));
    let wrapped = |state: TargetState| TargetState { heading_rad: real::wrap_angle_rad(state.heading_rad), ..state };
    let states = frames.clone().map(|frame| wrapped(rate.state(track, frame)));
    let (poses, states): (Vec<Pose>, Vec<TargetState>) = (poses.collect(), states.collect());
    for frame in frames {
        let (place, state) = (poses[frame].position_in_world, &states[frame]);
        flight.visibility[frame] = map.visibility(frame, place, state, track.height_m);
        flight.clearance_m[frame] = map.nearest(frame, place, CLEARANCE_CAP_M).map_or(CLEARANCE_CAP_M, |near| near.0);
    }
    // The last ones leave with the frames that the film does not have.
    flight.track.states.splice(..states.len(), states);
    flight.poses_in_world.splice(..poses.len(), poses);
    if let Some(twin) = &mut flight.perturbation {
        let share = rate.after_s / rate.dt_s;
        for frame in 1..twin.frames.len() {
            let next = twin.frames[frame];
            let own = &mut twin.frames[frame - 1];
            *own = FramePerturbation {
                position: own.position || next.position,
                rotation: own.rotation || next.rotation,
                drone_offset_in_world: own.drone_offset_in_world.lerp(next.drone_offset_in_world, share),
                aim_offset_in_world: own.aim_offset_in_world.lerp(next.aim_offset_in_world, share),
                pitch_offset_rad: own.pitch_offset_rad + share * (next.pitch_offset_rad - own.pitch_offset_rad),
                yaw_offset_rad: own.yaw_offset_rad + share * (next.yaw_offset_rad - own.yaw_offset_rad),
                ..*own
            };
        }
    }
}

/// Works out those figures of the certificate that follow from the frames.
fn measure_frames(flight: &mut Trajectory) {
    let Trajectory { track, poses_in_world: poses, visibility, certificate, .. } = flight;
    let frames = poses.len().max(1) as f64;
    let places = || poses.iter().map(|pose| pose.position_in_world);
    let turned_deg = |angle: fn(&Pose) -> f64| {
        let turns = poses.windows(2).map(|pair| real::wrap_angle_rad(angle(&pair[1]) - angle(&pair[0])).abs());
        turns.map(f64::to_degrees).fold(0.0, f64::max) / track.dt_s
    };
    certificate.mean_visibility = visibility.iter().sum::<f64>() / frames;
    certificate.frames_half_visible = visibility.iter().filter(|share| **share >= 0.5).count() as f64 / frames;
    certificate.mean_distance_m =
        places().zip(&track.states).map(|(place, state)| place.distance(state.feet_in_world)).sum::<f64>() / frames;
    certificate.length_m = places().zip(places().skip(1)).map(|(from, to)| to.distance(from)).sum();
    certificate.max_yaw_rate_deg_s = turned_deg(|pose| pose.yaw_rad);
    certificate.max_pitch_rate_deg_s = turned_deg(|pose| pose.pitch_rad);
}

/// Bodies of traffic around a flight, by the frames of a film.
pub fn filmed_around(around: &Around, config: &RenderConfig) -> Around {
    let rate = Rate::of(config, around.traffic.dt_s);
    if rate.is_whole() || around.traffic.bodies.is_empty() {
        return around.clone();
    }
    let mut film = if rate.after_s > 0.0 { later_around(around, rate.after_s) } else { around.clone() };
    let (first, n) = (rate.first as u32, rate.every as u32);
    film.traffic.dt_s = rate.step_s(film.traffic.dt_s);
    film.traffic.frames = film.traffic.frames.saturating_sub(first).div_ceil(n);
    for body in &mut film.traffic.bodies {
        let own = body.first_frame.saturating_sub(first).div_ceil(n);
        body.states.drain(..body.states.len().min((own * n + first - body.first_frame) as usize));
        body.first_frame = own;
        let mut place = 0..;
        body.states.retain(|_| place.next().is_some_and(|it: usize| it.is_multiple_of(rate.every)));
    }
    present(film)
}

/// Bodies of traffic some time after each frame but the last.
fn later_around(around: &Around, after_s: f64) -> Around {
    let mut later = around.clone();
    let traffic = &mut later.traffic;
    traffic.frames = traffic.frames.saturating_sub(1);
    for body in &mut traffic.bodies {
        let person = BodyOnTrack::of(body, traffic.dt_s);
        let state = |frame: u32| person.state(f64::from(frame) * traffic.dt_s + after_s);
        body.first_frame = (0..traffic.frames).find(|frame| state(*frame).is_some()).unwrap_or_default();
        body.states = (0..traffic.frames).filter_map(state).collect();
    }
    present(later)
}

/// Leaves out bodies that no frame has.
fn present(mut around: Around) -> Around {
    let kept: Vec<bool> = around.traffic.bodies.iter().map(|body| !body.states.is_empty()).collect();
    let mut places = kept.iter();
    around.numbers.retain(|_| places.next() == Some(&true));
    around.traffic.bodies.retain(|body| !body.states.is_empty());
    around
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{Body, BodyKind, BodyPlan, Certificate, Mount, Traffic};
    use cosfly_frames::{DVec3, Seed};
    use cosfly_geometry::BoxBvh;
    use cosfly_surroundings::moving::drone_boxes;

    fn state(x: f64) -> TargetState {
        TargetState { feet_in_world: DVec3::X * x, heading_rad: 0.0, speed_mps: 1.0 }
    }

    fn every(every: u32) -> RenderConfig {
        RenderConfig { every, ..RenderConfig::default() }
    }

    fn nothing() -> BoxBvh {
        BoxBvh::build(vec![])
    }

    #[test]
    fn three_steps_of_a_fifth_of_a_second_are_three_fifths() {
        let step_s = |n: u32, dt_s: f64| Rate::of(&every(n), dt_s).step_s(dt_s);
        assert_eq!([step_s(3, 0.2), step_s(1, 0.1 + 0.2), step_s(7, 0.2)], [0.6, 0.1 + 0.2, 1.4]);
        assert!((step_s(7, 1.0 / 30.0) - 7.0 / 30.0).abs() < 1e-12);
    }

    fn flight(poses_in_world: Vec<Pose>) -> Trajectory {
        Trajectory {
            track: TargetTrack {
                dt_s: 0.5,
                height_m: 1.8,
                radius_m: 0.3,
                states: (0..8).map(|k| state(f64::from(k))).collect(),
            },
            poses_in_world,
            visibility: vec![1.0, 0.0, 0.0, 0.25, 0.0, 0.0, 1.0, 0.0],
            clearance_m: vec![2.0; 8],
            terms: vec![],
            coverage: (1..=8).map(f64::from).collect(),
            labels: vec![],
            convergence: vec![],
            certificate: Certificate { max_speed_mps: 2.0, ..Certificate::default() },
            perturbation: None,
        }
    }

    #[test]
    fn a_camera_that_looks_down_turns_with_the_drone_between_frames() {
        let pose = |k: u32| Pose {
            position_in_world: DVec3::new(f64::from(k), 0.0, 30.0),
            pitch_rad: -0.5,
            yaw_rad: 0.2 * f64::from(k),
            roll_rad: if k.is_multiple_of(2) { 0.1 } else { -0.1 },
        };
        let flight = flight((0..8).map(pose).collect());
        let mut shooting = Shooting::plain(Seed::of_item(1, "pedestrians", "p00000"));
        shooting.mount = Mount { pitch_rad: -1.05, levelled: false, ..Mount::default() };
        let film = FilmedFlight::new(&shooting, &flight, &every(1));
        // Angles of the camera jump between the first two frames, by more than a quarter of a turn: it looks past straight down.
        let poses = shooting.poses(&flight);
        assert!(real::wrap_angle_rad(poses[1].yaw_rad - poses[0].yaw_rad).abs() > 1.5, "{poses:?}");
        let turned_rad = |from_s: f64, to_s: f64| {
            let axes = [from_s, to_s].map(|offset_s| film.pose(0, offset_s).world_from_body());
            let [x, y, z] = [0, 1, 2].map(|column| axes[0].col(column).distance_squared(axes[1].col(column)));
            2.0 * real::asin((0.125 * (x + y + z)).sqrt())
        };
        let whole_rad = turned_rad(0.0, 0.5);
        let step_rad = |k: u32| turned_rad(0.05 * f64::from(k), 0.05 * f64::from(k + 1));
        assert!((0..10).all(|k| (step_rad(k) - 0.1 * whole_rad).abs() < 0.02 * whole_rad), "{whole_rad}");
        assert_eq!(film.pose(3, 0.0), poses[3]);
    }

    #[test]
    fn a_film_of_every_third_frame_has_the_flight_s_own_frames_and_its_own_figures() {
        let pose = |k: u32| Pose {
            position_in_world: DVec3::new(f64::from(k), 0.0, 5.0),
            pitch_rad: 0.0,
            yaw_rad: 0.1 * f64::from(k % 2),
            roll_rad: 0.0,
        };
        let flight = flight((0..8).map(pose).collect());
        let film = filmed_flight(
            flight.clone(),
            &every(3),
            &nothing(),
            (&Around::default(), (vec![], OtherDrones::default())),
        );
        assert_eq!((film.track.dt_s, &film.visibility[..]), (1.5, &[1.0, 0.25, 1.0][..]));
        assert!(film.poses_in_world.iter().eq([0, 3, 6].map(|k| &flight.poses_in_world[k])));
        assert_eq!(film.coverage, [1.0, 2.0 + 3.0 + 4.0, 5.0 + 6.0 + 7.0]);
        let it = &film.certificate;
        assert_eq!((it.mean_visibility, it.length_m, it.max_speed_mps), (0.75, 6.0, 2.0));
        assert!((it.frames_half_visible - 2.0 / 3.0).abs() < 1e-12 && (it.mean_distance_m - 5.0).abs() < 1e-12);
        assert!((it.max_yaw_rate_deg_s - 0.1f64.to_degrees() / 1.5).abs() < 1e-9);
        assert_eq!(
            filmed_flight(
                flight.clone(),
                &every(1),
                &nothing(),
                (&Around::default(), (vec![], OtherDrones::default()))
            ),
            flight
        );
        // Between frames, the drone beside it is where it is then: 4 m aside, less half its box.
        let places: Vec<DVec3> = (0..8).map(|k| DVec3::new(f64::from(k), 4.0, 5.0)).collect();
        let drones = (vec![drone_boxes(&places)], OtherDrones { count: 1, separation_m: 0.0 });
        let late = RenderConfig { begins_ns: 250_000_000, ..RenderConfig::default() };
        let film = filmed_flight(flight, &late, &nothing(), (&Around::default(), drones));
        assert!(film.clearance_m.len() == 7 && film.clearance_m.iter().all(|it| (it - 3.7).abs() < 1e-9), "{film:?}");
    }

    #[test]
    fn bodies_are_there_in_the_frames_of_the_film_in_which_they_are_there() {
        let (size_m, looks) = (DVec3::new(0.5, 0.5, 1.8), Seed([0; 32]));
        let plan = BodyPlan { source: String::new(), kind: BodyKind::Pedestrian, size_m, looks, group: None };
        let body = |first_frame: u32, count: u32| {
            let states = (first_frame..first_frame + count).map(|frame| state(f64::from(frame))).collect();
            Body { plan: plan.clone(), first_frame, states }
        };
        let bodies = vec![body(0, 9), body(4, 2), body(2, 5), body(7, 1)];
        let traffic = Traffic { dt_s: 0.5, frames: 9, bodies, ..Traffic::default() };
        let film = filmed_around(&Around { numbers: vec![5, 6, 7, 8], traffic }, &every(3));
        assert_eq!((film.numbers, film.traffic.frames, film.traffic.dt_s), (vec![5, 7], 3, 1.5));
        let found =
            film.traffic.bodies.iter().map(|body| (body.first_frame, body.states.iter().map(|it| it.feet_in_world.x)));
        let found: Vec<(u32, Vec<f64>)> = found.map(|(first, places)| (first, places.collect())).collect();
        assert_eq!(found, [(0, vec![0.0, 3.0, 6.0]), (1, vec![3.0, 6.0])]);
    }
}
