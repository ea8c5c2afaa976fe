//! The populations of a stage `traffic`: one line per kind.

use super::config::TrafficConfig;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::{DVec3, Seed, TargetState, TargetTrack};
use cosfly_maps::{Town, WalkableKind};
use cosfly_pedestrians::{PedestrianError, PedestrianPath, WalkableGrid, walk};
use cosfly_world::{BodyKind, BodyPlan, Clock, Population, Snapshot};

/// All populations, in the order of their numbers: further kinds come last.
pub fn all(config: &TrafficConfig, town: &Town, clock: Clock, seed: Seed) -> Result<Vec<Box<dyn Population>>> {
    Ok(vec![Box::new(Rails::new(config, town, clock, seed).map_err(|error| refusal(error, &town.name))?)])
}

/// Walk along a track, with the ground under it.
pub fn path(_: &Town, _: &TrafficConfig, track: TargetTrack) -> PedestrianPath {
    let standing = track.states.iter().map(|state| state.speed_mps == 0.0).collect();
    PedestrianPath { ground: vec![WalkableKind::Sidewalk; track.len()], standing, track }
}

fn refusal(error: PedestrianError, town: &str) -> Box<Diagnostic> {
    Diagnostic::new("pedestrians-refused", Fault::Input, format!("{error}"))
        .because(format!("in town `{town}`"))
        .hint(error.hint())
}

struct Rails {
    tracks: Vec<TargetTrack>,
    frame: usize,
    step: u32,
    clock: Clock,
    looks: Seed,
}

impl Rails {
    fn new(config: &TrafficConfig, town: &Town, clock: Clock, seed: Seed) -> Result<Self, PedestrianError> {
        let grid = WalkableGrid::build(town, &config.people)?;
        let mut people = config.people.clone();
        (people.steps, people.dt_s) = (config.frames, config.dt_s);
        let track = |number: u64| walk(&grid, &people, seed.child("walk", number)).map(|path| path.track);
        let tracks = (0..people.count).map(track).collect::<Result<_, _>>()?;
        Ok(Self { tracks, frame: 0, step: 0, clock, looks: seed.child("looks", 0) })
    }
}

impl Population for Rails {
    fn plans(&self) -> Vec<BodyPlan> {
        let plan = |(number, track): (u64, &TargetTrack)| BodyPlan {
            source: String::new(),
            kind: BodyKind::Pedestrian,
            size_m: DVec3::new(2.0 * track.radius_m, 2.0 * track.radius_m, track.height_m),
            looks: self.looks.child("body", number),
            group: None,
        };
        (0..).zip(&self.tracks).map(plan).collect()
    }

    fn state(&self, body: usize) -> Option<TargetState> {
        Some(self.tracks[body].states[self.frame])
    }

    fn step(&mut self, _: f64, _: f64, _: &Snapshot) {
        self.step += 1;
        self.frame = (self.step / self.clock.steps_per_frame) as usize;
    }
}
