//! A film of every n-th frame: the moments that a camera with a rate of its own takes, and the flight as its film has it.

use crate::Shooting;
use crate::walks::walked_m;
use cosfly_domain::{Around, Trajectory};
use cosfly_frames::{Pose, TargetTrack, real};
use cosfly_optics::{pose_at, target_state_at};
use cosfly_render::Moment;

/// The moments of a flight that a camera films.
pub struct FilmedFlight<'a> {
    shooting: &'a Shooting,
    track: &'a TargetTrack,
    /// Poses of the camera in all frames of the flight.
    poses: Vec<Pose>,
    walked_m: Vec<f64>,
    every: usize,
}

impl<'a> FilmedFlight<'a> {
    /// The film of every n-th frame of a flight.
    pub fn new(shooting: &'a Shooting, flight: &'a Trajectory, every: u32) -> Self {
        let (poses, walked_m) = (shooting.poses(flight), walked_m(&flight.track.states));
        Self { shooting, track: &flight.track, poses, walked_m, every: every.max(1) as usize }
    }

    /// Frames of the flight that the film has.
    pub fn frames(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.track.len()).step_by(self.every)
    }

    /// Poses of the camera, one per frame of the film.
    pub fn poses(&self) -> impl Iterator<Item = &Pose> {
        self.poses.iter().step_by(self.every)
    }

    /// Frame of the flight before a frame of the film; none before the first one.
    pub fn before(&self, frame: usize) -> Option<usize> {
        frame.checked_sub(self.every)
    }

    /// Frame of the flight after a frame of the film; none after the last one.
    pub fn after(&self, frame: usize) -> Option<usize> {
        Some(frame + self.every).filter(|next| *next < self.track.len())
    }

    /// Time between frames of the film, seconds.
    pub fn dt_s(&self) -> f64 {
        self.track.dt_s * self.every as f64
    }

    /// Time of a frame of the flight since the first one, seconds.
    pub fn time_s(&self, frame: usize) -> f64 {
        frame as f64 * self.track.dt_s
    }

    /// Camera and target some seconds after a frame of the flight.
    pub fn moment(&self, frame: usize, offset_s: f64) -> Moment {
        let at = frame as f64 + offset_s / self.track.dt_s;
        let state = target_state_at(&self.track.states, at);
        let target = self.shooting.target(self.track, state, self.walked_m[frame] + offset_s * state.speed_mps);
        // A target without extent is a point: it is watched, not drawn.
        Moment { pose: pose_at(&self.poses, at), target: Some(target).filter(|target| target.radius_m > 0.0) }
    }
}

