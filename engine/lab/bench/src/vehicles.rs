//! How simulated vehicles drive: speeds and accelerations by kind, from their places in frames alone.

use crate::clock::thread_cpu_s;
use cosfly_domain::{Body, BodyKind, Town};
use cosfly_frames::{DVec2, Seed};
use cosfly_vehicles::{VehicleConfig, VehicleError, Vehicles};
use cosfly_world::{Clock, Population, contacts, simulate};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// Steps of the simulation are no longer than this, seconds.
const LONGEST_STEP_S: f64 = 0.1;
/// Slower than this a vehicle stands, m/s.
const STANDING_MPS: f64 = 0.3;

/// Vehicles of a town and how they drive.
#[derive(Clone, Debug, Serialize)]
pub struct Driving {
    /// Name of the town.
    pub town: String,
    /// Number of frames.
    pub frames: u32,
    /// Time between frames, seconds.
    pub frame_s: f64,
    /// CPU time of the simulation on one core, seconds.
    pub cpu_s: f64,
    /// Pairs of vehicles that overlap in some frame.
    pub overlaps: usize,
    /// Figures by kind.
    pub kinds: Vec<KindFigures>,
}

/// Figures of the vehicles of one kind that drive.
#[derive(Clone, Debug, Serialize)]
pub struct KindFigures {
    /// Kind.
    pub kind: String,
    /// Vehicles that ever drive.
    pub vehicles: usize,
    /// Middle speed while driving, m/s.
    pub speed_mps: f64,
    /// Share of the time standing.
    pub standing: f64,
    /// 99 of 100 accelerations are smaller, m/s^2.
    pub accelerating_mps2: f64,
    /// 99 of 100 decelerations are smaller, m/s^2.
    pub braking_mps2: f64,
    /// 99 of 100 sideways accelerations are smaller, m/s^2.
    pub sideways_mps2: f64,
    /// Largest sideways acceleration, m/s^2.
    pub most_sideways_mps2: f64,
}

/// Speeds and accelerations of one kind.
#[derive(Default)]
struct Samples {
    vehicles: usize,
    standing: usize,
    speeds: Vec<f64>,
    along: Vec<f64>,
    across: Vec<f64>,
}

impl Samples {
    fn add(&mut self, body: &Body, frame_s: f64) {
        let places: Vec<DVec2> = body.states.iter().map(|state| state.feet_in_world.truncate()).collect();
        let velocities: Vec<DVec2> = places.windows(2).map(|pair| (pair[1] - pair[0]) / frame_s).collect();
        if velocities.iter().all(|velocity| velocity.length() < STANDING_MPS) {
            return;
        }
        self.vehicles += 1;
        self.standing += velocities.iter().filter(|velocity| velocity.length() < STANDING_MPS).count();
        self.speeds.extend(velocities.iter().map(|velocity| velocity.length()).filter(|speed| *speed >= STANDING_MPS));
        for pair in velocities.windows(2) {
            let change = (pair[1] - pair[0]) / frame_s;
            let along = (pair[0] + pair[1]).normalize_or_zero();
            self.along.push(change.dot(along));
            self.across.push(change.perp_dot(along).abs());
        }
    }

    fn figures(mut self, kind: BodyKind) -> KindFigures {
        let seen = self.speeds.len() + self.standing;
        KindFigures {
            kind: kind.name().to_owned(),
            vehicles: self.vehicles,
            speed_mps: share(&mut self.speeds, 0.5),
            standing: self.standing as f64 / seen.max(1) as f64,
            accelerating_mps2: share(&mut self.along, 0.99),
            braking_mps2: -share(&mut self.along, 0.01),
            sideways_mps2: share(&mut self.across, 0.99),
            most_sideways_mps2: share(&mut self.across, 1.0),
        }
    }
}

/// The value below which a share of the values lies; 0 of none.
fn share(values: &mut [f64], share: f64) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get((share * values.len().saturating_sub(1) as f64).round() as usize).copied().unwrap_or(0.0)
}

/// Simulates vehicles of the default mix in a town, for a number of frames so many seconds apart.
///
/// # Errors
/// When the town has no lanes.
pub fn driving(town: &Town, count: u32, (frames, frame_s): (u32, f64), seed: u64) -> Result<Driving, VehicleError> {
    let clock = Clock::new(frames, frame_s, LONGEST_STEP_S);
    let config = VehicleConfig { count, ..VehicleConfig::default() };
    let begun = thread_cpu_s();
    let vehicles = Vehicles::new(town, &config, clock, Seed::of_item(seed, "vehicles", &town.name))?;
    let mut populations: Vec<Box<dyn Population>> = vec![Box::new(vehicles)];
    let Ok(traffic) = simulate(&mut populations, clock, |_| Ok::<_, std::convert::Infallible>(()));
    let cpu_s = thread_cpu_s() - begun;
    let mut by_kind: BTreeMap<BodyKind, Samples> = BTreeMap::new();
    traffic.bodies.iter().for_each(|body| by_kind.entry(body.plan.kind).or_default().add(body, frame_s));
    let kinds = by_kind.into_iter().filter(|(_, samples)| samples.vehicles > 0);
    Ok(Driving {
        town: town.name.clone(),
        frames,
        frame_s,
        cpu_s,
        overlaps: contacts(&traffic, 1e-6).len(),
        kinds: kinds.map(|(kind, samples)| samples.figures(kind)).collect(),
    })
}

impl fmt::Display for Driving {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { town, frames, frame_s, cpu_s, overlaps, kinds } = self;
        writeln!(out, "{town}: {frames} frames of {frame_s} s, {cpu_s:.2} s of CPU time, {overlaps} overlaps")?;
        writeln!(
            out,
            "{:<12}{:>9}{:>12}{:>11}{:>14}{:>10}{:>11}{:>10}",
            "kind", "vehicles", "speed, m/s", "standing", "faster, m/s2", "braking", "sideways", "at most"
        )?;
        for kind in kinds {
            writeln!(
                out,
                "{:<12}{:>9}{:>12.1}{:>9.1} %{:>14.2}{:>10.2}{:>11.2}{:>10.2}",
                kind.kind,
                kind.vehicles,
                kind.speed_mps,
                100.0 * kind.standing,
                kind.accelerating_mps2,
                kind.braking_mps2,
                kind.sideways_mps2,
                kind.most_sideways_mps2
            )?;
        }
        writeln!(out, "accelerations: 99 of 100 are smaller; `at most` is the largest sideways one")
    }
}
