//! [`Population`]: a group of bodies that move by one rule, and [`simulate`], which steps several of them together.

use crate::snapshot::Snapshot;
use cosfly_domain::{Body, BodyPlan, Traffic};
use cosfly_frames::TargetState;
use std::ops::Range;

/// Frames and the steps between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Number of frames.
    pub frames: u32,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Steps from one frame to the next, at least 1.
    pub steps_per_frame: u32,
}

impl Clock {
    /// Frames of `dt_s` seconds with as few equal steps between them as keep a step to `longest_step_s`.
    pub fn new(frames: u32, dt_s: f64, longest_step_s: f64) -> Self {
        Self { frames, dt_s, steps_per_frame: (dt_s / longest_step_s - 1e-9).ceil().max(1.0) as u32 }
    }

    /// Length of a step, seconds.
    pub fn step_s(&self) -> f64 {
        self.dt_s / f64::from(self.steps_per_frame)
    }
}

/// A group of bodies that move by one rule: a crowd, vehicles on lanes, recorded tracks.
///
/// The bodies of all populations are numbered through; the first number of each is given to [`Population::begin`]. A state of the
/// next moment may depend on the snapshot of the present one, on the population's own memory and on seeds, on nothing else.
pub trait Population {
    /// Properties that do not change, one entry per body that is ever present.
    fn plans(&self) -> Vec<BodyPlan>;

    /// Learns the number of the first own body.
    fn begin(&mut self, first_number: u32) {
        let _ = first_number;
    }

    /// Present state of an own body, counted from 0; `None` where it is absent. A body that left never comes back.
    fn state(&self, body: usize) -> Option<TargetState>;

    /// Moves on by one step; `time_s` is the present time since frame 0, `everybody` holds all bodies at that time.
    fn step(&mut self, time_s: f64, step_s: f64, everybody: &Snapshot);

    /// Assumptions and omissions, in words.
    fn notes(&self) -> Vec<String> {
        vec![]
    }
}

/// Steps populations together and records every frame. `check` is called before each frame and may stop the simulation.
///
/// # Errors
/// Those of `check`.
pub fn simulate<E>(
    populations: &mut [Box<dyn Population>],
    clock: Clock,
    mut check: impl FnMut(u32) -> Result<(), E>,
) -> Result<Traffic, E> {
    let mut bodies: Vec<Body> = vec![];
    let mut ranges: Vec<Range<usize>> = vec![];
    for population in populations.iter_mut() {
        let first = bodies.len();
        population.begin(first as u32);
        bodies.extend(population.plans().into_iter().map(|plan| Body { plan, first_frame: 0, states: vec![] }));
        ranges.push(first..bodies.len());
    }
    let mut everybody = Snapshot::default();
    for frame in 0..clock.frames {
        check(frame)?;
        for (population, range) in populations.iter().zip(&ranges) {
            for (own, body) in bodies[range.clone()].iter_mut().enumerate() {
                let Some(state) = population.state(own) else { continue };
                if body.states.is_empty() {
                    body.first_frame = frame;
                }
                // A body that comes back would leave a hole in its track.
                if body.end_frame() == frame || body.states.is_empty() {
                    body.states.push(state);
                }
            }
        }
        if frame + 1 == clock.frames {
            break;
        }
        for step in 0..clock.steps_per_frame {
            let time_s = f64::from(frame) * clock.dt_s + f64::from(step) * clock.step_s();
            everybody.refill(|list| {
                for (population, range) in populations.iter().zip(&ranges) {
                    let present = |own: usize| {
                        let number = range.start + own;
                        Some(Snapshot::present(number as u32, &bodies[number].plan, population.state(own)?))
                    };
                    list.extend((0..range.len()).filter_map(present));
                }
            });
            for population in populations.iter_mut() {
                population.step(time_s, clock.step_s(), &everybody);
            }
        }
    }
    let notes = populations.iter().flat_map(|population| population.notes()).collect();
    Ok(Traffic { name: String::new(), dt_s: clock.dt_s, frames: clock.frames, bodies, notes })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::BodyKind;
    use cosfly_frames::{DVec3, Seed};

    /// Bodies on a line that each go half of the way to the mean place of all others.
    struct Meeting {
        places_m: Vec<f64>,
        first: u32,
    }

    impl Population for Meeting {
        fn plans(&self) -> Vec<BodyPlan> {
            let plan = BodyPlan {
                source: String::new(),
                kind: BodyKind::Pedestrian,
                size_m: DVec3::splat(0.5),
                looks: Seed([0; 32]),
                group: None,
            };
            vec![plan; self.places_m.len()]
        }

        fn begin(&mut self, first_number: u32) {
            self.first = first_number;
        }

        fn state(&self, body: usize) -> Option<TargetState> {
            let feet_in_world = DVec3::X * self.places_m[body];
            Some(TargetState { feet_in_world, heading_rad: 0.0, speed_mps: 0.0 })
        }

        fn step(&mut self, _: f64, _: f64, everybody: &Snapshot) {
            for (number, place_m) in (self.first..).zip(&mut self.places_m) {
                let others = everybody.all().iter().filter(|body| body.number != number);
                let sum: f64 = others.map(|body| body.state.feet_in_world.x).sum();
                *place_m = 0.5 * (*place_m + sum / (everybody.all().len() - 1) as f64);
            }
        }
    }

    #[test]
    fn populations_see_one_moment_whatever_their_order() {
        let run = |lists: [Vec<f64>; 2]| {
            let mut populations = lists.map(|places_m| Box::new(Meeting { places_m, first: 0 }) as Box<dyn Population>);
            let clock = Clock::new(4, 0.5, 0.25);
            simulate(&mut populations, clock, |_| Ok::<_, ()>(())).unwrap()
        };
        let (one, other) = (run([vec![0.0, 4.0], vec![8.0]]), run([vec![8.0], vec![0.0, 4.0]]));
        assert_eq!((one.frames, one.bodies.len(), one.bodies[0].states.len()), (4, 3, 4));
        assert_eq!(one.bodies[2], other.bodies[0]);
        assert_eq!(one.bodies[..2], other.bodies[1..]);
        assert_ne!(one.bodies[0].states[0], one.bodies[0].states[1]);
    }

    #[test]
    fn steps_are_equal_and_no_longer_than_asked() {
        let steps = [0.04, 0.1, 0.5, 0.51].map(|dt_s| Clock::new(2, dt_s, 0.1).steps_per_frame);
        assert_eq!(steps, [1, 1, 5, 6]);
    }
}