/// The flight as a film of every n-th frame has it. Means and lengths of the certificate are those of the film's frames; limits, and what
/// was measured against them between frames, stay those of the flight.
pub fn filmed_flight(mut flight: Trajectory, every: u32) -> Trajectory {
    let n = every.max(1) as usize;
    if n == 1 {
        return flight;
    }
    flight.track.dt_s *= n as f64;
    thin(&mut flight.track.states, n);
    thin(&mut flight.poses_in_world, n);
    thin(&mut flight.visibility, n);
    thin(&mut flight.clearance_m, n);
    flight.labels.iter_mut().for_each(|label| thin(&mut label.per_frame, n));
    for term in &mut flight.terms {
        thin(&mut term.per_frame, n);
        term.sum = term.per_frame.iter().sum();
    }
    // What was seen first since the frame before.
    let (first, rest) = flight.coverage.split_at(flight.coverage.len().min(1));
    let rest = rest.chunks_exact(n).map(|stretch| stretch.iter().sum());
    flight.coverage = first.iter().copied().chain(rest).collect();
    if let Some(twin) = &mut flight.perturbation {
        thin(&mut twin.frames, n);
        twin.frames.iter_mut().for_each(|frame| frame.expert_frame /= every);
    }
    measure_frames(&mut flight);
    flight
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
pub fn filmed_around(around: &Around, every: u32) -> Around {
    let n = every.max(1);
    let mut film = around.clone();
    if n == 1 {
        return film;
    }
    film.traffic.dt_s *= f64::from(n);
    film.traffic.frames = film.traffic.frames.div_ceil(n);
    for body in &mut film.traffic.bodies {
        let first_frame = body.first_frame.div_ceil(n);
        body.states.drain(..body.states.len().min((first_frame * n - body.first_frame) as usize));
        body.first_frame = first_frame;
        thin(&mut body.states, n as usize);
    }
    let kept: Vec<bool> = film.traffic.bodies.iter().map(|body| !body.states.is_empty()).collect();
    let mut places = kept.iter();
    film.numbers.retain(|_| places.next() == Some(&true));
    film.traffic.bodies.retain(|body| !body.states.is_empty());
    film
}

/// Keeps the first of each `n`.
fn thin<T>(all: &mut Vec<T>, n: usize) {
    let mut place = 0..;
    all.retain(|_| place.next().is_some_and(|place| place % n == 0));
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{Body, BodyKind, BodyPlan, Certificate, Traffic};
    use cosfly_frames::{DVec3, Seed, TargetState};

    fn state(x: f64) -> TargetState {
        TargetState { feet_in_world: DVec3::X * x, heading_rad: 0.0, speed_mps: 1.0 }
    }

    #[test]
    fn a_film_of_every_third_frame_has_the_flight_s_own_frames_and_its_own_figures() {
        let pose = |k: u32| Pose {
            position_in_world: DVec3::new(f64::from(k), 0.0, 5.0),
            pitch_rad: 0.0,
            yaw_rad: 0.1 * f64::from(k % 2),
            roll_rad: 0.0,
        };
        let flight = Trajectory {
            track: TargetTrack {
                dt_s: 0.5,
                height_m: 1.8,
                radius_m: 0.3,
                states: (0..8).map(|k| state(f64::from(k))).collect(),
            },
            poses_in_world: (0..8).map(pose).collect(),
            visibility: vec![1.0, 0.0, 0.0, 0.25, 0.0, 0.0, 1.0, 0.0],
            clearance_m: vec![2.0; 8],
            terms: vec![],
            coverage: (1..=8).map(f64::from).collect(),
            labels: vec![],
            convergence: vec![],
            certificate: Certificate { max_speed_mps: 2.0, ..Certificate::default() },
            perturbation: None,
        };
        let film = filmed_flight(flight.clone(), 3);
        assert_eq!((film.track.dt_s, &film.visibility[..]), (1.5, &[1.0, 0.25, 1.0][..]));
        assert!(film.poses_in_world.iter().eq([0, 3, 6].map(|k| &flight.poses_in_world[k])));
        assert_eq!(film.coverage, [1.0, 2.0 + 3.0 + 4.0, 5.0 + 6.0 + 7.0]);
        let it = &film.certificate;
        assert_eq!((it.mean_visibility, it.length_m, it.max_speed_mps), (0.75, 6.0, 2.0));
        assert!((it.frames_half_visible - 2.0 / 3.0).abs() < 1e-12 && (it.mean_distance_m - 5.0).abs() < 1e-12);
        assert!((it.max_yaw_rate_deg_s - 0.1f64.to_degrees() / 1.5).abs() < 1e-9);
        assert_eq!(filmed_flight(flight.clone(), 1), flight);
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
        let film = filmed_around(&Around { numbers: vec![5, 6, 7, 8], traffic }, 3);
        assert_eq!((film.numbers, film.traffic.frames, film.traffic.dt_s), (vec![5, 7], 3, 1.5));
        let found =
            film.traffic.bodies.iter().map(|body| (body.first_frame, body.states.iter().map(|it| it.feet_in_world.x)));
        let found: Vec<(u32, Vec<f64>)> = found.map(|(first, places)| (first, places.collect())).collect();
        assert_eq!(found, [(0, vec![0.0, 3.0, 6.0]), (1, vec![3.0, 6.0])]);
    }
}
