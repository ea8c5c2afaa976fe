//! Where the streets are: a building must stand clear of every lane and pavement.

use super::streets::Network;
use super::turns::JunctionWay;
use crate::lot::Lot;
use cosfly_frames::DVec2;

/// Discs along all streets that together cover lanes and pavements.
#[derive(Clone, Debug)]
pub struct StreetSpace {
    discs: Vec<(DVec2, f64)>,
}

impl StreetSpace {
    /// Space of all streets and turns.
    pub fn new(network: &Network, turns: &[JunctionWay]) -> Self {
        let mut discs = Vec::new();
        for street in &network.streets {
            let radius_m = street.profile.half_width_m();
            let steps = (street.line.length_m() / 1.0).ceil() as usize;
            for i in 0..=steps {
                discs.push((street.line.pose_at(street.line.length_m() * i as f64 / steps as f64).at, radius_m));
            }
        }
        for turn in turns {
            let radius_m = 0.5 * turn.width_m();
            let steps = (turn.line.length_m() / 1.0).ceil() as usize;
            for i in 0..=steps {
                let pose = turn.line.pose_at(turn.line.length_m() * i as f64 / steps as f64);
                discs.push((pose.moved(0.0, -radius_m).at, radius_m));
            }
        }
        Self { discs }
    }

    /// Whether the lot keeps at least `gap_m` from every street (within 3 cm, by discs a metre apart).
    pub fn is_clear(&self, lot: &Lot, gap_m: f64) -> bool {
        self.discs.iter().all(|(center, radius_m)| lot.distance_m(*center) >= radius_m + gap_m)
    }
}
