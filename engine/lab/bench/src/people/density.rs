//! Speed by density: people on a ring of pavement, at rising numbers, beside Weidmann's curve.

use super::{SAMPLE_S, Tracks, crowded_along};
use cosfly_domain::{Town, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_pedestrians::{CrowdConfig, PedestrianError};
use serde::Serialize;

/// Outer side and width of the ring, metres.
const SIDE_M: f64 = 30.0;
const WIDTH_M: f64 = 4.0;
/// Frames, and those at the beginning that are left out.
const FRAMES: u32 = 160;
const LEFT_OUT: usize = 40;

/// Mean speed at one density.
#[derive(Clone, Debug, Serialize)]
pub struct DensityRow {
    /// People per square metre of pavement.
    pub per_m2: f64,
    /// Mean speed where all walk one way round, m/s.
    pub one_way_mps: f64,
    /// Share of them who walk that way.
    pub one_way_share: f64,
    /// Mean speed of people who walk both ways, m/s.
    pub both_ways_mps: f64,
    /// Largest share of the people who are stuck for 30 s, one way or both.
    pub stuck: f64,
    /// Speed by Weidmann's curve, m/s.
    pub weidmann_mps: f64,
}

/// Weidmann's curve of 1993: speed of a one-way stream by its density.
fn weidmann_mps(per_m2: f64) -> f64 {
    1.34 * (1.0 - cosfly_frames::real::exp(-1.913 * (1.0 / per_m2 - 1.0 / 5.4)))
}

/// Measures the mean speed at several densities; nobody stops on purpose or walks in a group.
///
/// # Errors
/// When the people do not fit.
pub fn density(seed: u64) -> Result<Vec<DensityRow>, PedestrianError> {
    let town = ring();
    let area_m2 = SIDE_M * SIDE_M - (SIDE_M - 2.0 * WIDTH_M) * (SIDE_M - 2.0 * WIDTH_M);
    let row = |wanted: &f64| {
        let mut config = CrowdConfig { count: (wanted * area_m2) as u32, ..CrowdConfig::default() };
        (config.stops.per_100m, config.stops.standing_share, config.groups.share) = (0.0, 0.0, 0.0);
        let per_m2 = f64::from(config.count) / area_m2;
        let (crowd, one_way) = crowded_along(&town, &config, FRAMES, seed, Some(&round))?;
        let (other, both_ways) = crowded_along(&town, &config, FRAMES, seed, None)?;
        Ok(DensityRow {
            per_m2,
            one_way_mps: mean_mps(&one_way),
            one_way_share: share_round(&one_way),
            both_ways_mps: mean_mps(&both_ways),
            stuck: crowd.stuck.max(other.stuck),
            weidmann_mps: weidmann_mps(per_m2),
        })
    };
    [0.05, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5].iter().map(row).collect()
}

/// Steps of all people after those that are left out: place in plan, velocity in m/s.
fn steps(tracks: &Tracks) -> impl Iterator<Item = (DVec2, DVec2)> {
    let of_one = |places: &'_ [DVec2]| -> Vec<(DVec2, DVec2)> {
        places[LEFT_OUT..].windows(2).map(|pair| (pair[0], (pair[1] - pair[0]) / SAMPLE_S)).collect()
    };
    tracks.people.iter().flat_map(move |(_, places)| of_one(places))
}

fn mean_mps(tracks: &Tracks) -> f64 {
    let (sum, count) = steps(tracks).fold((0.0, 0), |(sum, count), step| (sum + step.1.length(), count + 1));
    sum / f64::from(count.max(1))
}

/// Share of the steps that lead round as [`round`] does.
fn share_round(tracks: &Tracks) -> f64 {
    let (ahead, count) =
        steps(tracks).fold((0, 0), |(ahead, count), (at, by)| (ahead + i32::from(by.dot(round(at)) > 0.0), count + 1));
    f64::from(ahead) / f64::from(count.max(1))
}

/// Direction at a place of those who walk one way round: along the side of the ring that the place is on.
fn round(at: DVec2) -> DVec2 {
    let from_middle = at - DVec2::splat(0.5 * SIDE_M);
    match from_middle.x.abs() > from_middle.y.abs() {
        true => DVec2::Y * from_middle.x.signum(),
        false => DVec2::NEG_X * from_middle.y.signum(),
    }
}

/// A square ring of pavement.
fn ring() -> Town {
    let rectangle = |low: (f64, f64), high: (f64, f64)| WalkablePolygon {
        kind: WalkableKind::Sidewalk,
        outline_in_world: [(low.0, low.1), (high.0, low.1), (high.0, high.1), (low.0, high.1)]
            .map(|(x, y)| DVec3::new(x, y, 0.0))
            .to_vec(),
        synthetic: true,
    };
    let (side, inner) = (SIDE_M, SIDE_M - WIDTH_M);
    let walkable = vec![
        rectangle((0.0, 0.0), (side, WIDTH_M)),
        rectangle((0.0, inner), (side, side)),
        rectangle((0.0, WIDTH_M), (WIDTH_M, inner)),
        rectangle((inner, WIDTH_M), (side, inner)),
    ];
    let mut town = Town { name: "ring".into(), walkable, ..Town::default() };
    town.update_bounds();
    town
}
