//! Input of the linter for each flight: pedestrian, town, route, split.

use super::route::Route;
use cosfly_diagnose::{Result, Stop};
use cosfly_frames::{DVec3, Pose};
use cosfly_read::{PublishedDataset, PublishedFlight};
use cosfly_schema::RenderedTrajectory;
use cosfly_schema::TownLayout;
use std::path::Path;
use std::sync::Arc;

/// Least displacement of the target, metres, for a window to be recognised by the target; below it, the drone's
/// trajectory tells windows apart.
const MOVING_M: f64 = 0.5;

/// Facts of one flight.
#[derive(Clone, Debug)]
pub struct FlightFacts {
    /// Index of its dataset among those that are compared.
    pub dataset: usize,
    /// Trajectory id in that dataset.
    pub trajectory_id: String,
    /// Expert of a perturbed flight.
    pub expert_id: Option<String>,
    /// Pedestrian who is followed.
    pub pedestrian_id: String,
    /// Split group; flights of one group must stay together. Empty before it is decided.
    pub group: String,
    /// Name of the split; empty before it is decided.
    pub split: String,
    /// Name of the town.
    pub town: String,
    /// Ground plan of the town, independent of its name.
    pub layout: Arc<TownLayout>,
    /// Route of the target.
    pub route: Route,
    /// Hash of the window that starts at each frame: equal hashes are equal windows.
    pub windows: Vec<u64>,
}

impl FlightFacts {
    /// Facts of a flight that is about to be published; `window` is the size of its training windows, frames.
    pub fn of_record(record: &RenderedTrajectory, layout: &Arc<TownLayout>, window: usize) -> Self {
        let offset = record.town.origin.offset_m;
        let feet: Vec<DVec3> =
            record.trajectory.track.states.iter().map(|state| state.feet_in_world + offset).collect();
        let drone: Vec<DVec3> =
            record.trajectory.poses_in_world.iter().map(|pose| pose.position_in_world + offset).collect();
        Self {
            dataset: 0,
            trajectory_id: record.trajectory_id.clone(),
            expert_id: record.pair.as_ref().map(|pair| pair.expert_id.clone()),
            pedestrian_id: record.pedestrian_id.clone(),
            group: String::new(),
            split: String::new(),
            town: record.town.name.clone(),
            layout: Arc::clone(layout),
            route: Route::of(&feet),
            windows: windows(&feet, &drone, window),
        }
    }

    fn of_published(dataset: usize, flight: &PublishedFlight, poses: &[Pose], feet: &[DVec3], window: usize) -> Self {
        let in_map: Vec<DVec3> = feet.iter().map(|feet| *feet + flight.town_offset_m).collect();
        Self {
            dataset,
            trajectory_id: flight.trajectory_id.clone(),
            expert_id: flight.expert_id.clone(),
            pedestrian_id: flight.pedestrian_id.clone(),
            group: flight.split_group.clone(),
            split: flight.split.clone(),
            town: flight.town.clone(),
            layout: Arc::clone(&flight.town_layout),
            route: Route::of(&in_map),
            windows: published_windows(flight, poses, feet, window),
        }
    }
}

/// Hashes of the windows of `size` frames of a published flight.
pub(crate) fn published_windows(flight: &PublishedFlight, poses: &[Pose], feet: &[DVec3], size: usize) -> Vec<u64> {
    let offset = flight.town_offset_m;
    let feet: Vec<DVec3> = feet.iter().map(|feet| *feet + offset).collect();
    let drone: Vec<DVec3> = poses.iter().map(|pose| pose.position_in_world + offset).collect();
    windows(&feet, &drone, size)
}

/// Facts of all flights of the published dataset in `folder`, which is number `dataset` of those compared. Without windows
/// where `window` is 0: [`Leaks::of_windows`](super::leaks::Leaks::of_windows) compares those of large datasets.
///
/// # Errors
/// Damage of the tables `trajectories` and `waypoints`; the user stopped the work.
pub fn facts_of_dataset(folder: &Path, dataset: usize, window: usize, stop: &Stop) -> Result<Vec<FlightFacts>> {
    let published = PublishedDataset::open(folder)?;
    let mut facts = vec![];
    published.ways(&mut |id, poses, feet| {
        if let Some(place) = published.place(id) {
            facts.push(FlightFacts::of_published(dataset, &published.flights()[place], poses, feet, window));
        }
        stop.check("splits")
    })?;
    Ok(facts)
}

/// Hash of the `size` frames from each frame on: the target's positions to the centimetre, or the drone's where the
/// target stands.
fn windows(feet: &[DVec3], drone: &[DVec3], size: usize) -> Vec<u64> {
    if size == 0 {
        return vec![];
    }
    let shown = |window: (&[DVec3], &[DVec3])| {
        let (feet, drone) = window;
        let way_m = feet.iter().map(|place| place.distance(feet[0])).fold(0.0, f64::max);
        if way_m >= MOVING_M { fingerprint(0, feet) } else { fingerprint(1, drone) }
    };
    feet.windows(size).zip(drone.windows(size)).map(shown).collect()
}

fn fingerprint(kind: u8, places: &[DVec3]) -> u64 {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&[kind]);
    for number in places.iter().flat_map(|place| place.to_array()) {
        hasher.update(&((number * 100.0).round() as i64).to_le_bytes());
    }
    u64::from_le_bytes(hasher.finalize().as_bytes()[..8].try_into().unwrap_or_default())
}

/// Facts for tests.
#[cfg(test)]
pub(crate) mod fixture {
    use super::*;

    /// An expert's flight behind pedestrian `id`, whose feet are at `feet`, in one town, without a split.
    pub(crate) fn behind(id: usize, feet: &[DVec3]) -> FlightFacts {
        FlightFacts {
            dataset: 0,
            trajectory_id: format!("expert-p{id:05}"),
            expert_id: None,
            pedestrian_id: format!("p{id:05}"),
            group: String::new(),
            split: String::new(),
            town: "town".into(),
            layout: Arc::new(TownLayout { digest: "ab".repeat(32), sketch: vec![] }),
            route: Route::of(feet),
            windows: vec![],
        }
    }
}
