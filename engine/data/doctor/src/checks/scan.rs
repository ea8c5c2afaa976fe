//! Flights against the scan that they were flown in.

use cosfly_episodes::{ExaminedEpisode, Flag};
use cosfly_frames::DVec3;
use cosfly_metrics::scanned_mesh::ScannedMesh;

/// Distances are good to this much, metres: corners are 32-bit numbers.
const ROUNDING_M: f64 = 0.01;
/// A drone nearer to a surface than this has flown into it, metres.
const TOUCHING_M: f64 = 0.05;
/// Feet that are farther from the surface in the median stand on other ground, metres.
const MOST_OFF_M: f64 = 0.3;
/// Surfaces farther from feet than this are not theirs, metres.
const WITHIN_M: f64 = 5.0;
/// Fewest frames with feet that tell where a walk is.
const LEAST_FEET: usize = 5;

/// Checks an episode in the town of the mesh: its distance from the surface, and whether who is followed stands on it.
pub fn check(episode: &ExaminedEpisode, mesh: &ScannedMesh) -> Vec<Flag> {
    if !mesh.town.is_empty() && episode.town != mesh.town {
        return vec![];
    }
    near(episode, mesh).into_iter().chain(feet(episode, mesh)).collect()
}

/// The place where a flight comes nearer to the mesh than it says.
fn near(episode: &ExaminedEpisode, mesh: &ScannedMesh) -> Option<Flag> {
    let path: Vec<DVec3> = episode.moments.iter().map(|it| it.drone.position_in_world).collect();
    let stated_m = episode.limits[0].filter(|_| !episode.is_perturbed);
    let (frame, away_m) = mesh.nearest(&path, stated_m.unwrap_or(TOUCHING_M) - ROUNDING_M)?;
    let told = format!("at frame {frame} the drone is {away_m:.2} m from the mesh");
    Some(match stated_m {
        Some(stated_m) => Flag::damage("scan-clearance", &episode.id, format!("{told}; {stated_m} m are stated")),
        None if episode.is_perturbed => Flag::imperfect("scan-clearance", &episode.id, told),
        None => Flag::damage("scan-clearance", &episode.id, told),
    })
}

/// Feet that are not on the surface.
fn feet(episode: &ExaminedEpisode, mesh: &ScannedMesh) -> Option<Flag> {
    let down = DVec3::Z * (0.5 * episode.target_height_m);
    let feet = episode.moments.iter().filter_map(|it| Some(it.target_in_world? - down));
    let mut over_m: Vec<f64> = feet.map(|feet| mesh.height_over(feet, WITHIN_M).unwrap_or(f64::INFINITY)).collect();
    over_m.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let off_m = over_m.get(over_m.len() / 2).copied().filter(|_| over_m.len() >= LEAST_FEET)?;
    let told = if off_m.is_infinite() {
        format!(
            "within {WITHIN_M} m of the feet of who is followed there is no surface of the mesh in half of the frames"
        )
    } else {
        let side = if off_m > 0.0 { "over" } else { "under" };
        format!("the feet of who is followed are {:.2} m {side} the mesh in the median", off_m.abs())
    };
    (off_m.abs() > MOST_OFF_M).then(|| Flag::damage("scan-ground", &episode.id, told))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::walk::tests::episode;

    /// A level square of 200 m around the origin at a height, metres.
    fn ground(height_m: f64) -> ScannedMesh {
        ground_of("", height_m)
    }

    fn ground_of(town: &str, height_m: f64) -> ScannedMesh {
        let [a, b, c, d] = [[-100.0, -100.0], [100.0, -100.0], [100.0, 100.0], [-100.0, 100.0]]
            .map(|[x, y]| DVec3::new(x, y, height_m));
        ScannedMesh::new(town.to_owned(), [[a, b, c], [a, c, d]].into_iter())
    }

    fn names(episode: &ExaminedEpisode, mesh: &ScannedMesh) -> Vec<&'static str> {
        check(episode, mesh).iter().map(|flag| flag.name).collect()
    }

    #[test]
    fn flights_over_their_own_ground_pass_and_planted_faults_are_flagged() {
        let walk =
            ExaminedEpisode { limits: [Some(1.5), None, None, None, None, None], ..episode(&[(0.0, 24.0)], "walks") };
        assert_eq!(names(&walk, &ground(0.0)), [""; 0]);
        assert_eq!(names(&walk, &ground(-0.25)), [""; 0], "a step of a scan");
        assert_eq!(names(&walk, &ground(0.8)), ["scan-ground"], "a scan that is too high");
        assert_eq!(names(&walk, &ground(-2.0)), ["scan-ground"], "a scan that is too low");
        assert_eq!(names(&walk, &ground(-30.0)), ["scan-ground"], "a scan of another place");
        // The drone flies 20 m over the feet.
        assert_eq!(names(&walk, &ground(19.0)), ["scan-clearance", "scan-ground"]);
        let unlimited = ExaminedEpisode { limits: [None; 6], ..walk.clone() };
        assert_eq!(names(&unlimited, &ground(19.0)), ["scan-ground"], "nothing is stated");
        assert_eq!(names(&unlimited, &ground(20.0)), ["scan-clearance", "scan-ground"], "in the surface");
        let twin = ExaminedEpisode { is_perturbed: true, ..walk.clone() };
        assert_eq!(names(&twin, &ground(19.0)), ["scan-ground"], "twins depart on purpose");
        assert_eq!(names(&walk, &ground_of("another", 19.0)), [""; 0]);
    }
}
