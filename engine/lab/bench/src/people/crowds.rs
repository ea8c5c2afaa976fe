//! A crowd in a town: its tracks, its cost, and how well it keeps its laws.

use super::{SAMPLE_S, Tracks};
use crate::clock::thread_cpu_s;
use cosfly_domain::{Body, Town, Traffic};
use cosfly_frames::{DVec2, Seed, TargetState};
use cosfly_pedestrians::{Crowd, CrowdConfig, PedestrianError, WalkableGrid, path_of};
use cosfly_world::{Clock, Population, contacts, simulate};
use serde::Serialize;
use std::fmt;
use std::sync::Arc;

/// Who moves but does not come so far in so long is stuck: metres, samples.
const STUCK_M: f64 = 1.0;
const STUCK_SAMPLES: usize = 60;

/// Cost and laws of a simulated crowd.
#[derive(Clone, Debug, Serialize)]
pub struct Crowded {
    /// Name of the town.
    pub town: String,
    /// Number of people.
    pub people: usize,
    /// Number of frames.
    pub frames: u32,
    /// CPU time of the simulation on one core, seconds.
    pub cpu_s: f64,
    /// Pairs of bodies that overlap in some frame.
    pub overlaps: usize,
    /// Steps between frames that leave the walkable ground or touch a thing.
    pub off_ground: usize,
    /// Share of the people who are stuck for 30 s.
    pub stuck: f64,
    /// Share of the time on crossings and on carriageways.
    pub on_crossings: f64,
    /// Share of the time on carriageways.
    pub on_roads: f64,
}

impl fmt::Display for Crowded {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(out, "{}: {} people, {} frames of {SAMPLE_S} s", self.town, self.people, self.frames)?;
        writeln!(
            out,
            "  {:.2} s of CPU time; {} overlaps; {} steps off the ground or into things",
            self.cpu_s, self.overlaps, self.off_ground
        )?;
        write!(
            out,
            "  stuck {:.2} %; time on crossings {:.1} %, on carriageways {:.2} %",
            100.0 * self.stuck,
            100.0 * self.on_crossings,
            100.0 * self.on_roads
        )
    }
}

/// Simulates a crowd of the default config in a town.
///
/// # Errors
/// When the town has no room for it.
pub fn crowded(
    town: &Town,
    config: &CrowdConfig,
    frames: u32,
    seed: u64,
) -> Result<(Crowded, Tracks), PedestrianError> {
    crowded_along(town, config, frames, seed, None)
}

/// The same; where `along` is given, people come along the direction that it gives for their place.
///
/// # Errors
/// When the town has no room for it.
pub fn crowded_along(
    town: &Town,
    config: &CrowdConfig,
    frames: u32,
    seed: u64,
    along: Option<&dyn Fn(DVec2) -> DVec2>,
) -> Result<(Crowded, Tracks), PedestrianError> {
    let grid = Arc::new(Crowd::grid(town, config)?);
    let clock = Clock::new(frames, SAMPLE_S, 0.1);
    let start_s = thread_cpu_s();
    let crowd = Crowd::new(grid.clone(), config, clock, Seed::of_item(seed, "people", &town.name))?;
    let crowd = match along {
        Some(along) => crowd.coming(along),
        None => crowd,
    };
    let mut populations = [Box::new(crowd) as Box<dyn Population>];
    let done = simulate(&mut populations, clock, |_| Ok::<_, std::convert::Infallible>(()));
    let traffic = done.unwrap_or_default();
    let cpu_s = thread_cpu_s() - start_s;
    let mut figures = Crowded {
        town: town.name.clone(),
        people: traffic.bodies.len(),
        frames,
        cpu_s,
        overlaps: contacts(&traffic, 0.0).len(),
        off_ground: traffic.bodies.iter().map(|body| off_ground(&grid, body)).sum(),
        stuck: traffic.bodies.iter().filter(|body| is_stuck(body)).count() as f64 / traffic.bodies.len().max(1) as f64,
        on_crossings: 0.0,
        on_roads: 0.0,
    };
    (figures.on_crossings, figures.on_roads) = on_roads(&grid, &traffic);
    let places = |body: &Body| body.states.iter().map(|state| state.feet_in_world.truncate()).collect::<Vec<DVec2>>();
    let people = traffic.bodies.iter().map(|body| (body.first_frame, places(body))).collect();
    Ok((figures, Tracks { name: "ours".into(), people }))
}

fn off_ground(grid: &WalkableGrid, body: &Body) -> usize {
    let plan = |state: &TargetState| state.feet_in_world.truncate();
    body.states.windows(2).filter(|pair| !grid.step_is_free(plan(&pair[0]), plan(&pair[1]))).count()
}

fn is_stuck(body: &Body) -> bool {
    body.states.windows(STUCK_SAMPLES).any(|states| {
        let moving = states.iter().filter(|state| state.speed_mps > 0.0).count();
        let is_near = |state: &TargetState| (state.feet_in_world - states[0].feet_in_world).length() < STUCK_M;
        2 * moving > STUCK_SAMPLES && states.iter().all(is_near)
    })
}

fn on_roads(grid: &WalkableGrid, traffic: &Traffic) -> (f64, f64) {
    use cosfly_domain::WalkableKind::{Crossing, Road};
    let (mut crossings, mut roads, mut all) = (0, 0, 0);
    for number in 0..traffic.bodies.len() as u32 {
        let Some(track) = traffic.track(number) else { continue };
        let kinds = path_of(Some(grid.ground()), track).ground;
        crossings += kinds.iter().filter(|kind| **kind == Crossing).count();
        roads += kinds.iter().filter(|kind| **kind == Road).count();
        all += kinds.len();
    }
    let share = |count: usize| count as f64 / all.max(1) as f64;
    (share(crossings), share(roads))
}
