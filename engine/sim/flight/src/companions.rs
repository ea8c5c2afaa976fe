//! Companions of a flight: the walks that stay nearest to the followed one.

use cosfly_frames::TargetTrack;

/// Id and track of a walk.
pub type NamedTrack = (String, TargetTrack);

/// The `count` walks that stay nearest to `track` on average over its frames, nearest first; equally near ones by id.
pub fn nearest(track: &TargetTrack, others: Vec<NamedTrack>, count: usize) -> Vec<NamedTrack> {
    let distance = |other: &TargetTrack| {
        let pairs = track.states.iter().zip(&other.states);
        pairs.map(|(a, b)| a.feet_in_world.distance(b.feet_in_world)).sum::<f64>()
    };
    let mut ranked: Vec<(f64, NamedTrack)> = others.into_iter().map(|other| (distance(&other.1), other)).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.0.cmp(&b.1.0)));
    ranked.into_iter().take(count).map(|(_, companion)| companion).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::{DVec3, TargetState};

    fn walk_at(y: f64) -> TargetTrack {
        let state = |x: f64| TargetState { feet_in_world: DVec3::new(x, y, 0.0), heading_rad: 0.0, speed_mps: 1.0 };
        TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.3, states: (0..9).map(|x| state(f64::from(x))).collect() }
    }

    #[test]
    fn companions_are_the_nearest_and_equals_come_by_id() {
        let others = [("p3", 2.0), ("p1", -9.0), ("p2", 2.0), ("p4", 30.0)];
        let others = others.map(|(id, y)| (id.to_owned(), walk_at(y))).to_vec();
        let chosen = nearest(&walk_at(0.0), others, 3);
        assert_eq!(chosen.iter().map(|(id, _)| id.as_str()).collect::<Vec<_>>(), ["p2", "p3", "p1"]);
    }
}
